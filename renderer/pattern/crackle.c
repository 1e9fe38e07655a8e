/* crackle: by the distances to the nearest of points, of which each unit cube has one at random. */
#include "pattern/pattern.h"

#define CUBE_EPSILON 1e-10

enum { NEAREST = 3 };

/* The search for the points nearest to one. Distances are sums of powers of what coordinates differ by. */
typedef struct Search {
    const struct Crackle *crackle;
    Vec3 p;
    double offset;            /* its power */
    double gap[3][5];         /* powers of how far cubes that lie -2 to 2 away are from the point, by axis */
    double distance[NEAREST]; /* the least first */
    const double *bound;      /* of distances that are needed */
    Vec3 point;               /* the nearest one */
} Search;

static double power_of(const struct Crackle *crackle, double by)
{
    const double metric = crackle->metric;
    return metric == 2 ? by * by : metric == 1 ? fabs(by) : pow(fabs(by), metric);
}

static double root_of(const struct Crackle *crackle, double power)
{
    const double metric = crackle->metric;
    return metric == 2 ? sqrt(power) : metric == 1 ? power : pow(power, 1 / metric);
}

static void consider(Search *search, Vec3 cube)
{
    const struct Crackle *crackle = search->crackle;
    const Vec3 point = vec_add(cube, noise_cell(cube)), by = vec_sub(point, search->p);
    const double distance =
        power_of(crackle, by.x) + power_of(crackle, by.y) + power_of(crackle, by.z) + search->offset;
    double *d = search->distance;
    if (distance < d[0]) {
        d[2] = d[1], d[1] = d[0], d[0] = distance;
        search->point = point;
    } else if (distance < d[1])
        d[2] = d[1], d[1] = distance;
    else if (distance < d[2])
        d[2] = distance;
}

/* The cubes about the point's own: those that share a side with it, an edge, a corner. */
static const signed char around[26][3] = {
    {-1, 0, 0},   {0, -1, 0},  {0, 0, -1},  {0, 0, 1},  {0, 1, 0},   {1, 0, 0},  {-1, -1, 0}, {-1, 0, -1}, {-1, 0, 1},
    {-1, 1, 0},   {0, -1, -1}, {0, -1, 1},  {0, 1, -1}, {0, 1, 1},   {1, -1, 0}, {1, 0, -1},  {1, 0, 1},   {1, 1, 0},
    {-1, -1, -1}, {-1, -1, 1}, {-1, 1, -1}, {-1, 1, 1}, {1, -1, -1}, {1, -1, 1}, {1, 1, -1},  {1, 1, 1}};

static void search_cube(Search *search, Vec3 own, int x, int y, int z)
{
    const double gap = search->gap[0][x + 2] + search->gap[1][y + 2] + search->gap[2][z + 2];
    if (gap + search->offset <= *search->bound)
        consider(search, vec_add(own, vec3(x, y, z)));
}

/* The point's own cube, the 26 about it, and nine beyond each side of these, as in POV-Ray; but those that can have
 * nothing near enough. */
static void find_nearest(Search *search)
{
    const Vec3 p = search->p;
    const Vec3 own = vec3(floor(p.x + CUBE_EPSILON), floor(p.y + CUBE_EPSILON), floor(p.z + CUBE_EPSILON));
    const double at[3] = {p.x - own.x, p.y - own.y, p.z - own.z};
    for (int axis = 0; axis < 3 && search->crackle->metric > 0; axis++)
        for (int away = 1; away <= 2; away++) {
            search->gap[axis][2 + away] = power_of(search->crackle, away - at[axis]);
            search->gap[axis][2 - away] = power_of(search->crackle, at[axis] + away - 1);
        }
    consider(search, own);
    for (int i = 0; i < 26; i++)
        search_cube(search, own, around[i][0], around[i][1], around[i][2]);
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2, away = side % 2 ? 2 : -2;
        if (search->gap[axis][away + 2] + search->offset > *search->bound)
            continue;
        for (int i = 0; i < 9; i++) {
            const int u = i / 3 - 1, v = i % 3 - 1;
            search_cube(search, own, axis == 0 ? away : u, axis == 1 ? away : axis == 0 ? u : v, axis == 2 ? away : v);
        }
    }
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const struct Crackle *crackle = &pattern->crackle;
    Search s = {.crackle = crackle, .p = point->p, .distance = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, .point = point->p};
    const int needed = crackle->is_solid ? 0 : crackle->form.z != 0 ? 2 : crackle->form.y != 0 ? 1 : 0;
    s.offset = crackle->offset != 0 ? power_of(crackle, crackle->offset) : 0;
    s.bound = &s.distance[needed];
    find_nearest(&s);
    if (crackle->is_solid)
        return pattern_noise(pattern, s.point);
    double sum = crackle->form.x * root_of(crackle, s.distance[0]);
    if (needed > 0)
        sum += crackle->form.y * root_of(crackle, s.distance[1]);
    if (needed > 1)
        sum += crackle->form.z * root_of(crackle, s.distance[2]);
    return fmin(fmax(sum, 0), 1);
}

const PatternOps pattern_crackle = {.keyword = "crackle", .value = value};
