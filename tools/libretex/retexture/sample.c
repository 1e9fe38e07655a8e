/* Sampling: new textures are filtered at every footprint of their targets. A footprint is a Gaussian, an ellipse or a
 * parallelogram (retex_footprint_filter) with the stored mean and spread of the surface UV, which the texture's
 * transform maps exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/combine.h>
#include <retex/edit.h>
#include <retex/host/band_store.h>
#include <retex/laid.h>

#include <stdlib.h>
#include <string.h>

#include "base/part_name.h"
#include "retexture/term_finishes.h"
#include "retexture/textures.h"
#include "retexture/view_images.h"
#include "retexture/view_source.h"
#include "set/keep.h"
#include "set/laid.h"

typedef struct SampleWork {
    RetexSet *set;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int nspecs;
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target */
    RetexView view;                            /* of set and textures alone */
    RetexSetSource *source;                    /* the view as the source of what is added */
} SampleWork;

/* Adds the part for a footprint with a finish, or -1, or with footprint -1 for the gates. */
static int add_laid(SampleWork *work, int target, int footprint, int finish, RetexError *err)
{
    RetexSet *set = work->set;
    int part = 0;
    const int code = retex_set_add_laid(set, target, footprint, finish, &part, err);
    if (code)
        return code;
    const int image = footprint < 0 ? retex_view_gates(&work->view, target)
                                    : retex_view_footprint(&work->view, footprint, finish,
                                                           &set->parts[set->footprints[footprint].uv].image);
    if (image < 0)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    retex_part_set_source(&set->parts[part], work->source, image);
    return RETEX_OK;
}

/* Adds the parts for the texture of a target. */
static int add_target(SampleWork *work, int target, RetexError *err)
{
    const int mapped = work->view.mapped[target];
    int code = RETEX_OK;
    for (int f = 0; f < work->set->nfootprints; f++)
        for (int k = -1; k < mapped && work->set->footprints[f].target == target && !code; k++)
            code = add_laid(work, target, f, k, err);
    return code || !mapped ? code : add_laid(work, target, -1, -1, err);
}

static int add_targets(SampleWork *work, int nthreads, RetexError *err)
{
    RetexSet *set = work->set;
    work->view = (RetexView){.set = set, .textures = work->textures, .columns = {0, set->width}};
    int code = retex_view_source_open(&work->source, &work->view, err);
    if (!code)
        code = retex_view_find_maps(&work->view, NULL, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        if (work->textures[t])
            retex_set_lift(set, t);
    for (int t = 0; t < set->ntargets && !code; t++)
        code = work->textures[t] ? add_target(work, t, err) : RETEX_OK;
    for (int i = 0; i < work->nspecs && !code; i++) {
        RetexTarget *target = &set->targets[retex_set_find_target(set, work->specs[i].target)];
        retex_edit_image_text(&work->specs[i], target->texture, sizeof target->texture);
    }
    return code ? code : retex_view_make(&work->view, nthreads, err);
}

/* Brings what was added out of the view: parts as large as the picture into a band store; near NULL: all into
 * memory. */
static int keep_parts(SampleWork *work, const char *near, int nthreads, RetexError *err)
{
    RetexSet *set = work->set;
    RetexBandStore *store = NULL;
    char wanted[RETEX_SET_PARTS_MAX];
    int code = near ? retex_band_store_create(&store, set->width, set->height, set->id, near, err) : RETEX_OK;
    if (store && strcmp(near, "-") == 0)
        retex_band_store_set_fast(store);
    for (int i = 0; i < set->nparts; i++)
        wanted[i] = set->parts[i].source == work->source;
    if (!code)
        code = retex_set_keep(set, wanted, store, nthreads, err);
    for (int i = 0; i < set->nparts; i++)
        if (set->parts[i].source == work->source)
            retex_part_set_source(&set->parts[i], NULL, 0);
    return code;
}

static int is_loaded(const RetexSet *set, const RetexFootprint *f)
{
    return set->parts[f->uv].image.pixels && set->parts[f->spread].image.pixels && set->parts[f->albedo].image.pixels;
}

static int check_loaded(const SampleWork *work, RetexError *err)
{
    const RetexSet *set = work->set;
    for (int f = 0; f < set->nfootprints; f++)
        if (work->textures[set->footprints[f].target] && !is_loaded(set, &set->footprints[f]))
            return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
    return RETEX_OK;
}

static int lay(SampleWork *work, const char *near, int nthreads, RetexError *err)
{
    int code = add_targets(work, nthreads, err);
    if (!code)
        code = keep_parts(work, near, nthreads, err);
    for (int t = 0; t < work->set->ntargets && code; t++)
        if (work->textures[t])
            retex_set_lift(work->set, t);
    retex_source_release(&work->source);
    retex_view_close(&work->view);
    return code;
}

int retex_sample(RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs};
    int code = retex_texture_specs_copy(work.specs, specs, nspecs, err);
    if (!code)
        code = retex_textures_load(work.textures, set, work.specs, nspecs, nthreads, err);
    if (!code)
        code = check_loaded(&work, err);
    if (!code)
        code = lay(&work, NULL, nthreads, err);
    retex_textures_close(work.textures);
    return code;
}

int retex_sample_textures(RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS], const RetexTextureSpec *specs,
                          int nspecs, const char *near, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs};
    memcpy(work.textures, textures, sizeof work.textures);
    const int code = retex_texture_specs_copy(work.specs, specs, nspecs, err);
    return code ? code : lay(&work, near, nthreads, err);
}
