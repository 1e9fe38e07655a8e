/* Finishes of targets, by name; only of surfaces that let no light through, which a finish might change. */
#include "job/job.h"
#include "shade/pigment.h"

/* Whether light stays on its side of the surface. */
static int is_closed(const Texture *leaf)
{
    return !finish_transmits(leaf->finish) && !finish_is_subsurface(leaf->finish) && pigment_is_opaque(leaf->pigment);
}

static int check_texture(const Scene *scene, const Texture *texture, int whole, RetexError *err)
{
    for (int k = 0; k < texture_leaf_count(texture); k++) {
        const Texture *leaf = texture_leaf(texture, k);
        const int target = texture_leaf_target(leaf, whole);
        if (target >= 0 && scene->targets[target].nfinishes && !is_closed(leaf))
            return retex_fail(
                err, RETEX_EUNSUPPORTED, "--finish: light goes %s target %s: its finish cannot be chosen later",
                finish_is_subsurface(leaf->finish) ? "below the surface of" : "through", scene->targets[target].name);
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
