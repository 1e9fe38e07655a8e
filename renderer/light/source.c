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

Vec3 source_point(const Light *light, Vec3 position, float u1, float u2)
{
    if (!light->area)
        return light->location;
    int n1 = light->size1 > 1 ? light->size1 : 1, n2 = light->size2 > 1 ? light->size2 : 1;
    double a = grid_place(light, u1, n1), b = grid_place(light, u2, n2);
    Vec3 axis1 = light->axis1, axis2 = light->axis2;
    if (light->orient) { /* the grid faces the lit point */
        Vec3 s, t;
        vec_frame(vec_normalize(vec_sub(position, light->location)), &s, &t);
        axis1 = vec_scale(s, vec_length(axis1));
        axis2 = vec_scale(t, vec_length(axis2));
    }
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
