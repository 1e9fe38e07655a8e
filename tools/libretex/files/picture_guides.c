/* See picture_guides.h. */
#include "files/picture_guides.h"

#include <math.h>
#include <string.h>

#include <retex/host/denoise_data.h>
#include <retex/host/set_build.h>

#include "set/set.h"

#define FARTHEST 25 /* logarithm of the depth where nothing is hit */

void retex_picture_depth_to_position(RetexImage *depth)
{
    for (int y = 0; y < depth->height; y++)
        for (int x = 0; x < depth->width; x++) {
            float *p = depth->pixels + retex_image_index(depth, x, y);
            const float z = p[0];
            p[0] = (float)x / (float)depth->width;
            p[1] = (float)y / (float)depth->width;
            p[2] = z > 0 && z < 1e9f ? logf(z) : FARTHEST;
        }
}

/* The smaller of the differences to the pixels at both sides. */
static void smaller_difference(float d[3], const RetexImage *im, int x, int y, int dx, int dy)
{
    float least = INFINITY;
    memset(d, 0, 3 * sizeof *d);
    for (int side = -1; side <= 1; side += 2) {
        const int qx = x + side * dx, qy = y + side * dy;
        if (qx < 0 || qx >= im->width || qy < 0 || qy >= im->height)
            continue;
        const float *p = im->pixels + retex_image_index(im, x, y), *q = im->pixels + retex_image_index(im, qx, qy);
        const float e[3] = {(float)side * (q[0] - p[0]), (float)side * (q[1] - p[1]), (float)side * (q[2] - p[2])};
        const float squared = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
        if (squared < least)
            memcpy(d, e, sizeof e), least = squared;
    }
}

int retex_picture_derive_normals(RetexImage *normal, const RetexImage *position, RetexError *err)
{
    const int code = retex_image_alloc(normal, position->width, position->height, 3, err);
    for (int y = 0; y < position->height && !code; y++)
        for (int x = 0; x < position->width; x++) {
            float a[3], b[3], *n = normal->pixels + retex_image_index(normal, x, y);
            smaller_difference(a, position, x, y, 1, 0);
            smaller_difference(b, position, x, y, 0, 1);
            n[0] = a[1] * b[2] - a[2] * b[1], n[1] = a[2] * b[0] - a[0] * b[2], n[2] = a[0] * b[1] - a[1] * b[0];
            const float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
            for (int c = 0; c < 3; c++)
                n[c] = length > 0 && length < INFINITY ? n[c] / length : 0;
        }
    return code;
}

static void move(RetexImage *to, RetexImage *from)
{
    *to = *from;
    *from = (RetexImage){0};
}

int retex_picture_guides_finish(RetexPictureGuides *guides, int has_depth, RetexError *err)
{
    int code = RETEX_OK;
    if (!guides->seen_normal.pixels && !(has_depth && guides->normal.pixels)) { /* one hit only */
        move(&guides->seen_normal, &guides->normal);
        move(&guides->seen_position, &guides->position);
        if (guides->seen_position.pixels && !guides->seen_normal.pixels)
            code = retex_picture_derive_normals(&guides->seen_normal, &guides->seen_position, err);
        return code;
    }
    if (has_depth && !guides->seen_normal.pixels)
        move(&guides->seen_normal, &guides->normal);
    if (has_depth)
        retex_image_free(&guides->normal); /* depths are of no such space */
    if (guides->position.pixels && !guides->normal.pixels)
        code = retex_picture_derive_normals(&guides->normal, &guides->position, err);
    guides->has_first = guides->normal.pixels != NULL;
    return code;
}

void retex_picture_guides_close(RetexPictureGuides *guides)
{
    retex_image_free(&guides->normal);
    retex_image_free(&guides->position);
    retex_image_free(&guides->seen_normal);
    retex_image_free(&guides->seen_position);
    retex_image_free(&guides->albedo);
}

/* ---- the set ---- */

int retex_picture_add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type,
                           const RetexImage *from, float value, RetexError *err)
{
    int part;
    const int code = retex_set_add_part(set, name, letters, type, 0, 0, &part, err);
    if (code)
        return code;
    RetexImage *to = &set->parts[part].image;
    const size_t count = retex_image_index(to, 0, to->height);
    if (from && from->pixels && from->channels == to->channels)
        memcpy(to->pixels, from->pixels, count * sizeof *to->pixels);
    for (size_t i = 0; i < count && value != 0 && !(from && from->pixels); i++)
        to->pixels[i] = value;
    return RETEX_OK;
}

int retex_picture_add_guides(RetexSet *set, const RetexPictureGuides *g, int with_albedo, RetexError *err)
{
    const RetexImage *images[RETEX_FEATURE_COUNT] = {[RETEX_FEATURE_NORMAL] = g->has_first ? &g->normal : NULL,
                                                     [RETEX_FEATURE_POSITION] = g->has_first ? &g->position : NULL,
                                                     [RETEX_FEATURE_SEEN_NORMAL] = &g->seen_normal,
                                                     [RETEX_FEATURE_SEEN_POSITION] = &g->seen_position,
                                                     [RETEX_FEATURE_SEEN_ALBEDO] = with_albedo ? &g->albedo : NULL};
    const float values[RETEX_FEATURE_COUNT] = {[RETEX_FEATURE_SPECULAR] =
                                                   g->has_first ? 1 : 0, /* it counts everywhere */
                                               [RETEX_FEATURE_SEEN_ALBEDO] = 1};
    int code = RETEX_OK;
    for (int k = 0; k < RETEX_FEATURE_COUNT && !code; k++) {
        const RetexFeatureInfo *info = retex_feature_info(k);
        code = retex_picture_add_part(set, info->name, info->letters, info->type, images[k], values[k], err);
    }
    return code;
}

int retex_picture_set(RetexSet **result, const RetexImage *beauty, const RetexImage *noise,
                      const RetexPictureGuides *guides, int with_albedo, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    int code = retex_set_create(result, beauty->width, beauty->height, err);
    RetexSet *set = *result;
    if (code)
        return code;
    strcpy(set->layout, "plain");
    set->spp = 2; /* halves of the same size */
    retex_noise_part_name(name, NULL, RETEX_SIGNAL_BEAUTY);
    code = retex_picture_add_part(set, "beauty", "RGB", RETEX_FLOAT, beauty, 0, err);
    if (!code)
        code = retex_picture_add_part(set, name, "RGB", RETEX_FLOAT, noise, 0, err);
    if (!code)
        code = retex_picture_add_guides(set, guides, with_albedo, err);
    if (code)
        retex_set_close(result);
    return code;
}
