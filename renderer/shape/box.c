/* The box [0,1]^3. Traced as triangles; its points are found on the exact faces. */
#include "shape/shapes.h"

/* Corner bits: 1 x, 2 y, 4 z. Two triangles a face, wound so that edge 01 x edge 02 points outward. */
const int box_triangles[12][3] = {
    {0, 4, 6}, {0, 6, 2}, /* -x */
    {1, 3, 7}, {1, 7, 5}, /* +x */
    {0, 1, 5}, {0, 5, 4}, /* -y */
    {2, 6, 7}, {2, 7, 3}, /* +y */
    {0, 2, 3}, {0, 3, 1}, /* -z */
    {4, 5, 7}, {4, 7, 6}, /* +z */
};

Vec3 box_corner(int index)
{
    return vec3(index & 1, index >> 1 & 1, index >> 2 & 1);
}

static double clamp01(double x)
{
    return fmin(fmax(x, 0), 1);
}

void box_point(Vec3 p, int face, ShapePoint *out)
{
    double side = face & 1, x, y, z;

    x = face >> 1 == 0 ? side : clamp01(p.x);
    y = face >> 1 == 1 ? side : clamp01(p.y);
    z = face >> 1 == 2 ? side : clamp01(p.z);
    out->p = vec3(x, y, z);
    out->normal = vec3(face >> 1 == 0, face >> 1 == 1, face >> 1 == 2);
    if (face % 2 == 0)
        out->normal = vec_neg(out->normal);
}

void box_uv(Vec3 p, int face, ShapeUv *out)
{
    ShapePoint on;
    double x, y, z;

    box_point(p, face, &on);
    x = on.p.x, y = on.p.y, z = on.p.z;
    /* POV-Ray unfolds the box into a cross, 4 by 3 fields: -x +z +x -z from left to right in the middle row, the bottom
     * below +z and the top above it. */
    switch (face) {
    case 0:
        out->uv = (Vec2){z / 4, (1 + y) / 3};
        out->natural = (Vec2){1 - z, y};
        break;
    case 1:
        out->uv = (Vec2){(3 - z) / 4, (1 + y) / 3};
        out->natural = (Vec2){z, y};
        break;
    case 2:
        out->uv = (Vec2){(1 + x) / 4, z / 3};
        out->natural = (Vec2){x, 1 - z};
        break;
    case 3:
        out->uv = (Vec2){(1 + x) / 4, (3 - z) / 3};
        out->natural = (Vec2){x, z};
        break;
    case 4:
        out->uv = (Vec2){(4 - x) / 4, (1 + y) / 3};
        out->natural = (Vec2){x, y};
        break;
    default:
        out->uv = (Vec2){(1 + x) / 4, (1 + y) / 3};
        out->natural = (Vec2){1 - x, y};
        break;
    }
    out->has_uv = out->has_natural = 1;
}
