/* See events.h. */
#include "events.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/clock.h>

#include "studio.h"

/* A beat shows that a window has gone, which is noticed by writing only. Progress is told a few times a second. */
enum { BEAT_SECONDS = 25, PAUSE_MILLISECONDS = 150, BLOCK = 16 << 10 };

typedef struct Stream {
    Studio *studio;
    uint64_t told; /* number of the last change that was told */
    char *text;    /* that is being sent */
    size_t bytes, sent;
    double begun; /* when it was made */
} Stream;

static void put_event(FILE *file, const char *name, json_t *data)
{
    char *text = data ? json_dumps(data, JSON_COMPACT) : NULL;
    if (text)
        fprintf(file, "event: %s\ndata: %s\n\n", name, text);
    free(text);
    json_decref(data);
}

/* What has changed since stream->told; with the lock. */
static void put_changes(Stream *stream, FILE *file)
{
    Studio *studio = stream->studio;
    if (studio->watch.changed > stream->told)
        put_event(file, "model",
                  json_pack("{s:b, s:s}", "there", studio->watch.id[0] != 0, "changed", studio->watch.id));
    if (studio->project.changed > stream->told)
        put_event(file, "project", json_pack("{s:s}", "etag", studio->project.etag));
    if (studio->preview.changed > stream->told)
        put_event(file, "preview", preview_json(&studio->preview));
    json_t *list = jobs_list(&studio->jobs, stream->told);
    for (size_t i = 0; i < json_array_size(list); i++)
        put_event(file, "job", json_incref(json_array_get(list, i)));
    json_decref(list);
    stream->told = studio->changes.number;
    fprintf(file, "id: %llu\n\n", (unsigned long long)stream->told);
}

/* The next text, when there is one. 0: the server ends. */
static int wait_for_text(Stream *stream)
{
    Changes *changes = &stream->studio->changes;
    const double pause = stream->begun + 1e-3 * PAUSE_MILLISECONDS;
    FILE *file = open_memstream(&stream->text, &stream->bytes);
    if (!file)
        return 0;
    changes_lock(changes);
    while (retex_clock_seconds() < pause && !changes->is_ending)
        changes_wait(changes, pause);
    const double beat = retex_clock_seconds() + BEAT_SECONDS;
    while (changes->number == stream->told && changes_wait(changes, beat))
        ;
    if (changes->number != stream->told)
        put_changes(stream, file);
    else
        fputs(":\n\n", file);
    const int is_ending = changes->is_ending;
    changes_unlock(changes);
    stream->begun = retex_clock_seconds();
    stream->sent = 0;
    return fclose(file) == 0 && !is_ending;
}

static ssize_t read_stream(void *context, uint64_t position, char *data, size_t size)
{
    Stream *stream = context;
    (void)position;
    if (stream->sent == stream->bytes) {
        free(stream->text);
        stream->text = NULL;
        stream->bytes = stream->sent = 0;
        if (!wait_for_text(stream))
            return MHD_CONTENT_READER_END_OF_STREAM;
    }
    const size_t left = stream->bytes - stream->sent, count = left < size ? left : size;
    memcpy(data, stream->text + stream->sent, count);
    stream->sent += count;
    return (ssize_t)count;
}

static void free_stream(void *context)
{
    Stream *stream = context;
    free(stream->text);
    free(stream);
}

Reply events_stream(struct Studio *studio, uint64_t since)
{
    static const char begin[] = ": the beginning\n\n"; /* so that a window knows that it listens */
    Stream *stream = calloc(1, sizeof *stream);
    if (!stream || !(stream->text = strdup(begin))) {
        free(stream);
        return reply_error(MHD_HTTP_INTERNAL_SERVER_ERROR, "not enough memory");
    }
    stream->studio = studio;
    stream->told = since;
    stream->bytes = sizeof begin - 1;
    Reply reply = {MHD_HTTP_OK,
                   MHD_create_response_from_callback(MHD_SIZE_UNKNOWN, BLOCK, read_stream, stream, free_stream)};
    if (!reply.response)
        free_stream(stream);
    reply_header(&reply, "Content-Type", "text/event-stream");
    return reply;
}
