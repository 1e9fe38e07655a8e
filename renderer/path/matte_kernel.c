/* See matte.h. Loops over lanes without branches: the compiler makes vectors of them. */
#include <retex/host/cpu.h>
#include "path/matte.h"

/* accel_offset, by the side that a direction points to. */
RETEX_CPU_INLINE Vec3 start_of_ray(Vec3 position, Vec3 geometric, double margin, double side)
{
    return vec_mad(position, geometric, side < 0 ? -margin : margin);
}

RETEX_CPU_INLINE void light_lane(MatteLights *to, const MattePacket *p, int k)
{
    Vec3 position = matte_get(&p->position, k), geometric = matte_get(&p->geometric, k);
    Vec3 face_normal = matte_get(&p->face_normal, k);
    double along = p->along[k], across = p->across[k], b1 = along * (1 - across), b2 = along * across;
    Vec3 point = vec_mad(vec_mad(matte_get(&p->corner, k), matte_get(&p->edge1, k), b1), matte_get(&p->edge2, k), b2);
    Vec3 d = vec_sub(point, position);
    double distance = vec_length(d);
    Vec3 direction = vec_scale(d, 1 / distance);
    double facing = vec_dot(direction, face_normal), slope = fabs(facing);
    float light_pdf = (float)(p->density[k] * distance * distance / slope) * p->pick_probability[k];
    /* Lambert */
    float cosine = (float)vec_dot(direction, matte_get(&p->normal, k));
    double side = vec_dot(direction, geometric);
    float pdf = cosine / (float)PI, value = p->diffuse[k] * pdf, ratio = pdf / light_pdf;
    /* the shadow ray ends just before the face, which it meets the earlier, the flatter the angle: see vertex.c */
    double margin = accel_margin(position);
    double length = distance * (1 - 1e-6) - margin;
    length -= (margin + accel_margin(point)) / (slope > 1e-3 ? slope : 1e-3);
    Vec3 origin = start_of_ray(position, geometric, margin, side);
    to->found[k] = (distance > 0) & (slope > 1e-9) & (cosine > 0) & (side >= 0) & (value != 0);
    to->behind[k] = facing > 0;
    matte_set(&to->direction, k, direction);
    matte_set(&to->origin, k, origin);
    to->length[k] = length > 0 ? length : 0;
    to->value[k] = value;
    to->weight[k] = 1 / (1 + ratio * ratio) / light_pdf;
}

RETEX_CPU_INLINE void bounce_lane(MatteBounces *to, const MattePacket *p, int k)
{
    Vec3 position = matte_get(&p->position, k), geometric = matte_get(&p->geometric, k);
    Vec3 normal = matte_get(&p->normal, k), s, t;
    float u = p->direction_u[k];
    double r = sqrt(u), sine, cosine;
    turn_sincos(p->direction_v[k], &sine, &cosine);
    vec_frame(normal, &s, &t);
    Vec3 wi = vec_mad(vec_mad(vec_scale(normal, sqrt(1 - u)), s, r * cosine), t, r * sine);
    float height = (float)vec_dot(wi, normal);
    double side = vec_dot(wi, geometric);
    Vec3 origin = start_of_ray(position, geometric, accel_margin(position), side);
    to->found[k] = (height > 0) & (side > 0);
    matte_set(&to->direction, k, wi);
    matte_set(&to->origin, k, origin);
    to->pdf[k] = height / (float)PI;
}

RETEX_CPU_INLINE void lights_body(MatteLights *restrict to, const MattePacket *restrict p)
{
    for (int k = 0; k < MATTE_LANES; k++)
        light_lane(to, p, k);
}

RETEX_CPU_INLINE void bounces_body(MatteBounces *restrict to, const MattePacket *restrict p)
{
    for (int k = 0; k < MATTE_LANES; k++)
        bounce_lane(to, p, k);
}

RETEX_CPU_KERNEL(lights, (MatteLights * to, const MattePacket *p), (to, p))
RETEX_CPU_KERNEL(bounces, (MatteBounces * to, const MattePacket *p), (to, p))

void matte_lights(MatteLights *to, const MattePacket *p)
{
    lights_by_level[retex_cpu_level()](to, p);
}

void matte_bounces(MatteBounces *to, const MattePacket *p)
{
    bounces_by_level[retex_cpu_level()](to, p);
}
