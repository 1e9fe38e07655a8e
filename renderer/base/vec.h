/* Vectors, colours and affine maps. Scene quantities are double; rays go to Embree as float. */
#ifndef RENDERER_BASE_VEC_H
#define RENDERER_BASE_VEC_H

#include <math.h>
#include <retex/color.h>

#define PI 3.14159265358979323846

typedef struct Vec3 { double x, y, z; } Vec3;
typedef struct Vec2 { double u, v; } Vec2;
typedef struct Rgb { float r, g, b; } Rgb;
typedef struct Ray {
    Vec3 origin, direction; /* direction of unit length */
    double tmin, tmax;
} Ray;

static inline Vec3 vec3(double x, double y, double z) { return (Vec3){x, y, z}; }
static inline Vec3 vec_add(Vec3 a, Vec3 b) { return vec3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline Vec3 vec_sub(Vec3 a, Vec3 b) { return vec3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline Vec3 vec_scale(Vec3 a, double s) { return vec3(a.x * s, a.y * s, a.z * s); }
static inline Vec3 vec_mad(Vec3 a, Vec3 d, double s) { return vec3(a.x + d.x * s, a.y + d.y * s, a.z + d.z * s); }
static inline Vec3 vec_neg(Vec3 a) { return vec3(-a.x, -a.y, -a.z); }
static inline double vec_dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline Vec3 vec_cross(Vec3 a, Vec3 b)
{
    return vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double vec_component(Vec3 a, int axis) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; }
static inline Vec3 vec_min(Vec3 a, Vec3 b) { return vec3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z)); }
static inline Vec3 vec_max(Vec3 a, Vec3 b) { return vec3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z)); }
static inline double vec_largest(Vec3 a) { return fmax(fabs(a.x), fmax(fabs(a.y), fabs(a.z))); }
static inline int vec_is_finite(Vec3 a) { return (a.x + a.y + a.z) * 0 == 0; }
static inline double vec_length(Vec3 a) { return sqrt(vec_dot(a, a)); }
/* A point seen along the axis that is nearest to a direction. */
static inline Vec2 vec_project(Vec3 p, Vec3 along)
{
    const Vec3 size = vec3(fabs(along.x), fabs(along.y), fabs(along.z));
    if (size.x > size.y && size.x > size.z)
        return (Vec2){p.z, p.y};
    return size.y > size.z ? (Vec2){p.x, p.z} : (Vec2){p.x, p.y};
}
/* The zero vector stays zero. */
static inline Vec3 vec_normalize(Vec3 a)
{
    double length = vec_length(a);
    return length > 0 ? vec_scale(a, 1 / length) : a;
}
/* Two unit vectors that make a right-handed frame with unit n (Duff et al. 2017). */
static inline void vec_frame(Vec3 n, Vec3 *s, Vec3 *t)
{
    double sign = copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    *s = vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    *t = vec3(b, sign + n.y * n.y * a, -n.y);
}

/* Sine and cosine of u turns, u in [0, 1), to 1e-11: for directions, where libm's call is the dearest part. */
static inline void turn_sincos(double u, double *sine, double *cosine)
{
    int quarter = (int)(4 * u + 0.5);
    double f = (4 * u - quarter) * (PI / 2), f2 = f * f;
    double s = f * (1 + f2 * (-1.0 / 6 + f2 * (1.0 / 120 + f2 * (-1.0 / 5040 + f2 * (1.0 / 362880 - f2 / 39916800)))));
    double c = 1 + f2 * (-1.0 / 2 + f2 * (1.0 / 24 + f2 * (-1.0 / 720 + f2 * (1.0 / 40320 +
               f2 * (-1.0 / 3628800 + f2 / 479001600)))));
    double y = quarter & 1 ? c : s, x = quarter & 1 ? s : c;
    *sine = quarter & 2 ? -y : y;
    *cosine = (quarter + 1) & 2 ? -x : x;
}

/* Not fmaxf and fminf, which are calls. NaN becomes 0. */
static inline float not_negative(float x) { return x > 0 ? x : 0; }
static inline float at_most(float x, float most) { return x < most ? x : most; }

static inline Rgb rgb(float r, float g, float b) { return (Rgb){r, g, b}; }
static inline Rgb rgb_grey(float v) { return rgb(v, v, v); }
static inline Rgb rgb_add(Rgb a, Rgb b) { return rgb(a.r + b.r, a.g + b.g, a.b + b.b); }
static inline Rgb rgb_mul(Rgb a, Rgb b) { return rgb(a.r * b.r, a.g * b.g, a.b * b.b); }
static inline Rgb rgb_scale(Rgb a, float s) { return rgb(a.r * s, a.g * s, a.b * s); }
static inline Rgb rgb_lerp(Rgb a, Rgb b, float t) { return rgb_add(rgb_scale(a, 1 - t), rgb_scale(b, t)); }
static inline int rgb_is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }
static inline int rgb_is_finite(Rgb a) { return isfinite(a.r + a.g + a.b); }
static inline float rgb_max(Rgb a) { return fmaxf(a.r, fmaxf(a.g, a.b)); }
static inline float rgb_min(Rgb a) { return fminf(a.r, fminf(a.g, a.b)); }
/* Rec.709 luminance. */
static inline float rgb_luminance(Rgb a) { return retex_luminancef(a.r, a.g, a.b); }

/* p' = m[.][0..2] p + m[.][3]; inverse holds the inverse map in the same form. */
typedef struct Transform {
    double m[3][4], inverse[3][4];
} Transform;

Transform transform_identity(void);
Transform transform_translate(Vec3 by);
Transform transform_scale(Vec3 by);               /* a 0 becomes 1, as in POV-Ray */
Transform transform_rotate(Vec3 degrees);         /* about x, then y, then z, left-handed as POV-Ray's */
Transform transform_axis_rotate(Vec3 axis, double degrees); /* left-handed */
/* POV-Ray's 12 values: rows of a 4x3 matrix that acts on row vectors. Returns 0 where it is singular. */
int transform_matrix(const double values[12], Transform *out);
/* Columns: x, y, z axes and origin. Returns 0 where singular. */
int transform_from_axes(Vec3 x, Vec3 y, Vec3 z, Vec3 origin, Transform *out);
Transform transform_then(Transform first, Transform second); /* apply first, then second */
Transform transform_inverse(Transform t);
Vec3 transform_point(const Transform *t, Vec3 p);
Vec3 transform_vector(const Transform *t, Vec3 d);
Vec3 transform_normal(const Transform *t, Vec3 n); /* by the inverse transpose; not normalised */
Vec3 transform_inverse_point(const Transform *t, Vec3 p);
Vec3 transform_inverse_vector(const Transform *t, Vec3 d);
Vec3 transform_inverse_normal(const Transform *t, Vec3 n); /* normal taken from outer to inner space */

#endif
