/* Which side of a model is its floor. Things stand on the floor and few hang from the ceiling, while walls that face
 * each other both have something before them. */
#include <math.h>

#include "import/sense/sense.h"
#include "import/space/space.h"

enum { SIDE = 40, BINS = 50 };

typedef struct Relief {
    double open;      /* share of the side where nothing is */
    double flat;      /* share of it that is bare */
    double raised[2]; /* where something level stands on it whose back, or front, is seen */
} Relief;

/* Where the floor, ceiling or wall itself is: where most rays end, as one of BINS. */
static int find_plane(const int *counts)
{
    int best = 0;
    for (int i = 1; i < BINS; i++)
        if (counts[i] >= counts[best])
            best = i;
    return best;
}

static Relief relief_of(const Space *space, int axis, int sign)
{
    double low[3], high[3], direction[3] = {0, 0, 0};
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int counts[2][BINS] = {{0}}, sums[BINS], hits = 0;
    space_bounds(space, low, high);
    const double half = (high[axis] - low[axis]) / 2;
    direction[axis] = sign;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double from[3];
        SpaceHit hit;
        from[u] = low[u] + (high[u] - low[u]) * (i % SIDE + 0.487) / SIDE;
        from[v] = low[v] + (high[v] - low[v]) * (i / SIDE + 0.513) / SIDE;
        from[axis] = low[axis] + half;
        if (!space_ray(space, from, direction, 0, INFINITY, &hit))
            continue;
        hits++;
        if (fabs(hit.normal[axis]) > 0.7)
            counts[hit.is_front][(int)fmin(hit.t / half * BINS, BINS - 1)]++;
    }
    for (int i = 0; i < BINS; i++)
        sums[i] = counts[0][i] + counts[1][i];
    const int plane = find_plane(sums);
    const double all = SIDE * SIDE;
    Relief relief = {.open = 1 - hits / all};
    for (int i = 0; i < BINS; i++) {
        relief.flat += i >= plane - 1 ? sums[i] / all : 0;
        for (int front = 0; front < 2; front++)
            relief.raised[front] += i < plane - 3 ? counts[front][i] / all : 0;
    }
    return relief;
}

/* How differently much stands on two sides that face each other: 0 to 1. */
static double difference(double a, double b)
{
    return a + b > 0.005 ? fabs(a - b) / (a + b) : 0;
}

/* A box without a lid stands on the other side. */
static int is_open_above(const Space *space)
{
    double most = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int sign = -1; sign <= 1; sign += 2)
            most = fmax(most, axis == 1 && sign == 1 ? 0 : relief_of(space, axis, sign).open);
    return most < 0.3 && relief_of(space, 1, 1).open > 0.8;
}

/* Here y is up as yet, and z away from the viewer: the model's -z is +z. The floor and the ceiling must differ clearly
 * more than walls do. */
int sense_is_z_up(const Space *space)
{
    const Relief floor = relief_of(space, 2, 1), ceiling = relief_of(space, 2, -1);
    const int is_front = floor.raised[1] >= floor.raised[0]; /* from inside of things one sees the other sides */
    const double stands = floor.raised[is_front], hangs = ceiling.raised[is_front], most = difference(stands, hangs);
    if (floor.flat < 0.35 || stands < 0.1 || stands < hangs || most < 0.6 || is_open_above(space))
        return 0;
    for (int axis = 0; axis < 2; axis++) {
        const Relief a = relief_of(space, axis, -1), b = relief_of(space, axis, 1);
        if (difference(a.raised[is_front], b.raised[is_front]) > fmin(0.6, most - 0.15))
            return 0;
    }
    return 1;
}
