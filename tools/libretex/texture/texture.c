/* Textures: loading, placement, and the transform from surface UV to texels. A file becomes premultiplied RGBA: 16-bit
 * integers where the file has integers, else floats. The pyramid is in pyramid_kernel.c, look-ups of
 * points in point_kernel.c, of footprints in batch.c. */
#include "base/params.h"
#include "texture/adjust.h"
#include "texture/lay.h"
#include "texture/layer.h"

#include <math.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/texture_lookup.h>
#include <retex/color_text.h>
#include <retex/parallel.h>

#define LEAST_ALPHA 1e-20f /* alpha below this has no colour that a float can hold */

static int no_memory(const RetexTexture *texture, int width, int height, RetexError *err)
{
    return retex_fail_at(err, RETEX_ENOMEM, texture->spec.image, 0, 0,
                         "not enough memory for a texture of %d x %d texels", width, height);
}

/* Fits the repeats around a surface that closes: see <retex/texture.h>. before: units of width for a unit of UV. */
static void fit_repeats(const RetexTexture *texture, double before[2], const double after[2])
{
    const RetexTextureSpec *spec = &texture->spec;
    const double quarters = spec->rotate / 90;

    for (int axis = 0; axis < 2; axis++) {
        const int of = fmod(quarters, 2) == 0 ? axis : !axis; /* the texture's axis that lies along it */
        const RetexWrap wrap = spec->wrap[of];
        if (!spec->periodic[axis] || quarters != rint(quarters) ||
            (wrap != RETEX_WRAP_REPEAT && wrap != RETEX_WRAP_MIRROR))
            continue;
        const double period = wrap == RETEX_WRAP_MIRROR ? 2 : texture->repeats[of],
                     around = before[axis] * after[of] / period;
        before[axis] *= fmax(1, rint(fabs(around))) / fabs(around);
    }
}

/* What a unit of the surface's u or v measures, in the unit of the texture's lengths. */
static double length_of_uv(const RetexTextureSpec *spec, int axis)
{
    return spec->uv_scale[axis] * (spec->metric ? spec->unit : 1);
}

/* What is added to the texture's UV: the offset, and what moves the middle of the image to where it is to be. */
static void place_middle(const RetexTexture *texture, const double after[2], double turn[2][2], const double before[2],
                         double place[2])
{
    const RetexTextureSpec *spec = &texture->spec;
    memcpy(place, spec->offset, sizeof spec->offset);
    for (int axis = 0; axis < 2 && spec->has_at; axis++) {
        place[axis] += 0.5;
        for (int i = 0; i < 2; i++)
            place[axis] -= after[axis] * turn[axis][i] * before[i] *
                           (spec->width[0] > 0 ? spec->at[i] / length_of_uv(spec, i) : spec->at[i]);
    }
}

/* Combines the spec's placement into one matrix and offset, for an image of that size. */
static void set_transform(RetexTexture *texture, int width, int height)
{
    const RetexTextureSpec *spec = &texture->spec;
    double angle = fmod(spec->rotate, 360) * M_PI / 180, c = cos(angle), s = sin(angle);
    if (fmod(spec->rotate, 90) == 0) { /* quarter turns are exact */
        c = rint(c);
        s = rint(s);
    }
    double before[2] = {spec->scale[0], spec->scale[1]}, after[2] = {1, 1}, turn[2][2] = {{c, -s}, {s, c}};
    if (spec->width[0] > 0) {
        double size[2] = {spec->width[0], spec->width[1] > 0 ? spec->width[1] : spec->width[0] * height / width};
        for (int axis = 0; axis < 2; axis++) {
            before[axis] *= length_of_uv(spec, axis);
            after[axis] = 1 / size[axis];
        }
        fit_repeats(texture, before, after);
    }
    double place[2];
    place_middle(texture, after, turn, before, place);
    for (int axis = 0; axis < 2; axis++) {
        double sign = spec->flip[axis] ? -1 : 1, share = 1 / texture->repeats[axis];
        for (int i = 0; i < 2; i++)
            texture->matrix[axis][i] = sign * share * after[axis] * turn[axis][i] * before[i];
        texture->offset[axis] = share * (spec->flip[axis] ? 1 - place[axis] : place[axis]);
    }
}

typedef struct InspectWork {
    const RetexTexels *texels;
    atomic_int found; /* 1: a texel that is not opaque */
} InspectWork;

static void inspect_job(void *context, int index, int thread)
{
    InspectWork *work = context;
    const size_t width = (size_t)work->texels->width, first = (size_t)index * width;
    const uint16_t *narrow = work->texels->texels;
    const float *wide = work->texels->texels;
    int clear = 0;
    (void)thread;
    for (size_t i = first; i < first + width; i++)
        clear |= work->texels->narrow ? narrow[4 * i + 3] != (uint16_t)NARROW_ONE : !(wide[4 * i + 3] >= 1);
    if (clear)
        atomic_store(&work->found, 1);
}

static void inspect_texels(RetexTexture *texture, const RetexTexels *texels, int nthreads)
{
    InspectWork work = {texels, 0};
    retex_parallel(nthreads, texels->height, inspect_job, &work);
    texture->opaque =
        !work.found && texture->spec.wrap[0] != RETEX_WRAP_BLACK && texture->spec.wrap[1] != RETEX_WRAP_BLACK;
}

int retex_texture_is_opaque(const RetexTexture *texture)
{
    return texture->nlevels == 0 || texture->opaque;
}

/* Charges texels and their pyramid to the budget. */
static int charge(RetexTexture *texture, int width, int height, int narrow, RetexError *err)
{
    uint64_t bytes = texel_size(narrow) * (uint64_t)width * (uint64_t)height;
    bytes += bytes / 3;
    int code = retex_budget_charge(texture->spec.budget, bytes, texture->spec.image, err);
    if (!code)
        texture->charged += bytes;
    return code;
}

/* Lays repeats into one image, which takes the place of the texels. To the filters it is an image like any other. */
static int lay(RetexTexture *texture, const RetexLayout *layout, RetexTexels *texels, const RetexTexels *tiles,
               int ntiles, int nthreads, RetexError *err)
{
    RetexTexels image = {layout->width, layout->height, texels->narrow, NULL}, all[1 + RETEX_TILES_MAX] = {*texels};
    for (int k = 0; k < ntiles; k++) {
        all[1 + k] = tiles[k];
        image.narrow &= tiles[k].narrow;
    }
    if (charge(texture, image.width, image.height, image.narrow, err))
        return RETEX_ELIMIT;
    if (retex_texels_alloc(&image))
        return no_memory(texture, image.width, image.height, err);
    retex_layout_paint(layout, &texture->spec, all, 1 + ntiles, &image, nthreads);
    memcpy(texture->repeats, layout->period, sizeof texture->repeats);
    free(texels->texels);
    *texels = image;
    return RETEX_OK;
}

static int lay_repeats(RetexTexture *texture, RetexTexels *texels, const RetexTexels *tiles, int ntiles, int nthreads,
                       RetexError *err)
{
    RetexLayout layout;
    int most[2] = {texels->width, texels->height};
    for (int k = 0; k < ntiles; k++) { /* the finest image decides, in the first one's shape */
        const double finer = fmax((double)tiles[k].width / most[0], (double)tiles[k].height / most[1]);
        for (int axis = 0; axis < 2 && finer > 1; axis++)
            most[axis] = (int)ceil(most[axis] * finer);
    }
    int code = retex_layout_make(&layout, &texture->spec, most[0], most[1], err);
    if (!code)
        code = lay(texture, &layout, texels, tiles, ntiles, nthreads, err);
    retex_layout_free(&layout);
    return code;
}

int retex_texture_set_texels(RetexTexture *texture, RetexTexels *texels, const RetexTexels *tiles, int ntiles,
                             int nthreads, RetexError *err)
{
    int code = RETEX_OK;
    texture->size[0] = (int)(texels->width / texture->repeats[0]); /* maps may have two repeats already */
    texture->size[1] = (int)(texels->height / texture->repeats[1]);
    if (retex_lay_is_needed(&texture->spec))
        code = lay_repeats(texture, texels, tiles, ntiles, nthreads, err);
    else
        code = charge(texture, texels->width, texels->height, texels->narrow, err);
    if (code)
        return code;
    set_transform(texture, texture->size[0], texture->size[1]);
    inspect_texels(texture, texels, nthreads);
    if (retex_texture_build_pyramid(texture, texels, nthreads))
        return no_memory(texture, texture->size[0], texture->size[1], err);
    return RETEX_OK;
}

/* ---- life ---- */

int retex_texture_mixes_units(const RetexTextureSpec *spec)
{
    const int is_placed = spec->has_at && (spec->at[0] != 0 || spec->at[1] != 0);
    const int lengths = (spec->width[0] > 0 ? RETEX_METRIC_WIDTH : 0) | (spec->grout > 0 ? RETEX_METRIC_GROUT : 0) |
                        (is_placed ? RETEX_METRIC_AT : 0);
    return (spec->metric & lengths) != 0 && (spec->metric & lengths) != lengths;
}

static void close_finishes(RetexTexture *texture);
static uint64_t finishes_bytes(const RetexTexture *texture);

static int check_width(const RetexTextureSpec *spec, RetexError *err)
{
    for (int axis = 0; axis < 2; axis++)
        if (!isfinite(spec->width[axis]) || spec->width[axis] < 0)
            return retex_fail(err, RETEX_EINVAL, "texture: width must be finite and above 0");
    if (spec->width[1] > 0 && !(spec->width[0] > 0))
        return retex_fail(err, RETEX_EINVAL, "texture: a second width needs a first one");
    if (!isfinite(spec->unit) || !(spec->unit > 0))
        return retex_fail(err, RETEX_EINVAL, "texture: a scene unit of %g metres", spec->unit);
    if (retex_texture_mixes_units(spec))
        return retex_fail(err, RETEX_EINVAL, "texture: all lengths have a unit, or none");
    for (int axis = 0; axis < 2 && spec->width[0] > 0; axis++)
        if (!isfinite(spec->uv_scale[axis]) || !(spec->uv_scale[axis] > 0))
            return retex_fail(err, RETEX_EINVAL,
                              "the size of target %s is not known: width= cannot be used on it, only scale=",
                              spec->target[0] ? spec->target : "(none)");
    return RETEX_OK;
}

static int check_spec(const RetexTextureSpec *spec, RetexError *err)
{
    for (int axis = 0; axis < 2; axis++) {
        if (!isfinite(spec->scale[axis]) || spec->scale[axis] == 0 || !isfinite(spec->offset[axis]) ||
            !isfinite(spec->at[axis]))
            return retex_fail(err, RETEX_EINVAL, "texture: scale must be finite and not 0, offset and place finite");
        if ((unsigned)spec->wrap[axis] > RETEX_WRAP_BLACK)
            return retex_fail(err, RETEX_EINVAL, "texture: no wrap mode has the number %d", (int)spec->wrap[axis]);
    }
    if (!isfinite(spec->rotate))
        return retex_fail(err, RETEX_EINVAL, "texture: rotate must be finite");
    if ((unsigned)spec->repeat >= RETEX_REPEATS)
        return retex_fail(err, RETEX_EINVAL, "texture: no repeat has the number %d", (int)spec->repeat);
    if (retex_adjust_check(spec, err) || retex_lay_check(spec, err) || retex_layers_check(spec, err))
        return RETEX_EINVAL;
    return retex_lay_is_image(spec) ? check_width(spec, err) : RETEX_OK;
}

RetexTexture *retex_texture_new(const RetexTextureSpec *given, RetexError *err)
{
    RetexTextureSpec spec = *given;
    if (check_spec(&spec, err))
        return NULL;
    RetexTexture *texture = calloc(1, sizeof *texture);
    if (!texture) {
        retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
        return NULL;
    }
    if (spec.constant) {
        retex_texel_defects_repair_color(spec.color, &texture->defects);
        retex_adjust_color(&spec, spec.color);
    }
    spec.constant = !retex_lay_is_image(&spec);
    for (int axis = 0; axis < 2; axis++)
        if (spec.repeat == RETEX_REPEAT_MIRROR && spec.wrap[axis] == RETEX_WRAP_REPEAT)
            spec.wrap[axis] = RETEX_WRAP_MIRROR;
    texture->spec = spec;
    texture->size[0] = texture->size[1] = 1;
    texture->repeats[0] = texture->repeats[1] = 1;
    return texture;
}

void retex_texture_close(RetexTexture **texture)
{
    if (!texture || !*texture)
        return;
    for (int i = 0; i < TEXTURE_MAX_LEVELS && !(*texture)->shared; i++) {
        RetexTextureLevel *level = &(*texture)->levels[i];
        free(level->texels);
        free(level->padded);
        for (int k = 0; k < 2; k++) {
            free(level->sides[k]);
            free(level->ends[k]);
        }
    }
    close_finishes(*texture);
    retex_texture_close(&(*texture)->over);
    retex_budget_release((*texture)->spec.budget, (*texture)->charged);
    free((*texture)->color_warning);
    free(*texture);
    *texture = NULL;
}

int retex_texture_spec_needs_scale(const RetexTextureSpec *given)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&spec, given, NULL))
        return 0;
    int needs = retex_lay_is_image(&spec) && spec.width[0] > 0;
    for (int k = 0; k < spec.nlayers && k < RETEX_LAYERS_MAX; k++)
        needs |= spec.layers[k].width[0] > 0;
    return needs;
}

static int set_surface_finishes(RetexTexture *texture, const RetexTextureSpec *spec, RetexError *err);
static int place_finishes(RetexTexture *placed, const RetexTexture *texture, RetexError *err);
static int square_finishes(RetexTexture *square, const RetexTexture *texture, int nthreads, RetexError *err);

int retex_texture_set_surface(RetexTexture *texture, const RetexTextureSpec *surface, RetexError *err)
{
    RetexTextureSpec spec = texture->spec;
    int width, height;
    memcpy(spec.uv_scale, surface->uv_scale, sizeof spec.uv_scale);
    spec.unit = surface->unit;
    memcpy(spec.uv_min, surface->uv_min, sizeof spec.uv_min);
    memcpy(spec.uv_max, surface->uv_max, sizeof spec.uv_max);
    if (!spec.constant && check_width(&spec, err))
        return RETEX_EINVAL;
    texture->spec = spec;
    retex_texture_size(texture, &width, &height);
    if (!spec.constant)
        set_transform(texture, width, height);
    const int code = texture->over ? retex_texture_set_surface(texture->over, surface, err) : RETEX_OK;
    return code ? code : set_surface_finishes(texture, surface, err);
}

/* Whether vectors of both are turned in the same way. */
static int is_turned_as(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    int same = a->rotate == b->rotate;
    for (int axis = 0; axis < 2; axis++)
        same &= !a->flip[axis] == !b->flip[axis] && (a->scale[axis] < 0) == (b->scale[axis] < 0);
    return same;
}

static void unplace(RetexTextureSpec *spec)
{
    const RetexTextureSpec plain = RETEX_TEXTURE_SPEC_INIT;
    memset(spec->target, 0, sizeof spec->target);
    if (spec->normal_tilt > 0) { /* vectors turn with the texture */
        for (int axis = 0; axis < 2; axis++)
            spec->scale[axis] = copysign(1, spec->scale[axis]);
    } else {
        memcpy(spec->scale, plain.scale, sizeof spec->scale);
        memset(spec->flip, 0, sizeof spec->flip);
        spec->rotate = 0;
    }
    memset(spec->offset, 0, sizeof spec->offset);
    spec->has_at = 0;
    memset(spec->at, 0, sizeof spec->at);
    const int has_width = retex_lay_is_needed(spec) && spec->width[0] > 0; /* joints and turns depend on it */
    if (!has_width)
        memset(spec->width, 0, sizeof spec->width);
    spec->metric = 0; /* texels depend on the ratios of lengths */
    spec->unit = 1;
    spec->uv_scale[0] = spec->uv_scale[1] = has_width;
    memset(spec->uv_min, 0, sizeof spec->uv_min);
    memset(spec->uv_max, 0, sizeof spec->uv_max);
    memset(spec->periodic, 0, sizeof spec->periodic);
    for (int k = 0; k < spec->nlayers; k++) {
        RetexTextureSpec layer = RETEX_TEXTURE_SPEC_INIT;
        retex_texture_layer_get(&layer, spec, k);
        unplace(&layer);
        retex_texture_layer_set(spec, k, &layer, NULL);
    }
    spec->access = NULL;
    spec->budget = NULL;
    spec->warn = NULL;
    spec->warn_context = NULL;
}

void retex_texture_spec_unplace(RetexTextureSpec *given)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&spec, given, NULL))
        return;
    unplace(&spec);
    RETEX_PARAMS_RETURN(given, &spec, NULL);
}

static int is_same_tiles(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    int count = retex_lay_tiles(a), same = count == retex_lay_tiles(b);
    for (int k = 0; k < count && same; k++)
        same = strcmp(a->tiles[k], b->tiles[k]) == 0;
    return same;
}

static int is_laid_alike(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    const int have_sizes = a->grout > 0 || a->vary || a->repeat >= RETEX_REPEAT_HERRINGBONE;
    return a->grout == b->grout && memcmp(a->grout_color, b->grout_color, sizeof a->grout_color) == 0 &&
           a->vary == b->vary && a->vary_seed == b->vary_seed && is_same_tiles(a, b) &&
           (!have_sizes || (a->width[0] == b->width[0] && a->width[1] == b->width[1]));
}

static int has_layers_alike(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    int alike = a->nlayers == b->nlayers;
    for (int k = 0; k < a->nlayers && alike; k++) {
        RetexTextureSpec one = RETEX_TEXTURE_SPEC_INIT, other = RETEX_TEXTURE_SPEC_INIT;
        retex_texture_layer_get(&one, a, k);
        retex_texture_layer_get(&other, b, k);
        alike = retex_texture_specs_alike(&one, &other);
    }
    return alike;
}

int retex_texture_specs_alike(const RetexTextureSpec *one, const RetexTextureSpec *other)
{
    RetexTextureSpec a = RETEX_TEXTURE_SPEC_INIT, b = RETEX_TEXTURE_SPEC_INIT;
    if (RETEX_PARAMS_COPY(&a, one, NULL) || RETEX_PARAMS_COPY(&b, other, NULL) || a.constant || b.constant)
        return 0;
    if (strcmp(a.image, b.image) != 0 || strcmp(a.colorspace, b.colorspace) != 0 || strcmp(a.finish, b.finish) != 0 ||
        a.normal != b.normal ||
        a.repeat != b.repeat || a.wrap[0] != b.wrap[0] || a.wrap[1] != b.wrap[1] || a.is_light != b.is_light ||
        a.nadjustments != b.nadjustments || !is_laid_alike(&a, &b) || !has_layers_alike(&a, &b))
        return 0;
    for (int i = 0; i < a.nadjustments; i++)
        if (a.adjustments[i].kind != b.adjustments[i].kind ||
            memcmp(a.adjustments[i].value, b.adjustments[i].value, sizeof a.adjustments[i].value) != 0)
            return 0;
    return 1;
}

static int has_texels_of(const RetexTexture *texture, const RetexTextureSpec *spec)
{
    const RetexTextureSpec *own = &texture->spec;
    return texture->nlevels > 0 && retex_texture_specs_alike(own, spec) &&
           (!texture->may_have_finishes ||
            (spec->nfinishes == own->nfinishes && spec->normal_tilt == own->normal_tilt &&
             (spec->normal_tilt == 0 || is_turned_as(spec, own)) &&
             memcmp(spec->roughness, own->roughness, sizeof own->roughness) == 0));
}

/* Places the layers of `texture` on another one. */
static int place_layers(RetexTexture *placed, const RetexTexture *texture, const RetexTextureSpec *spec,
                        RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < spec->nlayers && !code; k++, placed = placed->over, texture = texture->over) {
        RetexTextureSpec layer = RETEX_TEXTURE_SPEC_INIT;
        retex_texture_layer_get(&layer, spec, k);
        code = retex_texture_place(&placed->over, texture->over, &layer, err);
    }
    return code;
}

int retex_texture_place(RetexTexture **out, const RetexTexture *texture, const RetexTextureSpec *spec, RetexError *err)
{
    RetexError why = {0};
    int width, height;
    *out = NULL;
    RetexTexture *placed = retex_texture_new(spec, &why);
    int code = why.code;
    if (!code && !has_texels_of(texture, &placed->spec))
        code = retex_fail(&why, RETEX_EINVAL, "%s is not loaded as this placement needs it", texture->spec.image);
    if (code) {
        retex_texture_close(&placed);
        if (err)
            *err = why;
        return code;
    }
    const RetexTextureSpec own = placed->spec;
    *placed = *texture;
    placed->spec = own;
    placed->spec.access = NULL;
    placed->spec.warn = NULL;
    placed->shared = 1;
    placed->charged = 0;
    placed->color_warning = NULL;
    placed->over = NULL;
    retex_texture_size(texture, &width, &height);
    set_transform(placed, width, height);
    code = place_finishes(placed, texture, err);
    if (!code)
        code = place_layers(placed, texture, &placed->spec, err);
    if (code)
        retex_texture_close(&placed);
    *out = placed;
    return code;
}

int retex_texture_square(RetexTexture **out, const RetexTexture *texture, int nthreads, RetexError *err)
{
    *out = NULL;
    RetexTexture *square = calloc(1, sizeof *square);
    if (!square)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    square->spec = texture->spec;
    memcpy(square->size, texture->size, sizeof square->size);
    memcpy(square->repeats, texture->repeats, sizeof square->repeats);
    memcpy(square->matrix, texture->matrix, sizeof square->matrix);
    memcpy(square->offset, texture->offset, sizeof square->offset);
    for (int c = 0; c < 3; c++)
        square->spec.color[c] = texture->spec.color[c] * texture->spec.color[c];
    int code = RETEX_OK;
    if (texture->nlevels) {
        const RetexTextureLevel *from = &texture->levels[0];
        RetexTexels texels = {from->width, from->height, 0, NULL};
        if (retex_texels_alloc(&texels))
            code = no_memory(texture, from->width, from->height, err);
        size_t count = (size_t)from->width * (size_t)from->height;
        for (size_t i = 0; !code && i < count; i++) {
            float p[4], *to = (float *)texels.texels + 4 * i;
            retex_texture_read_texel(from->texels, i, texture->narrow, p);
            for (int c = 0; c < 3; c++)
                to[c] = p[3] > 0 ? p[c] / p[3] * (p[c] / p[3]) * p[3] : 0;
            to[3] = p[3];
        }
        if (!code && retex_texture_build_pyramid(square, &texels, nthreads))
            code = no_memory(texture, from->width, from->height, err);
        free(texels.texels);
    }
    if (!code)
        code = square_finishes(square, texture, nthreads, err);
    if (!code && texture->over)
        code = retex_texture_square(&square->over, texture->over, nthreads, err);
    if (code)
        retex_texture_close(&square);
    *out = square;
    return code;
}

void retex_texture_size(const RetexTexture *texture, int *width, int *height)
{
    *width = texture->size[0];
    *height = texture->size[1];
}

uint64_t retex_texture_bytes(const RetexTexture *texture)
{
    return texture->charged + finishes_bytes(texture) + (texture->over ? retex_texture_bytes(texture->over) : 0);
}

/* ---- maps of finishes ---- */

/* The textures of a map, by number: the weights first. */
static RetexTexture **texture_of(RetexFinishMap *finishes, int k)
{
    return k ? &finishes->colors[k - 1] : &finishes->weights;
}

static void close_finishes(RetexTexture *texture)
{
    for (int k = 0; texture->finishes && k <= RETEX_FINISHES_MAX; k++)
        retex_texture_close(texture_of(texture->finishes, k));
    free(texture->finishes);
    texture->finishes = NULL;
}

static uint64_t finishes_bytes(const RetexTexture *texture)
{
    uint64_t bytes = 0;
    for (int k = 0; texture->finishes && k <= texture->finishes->count; k++)
        bytes += retex_texture_bytes(*texture_of(texture->finishes, k));
    return bytes;
}

static int set_surface_finishes(RetexTexture *texture, const RetexTextureSpec *spec, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; texture->finishes && k <= texture->finishes->count && !code; k++)
        code = retex_texture_set_surface(*texture_of(texture->finishes, k), spec, err);
    return code;
}

typedef int Derive(RetexTexture **to, const RetexTexture *from, const void *context, RetexError *err);

static int derive(RetexTexture *to, const RetexTexture *from, Derive *make, const void *context, RetexError *err)
{
    int code = RETEX_OK;
    to->finishes = NULL;
    if (!from->finishes)
        return RETEX_OK;
    if (!(to->finishes = calloc(1, sizeof *to->finishes)))
        return no_memory(from, 1, 1, err);
    to->finishes->count = from->finishes->count;
    to->finishes->is_normal = from->finishes->is_normal;
    for (int k = 0; k <= from->finishes->count && !code; k++)
        code = make(texture_of(to->finishes, k), *texture_of(from->finishes, k), context, err);
    return code;
}

static int place_one(RetexTexture **to, const RetexTexture *from, const void *context, RetexError *err)
{
    return retex_texture_place(to, from, context, err);
}

static int place_finishes(RetexTexture *placed, const RetexTexture *texture, RetexError *err)
{
    int width, height;
    retex_texture_size(texture, &width, &height);
    const RetexTextureSpec spec =
        retex_texture_finish_spec(&placed->spec, width, height, texture->finishes && texture->finishes->is_normal);
    return derive(placed, texture, place_one, &spec, err);
}

static int square_one(RetexTexture **to, const RetexTexture *from, const void *context, RetexError *err)
{
    return retex_texture_square(to, from, *(const int *)context, err);
}

static int square_finishes(RetexTexture *square, const RetexTexture *texture, int nthreads, RetexError *err)
{
    return derive(square, texture, square_one, &nthreads, err);
}

RetexTextureSpec retex_texture_finish_spec(const RetexTextureSpec *spec, int width, int height, int is_normal)
{
    RetexTextureSpec own = *spec;
    own.constant = 0;
    if (!spec->constant && own.width[0] > 0 && !(own.width[1] > 0))
        own.width[1] = own.width[0] * height / width;
    if (is_normal && own.repeat == RETEX_REPEAT_MIRROR)
        own.repeat = RETEX_REPEAT_STRAIGHT;
    for (int axis = 0; axis < 2; axis++)
        if (is_normal && own.wrap[axis] == RETEX_WRAP_MIRROR)
            own.wrap[axis] = RETEX_WRAP_REPEAT;
    return own;
}

/* ---- from surface UV to texels ---- */

/* The mean of a footprint in texture UV. 0 where it is not finite. */
static int texture_uv(const RetexTexture *texture, double u, double v, double uv[2])
{
    for (int i = 0; i < 2; i++)
        uv[i] = texture->matrix[i][0] * u + texture->matrix[i][1] * v + texture->offset[i];
    return isfinite(uv[0]) && isfinite(uv[1]);
}

static void constant_color(const RetexTexture *texture, float rgba[4])
{
    memcpy(rgba, texture->spec.color, 3 * sizeof(float));
    rgba[3] = 1;
}

static void unassociate(float rgba[4])
{
    if (!(rgba[3] > LEAST_ALPHA)) {
        rgba[0] = rgba[1] = rgba[2] = rgba[3] = 0;
        return;
    }
    float inverse = 1 / rgba[3];
    for (int c = 0; c < 3; c++)
        rgba[c] *= inverse;
    if (rgba[3] > 1)
        rgba[3] = 1; /* sums of weights have rounding errors */
}

static void point_at(const RetexTexture *texture, const double uv[2], int nearest, float rgba[4])
{
    double x = uv[0] * texture->levels[0].width, y = (1 - uv[1]) * texture->levels[0].height;
    for (int axis = 0; axis < 2; axis++)
        if (texture->spec.wrap[axis] == RETEX_WRAP_BLACK && (uv[axis] < 0 || uv[axis] > 1)) {
            memset(rgba, 0, 4 * sizeof(float));
            return;
        }
    if (nearest)
        retex_texture_nearest_kernel(texture, x, y, rgba);
    else
        retex_texture_point_kernel(texture, x, y, rgba);
    unassociate(rgba);
}

static void look_up(const RetexTexture *texture, double u, double v, int nearest, float rgba[4])
{
    double uv[2];
    if (!texture->nlevels)
        constant_color(texture, rgba);
    else if (texture_uv(texture, u, v, uv))
        point_at(texture, uv, nearest, rgba);
    else
        memset(rgba, 0, 4 * sizeof(float));
    for (const RetexTexture *over = texture->over; over; over = over->over) {
        float color[4] = {0, 0, 0, 0};
        if (texture_uv(over, u, v, uv))
            point_at(over, uv, nearest, color);
        retex_lay_over(rgba, color);
    }
}

void retex_texture_point(const RetexTexture *texture, double u, double v, float rgba[4])
{
    look_up(texture, u, v, 0, rgba);
}

static int clamped(double x, int size)
{
    return x <= 0 ? 0 : x >= size - 1 ? size - 1 : (int)x;
}

/* Assumes repeats for every wrap mode: a wrong guess only costs the prefetch. */
void retex_texture_prefetch(const RetexTexture *texture, double u, double v)
{
    double uv[2];
    if (!texture->nlevels || !texture_uv(texture, u, v, uv))
        return;
    const RetexTextureLevel *image = &texture->levels[0];
    int column = clamped((uv[0] - floor(uv[0])) * image->width - 0.5, image->width);
    int row = clamped((1 - (uv[1] - floor(uv[1]))) * image->height - 0.5, image->height > 1 ? image->height - 1 : 1);
    size_t size = 4 * (texture->narrow ? sizeof(uint16_t) : sizeof(float));
    const char *texel = (const char *)image->texels + ((size_t)row * (size_t)image->width + (size_t)column) * size;
    __builtin_prefetch(texel);
    if (image->height > 1)
        __builtin_prefetch(texel + (size_t)image->width * size);
}

void retex_texture_nearest(const RetexTexture *texture, double u, double v, float rgba[4])
{
    look_up(texture, u, v, 1, rgba);
}

int retex_texture_finishes(const RetexTexture *texture, double u, double v, int shown, float weights[4])
{
    const RetexFinishMap *finishes = texture->finishes;
    float rgba[4];
    if (!finishes)
        return 0;
    retex_texture_point(finishes->weights, u, v, rgba);
    weights[0] = 1;
    for (int k = 1; k < RETEX_FINISHES_MAX; k++) {
        weights[k] = rgba[3] * rgba[k - 1] + (shown == k ? 1 - rgba[3] : 0);
        weights[0] -= weights[k];
    }
    weights[0] = weights[0] > 0 || finishes->is_normal ? weights[0] : 0;
    return finishes->count;
}
