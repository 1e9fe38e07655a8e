/* Layout footprints, through the film: which places of the first hits of light paths a pixel keeps. */
#include "lib_film.h"
#include "lib_folder.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

static void two_places_are_two_clusters(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 8, 6, 2, 1);
    create_film(&f);
    for (int k = 0; k < 8; k++)
        if (k % 4 == 3)
            one_hit(&f, 0.8, 0.9, rgb(0.1f, 0.2f, 0.9f), SHARP, rgb(4, 8, 16));
        else
            one_hit(&f, 0.125, 0.25, rgb(0.5f, 0.25f, 1), SHARP, rgb(1, 2, 3));
    finish_film(&f);
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
    end_film(&f);
}

/* Light of one channel alone is light. */
static void red_green_and_blue_light_are_kept(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        const int c = k % 3, sharp = k / 3 ? SHARP : BROAD;
        Fixture f;
        begin_film(&f, 1, 1, 6, 1, 1);
        create_film(&f);
        one_hit(&f, 0.125, 0.25, rgb_grey(1), sharp, rgb(c == 0, c == 1, c == 2));
        finish_film(&f);
        expect_rgb(part(&f, sharp == SHARP ? "dep_Floor_sharp1" : "dep_Floor_broad1"), c == 0, c == 1, c == 2, 1e-3);
        expect_beauty(&f, 0);
        end_film(&f);
    }
}

/* Of four targets, a lamp needs 2 + 2 4 15 + 9 = 131 parts or more while all 15 combinations of up to two further hits
 * are kept: twelve of them need more than a set can have, and get fewer. With no combinations of two, 6 coefficients
 * are left: 27 lamps need 27 (2 + 2 4 6 + 9) = 1593 parts, too many. */
static void many_lamps_have_fewer_combinations(void **state)
{
    (void)state;
    static const int lamps[] = {1, 5, 10, 15, 20, 27};
    for (size_t k = 0; k < sizeof lamps / sizeof *lamps; k++) {
        Fixture f;
        RetexError err = {0};
        begin_film(&f, 4, 1, 6, 1, 1);
        f.scene.nkept = f.params.nkept = lamps[k];
        for (int l = 0; l < lamps[k]; l++) {
            f.scene.kept[l].combination = -1;
            snprintf(f.scene.kept[l].name, sizeof f.scene.kept[l].name, "lamp%d", l);
        }
        const int code = film_create(&f.film, &f.scene, &f.params, &err);
        if (lamps[k] < 22)
            test_must(code, &err);
        else
            assert_int_equal(code, RETEX_ELIMIT);
        assert_true(lamps[k] < 22 || strstr(err.message, "take fewer targets, lamps, finishes or clusters"));
        film_close(&f.film);
    }
}

/* A film whose band is in a checkpoint is the same film again, without its paths. */
static void a_film_continues_from_its_checkpoint(void **state)
{
    (void)state;
    const char *const path = test_in_folder("checkpoint");
    RetexError err = {0};
    Fixture f;
    for (int again = 0; again < 2; again++) {
        begin_film(&f, 1, 1, 6, 1, 1);
        test_must(retex_band_store_open(&f.params.store, 2, 1, 7, path, &err), &err);
        create_film(&f);
        test_must(film_resume(f.film, &err), &err);
        assert_int_equal(film_bands_done(f.film), again);
        if (!again) {
            one_hit(&f, 0.125, 0.25, rgb(0.5f, 0.25f, 1), SHARP, rgb(1, 2, 3));
            film_pixel_end(f.pixel, 0, 0);
            film_pixel_end(f.pixel, 1, 0);
            film_tile_end(f.pixel, 0);
            film_pixel_close(&f.pixel);
            assert_int_equal(film_bands_done(f.film), 1);
            film_close(&f.film);
        }
    }
    film_pixel_close(&f.pixel);
    test_must(retex_set_create(&f.set, 2, 1, &err), &err);
    test_must(retex_set_add_part(f.set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(film_finish(f.film, f.set, &err), &err);
    expect_rgb(part(&f, "beauty"), 0.5f, 0.5f, 3, 0);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 1, 2, 3, 1e-3);
    expect_rgb(part(&f, "albedo_Floor_sharp1"), 0.5f, 0.25f, 1, 1e-6);
    expect_rgb(part(&f, "indep"), 0, 0, 0, 0);
    end_film(&f);
}

static void what_is_not_needed_is_left_out(void **state)
{
    (void)state;
    static const char *const unused[] = {"sharp2", "sharp3", "broad1"};
    Fixture f;
    begin_film(&f, 1, 1, 6, 3, 1);
    create_film(&f);
    one_hit(&f, 0.5, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
    finish_film(&f);
    for (size_t k = 0; k < sizeof unused / sizeof unused[0]; k++) {
        char name[64];
        snprintf(name, sizeof name, "uv_Floor_%s", unused[k]);
        assert_int_equal(retex_set_find_part(f.set, name), -1);
        snprintf(name, sizeof name, "dep_Floor_%s", unused[k]);
        assert_int_equal(retex_set_find_part(f.set, name), -1);
    }
    assert_int_equal(retex_set_find_part(f.set, "dep_Floor_sharp_a1"), -1);
    assert_absent(&f, "uv_Floor_interreflection1");
    /* the other pixel has no light, and nothing of this one */
    assert_true(part(&f, "uv_Floor_sharp1")[2] == 1 && part(&f, "uv_Floor_sharp1")[3 + 2] == 0);
    expect_rgb(part(&f, "dep_Floor_sharp1") + 3, 0, 0, 0, 0);
    expect_beauty(&f, 1);
    end_film(&f);
}

static void the_set_says_what_is_what(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 2, 3, 2, 1);
    create_film(&f);
    one_hit(&f, 2.5, -1, rgb(0.5f, 0.5f, 0.5f), SHARP, rgb_grey(1));
    one_hit(&f, 3.5, -2, rgb(0.25f, 0.5f, 1), BROAD, rgb_grey(1));
    finish_film(&f);
    assert_int_equal(f.set->ntargets, 1);
    assert_int_equal(f.set->orders, 3);
    assert_int_equal(f.set->nfootprints, 2);
    assert_int_equal(f.set->nterms, 1 + 2 + 1);
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
    const int last = f.set->nterms - 1;
    for (int t = 1; t < last; t++) {
        assert_int_equal(f.set->terms[t].nfactors, 1);
        assert_int_equal(test_factor_number(f.set->terms[t].factors[0]), t - 1);
        assert_int_equal(f.set->terms[t].role,
                         kinds[t - 1] == RETEX_FOOTPRINT_SHARP ? RETEX_ROLE_SHARP : RETEX_ROLE_BROAD);
        assert_int_equal(f.set->terms[t].target, 0);
    }
    assert_int_equal(f.set->terms[last].role, RETEX_ROLE_PICTURE);
    const RetexTarget *target = &f.set->targets[0];
    assert_true(target->uv_min[0] == 2.5 && target->uv_max[0] == 3.5);
    assert_true(target->uv_min[1] == -2 && target->uv_max[1] == -1);
    expect_rgb(target->mean_albedo, 0.375f, 0.5f, 0.75f, 1e-6);
    /* what a render needs of memory, asked for before: about what a set holds */
    long floats = 0;
    for (int k = 0; k < f.set->nparts; k++)
        floats += f.set->parts[k].image.channels;
    assert_in_range(film_floats(&f.params, 1), floats / 3, 2 * floats);
    end_film(&f);
}

static void a_cluster_knows_its_spread(void **state)
{
    (void)state;
    enum { PATHS = 500 };
    Fixture f;
    uint32_t seed = 3;
    double weight = 0, squares = 0, mean[2] = {0, 0}, uv[PATHS][2], w[PATHS], m2[3] = {0, 0, 0};
    begin_film(&f, 1, PATHS, 6, 1, 1);
    create_film(&f);
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
    finish_film(&f);
    const float *got = part(&f, "uv_Floor_sharp1"), *spread = part(&f, "spread_Floor_sharp1");
    double su = sqrt(m2[0]), sv = sqrt(m2[2]);
    assert_float_equal(got[2], weight * weight / squares / PATHS,
                       weight * weight / squares / PATHS / 256); /* effective paths */
    assert_true(fabs(got[0] - mean[0]) <= su / 64 + 1e-5);       /* rounded; float has steps of 8e-6 there */
    assert_true(fabs(got[1] - mean[1]) <= sv / 64 + 1e-5);
    assert_float_equal(spread[0], su, su / 128);
    assert_float_equal(spread[1], sv, sv / 128);
    assert_float_equal(spread[2], m2[1] / (su * sv), 1.0 / 128);
    end_film(&f);
}

static void the_nearest_places_merge(void **state)
{
    (void)state;
    static const double places[3] = {0.1, 0.12, 0.9};
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int k = 0; k < 6; k++) {
        Fixture f;
        begin_film(&f, 1, 4, 6, 2, 1);
        create_film(&f);
        for (int i = 0; i < 3; i++) {
            int place = orders[k][i];
            one_hit(&f, places[place], 0.5, rgb_grey(0.2f * (float)(place + 1)), SHARP, rgb_grey(place ? 1 : 3));
        }
        finish_film(&f);
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
        end_film(&f);
    }
}

/* Not even at the same place, and not where there are more than there is room for. */
static void sharp_and_broad_stay_apart(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 8, 6, 1, 1);
    create_film(&f);
    for (int k = 0; k < 4; k++) {
        one_hit(&f, 0.25, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(8));
        one_hit(&f, 0.25 + 0.5 * (k % 2), 0.5, rgb_grey(0.25f), BROAD, rgb_grey(2));
    }
    finish_film(&f);
    assert_true(part(&f, "uv_Floor_sharp1")[0] == 0.25f && fabsf(part(&f, "uv_Floor_sharp1")[2] - 0.5f) < 1e-6f);
    assert_float_equal(part(&f, "uv_Floor_broad1")[0], 0.5f, 0.25 / 64);
    assert_float_equal(part(&f, "spread_Floor_broad1")[0], 0.25f, 1e-6);
    assert_float_equal(part(&f, "uv_Floor_broad1")[2], 0.5f, 1e-6);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 4, 4, 4, 2e-3);
    expect_rgb(part(&f, "dep_Floor_broad1"), 1, 1, 1, 2e-3);
    end_film(&f);
}

/* Also where both hits are at the same place. */
static void one_place_may_be_met_twice(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 1, 6, 2, 1);
    create_film(&f);
    begin_path(&f);
    for (int sharp = SHARP; sharp >= BROAD; sharp--)
        split_hit(&f, 0, 0.25, 0, rgb_grey(1), sharp, (Split){rgb_grey(0.5f), rgb_grey(0.5f)});
    connect_light(&f, rgb_grey(4));
    end_path(&f);
    finish_film(&f);
    static const char *const parts[] = {"indep", "dep_Floor_sharp1", "dep_Floor_broad1", "dep_Floor_sharp_a1"};
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++)
        expect_rgb(part(&f, parts[k]), 1, 1, 1, 1e-3);
    end_film(&f);
}

/* Clusters, later hits and albedos of one pixel are not in the next. */
static void pixels_do_not_mix(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 1, 6, 1, 1);
    create_film(&f);
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
        expect_rgb(part(&f, "uv_Floor_interreflection1") + 3 * x, 0.125f + at, 0.5f, 1, 0);
        expect_rgb(part(&f, "albedo_Floor_sharp1") + 3 * x, 0.25f + at, 0.25f + at, 0.25f + at, 1e-6);
        expect_rgb(part(&f, "albedo_Floor_interreflection1") + 3 * x, 0.125f + at, 0.125f + at, 0.125f + at, 1e-6);
        expect_beauty(&f, (size_t)x);
    }
    end_film(&f);
}

static void a_seam_is_one_place(void **state)
{
    (void)state;
    for (int closed = 0; closed < 2; closed++) {
        Fixture f;
        begin_film(&f, 1, 2, 6, 1, 1);
        f.params.periodic[0][0] = closed;
        create_film(&f);
        one_hit(&f, 0.99, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
        one_hit(&f, 0.01, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
        finish_film(&f);
        const float u = part(&f, "uv_Floor_sharp1")[0], sd = part(&f, "spread_Floor_sharp1")[0];
        assert_float_equal(sd, closed ? 0.01f : 0.49f, (closed ? 0.01 : 0.49) / 128);
        assert_true(closed ? fabsf(u - rintf(u)) < 0.001f : fabsf(u - 0.5f) < 0.01f);
        end_film(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_places_are_two_clusters), cmocka_unit_test(red_green_and_blue_light_are_kept),
        cmocka_unit_test(many_lamps_have_fewer_combinations),
        cmocka_unit_test(a_film_continues_from_its_checkpoint),
        cmocka_unit_test(what_is_not_needed_is_left_out),
        cmocka_unit_test(the_set_says_what_is_what),   cmocka_unit_test(a_cluster_knows_its_spread),
        cmocka_unit_test(the_nearest_places_merge),    cmocka_unit_test(sharp_and_broad_stay_apart),
        cmocka_unit_test(one_place_may_be_met_twice),  cmocka_unit_test(pixels_do_not_mix),
        cmocka_unit_test(a_seam_is_one_place),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
