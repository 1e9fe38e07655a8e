/* See passed.h. */
#include "denoise/passed.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "set/set.h"

int retex_denoise_passed_open(RetexDenoisePassed *passed, const RetexDenoiser *d, int rows, RetexError *err)
{
    const size_t floats = DENOISE_PASSED * (size_t)rows * (size_t)d->set->width;
    *passed = (RetexDenoisePassed){.rows = rows, .of = calloc((size_t)d->signals.count + 1, sizeof *passed->of)};
    for (int s = 0; passed->of && s < d->signals.count; s++)
        if (!(passed->of[s] = calloc(floats, sizeof(float))))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    return passed->of ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
}

void retex_denoise_passed_close(RetexDenoisePassed *passed, const RetexDenoiser *d)
{
    for (int s = 0; passed->of && s < d->signals.count; s++)
        free(passed->of[s]);
    free(passed->of);
    passed->of = NULL;
}

/* ---- in a file ---- */

/* The offset of an image among the floats of a pixel. */
static int offset_of(RetexPassedImage image)
{
    return image < PASSED_TOTAL ? DENOISE_PASSED_HALVES + 3 * (int)image : DENOISE_PASSED_TOTAL;
}

int retex_passed_store_open(RetexPassedStore *s, const RetexDenoiser *d, RetexError *err)
{
    const int count = PASSED_IMAGES * d->signals.count;
    int code = retex_band_store_create(&s->store, d->set->width, d->set->height, d->set->id, d->params.near, err);
    s->images = calloc((size_t)count + 1, sizeof *s->images);
    if (!code)
        retex_band_store_set_plain(s->store); /* compressing takes longer than writing */
    if (!code && !s->images)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < count && !code; k++) {
        char name[RETEX_NAME_MAX];
        snprintf(name, sizeof name, "passed_%d", k);
        code = retex_band_store_add(s->store, name, "RGB", RETEX_FLOAT, &s->images[k], err);
    }
    return code;
}

void retex_passed_store_close(RetexPassedStore *s)
{
    retex_band_store_close(&s->store);
    free(s->images);
    s->images = NULL;
}

int retex_passed_store_put(RetexPassedStore *s, const RetexDenoiser *d, const RetexDenoisePassed *passed,
                           RetexPassedImage image, int row, int count, int y, RetexError *err)
{
    const size_t width = (size_t)d->set->width;
    float *pixels = malloc(3 * width * RETEX_BAND_ROWS * sizeof *pixels);
    int code = pixels ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < d->signals.count; k++)
        for (int v = 0; v < count && !code; v += RETEX_BAND_ROWS) {
            const float *from = passed->of[k] + DENOISE_PASSED * width * (size_t)(row + v) + offset_of(image);
            const size_t rows = (size_t)(count - v < RETEX_BAND_ROWS ? count - v : RETEX_BAND_ROWS);
            for (size_t i = 0; i < width * rows; i++)
                memcpy(pixels + 3 * i, from + DENOISE_PASSED * i, 3 * sizeof *pixels);
            code = retex_band_store_put(s->store, s->images[PASSED_IMAGES * (d->first_signal + k) + (int)image],
                                        (y + v) / RETEX_BAND_ROWS, pixels, err);
        }
    free(pixels);
    return code;
}

int retex_passed_store_load(const RetexPassedStore *s, const RetexDenoiser *d, RetexDenoisePassed *passed,
                            RetexPassedImage image, int y, RetexError *err)
{
    const size_t width = (size_t)d->set->width;
    float *pixels = malloc(3 * width * RETEX_BAND_ROWS * sizeof *pixels);
    int code = pixels ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < d->signals.count; k++)
        for (int band = y / RETEX_BAND_ROWS; band * RETEX_BAND_ROWS < y + passed->rows && !code; band++) {
            const int begin = band * RETEX_BAND_ROWS;
            code = retex_band_store_load_band(s->store, s->images[PASSED_IMAGES * (d->first_signal + k) + (int)image],
                                              band, pixels, err);
            for (int v = begin; v < begin + RETEX_BAND_ROWS && !code; v++) {
                if (v < y || v >= y + passed->rows)
                    continue;
                float *to = passed->of[k] + DENOISE_PASSED * width * (size_t)(v - y) + offset_of(image);
                for (size_t i = 0; i < width; i++)
                    memcpy(to + DENOISE_PASSED * i, pixels + 3 * (width * (size_t)(v - begin) + i), 3 * sizeof *to);
            }
        }
    free(pixels);
    return code;
}
