/* See answer.h. */
#include "serve/answer/answer.h"

#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/json.h"
#include "common/json_text.h"

Answer *answer_new(int status, const char *type, void *data, size_t bytes)
{
    Answer *answer = calloc(1, sizeof *answer);
    if (!answer) {
        free(data);
        return NULL;
    }
    atomic_init(&answer->uses, 1);
    answer->status = status;
    answer->type = type;
    answer->data = data;
    answer->bytes = bytes;
    return answer;
}

Answer *answer_of_text(int status, const char *type, FILE *file, char **text, const size_t *bytes)
{
    const int failed = ferror(file);
    if (fclose(file) == 0 && !failed)
        return answer_new(status, type, *text, *bytes);
    free(*text);
    return NULL;
}

Answer *answer_json(int status, json_t *value)
{
    enum { DIGITS = 6 };
    char *text = json_line_text(value, DIGITS);
    return text ? answer_new(status, "application/json", text, strlen(text)) : NULL;
}

Answer *answer_error(int status, const char *fmt, ...)
{
    char reason[sizeof((Answer *)0)->reason], line[sizeof reason + 1];
    va_list args;
    va_start(args, fmt);
    vsnprintf(reason, sizeof reason, fmt, args);
    va_end(args);
    utf8_trim(reason);
    const int bytes = snprintf(line, sizeof line, "%s\n", reason);
    char *data = strdup(line);
    Answer *answer = data ? answer_new(status, "text/plain; charset=utf-8", data, (size_t)bytes) : NULL;
    if (answer)
        strcpy(answer->reason, reason);
    return answer;
}

/* The status of a failure. What the request asked for was checked before, so that what remains is the server's fault,
 * but for what only the room or the texture tells. */
static int status_of(int code)
{
    switch (code) {
    case RETEX_EINVAL:
    case RETEX_EPARSE:
        return 400;
    case RETEX_ENOTFOUND:
    case RETEX_EACCESS:
        return 404;
    case RETEX_ENOMEM:
    case RETEX_ELIMIT:
    case RETEX_ESTOPPED:
        return 503;
    default: /* a file that is damaged or cannot be read */
        return 500;
    }
}

/* Messages of failures of the server name its files: they are for the log alone. */
Answer *answer_of_error(const RetexError *err)
{
    const int status = status_of(err->code);
    const char *told = status == 404 && err->code == RETEX_EACCESS ? "there is no such file"
                       : status == 500                             ? "the server cannot make this"
                       : status == 503                             ? "the server is busy"
                                                                   : err->message;
    Answer *answer = answer_error(status, "%s", told);
    if (answer)
        snprintf(answer->reason, sizeof answer->reason, "%.80s%s%.110s", err->file, err->file[0] ? ": " : "",
                 err->message);
    return answer;
}

Answer *answer_hold(Answer *answer)
{
    atomic_fetch_add(&answer->uses, 1);
    return answer;
}

void answer_release(Answer *answer)
{
    if (!answer || atomic_fetch_sub(&answer->uses, 1) != 1)
        return;
    free(answer->data);
    free(answer->location);
    free(answer);
}
