/* image_map: projections and look-up, as POV-Ray's (measured): UV (0,0) is the lower left corner of the image, texel
 * centres are at (i + 0.5) / width, `interpolate` wraps round the edges and blends numbers of the working space. */
#include "base/polynomial.h"
#include "shade/pigment_image.h"
#include <retex/host/texture_lookup.h>

#include "shade/working_space.h"

/* Round the y axis, 0..1. */
static double turn(Vec3 p)
{
    double t = p.x == 0 && p.z == 0 ? 0 : atan2(p.z, p.x) / (2 * PI);

    return t < 0 ? t + 1 : t;
}

static Vec2 projection(const ImageMap *image, Vec3 p)
{
    double length, radius;

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
    case MAP_ANGULAR:
        length = hypot(p.x, p.y);
        radius = length > 0 ? atan2(length, p.z) / (2 * PI * length) : 0;
        return (Vec2){0.5 + p.x * radius, 0.5 + p.y * radius};
    }
    return (Vec2){p.x, p.y};
}

Vec2 pigment_image_uv(const ImageMap *image, Vec3 p)
{
    const Vec2 uv = projection(image, p);
    const ImagePlacement *place = image->place;

    return place ? (Vec2){uv.u * place->repeat.u - place->offset.u, uv.v * place->repeat.v - place->offset.v} : uv;
}

/* Both as projected and as placed by repeat and offset, as in POV-Ray. */
int image_is_outside(const ImageMap *image, Vec2 uv)
{
    int outside_u = uv.u < 0 || uv.u > 1, outside_v = uv.v < 0 || uv.v > 1;

    if (!image->once)
        return 0;
    if (image->place) {
        const double u = (uv.u + image->place->offset.u) / image->place->repeat.u,
                     v = (uv.v + image->place->offset.v) / image->place->repeat.v;
        outside_u |= u < 0 || u > 1, outside_v |= v < 0 || v > 1;
    }
    return image->map_type == MAP_PLANAR ? outside_u || outside_v : image->map_type == MAP_CYLINDRICAL && outside_v;
}

/* ---- look-up ---- */

static Rgbft with_transparency(const ImageMap *image, const float rgba[4], float filter, float transmit)
{
    const float alpha = image->has_alpha ? 1 - rgba[3] : 0;

    return (Rgbft){rgba[0], rgba[1], rgba[2], filter, transmit + alpha};
}

/* Column i, row j from below, of the image repeated, or with `once` of its edges; in the working space. */
static Rgbft texel(const Pigment *pigment, int i, int j)
{
    const ImageMap *image = pigment->image;
    const int x = image_texel(image, i, image->width), y = image_texel(image, j, image->height);
    const float *through = image->transparency
                               ? image->transparency[(size_t)(image->height - 1 - y) * (size_t)image->width + (size_t)x]
                               : NULL;
    float rgba[4];

    retex_texture_nearest(image->texture, (x + 0.5) / image->width, (y + 0.5) / image->height, rgba);
    const Rgbft c = with_transparency(image, rgba, through ? through[0] : image->filter_all,
                                      through ? through[1] : image->transmit_all);
    return working_encode_pigment(pigment->space, c);
}

static void add(Rgbft *sum, Rgbft c, double weight)
{
    const float w = (float)weight;

    sum->r += w * c.r, sum->g += w * c.g, sum->b += w * c.b, sum->filter += w * c.filter,
        sum->transmit += w * c.transmit;
}

/* From the centre of texel (i, j) to that of (i + 1, j + 1). */
static Rgbft bilinear(const Pigment *pigment, int i, int j, double x, double y)
{
    Rgbft sum = {0};

    for (int k = 0; k < 4; k++)
        add(&sum, texel(pigment, i + (k & 1), j + (k >> 1)), (k & 1 ? x : 1 - x) * (k >> 1 ? y : 1 - y));
    return sum;
}

static Rgbft bicubic(const Pigment *pigment, int i, int j, double x, double y)
{
    double across[4], up[4];
    Rgbft sum = {0};

    cubic_weights(x, across);
    cubic_weights(y, up);
    for (int k = 0; k < 16; k++)
        add(&sum, texel(pigment, i - 1 + k % 4, j - 1 + k / 4), across[k % 4] * up[k / 4]);
    return sum;
}

/* By the inverse squares of the distances to the four texels. */
static Rgbft by_distance(const Pigment *pigment, int i, int j, double x, double y)
{
    double weights[4], total = 0;
    Rgbft sum = {0};

    for (int k = 0; k < 4; k++) {
        const double dx = x - (k & 1), dy = y - (k >> 1), square = dx * dx + dy * dy;

        if (square < 1e-12)
            return texel(pigment, i + (k & 1), j + (k >> 1));
        total += weights[k] = 1 / square;
    }
    for (int k = 0; k < 4; k++)
        add(&sum, texel(pigment, i + (k & 1), j + (k >> 1)), weights[k] / total);
    return sum;
}

/* Between texels; or the texel itself, where the image's palette tells its transparency. */
static Rgbft interpolate(const Pigment *pigment, Vec2 uv)
{
    const ImageMap *image = pigment->image;
    const double offset = image->interpolate ? 0.5 : 0;
    const double x = (uv.u - floor(uv.u)) * image->width - offset, y = (uv.v - floor(uv.v)) * image->height - offset;
    const int i = (int)floor(x), j = (int)floor(y);

    switch (image->interpolate) {
    case 0:
        return texel(pigment, i, j);
    case 3:
        return bicubic(pigment, i, j, x - i, y - j);
    case 4:
        return by_distance(pigment, i, j, x - i, y - j);
    default:
        return bilinear(pigment, i, j, x - i, y - j);
    }
}

static Rgbft untinted(const Pigment *pigment, Vec2 uv)
{
    const ImageMap *image = pigment->image;
    /* a texture's own look-up repeats it, is scene-linear, and weighs colours by their alpha */
    const int blends = image->interpolate && (image->once || image->has_alpha || !working_is_linear(pigment->space));
    float rgba[4];

    if (image_is_outside(image, uv))
        return (Rgbft){1, 1, 1, 0, 1};
    if (image->interpolate > 2 || image->transparency || blends)
        return working_decode_pigment(pigment->space, interpolate(pigment, uv));
    if (image->interpolate)
        retex_texture_point(image->texture, uv.u, uv.v, rgba);
    else
        retex_texture_nearest(image->texture, uv.u, uv.v, rgba);
    return with_transparency(image, rgba, image->filter_all, image->transmit_all);
}

Rgbft image_lookup(const Pigment *pigment, Vec2 uv)
{
    Rgbft c = untinted(pigment, uv);
    if (pigment->is_tinted)
        c.r *= pigment->color.r, c.g *= pigment->color.g, c.b *= pigment->color.b;
    return c;
}
