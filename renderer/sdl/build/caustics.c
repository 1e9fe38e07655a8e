/* Which light sources throw caustics, and by which primitives: photons blocks, and the options that override them. */
#include "sdl/build/builder.h"
#include "shade/material.h"
#include "shape/shape.h"

#define SIZE_OF_DISTANCE (1.0 / 200) /* radius of a light source, of its distance from what it shines through */

static void set_flag(Sdl *sdl, unsigned *flags, unsigned flag)
{
    *flags = sdl_optional_bool(sdl, 1) ? *flags | flag : *flags & ~flag;
}

void parse_photons(Sdl *sdl, unsigned *flags)
{
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        if (sdl_accept(sdl, "target"))
            set_flag(sdl, flags, OBJECT_PHOTON_TARGET);
        else if (sdl_accept(sdl, "refraction"))
            set_flag(sdl, flags, OBJECT_PHOTONS_REFRACT);
        else if (sdl_accept(sdl, "reflection"))
            set_flag(sdl, flags, OBJECT_PHOTONS_REFLECT);
        else if (sdl_accept(sdl, "collect") || sdl_accept(sdl, "pass_through") || sdl_accept(sdl, "area_light"))
            sdl_optional_bool(sdl, 1);
        else
            sdl_expected(sdl, "target, refraction, reflection, collect, pass_through, area_light or } in photons");
}

/* The middle of all that throws caustics. Returns 0 where nothing does. */
static int find_middle(const Scene *scene, Vec3 *middle)
{
    Vec3 all_low = {INFINITY, INFINITY, INFINITY}, all_high = {-INFINITY, -INFINITY, -INFINITY};
    int found = 0, bounded = 0;
    for (int k = 0; k < scene->nprimitives; k++) {
        Vec3 low, high;
        if (!scene->primitives[k].caustics)
            continue;
        found = 1;
        if (scene->primitives[k].prototype || !shape_bounds(&scene->primitives[k], &low, &high))
            continue;
        bounded = 1;
        all_low = vec3(fmin(all_low.x, low.x), fmin(all_low.y, low.y), fmin(all_low.z, low.z));
        all_high = vec3(fmax(all_high.x, high.x), fmax(all_high.y, high.y), fmax(all_high.z, high.z));
    }
    *middle = bounded ? vec_scale(vec_add(all_low, all_high), 0.5) : vec3(0, 0, 0);
    return found;
}

static double default_size(const Light *light, Vec3 middle)
{
    const int beam = light->kind == LIGHT_PARALLEL || light->kind == LIGHT_CYLINDER;
    return SIZE_OF_DISTANCE * vec_length(vec_sub(light->location, beam ? light->point_at : middle));
}

void find_caustics(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const int flag = sdl_options(sdl)->caustics, wanted = flag ? flag > 0 : builder_of(sdl)->photons;
    Vec3 middle;
    for (int k = 0; k < scene->nprimitives; k++) {
        Primitive *p = &scene->primitives[k];
        if (!wanted)
            p->caustics = 0;
        else if (flag > 0)
            p->caustics = primitive_casts_caustics(p) ? CAUSTICS_REFRACT | CAUSTICS_REFLECT : 0;
    }
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
