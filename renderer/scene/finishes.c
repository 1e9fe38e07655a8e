/* Finishes to choose from after rendering: TARGET=NAME,NAME of the command line is read, and the light that is kept
 * apart for them is numbered. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <retex/nearest.h>
#include "scene/scene.h"

#define ORIGINAL "original"
#define NORMALS "normals"

/* ---- the built-in ones ---- */

#define BUILT_IN(r, m)                                                                                                 \
    {                                                                                                                  \
        FINISH_DEFAULTS, .retex.present = 1, .retex.roughness = r, .retex.metallic = m                                 \
    }

static const Finish built_in[] = {BUILT_IN(0.85, 0), BUILT_IN(0.4, 0), BUILT_IN(0.08, 0), BUILT_IN(0.25, 1)};
static const char *const built_in_names[] = {"matt", "satin", "polished", "metal"};
enum { BUILT_INS = sizeof built_in / sizeof *built_in };

const char *scene_built_in_finish(int k)
{
    return k >= 0 && k < BUILT_INS ? built_in_names[k] : NULL;
}

float target_finish_roughness(const Target *target, int k)
{
    const Finish *finish = target->finishes[k].finish;
    return finish && !target->has_normals ? finish_roughness(finish) : -1; /* with normals there is nothing to choose */
}

float finish_roughness(const Finish *f)
{
    const int is_mirror = finish_is_mirror(f), has_highlight = f->phong > 0 || f->specular > 0;
    const double metallic = f->retex.present ? f->retex.metallic
                            : is_mirror      ? f->reflection_metallic
                            : has_highlight  ? f->metallic
                                             : 0;
    if (metallic > 0.5)
        return -1;
    if (f->retex.present)
        return (float)f->retex.roughness;
    const double exponent = f->phong > 0 ? f->phong_size : 1 / f->roughness; /* alpha^2 = 2 / (exponent + 2) */
    return is_mirror ? 0 : has_highlight ? (float)pow(2 / (exponent + 2), 0.25) : 1;
}

/* ---- names ---- */

/* Exactly, else ignoring case; what the scene declares comes first. */
static const Finish *find_finish(const Scene *scene, const char *name, RetexNearest *nearest, const char **spelled)
{
    for (int ignoring = 0; ignoring < 2; ignoring++) {
        int (*const compare)(const char *, const char *) = ignoring ? strcasecmp : strcmp;
        for (int k = 0; k < scene->nnamed_finishes; k++)
            if (compare(scene->named_finishes[k].name, name) == 0)
                return *spelled = scene->named_finishes[k].name, scene->named_finishes[k].finish;
        for (int k = 0; k < BUILT_INS; k++)
            if (compare(built_in_names[k], name) == 0)
                return *spelled = built_in_names[k], &built_in[k];
    }
    for (int k = 0; k < scene->nnamed_finishes; k++)
        retex_nearest_try(nearest, scene->named_finishes[k].name);
    for (int k = 0; k < BUILT_INS; k++)
        retex_nearest_try(nearest, built_in_names[k]);
    return NULL;
}

/* What only the scene itself can have, as it changes where light goes or comes from. */
static const char *refused(const Finish *finish)
{
    return finish_transmits(finish)       ? "it lets light through"
           : finish_is_sampled(finish)    ? "it emits light"
           : finish_is_subsurface(finish) ? "light goes below its surface"
                                          : NULL;
}

static int read_finish(TargetFinish *out, const Scene *scene, const Target *target, const char *text, size_t length,
                       RetexError *err)
{
    char meant[RETEX_MEANT_SIZE];
    if (length == 0 || length >= sizeof out->name)
        return retex_fail(err, RETEX_EINVAL, "finishes of %s: expected names, as in %s=matt,polished", target->name,
                          target->name);
    *out = (TargetFinish){.finish = NULL};
    memcpy(out->name, text, length);
    if (strcasecmp(out->name, ORIGINAL) == 0) {
        strcpy(out->name, ORIGINAL);
        return RETEX_OK;
    }
    RetexNearest nearest = {out->name, NULL, 0};
    const char *spelled = NULL;
    out->finish = find_finish(scene, out->name, &nearest, &spelled);
    if (!out->finish)
        return retex_fail(err, RETEX_ENOTFOUND, "no finish is called `%s`%s; --list-finishes lists what there is",
                          out->name, retex_meant(nearest.best, meant));
    snprintf(out->name, sizeof out->name, "%s", spelled);
    if (refused(out->finish))
        return retex_fail(err, RETEX_EUNSUPPORTED, "finish `%s` of %s cannot be kept apart: %s", out->name,
                          target->name, refused(out->finish));
    return RETEX_OK;
}

static int find_target(Target **target, Scene *scene, const char *option, const char *spec, RetexError *err)
{
    const char *equals = strrchr(spec, '='), *names[RETEX_MAX_TARGETS];
    char name[RETEX_NAME_MAX], meant[RETEX_MEANT_SIZE];
    if (!equals || equals == spec || !equals[1])
        return retex_fail(err, RETEX_EINVAL, "%s `%s`: expected TARGET=NAME", option, spec);
    snprintf(name, sizeof name, "%.*s", (int)(equals - spec), spec);
    for (int ignoring = 0; ignoring < 2; ignoring++)
        for (int t = 0; t < scene->ntargets; t++)
            if ((ignoring ? strcasecmp : strcmp)(scene->targets[t].name, name) == 0) {
                *target = &scene->targets[t];
                return RETEX_OK;
            }
    for (int t = 0; t < scene->ntargets; t++)
        names[t] = scene->targets[t].name;
    return retex_fail(err, RETEX_ENOTFOUND, "%s `%s`: no target is called `%s`%s", option, spec, name,
                      scene->ntargets ? retex_meant(retex_nearest_of(name, names, scene->ntargets), meant)
                                      : "; targets are named by -t");
}

/* The word `normals`, which follows at most one finish. */
static int add_normals(Target *target, const char *rest, RetexError *err)
{
    static const char *const names[] = {"normal-u", "normal-v"};
    if (*rest || target->nfinishes > 1)
        return retex_fail(err, RETEX_EUNSUPPORTED, "--finish: %s has normals of one finish only, as in %s=matt,normals",
                          target->name, target->name);
    if (target->nfinishes == 0)
        strcpy(target->finishes[target->nfinishes++].name, ORIGINAL);
    for (int k = 0; k < 2; k++) {
        TargetFinish *tilted = &target->finishes[target->nfinishes++];
        tilted->finish = target->finishes[0].finish;
        strcpy(tilted->name, names[k]);
    }
    target->has_normals = 1;
    return RETEX_OK;
}

static int read_spec(Scene *scene, const char *spec, RetexError *err)
{
    Target *target;
    int code = find_target(&target, scene, "--finish", spec, err);
    if (!code && target->nfinishes)
        return retex_fail(err, RETEX_EINVAL, "--finish: %s is given finishes twice", target->name);
    for (const char *at = strrchr(spec, '='); !code && at;) {
        const size_t length = strcspn(++at, ",");
        if (length == strlen(NORMALS) && strncasecmp(at, NORMALS, length) == 0)
            return add_normals(target, at + length, err);
        if (target->nfinishes == FINISHES_MAX)
            return retex_fail(err, RETEX_ELIMIT, "--finish: %s has more than %d finishes", target->name, FINISHES_MAX);
        TargetFinish *added = &target->finishes[target->nfinishes];
        code = read_finish(added, scene, target, at, length, err);
        for (int k = 0; k < target->nfinishes && !code; k++)
            if (strcmp(target->finishes[k].name, added->name) == 0)
                code = retex_fail(err, RETEX_EINVAL, "--finish: %s has finish %s twice", target->name, added->name);
        target->nfinishes++;
        at = at[length] ? at + length : NULL;
    }
    return code;
}

/* The one in the picture: shown[t]. */
static int read_shown(Scene *scene, const char *spec, int shown[RETEX_MAX_TARGETS], RetexError *err)
{
    Target *target;
    const int code = find_target(&target, scene, "--show", spec, err);
    if (code)
        return code;
    const char *name = strrchr(spec, '=') + 1;
    for (int k = 0; k < (target->has_normals ? 1 : target->nfinishes); k++)
        if (strcasecmp(target->finishes[k].name, name) == 0) {
            shown[target - scene->targets] = k;
            return RETEX_OK;
        }
    return retex_fail(err, RETEX_ENOTFOUND, "--show `%s`: --finish gives %s no finish of that name", spec,
                      target->name);
}

/* ---- combinations ---- */

/* Number them: the finish of the first target changes the fastest. */
static int number_combinations(Scene *scene, const int shown[RETEX_MAX_TARGETS], RetexError *err)
{
    long count = 1;
    int step = 1;
    for (int t = 0; t < scene->ntargets; t++)
        count *= scene->targets[t].nfinishes ? scene->targets[t].nfinishes : 1;
    if (count > COMBINATIONS_MAX)
        return retex_fail(err, RETEX_ELIMIT, "--finish: %ld combinations of finishes, where there may be %d", count,
                          COMBINATIONS_MAX);
    const int lamps = scene->nlamps ? scene->nlamps - 1 : 1;
    if (count > 1 && count * lamps > LAMPS_MAX)
        return retex_fail(err, RETEX_ELIMIT,
                          "--finish: %ld combinations of finishes times %d lamps, where there may be %d", count, lamps,
                          LAMPS_MAX);
    scene->ncombinations = count > 1 ? (int)count : 0;
    scene->shown = 0;
    for (int t = 0; t < scene->ntargets; t++) {
        const int own = scene->targets[t].nfinishes ? scene->targets[t].nfinishes : 1;
        for (int c = 0; c < count; c++)
            scene->finish_of[c][t] = (unsigned char)(c / step % own);
        scene->shown += shown[t] * step;
        step *= own;
    }
    return RETEX_OK;
}

int scene_resolve_finishes(Scene *scene, const char *const *specs, int nspecs, const char *const *shown, int nshown,
                           RetexError *err)
{
    int of[RETEX_MAX_TARGETS] = {0}, code = RETEX_OK;
    for (int k = 0; k < nspecs && !code; k++)
        code = read_spec(scene, specs[k], err);
    for (int k = 0; k < nshown && !code; k++)
        code = read_shown(scene, shown[k], of, err);
    if (!code)
        code = number_combinations(scene, of, err);
    if (!code)
        scene_number_kept(scene);
    return code;
}
