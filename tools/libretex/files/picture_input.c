/* See picture_input.h. */
#include "files/picture_input.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "files/picture_noise.h"
#include "exr/rewrite.h"

enum { REPAIR_RADIUS = 3 };

void retex_picture_note(const RetexPictureInput *p, int important, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (p->params.note)
        p->params.note(p->params.note_context, important, text);
}

/* ---- files ---- */

static int open_file(RetexPictureFile *file, const char *path, const RetexAccess *access, RetexError *err)
{
    int code = retex_input_open_allowed(&file->input, path, access, err);
    if (!code)
        code = retex_exr_open(&file->exr, file->input, err);
    if (!code)
        code = retex_exr_rewrite_check(file->exr, err);
    return code ? code : retex_picture_layers_open(&file->layers, file->exr, err);
}

static void close_file(RetexPictureFile *file)
{
    retex_picture_layers_close(&file->layers);
    retex_exr_close(&file->exr);
    retex_input_close(&file->input);
}

const char *retex_picture_input_text(const RetexPictureInput *p, int layer)
{
    return retex_picture_layer_text(&p->file.layers, layer);
}

/* ---- layers ---- */

/* Fails at the first value that is no number. */
static int check_values(const RetexPictureFile *file, int layer, const RetexImage *image, RetexError *err)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                const float value = image->pixels[retex_image_index(image, x, y) + (size_t)c];
                if (!isfinite(value))
                    return retex_fail(err, RETEX_EFORMAT,
                                      "%s: layer %s holds %s at %d,%d: --accept-damaged takes the mean "
                                      "of the pixels around",
                                      retex_input_name(file->input), retex_picture_layer_text(&file->layers, layer),
                                      isnan(value) ? "NaN" : "infinity", x, y);
            }
    return RETEX_OK;
}

/* The mean of the finite values around a pixel; 0 where there are none. */
static float mean_around(const RetexImage *image, int x, int y, int c)
{
    double sum = 0;
    int count = 0;
    for (int radius = 1; radius <= REPAIR_RADIUS && !count; radius++)
        for (int v = y - radius; v <= y + radius; v++)
            for (int u = x - radius; u <= x + radius; u++) {
                if (u < 0 || u >= image->width || v < 0 || v >= image->height)
                    continue;
                const float value = image->pixels[retex_image_index(image, u, v) + (size_t)c];
                if (isfinite(value))
                    sum += value, count++;
            }
    return count ? (float)(sum / count) : 0;
}

static int repair(RetexImage *image, RetexError *err)
{
    RetexImage before = {0};
    const int code = retex_image_copy(&before, image, err);
    for (int y = 0; y < image->height && !code; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                float *value = &image->pixels[retex_image_index(image, x, y) + (size_t)c];
                if (!isfinite(*value))
                    *value = mean_around(&before, x, y, c);
            }
    retex_image_free(&before);
    return code;
}

/* Reads a layer; one channel becomes three equal ones. */
int retex_picture_read_layer(RetexImage *image, const RetexPictureFile *file, int layer, int nthreads, RetexError *err)
{
    const RetexPictureLayer *l = &file->layers.of[layer];
    RetexImage own = {0};
    RetexExrRequest request = {.part = l->part, .image = &own};
    int width, height;
    retex_exr_part_size(file->exr, l->part, &width, &height);
    for (int c = 0; c < l->count; c++)
        snprintf(request.channels[c], sizeof request.channels[c], "%s",
                 retex_exr_channel_name(file->exr, l->part, l->channels[c]));
    int code = retex_image_alloc(&own, width, height, l->count, err);
    if (!code)
        code = retex_exr_read(file->exr, &request, 1, nthreads, err);
    if (!code && l->count == 3) {
        *image = own;
        return code;
    }
    if (!code)
        code = retex_image_alloc(image, width, height, 3, err);
    for (size_t i = 0; i < (size_t)width * (size_t)height && !code; i++)
        image->pixels[3 * i] = image->pixels[3 * i + 1] = image->pixels[3 * i + 2] = own.pixels[i];
    retex_image_free(&own);
    return code;
}

/* 1 if a layer has the picture's size. */
static int has_size(const RetexPictureInput *p, const RetexPictureFile *file, int layer)
{
    int width, height;
    retex_exr_part_size(file->exr, file->layers.of[layer].part, &width, &height);
    return width == p->width && height == p->height;
}

/* The layer in the other half, which must have it: with the same size. */
static int find_in_other(const RetexPictureInput *p, int layer, RetexError *err)
{
    const RetexPictureLayer *l = &p->file.layers.of[layer];
    for (int k = 0; k < p->other.layers.count; k++)
        if (p->other.layers.of[k].count == l->count && strcmp(p->other.layers.of[k].name, l->name) == 0) {
            if (!has_size(p, &p->other, k))
                return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels, as in %s",
                                  retex_input_name(p->other.input), retex_picture_input_text(p, layer), p->width,
                                  p->height, retex_input_name(p->file.input));
            return k;
        }
    return retex_fail(err, RETEX_ENOTFOUND, "%s has no layer %s, as %s has", retex_input_name(p->other.input),
                      retex_picture_input_text(p, layer), retex_input_name(p->file.input));
}

int retex_picture_read_checked(RetexImage *image, const RetexPictureInput *p, const RetexPictureFile *file, int layer,
                               RetexError *err)
{
    int code = retex_picture_read_layer(image, file, layer, p->nthreads, err);
    if (code)
        return code;
    return p->params.access && p->params.access->accept_damaged ? repair(image, err)
                                                                : check_values(file, layer, image, err);
}

int retex_picture_check_layer(const RetexPictureInput *p, int layer, RetexError *err)
{
    const RetexPictureLayer *l = &p->file.layers.of[layer];
    RetexPixelType type;
    for (int c = 0; c < l->count; c++)
        if (!retex_exr_channel_type(p->file.exr, l->part, retex_exr_channel_name(p->file.exr, l->part, l->channels[c]),
                                    &type))
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s: layer %s holds integers, which are not denoised",
                              retex_input_name(p->file.input), retex_picture_input_text(p, layer));
    if (!has_size(p, &p->file, layer))
        return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", retex_input_name(p->file.input),
                          retex_picture_input_text(p, layer), p->width, p->height);
    return RETEX_OK;
}

/* ---- guides ---- */

/* The layer of a guide: by the name that the user gave, or else a well known one; -1: none. */
static int find_guide(const RetexPictureInput *p, const char *name, RetexPictureGuide guide, int *layer,
                      RetexError *err)
{
    const char *file = retex_input_name(p->file.input);
    *layer = name ? retex_picture_layer_named(&p->file.layers, name, file, err)
                  : retex_picture_layer_known(&p->file.layers, guide, p->beauty);
    if (name && *layer < 0)
        return *layer;
    if (*layer >= 0 && !has_size(p, &p->file, *layer)) {
        if (name)
            return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", file,
                              retex_picture_input_text(p, *layer), p->width, p->height);
        *layer = -1;
    }
    return RETEX_OK;
}

/* Reads a guide, of both halves their mean. */
static int load_guide(RetexImage *image, RetexPictureInput *p, int layer, const char *as, char *used, size_t size,
                      RetexError *err)
{
    if (layer < 0)
        return RETEX_OK;
    const size_t length = strlen(used);
    snprintf(used + length, size - length, "%s%s %s", length ? ", " : "", as, retex_picture_input_text(p, layer));
    int code = retex_picture_read_layer(image, &p->file, layer, p->nthreads, err);
    const int other = p->other.exr && !code ? find_in_other(p, layer, NULL) : -1;
    RetexImage second = {0};
    if (other >= 0 && !code)
        code = retex_picture_read_layer(&second, &p->other, other, p->nthreads, err);
    for (size_t i = 0; other >= 0 && !code && i < retex_image_index(image, 0, image->height); i++)
        image->pixels[i] = 0.5f * (image->pixels[i] + second.pixels[i]);
    retex_image_free(&second);
    for (size_t i = 0; !code && i < retex_image_index(image, 0, image->height); i++)
        if (!(fabsf(image->pixels[i]) < 1e30f))
            image->pixels[i] = 0;
    return code;
}

int retex_picture_load_guides(RetexPictureInput *p, RetexError *err)
{
    const RetexDenoisePictureParams *given = &p->params;
    RetexPictureGuides *g = &p->guides;
    int normal = -1, seen = -1, albedo = -1, position = -1, depth = -1;
    char used[1024] = "";
    int code = find_guide(p, given->normal, RETEX_PICTURE_NORMAL, &normal, err);
    if (!code && !given->normal)
        code = find_guide(p, NULL, RETEX_PICTURE_SEEN_NORMAL, &seen, err);
    if (!code)
        code = find_guide(p, given->albedo, RETEX_PICTURE_ALBEDO, &albedo, err);
    if (!code)
        code = find_guide(p, given->position, RETEX_PICTURE_POSITION, &position, err);
    if (!code && (given->depth || position < 0))
        code = find_guide(p, given->depth, RETEX_PICTURE_DEPTH, &depth, err);
    if (position >= 0)
        depth = given->depth && !given->position ? depth : -1;
    if (depth >= 0)
        position = -1;
    if (!code)
        code = load_guide(&g->normal, p, normal, "normal", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->seen_normal, p, seen, "normal", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->albedo, p, albedo, "albedo", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->position, p, depth >= 0 ? depth : position, depth >= 0 ? "depth" : "position", used,
                          sizeof used, err);
    if (!code && depth >= 0)
        retex_picture_depth_to_position(&g->position);
    if (!code)
        retex_picture_note(p, 0, "guides: %s", *used ? used : "none");
    return code ? code : retex_picture_guides_finish(g, depth >= 0, err);
}

/* ---- noise ---- */

/* The mean of both halves, and half of their difference. */
static int split_halves(RetexImage *image, RetexImage *noise, RetexPictureInput *p, int layer, RetexError *err)
{
    const int other = find_in_other(p, layer, err);
    int code = other < 0 ? other : retex_picture_read_checked(noise, p, &p->other, other, err);
    for (size_t i = 0; !code && i < retex_image_index(image, 0, image->height); i++) {
        const float a = image->pixels[i], b = noise->pixels[i];
        image->pixels[i] = 0.5f * (a + b);
        noise->pixels[i] = 0.5f * (a - b);
        p->halves_differ |= a != b;
    }
    return code;
}

static int read_variance(RetexImage *noise, const RetexPictureInput *p, RetexError *err)
{
    const int layer =
        retex_picture_layer_named(&p->file.layers, p->params.variance, retex_input_name(p->file.input), err);
    if (layer < 0)
        return layer;
    if (!has_size(p, &p->file, layer))
        return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", retex_input_name(p->file.input),
                          retex_picture_input_text(p, layer), p->width, p->height);
    return retex_picture_read_checked(noise, p, &p->file, layer, err);
}

int retex_picture_estimate_noise(RetexImage *noise, const RetexImage *image, const RetexPictureInput *p, int seed,
                                 int with_albedo, RetexError *err)
{
    const int code = retex_picture_estimate_variance(
        noise, image, p->guides.seen_normal.pixels ? &p->guides.seen_normal : NULL,
        with_albedo && p->guides.albedo.pixels ? &p->guides.albedo : NULL, p->nthreads, err);
    if (!code)
        retex_picture_draw_noise(noise, (uint32_t)seed, p->nthreads);
    return code;
}

int retex_picture_find_noise(RetexImage *image, RetexImage *noise, RetexPictureInput *p, int layer, int with_albedo,
                             RetexError *err)
{
    if (p->other.exr)
        return split_halves(image, noise, p, layer, err);
    if (!p->params.variance)
        return retex_picture_estimate_noise(noise, image, p, layer, with_albedo, err);
    const int code = read_variance(noise, p, err);
    if (!code)
        retex_picture_draw_noise(noise, (uint32_t)layer, p->nthreads);
    return code;
}

/* ---- the input ---- */

int retex_picture_input_open(RetexPictureInput *p, const char *path, RetexError *err)
{
    int code = RETEX_OK;
    if (p->params.other_half && p->params.variance)
        code = retex_fail(err, RETEX_EINVAL, "a second half tells the noise: a variance is not used with it");
    if (!code)
        code = open_file(&p->file, path, p->params.access, err);
    if (!code && p->params.other_half)
        code = open_file(&p->other, p->params.other_half, p->params.access, err);
    return code;
}

void retex_picture_input_close(RetexPictureInput *p)
{
    retex_picture_guides_close(&p->guides);
    close_file(&p->file);
    close_file(&p->other);
}

void retex_picture_note_noise(const RetexPictureInput *p)
{
    if (!p->other.exr && p->params.variance)
        retex_picture_note(p, 0, "the layer %s is taken as the variance of each pixel's mean", p->params.variance);
    if (!p->other.exr && !p->params.variance)
        retex_picture_note(
            p, 1,
            "the noise is estimated from the picture itself: what no guide shows may be taken for noise; "
            "--other-half is better");
}

int retex_picture_check_halves(const RetexPictureInput *p, RetexError *err)
{
    if (!p->other.exr || p->halves_differ)
        return RETEX_OK;
    return retex_fail(err, RETEX_EINVAL, "%s is the same render as %s: the other half needs another seed",
                      retex_input_name(p->other.input), retex_input_name(p->file.input));
}
