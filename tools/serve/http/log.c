/* See log.h. */
#include "serve/http/log.h"

#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include <retex/clock.h>

#include "common/json_text.h"

static void write_time(FILE *file)
{
    const struct timespec now = retex_clock_time_after(0);
    struct tm parts;
    char text[32];
    gmtime_r(&now.tv_sec, &parts);
    strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
    fprintf(file, "{\"time\": \"%s.%03ldZ\"", text, now.tv_nsec / 1000000);
}

static void write_text(FILE *file, const char *key, const char *text)
{
    fprintf(file, ", \"%s\": ", key);
    json_text(file, text ? text : "");
}

void log_request(const LogLine *line)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = open_memstream(&text, &bytes);
    if (!file)
        return;
    write_time(file);
    write_text(file, "client", line->client);
    write_text(file, "method", line->method);
    write_text(file, "path", line->path);
    fprintf(file, ", \"status\": %d, \"bytes\": %llu, \"seconds\": %.6f", line->status, line->bytes, line->seconds);
    write_text(file, "cache", cache_use_name(line->cache));
    if (line->error && line->error[0])
        write_text(file, "error", line->error);
    fputs("}\n", file);
    const int failed = ferror(file);
    if (fclose(file) == 0 && !failed)
        (void)!write(STDERR_FILENO, text, bytes);
    free(text);
}
