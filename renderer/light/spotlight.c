/* Spotlights: a point whose light falls off from its axis. */
#include "light/source.h"

/* A spot may not be wider in the middle than it is at the edge. */
static void spot_settle(Light *light)
{
    light->falloff = fmax(light->falloff, light->radius);
}

static double spot_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    if (point_shine(light, position, place, direction, distance) <= 0)
        return 0;
    const double cosine = -vec_dot(light_axis(light), *direction);
    if (cosine <= 0)
        return 0;
    double share = light->tightness > 0 ? pow(cosine, light->tightness) : 1;
    if (light->falloff > 0) {
        const double outer = cos(light->falloff * PI / 180), inner = cos(light->radius * PI / 180);
        share *= inner > outer ? light_smooth_step(outer, inner, cosine) : cosine > outer;
    }
    return share;
}

/* The part of a line that lies in the cone about the axis. */
static int spot_lit_part(const Light *light, Vec3 from, Vec3 direction, double *begin, double *end)
{
    if (!(light->falloff > 0 && light->falloff < 89) || light->area_illumination)
        return 1;
    const Vec3 axis = light_axis(light);
    const double cosine = cos(light->falloff * PI / 180), c2 = cosine * cosine;
    const double f = vec_dot(from, axis), d = vec_dot(direction, axis);
    const double a = d * d - c2, b = f * d - c2 * vec_dot(from, direction), c = f * f - c2 * vec_dot(from, from);
    const double discriminant = b * b - a * c, root = sqrt(fmax(discriminant, 0));
    const double one = (-b - root) / a, two = (-b + root) / a, low = fmin(one, two), high = fmax(one, two);
    if (!isfinite(one + two))
        return 1;
    if (a < 0) { /* between the roots, where it is the cone's own half */
        *begin = fmax(*begin, low), *end = fmin(*end, high);
        return discriminant > 0 && f + d * (low + high) / 2 > 0;
    }
    if (discriminant > 0)
        *begin = d > 0 ? fmax(*begin, high) : *begin, *end = d > 0 ? *end : fmin(*end, low);
    return 1;
}

static double spot_cone(const Light *light)
{
    return light->falloff * PI / 180;
}

const LightOps light_spotlight = {.name = "spotlight",
                                  .yields_to = "parallel",
                                  .settle = spot_settle,
                                  .shine = spot_shine,
                                  .meet = point_meet,
                                  .lit_part = spot_lit_part,
                                  .cone = spot_cone};
