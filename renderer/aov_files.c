/* AOVs as image files. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <retex/host/aov.h>
#include <retex/image_file.h>
#include "base/vec.h"
#include "retex-render.h"
#include "path/sampler.h"

typedef void (*Encode)(RetexImage *image);

static size_t samples(const RetexImage *im)
{
    return (size_t)im->width * (size_t)im->height * (size_t)im->channels;
}

static void encode_signed(RetexImage *im)
{
    for (size_t i = 0; i < samples(im); i++)
        im->pixels[i] = im->pixels[i] * 0.5f + 0.5f;
}

/* Map each channel from its range of finite values to 0…1. */
static void encode_range(RetexImage *im)
{
    size_t n = samples(im), step = (size_t)im->channels;
    for (size_t c = 0; c < step; c++) {
        float low = INFINITY, high = -INFINITY;
        for (size_t i = c; i < n; i += step)
            if (isfinite(im->pixels[i]))
                low = fminf(low, im->pixels[i]), high = fmaxf(high, im->pixels[i]);
        float scale = high > low ? 1 / (high - low) : 0;
        for (size_t i = c; i < n; i += step)
            im->pixels[i] = isfinite(im->pixels[i]) ? (im->pixels[i] - low) * scale : 1;
    }
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

static void encode_exposed(RetexImage *im)
{
    size_t n = samples(im) / 3;
    float *luminance = malloc((n + 1) * sizeof *luminance), bright = 0;
    for (size_t i = 0; i < n && luminance; i++)
        luminance[i] = rgb_luminance(rgb(im->pixels[3 * i], im->pixels[3 * i + 1], im->pixels[3 * i + 2]));
    if (luminance) {
        qsort(luminance, n, sizeof *luminance, compare_floats);
        bright = luminance[(size_t)(0.99 * (double)(n - 1))];
    }
    free(luminance);
    for (size_t i = 0; i < samples(im) && bright > 0; i++)
        im->pixels[i] /= bright;
}

static void encode_fraction(RetexImage *im)
{
    for (size_t i = 0; i < samples(im); i += 3) {
        im->pixels[i] -= floorf(im->pixels[i]);
        im->pixels[i + 1] -= floorf(im->pixels[i + 1]);
        im->pixels[i + 2] = 0;
    }
}

static const Encode encoders[] = {
    [RETEX_AOV_EXPOSED] = encode_exposed,   [RETEX_AOV_SIGNED] = encode_signed, [RETEX_AOV_RANGE] = encode_range,
    [RETEX_AOV_FRACTION] = encode_fraction, [RETEX_AOV_NUMBER] = NULL,
};

/* Image 0 is the beauty image; the AOVs follow. */
enum { PICTURES = 1 + RETEX_AOV_COUNT };

static const char *name_of(int picture)
{
    return picture ? retex_aov_info(picture - 1)->name : "beauty";
}

int aov_files_path(char *path, size_t size, const char *folder, int k)
{
    if (k >= 2 * PICTURES)
        return 0;
    snprintf(path, size, "%s/%s.%s", folder, name_of(k / 2), k % 2 ? "png" : "exr");
    return 1;
}

/* False colours of ids: neighbouring ids get distinct colours, none of them dark. */
static int color_numbers(RetexImage *dst, const RetexImage *src, RetexError *err)
{
    int code = retex_image_alloc(dst, src->width, src->height, 3, err);
    for (size_t i = 0; i < samples(src) && !code; i++) {
        uint32_t number = (uint32_t)src->pixels[i];
        for (uint32_t c = 0; c < 3 && number; c++)
            dst->pixels[3 * i + c] = 0.2f + 0.8f * unit_float(hash_pair(number, c));
    }
    return code;
}

static int write_picture(const RetexSet *set, const char *folder, int k, int nthreads, RetexError *err)
{
    const RetexAov aov = (RetexAov)(k - 1);
    const int part = k ? retex_set_find_part(set, name_of(k)) : 0, is_color = k == 0 || retex_aov_is_color(aov),
              is_number = k && retex_aov_info(aov)->shown == RETEX_AOV_NUMBER;
    if (part < 0)
        return RETEX_OK;
    const RetexImage *image = &retex_set_part(set, part)->image;
    char path[4096];
    RetexImage shown = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    params.is_data = !is_color;
    aov_files_path(path, sizeof path, folder, 2 * k);
    int code = retex_image_write(image, path, &params, nthreads, err);
    if (!code)
        code = is_number ? color_numbers(&shown, image, err) : retex_image_copy(&shown, image, err);
    if (!code && k && encoders[retex_aov_info(aov)->shown])
        encoders[retex_aov_info(aov)->shown](&shown);
    params.colorspace = k == 0 ? NULL : is_color ? "sRGB" : "raw"; /* NULL: the display transform */
    aov_files_path(path, sizeof path, folder, 2 * k + 1);
    if (!code)
        code = retex_image_write(&shown, path, &params, nthreads, err);
    retex_image_free(&shown);
    return code;
}

int aov_files_write(const RetexSet *set, const char *folder, int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < PICTURES && !code; k++)
        code = write_picture(set, folder, k, nthreads, err);
    return code;
}

int aov_files_check(const char *folder, RetexError *err)
{
    char path[4096];
    if (mkdir(folder, 0777) && errno != EEXIST)
        return retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
    snprintf(path, sizeof path, "%s/beauty.png", folder);
    return retex_image_write_check(path, NULL, err);
}
