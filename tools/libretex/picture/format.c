/* What picture formats have in common: see format.h. */
#include "picture/format.h"

#include <stdlib.h>
#include <string.h>

#include "picture/srgb_codes.h"

int retex_picture_plan(RetexPicture *picture, RetexError *err)
{
    pthread_mutex_lock(&picture->lock);
    if (picture->loading)
        pthread_join(picture->loader, NULL);
    picture->loading = 0;
    pthread_mutex_unlock(&picture->lock);
    if (!picture->plan && err)
        *err = picture->plan_error;
    return picture->plan ? 0 : picture->plan_error.code;
}

int retex_picture_strip_lines(const RetexPicture *picture, int strip)
{
    const int left = picture->height - strip * RETEX_PICTURE_STRIP;

    return left < RETEX_PICTURE_STRIP ? left : RETEX_PICTURE_STRIP;
}

int retex_picture_append(RetexPicture *picture, const void *data, size_t bytes, RetexError *err)
{
    int code = picture->output ? 0 : retex_output_open(&picture->output, picture->path, err);

    return code ? code : retex_output_write(picture->output, data, bytes, err);
}

int retex_picture_submit_strip(RetexPicture *picture, int strip, unsigned char *data, size_t bytes, RetexError *err)
{
    int code = 0;

    pthread_mutex_lock(&picture->lock);
    picture->strips[strip] = (RetexEncodedStrip){data, bytes, RETEX_STRIP_ENCODED};
    while (!code && picture->next < picture->nstrips && picture->strips[picture->next].state == RETEX_STRIP_ENCODED) {
        RetexEncodedStrip *encoded = &picture->strips[picture->next++];
        if (encoded->data)
            code = retex_picture_append(picture, encoded->data, encoded->bytes, err);
        free(encoded->data);
        encoded->data = NULL;
    }
    pthread_mutex_unlock(&picture->lock);
    return code;
}

/* --- colours --- */

static void to_srgb(void *codes, int bits, const float *values, size_t count)
{
    if (bits == 8)
        retex_srgb_codes_8(codes, values, count);
    else
        retex_srgb_codes_16(codes, values, count);
}

/* RGBA from codes of its colours, and alpha without the curve. */
static void join_alpha(void *codes, int bits, const void *color_codes, const float *rows, size_t pixels)
{
    const size_t bytes = (size_t)bits / 8;
    unsigned char *to = codes;
    const unsigned char *from = color_codes;

    for (size_t i = 0; i < pixels; i++, to += 4 * bytes, from += 3 * bytes) {
        const unsigned alpha = retex_linear_code(rows[4 * i + 3], bits);
        memcpy(to, from, 3 * bytes);
        if (bits == 8)
            to[3] = (unsigned char)alpha;
        else
            memcpy(to + 3 * bytes, &(uint16_t){(uint16_t)alpha}, bytes);
    }
}

/* Converts alpha without the curve, or drops it. */
static int convert_alpha(RetexPicture *picture, void *codes, int bits, int channels, const float *rows, size_t pixels,
                         RetexError *err)
{
    float *colors = malloc(pixels * 3 * sizeof *colors);
    void *color_codes = channels == 3 ? codes : malloc(pixels * 3 * (size_t)bits / 8);
    const int code =
        colors && color_codes ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);

    if (!code) {
        for (size_t i = 0; i < pixels; i++)
            for (size_t c = 0; c < 3; c++)
                colors[3 * i + c] = channels == 3 ? rows[4 * i + c] * rows[4 * i + 3] : rows[4 * i + c];
        retex_view_apply(picture->view, colors, pixels, 3);
        to_srgb(color_codes, bits, colors, 3 * pixels);
        if (channels == 4)
            join_alpha(codes, bits, color_codes, rows, pixels);
    }
    free(colors);
    if (color_codes != codes)
        free(color_codes);
    return code;
}

/* Converts rows by a view that is more than the display's curve. */
static int convert_view(RetexPicture *picture, void *codes, int bits, int channels, const float *rows, size_t pixels,
                        RetexError *err)
{
    const size_t count = pixels * (size_t)channels;
    float *shown = malloc(count * sizeof *shown);

    if (!shown)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    memcpy(shown, rows, count * sizeof *shown);
    retex_view_apply(picture->view, shown, pixels, (size_t)channels);
    to_srgb(codes, bits, shown, count);
    free(shown);
    return 0;
}

int retex_picture_codes(RetexPicture *picture, void *codes, int bits, int channels, const float *rows, int nrows,
                        RetexError *err)
{
    const size_t pixels = (size_t)picture->width * (size_t)nrows;

    if (picture->bridged) {
        const int code = retex_picture_plan(picture, err);
        if (code)
            return code;
        if (!picture->stored.is_srgb)
            return retex_bridge_convert(picture->plan, rows, (long)pixels, codes, err);
    }
    if (picture->channels == 4)
        return convert_alpha(picture, codes, bits, channels, rows, pixels, err);
    if (picture->view == RETEX_VIEW_FILMIC || picture->view == RETEX_VIEW_NEUTRAL)
        return convert_view(picture, codes, bits, channels, rows, pixels, err);
    to_srgb(codes, bits, rows, pixels * (size_t)channels);
    return 0;
}
