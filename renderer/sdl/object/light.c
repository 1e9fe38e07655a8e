/* light_source. A light is an object like others until it is placed; the object of its looks_like is its child. */
#include <string.h>
#include "light/source.h"
#include "sdl/object/object.h"

static Light *light_new(Sdl *sdl)
{
    Light *light = sdl_alloc(sdl, sizeof *light);
    light->ops = &light_point;
    light->point_at = vec3(0, 0, 1);
    light->color = rgb_grey(1);
    light->radius = 30;
    light->falloff = 45;
    light->caustics = CAUSTICS_REFRACT | CAUSTICS_REFLECT;
    return light;
}

static void set_kind(Light *light, const LightOps *kind)
{
    if (kind->yields_to && strcmp(kind->yields_to, light->ops->name) == 0)
        return;
    light->ops = kind;
    if (!(kind->properties & LIGHT_SHADOWLESS))
        light->shadowless = 0;
    if (kind->set_defaults)
        kind->set_defaults(light);
}

/* To POV-Ray this is one more kind, and the last one written counts; but parallel goes with it. */
static void set_shadowless(Light *light, int shadowless)
{
    light->shadowless = shadowless;
    if (shadowless && !(light->ops->properties & LIGHT_SHADOWLESS))
        light->ops = &light_point;
}

static void area_light(Sdl *sdl, Light *light)
{
    light->axis1 = sdl_vector(sdl);
    sdl_optional_comma(sdl);
    light->axis2 = sdl_vector(sdl);
    sdl_optional_comma(sdl);
    double size1 = floor(sdl_float(sdl));
    sdl_optional_comma(sdl);
    double size2 = floor(sdl_float(sdl));
    if (!(size1 >= 1 && size2 >= 1 && size1 <= 4096 && size2 <= 4096))
        sdl_error(sdl, "an area_light has 1 to 4096 lights a side, not %g by %g", size1, size2);
    light->area = 1;
    light->size1 = (int)size1;
    light->size2 = (int)size2;
}

/* { an object and what modifies it } */
static Object *object_in(Sdl *sdl, const char *where)
{
    sdl_expect(sdl, "{");
    const Object *inner = accept_ident(sdl, VALUE_OBJECT);
    if (!inner)
        inner = accept_object(sdl);
    if (!inner)
        sdl_expected(sdl, where);
    Object *child = object_new(sdl, OBJECT_EMPTY);
    *child = *inner;
    parse_object_modifiers(sdl, child);
    return child;
}

/* What the light passes through is in the light's own space, as its location. It is not seen. */
static void projected_through(Sdl *sdl, Object *object)
{
    Object *child = object_in(sdl, "an object in projected_through");
    object_count_child(sdl, object, child);
    const Transform back = transform_inverse(object->transform);
    object_move(child, &back);
    object->projector = child;
}

static void looks_like(Sdl *sdl, Object *object)
{
    Object *child = object_in(sdl, "an object in looks_like");
    ObjectList *list = sdl_alloc(sdl, sizeof *list);
    list->object = child;
    object_count_child(sdl, object, child);
    object->children = list;
}

static int accept_geometry(Sdl *sdl, Light *light)
{
    if (sdl_accept(sdl, "point_at"))
        light->point_at = sdl_vector(sdl), light->is_aimed = 1;
    else if (sdl_accept(sdl, "area_light"))
        area_light(sdl, light);
    else if (sdl_accept(sdl, "adaptive"))
        sdl_float(sdl); /* all of the grid is sampled */
    else
        return sdl_accept_float(sdl, "radius", &light->radius) || sdl_accept_float(sdl, "falloff", &light->falloff) ||
               sdl_accept_float(sdl, "tightness", &light->tightness) ||
               sdl_accept_float(sdl, "fade_distance", &light->fade_distance) ||
               sdl_accept_float(sdl, "fade_power", &light->fade_power);
    return 1;
}

static int accept_switch(Sdl *sdl, Light *light)
{
    if (sdl_accept(sdl, "circular"))
        light->circular = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "orient"))
        light->orient = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "shadowless") || sdl_accept(sdl, "fill_light"))
        set_shadowless(light, sdl_optional_bool(sdl, 1));
    else if (sdl_accept(sdl, "jitter"))
        light->jitter = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "area_illumination"))
        light->area_illumination = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "media_attenuation"))
        light->dimmed_by_air = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "media_interaction"))
        light->passes_media = !sdl_optional_bool(sdl, 1);
    else
        return 0;
    return 1;
}

static int accept_kind(Sdl *sdl, Light *light)
{
    static const LightOps *const kinds[] = {
#define X(name) &light_##name,
        LIGHT_TABLE(X)
#undef X
    };
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        if (kinds[i] != &light_point && sdl_accept(sdl, kinds[i]->name)) {
            set_kind(light, kinds[i]);
            return 1;
        }
    return 0;
}

static void photons(Sdl *sdl, Light *light)
{
    unsigned flags = (light->caustics & CAUSTICS_REFRACT ? OBJECT_PHOTONS_REFRACT : 0) |
                     (light->caustics & CAUSTICS_REFLECT ? OBJECT_PHOTONS_REFLECT : 0);
    parse_photons(sdl, &flags);
    light->caustics = (flags & OBJECT_PHOTONS_REFRACT ? CAUSTICS_REFRACT : 0) |
                      (flags & OBJECT_PHOTONS_REFLECT ? CAUSTICS_REFLECT : 0);
}

/* Our extension: retex{ radius R ies "FILE" turn DEGREES }. */
static void extension(Sdl *sdl, Light *light)
{
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "radius")) {
            light->size = sdl_float(sdl);
            if (!(light->size > 0))
                sdl_error(sdl, "the radius of a light must be above 0, not %g", light->size);
        } else if (sdl_accept(sdl, "ies")) {
            light->ies = parse_ies(sdl);
            light->ies_turn = sdl_accept(sdl, "turn") ? sdl_float(sdl) : 0;
        } else
            sdl_expected(sdl, "radius, ies or } in retex");
    }
}

/* A light distribution needs light that leaves a point, and an axis. */
static void check_ies(Sdl *sdl, const Light *light)
{
    if (light_is_beam(light))
        sdl_error(sdl, "a light with ies cannot be %s: all of its light would go one way", light->ops->name);
    if (light->is_aimed && vec_length(vec_sub(light->point_at, light->location)) <= 0)
        sdl_error(sdl, "a light with ies has no axis: its point_at is its location");
}

/* The object's transform is applied when it is placed: location and point_at are in its own space. */
static void modifier(Sdl *sdl, Object *object, Light *light)
{
    Transform by;
    if (accept_transform(sdl, &by))
        object_move(object, &by);
    else if (accept_kind(sdl, light) || accept_geometry(sdl, light) || accept_switch(sdl, light))
        ;
    else if (sdl_accept(sdl, "looks_like"))
        looks_like(sdl, object);
    else if (sdl_accept(sdl, "projected_through"))
        projected_through(sdl, object);
    else if (sdl_accept(sdl, "groups"))
        sdl_string(sdl);
    else if (sdl_accept(sdl, "photons"))
        photons(sdl, light);
    else if (sdl_accept(sdl, "retex"))
        extension(sdl, light);
    else if (sdl_is(sdl, "bounded_by"))
        skip_statement(sdl);
    else if (sdl_is_color_start(sdl)) {
        Rgbft c = sdl_color(sdl);
        light->color = rgb(c.r, c.g, c.b);
    } else
        sdl_expected(sdl, "a light's modifier or }");
}

static const Object *known_light(Sdl *sdl)
{
    const Object *known = accept_ident(sdl, VALUE_LIGHT);
    return known ? known : accept_ident(sdl, VALUE_OBJECT);
}

const Object *parse_light_source(Sdl *sdl)
{
    Object *object = object_new(sdl, OBJECT_LIGHT);
    Light *light = light_new(sdl);
    sdl_expect(sdl, "{");
    const Object *known = known_light(sdl);
    if (known) {
        *object = *known;
        if (known->kind == OBJECT_LIGHT)
            *light = *known->light;
    } else {
        light->location = sdl_vector(sdl);
        sdl_optional_comma(sdl);
        if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl)) {
            Rgbft c = sdl_color(sdl);
            light->color = rgb(c.r, c.g, c.b);
        }
    }
    object->light = light;
    while (!sdl_accept(sdl, "}"))
        modifier(sdl, object, light), sdl_optional_comma(sdl);
    if (light->ies)
        check_ies(sdl, light);
    if (rgb_luminance(light->color) < 0)
        sdl_unsupported(sdl, "light_source of negative colour", "it takes no light away");
    return object;
}
