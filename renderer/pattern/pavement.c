/* pavement: how far a point is from the edges of its tile, and how these look at corners. */
#include "pattern/pavement.h"
#include "pattern/pattern.h"

/* ---- squares ---- */

/* A square, and which of its edges are edges of tiles. */
typedef struct Square {
    const Pavement *pavement;
    double x, z;    /* its corner of least x and z */
    int at_x[2];    /* 1: the edge of least x, of greatest x, is one */
    int at_z[2];    /* the same of z */
} Square;

static int edge_x(const Square *square, int dx, int dz)
{
    return pavement_edges(square->pavement, square->x + dx, square->z + dz) & 1;
}

static int edge_z(const Square *square, int dx, int dz)
{
    return pavement_edges(square->pavement, square->x + dx, square->z + dz) >> 1;
}

static Square square_at(const Pavement *pavement, Vec3 p)
{
    Square square = {.pavement = pavement, .x = floor(p.x), .z = floor(p.z)};
    square.at_x[0] = edge_x(&square, 0, 0), square.at_x[1] = edge_x(&square, 1, 0);
    square.at_z[0] = edge_z(&square, 0, 0), square.at_z[1] = edge_z(&square, 0, 1);
    return square;
}

/* Whether a corner of the square is one where the tile turns inwards: the squares beside it have edges there, it has
 * none itself. right, up: 0 or 1, of least x or greatest, and so on. */
static int is_concave(const Square *square, int right, int up)
{
    return !square->at_x[right] && !square->at_z[up] && edge_x(square, right, up ? 1 : -1) &&
           edge_z(square, right ? 1 : -1, up);
}

/* Whether it has two edges, which are neighbours. */
static int has_bend(const Square *square)
{
    return square->at_x[0] != square->at_x[1] && square->at_z[0] != square->at_z[1];
}

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
static double square_value(const Pavement *pavement, Vec3 p)
{
    const Square square = square_at(pavement, p);
    const double u = p.x - square.x, v = p.z - square.z;
    const double from_middle_x = fabs(u - 0.5), from_middle_z = fabs(v - 0.5);
    const int right = u > 0.5, up = v > 0.5; /* the nearest corner, */
    const int is_edge_x = square.at_x[right], is_edge_z = square.at_z[up];
    const int inner_right = square.at_x[0], inner_up = square.at_z[0]; /* of a bend: that without edges */

    if (has_bend(&square) && pavement->form < 3 && is_concave(&square, inner_right, inner_up))
        return bend(pavement->form, inner_right ? 1 - u : u, inner_up ? 1 - v : v);
    if (is_edge_x && is_edge_z)
        return fmin(1, look_at_corner(pavement->exterior, from_middle_x, from_middle_z));
    if (is_edge_x || is_edge_z)
        return 2 * (is_edge_x ? from_middle_x : from_middle_z);
    return is_concave(&square, right, up)
               ? fmax(0, 1 - look_at_corner(pavement->interior, 0.5 - from_middle_x, 0.5 - from_middle_z))
               : 0;
}

/* ---- triangles, and hexagons of six triangles each ---- */

#define SQRT3 1.7320508075688772

/* Steps from a corner to its neighbours, against the clock, where x points right and z up. */
static const signed char steps[6][2] = {{1, 0}, {0, 1}, {-1, 1}, {-1, 0}, {0, -1}, {1, -1}};

typedef struct Corner {
    double i, j;
    int direction; /* along the triangle's edge on its right; the other edge is the next direction */
    double share;  /* barycentric */
} Corner;

static int has_edge(const Pavement *pavement, const Corner *corner, int direction)
{
    const int d = (direction + 6) % 6, back = d > 2;
    return pavement_edges(pavement, corner->i + back * steps[d][0], corner->j + back * steps[d][1]) >> d % 3 & 1;
}

/* The distance in the triangle's plane between two points, given the differences of two barycentric numbers. */
static double distance(double a, double b)
{
    return sqrt(a * a + a * b + b * b);
}

/* A tile's end, of one triangle: a is the corner's number, the others are b and c. */
static double end(int look, double a, double b, double c)
{
    if (look == 1)
        return 3 * a - 1;
    return look == 2 && a >= b && a >= c ? 2 * SQRT3 * distance(b - 1.0 / 3, c - 1.0 / 3) : 0;
}

/* Where a tile turns round a corner of two triangles. The edge leads from there to the corner of b; c is opposite. */
static double turn(int look, double a, double b)
{
    if (look == 1)
        return 4 * a + 2 * b - 2;
    return look == 2 && a >= b ? 2 * SQRT3 * distance(a, b) - 2 : 0;
}

/* A corner that is reached by edges of other triangles only. */
static double inner(int look, double b, double c)
{
    return 1 - 3 * (look == 0 ? b + c : look == 1 ? fmax(b, c) + 0.5 * fmin(b, c) : distance(b, c));
}

/* 1 on the edges of tiles, 0 in the middle of a triangle of three edges. */
static double triangle_value(const Pavement *pavement, Vec3 p)
{
    const double row = p.z / (SQRT3 / 2), column = p.x - row / 2;
    const double i = floor(column), j = floor(row), g = column - i, h = row - j;
    const Corner upward[3] = {{i, j, 0, 1 - g - h}, {i + 1, j, 2, g}, {i, j + 1, 4, h}};
    const Corner downward[3] = {{i + 1, j + 1, 3, g + h - 1}, {i, j + 1, 5, 1 - g}, {i + 1, j, 1, 1 - h}};
    const Corner *corners = g + h < 1 ? upward : downward;
    double most = 0;
    for (int k = 0; k < 3; k++) {
        const Corner *corner = corners + k;
        const int right = has_edge(pavement, corner, corner->direction);
        const int left = has_edge(pavement, corner, corner->direction + 1);
        const double a = corner->share, b = corners[(k + 1) % 3].share, c = corners[(k + 2) % 3].share;
        if (right)
            most = fmax(most, 1 - 3 * c);
        if (right && left)
            most = fmax(most, end(pavement->exterior, a, b, c));
        else if (right && has_edge(pavement, corner, corner->direction + 2))
            most = fmax(most, turn(pavement->form, a, b));
        else if (left && has_edge(pavement, corner, corner->direction - 1))
            most = fmax(most, turn(pavement->form, a, c));
        else if (!right && !left) {
            int edges = 0;
            for (int d = 0; d < 6; d++)
                edges += has_edge(pavement, corner, d);
            most = fmax(most, edges ? inner(pavement->interior, b, c) : 0);
        }
    }
    return fmin(1, most);
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const Pavement *pavement = pattern->data;
    return pavement->sides == 4 ? square_value(pavement, point->p) : triangle_value(pavement, point->p);
}

const PatternOps pattern_pavement = {.keyword = "pavement", .arguments = ARGUMENTS_PAVEMENT, .value = value};
