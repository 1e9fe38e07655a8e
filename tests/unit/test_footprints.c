/* Layout footprints, through the film: light paths made by hand, and what a pixel keeps of them. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "film/film.h"

#define SHARP 1
#define BROAD 0

static const double FINEST = 1.0 / (1 << 19); /* half of the finest step of mean UVs */

/* A film of two pixels side by side, of which most tests fill the left one. */
typedef struct Fixture {
    Scene scene;
    FilmParams params;
    Film *film;
    FilmPixel *pixel;
    RetexSet *set;
    PathHits hits; /* of the path in hand: a chain */
    PathHit room[PATH_HITS_MAX];
    Split split; /* of its last hit */
    Rgb value;   /* that the path carries with the original albedos */
    Rgb light;   /* that was connected */
} Fixture;

static void begin(Fixture *f, int ntargets, int spp, int orders, int sharp, int broad)
{
    static const char *const names[] = {"Floor", "Wall", "Lid", "Box", "Ball", "Rug", "Door", "Lamp"};
    *f = (Fixture){.scene = {.ntargets = ntargets}};
    for (int t = 0; t < ntargets; t++)
        snprintf(f->scene.targets[t].name, sizeof f->scene.targets[t].name, "%s", names[t]);
    f->params = (FilmParams){.width = 2, .height = 1, .spp = spp, .orders = orders, .split = 1, .ntiles = 1};
    f->params.clusters = sharp + broad, f->params.sharp = sharp, f->params.broad = broad;
}

static void open_film(Fixture *f)
{
    RetexError err = {0};
    test_must(film_create(&f->film, &f->scene, &f->params, &err), &err);
    test_must(film_pixel_create(&f->pixel, f->film, &err), &err);
}

static void begin_path(Fixture *f)
{
    f->hits = (PathHits){.last = NULL};
    f->value = rgb_grey(1);
}

static void end_path(Fixture *f)
{
    film_path_end(f->pixel, &f->hits);
}

static void split_hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp, Split split)
{
    const TargetHit hit = {{u, v}, albedo, (unsigned char)target, (unsigned char)sharp, 0};
    path_hits_add(&f->hits, &f->room[f->hits.count], &hit, f->hits.last, colour4(f->split.d), colour4(f->split.i));
    f->split = split;
    f->value = rgb_mul(f->value, split_apply(split, albedo));
}

/* One more hit, all of whose light the albedo multiplies. */
static void hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp)
{
    split_hit(f, target, u, v, albedo, sharp, (Split){rgb_grey(1), rgb_grey(0)});
}

/* Light behind the path's hits so far. */
static void connect_light(Fixture *f, Rgb light)
{
    Rgb beauty = rgb_mul(light, f->value);
    const double sum[3] = {(double)beauty.r, (double)beauty.g, (double)beauty.b};
    film_add_light(f->pixel, sum);
    if (f->hits.last)
        path_hit_shine(f->hits.last, colour4(f->split.d), colour4(f->split.i), colour4(light));
    else
        f->hits.free += colour4(light), f->hits.free_connections++;
    f->light = rgb_add(f->light, beauty);
}

/* A path of one hit that connects once. */
static void one_hit(Fixture *f, double u, double v, Rgb albedo, int sharp, Rgb light)
{
    begin_path(f);
    hit(f, 0, u, v, albedo, sharp);
    connect_light(f, light);
    end_path(f);
}

static void make_set(Fixture *f)
{
    RetexError err = {0};
    film_tile_end(f->pixel, 0);
    film_pixel_close(&f->pixel);
    test_must(retex_set_create(&f->set, 2, 1, &err), &err);
    test_must(retex_set_add_part(f->set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(film_finish(f->film, f->set, &err), &err);
}

static void finish(Fixture *f)
{
    film_pixel_end(f->pixel, 0, 0);
    film_pixel_end(f->pixel, 1, 0); /* without light */
    make_set(f);
}

static void end(Fixture *f)
{
    film_close(&f->film);
    retex_set_close(&f->set);
}

/* Values of a part in the left pixel. */
static const float *part(const Fixture *f, const char *name)
{
    int k = retex_set_find_part(f->set, name);
    if (k < 0)
        fail_msg("there is no part %s", name);
    return f->set->parts[k].image.pixels;
}

static const RetexFootprint *footprint(const Fixture *f, const char *uv)
{
    int k = retex_set_find_part(f->set, uv);
    for (int i = 0; i < f->set->nfootprints; i++)
        if (f->set->footprints[i].uv == k)
            return &f->set->footprints[i];
    fail_msg("there is no footprint %s", uv);
    return NULL;
}

static void expect_rgb(const float *got, float r, float g, float b, double tolerance)
{
    assert_float_equal(got[0], r, tolerance);
    assert_float_equal(got[1], g, tolerance);
    assert_float_equal(got[2], b, tolerance);
}

/* What no pixel has is left out of the set. */
static void assert_absent(const Fixture *f, const char *name)
{
    if (retex_set_find_part(f->set, name) >= 0)
        fail_msg("there is a part %s", name);
}

/* A factor with the footprints' own albedos. */
static double factor(const RetexSet *set, int number, size_t pixel, size_t channel)
{
    double sum = 0, weights = 0;
    if (number >= 0)
        return (double)set->parts[set->footprints[number].albedo].image.pixels[3 * pixel + channel];
    const RetexMixture *mixture = &set->mixtures[RETEX_MIXTURE(number)];
    for (int k = 0; k < mixture->nshares; k++) {
        double weight = (double)set->parts[mixture->shares[k].weight].image.pixels[pixel];
        weights += weight;
        sum += weight * factor(set, mixture->shares[k].footprint, pixel, channel);
    }
    return weights > 0 ? sum / weights : 0;
}

/* The polynomial with the footprints' own albedos, and with white textures: the largest channel, which is what
 * coefficients are rounded by. Every coefficient may be off by half a step. */
static double expect_beauty(const Fixture *f, size_t pixel)
{
    const RetexSet *set = f->set;
    double sum[3] = {0, 0, 0}, white[3] = {0, 0, 0}, largest = 0;
    for (int t = 0; t < set->nterms; t++)
        for (size_t c = 0; c < 3; c++) {
            double value = set->parts[set->terms[t].radiance].image.pixels[3 * pixel + c];
            assert_true(value >= 0);
            white[c] += value;
            for (int k = 0; k < set->terms[t].nfactors; k++)
                value *= factor(set, set->terms[t].factors[k], pixel, c);
            sum[c] += value;
        }
    for (size_t c = 0; c < 3; c++)
        largest = fmax(largest, white[c]);
    for (size_t c = 0; c < 3; c++) {
        double want = set->parts[0].image.pixels[3 * pixel + c];
        if (fabs(sum[c] - want) > (set->nterms * 0.5 / 8192 + 1e-5) * largest)
            fail_msg("pixel %zu, channel %zu: the terms give %g, not %g", pixel, c, sum[c], want);
    }
    return largest;
}

static void two_places_are_two_clusters(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 8, 6, 2, 1);
    open_film(&f);
    for (int k = 0; k < 8; k++)
        if (k % 4 == 3)
            one_hit(&f, 0.8, 0.9, rgb(0.1f, 0.2f, 0.9f), SHARP, rgb(4, 8, 16));
        else
            one_hit(&f, 0.125, 0.25, rgb(0.5f, 0.25f, 1), SHARP, rgb(1, 2, 3));
    finish(&f);
    const float *near = part(&f, "uv_Floor_sharp1"), *far = part(&f, "uv_Floor_sharp2");
    assert_true(near[0] == 0.125f && near[1] == 0.25f && fabsf(near[2] - 0.75f) < 1e-6f);
    assert_float_equal(far[0], 0.8f, FINEST);
    assert_float_equal(far[1], 0.9f, FINEST);
    assert_float_equal(far[2], 0.25f, 1e-6);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 0.75f, 1.5f, 2.25f, 1e-3);
    expect_rgb(part(&f, "dep_Floor_sharp2"), 1, 2, 4, 1e-3);
    expect_rgb(part(&f, "albedo_Floor_sharp1"), 0.5f, 0.25f, 1, 1e-6);
    expect_rgb(part(&f, "albedo_Floor_sharp2"), 0.1f, 0.2f, 0.9f, 1e-6);
    expect_rgb(part(&f, "spread_Floor_sharp1"), 0, 0, 0, 1e-7);
    expect_beauty(&f, 0);
    expect_beauty(&f, 1);
    end(&f);
}

static void what_is_not_needed_is_left_out(void **state)
{
    (void)state;
    static const char *const unused[] = {"sharp2", "sharp3", "broad1"};
    Fixture f;
    begin(&f, 1, 1, 6, 3, 1);
    open_film(&f);
    one_hit(&f, 0.5, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
    finish(&f);
    for (size_t k = 0; k < sizeof unused / sizeof unused[0]; k++) {
        char name[64];
        snprintf(name, sizeof name, "uv_Floor_%s", unused[k]);
        assert_int_equal(retex_set_find_part(f.set, name), -1);
        snprintf(name, sizeof name, "dep_Floor_%s", unused[k]);
        assert_int_equal(retex_set_find_part(f.set, name), -1);
    }
    assert_int_equal(retex_set_find_part(f.set, "dep_Floor_sharp_a1"), -1);
    assert_absent(&f, "uv_Floor_later1");
    /* the other pixel has no light, and nothing of this one */
    assert_true(part(&f, "uv_Floor_sharp1")[2] == 1 && part(&f, "uv_Floor_sharp1")[3 + 2] == 0);
    expect_rgb(part(&f, "dep_Floor_sharp1") + 3, 0, 0, 0, 0);
    expect_beauty(&f, 1);
    end(&f);
}

static void the_set_says_what_is_what(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 2, 3, 2, 1);
    open_film(&f);
    one_hit(&f, 2.5, -1, rgb(0.5f, 0.5f, 0.5f), SHARP, rgb_grey(1));
    one_hit(&f, 3.5, -2, rgb(0.25f, 0.5f, 1), BROAD, rgb_grey(1));
    finish(&f);
    assert_int_equal(f.set->ntargets, 1);
    assert_int_equal(f.set->orders, 3);
    assert_int_equal(f.set->nfootprints, 2);
    assert_int_equal(f.set->nterms, 1 + 2);
    static const char *const uvs[] = {"uv_Floor_sharp1", "uv_Floor_broad1"};
    static const RetexFootprintKind kinds[] = {RETEX_FOOTPRINT_SHARP, RETEX_FOOTPRINT_BROAD};
    static const int hits[] = {1, 3}; /* numbers of those that are not there stay free */
    for (int i = 0; i < 2; i++) {
        assert_ptr_equal(footprint(&f, uvs[i]), &f.set->footprints[i]);
        assert_int_equal(f.set->footprints[i].kind, kinds[i]);
        assert_int_equal(f.set->footprints[i].hit, hits[i]);
        assert_string_equal(f.set->parts[f.set->footprints[i].spread].letters, "RGB");
        assert_string_equal(f.set->parts[f.set->footprints[i].uv].letters, "RGA");
        assert_int_equal(f.set->parts[f.set->footprints[i].uv].type, RETEX_FLOAT);
    }
    assert_int_equal(f.set->terms[0].nfactors, 0);
    for (int t = 1; t < f.set->nterms; t++) {
        assert_int_equal(f.set->terms[t].nfactors, 1);
        assert_int_equal(f.set->terms[t].factors[0], t - 1);
    }
    const RetexTarget *target = &f.set->targets[0];
    assert_true(target->uv_min[0] == 2.5 && target->uv_max[0] == 3.5);
    assert_true(target->uv_min[1] == -2 && target->uv_max[1] == -1);
    expect_rgb(target->mean_albedo, 0.375f, 0.5f, 0.75f, 1e-6);
    /* what a render needs of memory, asked for before: about what a set holds */
    long floats = 0;
    for (int k = 0; k < f.set->nparts; k++)
        floats += f.set->parts[k].image.channels;
    assert_in_range(film_floats(&f.params, 1), floats / 3, 2 * floats);
    end(&f);
}

static void a_cluster_knows_its_spread(void **state)
{
    (void)state;
    enum { PATHS = 500 };
    Fixture f;
    uint32_t seed = 3;
    double weight = 0, squares = 0, mean[2] = {0, 0}, uv[PATHS][2], w[PATHS], m2[3] = {0, 0, 0};
    begin(&f, 1, PATHS, 6, 1, 1);
    open_film(&f);
    for (int k = 0; k < PATHS; k++) {
        uv[k][0] = 100 + 1e-3 * test_random(&seed);
        uv[k][1] = -50 + 2 * (uv[k][0] - 100) + 1e-3 * test_random(&seed);
        float light = (float)(0.1 + test_random(&seed));
        one_hit(&f, uv[k][0], uv[k][1], rgb_grey(0.3f), SHARP, rgb_grey(light));
        w[k] = light;
        weight += light, squares += (double)light * light;
    }
    for (int k = 0; k < PATHS; k++)
        for (int i = 0; i < 2; i++)
            mean[i] += w[k] / weight * uv[k][i];
    for (int k = 0; k < PATHS; k++) {
        double u = uv[k][0] - mean[0], v = uv[k][1] - mean[1];
        m2[0] += w[k] / weight * u * u, m2[1] += w[k] / weight * u * v, m2[2] += w[k] / weight * v * v;
    }
    finish(&f);
    const float *got = part(&f, "uv_Floor_sharp1"), *spread = part(&f, "spread_Floor_sharp1");
    double su = sqrt(m2[0]), sv = sqrt(m2[2]);
    assert_float_equal(got[2], weight * weight / squares / PATHS,
                       weight * weight / squares / PATHS / 256); /* effective paths */
    assert_true(fabs(got[0] - mean[0]) <= su / 64 + 1e-5);       /* rounded; float has steps of 8e-6 there */
    assert_true(fabs(got[1] - mean[1]) <= sv / 64 + 1e-5);
    assert_float_equal(spread[0], su, su / 128);
    assert_float_equal(spread[1], sv, sv / 128);
    assert_float_equal(spread[2], m2[1] / (su * sv), 1.0 / 128);
    end(&f);
}

static void the_nearest_places_merge(void **state)
{
    (void)state;
    static const double places[3] = {0.1, 0.12, 0.9};
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int k = 0; k < 6; k++) {
        Fixture f;
        begin(&f, 1, 4, 6, 2, 1);
        open_film(&f);
        for (int i = 0; i < 3; i++) {
            int place = orders[k][i];
            one_hit(&f, places[place], 0.5, rgb_grey(0.2f * (float)(place + 1)), SHARP, rgb_grey(place ? 1 : 3));
        }
        finish(&f);
        const float *near = part(&f, "uv_Floor_sharp1"), *far = part(&f, "uv_Floor_sharp2");
        double sd = 0.02 * sqrt(3) / 4; /* of weights 3 and 1 */
        assert_float_equal(near[0], 0.105, sd / 64 + FINEST);
        assert_float_equal(near[1], 0.5, 1e-6);
        assert_float_equal(near[2], 16.0 / 10 / 4, 0.4 / 256); /* weights 3 and 1 */
        assert_float_equal(part(&f, "spread_Floor_sharp1")[0], sd, sd / 128);
        assert_float_equal(far[0], 0.9, FINEST);
        assert_float_equal(far[2], 0.25, 0);
        expect_rgb(part(&f, "dep_Floor_sharp1"), 1, 1, 1, 1e-3);
        expect_rgb(part(&f, "dep_Floor_sharp2"), 0.25f, 0.25f, 0.25f, 1e-3);
        expect_rgb(part(&f, "albedo_Floor_sharp1"), 0.25f, 0.25f, 0.25f, 1e-6);
        expect_beauty(&f, 0);
        end(&f);
    }
}

/* Not even at the same place, and not where there are more than there is room for. */
static void sharp_and_broad_stay_apart(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 8, 6, 1, 1);
    open_film(&f);
    for (int k = 0; k < 4; k++) {
        one_hit(&f, 0.25, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(8));
        one_hit(&f, 0.25 + 0.5 * (k % 2), 0.5, rgb_grey(0.25f), BROAD, rgb_grey(2));
    }
    finish(&f);
    assert_true(part(&f, "uv_Floor_sharp1")[0] == 0.25f && fabsf(part(&f, "uv_Floor_sharp1")[2] - 0.5f) < 1e-6f);
    assert_float_equal(part(&f, "uv_Floor_broad1")[0], 0.5f, 0.25 / 64);
    assert_float_equal(part(&f, "spread_Floor_broad1")[0], 0.25f, 1e-6);
    assert_float_equal(part(&f, "uv_Floor_broad1")[2], 0.5f, 1e-6);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 4, 4, 4, 2e-3);
    expect_rgb(part(&f, "dep_Floor_broad1"), 1, 1, 1, 2e-3);
    end(&f);
}

static void further_hits_come_later(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 2, 6, 2, 1);
    open_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.25, rgb_grey(0.5f), SHARP);
    hit(&f, 0, 0.75, 0.5, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(4));
    hit(&f, 0, 0.25, 0, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(8));
    end_path(&f);
    finish(&f);
    assert_absent(&f, "dep_Floor_sharp1");
    expect_rgb(part(&f, "dep_Floor_sharp_a1"), 2, 2, 2, 1e-3);
    expect_rgb(part(&f, "dep_Floor_sharp_a2"), 4, 4, 4, 1e-3);
    assert_absent(&f, "dep_Floor_sharp_a3");
    const float *first = part(&f, "uv_Floor_sharp1"), *later = part(&f, "uv_Floor_later1");
    assert_true(first[0] == 0.25f && first[1] == 0.25f && first[2] == 0.5f); /* one path, however often it connects */
    assert_absent(&f, "uv_Floor_broad1");
    assert_absent(&f, "uv_Floor_sharp2");
    assert_true(later[0] == 0.75f && later[1] == 0.5f);
    expect_rgb(part(&f, "uv_Floor_later2"), 0.25f, 0, 0.5f, 1e-6);        /* one connection of two paths */
    assert_float_equal(part(&f, "share_Floor_later1")[0], 2.0 / 3, 2e-3); /* of the light: 1 + 1 of 3 */
    expect_rgb(part(&f, "albedo_Floor_later1"), 0.5f, 0.5f, 0.5f, 1e-6);
    assert_true(f.set->folded == 0);
    expect_beauty(&f, 0);
    end(&f);
}

/* A monomial goes by its own first hit, which need not be its path's. */
static void monomials_go_their_own_ways(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 1, 6, 2, 1);
    open_film(&f);
    begin_path(&f);
    split_hit(&f, 0, 0.25, 0, rgb_grey(1), SHARP, (Split){rgb_grey(0.5f), rgb_grey(0.25f)});
    split_hit(&f, 0, 0.75, 0, rgb_grey(0.5f), BROAD, (Split){rgb_grey(0.5f), rgb_grey(0.125f)});
    connect_light(&f, rgb_grey(32));
    end_path(&f);
    finish(&f);
    expect_rgb(part(&f, "indep"), 1, 1, 1, 1e-6);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 2, 2, 2, 2e-3);
    expect_rgb(part(&f, "dep_Floor_broad1"), 4, 4, 4, 2e-3);
    expect_rgb(part(&f, "dep_Floor_sharp_a1"), 8, 8, 8, 2e-3);
    assert_true(part(&f, "uv_Floor_sharp1")[0] == 0.25f && part(&f, "uv_Floor_broad1")[0] == 0.75f);
    assert_true(part(&f, "uv_Floor_later1")[0] == 0.75f);
    expect_beauty(&f, 0);
    end(&f);
}

/* Also where both hits are at the same place. */
static void one_place_may_be_met_twice(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 1, 6, 2, 1);
    open_film(&f);
    begin_path(&f);
    for (int sharp = SHARP; sharp >= BROAD; sharp--)
        split_hit(&f, 0, 0.25, 0, rgb_grey(1), sharp, (Split){rgb_grey(0.5f), rgb_grey(0.5f)});
    connect_light(&f, rgb_grey(4));
    end_path(&f);
    finish(&f);
    static const char *const parts[] = {"indep", "dep_Floor_sharp1", "dep_Floor_broad1", "dep_Floor_sharp_a1"};
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++)
        expect_rgb(part(&f, parts[k]), 1, 1, 1, 1e-3);
    end(&f);
}

/* Coefficients are rounded to the nearest step, a power of two of about 1/8192 of the white pixel. */
static void steps_are_rounded_to(void **state)
{
    (void)state;
    static const double steps[] = {0.2, 0.8, 4.6};
    for (size_t k = 0; k < sizeof steps / sizeof steps[0]; k++) {
        Fixture f;
        float value = (float)(0.5 + steps[k] / 8192);
        begin(&f, 1, 1, 6, 1, 1);
        open_film(&f);
        begin_path(&f);
        connect_light(&f, rgb(1 - value, 0, 0));
        end_path(&f);
        one_hit(&f, 0.5, 0.5, rgb_grey(0.5f), SHARP, rgb(value, 1.0f / 1024 - 1e-6f, 0));
        finish(&f);
        expect_rgb(part(&f, "dep_Floor_sharp1"), (float)(0.5 + rint(steps[k]) / 8192), 1.0f / 1024, 0, 0);
        expect_rgb(part(&f, "indep"), 1 - value, 0, 0, 0); /* of which there is one only: as it is */
        end(&f);
    }
}

/* Clusters, later hits and albedos of one pixel are not in the next. */
static void pixels_do_not_mix(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 1, 6, 1, 1);
    open_film(&f);
    for (int x = 1; x >= 0; x--) {
        begin_path(&f);
        hit(&f, 0, 0.25 + 0.5 * x, 0.5, rgb_grey(0.25f + 0.5f * (float)x), SHARP);
        connect_light(&f, rgb_grey(2));
        hit(&f, 0, 0.125 + 0.5 * x, 0.5, rgb_grey(0.125f + 0.5f * (float)x), BROAD);
        connect_light(&f, rgb_grey(2));
        end_path(&f);
        film_pixel_end(f.pixel, x, 0);
    }
    make_set(&f);
    for (int x = 0; x < 2; x++) {
        float at = 0.5f * (float)x;
        expect_rgb(part(&f, "uv_Floor_sharp1") + 3 * x, 0.25f + at, 0.5f, 1, 0);
        expect_rgb(part(&f, "uv_Floor_later1") + 3 * x, 0.125f + at, 0.5f, 1, 0);
        expect_rgb(part(&f, "albedo_Floor_sharp1") + 3 * x, 0.25f + at, 0.25f + at, 0.25f + at, 1e-6);
        expect_rgb(part(&f, "albedo_Floor_later1") + 3 * x, 0.125f + at, 0.125f + at, 0.125f + at, 1e-6);
        expect_beauty(&f, (size_t)x);
    }
    end(&f);
}

/* Clusters of varying albedo, several hits of targets that each have one colour, light that meets none: it all adds up
 * to the picture. */
static void the_terms_add_up(void **state)
{
    (void)state;
    for (uint32_t round = 1; round <= 12; round++) {
        enum { SPP = 300 };
        Fixture f;
        uint32_t seed = round;
        int targets = 1 + (int)round % 3, hits = round < 7 ? 1 : 4;
        begin(&f, targets, SPP, 6, 1 + (int)round % 4, 1 + (int)round % 2);
        open_film(&f);
        for (int k = 0; k < SPP; k++) {
            begin_path(&f);
            for (int n = (int)(test_random(&seed) * (hits + 1)); n > 0; n--) {
                int t = (int)(test_random(&seed) * targets);
                float level = hits == 1 ? (float)test_random(&seed) : 0.3f + 0.2f * (float)t;
                Split split = {rgb_grey((float)test_random(&seed)), rgb_grey(0)};
                if (test_random(&seed) < 0.5)
                    split.i = rgb_grey((float)test_random(&seed));
                Vec2 uv = {test_random(&seed), test_random(&seed)};
                split_hit(&f, t, uv.u, uv.v, rgb(level, 0.5f * level, 1 - level), test_random(&seed) < 0.5, split);
            }
            connect_light(&f, rgb((float)test_random(&seed), (float)test_random(&seed), 1));
            end_path(&f);
        }
        Rgb light = f.light;
        finish(&f);
        expect_rgb(f.set->parts[0].image.pixels, light.r / SPP, light.g / SPP, light.b / SPP, 1e-4);
        assert_true(expect_beauty(&f, 0) > 0.1);
        assert_true(f.set->folded == 0);
        end(&f);
    }
}

static void a_seam_is_one_place(void **state)
{
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        Fixture f;
        begin(&f, 1, 2, 6, 1, 1);
        f.params.periodic[0][0] = closed;
        open_film(&f);
        one_hit(&f, 0.99, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
        one_hit(&f, 0.01, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
        finish(&f);
        const float u = part(&f, "uv_Floor_sharp1")[0], sd = part(&f, "spread_Floor_sharp1")[0];
        assert_float_equal(sd, closed ? 0.01f : 0.49f, (closed ? 0.01 : 0.49) / 128);
        assert_true(closed ? fabsf(u - rintf(u)) < 0.001f : fabsf(u - 0.5f) < 0.01f);
        end(&f);
    }
}

/* Places that are black in the original are found all the same, and may become bright. */
static void black_albedo_has_footprints(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 2, 6, 3, 1);
    open_film(&f);
    one_hit(&f, 0.25, 0.75, rgb_grey(0), SHARP, rgb(1, 2, 4));
    begin_path(&f);
    hit(&f, 0, 0.5, 0.75, rgb_grey(0), BROAD);
    hit(&f, 0, 0.125, 0.5, rgb_grey(0), BROAD);
    connect_light(&f, rgb_grey(2));
    end_path(&f);
    finish(&f);
    const float *sharp = part(&f, "uv_Floor_sharp1"), *later = part(&f, "uv_Floor_later1");
    assert_true(sharp[0] == 0.25f && sharp[1] == 0.75f && sharp[2] == 0.5f);
    assert_true(part(&f, "uv_Floor_broad1")[0] == 0.5f && part(&f, "uv_Floor_broad1")[2] == 0.5f);
    assert_true(later[0] == 0.125f && later[1] == 0.5f && later[2] == 0.5f);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 0.5f, 1, 2, 1e-3);
    expect_rgb(part(&f, "dep_Floor_broad_a1"), 1, 1, 1, 1e-3);
    static const char *const albedos[] = {"albedo_Floor_sharp1", "albedo_Floor_broad1", "albedo_Floor_later1"};
    for (size_t k = 0; k < 3; k++)
        expect_rgb(part(&f, albedos[k]), 0, 0, 0, 0);
    expect_rgb(f.set->parts[0].image.pixels, 0, 0, 0, 0);
    expect_beauty(&f, 0);
    end(&f);
}

static void targets_follow_each_other(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 2, 2, 6, 2, 1);
    open_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.5, rgb_grey(0.5f), SHARP);
    hit(&f, 1, 0.125, 0.5, rgb_grey(0.25f), BROAD);
    connect_light(&f, rgb_grey(2));
    hit(&f, 0, 0.75, 0.5, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(4));
    end_path(&f);
    begin_path(&f);
    hit(&f, 1, 0.375, 0.5, rgb_grey(0.25f), SHARP);
    connect_light(&f, rgb_grey(6));
    for (int k = 0; k < 5; k++)
        hit(&f, 1, 0.125, 0.5, rgb_grey(0.25f), BROAD);
    connect_light(&f, rgb_grey(4096)); /* five hits later are too many to be kept in combinations */
    end_path(&f);
    finish(&f);
    expect_rgb(part(&f, "dep_Floor_sharp_b1"), 1, 1, 1, 0.3);
    expect_rgb(part(&f, "dep_Floor_sharp_a1b1"), 2, 2, 2, 0.3);
    assert_absent(&f, "dep_Floor_sharp_m5");
    expect_rgb(part(&f, "dep_Wall_sharp1"), 3, 3, 3, 0.3);
    assert_int_equal(retex_set_find_part(f.set, "dep_Wall_sharp_b5"), -1);
    assert_absent(&f, "dep_Wall_sharp_b4");
    expect_rgb(part(&f, "dep_Wall_sharp_m5"), 2048, 2048, 2048, 0.3);
    const RetexTerm *term = NULL;
    for (int t = 0; t < f.set->nterms; t++)
        if (f.set->terms[t].radiance == retex_set_find_part(f.set, "dep_Floor_sharp_a1b1"))
            term = &f.set->terms[t];
    assert_non_null(term);
    assert_int_equal(term->nfactors, 3);
    assert_ptr_equal(&f.set->footprints[term->factors[0]], footprint(&f, "uv_Floor_sharp1"));
    assert_ptr_equal(&f.set->footprints[term->factors[1]], footprint(&f, "uv_Floor_later1"));
    assert_ptr_equal(&f.set->footprints[term->factors[2]], footprint(&f, "uv_Wall_later1"));
    assert_true(part(&f, "uv_Floor_later1")[0] == 0.75f && part(&f, "uv_Wall_later1")[0] == 0.125f);
    assert_true(part(&f, "uv_Wall_sharp1")[0] == 0.375f);
    assert_true(f.set->targets[1].uv_max[0] == 0.375);
    assert_true(f.set->folded == 0 && f.set->folded_white == 0);
    expect_beauty(&f, 0);
    end(&f);
}

/* Shares tell how much light each place has of what is mixed; they add up to 1. */
static void shares_add_up(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 2, 2, 6, 2, 1);
    open_film(&f);
    for (int n = 0; n < 2; n++) {
        begin_path(&f);
        hit(&f, 1, 0.25 + 0.5 * n, 0.5, rgb_grey(0.5f), SHARP);
        connect_light(&f, rgb_grey(2));
        for (int k = 0; k < 5 + n; k++)
            hit(&f, k == 0 ? 0 : 1, k < 2 ? 0.5 : 0.125, 0.5, rgb_grey(0.5f), BROAD);
        connect_light(&f, rgb_grey(n ? 192 : 32)); /* which is 3 and 1 without the first hit, for albedos of 0.5 */
        end_path(&f);
    }
    finish(&f);
    assert_int_equal(f.set->nmixtures, 3); /* the wall's sharp clusters, its further hits, and those of both targets */
    double all = 0;
    static const char *const shares[] = {"share_Floor_later1", "share_Wall_later1", "share_Wall_later2"};
    for (size_t k = 0; k < 3; k++)
        all += part(&f, shares[k])[0];
    assert_float_equal(all, 1, 4e-3);
    assert_float_equal(part(&f, "share_Floor_later1")[0], (1.0 + 3) / (5 * 1 + 6 * 3), 2e-3);
    assert_float_equal(part(&f, "share_Wall_sharp1")[0], 0.25, 2e-3);
    assert_float_equal(part(&f, "share_Wall_sharp2")[0], 0.75, 2e-3);
    assert_true(part(&f, "share_Wall_sharp1")[1] == 0);
    expect_rgb(part(&f, "dep_Wall_sharp_m5"), 16, 16, 16, 0.2);
    expect_rgb(part(&f, "dep_Wall_sharp_m6"), 96, 96, 96, 0.2);
    for (int t = 0; t < f.set->nterms; t++) {
        const RetexTerm *term = &f.set->terms[t];
        if (term->radiance != retex_set_find_part(f.set, "dep_Wall_sharp_m6"))
            continue;
        assert_int_equal(term->nfactors, 7);
        assert_int_equal(f.set->mixtures[RETEX_MIXTURE(term->factors[0])].nshares, 2);
        assert_int_equal(f.set->mixtures[RETEX_MIXTURE(term->factors[1])].nshares, 3);
    }
    expect_beauty(&f, 0);
    end(&f);
}

/* What one target's albedo is does not depend on another that is black: that one may be edited. */
static void a_black_target_hides_no_other(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 2, 2, 6, 1, 1);
    open_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.5, rgb_grey(0), SHARP);
    hit(&f, 1, 0.75, 0.5, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(8));
    end_path(&f);
    begin_path(&f);
    hit(&f, 1, 0.25, 0.5, rgb(0.5f, 0.25f, 1), SHARP);
    hit(&f, 0, 0.75, 0.5, rgb_grey(0), BROAD);
    hit(&f, 0, 0.75, 0.5, rgb_grey(0), BROAD);
    connect_light(&f, rgb_grey(2));
    end_path(&f);
    finish(&f);
    expect_rgb(f.set->parts[0].image.pixels, 0, 0, 0, 0);
    expect_rgb(part(&f, "dep_Floor_sharp_b1"), 4, 4, 4, 1e-3);
    expect_rgb(part(&f, "albedo_Wall_later1"), 0.5f, 0.5f, 0.5f, 1e-6);
    expect_rgb(part(&f, "dep_Wall_sharp_a2"), 1, 1, 1, 1e-3);
    expect_rgb(part(&f, "albedo_Wall_sharp1"), 0.5f, 0.25f, 1, 1e-6);
    expect_rgb(part(&f, "albedo_Floor_sharp1"), 0, 0, 0, 0);
    expect_rgb(part(&f, "albedo_Floor_later1"), 0, 0, 0, 0);
    expect_beauty(&f, 0);
    end(&f);
}

/* How much light is folded, as it is and with white targets: what the original's black hides counts there too. */
static void folded_light_is_counted_as_white(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 4, 2, 2, 1);
    open_film(&f);
    one_hit(&f, 0.75, 0.5, rgb_grey(0), SHARP, rgb_grey(10));
    film_add_folded(f.pixel, rgb_grey(0), rgb_grey(10 * 0.8f));
    one_hit(&f, 0.25, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(4));
    begin_path(&f);
    connect_light(&f, rgb_grey(2));
    end_path(&f);
    begin_path(&f);
    for (int k = 0; k < 2; k++)
        hit(&f, 0, 0.25, 0.5, rgb_grey(0.5f), k ? BROAD : SHARP);
    connect_light(&f, rgb_grey(5));
    film_add_folded(f.pixel, rgb_grey(1.25f), rgb_grey(5 * 0.8f * 0.8f));
    end_path(&f);
    finish(&f);
    double hidden = 10 * 0.8, known = 5 * 0.8 * 0.8;
    assert_float_equal(f.set->folded_white, (hidden + known) / (hidden + known + 4 * 0.8 + 2), 1e-6);
    assert_float_equal(f.set->folded, 1.25 / (1.25 + 2 + 2), 1e-6);
    expect_beauty(&f, 0);
    end(&f);
}

/* A shadow ray may pass targets behind a hit that the path goes on from elsewhere: hits are a tree. */
static void hits_are_a_tree(void **state)
{
    (void)state;
    Fixture f;
    const Split both = {rgb_grey(0.5f), rgb_grey(0.25f)};
    begin(&f, 2, 1, 6, 2, 1);
    open_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.5, rgb_grey(0.5f), SHARP);
    PathHit *floor = f.hits.last;
    f.split = both; /* of the light picked there, through the wall */
    hit(&f, 1, 0.5, 0.5, rgb_grey(0.5f), BROAD);
    path_hit_shine(f.hits.last, splat(1), splat(0), splat(16));
    const TargetHit wall = {{0.75, 0.5}, rgb_grey(0.5f), 1, BROAD, 0}; /* to which the path goes on elsewhere */
    PathHit *last = path_hits_add(&f.hits, &f.room[2], &wall, floor, splat(1), splat(0));
    path_hit_shine(last, splat(1), splat(0), splat(4));
    const double beauty = 16 * 0.5 * (0.5 * 0.5 + 0.25) + 4 * 0.5 * 0.5;
    film_add_light(f.pixel, (double[3]){beauty, beauty, beauty});
    end_path(&f);
    finish(&f);
    expect_rgb(part(&f, "dep_Floor_sharp_b1"), 8 + 4, 12, 12, 1e-2);
    expect_rgb(part(&f, "dep_Wall_broad1"), 4, 4, 4, 1e-2);
    assert_absent(&f, "dep_Floor_sharp1");
    assert_true(part(&f, "uv_Wall_broad1")[0] == 0.5f);
    assert_true(part(&f, "uv_Wall_later1")[0] == 0.5f && part(&f, "uv_Wall_later2")[0] == 0.75f);
    assert_float_equal(part(&f, "share_Wall_later1")[0], 2.0 / 3, 2e-3); /* 4 and 2 through the floor's 1/2 */
    expect_beauty(&f, 0);
    end(&f);
}

/* Of either kind a pixel may have all clusters; params.clusters is how many of both together. */
static void begin_shared(Fixture *f, int ntargets, int spp, int orders, int clusters)
{
    begin(f, ntargets, spp, orders, clusters, clusters);
    f->params.clusters = clusters;
}

static int has_cluster(const Fixture *f, const char *kind, int number)
{
    char name[RETEX_NAME_MAX];
    snprintf(name, sizeof name, "uv_Floor_%s%d", kind, number);
    int k = retex_set_find_part(f->set, name);
    return k >= 0 && f->set->parts[k].image.pixels[2] > 0;
}

/* How many clusters of a kind the left pixel has: the first slots, and none behind them. */
static int count_clusters(const Fixture *f, const char *kind)
{
    int count = 0;
    while (has_cluster(f, kind, count + 1))
        count++;
    for (int k = count + 1; k <= FILM_CLUSTERS_MAX; k++)
        assert_false(has_cluster(f, kind, k));
    return count;
}

static void expect_place(const Fixture *f, const char *name, double u, double sd)
{
    char uv[RETEX_NAME_MAX], spread[RETEX_NAME_MAX];
    snprintf(uv, sizeof uv, "uv_%s", name);
    snprintf(spread, sizeof spread, "spread_%s", name);
    assert_float_equal(part(f, uv)[0], u, sd / 64 + FINEST + 1e-6 * fabs(u));
    assert_float_equal(part(f, spread)[0], sd, fmax(sd / 128, 1e-5));
}

/* What nothing sharp needs, broad light has; and the other way about. */
static void either_kind_may_have_all(void **state)
{
    (void)state;
    static const double places[4] = {0.1, 0.12, 0.5, 0.9};
    for (int sharp = 0; sharp < 2; sharp++) {
        Fixture f;
        begin_shared(&f, 1, 8, 6, 4);
        open_film(&f);
        for (int k = 0; k < 8; k++)
            one_hit(&f, places[k % 4], 0.5, rgb_grey(0.5f), sharp, rgb_grey(1));
        finish(&f);
        assert_int_equal(count_clusters(&f, "sharp"), sharp ? 4 : 0);
        assert_int_equal(count_clusters(&f, "broad"), sharp ? 0 : 4);
        for (int k = 0; k < 4; k++) {
            char name[32];
            snprintf(name, sizeof name, "Floor_%s%d", sharp ? "sharp" : "broad", k + 1);
            expect_place(&f, name, places[k], 0);
        }
        expect_beauty(&f, 0);
        end(&f);
    }
}

/* Where one of the other kind comes last, or came first, the cheapest pair makes room for it. */
static void kinds_make_room_for_each_other(void **state)
{
    (void)state;
    static const double places[4] = {0.1, 0.12, 0.5, 0.9};
    for (int round = 0; round < 10; round++) {
        int sharp = round % 2, at = round / 2; /* when the odd one comes */
        Fixture f;
        begin_shared(&f, 1, 5, 6, 4);
        open_film(&f);
        for (int k = 0; k < 5; k++)
            if (k == at)
                one_hit(&f, 0.11, 0.5, rgb_grey(0.5f), !sharp, rgb_grey(1));
            else
                one_hit(&f, places[k - (k > at)], 0.5, rgb_grey(0.25f), sharp, rgb_grey(1));
        finish(&f);
        assert_int_equal(count_clusters(&f, "sharp"), sharp ? 3 : 1);
        assert_int_equal(count_clusters(&f, "broad"), sharp ? 1 : 3);
        expect_place(&f, sharp ? "Floor_sharp1" : "Floor_broad1", 0.11, 0.01);
        expect_place(&f, sharp ? "Floor_sharp2" : "Floor_broad2", 0.5, 0);
        expect_place(&f, sharp ? "Floor_sharp3" : "Floor_broad3", 0.9, 0);
        expect_place(&f, sharp ? "Floor_broad1" : "Floor_sharp1", 0.11, 0);
        expect_rgb(part(&f, sharp ? "dep_Floor_sharp1" : "dep_Floor_broad1"), 0.4f, 0.4f, 0.4f, 1e-3);
        expect_rgb(part(&f, sharp ? "dep_Floor_broad1" : "dep_Floor_sharp1"), 0.2f, 0.2f, 0.2f, 1e-3);
        expect_beauty(&f, 0);
        end(&f);
    }
}

/* Of many places in any order: as many clusters as there may be, and of each kind some where there was light of it. */
static void no_more_than_there_may_be(void **state)
{
    (void)state;
    static const int allowed[][3] = {{4, 4, 4}, {2, 2, 2}, {16, 16, 16}, {3, 2, 1}, {4, 1, 3}, {16, 12, 4}, {2, 1, 1}};
    enum { PATHS = 200 };
    for (uint32_t round = 0; round < 4 * sizeof allowed / sizeof allowed[0]; round++) {
        const int *most = allowed[round / 4];
        uint32_t seed = round + 1;
        Fixture f;
        begin(&f, 1, PATHS, 6, most[1], most[2]);
        f.params.clusters = most[0];
        open_film(&f);
        for (int k = 0; k < PATHS; k++) {
            int sharp = round % 4 == 0   ? k % 2
                        : round % 4 == 1 ? k < PATHS / 2
                        : round % 4 == 2 ? k >= PATHS / 2
                                         : k == 77;
            one_hit(&f, test_random(&seed), 100 * pow(test_random(&seed), 8), rgb_grey(0.5f), sharp,
                    rgb_grey((float)test_random(&seed)));
        }
        finish(&f);
        int sharp = count_clusters(&f, "sharp"), broad = count_clusters(&f, "broad");
        assert_in_range(sharp, 1, most[1]);
        assert_in_range(broad, 1, most[2]);
        assert_int_equal(sharp + broad, round % 4 == 3 && most[1] < most[0] ? 1 + most[2] : most[0]);
        assert_true(expect_beauty(&f, 0) > 0.1);
        end(&f);
    }
}

/* A little broad light from far off, as on a plane to the horizon, leaves the near places their clusters; sharp light
 * is merged by the squares of distances. */
static void far_points_claim_no_clusters(void **state)
{
    (void)state;
    static const double near[3] = {0.1, 0.6, 1.2}, far[3] = {100, -2000, 50000};
    for (int first = 0; first < 2; first++)
        for (int sharp = 0; sharp < 2; sharp++) {
            Fixture f;
            begin_shared(&f, 1, 6, 6, 4);
            open_film(&f);
            for (int k = 0; k < 6; k++)
                if ((k < 3) == first)
                    one_hit(&f, far[k % 3], 0.5, rgb_grey(0.5f), sharp, rgb_grey(1));
                else
                    one_hit(&f, near[k % 3], 0.5, rgb_grey(0.5f), sharp, rgb_grey(10));
            finish(&f);
            int apart = 0; /* near places that are as they were */
            for (int k = 1; k <= 4; k++) {
                char name[32];
                snprintf(name, sizeof name, "uv_Floor_%s%d", sharp ? "sharp" : "broad", k);
                for (int i = 0; i < 3; i++)
                    apart += fabs(part(&f, name)[0] - near[i]) <= FINEST;
            }
            assert_int_equal(apart, sharp ? 0 : 3);
            expect_beauty(&f, 0);
            end(&f);
        }
}

/* A path whose first hit is always the same, and whose further one is there. */
static void later_hit(Fixture *f, double u, float light)
{
    begin_path(f);
    hit(f, 0, 0.5, 0.5, rgb_grey(0.5f), SHARP);
    hit(f, 0, u, 0.5, rgb_grey(0.5f), BROAD);
    connect_light(f, rgb_grey(light));
    end_path(f);
}

/* Further hits are pooled into two places; what is far off alone does not draw the other there. */
static void further_hits_have_two_places(void **state)
{
    (void)state;
    static const struct {
        int count;
        double u[4];
        float light[4];
        double mean[2], sd[2], share;
    } cases[] = {
        {2, {0.25, 0.75}, {1, 3}, {0.25, 0.75}, {0, 0}, 0.25},
        {3, {0.25, 9, 0.375}, {1, 1, 1}, {0.3125, 9}, {0.0625, 0}, 2.0 / 3},
        {3, {9, 0.25, 0.375}, {2, 1, 1}, {9, 0.3125}, {0, 0.0625}, 0.5},
        {3, {0.25, 0.375, 1000}, {1, 1, 2}, {0.3125, 1000}, {0.0625, 0}, 0.5},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Fixture f;
        begin(&f, 1, cases[k].count, 6, 2, 1);
        open_film(&f);
        for (int i = 0; i < cases[k].count; i++)
            later_hit(&f, cases[k].u[i], cases[k].light[i]);
        finish(&f);
        expect_place(&f, "Floor_later1", cases[k].mean[0], cases[k].sd[0]);
        expect_place(&f, "Floor_later2", cases[k].mean[1], cases[k].sd[1]);
        assert_float_equal(part(&f, "share_Floor_later1")[0], cases[k].share, 2e-3);
        expect_beauty(&f, 0);
        end(&f);
    }
}

/* Before anything is rendered, and by what the set may need at most. */
static void too_many_parts_are_refused(void **state)
{
    (void)state;
    static const struct {
        int ntargets, clusters, sharp, broad, code;
    } cases[] = {
        {1, 16, 16, 16, RETEX_OK}, {4, 16, 16, 16, RETEX_OK}, {8, 4, 4, 4, RETEX_OK},
        {8, 8, 8, 8, RETEX_OK},    {8, 16, 12, 4, RETEX_OK},  {8, 16, 16, 16, RETEX_ELIMIT},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Fixture f;
        RetexError err = {0};
        begin(&f, cases[k].ntargets, 1, 6, cases[k].sharp, cases[k].broad);
        f.params.clusters = cases[k].clusters;
        assert_int_equal(film_create(&f.film, &f.scene, &f.params, &err), cases[k].code);
        assert_true(!cases[k].code || strstr(err.message, "more than 1490"));
        end(&f);
    }
}

static void a_plain_film_keeps_the_beauty(void **state)
{
    (void)state;
    Fixture f;
    begin(&f, 1, 2, 6, 3, 1);
    f.params.split = 0;
    open_film(&f);
    one_hit(&f, 0.5, 0.5, rgb_grey(0.5f), SHARP, rgb(4, 8, 12));
    finish(&f);
    expect_rgb(f.set->parts[0].image.pixels, 1, 2, 3, 0);
    assert_true(f.set->nparts == 1 && f.set->ntargets == 0 && f.set->nterms == 0);
    assert_int_equal(film_floats(&f.params, 1), 3);
    end(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_places_are_two_clusters),
        cmocka_unit_test(what_is_not_needed_is_left_out),
        cmocka_unit_test(the_set_says_what_is_what),
        cmocka_unit_test(a_cluster_knows_its_spread),
        cmocka_unit_test(the_nearest_places_merge),
        cmocka_unit_test(sharp_and_broad_stay_apart),
        cmocka_unit_test(further_hits_come_later),
        cmocka_unit_test(monomials_go_their_own_ways),
        cmocka_unit_test(one_place_may_be_met_twice),
        cmocka_unit_test(steps_are_rounded_to),
        cmocka_unit_test(pixels_do_not_mix),
        cmocka_unit_test(the_terms_add_up),
        cmocka_unit_test(a_seam_is_one_place),
        cmocka_unit_test(black_albedo_has_footprints),
        cmocka_unit_test(hits_are_a_tree),
        cmocka_unit_test(targets_follow_each_other),
        cmocka_unit_test(shares_add_up),
        cmocka_unit_test(a_black_target_hides_no_other),
        cmocka_unit_test(folded_light_is_counted_as_white),
        cmocka_unit_test(either_kind_may_have_all),
        cmocka_unit_test(kinds_make_room_for_each_other),
        cmocka_unit_test(no_more_than_there_may_be),
        cmocka_unit_test(far_points_claim_no_clusters),
        cmocka_unit_test(further_hits_have_two_places),
        cmocka_unit_test(too_many_parts_are_refused),
        cmocka_unit_test(a_plain_film_keeps_the_beauty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
