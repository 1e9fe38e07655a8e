/* Pigments: colours by pattern, map or image as POV-Ray 3.7 evaluates them (measured where its manual is silent), and
 * the UV at which a replacement texture lies on a target. */
#include <retex/host/texture_lookup.h>

#include "pattern/pattern.h"
#include "shade/pigment.h"
#include "shade/pigment_image.h"
#include "shade/working_space.h"

static Rgbft blend(const Rgbft *a, const Rgbft *b, float t)
{
    return (Rgbft){a->r + (b->r - a->r) * t, a->g + (b->g - a->g) * t, a->b + (b->b - a->b) * t,
                   a->filter + (b->filter - a->filter) * t, a->transmit + (b->transmit - a->transmit) * t};
}

/* The same surface, in the pigment's own pattern space. */
static PatternPoint inside(const Pigment *pigment, const PatternPoint *at, Vec2 uv)
{
    return (PatternPoint){pigment_point(pigment, at->p, uv), at->normal, at->view};
}

static PatternPoint warped(const Pattern *pattern, const PatternPoint *at)
{
    return (PatternPoint){pattern_warp(pattern, at->p), at->normal, at->view};
}

/* The colour at a point of pattern space, in the scene's working space. */
static Rgbft in_working_space(const Pigment *pigment, const PatternPoint *at, Vec2 uv);

/* An entry's colour at a point of the pattern space of the map's pigment. */
static Rgbft entry_color(const ColorMapEntry *entry, const PatternPoint *at, Vec2 uv)
{
    if (!entry->pigment)
        return entry->color;
    const PatternPoint point = inside(entry->pigment, at, uv);
    return in_working_space(entry->pigment, &point, uv);
}

static Rgbft map_color(const ColorMap *map, double value, const PatternPoint *at, Vec2 uv)
{
    const ColorMapEntry *entry = map->entries;
    int last = map->count - 1, i = 0;

    if (map->count == 0)
        return (Rgbft){(float)value, (float)value, (float)value, 0, 0};
    if (value >= entry[last].value)
        return entry_color(&entry[last], at, uv);
    if (value <= entry[0].value)
        return entry_color(&entry[0], at, uv);
    while (value > entry[i].value)
        i++;
    const Rgbft above = entry_color(&entry[i], at, uv);
    /* Of several entries at exactly this value the first one counts. */
    if (value == entry[i].value)
        return above;
    const Rgbft below = entry_color(&entry[i - 1], at, uv);
    return blend(&below, &above, (float)((value - entry[i - 1].value) / (entry[i].value - entry[i - 1].value)));
}

static Rgbft average(const ColorMap *map, const PatternPoint *at, Vec2 uv)
{
    Rgbft sum = {0};
    double weights = 0;

    for (int i = 0; i < map->count; i++) {
        const Rgbft c = entry_color(&map->entries[i], at, uv);
        const float w = (float)map->entries[i].value;

        sum.r += w * c.r, sum.g += w * c.g, sum.b += w * c.b, sum.filter += w * c.filter,
            sum.transmit += w * c.transmit;
        weights += map->entries[i].value;
    }
    const float scale = weights != 0 ? (float)(1 / weights) : 0;
    return (Rgbft){sum.r * scale, sum.g * scale, sum.b * scale, sum.filter * scale, sum.transmit * scale};
}

/* Where in the image: warps move its points as they do a pattern's. */
static Vec2 warped_image_uv(const Pigment *pigment, Vec3 p)
{
    const int is_warped = pattern_is_warped(&pigment->pattern);
    return pigment_image_uv(pigment->image, is_warped ? pattern_warp(&pigment->pattern, p) : p);
}

static Rgbft image_color(const Pigment *pigment, Vec3 p)
{
    return image_lookup(pigment, warped_image_uv(pigment, p));
}

static Rgbft in_working_space(const Pigment *pigment, const PatternPoint *at, Vec2 uv)
{
    PatternPoint point;

    switch (pigment->kind) {
    case PIGMENT_COLOR:
        break;
    case PIGMENT_IMAGE:
        return working_encode_pigment(pigment->space, image_color(pigment, at->p));
    case PIGMENT_PATTERN:
        point = warped(&pigment->pattern, at);
        return map_color(&pigment->map, pattern_value_at(&pigment->pattern, &point), &point, uv);
    case PIGMENT_AVERAGE:
        point = warped(&pigment->pattern, at);
        return average(&pigment->map, &point, uv);
    }
    return pigment->color;
}

Rgbft pigment_as_written(const Pigment *pigment, const PatternPoint *at)
{
    const Vec2 uv = {at->p.x, at->p.y};
    const PatternPoint point = inside(pigment, at, uv);

    return in_working_space(pigment, &point, uv);
}

Rgbft pigment_pattern(const Pigment *pigment, const PatternPoint *at, Vec2 uv)
{
    if (pigment->kind == PIGMENT_COLOR)
        return pigment->color;
    if (pigment->kind == PIGMENT_IMAGE)
        return image_color(pigment, at->p);
    return working_decode_pigment(pigment->space, in_working_space(pigment, at, uv));
}

Vec3 pigment_point(const Pigment *pigment, Vec3 p, Vec2 uv)
{
    return transform_inverse_point(&pigment->transform, pigment->uv_mapping ? vec3(uv.u, uv.v, 0) : p);
}

Rgbft pigment_eval(const Pigment *pigment, Vec3 p, Vec2 uv)
{
    return pigment_eval_at(pigment, &(PatternPoint){.p = p}, uv);
}

Rgbft pigment_eval_at(const Pigment *pigment, const PatternPoint *at, Vec2 uv)
{
    if (pigment->kind == PIGMENT_COLOR)
        return pigment->color;
    const PatternPoint point = inside(pigment, at, uv);
    return pigment_pattern(pigment, &point, uv);
}

Rgbft pigment_eval_on(const Pigment *map, const Surface *surface)
{
    return pigment_eval(map, surface_texture_point(surface), surface_uv_of_set(surface, map->second_uv));
}

Rgbft pigment_eval_image(const Pigment *pigment, Vec3 p, Vec2 *target)
{
    const Vec2 at = pigment_image_uv(pigment->image, p);
    *target = pigment->uv_mapping ? (Vec2){p.x, p.y} : at;
    return pattern_is_warped(&pigment->pattern) ? image_color(pigment, p) : image_lookup(pigment, at);
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
    for (int i = 0; i < pigment->map.count; i++)
        if (entry[i].pigment || !same_color(&entry[0].color, &entry[i].color))
            return 0;
    return pigment->map.count > 0;
}

float pigment_opacity(const Pigment *pigment, Rgbft c)
{
    const float transmit = not_negative(c.transmit);
    float filter = not_negative(c.filter);
    if (filter > 0 && pigment->space && pigment->space->dark_filters_hide)
        filter *= rgb_max(working_encode(pigment->space, rgb(c.r, c.g, c.b)));
    return at_most(not_negative(1 - filter - transmit), 1);
}

static int is_opaque(const Rgbft *c)
{
    return c->filter == 0 && c->transmit == 0;
}

int pigment_is_opaque(const Pigment *pigment)
{
    const ImageMap *image = pigment->image;
    const ColorMapEntry *entry = pigment->map.entries;

    if (pigment->kind == PIGMENT_COLOR)
        return is_opaque(&pigment->color);
    if (pigment->kind == PIGMENT_IMAGE)
        return !image->has_alpha && !image->once && image->filter_all == 0 && image->transmit_all == 0 &&
               !image->transparency;
    for (int i = 0; i < pigment->map.count; i++)
        if (entry[i].pigment ? !pigment_is_opaque(entry[i].pigment) : !is_opaque(&entry[i].color))
            return 0;
    return 1;
}

Vec2 target_uv(const Pigment *pigment, Vec3 p, Vec3 normal, const Vec2 *mapped_uv, const Vec2 *natural)
{
    if (pigment->uv_mapping && mapped_uv) {
        p = transform_inverse_point(&pigment->transform, vec3(mapped_uv->u, mapped_uv->v, 0));
        return (Vec2){p.x, p.y};
    }
    p = transform_inverse_point(&pigment->transform, p);
    if (pigment->kind == PIGMENT_IMAGE)
        return pigment_image_uv(pigment->image, p);
    if (natural)
        return *natural;
    return vec_project(p, transform_inverse_normal(&pigment->transform, normal));
}
