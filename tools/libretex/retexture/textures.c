/* Loads the textures for a set's targets, after checking them against the set. */

#include <string.h>

#include <retex/combine.h>
#include <retex/edit.h>
#include <retex/parallel.h>

#include "base/params.h"
#include "retexture/textures.h"
#include "set/manifest.h"
#include "set/parts.h"
#include "texture/folder.h"
#include "texture/pyramid.h"

typedef struct Loading {
    RetexTexture **textures; /* by target */
    const RetexSet *set;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int target[RETEX_MAX_TARGETS]; /* by spec */
    int nspecs, threads;
    RetexError errors[RETEX_MAX_TARGETS];
} Loading;

/* ---- checks ---- */

int retex_texture_specs_copy(RetexTextureSpec own[RETEX_MAX_TARGETS], const RetexTextureSpec *specs, int nspecs,
                             RetexError *err)
{
    if (nspecs > RETEX_MAX_TARGETS)
        return retex_fail(err, RETEX_EINVAL, "%d textures are more than a set has targets", nspecs);
    for (int i = 0; i < nspecs; i++) {
        const void *bytes = (const char *)specs + (size_t)i * specs->size;
        const RetexTextureSpec *given = bytes;
        own[i] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        if (RETEX_PARAMS_COPY(&own[i], given, err))
            return RETEX_EINVAL;
        if (given->size != specs->size)
            return retex_fail(err, RETEX_EINVAL, "textures whose parameters differ in size");
    }
    return RETEX_OK;
}

static int find_targets(Loading *loading, RetexError *err)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    RetexTargetNames names;
    retex_set_target_names(&names, loading->set);
    for (int i = 0; i < loading->nspecs; i++) {
        int target, code = retex_target_find(&target, &names, loading->specs[i].target, err);
        if (code)
            return code;
        if (taken[target]++)
            return retex_fail(err, RETEX_EINVAL, "target %s is given two textures", loading->set->targets[target].name);
        loading->target[i] = target;
    }
    return RETEX_OK;
}

static int check_part(const RetexSet *set, int part, int channels)
{
    if (part < 0 || part >= set->nparts)
        return 0;
    const RetexImage *im = &set->parts[part].image;
    return retex_set_scale(set, im) && (im->channels == channels || (channels == 2 && im->channels > 2));
}

/* Checks that the footprints of targets with a new texture have all their parts. */
static int check_footprints(const Loading *loading, RetexError *err)
{
    const RetexSet *set = loading->set;
    if (set->nfootprints > RETEX_SET_FOOTPRINTS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "the set has %d footprints, more than %d", set->nfootprints,
                          RETEX_SET_FOOTPRINTS_MAX);
    for (int i = 0; i < set->nfootprints; i++) {
        const RetexFootprint *f = &set->footprints[i];
        if (f->target < 0 || f->target >= set->ntargets)
            return retex_fail(err, RETEX_EFORMAT, "footprint %d of the set has no target", i);
        int edited = 0;
        for (int k = 0; k < loading->nspecs; k++)
            edited |= loading->target[k] == f->target;
        if (edited && (!retex_set_footprint_scale(set, i) || !check_part(set, f->uv, 3) ||
                       !check_part(set, f->spread, 2) || !check_part(set, f->albedo, 3)))
            return retex_fail(err, RETEX_EFORMAT,
                              "nothing can be put on target %s: the set does not hold its footprints; "
                              "one that was sampled and sent through a pipe has left them behind",
                              set->targets[f->target].name);
    }
    return RETEX_OK;
}

/* ---- loading ---- */

static void describe_surface(RetexTextureSpec *spec, const RetexSet *set, const RetexTarget *t)
{
    spec->unit = set->unit;
    memcpy(spec->uv_scale, t->uv_scale, sizeof spec->uv_scale);
    memcpy(spec->periodic, t->periodic, sizeof spec->periodic);
    spec->nfinishes = t->nfinishes;
    memcpy(spec->roughness, t->finish_roughness, sizeof spec->roughness);
    spec->normal_tilt = t->normal_tilt;
    for (int axis = 0; axis < 2; axis++)
        if (!t->periodic[axis]) {
            spec->uv_min[axis] = t->uv_min[axis];
            spec->uv_max[axis] = t->uv_max[axis];
        }
}

static void load_job(void *context, int index, int thread)
{
    Loading *loading = context;
    (void)thread;
    int target = loading->target[index];
    RetexTextureSpec spec = loading->specs[index];
    spec.warn = NULL; /* warnings come afterwards, in the order of specs */
    describe_surface(&spec, loading->set, &loading->set->targets[target]);
    retex_texture_load(&loading->textures[target], &spec, loading->threads, &loading->errors[index]);
}

/* Loads all textures in parallel: most of the time is decoding, which uses one thread a file. */
static int load_textures(Loading *loading, int nthreads, RetexError *err)
{
    int threads = retex_threads(nthreads);
    loading->threads = loading->nspecs && threads > loading->nspecs ? threads / loading->nspecs : 1;
    retex_parallel(threads, loading->nspecs, load_job, loading);
    for (int i = 0; i < loading->nspecs; i++)
        if (loading->errors[i].code) {
            if (err)
                *err = loading->errors[i];
            return loading->errors[i].code;
        }
    for (int i = 0; i < loading->nspecs; i++)
        retex_texture_report_colors(loading->textures[loading->target[i]], &loading->specs[i]);
    return RETEX_OK;
}

int retex_textures_move(RetexTexture *texture, const RetexSet *set, int target, RetexError *err)
{
    RetexTextureSpec surface = RETEX_TEXTURE_SPEC_INIT;
    describe_surface(&surface, set, &set->targets[target]);
    return retex_texture_set_surface(texture, &surface, err);
}

int retex_textures_place(RetexTexture **placed, const RetexTexture *texture, const RetexSet *set,
                         const RetexTextureSpec *spec, RetexError *err)
{
    RetexTextureSpec own = RETEX_TEXTURE_SPEC_INIT;
    RetexTargetNames names;
    int target;
    *placed = NULL;
    if (RETEX_PARAMS_COPY(&own, spec, err))
        return RETEX_EINVAL;
    retex_set_target_names(&names, set);
    const int code = retex_target_find(&target, &names, own.target, err);
    if (code)
        return code;
    describe_surface(&own, set, &set->targets[target]);
    return retex_texture_place(placed, texture, &own, err);
}

static int check_needs(const RetexTarget *target, const RetexTextureSpec *spec, RetexError *err)
{
    if (retex_texture_spec_needs_scale(spec) && !(target->uv_scale[0] > 0))
        return retex_fail(err, RETEX_EINVAL,
                          "the size of target %s is not known: width= cannot be used on it, only scale=",
                          target->name);
    if (!spec->finish[0] || strcmp(spec->finish, RETEX_NO_FINISH_MAP) == 0)
        return RETEX_OK;
    if (spec->normal && !(target->normal_tilt > 0))
        return retex_fail(err, RETEX_EINVAL,
                          "%s takes no normal maps: normal= cannot be used on it; render the set with "
                          "--finish %s=normals",
                          target->name, target->name);
    if (!spec->normal && (!target->nfinishes || target->normal_tilt > 0))
        return retex_fail(err, RETEX_EINVAL,
                          "%s has no finishes to choose from: finish= cannot be used on it; render the set with "
                          "--finish %s=NAME,NAME",
                          target->name, target->name);
    return RETEX_OK;
}

/* Takes specifications over, after checking them against the set. */
static int open_loading(Loading *loading, const RetexTextureSpec *specs, RetexError *err)
{
    int code = retex_texture_specs_copy(loading->specs, specs, loading->nspecs, err);
    if (!code)
        code = find_targets(loading, err);
    for (int i = 0; i < loading->nspecs && !code; i++)
        code = check_needs(&loading->set->targets[loading->target[i]], &loading->specs[i], err);
    return code ? code : check_footprints(loading, err);
}

int retex_textures_check(const RetexSet *set, const RetexTextureSpec *specs, int nspecs, RetexError *err)
{
    Loading loading = {.set = set, .nspecs = nspecs};
    return open_loading(&loading, specs, err);
}

void retex_textures_close(RetexTexture *textures[RETEX_MAX_TARGETS])
{
    for (int i = 0; i < RETEX_MAX_TARGETS; i++)
        retex_texture_close(&textures[i]);
}

int retex_textures_load(RetexTexture *textures[RETEX_MAX_TARGETS], const RetexSet *set, const RetexTextureSpec *specs,
                        int nspecs, int nthreads, RetexError *err)
{
    Loading loading = {textures, set, .nspecs = nspecs};
    memset(textures, 0, RETEX_MAX_TARGETS * sizeof *textures);
    const int code = open_loading(&loading, specs, err);
    return code ? code : load_textures(&loading, nthreads, err);
}
