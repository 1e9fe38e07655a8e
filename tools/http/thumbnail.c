/* See thumbnail.h. */
#include "thumbnail.h"

#include <math.h>
#include <stdlib.h>

#include <retex/picture.h>

/* 0 to 1, which is all that is shown; what is no number is black. */
static float shown(float value)
{
    return value > 0 ? fminf(value, 1) : 0;
}

static void lay_over_white(float *rgb, const float *rgba, int width)
{
    for (int x = 0; x < width; x++, rgb += 3, rgba += 4) {
        const float alpha = shown(rgba[3]);
        for (int c = 0; c < 3; c++)
            rgb[c] = shown(rgba[c]) * alpha + (1 - alpha);
    }
}

static int shrink(const RetexImage *image, const RetexCut *place, int nthreads, RetexImage *small, RetexError *err)
{
    RetexShrink *shrinking = NULL;
    float *row = malloc(3 * (size_t)image->width * sizeof *row);
    int code = row ? retex_shrink_open(&shrinking, place, image->width, err)
                   : retex_fail(err, RETEX_ENOMEM, "not enough memory for a thumbnail");
    for (int y = 0; y < image->height && !code; y++) {
        lay_over_white(row, image->pixels + retex_image_index(image, 0, y), image->width);
        code = retex_shrink_rows(shrinking, y, y + 1, row, err);
    }
    if (!code)
        code = retex_shrink_take(&shrinking, small, nthreads, err);
    retex_shrink_close(&shrinking);
    free(row);
    return code;
}

int thumbnail_make(const RetexImage *image, const RetexCut *place, const char *extension, int quality, int nthreads,
                   void **data, size_t *bytes, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexPicture *picture = NULL;
    RetexImage small = {0};
    params.quality = quality;
    if (getenv("OCIO")) /* whose display may have a look of its own, which is for light and not for images */
        params.colorspace = "sRGB";
    int code = shrink(image, place, nthreads, &small, err);
    if (!code)
        code = retex_picture_open_memory(&picture, extension, small.width, small.height, 3, &params, err);
    if (!code)
        code = retex_picture_image(picture, &small, nthreads, err);
    if (!code)
        code = retex_picture_take(&picture, data, bytes, err);
    retex_picture_close(&picture, 0, NULL);
    retex_image_free(&small);
    return code;
}
