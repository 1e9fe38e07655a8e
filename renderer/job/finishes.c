/* Finishes of targets, by name; only of surfaces that let no light through, which a finish might change. */
#include "job/job.h"
#include "shade/texture.h"

/* Layers may be open where what lies below them is not. */
static int check_texture(const Scene *scene, const Texture *texture, int whole, RetexError *err)
{
    const int is_opaque = texture_is_opaque(texture);
    for (int k = 0; k < texture_leaf_count(texture); k++) {
        const Texture *leaf = texture_leaf(texture, k);
        const int target = first_target(leaf->target, whole), scatters_below = finish_is_subsurface(leaf->finish);
        if (target >= 0 && scene->targets[target].nfinishes && (!is_opaque || scatters_below))
            return retex_fail(err, RETEX_EUNSUPPORTED,
                              "--finish: light goes %s target %s: its finish cannot be chosen later",
                              scatters_below ? "below the surface of" : "through", scene->targets[target].name);
    }
    return RETEX_OK;
}

int job_resolve_finishes(Scene *scene, const JobNames *names, RetexError *err)
{
    int code = scene_resolve_finishes(scene, names->finishes, names->nfinishes, names->shown, names->nshown, err);
    const Texture *texture;
    int target;
    for (int p = 0; p < scene->nprimitives && names->nfinishes; p++)
        for (int k = 0; !code && (texture = primitive_texture(&scene->primitives[p], k, &target)); k++)
            code = check_texture(scene, texture, target, err);
    for (int i = 0; i < scene->ninstances && names->nfinishes; i++)
        if (!code && scene->instances[i].texture)
            code = check_texture(
                scene, scene->instances[i].texture,
                scene->instances[i].target >= 0 ? scene->instances[i].target : scene->instances[i].texture_target, err);
    return code;
}
