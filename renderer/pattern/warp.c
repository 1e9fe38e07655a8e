/* Warps, as POV-Ray 3.7 moves points by them (measured where its manual is silent). */
#include "base/noise.h"
#include "pattern/warp.h"

Vec3 turbulence_point(const Turbulence *t, Vec3 p)
{
    if (t->amount.x == 0 && t->amount.y == 0 && t->amount.z == 0)
        return p;
    const Vec3 by = noise_turbulence(p, t->lambda, t->omega, t->octaves);
    return vec3(p.x + by.x * t->amount.x, p.y + by.y * t->amount.y, p.z + by.z * t->amount.z);
}

Vec3 warp_point(const Warp *warp, Vec3 p)
{
    if (!warp->is_moved)
        return warp->apply(warp, p);
    return transform_inverse_point(&warp->moved, warp->apply(warp, transform_point(&warp->moved, p)));
}

Vec3 warp_turbulence(const Warp *warp, Vec3 p)
{
    return turbulence_point(&warp->turbulence, p);
}

/* ---- black holes ---- */

static double block_of(double x, double size)
{
    return size > 0 ? floor(x / size) : 0;
}

/* The point moves away from the centre, so that the pattern shrinks towards it; at most by its distance. */
Vec3 warp_black_hole(const Warp *warp, Vec3 p)
{
    const struct BlackHole *hole = &warp->hole;
    const Vec3 size = hole->repeat, random = hole->displacement;
    const Vec3 block = vec3(block_of(p.x, size.x), block_of(p.y, size.y), block_of(p.z, size.z));
    Vec3 center = vec_add(hole->center, vec3(block.x * size.x, block.y * size.y, block.z * size.z));
    if (random.x != 0 || random.y != 0 || random.z != 0) {
        const Vec3 by = noise_cell(block);
        center = vec_add(center, vec3(by.x * random.x, by.y * random.y, by.z * random.z));
    }
    const Vec3 from = vec_sub(p, center);
    const double distance = vec_length(from);
    if (!(distance < hole->radius))
        return p;
    const double force = pow((hole->radius - distance) / hole->radius, hole->falloff) * hole->strength;
    return vec_mad(p, from, hole->is_inverse ? -fmin(force, 1) : fmin(force, 1));
}

/* ---- repetition ---- */

Vec3 warp_repeat(const Warp *warp, Vec3 p)
{
    const struct Repeat *repeat = &warp->repeat;
    double at[3] = {p.x, p.y, p.z};
    const float block = (float)floor(at[repeat->axis] / repeat->width);
    at[repeat->axis] -= block * repeat->width;
    if (fmodf(block, 2) != 0) {
        at[0] *= repeat->flip.x, at[1] *= repeat->flip.y, at[2] *= repeat->flip.z;
        if ((&repeat->flip.x)[repeat->axis] < 0)
            at[repeat->axis] += repeat->width;
    }
    return vec_mad(vec3(at[0], at[1], at[2]), repeat->offset, block);
}

/* ---- mappings ---- */

/* As u, v and the distance w lie along x, y and z for an orientation of z; POV-Ray's linear rule for all others. */
static Vec3 oriented(const Warp *warp, double u, double v, double w)
{
    const Vec3 o = warp->mapping.orientation;
    return vec3(u * (o.z + o.y) + w * o.x, v * (o.z + o.x) - w * o.y, w * o.z - u * o.x + v * o.y);
}

/* 0 to 1, from the x axis over the z axis. */
static double turn_of(Vec3 p)
{
    const double turn = atan2(p.z, p.x) / (2 * PI);
    return turn < 0 ? turn + 1 : turn;
}

static double distance_factor(const Warp *warp, double distance)
{
    return warp->mapping.distance_exponent != 0 ? pow(distance, warp->mapping.distance_exponent) : 1;
}

Vec3 warp_planar(const Warp *warp, Vec3 p)
{
    return oriented(warp, p.x, p.y, warp->mapping.offset);
}

Vec3 warp_cylindrical(const Warp *warp, Vec3 p)
{
    const double distance = hypot(p.x, p.z);
    return distance > 0 ? oriented(warp, turn_of(p) * distance_factor(warp, distance), p.y, distance) : p;
}

Vec3 warp_spherical(const Warp *warp, Vec3 p)
{
    const double distance = vec_length(p), factor = distance_factor(warp, distance);
    if (distance == 0)
        return p;
    return oriented(warp, turn_of(p) * factor, (0.5 + asin(p.y / distance) / PI) * factor, distance);
}

Vec3 warp_toroidal(const Warp *warp, Vec3 p)
{
    const double from_axis = hypot(p.x, p.z), from_circle = from_axis - warp->mapping.major_radius;
    const double distance = hypot(from_circle, p.y), factor = distance_factor(warp, distance);
    if (from_axis == 0)
        return p;
    const double v = 0.5 + atan2(p.y, from_circle) / (2 * PI);
    return oriented(warp, turn_of(p) * factor, v * factor, distance);
}

/* The six sides of a box, unfolded as a cross in the unit square. */
Vec3 warp_cubic(const Warp *warp, Vec3 p)
{
    const double ax = fabs(p.x), ay = fabs(p.y), az = fabs(p.z), w = fmax(ax, fmax(ay, az));
    (void)warp;
    if (w == 0)
        return p;
    const double x = p.x / w, y = p.y / w, z = p.z / w;
    if (ax == w)
        return vec3(p.x > 0 ? 0.5 + (1 - z) / 8 : (1 + z) / 8, (1 + (1 + y) / 2) / 3, w);
    if (ay == w)
        return vec3(0.25 + (1 + x) / 8, p.y > 0 ? 2.0 / 3 + (1 - z) / 6 : (1 + z) / 6, w);
    return vec3(p.z > 0 ? 0.25 + (1 + x) / 8 : 0.75 + (1 - x) / 8, (1 + (1 + y) / 2) / 3, w);
}
