/* Rooms: a floor plan by vertical rays, and of its cells the region that is enclosed.
 *
 * Each column of the plan is cut into gaps between surfaces. Of all heights at which gaps begin, the floor is that with
 * most enclosed free space above; its cells that one can walk between are the room. Small rooms in large models get a
 * second plan, of their own. */

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "import/space/room.h"
#include "import/space/space.h"

#define PI 3.14159265358979323846

enum { MOST_SIDE = 72, MOST_GAPS = 8, MOST_SURFACES = 64, AZIMUTHS = 16, LEVELS = 128 };

/* Free space above a surface that is level. */
typedef struct Gap {
    float floor, reach, enclosed;
    float front; /* share of what is around whose front is seen, the floor too: little in solids */
    unsigned char is_covered;
} Gap;

typedef struct Gaps {
    Gap list[MOST_GAPS];
    int count;
} Gaps;

void room_point(const Room *room, int cell, double height, double point[3])
{
    /* off the middle by a little, so that rays do not run along edges of what is modelled on a grid */
    point[0] = room->low[0] + (cell % room->nx + 0.4873) * room->cell;
    point[1] = (double)room->cells[cell].floor + height;
    point[2] = room->low[2] + (cell / room->nx + 0.5131) * room->cell;
}

int room_cell_at(const Room *room, double x, double z)
{
    const double i = floor((x - room->low[0]) / room->cell), j = floor((z - room->low[2]) / room->cell);
    return i >= 0 && i < room->nx && j >= 0 && j < room->nz ? (int)j * room->nx + (int)i : -1;
}

/* The share of directions around a point in which something is, and its front is seen; the distance to the nearest. */
static double look_around(const Space *space, const double from[3], double *nearest, double *front)
{
    int hits = 0, fronts = 0;
    for (int i = 0; i < AZIMUTHS; i++) {
        const double a = 2 * PI * (i + 0.31) / AZIMUTHS, direction[3] = {cos(a), 0, sin(a)};
        SpaceHit hit;
        if (!space_ray(space, from, direction, 0, INFINITY, &hit))
            continue;
        hits++, fronts += hit.is_front;
        *nearest = fmin(*nearest, hit.t);
    }
    *front = (double)fronts / AZIMUTHS;
    return (double)hits / AZIMUTHS;
}

/* ---- gaps ---- */

static double least_reach(const Room *room)
{
    return room->metre > 0 ? fmin(1.6 * room->metre, 0.9 * (room->high[1] - room->low[1]))
                           : 0.15 * (room->high[1] - room->low[1]);
}

/* At which height in a gap one looks around: not right above the floor of a hall, not right below a ceiling. */
static double height_in(double metre, double reach)
{
    return fmin(fmax(metre > 0 ? 1.5 * metre : 0.45 * reach, 0.2 * reach), 0.62 * reach);
}

static void find_gaps(const Room *room, int cell, Gaps *gaps)
{
    const double tall = room->high[1] - room->low[1], down[3] = {0, -1, 0};
    double from[3], t = 0, ceiling = INFINITY;
    room_point(room, cell, 0, from);
    from[1] = room->high[1] + 0.01 * tall;
    gaps->count = 0;
    for (int i = 0; i < MOST_SURFACES && gaps->count < MOST_GAPS; i++) {
        SpaceHit hit;
        if (!space_ray(room->space, from, down, t, INFINITY, &hit))
            return;
        const double y = hit.point[1], reach = fmin(ceiling, room->high[1]) - y;
        if (fabs(hit.normal[1]) > 0.7 && reach >= least_reach(room))
            gaps->list[gaps->count++] =
                (Gap){.floor = (float)y, .reach = (float)reach, .front = hit.is_front, .is_covered = isfinite(ceiling)};
        ceiling = y;
        t = hit.t + 1e-5 * tall;
    }
}

static void enclose(const Room *room, int cell, Gap *gap)
{
    double point[3], nearest = INFINITY, front;
    room_point(room, cell, 0, point);
    point[1] = (double)gap->floor + height_in(room->metre, (double)gap->reach);
    gap->enclosed = (float)look_around(room->space, point, &nearest, &front);
    gap->front = (float)(0.5 * (double)gap->front + 0.5 * front);
}

/* ---- the floor ---- */

static int level_of(const Room *room, double y)
{
    const double tall = room->high[1] - room->low[1];
    return (int)fmin(fmax((y - room->low[1]) / (tall > 0 ? tall : 1) * LEVELS, 0), LEVELS - 1);
}

/* The level with most free space that is enclosed; also where nothing is enclosed, the one with most. */
static int choose_level(const Room *room, const Gaps *gaps)
{
    double sums[LEVELS + 1] = {0}, best = 0;
    int level = -1;
    for (int i = 0; i < room->nx * room->nz; i++)
        for (int k = 0; k < gaps[i].count; k++) {
            const Gap *gap = &gaps[i].list[k];
            const double e = (double)gap->enclosed, front = 0.1 + 0.9 * (double)gap->front;
            sums[level_of(room, (double)gap->floor)] +=
                (double)gap->reach * front * (e > 0.6 ? e * e : 0.02 * e + 1e-3);
        }
    for (int i = 0; i < LEVELS; i++)
        if (sums[i] + sums[i + 1] > best) {
            best = sums[i] + sums[i + 1];
            level = i;
        }
    return level;
}

/* Keep of each column the gap above that floor. */
static void take_level(Room *room, const Gaps *gaps, int level)
{
    double sum = 0, weight = 0;
    for (int i = 0; i < room->nx * room->nz; i++) {
        RoomCell *cell = &room->cells[i];
        for (int k = 0; k < gaps[i].count && !cell->is_floor; k++) {
            const Gap *gap = &gaps[i].list[k];
            const int of = level_of(room, (double)gap->floor);
            if (of != level && of != level + 1)
                continue;
            cell->is_floor = 1;
            cell->floor = gap->floor, cell->reach = gap->reach, cell->enclosed = gap->enclosed;
            cell->is_covered = gap->is_covered;
            sum += (double)gap->floor, weight++;
        }
    }
    room->floor = weight > 0 ? sum / weight : 0;
    for (int i = 0; i < room->nx * room->nz; i++)
        if (!room->cells[i].is_floor)
            room->cells[i].floor = (float)room->floor;
}

static int compare_floats(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Up to where there are walls, in a room without a ceiling; without walls, up to the top. */
static double wall_height(const Room *room)
{
    enum { STEPS = 24 };
    const double tall = room->high[1] - room->floor;
    double height = 0;
    for (int step = 1; step < STEPS; step++) {
        double sum = 0, count = 0, nearest = INFINITY, front, point[3];
        for (int i = 0; i < room->nx * room->nz; i += 7) {
            if (!room->cells[i].is_floor || (double)room->cells[i].enclosed < 0.5)
                continue;
            room_point(room, i, tall * step / STEPS, point);
            sum += look_around(room->space, point, &nearest, &front), count++;
        }
        if (!(count > 0) || sum / count < 0.5)
            break;
        height = tall * (step + 0.5) / STEPS;
    }
    return height > 0 ? fmin(height, tall) : fmax(tall, 2.6 * room->metre);
}

/* Where most of the free space ends below a ceiling, the median of its heights by volume; else that of the walls. */
static int find_height(Room *room, RetexError *err)
{
    const int count = room->nx * room->nz;
    float *reaches = malloc((size_t)count * sizeof *reaches);
    double volume = 0, all = 0, below = 0;
    int covered = 0;
    if (!reaches)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (int i = 0; i < count; i++) {
        const RoomCell *cell = &room->cells[i];
        if (!cell->is_floor || (double)cell->enclosed < 0.6)
            continue;
        all += (double)cell->reach;
        if (!cell->is_covered)
            continue;
        reaches[covered++] = cell->reach;
        volume += (double)cell->reach;
    }
    if (2 * volume > all) {
        int middle = 0;
        qsort(reaches, (size_t)covered, sizeof *reaches, compare_floats);
        while (middle + 1 < covered && 2 * (below + (double)reaches[middle]) < volume)
            below += (double)reaches[middle++];
        room->height = (double)reaches[middle];
    } else
        room->height = wall_height(room);
    free(reaches);
    return RETEX_OK;
}

/* ---- the region ---- */

int room_is_enclosed(const RoomCell *cell)
{
    return cell->is_floor && (double)cell->enclosed > (cell->is_covered ? 0.5 : 0.6);
}

static int is_free_between(const Room *room, int a, int b)
{
    double from[3], to[3];
    SpaceHit hit;
    room_point(room, a, room->eye, from);
    room_point(room, b, room->eye, to);
    for (int k = 0; k < 3; k++)
        to[k] -= from[k];
    return !space_ray(room->space, from, to, 0, 1, &hit);
}

/* Spread over cells that one can walk to. Returns the sum of what they are enclosed. */
static double flood(const Room *room, int from, int number, int *regions, int *stack)
{
    double sum = 0;
    int open = 0;
    stack[open++] = from;
    regions[from] = number;
    while (open) {
        const int at = stack[--open], x = at % room->nx, z = at / room->nx;
        const int beside[4] = {x > 0 ? at - 1 : -1, x + 1 < room->nx ? at + 1 : -1, z > 0 ? at - room->nx : -1,
                               z + 1 < room->nz ? at + room->nx : -1};
        sum += (double)room->cells[at].enclosed;
        for (int k = 0; k < 4; k++) {
            const int to = beside[k];
            if (to < 0 || regions[to] >= 0 || !room_is_enclosed(&room->cells[to]) || !is_free_between(room, at, to))
                continue;
            regions[to] = number;
            stack[open++] = to;
        }
    }
    return sum;
}

static int find_region(Room *room, RetexError *err)
{
    const int count = room->nx * room->nz;
    int *regions = malloc(2 * (size_t)count * sizeof *regions), best = -1, number = 0;
    double most = 0;
    if (!regions)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    for (int i = 0; i < count; i++)
        regions[i] = -1;
    for (int i = 0; i < count; i++)
        if (regions[i] < 0 && room_is_enclosed(&room->cells[i])) {
            const double sum = flood(room, i, number, regions, regions + count);
            if (sum > most)
                most = sum, best = number;
            number++;
        }
    room->ninside = 0;
    for (int i = 0; i < count; i++) {
        room->cells[i].is_inside = best < 0 ? room->cells[i].is_floor : regions[i] == best;
        room->ninside += room->cells[i].is_inside;
    }
    free(regions);
    return RETEX_OK;
}

/* ---- cells in detail ---- */

/* Seen from below the ceiling, what stands there. */
static double top_of(const Room *room, int cell)
{
    const double down[3] = {0, -1, 0};
    double from[3];
    SpaceHit hit;
    room_point(room, cell, 0, from);
    from[1] = room->floor + 0.85 * room->height;
    return space_ray(room->space, from, down, 0, INFINITY, &hit) ? hit.point[1] : -INFINITY;
}

static void measure_cells(Room *room)
{
    for (int i = 0; i < room->nx * room->nz; i++) {
        RoomCell *cell = &room->cells[i];
        double point[3], nearest = INFINITY, front;
        cell->is_floor &= (double)cell->reach > 1.05 * room->eye; /* not below a table */
        if (!cell->is_floor)
            continue;
        room_point(room, i, 0.45 * room->eye, point);
        look_around(room->space, point, &nearest, &front);
        room_point(room, i, room->eye, point);
        cell->enclosed = (float)look_around(room->space, point, &nearest, &front);
        cell->clearance = (float)nearest;
    }
}

/* The n-th of equally spread directions. */
static void spread(int n, int count, double direction[3])
{
    const double y = 1 - (2 * n + 1.0) / count, r = sqrt(1 - y * y), a = n * PI * (3 - sqrt(5));
    direction[0] = r * cos(a), direction[1] = y, direction[2] = r * sin(a);
}

/* Whether something stands in a cell that one can reach over from a place beside it. */
static int is_furnished(const Room *room, int cell)
{
    const int x = cell % room->nx, z = cell / room->nx;
    const int beside[4] = {x > 0 ? cell - 1 : -1, x + 1 < room->nx ? cell + 1 : -1, z > 0 ? cell - room->nx : -1,
                           z + 1 < room->nz ? cell + room->nx : -1};
    const double top = ((double)room->cells[cell].top - room->floor) / room->height;
    for (int k = 0; k < 4 && top > 0.06 && top < 0.8; k++) {
        double from[3], to[3];
        SpaceHit hit;
        if (beside[k] < 0 || !room->cells[beside[k]].is_inside)
            continue;
        room_point(room, beside[k], 0, from);
        room_point(room, cell, 0, to);
        from[1] = to[1] = (double)room->cells[cell].top + 0.03 * room->height;
        for (int j = 0; j < 3; j++)
            to[j] -= from[j];
        if (!space_ray(room->space, from, to, 0, 1, &hit))
            return 1;
    }
    return 0;
}

/* Inside of a solid surfaces are seen from behind. Furniture has a hull, and within it may be springs and boards, but
 * it is not as high as rooms are; models that are turned inside out may be. metre: as said, or 0. */
static void find_means(Room *room, double metre)
{
    enum { DIRECTIONS = 48 };
    double enclosed = 0, covered = 0, front = 0, seen = 0, floor = 0, furniture = 0;
    const int step = room->ninside / 64 + 1;
    int n = 0;
    for (int i = 0; i < room->nx * room->nz; i++) {
        const RoomCell *cell = &room->cells[i];
        double point[3], direction[3];
        SpaceHit hit;
        furniture += is_furnished(room, i);
        floor += cell->is_floor;
        if (!cell->is_inside)
            continue;
        enclosed += (double)cell->enclosed, covered += cell->is_covered;
        room->clearance = fmax(room->clearance, (double)cell->clearance);
        if (n++ % step)
            continue;
        room_point(room, i, room->eye, point);
        for (int k = 0; k < DIRECTIONS; k++) {
            spread(k, DIRECTIONS, direction);
            if (!space_ray(room->space, point, direction, 0, INFINITY, &hit))
                continue;
            seen++, front += hit.is_front;
        }
    }
    room->enclosed = room->ninside ? enclosed / room->ninside : 0;
    room->covered = room->ninside ? covered / room->ninside : 0;
    room->is_furnished = furniture > 0.005 * room->ninside;
    const double height = metre > 0 ? room->height / metre : room->height;
    room->is_solid = front < 0.05 * seen && (!room->is_furnished || height < 2 || height > 4);
    room->share = floor > 0 ? room->ninside / floor : 0;
}

double room_openness(const Room *room, const unsigned char *passes)
{
    enum { DIRECTIONS = 400, PLACES = 24 };
    const int step = room->ninside / PLACES + 1;
    double out = 0, all = 0;
    int n = 0;
    for (int i = 0; i < room->nx * room->nz; i++) {
        double point[3], direction[3];
        SpaceHit hit;
        if (!room->cells[i].is_inside || n++ % step)
            continue;
        room_point(room, i, room->eye, point);
        for (int k = 0; k < DIRECTIONS; k++) {
            spread(k, DIRECTIONS, direction);
            all++, out += !space_ray_through(room->space, point, direction, passes, &hit);
        }
    }
    return all > 0 ? out / all : 1;
}

/* ---- */

/* The size of the region, from one side to the other. */
static void region_size(const Room *room, int low[2], int high[2])
{
    low[0] = low[1] = MOST_SIDE, high[0] = high[1] = -1;
    for (int i = 0; i < room->nx * room->nz; i++) {
        const int at[2] = {i % room->nx, i / room->nx};
        for (int k = 0; room->cells[i].is_inside && k < 2; k++) {
            low[k] = at[k] < low[k] ? at[k] : low[k];
            high[k] = at[k] > high[k] ? at[k] : high[k];
        }
    }
}

static int make_plan(Room *room, RetexError *err)
{
    const double x = room->high[0] - room->low[0], z = room->high[2] - room->low[2];
    room->cell = fmax(x, z) / MOST_SIDE;
    if (!(room->cell > 0))
        return RETEX_OK;
    room->nx = (int)fmin(fmax(ceil(x / room->cell - 1e-6), 1), MOST_SIDE);
    room->nz = (int)fmin(fmax(ceil(z / room->cell - 1e-6), 1), MOST_SIDE);
    const int count = room->nx * room->nz;
    free(room->cells);
    room->cells = calloc((size_t)count, sizeof *room->cells);
    Gaps *gaps = malloc((size_t)count * sizeof *gaps);
    if (!gaps || !room->cells) {
        free(gaps);
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    }
    for (int i = 0; i < count; i++) {
        find_gaps(room, i, &gaps[i]);
        for (int k = 0; k < gaps[i].count; k++)
            enclose(room, i, &gaps[i].list[k]);
    }
    const int level = choose_level(room, gaps);
    room->is_found = level >= 0;
    if (level >= 0)
        take_level(room, gaps, level);
    free(gaps);
    return level >= 0 ? find_height(room, err) : RETEX_OK;
}

/* How high things stand on the floor, in the middle of them all. 0: nothing does. */
static double furniture_height(const Room *room, float *tops)
{
    int count = 0;
    for (int i = 0; i < room->nx * room->nz; i++) {
        const double top = ((double)room->cells[i].top - room->floor) / room->height;
        if (top > 0.06 && top < 0.8)
            tops[count++] = (float)(top * room->height);
    }
    if (count < 8)
        return 0;
    qsort(tops, (size_t)count, sizeof *tops, compare_floats);
    return (double)tops[count / 2];
}

/* Whether what one took for a room is a storey of a small model: much lower than a room, and much wider than furniture
 * is by its height. */
static int is_flat(const Room *room)
{
    double area = 0;
    for (int i = 0; i < room->nx * room->nz; i++)
        area += room->cells[i].is_floor ? room->cell * room->cell : 0;
    return room->height < 1.2 * room->metre && area > 12 * room->height * room->height;
}

/* A high room is a hall, or one whose lengths are not in the unit that is said: then its furniture is too high. */
static int check_metre(Room *room, int is_sure, RetexError *err)
{
    if (is_sure || !(room->height > 3.4 * room->metre || is_flat(room)))
        return RETEX_OK;
    float *tops = malloc((size_t)(room->nx * room->nz) * sizeof *tops);
    if (!tops)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    if (room->height < room->metre * 1.2 || furniture_height(room, tops) > 1.3 * room->metre) {
        room->metre = room->height / 2.6;
        room->is_doubtful = 1;
    }
    free(tops);
    return RETEX_OK;
}

static int find_room(Room *room, double metre, int is_sure, RetexError *err)
{
    room->metre = metre;
    room->is_found = 0;
    if (space_load(space_triangles(room->space), room->low, room->high) > SPACE_MOST_LOAD)
        return RETEX_OK;
    int code = make_plan(room, err);
    if (code || !room->is_found)
        return code;
    room->metre = metre > 0 ? metre : room->height / 2.6;
    for (int i = 0; i < room->nx * room->nz; i++)
        room->cells[i].top = (float)top_of(room, i);
    code = check_metre(room, is_sure, err);
    if (code)
        return code;
    room->is_said = metre > 0;
    room->eye = height_in(room->metre, room->height);
    measure_cells(room);
    return find_region(room, err);
}

int room_find(Room *room, const Space *space, double metre, int is_sure, RetexError *err)
{
    int low[2], high[2];
    memset(room, 0, sizeof *room);
    room->space = space;
    space_bounds(space, room->low, room->high);
    int code = find_room(room, metre, is_sure, err);
    if (code || !room->is_found)
        return code;
    region_size(room, low, high);
    const double corner[2] = {room->low[0], room->low[2]};
    if (high[0] >= 0 && high[0] - low[0] < 0.55 * MOST_SIDE && high[1] - low[1] < 0.55 * MOST_SIDE) {
        for (int k = 0; k < 2; k++) {
            room->low[2 * k] = corner[k] + (low[k] - 2) * room->cell;
            room->high[2 * k] = corner[k] + (high[k] + 3) * room->cell;
        }
        code = find_room(room, metre, is_sure, err);
        if (code || !room->is_found)
            return code;
    }
    find_means(room, metre);
    const double area = room->ninside * room->cell * room->cell, m = room->metre;
    /* hollow walls are long, too, but nowhere wide */
    room->is_closed = !room->is_solid && area > 2 * m * m && room->clearance > 0.4 * m && room->enclosed > 0.7 &&
                      (room->covered > 0.5 || (room->enclosed > 0.85 && room->share > 0.6));
    return RETEX_OK;
}

void room_free(Room *room)
{
    free(room->cells);
    room->cells = NULL;
}
