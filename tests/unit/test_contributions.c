/* Contributions of paths to the film of a set, hit by hit and light by light. */
#include "lib_test.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

#include "film/footprints/footprints.h"
#include "film/paper/paper.h"
#include "path/internal.h"
#include "path/path.h"

/* A film of one pixel and one path, whose target is called Floor. */
typedef struct Fixture {
    Scene scene;
    FilmParams params;
    PathContext context;
    PathWorker worker;
    Film *film;
    FilmPixel *pixel;
    RetexSet *set;
    Path path;
} Fixture;

static void begin_orders(Fixture *f, int paper, int orders)
{
    RetexError err = {0};
    const Ray ray = {{0, 0, 0}, {0, 0, 1}, 0, INFINITY};
    const Sampler sampler = {0};
    memset(f, 0, sizeof *f);
    f->scene.ntargets = 1;
    strcpy(f->scene.targets[0].name, "Floor");
    f->params = (FilmParams){.width = 1,
                             .height = 1,
                             .spp = 1,
                             .orders = orders,
                             .split = 1,
                             .ntiles = 1,
                             .layout = paper ? &paper_layout : &footprints_layout};
    f->params.clusters = 2, f->params.sharp = f->params.broad = 1;
    f->context = (PathContext){.scene = &f->scene, .max_depth = 16, .split = 1, .nvariants = 1, .exposure = 1};
    test_must(film_create(&f->film, &f->scene, &f->params, &err), &err);
    test_must(film_pixel_create(&f->pixel, f->film, &err), &err);
    f->worker.context = &f->context, f->worker.pixel = f->pixel;
    test_must(path_worker_open(&f->worker, &err), &err);
    f->path.control = f->worker.controls;
    path_start(&f->worker, &f->path, &ray, &sampler);
    f->path.sharp = 0;
}

static void begin(Fixture *f, int paper)
{
    begin_orders(f, paper, 6);
}

static void finish(Fixture *f)
{
    RetexError err = {0};
    PathResult result = {.hits = f->path.split.tree};
    memcpy(result.light, f->path.light, sizeof result.light);
    path_end(&f->worker, &result);
    path_worker_close(&f->worker);
    film_pixel_end(f->pixel, 0, 0);
    film_tile_end(f->pixel, 0);
    film_pixel_close(&f->pixel);
    test_must(retex_set_create(&f->set, 1, 1, &err), &err);
    test_must(retex_set_add_part(f->set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(film_finish(f->film, f->set, &err), &err);
}

static void end(Fixture *f)
{
    film_close(&f->film);
    retex_set_close(&f->set);
}

/* The floor, which reflects d times its albedo of 1/2. */
static Factor floor_factor(float d, double u)
{
    return (Factor){.d = splat(d), .i = splat(0), .albedo = splat(0.5f), .uv = {u, 0.25}, .reflects = 1};
}

static void bounce(Fixture *f, double u)
{
    const Shading floor = {.surface = {.target = 0}, .albedo = rgb_grey(0.5f), .uv = {u, 0.25}};
    assert_true(
        path_apply_factor(&f->worker, &f->path, &floor, (Split){rgb_grey(1), rgb_grey(0)}, NULL, NULL, NULL, 1));
}

static void bring(Fixture *f, float light)
{
    path_contribute(&f->worker, &f->path, &(Contribution){0, rgb_grey(light), NULL, 0, NULL});
}

/* Light by one more hit. */
static void connect_by_floor(Fixture *f, float light, double u)
{
    Factor factor = floor_factor(1, u);
    path_contribute(&f->worker, &f->path, &(Contribution){0, rgb_grey(light), &factor, 1, NULL});
}

static float red(const Fixture *f, const char *name)
{
    int k = retex_set_find_part(f->set, name);
    if (k < 0)
        fail_msg("there is no part %s", name);
    return f->set->parts[k].image.pixels[0];
}

/* Until the path bends; passing straight through a surface does not count. */
static void hits_know_whether_they_are_direct(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 0);
    for (int n = 0; n < 4; n++) {
        bounce(&f, 0.1 * n);
        assert_int_equal(f.path.split.tree.last->at.direct, n < 2);
        if (n == 0)
            f.path.straight++;
        else
            path_next_segment(&f.path, 0, 0);
    }
    finish(&f);
    end(&f);
}

static void light_behind_the_same_hits_is_one(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 0);
    bring(&f, 0.25f);
    bounce(&f, 0.5);
    bring(&f, 1), bring(&f, 2);
    finish(&f);
    assert_float_equal(red(&f, "beauty"), 0.25 + 0.5 * 3, 1e-6);
    assert_float_equal(red(&f, "indep"), 0.25, 1e-3);
    assert_float_equal(red(&f, "dep_Floor_broad1"), 3, 1e-3);
    assert_int_equal(film_dropped(f.film), 0);
    end(&f);
}

/* Light that comes before, between and after what is finite, behind the same hits; none of it takes that along. */
static void what_is_not_finite_is_dropped_alone(void **state)
{
    (void)state;
    const float bad[] = {INFINITY, -INFINITY, NAN};
    for (int round = 0; round < 24; round++) {
        Fixture f;
        float not_finite = bad[round % 3];
        int when = round / 3 % 4; /* of the path's four lights the one that is not finite comes before */
        begin(&f, round >= 12);
        for (int k = 0; k < 4; k++) {
            if (k == 2)
                bounce(&f, 0.5);
            if (k == when)
                bring(&f, not_finite);
            bring(&f, k < 2 ? 0.25f : 1);
        }
        finish(&f);
        assert_float_equal(red(&f, "beauty"), 2 * 0.25 + 2 * 0.5, 1e-6);
        if (round < 12) {
            assert_float_equal(red(&f, "indep"), 0.5, 1e-3);
            assert_float_equal(red(&f, "dep_Floor_broad1"), 2, 1e-3);
        }
        assert_int_equal(film_dropped(f.film), 1);
        end(&f);
    }
}

/* Two lights of which each is finite, and their sum is not: both stay. */
static void a_sum_that_overflows_is_not_made(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 0);
    bring(&f, 4e37f), bring(&f, 4e37f);
    finish(&f);
    assert_int_equal(film_dropped(f.film), 0);
    end(&f);
}

/* Light by one more hit, from where the path goes on: likewise. */
static void what_comes_by_a_hit_of_its_own_is_dropped_alone(void **state)
{
    (void)state;
    for (int bad_first = 0; bad_first < 2; bad_first++) {
        Fixture f;
        begin(&f, 0);
        connect_by_floor(&f, bad_first ? INFINITY : 1, 0.5);
        bounce(&f, 0.5);
        bring(&f, bad_first ? 1 : INFINITY);
        bring(&f, 2);
        finish(&f);
        assert_float_equal(red(&f, "beauty"), 0.5 * 3, 1e-6);
        assert_float_equal(red(&f, "dep_Floor_broad1"), 3, 2e-3);
        assert_int_equal(film_dropped(f.film), 1);
        end(&f);
    }
}

/* Hits beyond the last order keep their own colour, and how much light that is is counted. */
static void surplus_hits_fold(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++) {
        Fixture f;
        begin_orders(&f, paper, 2);
        bounce(&f, 0.25), bounce(&f, 0.5);
        bring(&f, 4);                   /* through 1/2 twice */
        connect_by_floor(&f, 16, 0.75); /* a third time */
        bounce(&f, 0.75);
        bring(&f, 24); /* likewise */
        finish(&f);
        assert_float_equal(red(&f, "beauty"), 1 + 2 + 3, 1e-5);
        if (!paper) {
            assert_float_equal(red(&f, "dep_Floor_broad_a1"), 4 + 8 + 12, 0.02);
            assert_float_equal(f.set->folded_white, (8.0 + 12) / (4 + 8 + 12), 1e-5);
        }
        assert_float_equal(f.set->folded, 5.0 / 6, 1e-5);
        end(&f);
    }
}

/* Light from a lamp behind a curtain: the floor and the curtain, both targets, and the path goes on without the latter.
 * Hits of one path that are more than there is room for fold likewise. */
static void light_passes_targets(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++) {
        Fixture f;
        begin(&f, paper);
        for (int k = 0; k < 2 * TARGET_NODES_MAX; k++)
            connect_by_floor(&f, 1, k / 1024.0);
        Factor factors[] = {floor_factor(1, 0.25), floor_factor(1, 0.75)};
        path_contribute(&f.worker, &f.path, &(Contribution){0, rgb_grey(4), factors, 2, NULL});
        bounce(&f, 0.25);
        bring(&f, 2);
        finish(&f);
        assert_float_equal(red(&f, "beauty"), TARGET_NODES_MAX + 1 + 1, 1e-3);
        assert_float_equal(f.set->folded, (0.5 * TARGET_NODES_MAX + 2) / (TARGET_NODES_MAX + 2), 1e-5);
        end(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(hits_know_whether_they_are_direct),
                                       cmocka_unit_test(light_behind_the_same_hits_is_one),
                                       cmocka_unit_test(what_is_not_finite_is_dropped_alone),
                                       cmocka_unit_test(a_sum_that_overflows_is_not_made),
                                       cmocka_unit_test(what_comes_by_a_hit_of_its_own_is_dropped_alone),
                                       cmocka_unit_test(surplus_hits_fold),
                                       cmocka_unit_test(light_passes_targets)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
