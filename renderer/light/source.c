/* POV-Ray's light sources: point, spot, cylinder and parallel light, area lights as points of their grid, fading. */
#include "light/lights.h"

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

Vec3 source_point(const Light *light, Vec3 position, float u1, float u2)
{
    if (!light->area)
        return light->location;
    int n1 = light->size1 > 1 ? light->size1 : 1, n2 = light->size2 > 1 ? light->size2 : 1;
    double a = n1 > 1 ? floor(u1 * n1) / (n1 - 1) - 0.5 : 0, b = n2 > 1 ? floor(u2 * n2) / (n2 - 1) - 0.5 : 0;
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
