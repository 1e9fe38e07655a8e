/* retex_normal_map: normals from a picture in tangent space. Its red, green and blue, 0 to 1, are components from -1 to
 * 1: along the directions in which the picture's x and y grow on the surface, y upwards, and along the normal. glTF and
 * OpenGL have it so. */
#include "shade/normal.h"
#include "shade/pigment.h"

Vec3 tangent_normal(const Normal *bumps, const Surface *surface, Vec3 normal)
{
    const Vec3 outward = surface->backside ? vec_neg(normal) : normal;
    Vec3 of_u, of_v;
    if (!surface->primitive || !surface_tangents(surface, bumps->vectors->second_uv, outward, &of_u, &of_v))
        return normal;
    const Rgbft c = pigment_eval_on(bumps->vectors, surface);
    /* The picture may be turned or mirrored on the UV. */
    const double(*m)[4] = bumps->vectors->transform.m;
    const Vec3 x = vec_normalize(vec_add(vec_scale(of_u, m[0][0]), vec_scale(of_v, m[1][0])));
    const Vec3 left = vec_cross(outward, x), up = vec_add(vec_scale(of_u, m[0][1]), vec_scale(of_v, m[1][1]));
    const Vec3 y = vec_dot(left, up) < 0 ? vec_neg(left) : left;
    const double size = 2 * bumps->size;
    Vec3 n = vec_scale(outward, 2 * (double)c.b - 1);
    n = vec_mad(vec_mad(n, x, size * ((double)c.r - 0.5)), y, size * ((double)c.g - 0.5));
    return surface->backside ? vec_neg(n) : n;
}
