/* See finish_map.h. */
#include "texture/finish_map.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "texture/interpolate.h"
#include "texture/normal_map.h"

#define GREY_DIFFERENCE 0.0101f /* of channels: 2.5 of 255, for JPEG stores colours and not grey */

/* ---- weights ---- */

int retex_finish_map_has_scale(const RetexTextureSpec *spec)
{
    int count = 0;
    for (int k = 0; k < spec->nfinishes && k < RETEX_FINISHES_MAX; k++)
        count += spec->roughness[k] >= 0;
    return count > 1;
}

static float clamped(float x)
{
    return x > 0 ? x < 1 ? x : 1 : 0; /* NaN becomes 0 */
}

/* Between the next smoother and the next rougher finish. */
static void weigh_roughness(const RetexTextureSpec *spec, float roughness, float weights[RETEX_FINISHES_MAX])
{
    int below = -1, above = -1;
    for (int k = 0; k < spec->nfinishes; k++) {
        const float own = spec->roughness[k];
        if (own >= 0 && own <= roughness && (below < 0 || own > spec->roughness[below]))
            below = k;
        if (own >= 0 && own > roughness && (above < 0 || own < spec->roughness[above]))
            above = k;
    }
    if (below < 0 || above < 0) {
        weights[below < 0 ? above : below] = 1;
        return;
    }
    const float low = spec->roughness[below], high = spec->roughness[above];
    weights[above] = (roughness - low) / (high - low);
    weights[below] = 1 - weights[above];
}

static void weigh_grey(int nfinishes, float value, float weights[RETEX_FINISHES_MAX])
{
    const float at = clamped(value) * (float)(nfinishes - 1);
    const int below = at < (float)(nfinishes - 2) ? (int)at : nfinishes - 2;
    weights[below + 1] = at - (float)below;
    weights[below] = 1 - weights[below + 1];
}

static void weigh_colors(int nfinishes, const float rgb[3], float weights[RETEX_FINISHES_MAX])
{
    float sum = 0;
    for (int k = 1; k < nfinishes; k++)
        sum += weights[k] = clamped(rgb[k - 1]);
    for (int k = 1; k < nfinishes && sum > 1; k++)
        weights[k] /= sum;
    weights[0] = sum < 1 ? 1 - sum : 0;
}

void retex_finish_map_weights(const RetexTextureSpec *spec, RetexFinishScale scale, int channel, int is_grey,
                              const float rgb[3], float weights[RETEX_FINISHES_MAX])
{
    memset(weights, 0, RETEX_FINISHES_MAX * sizeof *weights);
    if (scale == RETEX_FINISH_BY_LIST && is_grey)
        weigh_grey(spec->nfinishes, rgb[0], weights);
    else if (scale == RETEX_FINISH_BY_LIST)
        weigh_colors(spec->nfinishes, rgb, weights);
    else
        weigh_roughness(spec, scale == RETEX_FINISH_BY_GLOSS ? 1 - clamped(rgb[channel]) : clamped(rgb[channel]),
                        weights);
}

/* ---- texels ---- */

/* Texels of a map: the weights of the second finish and of later ones; the last number is 1. */
typedef struct WeightWork {
    const RetexTextureSpec *spec;
    RetexFinishScale scale;
    int channel, width;
    const RetexImage *map;
    atomic_int colored;
    const RetexTexels *weights;
} WeightWork;

static void find_colors_job(void *context, int y, int thread)
{
    WeightWork *work = context;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const float *p = work->map->pixels + 4 * ((size_t)y * (size_t)work->width + (size_t)x);
        if (fabsf(p[0] - p[1]) > GREY_DIFFERENCE || fabsf(p[1] - p[2]) > GREY_DIFFERENCE)
            atomic_store(&work->colored, 1);
    }
}

static void weigh_job(void *context, int y, int thread)
{
    WeightWork *work = context;
    (void)thread;
    for (int x = 0; x < work->width; x++) {
        const size_t i = (size_t)y * (size_t)work->width + (size_t)x;
        float weights[RETEX_FINISHES_MAX];
        retex_finish_map_weights(work->spec, work->scale, work->channel, !work->colored, work->map->pixels + 4 * i,
                                 weights);
        retex_texture_store_texel(work->weights, i, (const float[4]){weights[1], weights[2], weights[3], 1});
    }
}

/* Where texel i of an axis of so many lies in an image of other size. */
static RetexBetween texel_between(int i, int of, int texels, RetexWrap wrap)
{
    return retex_between((i + 0.5) * texels / of, texels, wrap);
}

/* Colour times weight of each finish, and the weights themselves, at one size. */
typedef struct ProductWork {
    const RetexTextureSpec *spec;
    const RetexTexels *color; /* NULL: a constant */
    RetexTexels map;
    RetexBetween *color_x, *map_x;                /* by column */
    RetexTexels products[RETEX_FINISHES_MAX + 1]; /* the last: the weights */
    int count, is_normal, repeats[2];
} ProductWork;

/* Of the colour at one size with all repeats, which it has not itself. */
static RetexBetween between_repeats(const ProductWork *work, int axis, int i, int of, int texels)
{
    const int repeats = work->repeats[axis];
    int unused;
    return texel_between(retex_normal_map_texel(axis, i, of / repeats, repeats, &unused), of / repeats, texels,
                   work->spec->wrap[axis]);
}

/* Of the map, which has them. */
static RetexBetween between_weights(const ProductWork *work, int axis, int i, int of)
{
    return texel_between(i, of, axis ? work->map.height : work->map.width,
                   work->repeats[axis] == 2 ? RETEX_WRAP_REPEAT : work->spec->wrap[axis]);
}

static void multiply_job(void *context, int y, int thread)
{
    ProductWork *work = context;
    const int width = work->products[0].width, height = work->products[0].height;
    const RetexBetween color_y = work->color ? between_repeats(work, 1, y, height, work->color->height)
                                             : (RetexBetween){0, 0, 0},
                       map_y = between_weights(work, 1, y, height);
    (void)thread;
    for (int x = 0; x < width; x++) {
        const size_t at = (size_t)y * (size_t)width + (size_t)x;
        float color[4] = {work->spec->color[0], work->spec->color[1], work->spec->color[2], 1}, weights[4], product[4];
        if (work->color)
            retex_interpolate(work->color, work->color_x[x], color_y, color);
        retex_interpolate(&work->map, work->map_x[x], map_y, weights);
        float first = 1;
        for (int c = 0; c < 3; c++) {
            first -= weights[c];
            product[c] = weights[c] * color[3];
        }
        product[3] = color[3];
        retex_texture_store_texel(&work->products[work->count], at, product);
        for (int k = 0; k < work->count; k++) {
            for (int c = 0; c < 3; c++)
                product[c] = color[c] * (k ? weights[k - 1] : work->is_normal ? first : fmaxf(first, 0));
            retex_texture_store_texel(&work->products[k], at, product);
        }
    }
}

/* ---- making one ---- */

static int no_memory(const RetexTexture *texture, RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory for the finishes of %s", texture->spec.target);
}

static int is_normal_map(RetexFinishScale scale)
{
    return scale == RETEX_FINISH_BY_NORMAL || scale == RETEX_FINISH_BY_NORMAL_DX;
}

static int weigh(const RetexTexture *texture, const RetexImage *map, RetexFinishScale scale, int channel,
                 const int repeats[2], RetexTexels *weights, int nthreads, RetexError *err)
{
    *weights = (RetexTexels){repeats[0] * map->width, repeats[1] * map->height, !is_normal_map(scale), NULL};
    if (retex_texels_alloc(weights))
        return no_memory(texture, err);
    if (is_normal_map(scale)) {
        retex_normal_map_weigh(&texture->spec, map, scale == RETEX_FINISH_BY_NORMAL_DX, weights, nthreads);
        return RETEX_OK;
    }
    WeightWork work = {&texture->spec, scale, channel, weights->width, map, 0, weights};
    retex_parallel(nthreads, weights->height, find_colors_job, &work);
    retex_parallel(nthreads, weights->height, weigh_job, &work);
    return RETEX_OK;
}

/* has_joints: the product is of the first finish, which joints between repeats have. */
static int make_texture(RetexTexture **made, const RetexTextureSpec *spec, const int repeats[2], RetexTexels *texels,
                        int has_joints, int nthreads, RetexError *err)
{
    RetexTextureSpec own = *spec;
    if (!has_joints)
        memset(own.grout_color, 0, sizeof own.grout_color);
    *made = retex_texture_new(&own, err);
    if (!*made)
        return err->code;
    for (int axis = 0; axis < 2; axis++)
        (*made)->repeats[axis] = repeats[axis];
    const int code = retex_texture_set_texels(*made, texels, NULL, 0, nthreads, err);
    if (!code) /* it is found by the specification of the whole */
        memcpy((*made)->spec.grout_color, spec->grout_color, sizeof spec->grout_color);
    return code;
}

static int make_products(RetexTexture *texture, ProductWork *work, int nthreads, RetexError *err)
{
    const RetexTexels *color = work->color;
    const int *repeats = work->repeats, least_width = color ? repeats[0] * color->width : 0,
              least_height = color ? repeats[1] * color->height : 0;
    const int width = least_width > work->map.width ? least_width : work->map.width,
              height = least_height > work->map.height ? least_height : work->map.height;
    const RetexTextureSpec spec =
        retex_texture_finish_spec(&texture->spec, color ? color->width : width / repeats[0],
                                  color ? color->height : height / repeats[1], work->is_normal);
    RetexFinishMap *finishes = texture->finishes;
    int code = RETEX_OK;
    for (int k = 0; k <= work->count && !code; k++) {
        work->products[k] =
            (RetexTexels){width, height, !work->is_normal && (k == work->count || (color && color->narrow)), NULL};
        if (retex_texels_alloc(&work->products[k]))
            code = no_memory(texture, err);
    }
    work->color_x = calloc((size_t)width, sizeof *work->color_x);
    work->map_x = calloc((size_t)width, sizeof *work->map_x);
    if (!code && (!work->color_x || !work->map_x))
        code = no_memory(texture, err);
    for (int x = 0; x < width && !code; x++) {
        work->color_x[x] = between_repeats(work, 0, x, width, color ? color->width : width / repeats[0]);
        work->map_x[x] = between_weights(work, 0, x, width);
    }
    if (!code)
        retex_parallel(nthreads, height, multiply_job, work);
    free(work->color_x);
    free(work->map_x);
    for (int k = 0; k <= work->count && !code; k++)
        code = make_texture(k < work->count ? &finishes->colors[k] : &finishes->weights, &spec, repeats,
                            &work->products[k], k == 0, nthreads, err);
    for (int k = 0; k <= work->count; k++)
        free(work->products[k].texels);
    return code;
}

int retex_finish_map_make(RetexTexture *texture, const RetexTexels *color, const RetexImage *map,
                          RetexFinishScale scale, int channel, int nthreads, RetexError *err)
{
    ProductWork work = {.spec = &texture->spec,
                        .color = color,
                        .count = texture->spec.nfinishes,
                        .is_normal = is_normal_map(scale),
                        .repeats = {1, 1}};
    RetexError why = {0};
    if (!(texture->finishes = calloc(1, sizeof *texture->finishes)))
        return no_memory(texture, err);
    texture->finishes->count = work.count;
    texture->finishes->is_normal = work.is_normal;
    if (work.is_normal)
        retex_normal_map_repeats(&texture->spec, work.repeats);
    int code = weigh(texture, map, scale, channel, work.repeats, &work.map, nthreads, &why);
    if (!code)
        code = make_products(texture, &work, nthreads, &why);
    free(work.map.texels);
    if (code && err)
        *err = why;
    return code;
}
