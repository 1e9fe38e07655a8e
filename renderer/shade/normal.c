/* Bumps, as POV-Ray 3.7 has them (compared with its pictures, tests/lib/povray_normals.py). A normal goes into pattern
 * space, is tilted there, and comes back. It has unit length in both spaces, unless no_bump_scale is given. */
#include "pattern/pattern.h"
#include "shade/normal.h"

/* The surface that all of a texture's normals are on. */
typedef struct Place {
    const Surface *surface;
    Vec3 view;
} Place;

static Vec3 tilted(const Normal *bumps, const Place *place, int keeps_size, Vec3 p, Vec3 n);

/* Which entries are at both sides of the value; the share of the second one. The same entry twice: it alone counts. */
static double between(const double *first, size_t stride, int count, double value, int *low, int *high)
{
#define AT(i) (*(const double *)(const void *)((const char *)first + (size_t)(i)*stride))
    int i = 0;
    if (value >= AT(count - 1))
        return *low = *high = count - 1, 0;
    while (value > AT(i))
        i++;
    *low = i == 0 || value == AT(i) ? i : i - 1, *high = i;
    return *low == *high ? 0 : (value - AT(*low)) / (AT(i) - AT(*low));
#undef AT
}

/* ---- by the slope of a pattern ---- */

/* The curve through the entries' heights, with their slopes. */
static double mapped_height(const Normal *bumps, double value)
{
    int low, high;
    if (bumps->nslopes == 0)
        return value;
    const double t = between(&bumps->slopes->value, sizeof *bumps->slopes, bumps->nslopes, value, &low, &high);
    const SlopeMapEntry *a = &bumps->slopes[low], *b = &bumps->slopes[high];
    if (low == high)
        return a->height;
    const double s = 1 - t;
    return s * s * ((1 + 2 * t) * a->height + t * a->slope) + t * t * ((3 - 2 * t) * b->height - s * b->slope);
}

/* From the values at the corners of a tetrahedron. */
static Vec3 slope_tilt(const Normal *bumps, Vec3 p, Vec3 n)
{
    static const Vec3 corners[4] = {{0.942809041, -0.333333333, 0},
                                    {-0.471404521, -0.333333333, 0.816496581},
                                    {-0.471404521, -0.333333333, -0.816496581},
                                    {0, 1, 0}};
    const double strength = -0.1 * bumps->size / bumps->accuracy; /* POV-Ray's */
    for (int i = 0; i < 4; i++) {
        const PatternPoint at = {.p = vec_mad(p, corners[i], bumps->accuracy)};
        const double value = pattern_value_at(&bumps->pattern, &at);
        n = vec_mad(n, corners[i], strength * mapped_height(bumps, value));
    }
    return n;
}

/* ---- by other normals ---- */

static Vec3 map_tilt(const Normal *bumps, const Place *place, int keeps_size, Vec3 p, Vec3 n)
{
    const Surface *surface = place->surface;
    const Vec3 facing = surface->backside ? vec_neg(surface->shading_normal) : surface->shading_normal;
    const double value = pattern_value_at(&bumps->pattern, &(PatternPoint){p, facing, surface->direction});
    int low, high;
    double t = 0;
    if (bumps->pattern.ops->colors)
        low = high = (int)value;
    else
        t = between(&bumps->entries->value, sizeof *bumps->entries, bumps->nentries, value, &low, &high);
    const Vec3 b = tilted(bumps->entries[high].normal, place, keeps_size, p, n);
    return low == high ? b
                       : vec_add(vec_scale(tilted(bumps->entries[low].normal, place, keeps_size, p, n), 1 - t),
                                 vec_scale(b, t));
}

static Vec3 average_tilt(const Normal *bumps, const Place *place, int keeps_size, Vec3 p, Vec3 n)
{
    Vec3 sum = {0, 0, 0};
    double weights = 0;
    for (int i = 0; i < bumps->nentries; i++) {
        const NormalMapEntry *entry = &bumps->entries[i];
        sum = vec_mad(sum, tilted(entry->normal, place, keeps_size, p, n), entry->value);
        weights += entry->value;
    }
    return weights != 0 ? vec_scale(sum, 1 / weights) : n;
}

/* ---- one normal ---- */

static Vec3 tilt(const Normal *bumps, const Place *place, int keeps_size, Vec3 p, Vec3 n)
{
    switch (bumps->kind) {
    case NORMAL_SLOPE:
        return slope_tilt(bumps, p, n);
    case NORMAL_VECTORS:
        return normal_vectors(bumps->pattern.ops)(bumps, p, n);
    case NORMAL_IMAGE:
        return bump_map_tilt(bumps, p, n);
    case NORMAL_MAP:
        return map_tilt(bumps, place, keeps_size, p, n);
    case NORMAL_AVERAGE:
        return average_tilt(bumps, place, keeps_size, p, n);
    case NORMAL_TANGENT: /* have no pattern space */
    case NORMAL_HEIGHTS:
        break;
    }
    return n;
}

/* A length that cannot be made 1 tells nothing: the normal before stays. */
static Vec3 unit(Vec3 n, Vec3 before)
{
    const double length = vec_length(n);
    return length > 0 && isfinite(length) ? vec_scale(n, 1 / length) : before;
}

static Vec3 tilted(const Normal *bumps, const Place *place, int keeps_size, Vec3 p, Vec3 n)
{
    const int needs_value = bumps->kind == NORMAL_SLOPE || bumps->kind == NORMAL_MAP;
    if (needs_value && (!bumps->pattern.ops || !bumps->pattern.ops->value))
        return n; /* no pattern, or one that is not supported */
    if (bumps->kind == NORMAL_TANGENT)
        return unit(tangent_normal(bumps, place->surface, n), n);
    if (bumps->kind == NORMAL_HEIGHTS)
        return unit(height_normal(bumps, place->surface, n), n);
    keeps_size |= bumps->keeps_size;
    if (bumps->uv_mapping && place->surface->primitive) {
        const Vec2 uv = surface_uv(place->surface).uv;
        p = vec3(uv.u, uv.v, 0);
    }
    Vec3 inner = transform_inverse_normal(&bumps->transform, n);
    if (!keeps_size)
        inner = unit(inner, n);
    p = pattern_warp(&bumps->pattern, transform_inverse_point(&bumps->transform, p));
    const Vec3 outer = transform_normal(&bumps->transform, tilt(bumps, place, keeps_size, p, inner));
    return keeps_size && bumps->kind != NORMAL_MAP ? outer : unit(outer, n);
}

Vec3 normal_tilted_ray(const Normal *bumps, Vec3 point, Vec3 direction)
{
    const Surface nowhere = {.position = point, .shading_normal = direction, .direction = direction};
    return unit(tilted(bumps, &(Place){&nowhere, direction}, 0, point, direction), direction);
}

Vec3 normal_tilted(const Normal *bumps, const Surface *surface, Vec3 normal, Vec3 view)
{
    Place place = {surface, view};
    if (!surface->instance)
        return unit(tilted(bumps, &place, 0, surface->position, normal), normal);
    const Transform *t = &surface->instance->transform;
    place.view = transform_inverse_vector(t, view);
    const Vec3 inner = transform_inverse_normal(t, normal);
    const Vec3 n = tilted(bumps, &place, 0, surface_texture_point(surface), inner);
    return unit(transform_normal(t, n), normal);
}
