/* Fills a RetexError. The message is formatted into a buffer first, so that a caller may quote the message that it
 * replaces: retex_fail(err, code, "%s: %s", path, err->message). */
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
