/* See status.h. */
#include "serve/http/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

static void write_counts(FILE *file, const StatusSources *sources)
{
    const Site *site = sources->site;
    const RoomsCount rooms = rooms_count(site->rooms);
    const ImagesCount images = images_count(site->images);
    const WorkCount work = work_count(sources->pictures);
    size_t pictures, picture_bytes;
    cache_count(site->pictures, &pictures, &picture_bytes);
    metrics_write_value(file, "connections", "gauge", "Open connections.", sources->connections);
    metrics_write_value(file, "queue_length", "gauge", "Pictures that wait.", work.waiting);
    metrics_write_value(file, "queue_limit", "gauge", "Pictures that may wait.", work.limit);
    metrics_write_value(file, "working", "gauge", "Pictures that are being made.", work.running);
    if (sources->uploads) {
        const WorkCount decoding = work_count(sources->uploads);
        metrics_write_value(file, "decoding_waiting", "gauge", "Requests that wait for the decoding of an upload.",
                            decoding.waiting);
        metrics_write_value(file, "decoding", "gauge", "Requests for which an upload is decoded.", decoding.running);
    }
    metrics_write_value(file, "rooms_open", "gauge", "Rooms that are open.", rooms.open);
    metrics_write_value(file, "rooms_bytes", "gauge", "Bytes of rooms decoded in memory.", (double)rooms.bytes);
    metrics_write_value(file, "rooms_opened_total", "counter", "Rooms that were opened.", (double)rooms.opened);
    metrics_write_value(file, "rooms_failed_total", "counter", "Rooms that could not be opened.", (double)rooms.failed);
    metrics_write_value(file, "images_open", "gauge", "Images of textures in memory.", images.open);
    metrics_write_value(file, "images_bytes", "gauge", "Bytes of images of textures in memory.", (double)images.bytes);
    metrics_write_value(file, "images_read_total", "counter", "Images of textures that were read.",
                        (double)images.read);
    metrics_write_value(file, "images_failed_total", "counter", "Images of textures that could not be read.",
                        (double)images.failed);
    metrics_write_value(file, "pictures_kept", "gauge", "Finished pictures in memory.", (double)pictures);
    metrics_write_value(file, "pictures_bytes", "gauge", "Bytes of finished pictures in memory.",
                        (double)picture_bytes);
    if (site->uploads) {
        const UploadsCount uploads = uploads_count(site->uploads);
        metrics_write_value(file, "uploads", "gauge", "Uploaded images.", uploads.count);
        metrics_write_value(file, "uploads_bytes", "gauge", "Bytes of uploaded images.", (double)uploads.bytes);
    }
}

static void write_process(FILE *file)
{
    FILE *status = fopen("/proc/self/statm", "re");
    struct rusage usage = {0};
    unsigned long long pages = 0;
    if (status && fscanf(status, "%*u %llu", &pages) == 1)
        metrics_write_value(file, "resident_bytes", "gauge", "Memory of the process.",
                            (double)pages * (double)sysconf(_SC_PAGESIZE));
    if (status)
        fclose(status);
    if (getrusage(RUSAGE_SELF, &usage) == 0)
        metrics_write_value(file, "processor_seconds_total", "counter", "Processor time of the process.",
                            (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                                1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec));
}

Answer *status_answer(const StatusSources *sources)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = open_memstream(&text, &bytes);
    if (!file)
        return NULL;
    metrics_write(file, sources->metrics);
    write_counts(file, sources);
    write_process(file);
    return answer_of_text(200, "text/plain; version=0.0.4; charset=utf-8", file, &text, &bytes);
}
