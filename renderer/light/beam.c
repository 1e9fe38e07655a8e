/* Parallel light, which starts on the plane through its location, and cylinders of it. */
#include "light/source.h"

static double parallel_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    *direction = vec_normalize(vec_sub(place, light->point_at));
    /* POV-Ray lights points behind the plane too, without shadows */
    *distance = fmax(0, vec_dot(vec_sub(place, position), *direction));
    return 1;
}

/* A narrow cone of directions, as seen from anywhere. */
static int beam_meet(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    const Vec3 to = vec_sub(light->location, light->point_at);
    const double slope = light->size / vec_length(to), sin2 = slope * slope / (1 + slope * slope);
    const Vec3 across = vec_cross(vec_normalize(to), ray->direction);
    Vec3 direction;
    if (vec_dot(to, ray->direction) <= 0 || vec_dot(across, across) > sin2)
        return 0;
    *radiance = rgb_scale(source_irradiance(light, ray->origin, light->location, &direction, distance),
                          (float)(1 / (PI * sin2)));
    return 1;
}

const LightOps light_parallel = {.name = "parallel",
                                 .yields_to = "cylinder",
                                 .properties = LIGHT_BEAM | LIGHT_SHADOWLESS,
                                 .shine = parallel_shine,
                                 .meet = beam_meet};

/* ---- cylinders ---- */

static void cylinder_set_defaults(Light *light)
{
    light->radius = 0.75, light->falloff = 1;
}

static double cylinder_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    const Vec3 axis = light_axis(light), d = vec_sub(position, light->location);
    const double along = vec_dot(d, axis), across = vec_length(vec_mad(d, axis, -along));
    parallel_shine(light, position, place, direction, distance);
    if (along <= 0 || across >= light->falloff)
        return 0;
    const double share = 1 - across / light->falloff;
    const double edge = across > light->radius && light->radius > 0
                            ? light_smooth_step(0, 1 - light->radius / light->falloff, share)
                            : 1;
    return edge * (light->tightness > 0 ? pow(share, light->tightness) : 1);
}

static int cylinder_lit_part(const Light *light, Vec3 from, Vec3 direction, double *begin, double *end)
{
    const Vec3 axis = light_axis(light);
    const Vec3 f = vec_mad(from, axis, -vec_dot(from, axis)), d = vec_mad(direction, axis, -vec_dot(direction, axis));
    const double a = vec_dot(d, d), b = vec_dot(f, d), c = vec_dot(f, f) - light->falloff * light->falloff,
                 discriminant = b * b - a * c;
    if (a < 1e-12)
        return c < 0;
    *begin = fmax(*begin, (-b - sqrt(fmax(discriminant, 0))) / a);
    *end = fmin(*end, (-b + sqrt(fmax(discriminant, 0))) / a);
    return discriminant > 0;
}

const LightOps light_cylinder = {.name = "cylinder",
                                 .properties = LIGHT_BEAM,
                                 .set_defaults = cylinder_set_defaults,
                                 .shine = cylinder_shine,
                                 .meet = beam_meet,
                                 .lit_part = cylinder_lit_part};
