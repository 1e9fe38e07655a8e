/* tiling: which tile a point is in, and how far from its edges. */
#include "pattern/tiling.h"
#include "pattern/pattern.h"

static Vec2 corner_at(const Tiling *tiling, const signed char *n)
{
    return (Vec2){(n[0] + n[1] * tiling->root) / 2, (n[2] + n[3] * tiling->root) / 2};
}

/* The least distance of a point from the lines through the edges; below 0 outside. */
static double inset(const Tiling *tiling, const Vec2 *corners, int n, Vec2 p)
{
    double least = HUGE_VAL;
    for (int i = 0; i < n; i++) {
        const Vec2 a = corners[i], b = corners[i + 1 < n ? i + 1 : 0];
        const double x = b.u - a.u, z = b.v - a.v;
        /* Those along z, and the lowest one. */
        const int is_straight = n == 12 && (fabs(x) < 1e-9 || (fabs(z) < 1e-9 && x > 0));
        const double factor = is_straight && tiling->straight > 0 ? tiling->straight : 1;
        least = fmin(least, factor * (x * (p.v - a.v) - z * (p.u - a.u)) / hypot(x, z));
    }
    return least;
}

/* POV-Ray's slopes, measured. */
static double penrose_value(int number, const PatternPoint *point)
{
    const Vec2 p = {point->p.x, point->p.z};
    int type, types = 2;
    double slope = 3.4300886, inset;
    if (number == TILING_PENTAGONS) {
        inset = penrose_pentagons(p, &type);
        types = 6;
    } else if (number == TILING_KITES) {
        inset = penrose_kites(p, &type);
        slope = 4.46;
    } else {
        inset = penrose_rhombs(p, &type);
    }
    return (type + fmax(0, 1 - slope * inset)) / types;
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    if (pattern->number > TILINGS)
        return penrose_value((int)pattern->number, point);
    const Tiling *tiling = &tilings[(int)pattern->number - 1];
    const Vec2 a = corner_at(tiling, tiling->lattice[0]), b = corner_at(tiling, tiling->lattice[1]);
    const double area = a.u * b.v - a.v * b.u;
    const signed char *next = tiling->tiles;
    double most = -HUGE_VAL;
    int type = 0;
    for (int tile = 0; tile < tiling->ntiles; tile++) {
        Vec2 corners[TILING_SIDES], p = {point->p.x, point->p.z};
        const int its_type = *next++, n = *next++;
        for (int i = 0; i < n; i++, next += 4) {
            corners[i] = corner_at(tiling, next);
            p.u -= corners[i].u / n, p.v -= corners[i].v / n;
        }
        /* No tile reaches farther from its middle than one step of the lattice: of its copies, four may have it. */
        const double s = floor((p.u * b.v - p.v * b.u) / area), t = floor((a.u * p.v - a.v * p.u) / area);
        for (int k = 0; k < 4; k++) {
            const double i = s + (k & 1), j = t + (k >> 1);
            const Vec2 q = {point->p.x - i * a.u - j * b.u, point->p.z - i * a.v - j * b.v};
            const double distance = inset(tiling, corners, n, q);
            if (distance > most)
                most = distance, type = its_type;
        }
    }
    return (type + fmax(0, 1 - tiling->slope * most)) / tiling->types;
}

const PatternOps pattern_tiling = {.keyword = "tiling", .arguments = ARGUMENTS_TILING, .value = value};
