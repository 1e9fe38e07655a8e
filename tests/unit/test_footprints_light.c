/* Layout footprints, through the film: light with further hits, and folded light. */
#include "lib_film.h"

#include <math.h>
#include <stdio.h>

#include <cmocka.h>

static void further_hits_come_later(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 2, 6, 2, 1);
    create_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.25, rgb_grey(0.5f), SHARP);
    hit(&f, 0, 0.75, 0.5, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(4));
    hit(&f, 0, 0.25, 0, rgb_grey(0.5f), BROAD);
    connect_light(&f, rgb_grey(8));
    end_path(&f);
    finish_film(&f);
    assert_absent(&f, "dep_Floor_sharp1");
    expect_rgb(part(&f, "dep_Floor_sharp_a1"), 2, 2, 2, 1e-3);
    expect_rgb(part(&f, "dep_Floor_sharp_a2"), 4, 4, 4, 1e-3);
    assert_absent(&f, "dep_Floor_sharp_a3");
    const float *first = part(&f, "uv_Floor_sharp1"), *later = part(&f, "uv_Floor_interreflection1");
    assert_true(first[0] == 0.25f && first[1] == 0.25f && first[2] == 0.5f); /* one path, however often it connects */
    assert_absent(&f, "uv_Floor_broad1");
    assert_absent(&f, "uv_Floor_sharp2");
    assert_true(later[0] == 0.75f && later[1] == 0.5f);
    expect_rgb(part(&f, "uv_Floor_interreflection2"), 0.25f, 0, 0.5f, 1e-6);        /* one connection of two paths */
    assert_float_equal(part(&f, "share_Floor_interreflection1")[0], 2.0 / 3, 2e-3); /* of the light: 1 + 1 of 3 */
    expect_rgb(part(&f, "albedo_Floor_interreflection1"), 0.5f, 0.5f, 0.5f, 1e-6);
    assert_true(f.set->folded == 0);
    expect_beauty(&f, 0);
    end_film(&f);
}

/* A monomial goes by its own first hit, which need not be its path's. */
static void monomials_go_their_own_ways(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 1, 6, 2, 1);
    create_film(&f);
    begin_path(&f);
    split_hit(&f, 0, 0.25, 0, rgb_grey(1), SHARP, (Split){rgb_grey(0.5f), rgb_grey(0.25f)});
    split_hit(&f, 0, 0.75, 0, rgb_grey(0.5f), BROAD, (Split){rgb_grey(0.5f), rgb_grey(0.125f)});
    connect_light(&f, rgb_grey(32));
    end_path(&f);
    finish_film(&f);
    expect_rgb(part(&f, "indep"), 1, 1, 1, 1e-6);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 2, 2, 2, 2e-3);
    expect_rgb(part(&f, "dep_Floor_broad1"), 4, 4, 4, 2e-3);
    expect_rgb(part(&f, "dep_Floor_sharp_a1"), 8, 8, 8, 2e-3);
    assert_true(part(&f, "uv_Floor_sharp1")[0] == 0.25f && part(&f, "uv_Floor_broad1")[0] == 0.75f);
    assert_true(part(&f, "uv_Floor_interreflection1")[0] == 0.75f);
    expect_beauty(&f, 0);
    end_film(&f);
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
        begin_film(&f, targets, SPP, 6, 1 + (int)round % 4, 1 + (int)round % 2);
        create_film(&f);
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
        finish_film(&f);
        expect_rgb(f.set->parts[0].image.pixels, light.r / SPP, light.g / SPP, light.b / SPP, 1e-4);
        assert_true(expect_beauty(&f, 0) > 0.1);
        assert_true(f.set->folded == 0);
        end_film(&f);
    }
}

/* Places that are black in the original are found all the same, and may become bright. */
static void black_albedo_has_footprints(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 2, 6, 3, 1);
    create_film(&f);
    one_hit(&f, 0.25, 0.75, rgb_grey(0), SHARP, rgb(1, 2, 4));
    begin_path(&f);
    hit(&f, 0, 0.5, 0.75, rgb_grey(0), BROAD);
    hit(&f, 0, 0.125, 0.5, rgb_grey(0), BROAD);
    connect_light(&f, rgb_grey(2));
    end_path(&f);
    finish_film(&f);
    const float *sharp = part(&f, "uv_Floor_sharp1"), *later = part(&f, "uv_Floor_interreflection1");
    assert_true(sharp[0] == 0.25f && sharp[1] == 0.75f && sharp[2] == 0.5f);
    assert_true(part(&f, "uv_Floor_broad1")[0] == 0.5f && part(&f, "uv_Floor_broad1")[2] == 0.5f);
    assert_true(later[0] == 0.125f && later[1] == 0.5f && later[2] == 0.5f);
    expect_rgb(part(&f, "dep_Floor_sharp1"), 0.5f, 1, 2, 1e-3);
    expect_rgb(part(&f, "dep_Floor_broad_a1"), 1, 1, 1, 1e-3);
    static const char *const albedos[] = {"albedo_Floor_sharp1", "albedo_Floor_broad1",
                                          "albedo_Floor_interreflection1"};
    for (size_t k = 0; k < 3; k++)
        expect_rgb(part(&f, albedos[k]), 0, 0, 0, 0);
    expect_rgb(f.set->parts[0].image.pixels, 0, 0, 0, 0);
    expect_beauty(&f, 0);
    end_film(&f);
}

static void targets_follow_each_other(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 2, 2, 6, 2, 1);
    create_film(&f);
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
    finish_film(&f);
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
    assert_ptr_equal(&f.set->footprints[test_factor_number(term->factors[0])], footprint(&f, "uv_Floor_sharp1"));
    assert_ptr_equal(&f.set->footprints[test_factor_number(term->factors[1])],
                     footprint(&f, "uv_Floor_interreflection1"));
    assert_ptr_equal(&f.set->footprints[test_factor_number(term->factors[2])],
                     footprint(&f, "uv_Wall_interreflection1"));
    assert_true(part(&f, "uv_Floor_interreflection1")[0] == 0.75f && part(&f, "uv_Wall_interreflection1")[0] == 0.125f);
    assert_true(part(&f, "uv_Wall_sharp1")[0] == 0.375f);
    assert_true(f.set->targets[1].uv_max[0] == 0.375);
    assert_true(f.set->folded == 0 && f.set->folded_white == 0);
    expect_beauty(&f, 0);
    end_film(&f);
}

/* Shares tell how much light each place has of what is mixed; they add up to 1. */
static void shares_add_up(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 2, 2, 6, 2, 1);
    create_film(&f);
    for (int n = 0; n < 2; n++) {
        begin_path(&f);
        hit(&f, 1, 0.25 + 0.5 * n, 0.5, rgb_grey(0.5f), SHARP);
        connect_light(&f, rgb_grey(2));
        for (int k = 0; k < 5 + n; k++)
            hit(&f, k == 0 ? 0 : 1, k < 2 ? 0.5 : 0.125, 0.5, rgb_grey(0.5f), BROAD);
        connect_light(&f, rgb_grey(n ? 192 : 32)); /* which is 3 and 1 without the first hit, for albedos of 0.5 */
        end_path(&f);
    }
    finish_film(&f);
    assert_int_equal(f.set->nmixtures, 3); /* the wall's sharp clusters, its further hits, and those of both targets */
    double all = 0;
    static const char *const shares[] = {"share_Floor_interreflection1", "share_Wall_interreflection1",
                                         "share_Wall_interreflection2"};
    for (size_t k = 0; k < 3; k++)
        all += part(&f, shares[k])[0];
    assert_float_equal(all, 1, 4e-3);
    assert_float_equal(part(&f, "share_Floor_interreflection1")[0], (1.0 + 3) / (5 * 1 + 6 * 3), 2e-3);
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
        assert_int_equal(f.set->mixtures[MIXTURE(test_factor_number(term->factors[0]))].nshares, 2);
        assert_int_equal(f.set->mixtures[MIXTURE(test_factor_number(term->factors[1]))].nshares, 3);
    }
    expect_beauty(&f, 0);
    end_film(&f);
}

/* The albedo of interreflections that are kept as one: times it, all their light is what they reflect. */
static void albedos_of_interreflections_weigh_by_light(void **state)
{
    (void)state;
    static const float albedo[] = {0.25f, 0.75f}, seen[] = {0.5f, 0.75f}, light[] = {16, 2};
    float all = 0, reflected = 0;
    Fixture f;
    begin_film(&f, 2, 2, 6, 1, 1);
    create_film(&f);
    for (int n = 0; n < 2; n++) {
        begin_path(&f);
        hit(&f, 1, 0.25, 0.5, rgb_grey(seen[n]), SHARP);
        hit(&f, 0, 0.125, 0.5, rgb_grey(albedo[n]), BROAD);
        connect_light(&f, rgb_grey(light[n]));
        end_path(&f);
        all += seen[n] * light[n], reflected += seen[n] * light[n] * albedo[n];
    }
    finish_film(&f);
    const float mean = reflected / all;
    expect_rgb(part(&f, "albedo_Floor_interreflection1"), mean, mean, mean, 2e-3);
    end_film(&f);
}

/* What one target's albedo is does not depend on another that is black: that one may be edited. */
static void a_black_target_hides_no_other(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 2, 2, 6, 1, 1);
    create_film(&f);
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
    finish_film(&f);
    expect_rgb(f.set->parts[0].image.pixels, 0, 0, 0, 0);
    expect_rgb(part(&f, "dep_Floor_sharp_b1"), 4, 4, 4, 1e-3);
    expect_rgb(part(&f, "albedo_Wall_interreflection1"), 0.5f, 0.5f, 0.5f, 1e-6);
    expect_rgb(part(&f, "dep_Wall_sharp_a2"), 1, 1, 1, 1e-3);
    expect_rgb(part(&f, "albedo_Wall_sharp1"), 0.5f, 0.25f, 1, 1e-6);
    expect_rgb(part(&f, "albedo_Floor_sharp1"), 0, 0, 0, 0);
    expect_rgb(part(&f, "albedo_Floor_interreflection1"), 0, 0, 0, 0);
    expect_beauty(&f, 0);
    end_film(&f);
}

static void fold_light(Fixture *f, double light, double white)
{
    f->hits.folded += light, f->hits.folded_white += white;
}

/* How much light is folded, as it is and with white targets: what the original's black hides counts there too. */
static void folded_light_is_counted_as_white(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 4, 2, 2, 1);
    create_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.75, 0.5, rgb_grey(0), SHARP);
    connect_light(&f, rgb_grey(10));
    fold_light(&f, 0, 10 * 0.8);
    end_path(&f);
    one_hit(&f, 0.25, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(4));
    begin_path(&f);
    connect_light(&f, rgb_grey(2));
    end_path(&f);
    begin_path(&f);
    for (int k = 0; k < 2; k++)
        hit(&f, 0, 0.25, 0.5, rgb_grey(0.5f), k ? BROAD : SHARP);
    connect_light(&f, rgb_grey(5));
    fold_light(&f, 1.25, 5 * 0.8 * 0.8);
    end_path(&f);
    finish_film(&f);
    double hidden = 10 * 0.8, known = 5 * 0.8 * 0.8;
    assert_float_equal(f.set->folded_white, (hidden + known) / (hidden + known + 4 * 0.8 + 2), 1e-6);
    assert_float_equal(f.set->folded, 1.25 / (1.25 + 2 + 2), 1e-6);
    expect_beauty(&f, 0);
    end_film(&f);
}

/* Light of one tile is not counted again with the next one that the same thread renders. */
static void light_of_a_tile_is_counted_once(void **state)
{
    (void)state;
    Fixture f;
    RetexError err = {0};
    begin_film(&f, 1, 1, 2, 2, 1);
    f.params.height = 32, f.params.ntiles = 2;
    create_film(&f);
    for (int tile = 0; tile < 2; tile++) {
        film_tile_begin(f.pixel, 1);
        begin_path(&f);
        connect_light(&f, rgb_grey(2));
        if (tile == 0)
            fold_light(&f, 1, 1);
        end_path(&f);
        film_pixel_end(f.pixel, 0, 16 * tile);
        film_tile_end(f.pixel, tile);
    }
    film_pixel_close(&f.pixel);
    test_must(retex_set_create(&f.set, 2, 32, &err), &err);
    test_must(retex_set_add_part(f.set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(film_finish(f.film, f.set, &err), &err);
    assert_float_equal(f.set->folded, 1.0 / (2 + 2), 1e-6);
    end_film(&f);
}

/* A shadow ray may pass targets behind a hit that the path goes on from elsewhere: hits are a tree. */
static void hits_are_a_tree(void **state)
{
    (void)state;
    Fixture f;
    const Split both = {rgb_grey(0.5f), rgb_grey(0.25f)};
    begin_film(&f, 2, 1, 6, 2, 1);
    create_film(&f);
    begin_path(&f);
    hit(&f, 0, 0.25, 0.5, rgb_grey(0.5f), SHARP);
    TargetNode *floor = f.hits.last;
    f.split = both; /* of the light picked there, through the wall */
    hit(&f, 1, 0.5, 0.5, rgb_grey(0.5f), BROAD);
    target_node_add_light(f.hits.last, splat(16), splat(0));
    const TargetVertex wall = {{0.75, 0.5}, rgb_grey(0.5f), 1, BROAD, 0, 0}; /* to which the path goes on elsewhere */
    TargetNode *last = target_tree_add(&f.hits, &f.room[2], &wall, floor, splat(1), splat(0));
    target_node_add_light(last, splat(4), splat(0));
    const double beauty = 16 * 0.5 * (0.5 * 0.5 + 0.25) + 4 * 0.5 * 0.5;
    film_add_light(f.pixel, (double[3]){beauty, beauty, beauty});
    end_path(&f);
    finish_film(&f);
    expect_rgb(part(&f, "dep_Floor_sharp_b1"), 8 + 4, 12, 12, 1e-2);
    expect_rgb(part(&f, "dep_Wall_broad1"), 4, 4, 4, 1e-2);
    assert_absent(&f, "dep_Floor_sharp1");
    assert_true(part(&f, "uv_Wall_broad1")[0] == 0.5f);
    assert_true(part(&f, "uv_Wall_interreflection1")[0] == 0.5f && part(&f, "uv_Wall_interreflection2")[0] == 0.75f);
    assert_float_equal(part(&f, "share_Wall_interreflection1")[0], 2.0 / 3, 2e-3); /* 4 and 2 through the floor's 1/2 */
    expect_beauty(&f, 0);
    end_film(&f);
}

/* Light of two hits, multiplied out: (d1 a1 + i1) (d2 a2 + i2) L, where a is a texture. Of each lamp it is kept by what
 * the eye sees: the mean of the paths, of which some have no light of a lamp. */
static void light_of_lamps_is_multiplied_out(void **state)
{
    (void)state;
    static const Split first = {{1, 0.5f, 0.25f}, {0.25f, 1, 0.5f}}, second = {{0.5f, 0.25f, 1}, {1, 0.5f, 0.125f}};
    static const Rgb lights[2][2] = {{{4, 2, 8}, {0, 0, 0}}, {{2, 8, 2}, {1, 4, 2}}}; /* by path and lamp */
    Fixture f;
    begin_film(&f, 1, 2, 6, 1, 1);
    f.scene.nkept = f.params.nkept = 2;
    for (int l = 0; l < 2; l++) {
        f.scene.kept[l].combination = -1;
        snprintf(f.scene.kept[l].name, sizeof f.scene.kept[l].name, l ? "sun" : "bulb");
    }
    create_film(&f);
    for (int k = 0; k < 2; k++) {
        LampLight lamps[2];
        begin_path(&f);
        split_hit(&f, 0, 0.125, 0.25, rgb_grey(0.5f), SHARP, first);
        split_hit(&f, 0, 0.625, 0.75, rgb_grey(0.25f), SHARP, second);
        for (int l = 0; l < 1 + k; l++) {
            const Rgb light = lights[k][l];
            connect_light(&f, light);
            lamps[l] = (LampLight){.dependent = color4(second.d) * color4(light),
                                   .independent = color4(second.i) * color4(light),
                                   .light = color4(rgb_mul(light, f.value)),
                                   .hit = f.hits.last,
                                   .earlier = f.hits.lamp_light,
                                   .kept = l};
            f.hits.lamp_light = &lamps[l];
        }
        end_path(&f);
    }
    finish_film(&f);
    for (int l = 0; l < 2; l++) {
        const char *const lamp = l ? "sun" : "bulb";
        const Rgb light = rgb_scale(rgb_add(lights[0][l], lights[1][l]), 0.5f);
        const Rgb none = rgb_mul(light, rgb_mul(first.i, second.i)), both = rgb_mul(light, rgb_mul(first.d, second.d));
        const Rgb one = rgb_mul(light, rgb_add(rgb_mul(first.d, second.i), rgb_mul(first.i, second.d)));
        const Rgb all = rgb_mul(light, f.value);
        char name[64];
        snprintf(name, sizeof name, "lamp_%s", lamp);
        expect_rgb(part(&f, name), all.r, all.g, all.b, 1e-3);
        snprintf(name, sizeof name, "lamp_%s_indep", lamp);
        expect_rgb(part(&f, name), none.r, none.g, none.b, 1e-3);
        snprintf(name, sizeof name, "lamp_%s_Floor_sharp", lamp);
        expect_rgb(part(&f, name), one.r, one.g, one.b, 1e-3);
        snprintf(name, sizeof name, "lamp_%s_Floor_sharp_a1", lamp);
        expect_rgb(part(&f, name), both.r, both.g, both.b, 1e-3);
    }
    end_film(&f);
}

static void a_plain_film_keeps_the_beauty(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 2, 6, 3, 1);
    f.params.split = 0;
    create_film(&f);
    one_hit(&f, 0.5, 0.5, rgb_grey(0.5f), SHARP, rgb(4, 8, 12));
    finish_film(&f);
    expect_rgb(f.set->parts[0].image.pixels, 1, 2, 3, 0);
    assert_true(f.set->nparts == 1 && f.set->ntargets == 0 && f.set->nterms == 0);
    assert_int_equal(film_floats(&f.params, 1), 3);
    end_film(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(further_hits_come_later),
        cmocka_unit_test(monomials_go_their_own_ways),
        cmocka_unit_test(the_terms_add_up),
        cmocka_unit_test(black_albedo_has_footprints),
        cmocka_unit_test(hits_are_a_tree),
        cmocka_unit_test(targets_follow_each_other),
        cmocka_unit_test(shares_add_up),
        cmocka_unit_test(a_black_target_hides_no_other),
        cmocka_unit_test(folded_light_is_counted_as_white),
        cmocka_unit_test(light_of_a_tile_is_counted_once),
        cmocka_unit_test(albedos_of_interreflections_weigh_by_light),
        cmocka_unit_test(light_of_lamps_is_multiplied_out),
        cmocka_unit_test(a_plain_film_keeps_the_beauty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
