/* POV-Ray's light sources: point, spot, cylinder and parallel light, area lights as points of their grid, fading. */
#include "light/lights.h"
#include "shape/csg.h"

/* 0 below low, 1 above high, a smooth cubic between. */
static double smooth_step(double low, double high, double x)
{
    if (x <= low)
        return 0;
    if (x >= high)
        return 1;
    double t = (x - low) / (high - low);
    return (3 - 2 * t) * t * t;
}

static double spot_attenuation(const Light *light, Vec3 to_light)
{
    Vec3 axis = vec_normalize(vec_sub(light->point_at, light->location));
    double cosine = -vec_dot(axis, to_light);
    if (cosine <= 0)
        return 0;
    double value = light->tightness > 0 ? pow(cosine, light->tightness) : 1;
    if (light->falloff > 0) {
        double outer = cos(light->falloff * PI / 180), inner = cos(light->radius * PI / 180);
        value *= inner > outer ? smooth_step(outer, inner, cosine) : cosine > outer;
    }
    return value;
}

static double cylinder_attenuation(const Light *light, Vec3 position)
{
    Vec3 axis = vec_normalize(vec_sub(light->point_at, light->location)), d = vec_sub(position, light->location);
    double along = vec_dot(d, axis), across = vec_length(vec_mad(d, axis, -along));
    if (along <= 0 || across >= light->falloff)
        return 0;
    double value = 1 - across / light->falloff;
    double edge =
        across > light->radius && light->radius > 0 ? smooth_step(0, 1 - light->radius / light->falloff, value) : 1;
    return edge * (light->tightness > 0 ? pow(value, light->tightness) : 1);
}

static double distance_fade(const Light *light, double distance)
{
    if (light->fade_power <= 0)
        return 1;
    if (light->fade_distance > 0)
        return 2 / (1 + pow(distance / light->fade_distance, light->fade_power));
    return pow(fmax(distance, 1e-6), -light->fade_power);
}

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

/* Parallel light starts on the plane through its location. */
int source_is_beam(const Light *light)
{
    return light->kind == LIGHT_PARALLEL || light->kind == LIGHT_CYLINDER;
}

Rgb source_irradiance(const Light *light, Vec3 position, Vec3 light_point, Vec3 *direction, double *distance)
{
    double value = PI;
    Vec3 d = vec_sub(light_point, position);
    if (source_is_beam(light)) {
        *direction = vec_normalize(vec_sub(light_point, light->point_at));
        *distance = fmax(0, vec_dot(d, *direction)); /* POV-Ray lights points behind the plane too, without shadows */
        if (light->kind == LIGHT_CYLINDER)
            value *= cylinder_attenuation(light, position);
    } else {
        *distance = vec_length(d);
        if (*distance <= 0)
            return rgb_grey(0);
        *direction = vec_scale(d, 1 / *distance);
        if (light->kind == LIGHT_SPOT)
            value *= spot_attenuation(light, *direction);
    }
    return rgb_scale(light->color, (float)(value * distance_fade(light, *distance)));
}

/* The part of a line, from a point seen from the light, that lies in its cone about an axis. */
static int part_in_cone(Vec3 from, Vec3 direction, Vec3 axis, double cosine, double *begin, double *end)
{
    const double c2 = cosine * cosine, f = vec_dot(from, axis), d = vec_dot(direction, axis);
    const double a = d * d - c2, b = f * d - c2 * vec_dot(from, direction), c = f * f - c2 * vec_dot(from, from);
    const double discriminant = b * b - a * c, root = sqrt(fmax(discriminant, 0));
    const double one = (-b - root) / a, two = (-b + root) / a, low = fmin(one, two), high = fmax(one, two);
    if (!isfinite(one + two))
        return 1;
    if (a < 0) { /* between the roots, where it is the cone's own half */
        *begin = fmax(*begin, low), *end = fmin(*end, high);
        return discriminant > 0 && f + d * (low + high) / 2 > 0;
    }
    if (discriminant > 0)
        *begin = d > 0 ? fmax(*begin, high) : *begin, *end = d > 0 ? *end : fmin(*end, low);
    return 1;
}

static int part_in_cylinder(Vec3 from, Vec3 direction, Vec3 axis, double radius, double *begin, double *end)
{
    const Vec3 f = vec_mad(from, axis, -vec_dot(from, axis)), d = vec_mad(direction, axis, -vec_dot(direction, axis));
    const double a = vec_dot(d, d), b = vec_dot(f, d), c = vec_dot(f, f) - radius * radius,
                 discriminant = b * b - a * c;
    if (a < 1e-12)
        return c < 0;
    *begin = fmax(*begin, (-b - sqrt(fmax(discriminant, 0))) / a);
    *end = fmin(*end, (-b + sqrt(fmax(discriminant, 0))) / a);
    return discriminant > 0;
}

int source_lit_part(const Light *light, const Ray *ray, double distance, double *begin, double *end)
{
    const Vec3 axis = vec_normalize(vec_sub(light->point_at, light->location));
    const Vec3 from = vec_sub(vec_mad(ray->origin, ray->direction, ray->tmin), light->location);
    int found = 1;
    *begin = 0, *end = distance;
    if (light->kind == LIGHT_CYLINDER)
        found = part_in_cylinder(from, ray->direction, axis, light->falloff, begin, end);
    else if (light->kind == LIGHT_SPOT && light->falloff > 0 && light->falloff < 89 && !light->area_illumination)
        found = part_in_cone(from, ray->direction, axis, cos(light->falloff * PI / 180), begin, end);
    return found && *begin < *end;
}

float source_most_irradiance(const Light *light, const Ray *ray, double distance)
{
    const double strength = PI * fmaxf(0, rgb_luminance(light->color));
    if (light->fade_power <= 0 || source_is_beam(light))
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

int source_sample(const Light *light, Vec3 position, float u1, float u2, LightSample *sample)
{
    const Vec3 point = source_point(light, position, u1, u2);
    const int from_middle = light->area && !light->area_illumination;
    sample->kind = LIGHT_SAMPLE_SOURCE;
    sample->pdf = 0;
    sample->shadowless = light->shadowless;
    sample->source = light;
    sample->radiance = source_irradiance(light, position, from_middle ? light->location : point, &sample->direction,
                                         &sample->distance);
    sample->shadow_direction = sample->direction, sample->shadow_distance = sample->distance;
    if (from_middle)
        source_irradiance(light, position, point, &sample->shadow_direction, &sample->shadow_distance);
    if (rgb_is_black(sample->radiance))
        return 0;
    return !light->projected_through || project(light, position, sample);
}

/* ---- what refracted and mirrored paths meet ---- */

static int beam_met(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    const Vec3 to = vec_sub(light->location, light->point_at);
    const double slope = light->size / vec_length(to), sin2 = slope * slope / (1 + slope * slope);
    const Vec3 across = vec_cross(vec_normalize(to), ray->direction);
    Vec3 direction;
    if (vec_dot(to, ray->direction) <= 0 || vec_dot(across, across) > sin2)
        return 0;
    *radiance = rgb_scale(source_irradiance(light, ray->origin, light->location, &direction, distance),
                          (float)(1 / (PI * sin2)));
    return 1;
}

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

static int is_met(const Light *light, const Ray *ray, Rgb *radiance, double *distance)
{
    if (source_is_beam(light))
        return beam_met(light, ray, radiance, distance);
    const int is_grid = light->area && (light->size1 > 1 || light->size2 > 1);
    return is_grid ? area_met(light, ray, radiance, distance) : sphere_met(light, ray, radiance, distance);
}

int source_meet(const Light *light, const Ray *ray, LightSample *sample)
{
    sample->kind = LIGHT_SAMPLE_SOURCE;
    sample->pdf = 0;
    sample->shadowless = 0;
    sample->source = light;
    if (!is_met(light, ray, &sample->radiance, &sample->distance) || rgb_is_black(sample->radiance))
        return 0;
    sample->direction = sample->shadow_direction = ray->direction;
    sample->shadow_distance = sample->distance;
    return !light->projected_through || project(light, ray->origin, sample);
}

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

LightBounds source_bounds(const Light *light)
{
    LightBounds b = {
        .low = light->location, .high = light->location, .axis = {0, 0, 1}, .theta_o = PI, .theta_e = PI / 2};
    set_fading(light, &b);
    if (light->kind == LIGHT_SPOT) {
        b.axis = vec_normalize(vec_sub(light->point_at, light->location));
        b.theta_o = 0;
        b.theta_e = light->falloff > 0 ? fmin(90, light->falloff) * PI / 180 : PI / 2;
    }
    if (light->area) {
        double x = vec_length(light->axis1), y = vec_length(light->axis2), most = (x + y) / 2;
        b.low = vec_sub(b.low, vec3(most, most, most));
        b.high = vec_add(b.high, vec3(most, most, most));
    }
    return b;
}
