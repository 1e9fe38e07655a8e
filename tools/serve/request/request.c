/* See request.h. */
#include "serve/request/request.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/json_text.h"

int serve_refuse(ServeRequest *request, int status, const char *fmt, ...)
{
    va_list arguments;
    va_start(arguments, fmt);
    vsnprintf(request->reason, sizeof request->reason, fmt, arguments);
    va_end(arguments);
    utf8_trim(request->reason);
    return request->status = status;
}

/* ---- formats ---- */

static const struct {
    const char *extension, *type;
} format_names[SERVE_FORMATS] = {
    {"jpg", "image/jpeg"}, {"png", "image/png"}, {"webp", "image/webp"}, {"avif", "image/avif"}, {"jxl", "image/jxl"}};

const char *serve_format_extension(ServeFormat format)
{
    return format_names[format].extension;
}

const char *serve_format_type(ServeFormat format)
{
    return format_names[format].type;
}

int serve_format_set(ServeRequest *request, const char *extension, unsigned formats)
{
    for (int f = 0; f < SERVE_FORMATS; f++)
        if (strcmp(extension, format_names[f].extension) == 0 && formats & 1u << f) {
            request->format = (ServeFormat)f;
            return 0;
        }
    return serve_refuse(request, 400, "pictures are not written as .%s; /v1 lists the formats", extension);
}
