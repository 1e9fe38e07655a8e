/* Faces that are flat with each other, and faces on one level, against loops over all pairs and all corners. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include "accel/accel.h"
#include "job/job.h"
#include "lib_scene.h"
#include "faces/faces.h"
#include "shape/shape.h"

static double random_number(unsigned *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 16777216.0;
}

/* ---- a mesh as text ---- */

enum { GRID = 9, TRIANGLES = 2 * GRID * GRID };

/* A hilly sheet of triangles, each with three vertices of its own, wound as chance has it, in no order. */
static void write_hills(char *text, size_t size, unsigned seed, const char *after)
{
    double height[GRID + 1][GRID + 1];
    int order[TRIANGLES];
    size_t used = (size_t)snprintf(text, size, "camera { location -9*z } mesh2 { vertex_vectors { %d", 3 * TRIANGLES);
    for (int y = 0; y <= GRID; y++)
        for (int x = 0; x <= GRID; x++)
            height[y][x] = random_number(&seed) < 0.4 ? 0 : 0.3 * random_number(&seed);
    for (int k = 0; k < TRIANGLES; k++) {
        const int other = (int)((k + 1) * random_number(&seed));
        order[k] = order[other], order[other] = k;
    }
    for (int k = 0; k < TRIANGLES; k++) {
        static const int halves[2][3][2] = {{{0, 0}, {1, 0}, {1, 1}}, {{0, 0}, {1, 1}, {0, 1}}};
        const int cell = order[k] / 2, turned = random_number(&seed) < 0.5;
        for (int i = 0; i < 3; i++) {
            const int *at = halves[order[k] % 2][turned ? 2 - i : i];
            const int x = cell % GRID + at[0], y = cell / GRID + at[1];
            used += (size_t)snprintf(text + used, size - used, ", <%d, %.9f, %d>", x, height[y][x], y);
        }
    }
    used += (size_t)snprintf(text + used, size - used, " } face_indices { %d", TRIANGLES);
    for (int k = 0; k < TRIANGLES; k++)
        used += (size_t)snprintf(text + used, size - used, ", <%d, %d, %d>", 3 * k, 3 * k + 1, 3 * k + 2);
    snprintf(text + used, size - used, " } pigment { rgb 1 } %s }", after);
}

/* ---- flat, by all pairs ---- */

static void corners_of(const Primitive *p, int face, Vec3 corner[3])
{
    for (int k = 0; k < 3; k++)
        corner[k] = transform_point(&p->transform, p->shape.mesh->vertices[p->shape.mesh->faces[face].vertex[k]]);
}

/* Degrees by which the surface bends over the edge that two triangles share; 360: they share none. */
static double bend(const Vec3 a[3], const Vec3 b[3])
{
    Vec3 shared[3];
    int own[3] = {0}, theirs[3] = {0}, count = 0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (vec_length(vec_sub(a[i], b[j])) < 1e-9)
                shared[count++ % 3] = a[i], own[i] = theirs[j] = 1;
    if (count != 2)
        return 360;
    const Vec3 edge = vec_normalize(vec_sub(shared[1], shared[0]));
    Vec3 out[2];
    for (int i = 0; i < 3; i++) {
        if (!own[i])
            out[0] = vec_sub(a[i], shared[0]);
        if (!theirs[i])
            out[1] = vec_sub(b[i], shared[0]);
    }
    for (int k = 0; k < 2; k++)
        out[k] = vec_normalize(vec_mad(out[k], edge, -vec_dot(out[k], edge)));
    return 180 - acos(fmax(-1, fmin(1, vec_dot(out[0], out[1])))) * 180 / PI;
}

/* Of each face the lowest that is reached from it, in rounds until nothing changes. */
static void flood(const Primitive *p, int *lowest)
{
    static unsigned char near[TRIANGLES][TRIANGLES];
    int changes = 1;
    for (int i = 0; i < TRIANGLES; i++) {
        lowest[i] = i;
        for (int j = 0; j < TRIANGLES; j++) {
            Vec3 a[3], b[3];
            corners_of(p, i, a), corners_of(p, j, b);
            near[i][j] = bend(a, b) < 10;
        }
    }
    while (changes) {
        changes = 0;
        for (int i = 0; i < TRIANGLES; i++)
            for (int j = 0; j < TRIANGLES; j++)
                if (near[i][j] && lowest[j] < lowest[i])
                    lowest[i] = lowest[j], changes = 1;
    }
}

static void flat_as_by_all_pairs(void **state)
{
    (void)state;
    static char text[200000];
    int lowest[TRIANGLES], regions = 0, largest = 0, sizes[TRIANGLES];
    for (unsigned seed = 1; seed <= 6; seed++) {
        write_hills(text, sizeof text, seed, seed % 2 ? "scale <2, .7, 1> rotate <20, 50, 0>" : "");
        Scene *scene = test_scene(text);
        int *flat = faces_flat(&scene->primitives[0]);
        assert_non_null(flat);
        flood(&scene->primitives[0], lowest);
        memset(sizes, 0, sizeof sizes);
        for (int i = 0; i < TRIANGLES; i++) {
            assert_int_equal(flat[i], lowest[i]);
            regions += lowest[i] == i;
            largest = ++sizes[lowest[i]] > largest ? sizes[lowest[i]] : largest;
        }
        free(flat);
        scene_close(&scene);
    }
    assert_in_range(regions, 60, 6 * TRIANGLES - 300); /* the hills are neither all flat nor all steep */
    assert_in_range(largest, 8, TRIANGLES);
}

/* Triangles without area are in no region and connect nothing; a sheet that is folded back on itself is two sides. */
static void degenerate_and_folded(void **state)
{
    (void)state;
    Scene *scene =
        test_scene("camera { location -9*z } mesh2 { vertex_vectors { 6, <0,0,0>, <1,0,0>, <1,0,1>, <2,0,0>, "
                   "<.5,0,-1>, <.5,.01,-1> } face_indices { 4, <0,1,2>, <0,1,3>, <0,1,4>, <0,1,5> } "
                   "pigment { rgb 1 } }");
    static const int expected[4] = {0, -1, 0, 0}; /* both lie on the other side of the edge */
    int *flat = faces_flat(&scene->primitives[0]);
    for (int k = 0; k < 4; k++)
        assert_int_equal(flat[k], expected[k]);
    free(flat);
    scene_close(&scene);
    scene = test_scene("camera { location -9*z } mesh2 { vertex_vectors { 4, <0,0,0>, <1,0,0>, <.5,0,1>, <.5,.01,1> } "
                       "face_indices { 2, <0,1,2>, <0,1,3> } pigment { rgb 1 } }");
    flat = faces_flat(&scene->primitives[0]);
    assert_int_equal(flat[0], 0);
    assert_int_equal(flat[1], 1);
    free(flat);
    scene_close(&scene);
}

/* ---- targets of faces ---- */

static Scene *scene_with(const char *text, const char *const *targets, int ntargets)
{
    const RenderParams render = RENDER_PARAMS_INIT;
    RetexError err = {0};
    Scene *scene = test_scene(text);
    if (job_resolve_targets(scene, &render, targets, ntargets, &err))
        fail_msg("%s", err.message);
    return scene;
}

/* The target at the middle of each face, as rays find it. */
static int target_at(const Scene *scene, const Accel *accel, const Face *face)
{
    Vec3 middle = {0, 0, 0};
    for (int k = 0; k < face->ncorners; k++)
        middle = vec_mad(middle, face->corners[k], 1.0 / face->ncorners);
    const Ray ray = {vec_mad(middle, face->normal, 1e-3), vec_neg(face->normal), 0, 2e-3};
    Hit hit;
    Surface surface;
    assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
    surface_at(&surface, scene, &ray, &hit);
    return surface.target;
}

static void hits_have_the_targets_of_their_faces(void **state)
{
    (void)state;
    static char text[200000];
    static const char *const targets[3] = {"A=#1/flat:40", "B=#1/flat:7", "C=#1"};
    int counts[3] = {0};
    Accel *accel;
    write_hills(text, sizeof text, 3, "");
    Scene *scene = scene_with(text, targets, 3);
    const Primitive *p = &scene->primitives[0];
    int *flat = faces_flat(p);
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    for (int i = 0; i < TRIANGLES; i++) {
        Face face;
        const int expected = flat[i] == flat[39] ? 0 : flat[i] == flat[6] ? 1 : 2;
        assert_true(faces_at(p, i, &face));
        assert_int_equal(target_at(scene, accel, &face), expected);
        counts[expected]++;
    }
    for (int t = 0; t < 3; t++) {
        assert_true(counts[t] > 0);
        assert_false(job_target_is_empty(scene, t));
    }
    free(flat);
    accel_close(&accel);
    scene_close(&scene);
}

/* ---- levels, by a loop over all corners ---- */

static const char levels[] =
    "camera { location -9*z } #default { pigment { rgb 1 } } "
    "box { <0,0,0>, <4,1,4> } "                                     /* #1, its top is pointed at */
    "box { <5,0,0>, <6,1.01,1> } "                                  /* #2 is level */
    "box { <7,0,0>, <8,1.3,1> } "                                   /* #3 is too high */
    "box { <5,-1,-1>, <6,0,1> rotate x*5 translate <0,1,3> } "      /* #4 is tilted, but not much, and too far */
    "box { <-.1,-1,-.1>, <.1,0,.1> rotate x*5 translate <9,1,3> } " /* #5 is tilted and small */
    "box { <5,1,6>, <6,2,7> } "                                     /* #6 has its bottom there, which faces down */
    "mesh2 { vertex_vectors { 4, <0,1,6>, <1,1,6>, <1,1,7>, <0,1.5,7> } face_indices { 2, <0,2,1>, <0,3,2> "
    "} } "                                                                                   /* #7 */
    "mesh2 { vertex_vectors { 3, <2,1,6>, <3,1,6>, <3,1,7> } face_indices { 1, <0,1,2> } } " /* #8 */
    "plane { y, 1 } plane { y, 2 } plane { -y, -1 } plane { y, 1 rotate z*3 } "              /* #9 to #12 */
    "disc { <9,1.01,9>, -y, 1 } sphere { <20,1,0>, .1 }";                                    /* #13, #14 */

/* As above, but told by hand: number of the object, and bits of its faces. */
static const unsigned on_level[14] = {1u << 3, 1u << 3, 0, 0, 1u << 3, 0, 1, 1, 1, 0, 0, 0, 1, 0};

static void levels_by_hand(void **state)
{
    (void)state;
    static const char *const target = "A=#1/level:4";
    RetexError err = {0};
    FaceLevel level;
    Scene *scene = scene_with(levels, &target, 1);
    assert_int_equal(scene->nprimitives, 14);
    assert_int_equal(faces_level(&level, scene, &scene->targets[0].selections[0], &err), 0);
    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *p = &scene->primitives[i];
        const FaceOwner owner = faces_owner(scene, p, faces_scene_size(scene));
        for (int k = 0; k < faces_count(p); k++) {
            const int expected = on_level[i] >> k & 1;
            const int marked = p->faces ? p->faces->of[k] == 0 : p->target == 0;
            if (faces_are_on_level(&level, scene, &owner, k) != expected || marked != expected)
                fail_msg("face %d of object #%d: %d", k + 1, i + 1, marked);
        }
        assert_int_equal(primitive_target_texture(p, 0) != NULL, on_level[i] != 0);
    }
    scene_close(&scene);
}

/* Of two selections that have a face the first counts, whichever is the wider one. */
static void first_selection_wins(void **state)
{
    (void)state;
    static const char *const wide_first[] = {"A=#1/level:4", "B=#2/flat:4"}, *const narrow_first[] = {"B=#2/flat:4",
                                                                                                      "A=#1/level:4"};
    Scene *scene = scene_with(levels, wide_first, 2);
    assert_int_equal(scene->primitives[0].faces->of[3], 0);
    assert_int_equal(scene->primitives[1].faces->of[3], 0);
    scene_close(&scene);
    scene = scene_with(levels, narrow_first, 2);
    assert_int_equal(scene->primitives[0].faces->of[3], 1);
    assert_int_equal(scene->primitives[1].faces->of[3], 0);
    scene_close(&scene);
}

/* Random boxes of any rotation: their corners against the plane through the middle of the one that is pointed at. */
static void levels_by_a_loop(void **state)
{
    (void)state;
    static char text[20000];
    static const char *const target = "A=#1/level:4";
    unsigned seed = 5;
    int on = 0, total = 0;
    size_t used = (size_t)snprintf(text, sizeof text,
                                   "camera { location -9*z } #default { pigment { rgb 1 } } "
                                   "box { <-1,-1,-1>, <1,0,1> } ");
    for (int k = 0; k < 100; k++)
        used += (size_t)snprintf(
            text + used, sizeof text - used,
            "box { <-1,-1,-1>*.008, <1,0,1>*.008 rotate <%.4f,%.4f,%.4f> translate <%.4f,%.4f,%.4f> } ",
            24 * random_number(&seed) - 12, 360 * random_number(&seed), k % 5 ? 24 * random_number(&seed) - 12 : 180,
            4 * random_number(&seed), 0.012 * random_number(&seed) - 0.006, 4 * random_number(&seed));
    Scene *scene = scene_with(text, &target, 1);
    Vec3 low = {1e9, 1e9, 1e9}, high = {-1e9, -1e9, -1e9};
    for (int i = 0; i < scene->nprimitives; i++)
        for (int c = 0; c < 8; c++) {
            const Vec3 p = transform_point(&scene->primitives[i].transform, vec3(c & 1, c >> 1 & 1, c >> 2));
            low = vec3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
            high = vec3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
        }
    const double tolerance = fmin(vec_length(vec3(2, 1, 2)) / 100, vec_length(vec_sub(high, low)) / 2000);
    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *p = &scene->primitives[i];
        for (int face = 0; face < 6; face++) {
            int expected = 1;
            for (int c = 0; c < 8; c++) {
                const double at[3] = {c & 1, c >> 1 & 1, c >> 2};
                if (at[face / 2] == face % 2)
                    expected &= fabs(transform_point(&p->transform, vec3(at[0], at[1], at[2])).y) <= tolerance;
            }
            const Vec3 across = transform_vector(&p->transform, vec3(face / 2 == 0, face / 2 == 1, face / 2 == 2));
            expected &= vec_normalize(across).y * (face % 2 ? 1 : -1) > cos(10 * PI / 180);
            assert_int_equal(p->faces && p->faces->of[face] == 0, expected);
            on += expected, total++;
        }
    }
    assert_in_range(on, 20, total / 10);
    scene_close(&scene);
}

/* Copies of a prototype: a face is on a level where it is in all of them. */
static void levels_of_copies(void **state)
{
    (void)state;
    static const char planks[] = "camera { location -9*z } #default { pigment { rgb 1 } } "
                                 "#declare Plank = union { #for (I, 1, 40) box { <0,0,I>, <1,.1,I+.9> } #end } "
                                 "#for (K, 0, 250) object { Plank translate <K,%s,0> } #end";
    const RenderParams render = RENDER_PARAMS_INIT;
    for (int steps = 0; steps < 2; steps++) {
        char text[1024], level[64], flat[64];
        const char *target = level;
        RetexError err = {0};
        int k = 0;
        snprintf(text, sizeof text, planks, steps ? "K" : "0");
        Scene *scene = test_scene(text);
        while (k < scene->nprimitives && !scene->primitives[k].prototype)
            k++;
        assert_in_range(k, 1, scene->nprimitives - 1);
        snprintf(level, sizeof level, "A=#%d/level:4", k + 1);
        snprintf(flat, sizeof flat, "A=#%d/flat:4", k + 1);
        assert_int_equal(job_resolve_targets(scene, &render, &target, 1, &err), steps ? RETEX_EUNSUPPORTED : 0);
        for (int i = 0; i < scene->nprimitives; i++)
            for (int face = 0; face < 6 && !steps; face++)
                assert_int_equal(scene->primitives[i].faces->of[face], face == 3 ? 0 : -1);
        target = flat;
        assert_int_equal(job_resolve_targets(scene, &render, &target, 1, &err), 0);
        assert_null(scene->primitives[k + 1].faces);
        assert_int_equal(scene->primitives[k].faces->of[3], 0);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flat_as_by_all_pairs),
        cmocka_unit_test(degenerate_and_folded),
        cmocka_unit_test(hits_have_the_targets_of_their_faces),
        cmocka_unit_test(levels_by_hand),
        cmocka_unit_test(first_selection_wins),
        cmocka_unit_test(levels_by_a_loop),
        cmocka_unit_test(levels_of_copies),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
