/* GGX (Trowbridge-Reitz) microfacets in the shading frame, normal along z: distribution, Smith masking, visible
 * normals. Sources: Walter et al. 2007 (distribution, transmission), Heitz 2014 (height-correlated masking), Heitz
 * 2018 (sampling). */
#ifndef RENDERER_SHADE_MICROFACET_H
#define RENDERER_SHADE_MICROFACET_H

#include "base/vec.h"

static inline double ggx_d(Vec3 h, double alpha)
{
    double a2 = alpha * alpha, c2 = h.z * h.z, k = (h.x * h.x + h.y * h.y) / a2 + c2;
    return 1 / (PI * a2 * k * k);
}

static inline double ggx_lambda(Vec3 w, double alpha)
{
    double c2 = w.z * w.z;
    if (c2 <= 0) return 1e30;
    double t2 = alpha * alpha * (w.x * w.x + w.y * w.y) / c2;
    return (sqrt(1 + t2) - 1) / 2;
}

static inline double ggx_g1(Vec3 w, double alpha) { return 1 / (1 + ggx_lambda(w, alpha)); }
static inline double ggx_g2(Vec3 a, Vec3 b, double alpha)
{
    return 1 / (1 + ggx_lambda(a, alpha) + ggx_lambda(b, alpha));
}

/* A normal seen from wo (wo.z > 0), with density ggx_visible_pdf. */
static inline Vec3 ggx_sample_visible(Vec3 wo, double alpha, double u1, double u2)
{
    Vec3 v = vec_normalize(vec3(alpha * wo.x, alpha * wo.y, wo.z));
    double length2 = v.x * v.x + v.y * v.y;
    Vec3 t1 = length2 > 1e-14 ? vec_scale(vec3(-v.y, v.x, 0), 1 / sqrt(length2)) : vec3(1, 0, 0);
    Vec3 t2 = vec_cross(v, t1);
    double r = sqrt(u1), phi = 2 * PI * u2, p1 = r * cos(phi), p2 = r * sin(phi), s = (1 + v.z) / 2;
    p2 = (1 - s) * sqrt(fmax(0, 1 - p1 * p1)) + s * p2;
    double p3 = sqrt(fmax(0, 1 - p1 * p1 - p2 * p2));
    Vec3 n = vec_add(vec_add(vec_scale(t1, p1), vec_scale(t2, p2)), vec_scale(v, p3));
    return vec_normalize(vec3(alpha * n.x, alpha * n.y, fmax(1e-7, n.z)));
}

static inline double ggx_visible_pdf(Vec3 wo, Vec3 h, double alpha)
{
    return ggx_g1(wo, alpha) * fmax(0, vec_dot(wo, h)) * ggx_d(h, alpha) / wo.z;
}

#endif
