/* See color_tag.h. IDs and tolerance are those of the Color Interop Forum's recommendations on textures and on OpenEXR
 * files. */
#include "exr/color_tag.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define TOLERANCE 1e-3 /* tolerance for chromaticities and for elements of a matrix */

#define D65 0.3127f, 0.3290f
#define ACES_WHITE 0.32168f, 0.33767f
#define REC709                                                                                                         \
    {                                                                                                                  \
        .64f, .33f, .3f, .6f, .15f, .06f, D65                                                                          \
    }

static const RetexColorTag linear_spaces[] = {
    {"lin_rec709_scene", 1, REC709},
    {"lin_ap1_scene", 1, {.713f, .293f, .165f, .83f, .128f, .044f, ACES_WHITE}},
    {"lin_ap0_scene", 1, {.7347f, .2653f, 0, 1, .0001f, -.077f, ACES_WHITE}},
    {"lin_p3d65_scene", 1, {.68f, .32f, .265f, .69f, .15f, .06f, D65}},
    {"lin_rec2020_scene", 1, {.708f, .292f, .17f, .797f, .131f, .046f, D65}},
    {"lin_adobergb_scene", 1, {.64f, .33f, .21f, .71f, .15f, .06f, D65}},
};
enum { SPACES = sizeof linear_spaces / sizeof *linear_spaces };

const RetexColorTag retex_color_tag_rec709 = {"lin_rec709_scene", 1, REC709};
const RetexColorTag retex_color_tag_data = {"data", 0, {0}};

const RetexColorTag *retex_color_tag_find(const char *interop)
{
    for (int i = 0; i < SPACES; i++)
        if (strcmp(linear_spaces[i].interop, interop) == 0)
            return &linear_spaces[i];
    return NULL;
}

/* ---- matrices ---- */

/* Inverts a matrix; 0 where the inverse does not exist or overflows. */
static int invert(const double m[3][3], double out[3][3])
{
    double determinant = 0, size = 0;

    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
            out[j][i] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
            size = fmax(size, fabs(m[i][j]));
        }
    for (int j = 0; j < 3; j++)
        determinant += m[0][j] * out[j][0];
    if (!isfinite(determinant) || !(fabs(determinant) > 1e-9 * size * size * size))
        return 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] /= determinant;
    return 1;
}

static void multiply(const double a[3][3], const double b[3][3], double out[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
}

static void apply(const double m[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

static int xyz_of(const float xy[2], double out[3])
{
    const double x = xy[0], y = xy[1];

    out[0] = x / y;
    out[1] = 1;
    out[2] = (1 - x - y) / y;
    return isfinite(x) && isfinite(y) && y > TOLERANCE && x > 0 && x + y < 1 + TOLERANCE;
}

/* The matrix from RGB to CIE XYZ: primaries as columns, scaled so that (1, 1, 1) is white. 0 where they span no
 * space. */
static int rgb_to_xyz(const float c[8], double out[3][3])
{
    double primaries[3][3], inverse[3][3], white[3], sizes[3];

    for (int j = 0; j < 3; j++) {
        primaries[0][j] = c[2 * j];
        primaries[1][j] = c[2 * j + 1];
        primaries[2][j] = 1 - primaries[0][j] - primaries[1][j];
    }
    if (!xyz_of(c + 6, white) || !invert(primaries, inverse))
        return 0;
    apply(inverse, white, sizes);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = primaries[i][j] * sizes[j];
    return 1;
}

/* Bradford's chromatic adaptation between two whites. 0 where a white has no cone response. */
static int adapt(const float from[2], const float to[2], double out[3][3])
{
    static const double cones[3][3] = {{.8951, .2664, -.1614}, {-.7502, 1.7135, .0367}, {.0389, -.0685, 1.0296}};
    double back[3][3], scaled[3][3], xyz[3], before[3], after[3];

    if (!xyz_of(from, xyz))
        return 0;
    apply(cones, xyz, before);
    if (!xyz_of(to, xyz) || !invert(cones, back))
        return 0;
    apply(cones, xyz, after);
    for (int i = 0; i < 3; i++) {
        if (!(before[i] > 0))
            return 0;
        for (int j = 0; j < 3; j++)
            scaled[i][j] = cones[i][j] * after[i] / before[i];
    }
    multiply(back, scaled, out);
    return 1;
}

static int are_rec709(const float c[8])
{
    int same = 1;

    for (int i = 0; i < 8; i++)
        same &= fabs((double)c[i] - (double)retex_color_tag_rec709.chromaticities[i]) <= TOLERANCE;
    return same;
}

int retex_color_tag_to_rec709(const float chromaticities[8], double matrix[3][3])
{
    const float *ours = retex_color_tag_rec709.chromaticities;
    double to_xyz[3][3], adapted[3][3], adaptation[3][3], rec709[3][3], from_xyz[3][3];

    if (are_rec709(chromaticities))
        return 0;
    if (!rgb_to_xyz(chromaticities, to_xyz) || !adapt(chromaticities + 6, ours + 6, adaptation) ||
        !rgb_to_xyz(ours, rec709) || !invert(rec709, from_xyz))
        return -1;
    multiply(adaptation, to_xyz, adapted);
    multiply(from_xyz, adapted, matrix);
    return 1;
}

const RetexColorTag *retex_color_tag_of_matrix(const double from_rec709[3][3])
{
    for (int k = 0; k < SPACES; k++) {
        double back[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, product[3][3], off = 0;
        retex_color_tag_to_rec709(linear_spaces[k].chromaticities, back);
        multiply(back, from_rec709, product);
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                off = fmax(off, fabs(product[i][j] - (i == j)));
        if (off <= TOLERANCE)
            return &linear_spaces[k];
    }
    return NULL;
}
