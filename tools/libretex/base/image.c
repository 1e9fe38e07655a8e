/* Images: memory and regions. Files are read by picture/image_read.c and written by picture/picture.c. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <retex/image.h>

#include "base/image.h"

int retex_image_alloc(RetexImage *im, int width, int height, int channels, RetexError *err)
{
    if (im->pixels)
        return retex_fail(err, RETEX_EINVAL, "the image is allocated already");
    if (width < 1 || height < 1 || width > RETEX_MAX_SIZE || height > RETEX_MAX_SIZE || channels < 1 ||
        channels > RETEX_MAX_CHANNELS)
        return retex_fail(err, RETEX_EINVAL, "an image of %d x %d pixels and %d channels is out of bounds", width,
                          height, channels);
    /* at most 2^16 * 2^16 * 2^6 * 4 = 2^40 bytes: no overflow where size_t has 64 bits */
    const uint64_t bytes = (uint64_t)width * (uint64_t)height * (uint64_t)channels * sizeof(float);
    im->pixels = bytes <= SIZE_MAX ? calloc(1, (size_t)bytes) : NULL;
    if (!im->pixels)
        return retex_fail(err, RETEX_ENOMEM, "no memory for an image of %d x %d pixels and %d channels", width, height,
                          channels);
#ifdef MADV_HUGEPAGE
    /* Page faults of fresh memory cost more than the work on it; huge pages cost less. This is advice only: failure
     * does not matter. */
    if (bytes >= (uint64_t)4 << 20) {
        const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE);
        const uintptr_t begin = ((uintptr_t)im->pixels + page - 1) / page * page;
        const uintptr_t end = ((uintptr_t)im->pixels + (uintptr_t)bytes) / page * page;
        (void)madvise((void *)begin, end - begin, MADV_HUGEPAGE);
    }
#endif
    im->width = width;
    im->height = height;
    im->channels = channels;
    return 0;
}

void retex_image_free(RetexImage *im)
{
    if (!im)
        return;
    free(im->pixels);
    *im = (RetexImage){0, 0, 0, NULL};
}

int retex_image_copy(RetexImage *dst, const RetexImage *src, RetexError *err)
{
    const int code = retex_image_alloc(dst, src->width, src->height, src->channels, err);

    if (!code)
        memcpy(dst->pixels, src->pixels, retex_image_index(src, 0, src->height) * sizeof(float));
    return code;
}

static RetexRoi whole_roi(const RetexImage *im)
{
    return (RetexRoi){0, 0, im->width, im->height, 0, im->channels};
}

static int clamp(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

int retex_image_prepare(RetexImage *dst, int width, int height, int channels, const RetexRoi *roi, RetexRoi *out,
                        RetexError *err)
{
    if (!dst->pixels) {
        const int code = retex_image_alloc(dst, width, height, channels, err);
        if (code)
            return code;
    } else if (dst->width != width || dst->height != height || dst->channels != channels) {
        return retex_fail(err, RETEX_EINVAL,
                          "the destination has %d x %d pixels and %d channels where %d x %d and %d are needed",
                          dst->width, dst->height, dst->channels, width, height, channels);
    }
    *out = whole_roi(dst);
    if (roi) {
        /* a region outside of the image, or with its bounds swapped, becomes empty */
        out->x0 = clamp(roi->x0, 0, width);
        out->y0 = clamp(roi->y0, 0, height);
        out->c0 = clamp(roi->c0, 0, channels);
        out->x1 = clamp(roi->x1, out->x0, width);
        out->y1 = clamp(roi->y1, out->y0, height);
        out->c1 = clamp(roi->c1, out->c0, channels);
    }
    return 0;
}
