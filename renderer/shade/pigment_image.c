/* image_map: projections and look-up, as POV-Ray's (measured): UV (0,0) is the lower left corner of the image, texel
 * centres are at (i + 0.5) / width, `interpolate` wraps round the edges. And baking, the way back from a pigment to an
 * image. */
#include <retex/parallel.h>

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

/* Where target_uv's UV came from, in pattern space. */
static Vec3 from_uv(const Pigment *pigment, int axis, double u, double v)
{
    if (pigment->uv_mapping || axis == 2)
        return vec3(u, v, 0);
    return axis == 0 ? vec3(0, v, u) : vec3(u, 0, v);
}

/* How a pigment is baked. */
typedef struct Baking {
    RetexImage *dst;
    const Pigment *pigment;
    int axis;
    const double *low, *high;
} Baking;

static void bake_row(void *context, int y, int thread)
{
    const Baking *b = context;
    const Pigment *pigment = b->pigment;
    float *pixel = b->dst->pixels + retex_image_index(b->dst, 0, y);
    double v = b->high[1] - (b->high[1] - b->low[1]) * (y + 0.5) / b->dst->height;
    (void)thread;
    for (int x = 0; x < b->dst->width; x++, pixel += 3) {
        double u = b->low[0] + (b->high[0] - b->low[0]) * (x + 0.5) / b->dst->width;
        Rgbft c = pigment->kind == PIGMENT_IMAGE && !pigment->uv_mapping
                      ? image_lookup(pigment->image, (Vec2){u, v})
                      : pigment_pattern(pigment, from_uv(pigment, b->axis, u, v));
        pixel[0] = c.r, pixel[1] = c.g, pixel[2] = c.b;
    }
}

int pigment_bake(RetexImage *dst, const Pigment *pigment, int axis, const double low[2], const double high[2],
                 int width, int height, int nthreads, RetexError *err)
{
    if (axis < 0 || axis > 2 || !(low[0] < high[0]) || !(low[1] < high[1]))
        return retex_fail(err, RETEX_EINVAL, "cannot bake a pigment over an empty UV rectangle");
    int code = retex_image_alloc(dst, width, height, 3, err);
    if (!code)
        retex_parallel(nthreads, height, bake_row, &(Baking){dst, pigment, axis, low, high});
    return code;
}
