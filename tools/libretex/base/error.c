/* Filling a RetexError: the one place where messages are put together.
 *
 * The text is formatted aside first, so that a caller may quote the very message it is about to replace:
 * retex_fail(err, code, "%s: %s", path, err->message). */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <retex/error.h>

static int fail(RetexError *err, int code, const char *file, int line, int column, const char *fmt, va_list arguments)
{
    char message[sizeof((RetexError *)0)->message] = "";

    if (!err)
        return code;
    vsnprintf(message, sizeof message, fmt, arguments);
    if (file != err->file)
        snprintf(err->file, sizeof err->file, "%s", file);
    memcpy(err->message, message, sizeof message);
    err->code = code;
    err->line = line;
    err->column = column;
    return code;
}

int retex_fail(RetexError *err, int code, const char *fmt, ...)
{
    va_list arguments;

    va_start(arguments, fmt);
    fail(err, code, "", 0, 0, fmt, arguments);
    va_end(arguments);
    return code;
}

int retex_fail_at(RetexError *err, int code, const char *file, int line, int column, const char *fmt, ...)
{
    va_list arguments;

    va_start(arguments, fmt);
    fail(err, code, file ? file : "", line, column, fmt, arguments);
    va_end(arguments);
    return code;
}
