/* What a pack takes, and what it lost: pictures made from it against the same from the set that was packed. */
#include <retex/pack.h>

#include <math.h>
#include <string.h>

#include <retex/metrics.h>
#include <retex/sample.h>

#include "pack_bands.h"
#include "manifest.h"

/* --- bytes --- */

const char *const retex_pack_group_names[RETEX_PACK_GROUPS] = {"picture", "radiance", "gains",     "uv",   "spread",
                                                               "weights", "albedo",   "originals", "other"};

static void assign(RetexPackGroup *groups, int part, RetexPackGroup group)
{
    if (part > 0)
        groups[part] = group;
}

static void assign_all(RetexPackGroup *groups, const RetexSet *set)
{
    for (int i = 0; i < set->nparts; i++)
        groups[i] = i ? RETEX_PACK_OTHER : RETEX_PACK_PICTURE;
    for (int i = 0; i < set->nterms; i++) {
        assign(groups, set->terms[i].radiance, RETEX_PACK_RADIANCE);
        assign(groups, set->terms[i].gain, RETEX_PACK_GAINS);
    }
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            assign(groups, set->mixtures[i].shares[k].weight, RETEX_PACK_WEIGHTS);
    for (int i = 0; i < set->nfootprints; i++) {
        assign(groups, set->footprints[i].uv, RETEX_PACK_UV);
        assign(groups, set->footprints[i].spread, RETEX_PACK_SPREAD);
        assign(groups, set->footprints[i].albedo, RETEX_PACK_ALBEDO);
    }
    for (int i = 0; i < set->ntargets; i++)
        assign(groups, set->targets[i].original, RETEX_PACK_ORIGINALS);
}

int retex_pack_bytes(uint64_t bytes[RETEX_PACK_GROUPS], const RetexSet *set)
{
    const RetexPack *pack = retex_pack_of(set);
    RetexPackGroup groups[RETEX_SET_PARTS_MAX];
    memset(bytes, 0, RETEX_PACK_GROUPS * sizeof *bytes);
    if (!pack)
        return 0;
    assign_all(groups, set);
    for (int i = 0; i < set->nparts; i++)
        bytes[groups[i]] += retex_pack_part_bytes(pack, i);
    return 1;
}

/* --- loss --- */

/* For each picture its textures: none, white, smooth waves, and a chequerboard, which has every edge. */
enum { SIDE = 256, WAVES = 4, SQUARES = 16 };

static void paint(RetexImage *image, int picture)
{
    const double turn = 2 * acos(-1) * WAVES / SIDE;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            float *pixel = image->pixels + retex_image_index(image, x, y);
            const int dark = (x * SQUARES / SIDE + y * SQUARES / SIDE) % 2;
            for (int c = 0; c < 3; c++)
                pixel[c] = picture == RETEX_PACK_LOSS_WHITE   ? 1
                           : picture == RETEX_PACK_LOSS_WAVES ? (float)(0.5 + 0.4 * sin(turn * (x + c * y)))
                           : dark                             ? 0.1f
                                                              : 0.8f;
        }
}

static int take_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    RetexImage *image = context;
    (void)err;
    memcpy(image->pixels + retex_image_index(image, 0, y0), rows,
           (size_t)(y1 - y0) * (size_t)image->width * 3 * sizeof *rows);
    return 0;
}

static int compare(double *psnr, const RetexSet *pack, const RetexSet *set, RetexTexture *texture, int nthreads,
                   RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL};
    RetexImage images[2] = {{0}};
    const RetexSet *sets[2] = {pack, set};
    RetexMetrics metrics;
    int code = 0;
    for (int i = 0; i < set->ntargets; i++)
        textures[i] = texture;
    for (int i = 0; i < 2 && !code; i++) {
        code = retex_image_alloc(&images[i], set->width, set->height, 3, err);
        if (!code)
            code = retex_retexture(sets[i], NULL, textures, NULL, take_rows, &images[i], nthreads, err);
    }
    if (!code)
        code = retex_metrics(&metrics, &images[0], &images[1], nthreads, err);
    if (!code)
        *psnr = metrics.psnr;
    retex_image_free(&images[0]);
    retex_image_free(&images[1]);
    return code;
}

int retex_pack_loss(double psnr[RETEX_PACK_LOSSES], const RetexSet *pack, const RetexSet *set, int nthreads,
                    RetexError *err)
{
    RetexImage painted = {0};
    int code = pack->width == set->width && pack->height == set->height && pack->ntargets == set->ntargets
                   ? retex_image_alloc(&painted, SIDE, SIDE, 3, err)
                   : retex_fail(err, RETEX_EINVAL, "the pack is of another set");
    for (int k = 0; k < RETEX_PACK_LOSSES && !code; k++) {
        RetexTexture *texture = NULL;
        paint(&painted, k);
        if (k != RETEX_PACK_LOSS_ORIGINAL)
            code = retex_texture_create(&texture, &painted, NULL, err);
        if (!code)
            code = compare(&psnr[k], pack, set, texture, nthreads, err);
        retex_texture_close(&texture);
    }
    retex_image_free(&painted);
    return code;
}
