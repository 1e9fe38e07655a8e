/* Penrose's tilings, from de Bruijn's pentagrid: five families of parallel lines, of which each crossing of two is a
 * rhomb. ("Algebraic theory of Penrose's non-periodic tilings of the plane", 1981.) */
#include <math.h>

#include "pattern/tiling.h"

enum { FAMILIES = 5 };

/* Normals of the families. */
#define C1 0.30901699437494742
#define S1 0.95105651629515357
#define C2 0.80901699437494742
#define S2 0.58778525229247313
#define GOLDEN 1.6180339887498949
static const Vec2 normals[FAMILIES] = {{1, 0}, {C1, S1}, {-C2, S2}, {-C2, -S2}, {C1, -S1}};

/* Its corners are base, base + a, base + b and base + a + b, and p is at base + s a + t b. */
typedef struct Rhomb {
    int is_thin, index; /* of its base: the sum of the numbers of the strips that it is in; there are two */
    Vec2 base, a, b;
    double s, t;
} Rhomb;

static double cross(Vec2 a, Vec2 b)
{
    return a.u * b.v - a.v * b.u;
}

static double dot(Vec2 a, Vec2 b)
{
    return a.u * b.u + a.v * b.v;
}

static Vec2 plus(Vec2 a, Vec2 b, double factor)
{
    return (Vec2){a.u + factor * b.u, a.v + factor * b.v};
}

/* Line n[0] of family j crosses line n[1] of family k. Returns whether p is in the rhomb of this crossing. */
static int try_crossing(Vec2 p, double shift, int j, int k, const double *n, Rhomb *rhomb)
{
    const Vec2 a = normals[j], b = normals[k];
    const double area = cross(a, b), f = n[0] - shift, g = n[1] - shift;
    const Vec2 crossing = {(f * b.v - g * a.v) / area, (g * a.u - f * b.u) / area};
    Vec2 base = {0, 0};
    double index = 0;
    for (int m = 0; m < FAMILIES; m++) {
        const double strip = m == j ? n[0] : m == k ? n[1] : ceil(dot(crossing, normals[m]) + shift);
        base = plus(base, normals[m], strip);
        index += strip;
    }
    const Vec2 d = plus(p, base, -1);
    const double s = cross(d, b) / area, t = cross(a, d) / area;
    if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1))
        return 0;
    *rhomb = (Rhomb){k - j == 2 || k - j == 3, (int)index, base, a, b, s, t};
    return 1;
}

/* The rhomb, of side 1, with point p. A point and the crossing of its rhomb are less than one strip apart, once p is
 * scaled. Returns whether there is one, as far as numbers tell. */
static int find_rhomb(Vec2 p, double shift, Rhomb *rhomb)
{
    const Vec2 scaled = {p.u / 2.5, p.v / 2.5};
    for (int j = 0; j < FAMILIES; j++)
        for (int k = j + 1; k < FAMILIES; k++)
            for (int i = 0; i < 4; i++) {
                const double n[2] = {floor(dot(scaled, normals[j]) + shift) + (i & 1),
                                     floor(dot(scaled, normals[k]) + shift) + (i >> 1)};
                if (try_crossing(p, shift, j, k, n, rhomb))
                    return 1;
            }
    return 0;
}

double penrose_rhombs(Vec2 p, int *type)
{
    Rhomb rhomb;
    *type = 0;
    if (!find_rhomb(p, -0.2, &rhomb))
        return 0;
    *type = rhomb.is_thin;
    const double s = fmin(rhomb.s, 1 - rhomb.s), t = fmin(rhomb.t, 1 - rhomb.t);
    return fmin(s, t) * fabs(cross(rhomb.a, rhomb.b));
}

/* The distance of p from the line through a and b. */
static double from_line(Vec2 p, Vec2 a, Vec2 b)
{
    const Vec2 d = plus(b, a, -1);
    return fabs(cross(d, plus(p, a, -1))) / hypot(d.u, d.v);
}

/* Rhombs are cut into triangles that are halves of kites and darts. The axis of a kite, where two halves meet, is an
 * edge of rhombs. */
double penrose_kites(Vec2 p, int *type)
{
    Rhomb rhomb;
    *type = 0;
    if (!find_rhomb(p, -0.4, &rhomb))
        return 0;
    const Vec2 side = plus(rhomb.base, rhomb.s > rhomb.t ? rhomb.a : rhomb.b, 1);
    const Vec2 end = plus(plus(rhomb.base, rhomb.a, 1), rhomb.b, 1);
    const int base_is_inner = rhomb.index == 0;
    const Vec2 inner = base_is_inner ? rhomb.base : end, outer = base_is_inner ? end : rhomb.base;
    if (rhomb.is_thin)
        return fmin(from_line(p, inner, outer), from_line(p, side, outer));
    const Vec2 along = plus(outer, inner, -1), middle = plus(inner, along, 1 / GOLDEN);
    const Vec2 cut = plus(side, middle, -1);
    *type = (cross(cut, plus(p, middle, -1)) > 0) != (cross(cut, plus(inner, middle, -1)) > 0);
    return fmin(from_line(p, side, middle), *type ? from_line(p, side, outer) : from_line(p, inner, middle));
}
