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
    int is_thin, index; /* of its base: the sum of the numbers of the strips that it is in */
    Vec2 base, a, b;
    double s, t;
    int sides[2]; /* families of a and b */
    double strips[FAMILIES];
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
    double index = 0, strips[FAMILIES];
    for (int m = 0; m < FAMILIES; m++) {
        strips[m] = m == j ? n[0] : m == k ? n[1] : ceil(dot(crossing, normals[m]) + shift);
        base = plus(base, normals[m], strips[m]);
        index += strips[m];
    }
    const Vec2 d = plus(p, base, -1);
    const double s = cross(d, b) / area, t = cross(a, d) / area;
    if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1))
        return 0;
    *rhomb = (Rhomb){k - j == 2 || k - j == 3, (int)index, base, a, b, s, t, {j, k}, {0}};
    for (int m = 0; m < FAMILIES; m++)
        rhomb->strips[m] = strips[m];
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

/* Pentagons, stars, boats and rhombs of side 1: each has its middle at a corner of the rhombs with shift -0.4, of side
 * ROW. Corners have indices from -1 to 2. Pentagons are at 0 and 1, the others at -1 and 2. The type of the tile
 * follows from the number of the corner's neighbours inwards: from -1 and 1 those at 0, from 0 and 2 those at 1. */
#define INRADIUS 0.68819096023558677 /* of the pentagon */
#define ROW (2 * INRADIUS)           /* from a pentagon's middle to the next one's */
#define STAR 0.42532540417601994     /* from a star's middle to the lines of its sides */
#define FLAT 0.16245984811645314     /* from a boat's, which is that of its star, to its straight side */
typedef struct Corner {
    int index;
    Vec2 p, image; /* image: of the strips, where directions are doubled; it tells whether there is such a corner */
} Corner;

/* The images of all corners of an index fill a pentagon. */
static int is_corner(Vec2 image, int index)
{
    const double radius = index == 0 || index == 1 ? GOLDEN : 1, sign = index & 1 ? -1 : 1;
    for (int k = 0; k < FAMILIES; k++)
        if (sign * dot(image, normals[k]) > radius * C2)
            return 0;
    return 1;
}

/* Star, boat or rhomb, by which of a corner's neighbours there are; d is the point from its middle, so turned that the
 * neighbours are along the normals. Opposite to each normal, a star has a tip, between the lines of the two normals
 * beside it, if it has the neighbours on either side of the tip. A boat has a straight side where it has no
 * neighbour. */
static double star_inset(Vec2 d, const int *is_there, int count)
{
    double line[FAMILIES], least = HUGE_VAL;
    int nearest = 0;
    for (int k = 0; k < FAMILIES; k++) {
        line[k] = STAR + dot(d, normals[k]);
        if (line[k] < line[nearest])
            nearest = k;
    }
    for (int k = 0; k < FAMILIES; k++) {
        const double one = line[(k + 1) % FAMILIES], other = line[(k + 4) % FAMILIES];
        const int is_tip = is_there[(k + 2) % FAMILIES] && is_there[(k + 3) % FAMILIES];
        if (is_tip && count == 3)
            least = fmin(fmin(one, S2 - one), fmin(other, S2 - other));
        else if (is_tip && k == nearest)
            least = fmin(least, fmin(one, other));
        if (!is_there[k] && count == 4) /* and here is the middle of its three tips */
            least =
                fmin(fmin(least, FLAT - dot(d, normals[k])), fmin(line[(k + 2) % FAMILIES], line[(k + 3) % FAMILIES]));
    }
    return least;
}

/* How far p is within the tile of a corner; below 0 outside. */
static double tile_inset(Vec2 p, const Corner *corner, int *type)
{
    const int inwards = corner->index <= 0 ? 1 : -1;
    const Vec2 from = plus(p, corner->p, -1), d = {inwards * from.u, inwards * from.v};
    int is_there[FAMILIES], count = 0;
    double inset = HUGE_VAL;
    for (int k = 0; k < FAMILIES; k++) {
        const Vec2 image = plus(corner->image, normals[2 * k % FAMILIES], inwards);
        is_there[k] = is_corner(image, corner->index + inwards);
        count += is_there[k];
        inset = fmin(inset, INRADIUS - dot(d, normals[k]));
    }
    if (corner->index == 0 || corner->index == 1) {
        *type = count == 2 ? 1 : count == 3 ? 2 : 0;
        return inset;
    }
    *type = 8 - (count > 3 ? count : 3); /* two missing at most, but where numbers do not tell */
    return star_inset(d, is_there, count);
}

double penrose_pentagons(Vec2 p, int *type)
{
    Rhomb rhomb;
    *type = 0;
    if (!find_rhomb((Vec2){p.u / ROW, p.v / ROW}, -0.4, &rhomb))
        return 0;
    double most = -HUGE_VAL;
    for (int i = 0; i < 4; i++) {
        const double step[2] = {i & 1, i >> 1};
        Corner corner = {rhomb.index + (i & 1) + (i >> 1), {0, 0}, {0, 0}};
        for (int k = 0; k < FAMILIES; k++) {
            const double strip = rhomb.strips[k] + (k == rhomb.sides[0]) * step[0] + (k == rhomb.sides[1]) * step[1];
            corner.p = plus(corner.p, normals[k], ROW * strip);
            corner.image = plus(corner.image, normals[2 * k % FAMILIES], strip);
        }
        int its_type;
        const double inset = tile_inset(p, &corner, &its_type);
        if (inset > most)
            most = inset, *type = its_type;
    }
    return most;
}
