/* Rays against a model's triangles and what retex-import asks of them, compared with a loop over all triangles, with
 * boxes whose measures are known, and with the solid angle of a rectangle. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "import/space/views.h"

#define PI 3.14159265358979323846

enum { TRIANGLES = 3000, RAYS = 20000 };

static uint32_t state = 5;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}

static SpaceTriangles make(size_t nvertices, size_t ntriangles)
{
    SpaceTriangles t = {.vertices = calloc(nvertices, sizeof *t.vertices),
                        .corners = calloc(ntriangles, sizeof *t.corners),
                        .tags = calloc(ntriangles, sizeof *t.tags)};
    assert_non_null(t.vertices);
    assert_non_null(t.corners);
    assert_non_null(t.tags);
    return t;
}

static Space *create(SpaceTriangles *t)
{
    Space *space;
    RetexError err = {0};
    assert_int_equal(space_create(&space, t, &err), RETEX_OK);
    return space;
}

/* ---- rays ---- */

static SpaceTriangles random_triangles(void)
{
    SpaceTriangles t = make(3 * TRIANGLES, TRIANGLES);
    for (t.ntriangles = 0; t.ntriangles < TRIANGLES; t.ntriangles++) {
        const double at[3] = {between(-10, 10), between(-10, 10), between(-10, 10)};
        for (uint32_t k = 0; k < 3; k++, t.nvertices++) {
            for (int j = 0; j < 3; j++)
                t.vertices[t.nvertices][j] = (float)(at[j] + between(-1, 1));
            t.corners[t.ntriangles][k] = (uint32_t)t.nvertices;
        }
        t.tags[t.ntriangles] = (uint32_t)(t.ntriangles % 7);
    }
    return t;
}

static double determinant(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/* By Cramer's rule: from + t d = a + u e1 + v e2. margin: how far inside the triangle it is. */
static double meet(const SpaceTriangles *t, size_t i, const double from[3], const double d[3], double *margin,
                   int *front)
{
    double e1[3], e2[3], s[3], minus[3];
    for (int k = 0; k < 3; k++) {
        const double a = (double)t->vertices[t->corners[i][0]][k];
        e1[k] = (double)t->vertices[t->corners[i][1]][k] - a;
        e2[k] = (double)t->vertices[t->corners[i][2]][k] - a;
        s[k] = from[k] - a, minus[k] = -d[k];
    }
    const double all = determinant(minus, e1, e2);
    const double u = determinant(minus, s, e2) / all, v = determinant(minus, e1, s) / all;
    *margin = fmin(fmin(u, v), 1 - u - v);
    *front = all > 0;
    return determinant(s, e1, e2) / all;
}

static void the_nearest_is_that_of_a_loop(void **unused)
{
    SpaceTriangles t = random_triangles(), mine = random_triangles();
    (void)unused;
    for (size_t i = 0; i < t.nvertices; i++)
        memcpy(mine.vertices[i], t.vertices[i], sizeof *t.vertices);
    Space *space = create(&t);
    static const unsigned char passes[7] = {0, 1, 0, 0, 1, 1, 0};
    int hits = 0, through = 0;
    for (int i = 0; i < RAYS; i++) {
        const double from[3] = {between(-12, 12), between(-12, 12), between(-12, 12)};
        const double d[3] = {between(-1, 1), between(-1, 1), between(-1, 1)};
        double best[2] = {INFINITY, INFINITY};
        int front[2] = {0, 0}, is_close = 0;
        size_t which[2] = {0, 0};
        for (size_t k = 0; k < TRIANGLES; k++) {
            double margin;
            int is_front;
            const double at = meet(&mine, k, from, d, &margin, &is_front);
            is_close |= fabs(margin) < 1e-4 || fabs(at) < 1e-4; /* float may decide otherwise */
            for (int kind = 0; kind < 2; kind++)
                if (margin > 0 && at > 0 && at < best[kind] && !(kind && passes[mine.tags[k]]))
                    best[kind] = at, which[kind] = k, front[kind] = is_front;
        }
        for (int kind = 0; kind < 2 && !is_close; kind++) {
            SpaceHit hit;
            const int any =
                kind ? space_ray_through(space, from, d, passes, &hit) : space_ray(space, from, d, 0, INFINITY, &hit);
            assert_int_equal(any, isfinite(best[kind]));
            if (!any)
                continue;
            hits += !kind, through += kind && which[0] != which[1];
            assert_true(fabs(hit.t - best[kind]) < 1e-4 * (1 + best[kind]));
            if (hit.triangle != which[kind]) /* two are there */
                continue;
            assert_int_equal(hit.is_front, front[kind]);
            assert_int_equal(hit.tag, mine.tags[which[kind]]);
        }
    }
    assert_true(hits > RAYS / 8 && through > RAYS / 50);
    space_free(space);
    free(mine.vertices);
    free(mine.corners);
    free(mine.tags);
}

static void ends_of_rays_count(void **unused)
{
    SpaceTriangles t = make(3, 1);
    const float corners[3][3] = {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}};
    const double from[3] = {0, 0, 0}, d[3] = {0, 0, 2};
    SpaceHit hit;
    (void)unused;
    memcpy(t.vertices, corners, sizeof corners);
    for (uint32_t k = 0; k < 3; k++)
        t.corners[0][k] = k;
    t.nvertices = 3, t.ntriangles = 1, t.tags[0] = 9;
    Space *space = create(&t);
    assert_int_equal(space_ray(space, from, d, 0, 2.4, &hit), 0);
    assert_int_equal(space_ray(space, from, d, 2.6, 9, &hit), 0);
    assert_int_equal(space_ray(space, from, d, 0, 2.6, &hit), 1);
    assert_true(fabs(hit.t - 2.5) < 1e-6 && fabs(hit.point[2] - 5) < 1e-6 && fabs(fabs(hit.normal[2]) - 1) < 1e-6);
    assert_int_equal(hit.tag, 9);
    assert_int_equal(hit.is_front, hit.normal[2] < 0);
    space_free(space);
}

/* ---- rooms ---- */

static void add_quad(SpaceTriangles *t, const double corners[4][3], uint32_t tag)
{
    const uint32_t base = (uint32_t)t->nvertices;
    for (int k = 0; k < 4; k++, t->nvertices++)
        for (int j = 0; j < 3; j++)
            t->vertices[t->nvertices][j] = (float)corners[k][j];
    for (uint32_t k = 0; k < 2; k++, t->ntriangles++) {
        t->corners[t->ntriangles][0] = base;
        t->corners[t->ntriangles][1] = base + 1 + k, t->corners[t->ntriangles][2] = base + 2 + k;
        t->tags[t->ntriangles] = tag;
    }
}

/* The six sides of a box, numbered 2 axis + side; without those of `without`, bits. Their tags are first + number. */
static void add_box(SpaceTriangles *t, const double low[3], const double high[3], int inwards, unsigned without,
                    uint32_t first)
{
    for (int side = 0; side < 6; side++) {
        const int axis = side / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, turned = (side % 2 == 0) != inwards;
        double corners[4][3];
        for (int k = 0; k < 4; k++) {
            const int at = turned ? 3 - k : k;
            corners[k][axis] = side % 2 ? high[axis] : low[axis];
            corners[k][u] = at == 1 || at == 2 ? high[u] : low[u];
            corners[k][v] = at >= 2 ? high[v] : low[v];
        }
        if (!(without >> side & 1))
            add_quad(t, corners, first + (uint32_t)side);
    }
}

static Space *room_with(const double box[2][3], double scale, unsigned without)
{
    SpaceTriangles t = make(64, 64);
    const double low[3] = {0, 0, 0}, high[3] = {5 * scale, 2.6 * scale, 4 * scale};
    add_box(&t, low, high, 1, without, 0);
    if (box)
        add_box(&t, box[0], box[1], 0, 0, 6);
    return create(&t);
}

static Space *box_room(double scale, unsigned without, int with_table)
{
    const double table[2][3] = {{1.5 * scale, 0, scale}, {3 * scale, .75 * scale, 2 * scale}};
    return room_with(with_table ? table : NULL, scale, without);
}

static void a_box_is_measured(void **unused)
{
    (void)unused;
    for (int i = 0; i < 3; i++) {
        const double scale = i == 1 ? 100 : 1, metre = i == 0 ? 1 : 0;
        Space *space = box_room(scale, 0, 1);
        RetexError err = {0};
        Room room;
        assert_int_equal(room_find(&room, space, metre, 0, &err), RETEX_OK);
        assert_true(room.is_found && room.is_closed && !room.is_doubtful);
        assert_true(fabs(room.floor) < 1e-3 * scale);
        assert_true(fabs(room.height - 2.6 * scale) < 1e-3 * scale);
        assert_true(fabs(room.metre - scale) < 1e-3 * scale);
        assert_true(fabs(room.eye - 1.5 * scale) < 1e-3 * scale);
        assert_true(fabs(room.enclosed - 1) < 1e-9 && fabs(room.covered - 1) < 1e-9);
        /* the table takes 1.5 of 20 square metres; cells at its edge are either */
        const double free_floor = room.ninside * room.cell * room.cell / (scale * scale);
        assert_true(fabs(free_floor - 18.5) < 0.4);
        /* clearances, by distances to the walls and the table's sides: no less than the true one */
        for (int k = 0; k < room.nx * room.nz; k++) {
            double p[3];
            if (!room.cells[k].is_inside)
                continue;
            room_point(&room, k, 0, p);
            const double x = p[0] / scale, z = p[2] / scale;
            const double walls = fmin(fmin(x, 5 - x), fmin(z, 4 - z));
            const double dx = fmax(fmax(1.5 - x, x - 3), 0), dz = fmax(fmax(1 - z, z - 2), 0);
            const double truth = fmin(walls, hypot(dx, dz)) * scale;
            assert_true((double)room.cells[k].clearance > truth - 1e-4 * scale);
            assert_true((double)room.cells[k].clearance < 1.25 * truth + 0.02 * scale);
        }
        room_free(&room);
        space_free(space);
    }
}

/* Along any wall; what is as flat as a carpet, or nearly as high as the room, is none. */
static void a_counter_is_furniture(void **unused)
{
    (void)unused;
    static const double boxes[][2][3] = {
        {{0, 0, 0}, {.6, .9, 4}}, {{4.4, 0, 0}, {5, .9, 4}}, {{0, 0, 0}, {5, .9, .6}},  {{0, 0, 3.4}, {5, .9, 4}},
        {{0, 0, 0}, {.6, .1, 4}}, {{0, 0, 0}, {.6, 2.2, 4}}, {{0, 2, 0}, {5, 2.6, .8}},
    };
    for (size_t i = 0; i < sizeof boxes / sizeof *boxes; i++) {
        Space *space = room_with(boxes[i], 1, 0);
        RetexError err = {0};
        Room room;
        assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
        if (i < 6) /* the last one hangs */
            assert_int_equal(room.is_furnished, i < 4);
        /* below that it is lower, but most of the space is as high as before */
        assert_true(fabs(room.height - 2.6) < 1e-3);
        room_free(&room);
        space_free(space);
    }
}

static void a_solid_is_no_room(void **unused)
{
    (void)unused;
    SpaceTriangles t = make(32, 16);
    const double low[3] = {0, 0, 0}, high[3] = {5, 2.6, 4};
    RetexError err = {0};
    Room room;
    add_box(&t, low, high, 0, 0, 0);
    Space *space = create(&t);
    assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
    assert_false(room.is_closed);
    room_free(&room);
    space_free(space);
}

/* The space within a block is much higher, but one sees its sides from behind. */
static void a_block_below_a_room_is_none(void **unused)
{
    (void)unused;
    SpaceTriangles t = make(64, 32);
    const double low[3] = {0, -20, 0}, high[3] = {5, -.01, 4}, floor[3] = {0, 0, 0}, top[3] = {5, 2.6, 4};
    RetexError err = {0};
    Room room;
    add_box(&t, low, high, 0, 0, 0);
    add_box(&t, floor, top, 1, 1u << 3, 6);
    Space *space = create(&t);
    assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
    assert_true(room.is_closed && fabs(room.floor) < .02 && fabs(room.height - 2.6) < .1);
    room_free(&room);
    space_free(space);
}

/* A box of 2 x 1 x 4 on a ground of 7 x 7, which is 6 times as large, or of 4 x 5. */
static void wide_ground_is_not_framed(void **unused)
{
    (void)unused;
    const double from[] = {1, 0, 2}, to[] = {3, 1, 6};
    for (int is_wide = 0; is_wide < 2; is_wide++) {
        SpaceTriangles t = make(32, 16);
        const double ground[4][3] = {{0, 0, is_wide ? 0 : 1.5},
                                     {is_wide ? 7 : 4, 0, is_wide ? 0 : 1.5},
                                     {is_wide ? 7 : 4, 0, is_wide ? 7 : 6.5},
                                     {0, 0, is_wide ? 7 : 6.5}};
        double low[3], high[3];
        add_quad(&t, ground, 0);
        add_box(&t, from, to, 0, 1u << 2, 1);
        Space *space = create(&t);
        space_standing_bounds(space, low, high);
        for (int k = 0; k < 3; k++) {
            const double margin = k == 1 ? 0 : .1 * (to[k] - from[k]);
            assert_float_equal(low[k], is_wide ? from[k] - margin : ground[0][k], 1e-6);
            assert_float_equal(high[k], is_wide ? to[k] + margin : k == 1 ? 1 : ground[2][k], 1e-6);
        }
        space_free(space);
    }
}

/* A corner of a rectangle is above the point, at this height. */
static double solid_angle(double a, double b, double height)
{
    return atan2(a * b, height * sqrt(height * height + a * a + b * b));
}

static void the_sky_has_the_solid_angle_of_the_opening(void **unused)
{
    static const unsigned char passes[12] = {[3] = 1}; /* a ceiling of glass */
    (void)unused;
    for (int i = 0; i < 3; i++) {
        Space *space = box_room(1, i == 0 ? 1u << 3 : 0, 0);
        RetexError err = {0};
        Room room;
        assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
        double sum = 0, count = 0;
        for (int k = 0; k < room.nx * room.nz; k++) {
            double p[3];
            room_point(&room, k, 0, p);
            if (!room.cells[k].is_inside)
                continue;
            const double h = 2.6 - room.eye;
            sum += (solid_angle(p[0], p[2], h) + solid_angle(5 - p[0], p[2], h) + solid_angle(p[0], 4 - p[2], h) +
                    solid_angle(5 - p[0], 4 - p[2], h)) /
                   (4 * PI);
            count++;
        }
        const double open = room_openness(&room, i == 1 ? passes : NULL), truth = i == 2 ? 0 : sum / count;
        assert_true(count > 100 && fabs(open - truth) < 0.02);
        room_free(&room);
        space_free(space);
    }
}

static void a_view_is_of_the_furniture(void **unused)
{
    (void)unused;
    Space *space = box_room(1, 0, 1);
    RetexError err = {0};
    Views views, again;
    Room room;
    assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
    assert_int_equal(views_find(&room, NULL, VIEWS_EITHER, NULL, &views, &err), RETEX_OK);
    assert_int_equal(views_find(&room, NULL, VIEWS_EITHER, NULL, &again, &err), RETEX_OK);
    assert_true(views.count > 1 && views.count == again.count);
    for (int i = 0; i < views.count; i++)
        assert_memory_equal(&views.list[i].view, &again.list[i].view, sizeof(View));
    /* the table is before the eye, and most of it is in the picture: its corners are not far from the axis */
    const View *view = &views.list[0].view;
    double to[3], size = 0, cosine = 0;
    for (int k = 0; k < 3; k++) {
        to[k] = (const double[3]){2.25, 0.6, 1.5}[k] - view->eye[k];
        size += to[k] * to[k], cosine += view->ahead[k] * to[k];
    }
    cosine /= sqrt(size);
    assert_int_equal(views.list[0].from, VIEWS_INSIDE);
    assert_true(cosine > cos(30 * PI / 180) && sqrt(size) > 1);
    assert_true(view->ahead[1] < 0);
    room_free(&room);
    space_free(space);
}

/* ---- which view is the best ---- */

/* Boxes from corner to corner, in metres; a room's are seen from inside, without some of its sides. */
typedef struct Box {
    double low[3], high[3];
    int inwards;
    unsigned without;
} Box;

static Space *boxes(const Box *list, int count)
{
    SpaceTriangles t = make(24 * (size_t)count, 12 * (size_t)count);
    for (int i = 0; i < count; i++)
        add_box(&t, list[i].low, list[i].high, list[i].inwards, list[i].without, 6 * (uint32_t)i);
    return create(&t);
}

static double nearest_beside(const Space *space, const double eye[3])
{
    double nearest = INFINITY;
    for (int i = 0; i < 32; i++) {
        const double a = 2 * PI * i / 32, direction[3] = {cos(a), 0, sin(a)};
        SpaceHit hit;
        if (space_ray(space, eye, direction, 0, INFINITY, &hit))
            nearest = fmin(nearest, hit.t);
    }
    return nearest;
}

/* What must hold of each view: its share of floor by rays of its own, its eye in free space, and no two alike. */
static void check_views(const Room *room, const Views *views, ViewsFrom from, double least_floor)
{
    const Space *space = room->space;
    for (int i = 0; i < views->count; i++) {
        const View *v = &views->list[i].view;
        assert_true(i == 0 || views->list[i].score <= views->list[i - 1].score);
        assert_true(fabs(v->up[0] * v->ahead[2] - v->up[2] * v->ahead[0]) < 1e-9 && v->up[1] > 0.5); /* upright */
        if (views->list[i].from == VIEWS_INSIDE)
            assert_true(nearest_beside(space, v->eye) > 0.4);
        for (int k = 0; k < i; k++) {
            const View *w = &views->list[k].view;
            double apart = 0, cosine = 0;
            for (int j = 0; j < 3; j++)
                apart = hypot(apart, v->eye[j] - w->eye[j]), cosine += v->ahead[j] * w->ahead[j];
            assert_true(apart > 0.99 * picture_metre(room) || cosine < cos(29.9 * PI / 180));
        }
    }
    assert_int_equal(views->list[0].from, from);
    int floor = 0, all = 0;
    for (int j = -10; j <= 10; j++)
        for (int i = -10; i <= 10; i++) {
            const View *v = &views->list[0].view;
            const double right[3] = {v->up[1] * v->ahead[2] - v->up[2] * v->ahead[1],
                                     v->up[2] * v->ahead[0] - v->up[0] * v->ahead[2],
                                     v->up[0] * v->ahead[1] - v->up[1] * v->ahead[0]};
            const double half = tan(v->angle * PI / 360);
            double direction[3];
            SpaceHit hit;
            for (int k = 0; k < 3; k++)
                direction[k] = v->ahead[k] + half * (i / 10.0 * right[k] + 0.75 * j / 10.0 * v->up[k]);
            all++;
            floor += space_ray(space, v->eye, direction, 0, INFINITY, &hit) && fabs(hit.point[1]) < 0.01;
        }
    assert_true(floor >= least_floor * all);
}

static void the_best_view_is_where_people_stand(void **unused)
{
    static const Box closed[] = {{{0, 0, 0}, {5, 2.6, 4}, 1, 0},
                                 {{3, 0, 1}, {4.2, .75, 2}, 0, 0},
                                 {{.1, 0, .1}, {2.2, .8, 1}, 0, 0},
                                 {{4.4, 0, 3}, {4.9, 1.9, 3.9}, 0, 0}},
                     ell[] = {{{0, 0, 0}, {6, 2.5, 2.8}, 1, 1u << 5},
                              {{0, 0, 2.8}, {2.8, 2.5, 6}, 1, 1u << 4},
                              {{2.8, 0, 2.8}, {6, 2.5, 2.81}, 0, 0},
                              {{4, 0, .1}, {5.9, .5, 1.7}, 0, 0},
                              {{.1, 0, 4.8}, {1.5, .74, 5.9}, 0, 0}},
                     open_side[] = {{{0, 0, 0}, {5, 2.6, 4}, 1, 1u << 4},
                                    {{1, 0, 1}, {2.2, .75, 2}, 0, 0},
                                    {{3, 0, 2.5}, {4.5, .8, 3.8}, 0, 0}},
                     house[] = {{{0, 0, 0}, {8, 2.6, 6}, 1, 0},
                                {{-.3, -.01, -.3}, {8.3, 2.9, 6.3}, 0, 0},
                                {{-1, 2.9, -1}, {9, 3.1, 7}, 0, 0},
                                {{2, 0, 2}, {4, .75, 3}, 0, 0},
                                {{6, 0, .1}, {7.9, .8, 1}, 0, 0}},
                     chair[] = {{{0, .45, 0}, {.5, .5, .5}, 0, 0},   {{0, .5, .45}, {.5, 1, .5}, 0, 0},
                                {{0, 0, 0}, {.05, .45, .05}, 0, 0},  {{.45, 0, 0}, {.5, .45, .05}, 0, 0},
                                {{0, 0, .45}, {.05, .45, .5}, 0, 0}, {{.45, 0, .45}, {.5, .45, .5}, 0, 0}},
                     sculpture[] = {{{0, 0, 0}, {1, 1, 1}, 0, 0}, {{.2, 1, .2}, {.8, 2.4, .8}, 0, 0}},
                     corner[] = {{{0, 0, 0}, {5, 2.6, 4}, 1, 1u << 1 | 1u << 3 | 1u << 4},
                                 {{.1, 0, 2.8}, {2.2, .8, 3.9}, 0, 0},
                                 {{3, 0, 1}, {4.2, .75, 2}, 0, 0}},
                     flat[] = {{{0, 0, 0}, {9, 2.6, 8}, 1, 1u << 3}, {{-.2, -.01, -.2}, {9.2, 2.6, 8.2}, 0, 1u << 3},
                               {{4.4, 0, 0}, {4.6, 2.6, 8}, 0, 0},   {{0, 0, 3.9}, {9, 2.6, 4.1}, 0, 0},
                               {{1, 0, 1}, {3, .75, 2}, 0, 0},       {{6, 0, 5}, {8, .5, 6.5}, 0, 0}},
                     block[] = {{{0, 0, 0}, {12, 13, 12}, 0, 0}, {{3, 13, 3}, {9, 14, 9}, 0, 0}};
    static const struct {
        const Box *boxes;
        int count;
        ViewsFrom from;
        double floor;
    } models[] = {
        {closed, 4, VIEWS_INSIDE, .08},  {ell, 5, VIEWS_INSIDE, .08},  {open_side, 3, VIEWS_EITHER, .05},
        {house, 5, VIEWS_INSIDE, .08},   {chair, 6, VIEWS_OUTSIDE, 0}, {sculpture, 2, VIEWS_OUTSIDE, 0},
        {corner, 3, VIEWS_OUTSIDE, .03}, {flat, 6, VIEWS_EITHER, .03}, {block, 2, VIEWS_OUTSIDE, 0},
    };
    (void)unused;
    for (size_t i = 0; i < sizeof models / sizeof *models; i++) {
        Space *space = boxes(models[i].boxes, models[i].count);
        RetexError err = {0};
        Views views;
        Room room;
        assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
        assert_int_equal(views_find(&room, NULL, VIEWS_EITHER, NULL, &views, &err), RETEX_OK);
        assert_int_equal(views.count, VIEWS_MOST);
        check_views(&room, &views, models[i].from == VIEWS_EITHER ? views.list[0].from : models[i].from,
                    models[i].floor);
        /* one that is given stays the first */
        const View best = views.list[0].view;
        assert_int_equal(views_find(&room, NULL, VIEWS_EITHER, &best, &views, &err), RETEX_OK);
        assert_memory_equal(&views.list[0].view, &best, sizeof best);
        assert_int_equal(views.list[0].from, VIEWS_GIVEN);
        room_free(&room);
        space_free(space);
    }
}

/* Each term of the score, by two pictures that differ in it alone. */
static void the_score_is_of_what_is_shown(void **unused)
{
    (void)unused;
    Content plain = {.furniture = .1, .floor = .15, .wall = .5, .objects = 2, .materials = 1, .extent = .15};
    const double score = content_score(&plain);
#define WITH(member, value, sign)                                                                                      \
    {                                                                                                                  \
        offsetof(Content, member), value, sign                                                                         \
    }
    static const struct {
        size_t at;
        double value;
        int sign;
    } changes[] = {
        WITH(furniture, .14, 1), WITH(floor, .2, 1), WITH(wall, .05, -1), WITH(objects, 3, 1),  WITH(materials, 2, 1),
        WITH(extent, .25, 1),    WITH(depth, 1, 1),  WITH(detail, 3, 1),  WITH(middle, .5, 1),  WITH(ceiling, .4, -1),
        WITH(nothing, .4, -1),   WITH(near, .1, -1), WITH(back, .2, -1),  WITH(cut, .2, -1),    WITH(largest, .3, -1),
        WITH(obstacle, .2, -1),  WITH(tilt, .5, -1), WITH(open, .3, -1),  WITH(behind, .5, -1),
    };
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        Content other = plain;
        *(double *)((char *)&other + changes[i].at) = changes[i].value;
        assert_true(changes[i].sign * (content_score(&other) - score) > 0.01);
    }
    /* some floor is worth more than more of it; a plan from above and the inside of a solid are worse than they seem */
    static const struct {
        size_t at;
        double values[3]; /* from the second to the third one the score changes by more than it does from the first */
    } bends[] = {{offsetof(Content, floor), {.1, .06, .02}},
                 {offsetof(Content, tilt), {.35, .5, .65}},
                 {offsetof(Content, back), {.6, .75, .9}},
                 {offsetof(Content, open), {.04, .08, .12}}};
    for (size_t i = 0; i < sizeof bends / sizeof *bends; i++) {
        double scores[3];
        for (int k = 0; k < 3; k++) {
            Content bent = plain;
            *(double *)((char *)&bent + bends[i].at) = bends[i].values[k];
            scores[k] = content_score(&bent);
        }
        assert_true(scores[1] - scores[2] > scores[0] - scores[1] + 0.1);
    }
    /* a little of what is no harm */
    Content other = plain;
    other.ceiling = .1, other.nothing = .1, other.tilt = .2, other.open = .05, other.largest = .1;
    assert_true(content_score(&other) == score);
}

/* Half a picture of floor, a quarter each of two things that the edges do not cut, seen from behind. */
static void contents_are_counted(void **unused)
{
    (void)unused;
    Picture *picture = calloc(1, sizeof *picture);
    const uint32_t materials[3] = {7, 8, 8};
    assert_non_null(picture);
    picture->width = 8, picture->height = 8, picture->size = 10;
    for (int i = 0; i < 64; i++) {
        const int x = i % 8, y = i / 8, is_thing = x >= 2 && x < 6 && y >= 2 && y < 6;
        PictureSample *s = &picture->samples[i];
        s->kind = is_thing ? PICTURE_FURNITURE : y < 4 ? PICTURE_NOTHING : PICTURE_FLOOR;
        s->tag = is_thing ? x < 4 ? 1 : 2 : 0;
        s->distance = is_thing ? 0.75f : 4;
        s->is_front = !is_thing;
        s->at[0] = is_thing ? -1 : 1;
    }
    const Content c = picture_content(picture, materials);
    const double thing = 16 / 64.0, nothing = 24 / 64.0, floor = 24 / 64.0;
    assert_true(fabs(c.furniture - thing) < 1e-12 && fabs(c.nothing - nothing) < 1e-12);
    assert_true(fabs(c.floor - floor) < 1e-12 && c.wall == 0 && c.cut == 0 && c.things == 3);
    assert_true(fabs(c.back - thing) < 1e-12 && fabs(c.near - thing / 2) < 1e-12);
    assert_true(fabs(c.largest - thing / 2) < 1e-12 && fabs(c.obstacle - thing) < 1e-12);
    assert_true(fabs(c.objects + thing * log2(thing / 2) + floor * log2(floor)) < 1e-12);
    assert_true(fabs(c.materials + thing * log2(thing) + floor * log2(floor)) < 1e-12);
    assert_true(fabs(c.extent - sqrt(1 - 0.2 * 0.2) / 10) < 1e-6); /* of 16 at -1 and 24 at 1 */
    picture->samples[3].kind = PICTURE_FURNITURE, picture->samples[3].tag = 1;
    assert_true(fabs(picture_content(picture, materials).cut - 9 / 64.0) < 1e-12);
    for (int near = 0; near < 2; near++) { /* much nearer than the rest, or not */
        for (int i = 0; i < 64; i++)
            if (picture->samples[i].kind == PICTURE_FURNITURE)
                picture->samples[i].distance = near ? 2.4f : 2.8f;
        assert_true(fabs(picture_content(picture, materials).obstacle - near * 17 / 64.0) < 1e-12);
    }
    free(picture);
}

/* ---- much at one place ---- */

/* A line that is as likely as any other through a ball. */
static void random_line(double radius, double from[3], double direction[3])
{
    const double y = between(-1, 1), a = between(0, 2 * PI), r = sqrt(1 - y * y);
    const double out = radius * sqrt(between(0, 1)), turn = between(0, 2 * PI);
    const double u[3] = {-sin(a), 0, cos(a)}, d[3] = {r * cos(a), y, r * sin(a)};
    const double v[3] = {d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]};
    for (int k = 0; k < 3; k++) {
        direction[k] = d[k];
        from[k] = out * (cos(turn) * u[k] + sin(turn) * v[k]);
    }
}

static int line_meets(const double from[3], const double direction[3], const double low[3], const double high[3])
{
    double enters = -INFINITY, leaves = INFINITY;
    for (int k = 0; k < 3; k++) {
        const double a = (low[k] - from[k]) / direction[k], b = (high[k] - from[k]) / direction[k];
        enters = fmax(enters, fmin(a, b)), leaves = fmin(leaves, fmax(a, b));
    }
    return enters <= leaves;
}

static void the_load_is_what_lines_meet(void **unused)
{
    (void)unused;
    enum { LINES = 20000 };
    SpaceTriangles t = random_triangles();
    const double low[3] = {-6, -2, -5}, high[3] = {3, 4, 6};
    double(*boxes)[2][3] = calloc(t.ntriangles, sizeof *boxes);
    long through = 0, met = 0;
    assert_non_null(boxes);
    for (size_t i = 0; i < t.ntriangles; i++)
        for (int k = 0; k < 3; k++) {
            boxes[i][0][k] = INFINITY, boxes[i][1][k] = -INFINITY;
            for (int j = 0; j < 3; j++) {
                boxes[i][0][k] = fmin(boxes[i][0][k], (double)t.vertices[t.corners[i][j]][k]);
                boxes[i][1][k] = fmax(boxes[i][1][k], (double)t.vertices[t.corners[i][j]][k]);
            }
            boxes[i][0][k] = fmax(boxes[i][0][k], low[k]), boxes[i][1][k] = fmin(boxes[i][1][k], high[k]);
        }
    for (int line = 0; line < LINES; line++) {
        double from[3], direction[3];
        random_line(12, from, direction);
        if (!line_meets(from, direction, low, high))
            continue;
        through++;
        for (size_t i = 0; i < t.ntriangles; i++) {
            const double(*b)[3] = (const double(*)[3])boxes[i];
            met += b[0][0] <= b[1][0] && b[0][1] <= b[1][1] && b[0][2] <= b[1][2] &&
                   line_meets(from, direction, b[0], b[1]);
        }
    }
    const double expected = (double)met / (double)through, load = space_load(&t, low, high);
    print_message("# %.3f, of lines %.3f\n", load, expected);
    assert_true(fabs(load - expected) < 0.02 * expected);
    free(boxes);
    free(t.vertices), free(t.corners), free(t.tags);
}

static void crowds_are_not_asked(void **unused)
{
    (void)unused;
    const double low[3] = {0, 0, 0}, high[3] = {5, 2.6, 4}, far_low[3] = {36, 0, 36}, far_high[3] = {40, 2.6, 40};
    const double floor[4][3] = {{0, 0, 0}, {0, 0, 4}, {5, 0, 4}, {5, 0, 0}};
    for (int crowded = 0; crowded < 2; crowded++) {
        RetexError err = {0};
        Space *space;
        Room room;
        /* of each pair of triangles in one plane, both have the bounds of all */
        SpaceTriangles flat = make(4096, 4096);
        for (int i = 0; i < (crowded ? 251 : 249); i++)
            add_quad(&flat, floor, 0);
        assert_int_equal(space_create(&space, &flat, &err), crowded ? RETEX_ELIMIT : RETEX_OK);
        space_free(space);
        /* a little room in a large model, with many floors */
        SpaceTriangles t = make(16384, 16384);
        add_box(&t, low, high, 1, 0, 0);
        add_box(&t, far_low, far_high, 0, 0, 6);
        for (int i = 0; i < (crowded ? 3000 : 1); i++)
            add_quad(&t, floor, 12);
        space = create(&t);
        assert_int_equal(room_find(&room, space, 1, 0, &err), RETEX_OK);
        assert_int_equal(room.is_found, !crowded);
        assert_int_equal(room.is_closed, !crowded);
        room_free(&room);
        space_free(space);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_is_that_of_a_loop),
        cmocka_unit_test(ends_of_rays_count),
        cmocka_unit_test(a_box_is_measured),
        cmocka_unit_test(a_counter_is_furniture),
        cmocka_unit_test(a_solid_is_no_room),
        cmocka_unit_test(a_block_below_a_room_is_none),
        cmocka_unit_test(wide_ground_is_not_framed),
        cmocka_unit_test(the_load_is_what_lines_meet),
        cmocka_unit_test(crowds_are_not_asked),
        cmocka_unit_test(the_sky_has_the_solid_angle_of_the_opening),
        cmocka_unit_test(a_view_is_of_the_furniture),
        cmocka_unit_test(the_best_view_is_where_people_stand),
        cmocka_unit_test(the_score_is_of_what_is_shown),
        cmocka_unit_test(contents_are_counted),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
