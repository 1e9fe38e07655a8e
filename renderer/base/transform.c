/* Affine maps of POV-Ray's scene language.
 *
 * POV-Ray writes points as rows and multiplies matrices from the right; here points are columns, so its matrices are
 * transposed on entry and nowhere else. Its coordinates are left-handed, which makes the ordinary rotation formulas
 * turn left-handed. Every Transform carries its inverse, composed along with it rather than computed anew, so that a
 * long chain of transforms does not lose it. */
#include <string.h>
#include "base/vec.h"

#define DEGREE (PI / 180)

Transform transform_identity(void)
{
    return (Transform){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
}

Transform transform_translate(Vec3 by)
{
    Transform t = transform_identity();
    const double offset[3] = {by.x, by.y, by.z};

    for (int i = 0; i < 3; i++) {
        t.m[i][3] = offset[i];
        t.inverse[i][3] = -offset[i];
    }
    return t;
}

Transform transform_scale(Vec3 by)
{
    Transform t = transform_identity();
    const double factor[3] = {by.x, by.y, by.z};

    for (int i = 0; i < 3; i++) {
        t.m[i][i] = factor[i] == 0 ? 1 : factor[i];
        t.inverse[i][i] = 1 / t.m[i][i];
    }
    return t;
}

/* Sine and cosine that are exact at the quarter turns scenes are full of. */
static void sine_cosine(double degrees, double *sine, double *cosine)
{
    double turn = fmod(degrees, 360);

    if (turn < 0)
        turn += 360;
    if (fmod(turn, 90) == 0) {
        static const double quarter[5] = {0, 1, 0, -1, 0};
        int i = (int)(turn / 90) & 3;
        *sine = quarter[i];
        *cosine = quarter[i + 1];
    } else {
        *sine = sin(turn * DEGREE);
        *cosine = cos(turn * DEGREE);
    }
}

/* The inverse of a rotation is its transpose. */
static Transform from_rotation(const double r[3][3])
{
    Transform t = transform_identity();

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            t.m[i][j] = t.inverse[j][i] = r[i][j];
    return t;
}

Transform transform_rotate(Vec3 degrees)
{
    double s, c;
    Transform t;

    sine_cosine(degrees.x, &s, &c);
    t = from_rotation((const double[3][3]){{1, 0, 0}, {0, c, -s}, {0, s, c}});
    sine_cosine(degrees.y, &s, &c);
    t = transform_then(t, from_rotation((const double[3][3]){{c, 0, s}, {0, 1, 0}, {-s, 0, c}}));
    sine_cosine(degrees.z, &s, &c);
    return transform_then(t, from_rotation((const double[3][3]){{c, -s, 0}, {s, c, 0}, {0, 0, 1}}));
}

Transform transform_axis_rotate(Vec3 axis, double degrees)
{
    Vec3 a = vec_normalize(axis);
    double s, c, d;

    if (vec_dot(a, a) == 0)
        return transform_identity();
    sine_cosine(degrees, &s, &c);
    d = 1 - c;
    return from_rotation((const double[3][3]){{c + a.x * a.x * d, a.x * a.y * d - a.z * s, a.x * a.z * d + a.y * s},
                                              {a.x * a.y * d + a.z * s, c + a.y * a.y * d, a.y * a.z * d - a.x * s},
                                              {a.x * a.z * d - a.y * s, a.y * a.z * d + a.x * s, c + a.z * a.z * d}});
}

int transform_from_axes(Vec3 x, Vec3 y, Vec3 z, Vec3 origin, Transform *out)
{
    Vec3 yz = vec_cross(y, z), zx = vec_cross(z, x), xy = vec_cross(x, y);
    double determinant = vec_dot(x, yz), size = vec_length(x) * vec_length(y) * vec_length(z);
    double inverse = 1 / determinant;

    /* Relative to the axes' lengths: a small scale is not a singular one. */
    if (!(fabs(determinant) > 1e-14 * size) || !isfinite(inverse) || !isfinite(vec_dot(origin, origin)))
        return 0;
    *out = (Transform){{{x.x, y.x, z.x, origin.x}, {x.y, y.y, z.y, origin.y}, {x.z, y.z, z.z, origin.z}},
                       {{yz.x * inverse, yz.y * inverse, yz.z * inverse, -vec_dot(yz, origin) * inverse},
                        {zx.x * inverse, zx.y * inverse, zx.z * inverse, -vec_dot(zx, origin) * inverse},
                        {xy.x * inverse, xy.y * inverse, xy.z * inverse, -vec_dot(xy, origin) * inverse}}};
    return 1;
}

int transform_matrix(const double values[12], Transform *out)
{
    Vec3 row[4];

    for (int i = 0; i < 4; i++)
        row[i] = vec3(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    return transform_from_axes(row[0], row[1], row[2], row[3], out);
}

static void multiply(double out[3][4], double a[3][4], double b[3][4])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 4; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
        out[i][3] += a[i][3];
    }
}

Transform transform_then(Transform first, Transform second)
{
    Transform t;

    multiply(t.m, second.m, first.m);
    multiply(t.inverse, first.inverse, second.inverse);
    return t;
}

Transform transform_inverse(Transform t)
{
    Transform out;

    memcpy(out.m, t.inverse, sizeof(out.m));
    memcpy(out.inverse, t.m, sizeof(out.inverse));
    return out;
}

static Vec3 linear(const double m[3][4], Vec3 d)
{
    return vec3(m[0][0] * d.x + m[0][1] * d.y + m[0][2] * d.z, m[1][0] * d.x + m[1][1] * d.y + m[1][2] * d.z,
                m[2][0] * d.x + m[2][1] * d.y + m[2][2] * d.z);
}

static Vec3 affine(const double m[3][4], Vec3 p)
{
    return vec_add(linear(m, p), vec3(m[0][3], m[1][3], m[2][3]));
}

static Vec3 transposed(const double m[3][4], Vec3 n)
{
    return vec3(m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z, m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
                m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z);
}

Vec3 transform_point(const Transform *t, Vec3 p)
{
    return affine(t->m, p);
}
Vec3 transform_vector(const Transform *t, Vec3 d)
{
    return linear(t->m, d);
}
Vec3 transform_normal(const Transform *t, Vec3 n)
{
    return transposed(t->inverse, n);
}
Vec3 transform_inverse_point(const Transform *t, Vec3 p)
{
    return affine(t->inverse, p);
}
Vec3 transform_inverse_vector(const Transform *t, Vec3 d)
{
    return linear(t->inverse, d);
}
Vec3 transform_inverse_normal(const Transform *t, Vec3 n)
{
    return transposed(t->m, n);
}
