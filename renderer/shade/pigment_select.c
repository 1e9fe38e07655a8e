/* Pigments that choose among textures: see TextureTree. */
#include "pattern/pattern.h"
#include "shade/pigment.h"
#include "shade/pigment_image.h"

double pigment_value(const Pigment *pigment, const PatternPoint *at, Vec2 uv)
{
    const PatternPoint point = {pigment_point(pigment, at->p, uv), at->normal, at->view};
    return pattern_value(&pigment->pattern, &point);
}

int pigment_warp(const Pigment *pigment, Vec3 *p)
{
    const Vec3 from = transform_inverse_point(&pigment->transform, *p), to = pattern_warp(&pigment->pattern, from);
    if (pigment->uv_mapping || (to.x == from.x && to.y == from.y && to.z == from.z))
        return 0;
    *p = transform_point(&pigment->transform, to);
    return 1;
}

/* Of the texel that has the point. */
static int texel(double at, int size)
{
    const double x = (at - floor(at)) * size;
    return x < size ? (int)x : size - 1;
}

int pigment_index(const Pigment *pigment, Vec3 p, Vec2 uv)
{
    const ImageMap *image = pigment->image;
    const Vec2 at = pigment_image_uv(image, pigment_point(pigment, p, uv));
    if (image_is_outside(image, at))
        return 0;
    const int x = texel(at.u, image->width), y = image->height - 1 - texel(at.v, image->height);
    return image->indices[(size_t)y * (size_t)image->width + (size_t)x];
}
