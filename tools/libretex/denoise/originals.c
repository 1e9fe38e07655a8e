/* See originals.h. */
#include "denoise/originals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/image.h"
#include "base/jobs.h"
#include "retexture/sample_row.h"
#include "set/parts.h"
#include "set/set.h"
#include "set/strip.h"
#include "texture/pyramid.h"

/* Squared differences from the original texture that count as noise, in units of the variance of an albedo. */
#define EXPLAINED 4.0f
/* The same of what is seen sharply: paths are spread evenly over a pixel, so that the mean of a part of it has less
 * noise than that of as many samples anywhere. */
#define EXPLAINED_OF_PARTS 1.0f
#define EXPLAINED_OF_PIXELS 6.0f
/* So many times this in the pixel itself, and in the mean of the pixels around: these tell what is no noise. */
#define EXPLAINED_HERE 2.0f
#define EXPLAINED_AROUND 0.6f
#define UNEXPLAINED_MOST 10.0f /* of a pixel in that mean */
#define AROUND 3               /* pixels to each side */
#define SPREAD 0.1f /* variance of the mean of evenly spread samples of a whole pixel, of that of as many anywhere */

/* A footprint whose albedo is no other one's, but for quadrants: of these the first stands for the whole pixel. */
typedef struct Place {
    int uv, spread, albedo, target; /* parts, target */
    RetexTextureFilter filter;
} Place;

struct RetexDenoiseOriginals {
    RetexTexture *textures[RETEX_MAX_TARGETS], *squares[RETEX_MAX_TARGETS]; /* NULL where there is no original */
    Place *places;
    int nplaces, spp;
};

/* ---- textures ---- */

/* The rectangle of UV that the original covers becomes one repeat. */
static RetexTextureSpec place_original(const RetexTarget *t)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    for (int k = 0; k < 2; k++) {
        const double size = t->original_max[k] - t->original_min[k];
        spec.scale[k] = 1 / size;
        spec.offset[k] = -t->original_min[k] / size;
        spec.wrap[k] = size == 1 && t->original_min[k] == 0 ? RETEX_WRAP_REPEAT : RETEX_WRAP_CLAMP;
        spec.periodic[k] = t->periodic[k];
        if (!t->periodic[k])
            spec.uv_min[k] = t->uv_min[k], spec.uv_max[k] = t->uv_max[k];
    }
    return spec;
}

static int is_usable(const RetexSet *set, const RetexTarget *t)
{
    int usable = t->original >= 0 && set->parts[t->original].image.channels == 3;
    for (int k = 0; k < 2; k++)
        usable &= isfinite(1 / (t->original_max[k] - t->original_min[k]));
    return usable;
}

/* The numbers that a file would have, whether the set comes from one or not. */
static int copy_original(RetexImage *image, const RetexSet *set, int original, RetexError *err)
{
    RetexPart part = set->parts[original];
    int code = retex_image_alloc(image, part.image.width, part.image.height, part.image.channels, err);
    if (!code)
        code = retex_set_part_rows(image, set, original, 0, err);
    part.image = *image;
    for (int y = 0; y < image->height && !code; y++)
        retex_part_round_row(&part, y);
    return code;
}

static int open_texture(RetexDenoiseOriginals *o, const RetexSet *set, int target, int nthreads, RetexError *err)
{
    const RetexTarget *t = &set->targets[target];
    if (!is_usable(set, t))
        return RETEX_OK;
    const RetexTextureSpec spec = place_original(t);
    RetexImage image = {0};
    int code = copy_original(&image, set, t->original, err);
    if (!code)
        code = retex_texture_create(&o->textures[target], &image, &spec, nthreads, err);
    if (!code)
        code = retex_texture_square(&o->squares[target], o->textures[target], nthreads, err);
    retex_image_free(&image);
    return code;
}

/* ---- footprints ---- */

static int is_whole(const RetexSet *set, int part, int least, int most)
{
    const RetexImage *im = part >= 0 ? &set->parts[part].image : NULL;
    return im && im->width == set->width && im->height == set->height && im->channels >= least && im->channels <= most;
}

/* 1 if another footprint, which is no quadrant of the same pixel, has the same albedo. */
static int shares_albedo(const RetexSet *set, const RetexFootprint *f)
{
    for (int k = 0; k < set->nfootprints; k++) {
        const RetexFootprint *g = &set->footprints[k];
        if (g->albedo == f->albedo && (g->uv != f->uv || g->spread != f->spread))
            return 1;
    }
    return 0;
}

static int is_placed(const RetexDenoiseOriginals *o, int albedo)
{
    for (int k = 0; k < o->nplaces; k++)
        if (o->places[k].albedo == albedo)
            return 1;
    return 0;
}

static void find_places(RetexDenoiseOriginals *o, const RetexSet *set)
{
    for (int k = 0; k < set->nfootprints; k++) {
        RetexFootprint f = set->footprints[k];
        f.quadrant = 0;
        if (o->textures[f.target] && is_whole(set, f.uv, 3, 3) && is_whole(set, f.spread, 2, RETEX_AXES) &&
            is_whole(set, f.albedo, 3, 3) && !shares_albedo(set, &f) && !is_placed(o, f.albedo))
            o->places[o->nplaces++] = (Place){f.uv, f.spread, f.albedo, f.target, retex_footprint_filter(set, &f)};
    }
}

/* Of all textures and their squares, with the levels of their pyramids. */
static uint64_t texture_bytes(const RetexSet *set)
{
    uint64_t bytes = 0;
    for (int t = 0; t < set->ntargets; t++)
        if (is_usable(set, &set->targets[t])) {
            const RetexImage *im = &set->parts[set->targets[t].original].image;
            bytes += 2 * 21 * (uint64_t)im->width * (uint64_t)im->height;
        }
    return bytes;
}

int retex_denoise_originals_open(RetexDenoiseOriginals **out, const RetexSet *set, const RetexBudget *budget,
                                 int nthreads, RetexError *err)
{
    const uint64_t bytes = texture_bytes(set);
    int code = RETEX_OK;
    *out = NULL;
    if (!bytes)
        return RETEX_OK;
    if (bytes > retex_budget_left(budget))
        return retex_fail(err, RETEX_ELIMIT,
                          "the set's original textures take more than is left of the %.0f MB of --max-memory",
                          (double)retex_budget_memory(budget) / (1 << 20));
    RetexDenoiseOriginals *o = *out = calloc(1, sizeof *o);
    if (o)
        o->spp = set->spp, o->places = calloc((size_t)set->nfootprints + 1, sizeof *o->places);
    if (!o || !o->places)
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int t = 0; t < set->ntargets && !code; t++)
        code = open_texture(o, set, t, nthreads, err);
    if (code)
        retex_denoise_originals_close(out);
    else
        find_places(o, set);
    return code;
}

void retex_denoise_originals_close(RetexDenoiseOriginals **out)
{
    RetexDenoiseOriginals *o = out ? *out : NULL;
    if (!o)
        return;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
        retex_texture_close(&o->textures[t]);
        retex_texture_close(&o->squares[t]);
    }
    free(o->places);
    free(o);
    *out = NULL;
}

/* ---- rows ---- */

typedef struct Use {
    const RetexDenoiseOriginals *originals;
    RetexSet *rows;
    RetexRoi roi;
} Use;

/* The variance beyond which a squared difference is no noise, in units of the texture's within the footprint. Of n
 * effective samples the variance of a mean is an nth. All samples of a pixel that are equally bright are spread evenly:
 * what they lack of all is by how much some are brighter. A quadrant covers a quarter. */
static float explained(RetexTextureFilter filter, float cover, float samples)
{
    if (filter == RETEX_TEXTURE_PARALLELOGRAM)
        return EXPLAINED_OF_PIXELS * (fmaxf(0.25f / cover, 1) - 1 + SPREAD) / samples;
    return (filter == RETEX_TEXTURE_BROAD ? EXPLAINED : EXPLAINED_OF_PARTS) / fmaxf(cover * samples, 1);
}

/* The squared difference of an albedo from the mean of the original texture, as a multiple of the most that noise
 * explains; less than 0 where this is nothing. */
static float unexplained(const float albedo[3], const float mean[3], const float variance[3], float most)
{
    float squared = 0, expected = 0;
    for (int c = 0; c < 3; c++) {
        squared += (mean[c] - albedo[c]) * (mean[c] - albedo[c]);
        expected += variance[c];
    }
    return most * expected > 0 ? squared / (most * expected) : -1;
}

/* The mean over the pixels around, in the row. Noise differs from pixel to pixel; where it is more than noise, the
 * footprint is not what pixels see. */
static float unexplained_around(const float *ratios, int x, int width)
{
    float sum = 0, count = 0;
    for (int k = x < AROUND ? 0 : x - AROUND; k <= x + AROUND && k < width; k++)
        if (ratios[k] >= 0)
            sum += fminf(ratios[k], UNEXPLAINED_MOST), count++;
    return count > 0 ? sum / count : 0;
}

/* How far the mean of the original texture takes an albedo's place. */
static float share_of(float ratio, float around)
{
    return ratio < 0 ? 0 : fminf(1, fminf(EXPLAINED_HERE / ratio, EXPLAINED_AROUND / around));
}

/* means, variances, ratios: of the pixels of the row. */
static void use_place(const Use *u, const Place *p, int y, float *means, float *variances, float *ratios)
{
    const RetexImage *uv = &u->rows->parts[p->uv].image, *spread = &u->rows->parts[p->spread].image;
    RetexImage *albedo = &u->rows->parts[p->albedo].image;
    const int x0 = u->roi.x0, width = u->roi.x1 - u->roi.x0;
    if (!uv->pixels || !spread->pixels || !albedo->pixels)
        return;
    const RetexFootprintRow row = {.uv = uv->pixels + retex_image_index(uv, x0, y),
                                   .spread = spread->pixels + retex_image_index(spread, x0, y),
                                   .spreads = spread->channels,
                                   .width = width,
                                   .span = {0, width}};
    float *to = albedo->pixels + retex_image_index(albedo, x0, y);
    retex_sample_row(u->originals->textures[p->target], p->filter, &row, means);
    retex_variance_row(u->originals->textures[p->target], u->originals->squares[p->target], p->filter, &row, variances);
    for (int x = 0; x < width; x++) {
        const float cover = row.uv[3 * x + 2];
        ratios[x] = cover > 0 ? unexplained(to + 3 * x, means + 3 * x, variances + 3 * x,
                                            explained(p->filter, cover, (float)u->originals->spp))
                              : -1;
    }
    for (int x = 0; x < width; x++) {
        const float share = share_of(ratios[x], unexplained_around(ratios, x, width));
        for (int c = 0; c < 3 && share > 0; c++)
            to[3 * x + c] += share * (means[3 * x + c] - to[3 * x + c]);
    }
}

static int use_row(void *context, int index, int thread, RetexError *err)
{
    const Use *u = context;
    const size_t floats = 3 * (size_t)(u->roi.x1 - u->roi.x0);
    float *memory = malloc((2 * floats + floats / 3) * sizeof *memory);
    (void)thread;
    if (!memory)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to denoise");
    for (int k = 0; k < u->originals->nplaces; k++)
        use_place(u, &u->originals->places[k], u->roi.y0 + index, memory, memory + floats, memory + 2 * floats);
    free(memory);
    return RETEX_OK;
}

int retex_denoise_use_originals(const RetexDenoiseOriginals *originals, RetexSet *rows, const RetexRoi *roi,
                                int nthreads, RetexError *err)
{
    Use use = {originals, rows, *roi};
    return originals ? retex_jobs_run(nthreads, roi->y1 - roi->y0, use_row, &use, err) : RETEX_OK;
}
