/* See log.h. */
#include "serve/http/log.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <retex/clock.h>

#include "common/json.h"

static json_t *text_of(const char *text)
{
    return json_of_text(text ? text : "");
}

void log_request(const LogLine *line)
{
    enum { DIGITS = 15 };
    const struct timespec now = retex_clock_time_after(0);
    const int has_error = line->error && line->error[0];
    struct tm parts;
    char time[32];
    gmtime_r(&now.tv_sec, &parts);
    const size_t length = strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%S", &parts);
    snprintf(time + length, sizeof time - length, ".%03ldZ", now.tv_nsec / 1000000);
    char *text = json_line_text(
        json_pack("{s:s, s:o, s:o, s:o, s:i, s:I, s:o, s:s, s:o*}", "time", time, "client", text_of(line->client),
                  "method", text_of(line->method), "path", text_of(line->path), "status",
                  line->status, "bytes", (json_int_t)line->bytes, "seconds", json_of_rounded(line->seconds, 6),
                  "cache", cache_use_name(line->cache), "error", has_error ? json_of_text(line->error) : NULL),
        DIGITS);
    if (text)
        (void)!write(STDERR_FILENO, text, strlen(text));
    free(text);
}
