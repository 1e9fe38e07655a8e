/* Pigments: colours by pattern, map or image as POV-Ray 3.7 evaluates them (measured where its manual is silent), and
 * the UV at which a replacement texture lies on a target. */
#include "pattern/pattern.h"
#include "shade/pigment_image.h"

static Rgbft blend(const Rgbft *a, const Rgbft *b, float t)
{
    return (Rgbft){a->r + (b->r - a->r) * t, a->g + (b->g - a->g) * t, a->b + (b->b - a->b) * t,
                   a->filter + (b->filter - a->filter) * t, a->transmit + (b->transmit - a->transmit) * t};
}

static Rgbft map_color(const ColorMap *map, double value)
{
    const ColorMapEntry *entry = map->entries;
    int last = map->count - 1, i = 0;

    if (map->count == 0)
        return (Rgbft){(float)value, (float)value, (float)value, 0, 0};
    if (value >= entry[last].value)
        return entry[last].color;
    if (value <= entry[0].value)
        return entry[0].color;
    while (value > entry[i].value)
        i++;
    /* Of several entries at exactly this value the first one counts. */
    if (value == entry[i].value)
        return entry[i].color;
    return blend(&entry[i - 1].color, &entry[i].color,
                 (float)((value - entry[i - 1].value) / (entry[i].value - entry[i - 1].value)));
}

Rgbft pigment_pattern(const Pigment *pigment, Vec3 p)
{
    if (pigment->kind == PIGMENT_COLOR)
        return pigment->color;
    if (pigment->kind == PIGMENT_IMAGE)
        return image_lookup(pigment->image, pigment_image_uv(pigment->image, p));
    const double value = pattern_value(&pigment->pattern, p);
    return pigment->pattern.ops->colors ? pigment->colors[(int)value] : map_color(&pigment->map, value);
}

Vec3 pigment_point(const Pigment *pigment, Vec3 p, Vec2 uv)
{
    return transform_inverse_point(&pigment->transform, pigment->uv_mapping ? vec3(uv.u, uv.v, 0) : p);
}

Rgbft pigment_eval(const Pigment *pigment, Vec3 p, Vec2 uv)
{
    if (pigment->kind == PIGMENT_COLOR)
        return pigment->color;
    return pigment_pattern(pigment, pigment_point(pigment, p, uv));
}

Rgbft pigment_eval_image(const Pigment *pigment, Vec3 p, Vec2 *target)
{
    const Vec2 at = pigment_image_uv(pigment->image, p);
    *target = pigment->uv_mapping ? (Vec2){p.x, p.y} : at;
    return image_lookup(pigment->image, at);
}

void pigment_prefetch_image(const Pigment *pigment, Vec3 p)
{
    if (pigment->image->map_type == MAP_PLANAR)
        retex_texture_prefetch(pigment->image->texture, p.x, p.y);
}

static int same_color(const Rgbft *a, const Rgbft *b)
{
    return a->r == b->r && a->g == b->g && a->b == b->b && a->filter == b->filter && a->transmit == b->transmit;
}

int pigment_is_constant(const Pigment *pigment)
{
    const ImageMap *image = pigment->image;
    const ColorMapEntry *entry = pigment->map.entries;

    if (pigment->kind == PIGMENT_COLOR)
        return 1;
    if (pigment->kind == PIGMENT_IMAGE)
        return image->width == 1 && image->height == 1 && !image->once;
    for (int i = 1; i < pigment->pattern.ops->colors; i++)
        if (!same_color(&pigment->colors[0], &pigment->colors[i]))
            return 0;
    if (pigment->pattern.ops->colors)
        return 1;
    for (int i = 1; i < pigment->map.count; i++)
        if (!same_color(&entry[0].color, &entry[i].color))
            return 0;
    return pigment->map.count > 0;
}

static int is_opaque(const Rgbft *c)
{
    return c->filter == 0 && c->transmit == 0;
}

int pigment_is_opaque(const Pigment *pigment)
{
    const ImageMap *image = pigment->image;

    if (pigment->kind == PIGMENT_COLOR)
        return is_opaque(&pigment->color);
    if (pigment->kind == PIGMENT_IMAGE)
        return !image->has_alpha && !image->once && image->filter_all == 0 && image->transmit_all == 0;
    for (int i = 0; i < pigment->pattern.ops->colors; i++)
        if (!is_opaque(&pigment->colors[i]))
            return 0;
    for (int i = 0; !pigment->pattern.ops->colors && i < pigment->map.count; i++)
        if (!is_opaque(&pigment->map.entries[i].color))
            return 0;
    return 1;
}

Vec2 target_uv(const Pigment *pigment, Vec3 p, Vec3 normal, const Vec2 *mapped_uv, const Vec2 *natural)
{
    Vec3 n, size;

    if (pigment->uv_mapping && mapped_uv) {
        p = transform_inverse_point(&pigment->transform, vec3(mapped_uv->u, mapped_uv->v, 0));
        return (Vec2){p.x, p.y};
    }
    p = transform_inverse_point(&pigment->transform, p);
    if (pigment->kind == PIGMENT_IMAGE)
        return pigment_image_uv(pigment->image, p);
    if (natural)
        return *natural;
    n = transform_inverse_normal(&pigment->transform, normal);
    size = vec3(fabs(n.x), fabs(n.y), fabs(n.z));
    if (size.x > size.y && size.x > size.z)
        return (Vec2){p.z, p.y};
    return size.y > size.z ? (Vec2){p.x, p.z} : (Vec2){p.x, p.y};
}
