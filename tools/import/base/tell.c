/* See tell.h. */
#include "import/base/tell.h"

#include <stdarg.h>

void import_tell(const Import *import, char kind, const char *fmt, ...)
{
    char text[1024];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    import->options->tell(import->options->context, kind, text);
}

const char *import_plain(const char *text, char plain[NAME_SIZE])
{
    int n = 0;
    for (; *text && n + 1 < NAME_SIZE; text++)
        plain[n++] = (unsigned char)*text < 32 || *text == 127 ? '?' : *text;
    plain[n] = '\0';
    return plain;
}
