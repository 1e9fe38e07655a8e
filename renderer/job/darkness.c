/* Finds out whether a scene has any emitter, and any object, to warn before a black picture is rendered. */
#include <stdio.h>
#include "job/job.h"
#include "light/environment.h"

static int texture_is(const Texture *texture, int (*has)(const Finish *))
{
    for (int k = 0; texture && k < texture_leaf_count(texture); k++)
        if (has(texture_leaf(texture, k)->finish))
            return 1;
    return 0;
}

static int emits(const Finish *finish)
{
    return !rgb_is_black(finish->emission);
}

static int is_ambient(const Finish *finish)
{
    return !rgb_is_black(finish->ambient);
}

/* Whether any surface of the scene emits light, including inner sides and faces of meshes. */
static int any_surface(const Scene *scene, int (*has)(const Finish *))
{
    for (int k = 0; k < scene->nprimitives; k++) {
        const Primitive *p = &scene->primitives[k];
        if (texture_is(p->texture, has) || texture_is(p->interior_texture, has))
            return 1;
        for (int f = 0; p->shape.textures && f < p->shape.textures->count; f++)
            if (texture_is(p->shape.textures->list[f], has))
                return 1;
    }
    return 0;
}

static int any_light_source(const Scene *scene)
{
    for (int k = 0; k < scene->nlights; k++)
        if (!rgb_is_black(scene->lights[k].color))
            return 1;
    return 0;
}

void job_warn_dark(const Scene *scene, const SdlOptions *sdl)
{
    char text[sizeof scene->path + 256];
    const int is_empty = !scene->nprimitives;
    const int glows = sky_shines(scene) || scene->fogs || scene->rainbows || scene->has_media;
    const char *why = NULL, *advice = "";
    if (is_empty)
        why = glows ? "no object in the scene" : "no object and no sky: the picture will be black";
    else if (!glows && !any_light_source(scene) && !any_surface(scene, emits))
        why = scene->nlights
                  ? "its light sources are black, nothing shines and there is no sky: the picture will be black"
                  : "no light source, nothing that shines and no sky: the picture will be black";
    if (!why || !sdl->message)
        return;
    if (!is_empty && sdl->ambient <= 0 && !rgb_is_black(scene->ambient_light) && any_surface(scene, is_ambient))
        advice = sdl->ambient ? "; `ambient` gives no light with --no-ambient"
                              : "; weak `ambient`, or ambient beside radiosity, gives light with --ambient only";
    snprintf(text, sizeof text, "%s: warning: %s%s", scene->path, why, advice);
    sdl->message(sdl->message_context, 1, text);
}
