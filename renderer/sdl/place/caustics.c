/* Which light sources throw caustics, and by which primitives: as photons blocks say, and the options that override
 * them. */
#include "light/source.h"
#include "sdl/place/place.h"
#include "shade/casters.h"
#include "shape/shape.h"

#define SIZE_OF_DISTANCE (1.0 / 200) /* radius of a light source, of its distance from what it shines through */

/* Where what throws caustics is. */
typedef struct Extent {
    int found, bounded;
    Vec3 low, high;
} Extent;

static int add_extent(void *context, const Caster *caster)
{
    Extent *all = context;
    all->found = 1;
    if (!caster->is_bounded)
        return 0;
    all->bounded = 1;
    shape_bound_point(&all->low, &all->high, caster->low);
    shape_bound_point(&all->low, &all->high, caster->high);
    return 0;
}

/* The middle of all that throws caustics. Returns 0 where nothing does. */
static int find_middle(const Scene *scene, Vec3 *middle)
{
    Extent all = {.low = {INFINITY, INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY, -INFINITY}};
    casters_visit(scene, CASTERS_OF_SOURCES, add_extent, &all);
    *middle = all.bounded ? vec_scale(vec_add(all.low, all.high), 0.5) : vec3(0, 0, 0);
    return all.found;
}

static double default_size(const Light *light, Vec3 middle)
{
    return SIZE_OF_DISTANCE * vec_length(vec_sub(light->location, light_is_beam(light) ? light->point_at : middle));
}

static int mark(void *context, const Caster *caster)
{
    Scene *scene = context;
    scene->primitives[caster->primitive].caustics = CAUSTICS_REFRACT | CAUSTICS_REFLECT;
    return 0;
}

void find_caustics(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const int flag = sdl_options(sdl)->caustics, wanted = flag ? flag > 0 : builder_of(sdl)->global.photons;
    Vec3 middle;
    if (!wanted || flag > 0)
        for (int k = 0; k < scene->nprimitives; k++)
            scene->primitives[k].caustics = 0;
    if (flag > 0)
        casters_visit(scene, CASTERS_OF_EMITTERS, mark, scene);
    const int found = wanted && find_middle(scene, &middle);
    for (int k = 0; k < scene->nlights; k++) {
        Light *light = &scene->lights[k];
        if (flag > 0)
            light->caustics = CAUSTICS_REFRACT | CAUSTICS_REFLECT;
        if (!found || light->shadowless)
            light->caustics = 0;
        else if (light->size <= 0)
            light->size = default_size(light, middle);
        if (!(light->size > 0))
            light->caustics = 0;
    }
}
