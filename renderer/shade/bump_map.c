/* bump_map: normals from a picture's heights, by POV-Ray's three points and frame (compared with its pictures). */
#include "base/polynomial.h"
#include "shade/normal.h"
#include "shade/pigment_image.h"

static double height_of(const BumpMap *map, int i, int j)
{
    const ImageMap *m = &map->image;
    i = image_texel(m, i, m->width), j = image_texel(m, j, m->height);
    return map->heights[(size_t)j * (size_t)m->width + (size_t)i];
}

/* Of the points around: by the inverse of the squared distance. */
static double nearness(double x, double y)
{
    return 1 / (x * x + y * y);
}

/* The points beside a pixel come from the other edge, also of a picture that is there once. */
static double round_again(double x, int size)
{
    return x < 0 ? x + size : x >= size ? x - size : x;
}

/* x and y in pixels, from the upper left corner. */
static double height_at(const BumpMap *map, double x, double y)
{
    const int kind = map->image.interpolate;
    if (kind == 0)
        return height_of(map, (int)floor(x), (int)floor(y));
    const double left = floor(x - 0.5), top = floor(y - 0.5), u = x - 0.5 - left, v = y - 0.5 - top;
    const int i0 = (int)left, j0 = (int)top;
    double wx[4] = {0, 1 - u, u, 0}, wy[4] = {0, 1 - v, v, 0}, sum = 0, weights = 0;
    if (kind == 3)
        cubic_weights(u, wx), cubic_weights(v, wy);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++) {
            double weight = wx[i] * wy[j];
            if (kind == 4)
                weight = i % 3 && j % 3 ? nearness(i - 1 - u, j - 1 - v) : 0;
            if (weight == INFINITY)
                return height_of(map, i0 + i - 1, j0 + j - 1);
            if (weight != 0)
                sum += weight * height_of(map, i0 + i - 1, j0 + j - 1), weights += weight;
        }
    return sum / weights;
}

Vec3 bump_map_tilt(const Normal *bumps, Vec3 p, Vec3 n)
{
    const BumpMap *map = bumps->bump_map;
    const Vec2 uv = pigment_image_uv(&map->image, p);
    if (map->image.once && (uv.u < 0 || uv.u > 1 || uv.v < 0 || uv.v > 1))
        return n;
    /* Heights at a pixel and at the two ends of the row below it make a triangle with a normal. */
    const double x = (uv.u - floor(uv.u)) * map->image.width + 1e-10,
                 y = (1 - (uv.v - floor(uv.v))) * map->image.height - 1e-10;
    const double before = round_again(x - 1, map->image.width), after = round_again(x + 1, map->image.width),
                 below = round_again(y + 1, map->image.height);
    const double here = bumps->size * height_at(map, x, y), left = bumps->size * height_at(map, before, below),
                 right = bumps->size * height_at(map, after, below);
    const Vec3 a = vec3(1, here - left, -1), b = vec3(2, right - left, 0);
    const Vec3 bump = vec_normalize(vec_cross(b, a));
    Vec3 across = vec_cross(n, vec3(0, 1, 0)), up = n;
    if (vec_length(across) < 1e-10)
        across = vec3(1, 0, 0), up = vec3(0, n.y > 0 ? 1 : -1, 0);
    across = vec_normalize(across);
    const Vec3 along = vec_normalize(vec_cross(across, up));
    return vec_add(vec_add(vec_scale(across, bump.x), vec_scale(up, bump.y)), vec_scale(along, -bump.z));
}
