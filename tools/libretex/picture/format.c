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

int retex_picture_band_lines(const RetexPicture *picture, int band)
{
    const int left = picture->height - band * RETEX_PICTURE_BAND;

    return left < RETEX_PICTURE_BAND ? left : RETEX_PICTURE_BAND;
}

int retex_picture_append(RetexPicture *picture, const void *data, size_t bytes, RetexError *err)
{
    int status = picture->output ? 0 : retex_output_open(&picture->output, picture->path, err);

    return status ? status : retex_output_write(picture->output, data, bytes, err);
}

int retex_picture_submit_band(RetexPicture *picture, int band, unsigned char *data, size_t bytes, RetexError *err)
{
    int status = 0;

    pthread_mutex_lock(&picture->lock);
    picture->bands[band] = (RetexEncodedBand){data, bytes, RETEX_BAND_ENCODED};
    while (!status && picture->next < picture->nbands && picture->bands[picture->next].state == RETEX_BAND_ENCODED) {
        RetexEncodedBand *encoded = &picture->bands[picture->next++];
        if (encoded->data)
            status = retex_picture_append(picture, encoded->data, encoded->bytes, err);
        free(encoded->data);
        encoded->data = NULL;
    }
    pthread_mutex_unlock(&picture->lock);
    return status;
}

/* --- colours --- */

/* Converts alpha without the curve, or drops it. */
static int convert_alpha(RetexPicture *picture, uint8_t *codes, int channels, const float *rows, size_t pixels,
                         RetexError *err)
{
    float *colors = malloc(pixels * 3 * sizeof *colors);
    uint8_t *color_codes = channels == 3 ? codes : malloc(pixels * 3);
    const int status =
        colors && color_codes ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);

    if (!status) {
        for (size_t i = 0; i < pixels; i++)
            for (size_t c = 0; c < 3; c++)
                colors[3 * i + c] = channels == 3 ? rows[4 * i + c] * rows[4 * i + 3] : rows[4 * i + c];
        retex_srgb_codes_8(color_codes, colors, 3 * pixels);
        for (size_t i = 0; channels == 4 && i < pixels; i++) {
            memcpy(codes + 4 * i, color_codes + 3 * i, 3);
            codes[4 * i + 3] = (uint8_t)retex_linear_code(rows[4 * i + 3], 8);
        }
    }
    free(colors);
    if (color_codes != codes)
        free(color_codes);
    return status;
}

int retex_picture_codes_8(RetexPicture *picture, uint8_t *codes, int channels, const float *rows, int nrows,
                          RetexError *err)
{
    const size_t pixels = (size_t)picture->width * (size_t)nrows;

    if (picture->bridged) {
        const int status = retex_picture_plan(picture, err);
        if (status)
            return status;
        if (!picture->stored.is_srgb)
            return retex_bridge_convert(picture->plan, rows, (long)pixels, codes, err);
    }
    if (picture->channels == 4)
        return convert_alpha(picture, codes, channels, rows, pixels, err);
    retex_srgb_codes_8(codes, rows, pixels * (size_t)channels);
    return 0;
}
