/* What all light sources share: fading, light distributions, the grid of an area_light, projected_through, and how the
 * list of lights sees them. */
#include "light/entry.h"
#include "light/ies.h"
#include "shape/csg.h"

static double distance_fade(const Light *light, double distance)
{
    if (light->fade_power <= 0)
        return 1;
    if (light->fade_distance > 0)
        return 2 / (1 + pow(distance / light->fade_distance, light->fade_power));
    return pow(fmax(distance, 1e-6), -light->fade_power);
}

/* ---- the grid of an area_light ---- */

/* Which of the n lights on a side. POV-Ray halves the side until two lights are left; a middle one belongs to both
 * halves, so that the outer ones of 3, 5 or 9 weigh half in shadows. *u is uniform in [0,1) again. */
static int pick_by_halves(double *u, int n)
{
    int low = 0, high = n - 1;
    while (high > low) {
        const int sum = low + high, two = high - low == 1, second = *u >= 0.5;
        if (second)
            low = two ? high : sum - sum / 2;
        else
            high = two ? low : sum / 2;
        *u = 2 * *u - second;
    }
    return low;
}

/* A place on a side of n lights, -0.5 to 0.5. With jitter a light is anywhere on its share of the side. */
static double grid_place(const Light *light, double u, int n)
{
    if (n < 2)
        return 0;
    double k = light->area_illumination ? floor(u * n) : pick_by_halves(&u, n);
    if (light->jitter)
        k += light->area_illumination ? u * n - k - 0.5 : u - 0.5;
    return k / (n - 1) - 0.5;
}

/* The sides of the grid, as a point sees them: with orient they face it. */
static void grid_axes(const Light *light, Vec3 position, Vec3 *axis1, Vec3 *axis2)
{
    *axis1 = light->axis1, *axis2 = light->axis2;
    if (light->orient) {
        Vec3 s, t;
        vec_frame(vec_normalize(vec_sub(position, light->location)), &s, &t);
        *axis1 = vec_scale(s, vec_length(*axis1));
        *axis2 = vec_scale(t, vec_length(*axis2));
    }
}

Vec3 source_point(const Light *light, Vec3 position, float u1, float u2)
{
    if (!light->area)
        return light->location;
    int n1 = light->size1 > 1 ? light->size1 : 1, n2 = light->size2 > 1 ? light->size2 : 1;
    double a = grid_place(light, u1, n1), b = grid_place(light, u2, n2);
    Vec3 axis1, axis2;
    grid_axes(light, position, &axis1, &axis2);
    if (light->circular) { /* squares about the centre become circles */
        double m = fmax(fabs(a), fabs(b)), length = sqrt(a * a + b * b);
        if (length > 0)
            a *= m / length, b *= m / length;
    }
    return vec_mad(vec_mad(light->location, axis1, a), axis2, b);
}

/* ---- light that it gives ---- */

double point_shine(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    const Vec3 d = vec_sub(place, position);
    (void)light;
    *distance = vec_length(d);
    if (*distance <= 0)
        return 0;
    *direction = vec_scale(d, 1 / *distance);
    return 1;
}

Rgb source_irradiance(const Light *light, Vec3 position, Vec3 place, Vec3 *direction, double *distance)
{
    double share = light->ops->shine(light, position, place, direction, distance);
    if (share > 0 && light->ies)
        share *= ies_light_share(light, vec_neg(*direction));
    return share > 0 ? rgb_scale(light->color, (float)(PI * share * distance_fade(light, *distance))) : rgb_grey(0);
}

int source_lit_part(const Light *light, const Ray *ray, double distance, double *begin, double *end)
{
    const Vec3 from = vec_sub(vec_mad(ray->origin, ray->direction, ray->tmin), light->location);
    *begin = 0, *end = distance;
    return (!light->ops->lit_part || light->ops->lit_part(light, from, ray->direction, begin, end)) && *begin < *end;
}

float source_most_irradiance(const Light *light, const Ray *ray, double distance)
{
    const double strength = PI * fmaxf(0, rgb_luminance(light->color));
    if (light->fade_power <= 0 || light_is_beam(light))
        return (float)strength;
    const Vec3 to = vec_sub(light->location, vec_mad(ray->origin, ray->direction, ray->tmin));
    const double along = fmin(fmax(vec_dot(to, ray->direction), 0), distance);
    return (float)(strength * distance_fade(light, vec_length(vec_mad(to, ray->direction, -along))));
}

/* The shadow ray ends where it first meets the object that light is projected through: what is beyond throws no
 * shadow. Returns 0 where it does not meet it. */
static int project(const Light *light, Vec3 position, LightSample *sample)
{
    CsgQuery query = {.ray = {position, sample->shadow_direction, 1e-4, sample->shadow_distance}};
    if (!csg_intersect(light->projected_through, &query))
        return 0;
    sample->shadow_distance = query.t;
    return 1;
}

static void begin_sample(const Light *light, int shadowless, LightSample *sample)
{
    sample->source = light, sample->lamp = light->lamp, sample->shadowless = shadowless;
    sample->surface.primitive = NULL;
    sample->pdf = 0;
}

int source_sample(const Light *light, Vec3 position, float u1, float u2, LightSample *sample)
{
    const Vec3 point = source_point(light, position, u1, u2);
    const int from_middle = light->area && !light->area_illumination;
    begin_sample(light, light->shadowless, sample);
    sample->radiance = source_irradiance(light, position, from_middle ? light->location : point, &sample->direction,
                                         &sample->distance);
    sample->shadow_direction = sample->direction, sample->shadow_distance = sample->distance;
    if (from_middle)
        light->ops->shine(light, position, point, &sample->shadow_direction, &sample->shadow_distance);
    if (rgb_is_black(sample->radiance))
        return 0;
    return !light->projected_through || project(light, position, sample);
}

/* ---- what refracted and mirrored paths meet ---- */

static int sphere_met(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    const Vec3 to = vec_sub(light->location, ray->origin), across = vec_cross(to, ray->direction);
    const double size2 = light->size * light->size, distance2 = vec_dot(to, to);
    Vec3 direction;
    if (vec_dot(to, ray->direction) <= 0 || vec_dot(across, across) > size2 || distance2 <= size2)
        return 0;
    *radiance = rgb_scale(source_irradiance(light, ray->origin, light->location, &direction, distance),
                          (float)(distance2 / (PI * size2)));
    return 1;
}

/* A side of the grid that has one light only is as wide as a light without area. */
static Vec3 side_axis(Vec3 axis, Vec3 other, int n, double size)
{
    if (n > 1)
        return axis;
    const Vec3 along = vec_length(axis) > 0 ? axis : vec_cross(other, vec3(0.6, 0.48, 0.64));
    return vec_scale(vec_normalize(along), 2 * size);
}

static int area_met(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    Vec3 axis1, axis2, direction;
    grid_axes(light, ray->origin, &axis1, &axis2);
    const Vec3 side1 = side_axis(axis1, axis2, light->size1, light->size),
               side2 = side_axis(axis2, side1, light->size2, light->size);
    const Vec3 normal = vec_cross(side1, side2), to = vec_sub(light->location, ray->origin);
    const double area = vec_length(normal), fall = vec_dot(normal, ray->direction), t = vec_dot(normal, to) / fall;
    if (!(area > 0 && t > 0 && isfinite(t)))
        return 0;
    const Vec3 point = vec_mad(ray->origin, ray->direction, t), off = vec_sub(point, light->location);
    const double a = vec_dot(vec_cross(off, side2), normal) / (area * area),
                 b = vec_dot(vec_cross(side1, off), normal) / (area * area);
    if (light->circular ? a * a + b * b > 0.25 : fabs(a) > 0.5 || fabs(b) > 0.5)
        return 0;
    const double seen = (light->circular ? PI / 4 : 1) * fabs(fall);
    *radiance = rgb_scale(source_irradiance(light, ray->origin, point, &direction, distance), (float)(t * t / seen));
    return 1;
}

int point_meet(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    const int is_grid = light->area && (light->size1 > 1 || light->size2 > 1);
    return is_grid ? area_met(light, ray, radiance, distance) : sphere_met(light, ray, radiance, distance);
}

int source_meet(const Light *light, const Ray *ray, LightSample *sample)
{
    begin_sample(light, 0, sample);
    if (!light->ops->meet(light, ray, &sample->radiance, &sample->distance) || rgb_is_black(sample->radiance))
        return 0;
    sample->direction = sample->shadow_direction = ray->direction;
    sample->shadow_distance = sample->distance;
    return !light->projected_through || project(light, ray->origin, sample);
}

/* ---- in the list of lights ---- */

/* Approximate POV-Ray's fading by constant light, or by light that falls with the square of the distance. */
static void set_fading(const Light *light, LightBounds *b)
{
    double strength = PI * fmaxf(0, rgb_luminance(light->color)), at = light->fade_distance;
    if (light->fade_power < 1.5) {
        b->constant = light->fade_power > 0 ? 2 * strength : strength;
        return;
    }
    b->intensity = at > 0 ? 2 * strength * at * at : strength;
    b->peak = at > 0 ? 2 * strength : INFINITY;
}

static LightBounds source_bounds(const LightEntry *e, int face)
{
    const Light *light = &e->scene->lights[e->index];
    LightBounds b = {
        .low = light->location, .high = light->location, .axis = {0, 0, 1}, .theta_o = PI, .theta_e = PI / 2};
    (void)face;
    set_fading(light, &b);
    if (light->ops->cone) {
        const double half = light->ops->cone(light);
        b.axis = light_axis(light);
        b.theta_o = 0;
        b.theta_e = half > 0 ? fmin(half, PI / 2) : PI / 2;
    } else if (light->ies) {
        b.theta_o = ies_light_cone(light, &b.axis);
        b.theta_e = 0;
    }
    if (light->area) {
        double x = vec_length(light->axis1), y = vec_length(light->axis2), most = (x + y) / 2;
        b.low = vec_sub(b.low, vec3(most, most, most));
        b.high = vec_add(b.high, vec3(most, most, most));
    }
    return b;
}

static int add_sources(LightEntries *list, RetexError *err)
{
    const Scene *scene = list->scene;
    int code = RETEX_OK;
    for (int k = 0; k < scene->nlights && !code; k++) {
        const Light *light = &scene->lights[k];
        const float strength = rgb_luminance(light->color) * (float)PI;
        if (strength > 0)
            code = light_entries_add(list,
                                     &(LightEntry){.ops = &entry_source,
                                                   .index = k,
                                                   .lamp = light->lamp,
                                                   .strength = strength,
                                                   .is_infinite = light_is_beam(light)},
                                     err);
    }
    return code;
}

static int source_reaches(const LightEntry *e, const LightGroup *light_group)
{
    return light_reaches(&e->scene->lights[e->index], light_group);
}

static float source_estimate(const LightEntry *e, Vec3 position)
{
    const Light *light = &e->scene->lights[e->index];
    Vec3 direction;
    double distance;
    return rgb_luminance(source_irradiance(light, position, light->location, &direction, &distance));
}

static int sample_source(const LightEntry *e, const LightPick *pick, Vec3 position, float u1, float u2,
                         LightSample *sample)
{
    (void)pick;
    return source_sample(&e->scene->lights[e->index], position, u1, u2, sample);
}

const LightEntryOps entry_source = {.add = add_sources,
                                    .reaches = source_reaches,
                                    .estimate = source_estimate,
                                    .bounds = source_bounds,
                                    .sample = sample_source};
