/* Targets and lamps by what pixels show, or what lies at points of the scene. `@X:Y` and `@X:Y:Z` become the number of
 * the object there, with the scope of what is taken with it, which a set keeps: at another size the same pixel would
 * show another one. What a scene offers by a name is put in its place before that. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "job/job.h"
#include "light/environment.h"
#include "path/projection.h"
#include "path/target_units.h"
#include "faces/faces.h"
#include "faces/nearest.h"

enum { PIXELS_MAX = 64 };
typedef struct Pixels {
    SelectorScope scope; /* of those that name none */
    int count;
    unsigned char is_point[PIXELS_MAX]; /* of the scene */
    int at[PIXELS_MAX][2];
    Vec3 points[PIXELS_MAX];
    SelectorScope scopes[PIXELS_MAX];
    ShownSurface shown[PIXELS_MAX];
} Pixels;

/* The first selector of a target's; NULL where it has none but its name. */
static const char *first_selector(const char *spec)
{
    const char *equals = strchr(spec, '=');
    return equals ? equals + 1 : NULL;
}

/* The next one; NULL after the last. */
static const char *next_selector(const char *selector)
{
    selector += selector_length(selector);
    return *selector ? selector + 1 : NULL;
}

/* X:Y:Z, in scene units. */
static int read_point(const char *text, Vec3 *point)
{
    double at[3];
    for (int k = 0; k < 3; k++) {
        char *end;
        at[k] = strtod(text, &end);
        if (end == text || !(fabs(at[k]) < 1e15) || *end != (k < 2 ? ':' : 0))
            return 0;
        text = end + 1;
    }
    *point = vec3(at[0], at[1], at[2]);
    return 1;
}

static int find_pixels(Pixels *pixels, const char *spec, RetexError *err)
{
    for (const char *at = first_selector(spec); at; at = next_selector(at)) {
        char word[128], *slash;
        int k = pixels->count;
        if (*at != '@')
            continue;
        snprintf(word, sizeof word, "%.*s", (int)selector_length(at), at);
        if (k == PIXELS_MAX)
            return retex_fail(err, RETEX_EINVAL, "more than %d pixels name targets", PIXELS_MAX);
        pixels->scopes[k] = pixels->scope;
        if ((slash = strchr(word, '/')))
            *slash = 0;
        pixels->is_point[k] = (unsigned char)read_point(word + 1, &pixels->points[k]);
        if ((!pixels->is_point[k] && !job_numbers(word + 1, ':', 2, pixels->at[k])) ||
            (slash && !selector_scope(&pixels->scopes[k], slash + 1)))
            return retex_fail(err, RETEX_EINVAL,
                              "target `%.*s`: expected @X:Y, a pixel of the picture, or @X:Y:Z, a point of the scene; "
                              "or after either /material, /object, /flat or /level",
                              (int)selector_length(at), at);
        pixels->count++;
    }
    return RETEX_OK;
}

/* The text that stands for a pixel. */
static int name_shown(char text[SELECTOR_MAX], const ShownSurface *shown, SelectorScope scope,
                      const Materials *materials, RetexError *err)
{
    int *flat = scope == SCOPE_FLAT && faces_count(shown->primitive) ? faces_flat(shown->primitive) : NULL;
    const int named = shown_selector(text, shown, scope, materials, flat);
    free(flat);
    return named ? RETEX_OK : retex_fail(err, RETEX_EUNSUPPORTED, "what a pixel shows has no number");
}

/* The target with numbers of objects in the place of pixels, from the k-th pixel on. */
static int name_objects(Scene *scene, const Pixels *pixels, const Materials *materials, int *k, const char *spec,
                        const char **named, RetexError *err)
{
    const char *at = first_selector(spec);
    size_t size = strlen(spec) + 1, used = at ? (size_t)(at - spec) : 0;
    int code = RETEX_OK;
    for (const char *p = spec; (p = strchr(p, '@')); p++)
        size += 64;
    char *text = arena_alloc(scene->arena, size);
    if (!text)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    memcpy(text, spec, used);
    for (; at && !code; at = next_selector(at)) {
        char object[SELECTOR_MAX];
        const int is_pixel = *at == '@';
        if (is_pixel) {
            code = name_shown(object, &pixels->shown[*k], pixels->scopes[*k], materials, err);
            ++*k;
        }
        if (code)
            return code;
        const int length = is_pixel ? (int)strlen(object) : (int)selector_length(at);
        used += (size_t)snprintf(text + used, size - used, "%.*s%s", length, is_pixel ? object : at,
                                 next_selector(at) ? "," : "");
    }
    *named = text;
    return code;
}

static int name_all(Scene *scene, const Pixels *pixels, const char *const *specs, int nspecs, const char **named,
                    RetexError *err)
{
    Materials materials;
    int code = RETEX_OK, next = 0;
    if (!materials_open(&materials, scene))
        return retex_fail(err, RETEX_ENOMEM, "no memory for the materials of the scene");
    for (int k = 0; k < nspecs && !code; k++)
        if (first_selector(specs[k]))
            code = name_objects(scene, pixels, &materials, &next, specs[k], &named[k], err);
    materials_close(&materials);
    return code;
}

static int find_shown(Pixels *pixels, const Scene *scene, const RenderParams *render, RetexError *err)
{
    int pixel[PIXELS_MAX][2], of[PIXELS_MAX], count = 0, code = RETEX_OK;
    ShownSurface shown[PIXELS_MAX];
    for (int k = 0; k < pixels->count && !code; k++) {
        if (pixels->is_point[k])
            code = faces_nearest(&pixels->shown[k], scene, pixels->points[k], err);
        else
            memcpy(pixel[count], pixels->at[k], sizeof *pixel), of[count++] = k;
    }
    if (!code && count)
        code = render_pick(scene, render, count, (const int(*)[2])pixel, shown, err);
    for (int k = 0; k < count && !code; k++)
        pixels->shown[of[k]] = shown[k];
    return code;
}

/* Copies of the specs, in which numbers of objects stand for pixels. scope: of pixels that name none. */
static int name_pixels(Scene *scene, const RenderParams *render, const char *const *specs, int nspecs,
                       SelectorScope scope, const char **named, RetexError *err)
{
    Pixels pixels = {.scope = scope};
    int code = RETEX_OK;
    for (int k = 0; k < nspecs && !code; k++)
        named[k] = specs[k], code = find_pixels(&pixels, specs[k], err);
    if (code || !pixels.count)
        return code;
    code = find_shown(&pixels, scene, render, err);
    return code ? code : name_all(scene, &pixels, specs, nspecs, named, err);
}

/* Text of two parts, in the scene's arena. */
static int join(Scene *scene, const char **text, const char *a, size_t length, const char *b, RetexError *err)
{
    char *made = arena_alloc(scene->arena, length + strlen(b) + 1);
    if (!made)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    memcpy(made, a, length);
    memcpy(made + length, b, strlen(b) + 1);
    *text = made;
    return RETEX_OK;
}

/* Options stand at the end: they are taken off while pixels are named. */
static int name_targets(Scene *scene, const RenderParams *render, const char *const *specs, int nspecs,
                        const char **named, RetexError *err)
{
    const char *bare[RETEX_MAX_TARGETS] = {0};
    int code = RETEX_OK;
    for (int k = 0; k < nspecs && !code; k++)
        code = join(scene, &bare[k], specs[k], (size_t)(target_spec_options(specs[k]) - specs[k]), "", err);
    if (!code)
        code = name_pixels(scene, render, bare, nspecs, SCOPE_MATERIAL, named, err);
    for (int k = 0; k < nspecs && !code; k++)
        code = join(scene, &named[k], named[k], strlen(named[k]), target_spec_options(specs[k]), err);
    return code;
}

/* A target that the scene offers, as NAME=SELECTORS, with the options of the spec if it has any; else the spec. */
static int take_offered(Scene *scene, const char *spec, const char **taken, RetexError *err)
{
    const char *options = target_spec_options(spec);
    char name[RETEX_NAME_MAX];
    const SceneTarget *offered = NULL;
    *taken = spec;
    if (!strchr(spec, '=') || strchr(spec, '=') > options) {
        snprintf(name, sizeof name, "%.*s", (int)(options - spec), spec);
        offered = scene_offers(scene, name);
    }
    if (!offered)
        return RETEX_OK;
    const char *selectors = offered->selectors, *end = target_spec_options(selectors);
    const size_t size = strlen(name) + strlen(selectors) + strlen(options) + 2;
    char *text = arena_alloc(scene->arena, size);
    if (!text)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    snprintf(text, size, "%s=%.*s%s", name, (int)(end - selectors), selectors, *options ? options : end);
    *taken = text;
    return RETEX_OK;
}

static int resolve(Scene *scene, const RenderParams *render, const char *const *targets, int ntargets, RetexError *err)
{
    const char *named[RETEX_MAX_TARGETS];
    int code = name_targets(scene, render, targets, ntargets, named, err);
    if (!code)
        code = scene_resolve_targets(scene, named, ntargets, err);
    if (!code)
        code = faces_mark(scene, err);
    if (!code)
        code = projection_choose(scene, render->unit, err);
    if (!code)
        target_units_choose(scene);
    return code;
}

/* What was typed is a name: say which of those that the scene offers cannot be. */
static int explain(Scene *scene, const RenderParams *render, const char *const *typed, const char *const *taken,
                   int ntargets, int code, RetexError *err)
{
    RetexError why = {0};
    for (int k = 0; k < ntargets; k++)
        if (taken[k] != typed[k] && resolve(scene, render, &taken[k], 1, &why))
            return retex_fail(err, code, "target `%s` of the scene: %s", typed[k], why.message);
    return code;
}

int job_resolve_targets(Scene *scene, const RenderParams *render, const char *const *targets, int ntargets,
                        RetexError *err)
{
    const char *taken[RETEX_MAX_TARGETS];
    if (ntargets > RETEX_MAX_TARGETS)
        return scene_resolve_targets(scene, targets, ntargets, err);
    int code = RETEX_OK;
    for (int k = 0; k < ntargets && !code; k++)
        code = take_offered(scene, targets[k], &taken[k], err);
    if (code)
        return code;
    code = resolve(scene, render, taken, ntargets, err);
    return code ? explain(scene, render, targets, taken, ntargets, code, err) : code;
}

int job_resolve_lamps(Scene *scene, const RenderParams *render, const JobNames *names, RetexError *err)
{
    const char *named[LAMPS_MAX], *const *specs = names->lamps;
    int count = names->nlamps, code = RETEX_OK;
    if (names->each_lamp)
        code = scene_each_lamp(scene, sky_shines(scene) || !rgb_is_black(scene->background), 0, &specs, &count, err);
    if (code || count > LAMPS_MAX)
        return code ? code : scene_resolve_lamps(scene, specs, count, err);
    code = name_pixels(scene, render, specs, count, SCOPE_OBJECT, named, err);
    return code ? code : scene_resolve_lamps(scene, named, count, err);
}
