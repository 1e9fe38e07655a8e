/* Transforms. */
#include <math.h>

#include "import/base/affine.h"

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

/* Numbers that single precision made of 0 and 1 are written as these. */
static double tidy(double x, double size)
{
    return fabs(x) < 1e-7 * size ? 0 : fabs(x - round(x)) < 1e-7 ? round(x) : x;
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
