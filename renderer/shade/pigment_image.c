/* image_map: projections and look-up, as POV-Ray's (measured): UV (0,0) is the lower left corner of the image, texel
 * centres are at (i + 0.5) / width, `interpolate` wraps round the edges. */
#include "shade/pigment_image.h"

/* Round the y axis, 0..1. */
static double turn(Vec3 p)
{
    double t = p.x == 0 && p.z == 0 ? 0 : atan2(p.z, p.x) / (2 * PI);

    return t < 0 ? t + 1 : t;
}

Vec2 pigment_image_uv(const ImageMap *image, Vec3 p)
{
    switch (image->map_type) {
    case MAP_PLANAR:
        break;
    case MAP_SPHERICAL:
        return (Vec2){turn(p), 0.5 + atan2(p.y, hypot(p.x, p.z)) / PI};
    case MAP_CYLINDRICAL:
        return (Vec2){turn(p), p.y};
    case MAP_TORUS:
        /* The ring has radius 1. */
        return (Vec2){turn(p), 0.5 + atan2(p.y, hypot(p.x, p.z) - 1) / (2 * PI)};
    }
    return (Vec2){p.x, p.y};
}

int image_is_outside(const ImageMap *image, Vec2 uv)
{
    int outside_u = uv.u < 0 || uv.u > 1, outside_v = uv.v < 0 || uv.v > 1;

    if (!image->once)
        return 0;
    return image->map_type == MAP_PLANAR ? outside_u || outside_v : image->map_type == MAP_CYLINDRICAL && outside_v;
}

Rgbft image_lookup(const ImageMap *image, Vec2 uv)
{
    float rgba[4], transmit;

    if (image_is_outside(image, uv))
        return (Rgbft){0, 0, 0, 0, 1};
    if (image->interpolate)
        retex_texture_point(image->texture, uv.u, uv.v, rgba);
    else
        retex_texture_nearest(image->texture, uv.u, uv.v, rgba);
    transmit = image->transmit_all + (image->has_alpha ? 1 - rgba[3] : 0);
    return (Rgbft){rgba[0], rgba[1], rgba[2], image->filter_all, transmit};
}
