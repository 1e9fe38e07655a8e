/* Fog, by the formulas of POV-Ray 3.7; where its manual is silent, they were measured. Several fogs multiply, and each
 * adds its colour as if it were alone. */
#include "medium/fog.h"
#include "pattern/pattern.h"

#define SKY_DISTANCE 2e10 /* that of the sky to POV-Ray */
#define ALTITUDE_MIN 1e-10

/* Mean of 1 / (1 + h h) between two heights over the ground fog's offset, where it is 1 below it. */
static double mean_density(double a, double b)
{
    const double low = fmin(a, b), high = fmax(a, b), rise = high - low;
    if (high <= 0)
        return 1;
    if (rise < 1e-6)
        return 1 / (1 + high * high);
    return (atan(high) - (low > 0 ? atan(low) : low)) / rise;
}

static double ground_density(const Fog *fog, Vec3 from, Vec3 to)
{
    const double altitude = fmax(fog->altitude, ALTITUDE_MIN);
    return mean_density((vec_dot(from, fog->up) - fog->offset) / altitude,
                        (vec_dot(to, fog->up) - fog->offset) / altitude);
}

/* Turbulence shortens the way through the fog, the less the farther it is. */
static double turbulent(const Fog *fog, int generator, Vec3 middle, double distance)
{
    const Vec3 t = fog->turbulence.amount, p = vec3(middle.x * t.x, middle.y * t.y, middle.z * t.z);
    const double value = fog->turbulence_depth * turbulence_value(&fog->turbulence, generator, p);
    return distance * (1 - exp(-distance / fog->distance) * fmin(1, value));
}

static double transmittance(const Fog *fog, int generator, Vec3 from, Vec3 direction, double distance)
{
    const Vec3 to = vec_mad(from, direction, distance);
    const double density = fog->kind == FOG_GROUND ? ground_density(fog, from, to) : 1;
    if (fog->has_turbulence)
        distance = turbulent(fog, generator, vec_scale(vec_add(from, to), 0.5), distance);
    return fmax(exp(-distance * density / fog->distance), fog->transmit);
}

Rgb fog_transmittance(const Scene *scene, const Ray *ray, double distance, Rgb *own)
{
    const Vec3 from = vec_mad(ray->origin, ray->direction, ray->tmin);
    Rgb product = rgb_grey(1);
    *own = rgb_grey(0);
    for (const Fog *fog = scene->fogs; fog; fog = fog->next) {
        const float t =
            (float)transmittance(fog, scene->noise_generator, from, ray->direction, fmin(distance, SKY_DISTANCE));
        *own = rgb_add(*own, rgb_scale(fog->color, 1 - t));
        product = rgb_scale(rgb_mul(product, rgb_lerp(rgb_grey(1), fog->color, fog->filter)), t);
    }
    return product;
}
