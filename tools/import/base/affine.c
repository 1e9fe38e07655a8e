/* Transforms. */
#include <math.h>

#include "import/base/affine.h"

#define THIN 1e-5 /* of its size: the thickness of what is flat */

const Affine affine_identity = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

Affine affine_from(const struct aiMatrix4x4 *m)
{
    return (Affine){{{m->a1, m->a2, m->a3, m->a4}, {m->b1, m->b2, m->b3, m->b4}, {m->c1, m->c2, m->c3, m->c4}}};
}

int affine_is_finite(const Affine *a)
{
    double sum = 0;
    for (int i = 0; i < 12; i++)
        sum += 0 * a->m[i / 4][i % 4];
    return sum == 0;
}

Affine affine_multiply(const Affine *a, const Affine *b)
{
    Affine c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            c.m[i][j] =
                a->m[i][0] * b->m[0][j] + a->m[i][1] * b->m[1][j] + a->m[i][2] * b->m[2][j] + (j == 3 ? a->m[i][3] : 0);
    return c;
}

void affine_vector(const Affine *a, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a->m[i][0] * v[0] + a->m[i][1] * v[1] + a->m[i][2] * v[2];
}

void affine_point(const Affine *a, const double p[3], double out[3])
{
    affine_vector(a, p, out);
    for (int i = 0; i < 3; i++)
        out[i] += a->m[i][3];
}

Affine affine_mirror_z(const Affine *a)
{
    Affine b = *a;
    b.m[0][2] = -b.m[0][2], b.m[1][2] = -b.m[1][2];
    b.m[2][0] = -b.m[2][0], b.m[2][1] = -b.m[2][1];
    b.m[2][3] = -b.m[2][3];
    return b;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The longest product of two of three vectors, as a unit vector: normal to all if they lie in a plane. Returns its
 * length. */
static double normal_of(const double v[3][3], double normal[3])
{
    double longest = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = v[i], *b = v[(i + 1) % 3];
        const double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
        const double length = sqrt(dot(n, n));
        for (int k = 0; k < 3 && length > longest; k++)
            normal[k] = n[k] / length;
        longest = fmax(longest, length);
    }
    return longest;
}

int affine_thicken(Affine *a)
{
    double rows[3][3], columns[3][3], from[3] = {0}, to[3] = {0}, size = 0;
    for (int i = 0; i < 9; i++)
        size = fmax(size, fabs(rows[i / 3][i % 3] = columns[i % 3][i / 3] = a->m[i / 3][i % 3]));
    const double plane = normal_of((const double(*)[3])rows, from);
    if (!(normal_of((const double(*)[3])columns, to) > 1e-7 * size * size) || !(plane > 0))
        return 0;
    double through[3];
    affine_vector(a, from, through);
    if (sqrt(dot(through, through)) > THIN * size)
        return 1;
    for (int i = 0; i < 9; i++)
        a->m[i / 3][i % 3] += THIN * size * to[i / 3] * from[i % 3];
    return 1;
}

/* Numbers that single precision made of 0 and 1 are written as these. */
static double tidy(double x, double size)
{
    return fabs(x) < 1e-7 * size ? 0 : round(x) != 0 && fabs(x - round(x)) < 1e-7 ? round(x) : x;
}

void affine_print(FILE *out, const Affine *a)
{
    double m[3][4], size = 1e-30;
    for (int i = 0; i < 9; i++)
        size = fmax(size, fabs(a->m[i / 3][i % 3]));
    for (int i = 0; i < 12; i++)
        m[i / 4][i % 4] = tidy(a->m[i / 4][i % 4], i % 4 == 3 ? 1 : size);
    const int diagonal = m[0][1] == 0 && m[0][2] == 0 && m[1][0] == 0 && m[1][2] == 0 && m[2][0] == 0 && m[2][1] == 0;
    const int moved = m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0;
    if (!diagonal || m[0][0] * m[1][1] * m[2][2] == 0) {
        fprintf(out, " matrix <");
        for (int j = 0; j < 4; j++)
            for (int i = 0; i < 3; i++)
                fprintf(out, "%s%.8g", i || j ? ", " : "", m[i][j]);
        fprintf(out, ">");
        return;
    }
    if (m[0][0] != 1 || m[1][1] != 1 || m[2][2] != 1) {
        if (m[0][0] == m[1][1] && m[1][1] == m[2][2])
            fprintf(out, " scale %.8g", m[0][0]);
        else
            fprintf(out, " scale <%.8g, %.8g, %.8g>", m[0][0], m[1][1], m[2][2]);
    }
    if (moved)
        fprintf(out, " translate <%.8g, %.8g, %.8g>", m[0][3], m[1][3], m[2][3]);
}

void vector_print(FILE *out, const char *before, const double v[3], const char *after)
{
    fprintf(out, "%s<%.7g, %.7g, %.7g>%s", before, v[0], v[1], v[2], after);
}
