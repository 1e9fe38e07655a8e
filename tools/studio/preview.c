/* See preview.h. */
#include "preview.h"

#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>

/* Beside a render, which has NICE of jobs.c, it gets a quarter of the processor time. */
enum { NICE = 15, KILL_SECONDS = 3, HEAD_BYTES = 16 << 20, READ_BYTES = 64 << 10 };
#define ANSWER_BYTES ((json_int_t)1 << 30)

static const char *const kind_names[] = {"live", "picture", "surfaces", "uv", "error"};

int preview_kind(const char *name, AnswerKind *kind)
{
    for (int k = 0; k < ANSWER_KINDS; k++)
        if (strcmp(name, kind_names[k]) == 0) {
            *kind = (AnswerKind)k;
            return 1;
        }
    return 0;
}

void live_answer_release(LiveAnswer *answer)
{
    if (!answer || atomic_fetch_sub(&answer->uses, 1) > 1)
        return;
    free(answer->line);
    free(answer->data);
    free(answer);
}

void preview_open(Preview *preview, Changes *changes)
{
    *preview = (Preview){.changes = changes, .child = CHILD_NONE};
}

static void drop_incoming(Incoming *incoming)
{
    free(incoming->head);
    free(incoming->data);
    json_decref(incoming->json);
    *incoming = (Incoming){0};
}

static void drop_answers(Preview *preview)
{
    for (int k = 0; k < ANSWER_KINDS; k++) {
        live_answer_release(preview->answers[k]);
        preview->answers[k] = NULL;
    }
    drop_incoming(&preview->incoming);
    said_free(&preview->said);
}

void preview_close(Preview *preview)
{
    drop_answers(preview);
    line_free(&preview->next);
}

/* ---- what windows ask for ---- */

static int is_alive(const Preview *preview)
{
    return preview->next.words || (preview->child.pid > 0 && !preview->is_stopping);
}

void preview_start(Preview *preview, Line *line, const Model *model, int is_confined)
{
    changes_lock(preview->changes);
    line_free(&preview->next);
    preview->next = *line;
    preview->next_model = model;
    preview->next_is_confined = is_confined;
    preview->nlines = 0;
    drop_answers(preview);
    preview->changed = changes_note(preview->changes);
    changes_unlock(preview->changes);
    *line = (Line){0};
    changes_wake(preview->changes);
}

static void stop_child(Preview *preview)
{
    if (preview->child.pid <= 0 || preview->is_stopping)
        return;
    preview->is_stopping = 1;
    preview->stopped = retex_clock_seconds();
    child_close_file(&preview->child.input);
    child_signal(&preview->child, SIGTERM);
}

void preview_stop(Preview *preview)
{
    changes_lock(preview->changes);
    line_free(&preview->next);
    stop_child(preview);
    preview->changed = changes_note(preview->changes);
    changes_unlock(preview->changes);
    changes_wake(preview->changes);
}

/* Keep a line until the process takes it. 0: there is no room. */
static int keep_line(Preview *preview, const char *line)
{
    const int most = (int)(sizeof preview->lines / sizeof *preview->lines);
    int at = preview->nlines;
    for (int i = 0; i < preview->nlines; i++)
        if (strncmp(line, "view", 4) == 0 && strncmp(preview->lines[i], "view", 4) == 0)
            at = i;
    if (at == most)
        return 0;
    memcpy(preview->lines[at], line, strlen(line));
    memcpy(preview->lines[at] + strlen(line), "\n", 2);
    preview->nlines += at == preview->nlines;
    return 1;
}

/* Give the process what it takes: a line goes into a pipe as a whole. */
static void send_lines(Preview *preview)
{
    while (preview->nlines && preview->child.input >= 0 && !preview->is_stopping && !preview->next.words) {
        const size_t length = strlen(preview->lines[0]);
        if (write(preview->child.input, preview->lines[0], length) < 0)
            return;
        preview->nlines--;
        memmove(preview->lines[0], preview->lines[1], (size_t)preview->nlines * sizeof *preview->lines);
    }
}

int preview_send(Preview *preview, const char *line, RetexError *err)
{
    int code = RETEX_OK;
    if (!line || !*line || strlen(line) > PREVIEW_LINE || strpbrk(line, "\r\n"))
        return retex_fail(err, RETEX_EINVAL, "line: expected one line of at most %d bytes", PREVIEW_LINE);
    changes_lock(preview->changes);
    if (!is_alive(preview))
        code = retex_fail(err, RETEX_ENOTFOUND, "there is no preview");
    else if (!keep_line(preview, line))
        code = retex_fail(err, RETEX_ELIMIT, "the preview is busy");
    send_lines(preview);
    changes_unlock(preview->changes);
    changes_wake(preview->changes);
    return code;
}

LiveAnswer *preview_answer(Preview *preview, AnswerKind kind, uint64_t after, double seconds, int *is_running,
                           char why[SAID_LINE + 1])
{
    const double until = retex_clock_seconds() + seconds;
    changes_lock(preview->changes);
    while (!(preview->answers[kind] && preview->answers[kind]->number > after) && is_alive(preview) &&
           changes_wait(preview->changes, until))
        ;
    LiveAnswer *answer = preview->answers[kind];
    if (answer && answer->number > after)
        atomic_fetch_add(&answer->uses, 1);
    else
        answer = NULL;
    *is_running = is_alive(preview);
    strcpy(why, said_last(&preview->said));
    changes_unlock(preview->changes);
    return answer;
}

json_t *preview_json(const Preview *preview)
{
    json_t *said = said_json(&preview->said), *text = json_pack("{s:b}", "running", is_alive(preview));
    json_object_set(text, "lines", json_object_get(said, "lines"));
    json_decref(said);
    return text;
}

/* ---- reading ---- */

static AnswerKind kind_of(const json_t *json)
{
    for (int k = 0; k < ANSWER_ERROR; k++)
        if (json_object_get(json, kind_names[k]))
            return (AnswerKind)k;
    return ANSWER_ERROR;
}

/* The answer is whole: it replaces the last one of its kind. */
static void keep_answer(Preview *preview)
{
    Incoming *incoming = &preview->incoming;
    const AnswerKind kind = kind_of(incoming->json);
    LiveAnswer *answer = calloc(1, sizeof *answer);
    if (answer) {
        atomic_init(&answer->uses, 1);
        answer->number = changes_note(preview->changes);
        json_object_set_new(incoming->json, "number", json_integer((json_int_t)answer->number));
        answer->line = json_dumps(incoming->json, JSON_COMPACT | JSON_ENSURE_ASCII);
        answer->data = incoming->data;
        answer->bytes = incoming->bytes;
        incoming->data = NULL;
        live_answer_release(preview->answers[kind]);
        preview->answers[kind] = answer->line ? answer : NULL;
        if (!answer->line)
            live_answer_release(answer);
    }
    drop_incoming(incoming);
}

/* Take bytes of the line. Returns how many; below 0: this is no answer. */
static long take_head(Incoming *incoming, const char *bytes, size_t count)
{
    const char *end = memchr(bytes, '\n', count);
    const size_t taken = end ? (size_t)(end - bytes) + 1 : count;
    if (incoming->head_bytes + taken > incoming->head_space) {
        const size_t space = 2 * (incoming->head_bytes + taken);
        char *head = space <= HEAD_BYTES ? realloc(incoming->head, space) : NULL;
        if (!head)
            return -1;
        incoming->head = head;
        incoming->head_space = space;
    }
    memcpy(incoming->head + incoming->head_bytes, bytes, taken);
    incoming->head_bytes += taken;
    if (!end)
        return (long)taken;
    incoming->json = json_loadb(incoming->head, incoming->head_bytes, 0, NULL);
    const json_int_t size = json_integer_value(json_object_get(incoming->json, "bytes"));
    if (!json_is_object(incoming->json) || size < 0 || size > ANSWER_BYTES)
        return -1;
    incoming->bytes = (size_t)size;
    incoming->data = malloc(incoming->bytes + 1);
    return incoming->data ? (long)taken : -1;
}

/* Bytes of one answer or several. 0: they are none. */
static int take_bytes(Preview *preview, const char *bytes, size_t count)
{
    Incoming *incoming = &preview->incoming;
    while (count || (incoming->json && incoming->got == incoming->bytes)) {
        long taken;
        if (!incoming->json) {
            taken = take_head(incoming, bytes, count);
        } else {
            const size_t left = incoming->bytes - incoming->got;
            taken = (long)(left < count ? left : count);
            memcpy(incoming->data + incoming->got, bytes, (size_t)taken);
            incoming->got += (size_t)taken;
        }
        if (taken < 0)
            return 0;
        bytes += taken;
        count -= (size_t)taken;
        if (incoming->json && incoming->got == incoming->bytes)
            keep_answer(preview);
    }
    return 1;
}

static ssize_t read_some(int *file, char *bytes, size_t size)
{
    ssize_t got;
    if (*file < 0)
        return -1;
    do
        got = read(*file, bytes, size);
    while (got < 0 && errno == EINTR);
    if (got == 0 || (got < 0 && errno != EAGAIN))
        child_close_file(file);
    return got;
}

static void read_child(Preview *preview)
{
    char bytes[READ_BYTES];
    ssize_t got;
    int is_right = 1;
    while (is_right && (got = read_some(&preview->child.output, bytes, sizeof bytes)) > 0)
        is_right = preview->is_stopping || preview->next.words || take_bytes(preview, bytes, (size_t)got);
    while ((got = read_some(&preview->child.message, bytes, sizeof bytes)) > 0)
        said_message(&preview->said, bytes, (size_t)got);
    if (!is_right) {
        said_line(&preview->said, "retex-studio: the preview has answered what is no answer");
        stop_child(preview);
    }
}

/* ---- running ---- */

int preview_poll(Preview *preview, struct pollfd files[PREVIEW_FILES])
{
    int count = 0;
    changes_lock(preview->changes);
    if (preview->child.output >= 0)
        files[count++] = (struct pollfd){preview->child.output, POLLIN, 0};
    if (preview->child.message >= 0)
        files[count++] = (struct pollfd){preview->child.message, POLLIN, 0};
    if (preview->nlines && preview->child.input >= 0)
        files[count++] = (struct pollfd){preview->child.input, POLLOUT, 0};
    changes_unlock(preview->changes);
    return count;
}

static void start_next(Preview *preview)
{
    RetexError err = {0};
    const ChildParams params = {.words = preview->next.words,
                                .folder = preview->next_model->folder,
                                .writes = preview->next_is_confined ? preview->next_model->written : NULL,
                                .writes_folder = preview->next_model->top,
                                .is_fed = 1,
                                .nice = NICE};
    said_free(&preview->said);
    drop_incoming(&preview->incoming);
    preview->is_stopping = 0;
    if (child_start(&preview->child, &params, &err))
        said_line(&preview->said, "retex-studio: %s", err.message);
    line_free(&preview->next);
    preview->changed = changes_note(preview->changes);
}

static void end_child(Preview *preview, int status)
{
    said_end(&preview->said, 0);
    if (WIFSIGNALED(status) && !preview->is_stopping)
        said_line(&preview->said, "retex-studio: the preview was ended by a signal: %s", strsignal(WTERMSIG(status)));
    child_close(&preview->child);
    drop_incoming(&preview->incoming);
    preview->nlines = preview->next.words ? preview->nlines : 0;
    preview->is_stopping = 0;
    preview->changed = changes_note(preview->changes);
}

void preview_go_on(Preview *preview)
{
    int status;
    uint64_t memory;
    changes_lock(preview->changes);
    if (preview->child.pid > 0) {
        const int has_ended = child_reap(&preview->child, &status, &memory);
        read_child(preview);
        if (has_ended)
            end_child(preview, status);
        else if (preview->next.words)
            stop_child(preview);
        if (preview->is_stopping && retex_clock_seconds() > preview->stopped + KILL_SECONDS)
            child_signal(&preview->child, SIGKILL);
    }
    if (preview->child.pid <= 0 && preview->next.words && !preview->changes->is_ending)
        start_next(preview);
    send_lines(preview);
    changes_unlock(preview->changes);
}

int preview_end(Preview *preview, int number)
{
    changes_lock(preview->changes);
    line_free(&preview->next);
    stop_child(preview);
    if (number)
        child_signal(&preview->child, number);
    const int running = preview->child.pid > 0;
    changes_unlock(preview->changes);
    return running;
}
