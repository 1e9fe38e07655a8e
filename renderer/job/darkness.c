/* Finds out whether a scene has any emitter, and any object, to warn before a black picture is rendered. */
#include <stdio.h>
#include "job/job.h"
#include "light/environment.h"

/* Whether any surface has `ambient`, including inner sides and faces of meshes. */
static int any_ambient(const Scene *scene)
{
    const Texture *texture;
    int target;
    for (int k = 0; k < scene->nprimitives; k++)
        for (int i = 0; (texture = primitive_texture(&scene->primitives[k], i, &target)); i++)
            for (int j = 0; j < texture_leaf_count(texture); j++)
                if (!rgb_is_black(texture_leaf(texture, j)->finish->ambient))
                    return 1;
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
    else if (!glows && !any_light_source(scene) && !scene_has_emitters(scene))
        why = scene->nlights
                  ? "its light sources are black, nothing shines and there is no sky: the picture will be black"
                  : "no light source, nothing that shines and no sky: the picture will be black";
    if (!why || !sdl->message)
        return;
    if (!is_empty && sdl->ambient <= 0 && !rgb_is_black(scene->ambient_light) && any_ambient(scene))
        advice = sdl->ambient ? "; `ambient` gives no light with --no-ambient"
                              : "; weak `ambient`, or ambient beside radiosity, gives light with --ambient only";
    snprintf(text, sizeof text, "%s: warning: %s%s", scene->path, why, advice);
    sdl->message(sdl->message_context, 1, text);
}
