/* Parser of isosurfaces. */
#include "sdl/object/shape.h"
#include "shape/isosurface.h"

/* contained_by { box { A, B } } or { sphere { C, R } } */
int accept_container(Sdl *sdl, Container *container)
{
    if (!sdl_accept(sdl, "contained_by"))
        return 0;
    sdl_expect(sdl, "{");
    if (sdl_accept(sdl, "sphere")) {
        sdl_expect(sdl, "{");
        container->spherical = 1;
        container->centre = sdl_vector(sdl);
        sdl_optional_comma(sdl);
        container->radius = fabs(sdl_float(sdl));
        const Vec3 half = vec3(container->radius, container->radius, container->radius);
        container->low = vec_sub(container->centre, half);
        container->high = vec_add(container->centre, half);
    } else {
        sdl_expect(sdl, "box");
        sdl_expect(sdl, "{");
        container->spherical = 0;
        const Vec3 a = sdl_vector(sdl);
        sdl_optional_comma(sdl);
        const Vec3 b = sdl_vector(sdl);
        container->low = vec3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
        container->high = vec3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
        container->centre = vec_scale(vec_add(container->low, container->high), 0.5);
    }
    sdl_expect(sdl, "}");
    sdl_expect(sdl, "}");
    return 1;
}

double positive_or(Sdl *sdl, const char *what, double value, double instead)
{
    if (value > 0 && value < INFINITY)
        return value;
    sdl_warn(sdl, "%s %g is not positive: %g is used", what, value, instead);
    return instead;
}

static int accept_option(Sdl *sdl, Isosurface *iso)
{
    if (sdl_accept(sdl, "threshold"))
        iso->threshold = sdl_float(sdl);
    else if (sdl_accept(sdl, "accuracy"))
        iso->accuracy = positive_or(sdl, "accuracy", sdl_float(sdl), 0.001);
    else if (sdl_accept(sdl, "max_gradient"))
        iso->max_gradient = positive_or(sdl, "max_gradient", sdl_float(sdl), 1.1);
    else if (sdl_accept(sdl, "max_trace"))
        sdl_float(sdl);
    else if (sdl_accept(sdl, "evaluate")) {
        iso->evaluates = 1;
        iso->least = sdl_float(sdl);
        sdl_optional_comma(sdl);
        iso->factor = sdl_float(sdl);
        sdl_optional_comma(sdl);
        iso->fall = sdl_float(sdl);
    } else if (sdl_accept(sdl, "open"))
        iso->open = 1;
    else
        return sdl_accept(sdl, "all_intersections") || accept_container(sdl, &iso->container);
    return 1;
}

void parse_isosurface(Sdl *sdl, Object *object)
{
    Isosurface *iso = sdl_alloc(sdl, sizeof *iso);
    *iso = (Isosurface){.accuracy = 0.001, .max_gradient = 1.1, .container = CONTAINER_INIT};
    if (!sdl_is(sdl, "function"))
        sdl_expected(sdl, "`function`");
    const Value function = sdl_function(sdl);
    object->shape.ops = &shape_isosurface;
    object->shape.data = iso;
    while (accept_option(sdl, iso))
        ;
    iso->function = sdl_function_program(sdl, &function, 3);
    const Vec3 size = vec_sub(iso->container.high, iso->container.low);
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) {
        sdl_warn(sdl, "an isosurface contained by nothing: it is left out");
        object->kind = OBJECT_EMPTY;
    } else if (iso->evaluates)
        sdl_step(sdl, isosurface_learn(iso) * iso->function->ninstructions);
}
