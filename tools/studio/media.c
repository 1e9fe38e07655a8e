/* See media.h. */
#include "media.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

static const struct {
    const char *ending, *type;
    int is_own; /* 1: of other folders it is only bytes */
} types[] = {
    {".html", "text/html; charset=utf-8", 1},
    {".js", "text/javascript; charset=utf-8", 1},
    {".css", "text/css; charset=utf-8", 1},
    {".json", "application/json", 0},
    {".txt", "text/plain; charset=utf-8", 0},
    {".md", "text/plain; charset=utf-8", 0},
    {".csv", "text/csv; charset=utf-8", 0},
    {".png", "image/png", 0},
    {".jpg", "image/jpeg", 0},
    {".jpeg", "image/jpeg", 0},
    {".webp", "image/webp", 0},
    {".avif", "image/avif", 0},
    {".gif", "image/gif", 0},
    {".bmp", "image/bmp", 0},
    {".tif", "image/tiff", 0},
    {".tiff", "image/tiff", 0},
    {".exr", "image/x-exr", 0},
    {".glb", "model/gltf-binary", 0},
    {".gltf", "model/gltf+json", 0},
    {".zip", "application/zip", 0},
};

const char *media_type(const char *name, int is_own)
{
    const char *dot = strrchr(name, '.');
    for (size_t k = 0; dot && k < sizeof types / sizeof *types; k++)
        if (strcasecmp(dot, types[k].ending) == 0 && (is_own || !types[k].is_own))
            return types[k].type;
    return "application/octet-stream";
}

/* The digits at *at, which is moved behind them; too many are the largest number. 0: there are none. */
static int read_number(const char **at, unsigned long long *number)
{
    char *end;
    if (**at < '0' || **at > '9')
        return 0;
    *number = strtoull(*at, &end, 10);
    *at = end;
    return 1;
}

int media_range(const char *header, off_t size, off_t *first, off_t *count)
{
    const unsigned long long all = (unsigned long long)size;
    unsigned long long a = 0, b = 0;
    *first = 0;
    *count = size;
    if (!header || strncmp(header, "bytes=", 6) != 0)
        return 0;
    header += 6;
    const int has_first = read_number(&header, &a), is_range = *header == '-';
    header += is_range;
    const int has_last = is_range && read_number(&header, &b);
    if (!is_range || *header || !(has_first || has_last) || (has_first && has_last && b < a))
        return 0;
    if (!has_first) {
        *count = b < all ? (off_t)b : size;
        *first = size - *count;
        return *count > 0 ? 1 : -1;
    }
    if (a >= all)
        return -1;
    *first = (off_t)a;
    *count = has_last && b < all ? (off_t)(b - a) + 1 : size - *first;
    return 1;
}

static Reply no_part(off_t size)
{
    char text[64];
    Reply reply = reply_error(MHD_HTTP_RANGE_NOT_SATISFIABLE, "the file has no such part");
    snprintf(text, sizeof text, "bytes */%lld", (long long)size);
    reply_header(&reply, "Content-Range", text);
    return reply;
}

Reply media_file(const Request *request, int descriptor, const char *type)
{
    char etag[96], text[96];
    struct stat info;
    off_t first, count;
    if (fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(descriptor);
        return reply_error(MHD_HTTP_NOT_FOUND, "this is no file");
    }
    snprintf(etag, sizeof etag, "\"%llx.%llx.%llx.%lx\"", (unsigned long long)info.st_ino,
             (unsigned long long)info.st_size, (unsigned long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    const char *seen = request_header(request, "If-None-Match"), *range_if = request_header(request, "If-Range");
    const int is_seen = seen && strcmp(seen, etag) == 0;
    const char *range = !range_if || strcmp(range_if, etag) == 0 ? request_header(request, "Range") : NULL;
    const int part = media_range(range, info.st_size, &first, &count);
    if (is_seen || part < 0)
        close(descriptor);
    if (part < 0 && !is_seen)
        return no_part(info.st_size);
    Reply reply = is_seen    ? reply_constant(type, "", 0)
                  : part > 0 ? reply_file(MHD_HTTP_PARTIAL_CONTENT, type, descriptor, first, count)
                             : reply_file(MHD_HTTP_OK, type, descriptor, 0, info.st_size);
    if (is_seen)
        reply.status = MHD_HTTP_NOT_MODIFIED;
    snprintf(text, sizeof text, "bytes %lld-%lld/%lld", (long long)first, (long long)(first + count - 1),
             (long long)info.st_size);
    if (part > 0 && !is_seen)
        reply_header(&reply, "Content-Range", text);
    reply_header(&reply, "ETag", etag);
    reply_header(&reply, "Accept-Ranges", "bytes");
    reply_header(&reply, "Cache-Control", "no-cache");
    return reply;
}
