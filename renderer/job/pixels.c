/* Targets by what pixels show. `@X:Y` becomes the number of the object there, which a set keeps: at another size the
 * same pixel would show another one. */
#include <stdio.h>
#include <string.h>
#include "job/job.h"
#include "path/target_units.h"

enum { PIXELS_MAX = 64 };
typedef struct Pixels {
    int count;
    int at[PIXELS_MAX][2];
    ObjectPart shown[PIXELS_MAX];
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

static int find_pixels(Pixels *pixels, const char *spec, RetexError *err)
{
    for (const char *at = first_selector(spec); at; at = next_selector(at)) {
        char word[64];
        if (*at != '@')
            continue;
        snprintf(word, sizeof word, "%.*s", (int)selector_length(at), at);
        if (pixels->count == PIXELS_MAX)
            return retex_fail(err, RETEX_EINVAL, "more than %d pixels name targets", PIXELS_MAX);
        if (!job_numbers(word + 1, ':', 2, pixels->at[pixels->count++]))
            return retex_fail(err, RETEX_EINVAL, "target `%s`: expected @X:Y, a pixel of the picture", word);
    }
    return RETEX_OK;
}

/* The target with numbers of objects in the place of pixels, from the k-th pixel on. */
static int name_objects(Scene *scene, const Pixels *pixels, int *k, const char *spec, const char **named,
                        RetexError *err)
{
    const char *at = first_selector(spec);
    size_t size = strlen(spec) + 1, used = at ? (size_t)(at - spec) : 0;
    for (const char *p = spec; (p = strchr(p, '@')); p++)
        size += 32;
    char *text = arena_alloc(scene->arena, size);
    if (!text)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the targets");
    memcpy(text, spec, used);
    for (; at; at = next_selector(at)) {
        char object[SELECTOR_MAX];
        const int is_pixel = *at == '@';
        if (is_pixel)
            selector_of_object(object, &pixels->shown[(*k)++]);
        const int length = is_pixel ? (int)strlen(object) : (int)selector_length(at);
        used += (size_t)snprintf(text + used, size - used, "%.*s%s", length, is_pixel ? object : at,
                                 next_selector(at) ? "," : "");
    }
    *named = text;
    return RETEX_OK;
}

int job_resolve_targets(Scene *scene, const RenderParams *render, const char *const *targets, int ntargets,
                        RetexError *err)
{
    const char *named[RETEX_MAX_TARGETS];
    Pixels pixels = {.count = 0};
    int code = RETEX_OK, next = 0;
    if (ntargets > RETEX_MAX_TARGETS)
        return scene_resolve_targets(scene, targets, ntargets, err);
    for (int k = 0; k < ntargets && !code; k++)
        code = find_pixels(&pixels, targets[k], err);
    if (!code && pixels.count)
        code = render_pick(scene, render, pixels.count, (const int(*)[2])pixels.at, pixels.shown, err);
    for (int k = 0; k < ntargets && !code; k++) {
        named[k] = targets[k];
        if (pixels.count && first_selector(targets[k]))
            code = name_objects(scene, &pixels, &next, targets[k], &named[k], err);
    }
    if (!code)
        code = scene_resolve_targets(scene, named, ntargets, err);
    if (!code)
        target_units_choose(scene);
    return code;
}
