/* See picture_kind.h. */
#include "common/picture_kind.h"

#include <string.h>
#include <strings.h>

const char *const picture_endings[] = {"jpg", "jpeg", "png", "exr", "tif",  "tiff",
                                       "hdr", "tga",  "bmp", "gif", "webp", NULL};

static const PictureKind kinds[] = {
    {"jpg", "jpeg", "image/jpeg", "\xff\xd8\xff", 3, 0},
    {"png", NULL, "image/png", "\x89PNG\r\n\x1a\n", 8, 0},
    {"exr", NULL, "image/x-exr", "\x76\x2f\x31\x01", 4, 0},
    {"tif", "tiff", "image/tiff", "II*\0", 4, 0},
    {"tif", "tiff", "image/tiff", "MM\0*", 4, 0},
    {"bmp", NULL, "image/bmp", "BM", 2, 0},
    {"gif", NULL, "image/gif", "GIF8", 4, 0},
    {"hdr", NULL, "image/vnd.radiance", "#?RADIANCE", 10, 0},
    {"hdr", NULL, "image/vnd.radiance", "#?RGBE", 6, 0},
    {"webp", NULL, "image/webp", "WEBP", 4, 8},
    {"tga", NULL, "image/x-tga", NULL, 0, 0},
    {"pfm", NULL, "image/x-portable-floatmap", NULL, 0, 0},
    {"avif", NULL, "image/avif", NULL, 0, 0},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

const PictureKind *picture_kind_of_name(const char *name)
{
    const char *dot = strrchr(name, '.');
    for (int k = 0; dot && k < KINDS; k++)
        if (strcasecmp(dot + 1, kinds[k].ending) == 0 || (kinds[k].also && strcasecmp(dot + 1, kinds[k].also) == 0))
            return &kinds[k];
    return NULL;
}

const PictureKind *picture_kind_of_bytes(const void *bytes, size_t count)
{
    for (int k = 0; k < KINDS; k++)
        if (kinds[k].mark && count > kinds[k].at + kinds[k].length &&
            memcmp((const char *)bytes + kinds[k].at, kinds[k].mark, kinds[k].length) == 0)
            return &kinds[k];
    return NULL;
}
