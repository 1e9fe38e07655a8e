/* Fields of the plane y = 0, of side 1: hexagon, square, triangular. */
#include "pattern/pattern.h"

#define SQRT3 1.7320508075688772

static int modulo(double i, int n)
{
    const int rest = (int)fmod(i, n);

    return rest < 0 ? rest + n : rest;
}

/* Squares in columns and rows: two colours by two. */
static double square(const Pattern *pattern, const PatternPoint *point)
{
    const int odd_x = modulo(floor(point->p.x), 2), odd_z = modulo(floor(point->p.z), 2);

    (void)pattern;
    return odd_x ? 3 - odd_z : odd_z;
}

/* The hexagon whose centre is nearest: that of column q and row r is at (3/2 q, √3 (r + q/2)). */
static double hexagon(const Pattern *pattern, const PatternPoint *point)
{
    const double q = point->p.x / 1.5, r = point->p.z / SQRT3 - q / 2, s = -q - r;
    double a = floor(q + 0.5), b = floor(r + 0.5);
    const double c = floor(s + 0.5), da = fabs(a - q), db = fabs(b - r), dc = fabs(c - s);

    (void)pattern;
    if (da > db && da > dc)
        a = -b - c;
    else if (db > dc)
        b = -a - c;
    return modulo(2 * a + b, 3);
}

/* Triangles in rows; those that point up have the even colours. */
static double triangular(const Pattern *pattern, const PatternPoint *point)
{
    static const int up[3] = {0, 4, 2}, down[3] = {1, 3, 5};
    const double z = point->p.z / (SQRT3 / 2), row = floor(z), height = z - row;
    const double x = point->p.x - row / 2 - height / 2, column = floor(x);

    (void)pattern;
    return x - column + height < 1 ? up[modulo(column - row, 3)] : down[modulo(column + 1 - row, 3)];
}

const PatternOps pattern_square = {.keyword = "square", .colors = 4, .value = square};
const PatternOps pattern_hexagon = {
    .keyword = "hexagon", .colors = 3, .map = &pattern_blue_green_red, .value = hexagon};
const PatternOps pattern_triangular = {.keyword = "triangular", .colors = 6, .value = triangular};
