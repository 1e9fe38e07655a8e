/* See media.h. */
#include "media.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/picture_kind.h"
#include "http/headers.h"

/* What the page is made of. */
static const struct {
    const char *ending, *type;
} page_types[] = {
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
};

const char *media_type(const char *name, int is_page)
{
    const char *dot = strrchr(name, '.');
    const PictureKind *picture = picture_kind_of_name(name);
    for (size_t k = 0; is_page && dot && k < sizeof page_types / sizeof *page_types; k++)
        if (strcmp(dot, page_types[k].ending) == 0)
            return page_types[k].type;
    return dot && strcasecmp(dot, ".json") == 0 ? "application/json"
           : picture                            ? picture->type
                                                : "application/octet-stream";
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
    size_t first = 0, last = 0;
    if (fstat(descriptor, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(descriptor);
        return reply_error(MHD_HTTP_NOT_FOUND, "this is no file");
    }
    snprintf(etag, sizeof etag, "\"%llx.%llx.%llx.%lx\"", (unsigned long long)info.st_ino,
             (unsigned long long)info.st_size, (unsigned long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    const char *seen = request_header(request, "If-None-Match"), *range_if = request_header(request, "If-Range");
    const int is_seen = header_has_etag(seen, etag);
    const char *range = !range_if || strcmp(range_if, etag) == 0 ? request_header(request, "Range") : NULL;
    const RangeKind part = header_range(range, (size_t)info.st_size, &first, &last);
    if (is_seen || part == RANGE_OUTSIDE)
        close(descriptor);
    if (part == RANGE_OUTSIDE && !is_seen)
        return no_part(info.st_size);
    Reply reply = is_seen ? reply_constant(type, "", 0)
                  : part == RANGE_SOME
                      ? reply_file(MHD_HTTP_PARTIAL_CONTENT, type, descriptor, (off_t)first, (off_t)(last - first + 1))
                      : reply_file(MHD_HTTP_OK, type, descriptor, 0, info.st_size);
    if (is_seen)
        reply.status = MHD_HTTP_NOT_MODIFIED;
    snprintf(text, sizeof text, "bytes %zu-%zu/%lld", first, last, (long long)info.st_size);
    if (part == RANGE_SOME && !is_seen)
        reply_header(&reply, "Content-Range", text);
    reply_header(&reply, "ETag", etag);
    reply_header(&reply, "Accept-Ranges", "bytes");
    reply_header(&reply, "Cache-Control", "no-cache");
    return reply;
}
