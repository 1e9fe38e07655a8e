/* See balance.h. Levels are rounded on a curve, so that the mean of what they stand for is another one, and the more so
 * the coarser the steps are. Light and gains are multiplied by what restores it: so each lamp, and each finish, keeps
 * its mean in every channel. */
#include "pack/balance.h"

#include <math.h>
#include <stdlib.h>

#include "retexture/enlarge.h"
#include "set/set.h"

int retex_pack_light_of(const RetexSet *set, int part)
{
    int light = -1;
    for (int t = 0; t < set->nterms && part > 0; t++) {
        const RetexTerm *term = &set->terms[t];
        if (term->radiance == part || retex_term_image(term) == part)
            light = term->radiance;
    }
    return light;
}

/* Sums by channel of an image, or of light times a gain, enlarged. */
static int sum_light(double sum[3], const RetexImage *light /* or NULL */, const RetexImage *image, RetexError *err)
{
    const RetexImage *size = light ? light : image;
    const int scale = (size->width + image->width - 1) / image->width;
    float *row = malloc(sizeof *row * 3 * (size_t)size->width);
    sum[0] = sum[1] = sum[2] = 0;
    for (int y = 0; y < size->height && row; y++) {
        retex_enlarge_rows(image, scale, size->width, y, y + 1, row);
        const float *of = light ? light->pixels + retex_image_index(light, 0, y) : NULL;
        for (int i = 0; i < 3 * size->width; i++)
            sum[i % 3] += (double)row[i] * (of ? (double)of[i] : 1);
    }
    free(row);
    return row ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory to compare means of light");
}

int retex_pack_restore_mean(RetexPackCurve *curve, RetexImage *decoded, const RetexImage *image,
                            const RetexImage *light, const RetexImage *decoded_light, double *change, RetexError *err)
{
    double wanted[3], is[3], times[3] = {1, 1, 1};
    *change = 1;
    int code = sum_light(wanted, light, image, err);
    if (!code)
        code = sum_light(is, decoded_light, decoded, err);
    for (int c = 0; c < 3 && !code; c++)
        times[c] = is[c] > 0 && wanted[c] > 0 ? wanted[c] / is[c] : wanted[c] > 0 ? INFINITY : 1;
    for (int c = 0; c < 3 && !code; c++) {
        *change = fmax(*change, fmax(times[c], 1 / times[c]));
        times[c] = isfinite(times[c]) ? times[c] : 1;
        curve->white[c] *= times[c];
    }
    for (size_t i = 0; i < retex_image_index(decoded, 0, decoded->height) && !code; i++)
        decoded->pixels[i] *= (float)times[i % 3];
    return code;
}
