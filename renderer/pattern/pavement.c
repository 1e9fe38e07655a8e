/* pavement: how far a point is from the edges of its tile, and how these look at corners. */
#include "pattern/pavement.h"
#include "pattern/pattern.h"

/* Which edges of its squares a pavement has: measured in POV-Ray's pictures. Of each square of a period, bit 0: it has
 * its edge of least x, bit 1: that of least z. A period has rows of `width` squares, as many as `height`; the next
 * period in z is moved by `shift` in x. */
typedef struct Period {
    int width, shift, height;
    const char *edges; /* digits, row by row */
} Period;

/* clang-format off */
static const Period periods[] = {
    {1, 0, 1, "3"}, {1, 0, 2, "31"}, {3, 0, 1, "322"}, {3, 0, 2, "332121"}, {4, 0, 1, "3222"}, {4, 0, 2, "33221221"},
    {4, 2, 1, "3221"}, {2, 0, 2, "3210"}, {2, 1, 2, "2330"}, {5, 0, 1, "32222"}, {5, 0, 2, "3322212221"},
    {5, 2, 2, "2323230010"}, {5, 3, 1, "32221"}, {5, 3, 1, "30213"}, {10, 9, 1, "3112232211"},
    {10, 9, 1, "1312123212"}, {10, 7, 1, "3221313120"}, {5, 4, 1, "31221"}, {5, 2, 2, "3302112213"},
    {5, 1, 2, "2322330320"}, {10, 2, 1, "3223021131"}, {6, 0, 1, "322222"}, {6, 0, 2, "322223132220"},
    {6, 0, 2, "322223213220"}, {6, 0, 2, "322223221320"}, {6, 1, 1, "303222"}, {6, 0, 2, "322232103200"},
    {6, 0, 2, "232322300210"}, {6, 1, 1, "320322"}, {3, 0, 2, "232300"}, {3, 0, 2, "322100"},
    {4, 0, 3, "332212101021"}, {6, 5, 1, "322121"}, {4, 0, 3, "322231311202"}, {3, 0, 4, "322213112023"},
    {3, 1, 2, "320310"}, {6, 4, 1, "330210"}, {6, 5, 2, "302231313202"}, {6, 5, 2, "313220122231"},
    {6, 5, 1, "312211"}, {6, 1, 1, "132203"}, {6, 1, 1, "113222"}, {4, 0, 3, "322213312012"},
    {4, 0, 3, "130212213131"}, {6, 2, 2, "323201312212"}, {2, 0, 3, "322112"}, {2, 0, 3, "321021"},
    {2, 0, 3, "320312"}, {6, 5, 1, "312212"}, {6, 2, 2, "321312212032"}, {6, 3, 2, "231221302132"},
    {6, 3, 2, "320231132203"}, {6, 2, 1, "313202"}, {3, 0, 4, "322321130122"}, {12, 5, 1, "302231313220"},
    {4, 2, 3, "132012211331"},
};
/* clang-format on */

static const int counts[PAVEMENT_SQUARES + 1] = {0, 1, 1, 2, 5, 12, 35};

int pavement_count(int tiles)
{
    return counts[tiles];
}

static const Period *period_of(const Pavement *pavement)
{
    const Period *period = periods + pavement->pattern - 1;
    for (int k = 1; k < pavement->tiles; k++)
        period += counts[k];
    return period;
}

/* ---- edges ---- */

typedef struct Square {
    const Period *period;
    double x, z; /* its corner of least x and z */
} Square;

static int modulo(double i, int n)
{
    const int rest = (int)fmod(i, n);
    return rest < 0 ? rest + n : rest;
}

static int edges_at(const Square *square, int dx, int dz)
{
    const Period *period = square->period;
    const double z = square->z + dz, repeats = floor(z / period->height);
    const int column = modulo(square->x + dx - period->shift * fmod(repeats, period->width), period->width);
    return period->edges[modulo(z, period->height) * period->width + column] - '0';
}

static int edge_x(const Square *square, int dx, int dz)
{
    return edges_at(square, dx, dz) & 1;
}

static int edge_z(const Square *square, int dx, int dz)
{
    return edges_at(square, dx, dz) >> 1;
}

/* ---- the value ---- */

/* 0 in the middle of a corner, 1 half a side away. */
static double look_at_corner(int look, double a, double b)
{
    return 2 * (look == 0 ? fmax(a, b) : look == 1 ? a + b : hypot(a, b));
}

/* A tile turns its corner in a square of two neighbouring edges: bands round its inner corner, from which a and b are
 * measured. */
static double bend(int look, double a, double b)
{
    return fmin(1, fabs(look_at_corner(look, a, b) - 1));
}

/* 1 on the edges of tiles, 0 half a side inside. */
static double value(const Pattern *pattern, const PatternPoint *point)
{
    const Pavement *pavement = pattern->data;
    const Square square = {period_of(pavement), floor(point->p.x), floor(point->p.z)};
    const double u = point->p.x - square.x, v = point->p.z - square.z, a = fabs(u - 0.5), b = fabs(v - 0.5);
    const int along_x[2] = {edge_x(&square, 0, 0), edge_x(&square, 1, 0)}; /* least and greatest x */
    const int along_z[2] = {edge_z(&square, 0, 0), edge_z(&square, 0, 1)};
    const int right = u > 0.5, up = v > 0.5, bends = along_x[0] != along_x[1] && along_z[0] != along_z[1];
    const int i = bends ? along_x[0] : right, j = bends ? along_z[0] : up; /* the corner in question */
    const int concave = !along_x[i] && !along_z[j] && edge_x(&square, i, j ? 1 : -1) && edge_z(&square, i ? 1 : -1, j);
    if (bends && concave && pavement->form < 3)
        return bend(pavement->form, i ? 1 - u : u, j ? 1 - v : v);
    if (along_x[right] && along_z[up])
        return fmin(1, look_at_corner(pavement->exterior, a, b));
    if (along_x[right] || along_z[up])
        return 2 * (along_x[right] ? a : b);
    return concave && i == right && j == up ? fmax(0, 1 - look_at_corner(pavement->interior, 0.5 - a, 0.5 - b)) : 0;
}

const PatternOps pattern_pavement = {.keyword = "pavement",
                                     .arguments = ARGUMENTS_PAVEMENT,
                                     .value = value,
                                     .name = "pavement of triangles or hexagons"};
