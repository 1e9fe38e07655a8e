/* Layout footprints, through the film: clusters that sharp and broad places share. */
#include "lib_film.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* What nothing sharp needs, broad light has; and the other way about. */
static void either_kind_may_have_all(void **state)
{
    (void)state;
    static const double places[4] = {0.1, 0.12, 0.5, 0.9};
    for (int sharp = 0; sharp < 2; sharp++) {
        Fixture f;
        begin_shared(&f, 1, 8, 6, 4);
        create_film(&f);
        for (int k = 0; k < 8; k++)
            one_hit(&f, places[k % 4], 0.5, rgb_grey(0.5f), sharp, rgb_grey(1));
        finish_film(&f);
        assert_int_equal(count_clusters(&f, "sharp"), sharp ? 4 : 0);
        assert_int_equal(count_clusters(&f, "broad"), sharp ? 0 : 4);
        for (int k = 0; k < 4; k++) {
            char name[32];
            snprintf(name, sizeof name, "Floor_%s%d", sharp ? "sharp" : "broad", k + 1);
            expect_place(&f, name, places[k], 0);
        }
        expect_beauty(&f, 0);
        end_film(&f);
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
        create_film(&f);
        for (int k = 0; k < 5; k++)
            if (k == at)
                one_hit(&f, 0.11, 0.5, rgb_grey(0.5f), !sharp, rgb_grey(1));
            else
                one_hit(&f, places[k - (k > at)], 0.5, rgb_grey(0.25f), sharp, rgb_grey(1));
        finish_film(&f);
        assert_int_equal(count_clusters(&f, "sharp"), sharp ? 3 : 1);
        assert_int_equal(count_clusters(&f, "broad"), sharp ? 1 : 3);
        expect_place(&f, sharp ? "Floor_sharp1" : "Floor_broad1", 0.11, 0.01);
        expect_place(&f, sharp ? "Floor_sharp2" : "Floor_broad2", 0.5, 0);
        expect_place(&f, sharp ? "Floor_sharp3" : "Floor_broad3", 0.9, 0);
        expect_place(&f, sharp ? "Floor_broad1" : "Floor_sharp1", 0.11, 0);
        expect_rgb(part(&f, sharp ? "dep_Floor_sharp1" : "dep_Floor_broad1"), 0.4f, 0.4f, 0.4f, 1e-3);
        expect_rgb(part(&f, sharp ? "dep_Floor_broad1" : "dep_Floor_sharp1"), 0.2f, 0.2f, 0.2f, 1e-3);
        expect_beauty(&f, 0);
        end_film(&f);
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
        begin_film(&f, 1, PATHS, 6, most[1], most[2]);
        f.params.clusters = most[0];
        create_film(&f);
        for (int k = 0; k < PATHS; k++) {
            int sharp = round % 4 == 0   ? k % 2
                        : round % 4 == 1 ? k < PATHS / 2
                        : round % 4 == 2 ? k >= PATHS / 2
                                         : k == 77;
            one_hit(&f, test_random(&seed), 100 * pow(test_random(&seed), 8), rgb_grey(0.5f), sharp,
                    rgb_grey((float)test_random(&seed)));
        }
        finish_film(&f);
        int sharp = count_clusters(&f, "sharp"), broad = count_clusters(&f, "broad");
        assert_in_range(sharp, 1, most[1]);
        assert_in_range(broad, 1, most[2]);
        assert_int_equal(sharp + broad, round % 4 == 3 && most[1] < most[0] ? 1 + most[2] : most[0]);
        assert_true(expect_beauty(&f, 0) > 0.1);
        end_film(&f);
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
            create_film(&f);
            for (int k = 0; k < 6; k++)
                if ((k < 3) == first)
                    one_hit(&f, far[k % 3], 0.5, rgb_grey(0.5f), sharp, rgb_grey(1));
                else
                    one_hit(&f, near[k % 3], 0.5, rgb_grey(0.5f), sharp, rgb_grey(10));
            finish_film(&f);
            int apart = 0; /* near places that are as they were */
            for (int k = 1; k <= 4; k++) {
                char name[32];
                snprintf(name, sizeof name, "uv_Floor_%s%d", sharp ? "sharp" : "broad", k);
                for (int i = 0; i < 3; i++)
                    apart += fabs(part(&f, name)[0] - near[i]) <= FINEST;
            }
            assert_int_equal(apart, sharp ? 0 : 3);
            expect_beauty(&f, 0);
            end_film(&f);
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
        begin_film(&f, 1, cases[k].count, 6, 2, 1);
        create_film(&f);
        for (int i = 0; i < cases[k].count; i++)
            later_hit(&f, cases[k].u[i], cases[k].light[i]);
        finish_film(&f);
        expect_place(&f, "Floor_interreflection1", cases[k].mean[0], cases[k].sd[0]);
        expect_place(&f, "Floor_interreflection2", cases[k].mean[1], cases[k].sd[1]);
        assert_float_equal(part(&f, "share_Floor_interreflection1")[0], cases[k].share, 2e-3);
        expect_beauty(&f, 0);
        end_film(&f);
    }
}

/* The weight of an interreflection where places are pooled: the light that its texture multiplies, with every other
 * texture 1/2, less what reaches the camera by no texture before it. The originals do not count. */
static void further_hits_weigh_by_light_through_textures(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        Fixture f;
        begin_film(&f, 1, 3, 6, 2, 1);
        create_film(&f);
        later_hit(&f, 9, 1);
        begin_path(&f);
        split_hit(&f, 0, 0.5, 0.5, rgb_grey(0.9f), SHARP, (Split){rgb_grey(k ? 0.5f : 1), rgb_grey(k ? 0.5f : 0)});
        hit(&f, 0, 0.25, 0.5, rgb_grey(0.9f), BROAD);
        if (k) { /* (1/4 + 1/2 - 1/2) L, and on another path 1/2 L */
            connect_light(&f, rgb_grey(1));
            end_path(&f);
            begin_path(&f);
            hit(&f, 0, 0.5, 0.5, rgb_grey(0.9f), SHARP);
        }
        hit(&f, 0, 0.375, 0.5, rgb_grey(0.9f), BROAD); /* else on the same: 1/2 * 1/2 L both */
        connect_light(&f, rgb_grey(1));
        end_path(&f);
        finish_film(&f);
        const double share = k ? 2.0 / 3 : 0.5, mean = 0.25 + 0.125 * share, sd = 0.125 * sqrt(share * (1 - share));
        expect_place(&f, "Floor_interreflection2", mean, sd);
        expect_place(&f, "Floor_interreflection1", 9, 0);
        end_film(&f);
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
        begin_film(&f, cases[k].ntargets, 1, 6, cases[k].sharp, cases[k].broad);
        f.params.clusters = cases[k].clusters;
        assert_int_equal(film_create(&f.film, &f.scene, &f.params, &err), cases[k].code);
        assert_true(!cases[k].code || strstr(err.message, "more than 1490"));
        end_film(&f);
    }
}

/* As many places as clusters, seen in a mirror by 32 paths each; their light is not the same in all. */
static int count_in_mirror(int ntargets, int extra, int places)
{
    Fixture f;
    begin_film(&f, ntargets, 32 * places, 6, 4, 2);
    f.params.extra = extra;
    create_film(&f);
    for (int k = 0; k < 32 * places; k++)
        one_hit(&f, (k % places) / (double)places, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
    finish_film(&f);
    const int count = count_clusters(&f, "sharp");
    assert_int_equal(count_clusters(&f, "broad"), 0);
    expect_beauty(&f, 0);
    for (int k = 0; count == places && k < count; k++) {
        char name[32];
        snprintf(name, sizeof name, "Floor_sharp%d", k + 1);
        expect_place(&f, name, k / (double)places, 0);
    }
    end_film(&f);
    return count;
}

/* Extra clusters keep the number of parts below what readers of EXR files take: eight targets have eight of them. */
static void extra_clusters_are_bounded(void **state)
{
    (void)state;
    assert_int_equal(count_in_mirror(1, 0, 14), 4);
    assert_int_equal(count_in_mirror(1, 8, 14), 12);
    assert_int_equal(count_in_mirror(1, 10, 14), 14);
    assert_int_equal(count_in_mirror(8, 8, 14), 12);
    assert_int_equal(count_in_mirror(8, 10, 14), 12);
    assert_int_equal(count_in_mirror(1, 8, 7), 7);
}

/* Pairs of places that are so near that no texture is expected to tell them apart. */
static void extra_clusters_merge_what_is_near(void **state)
{
    (void)state;
    enum { PATHS = 12 * 32 };
    Fixture f;
    begin_film(&f, 1, PATHS, 6, 4, 2);
    f.params.extra = 8;
    create_film(&f);
    for (int k = 0; k < PATHS; k++)
        one_hit(&f, k % 6 / 6.0 + k / 6 % 2 * 0.001, 0.5, rgb_grey(0.5f), SHARP, rgb_grey(1));
    finish_film(&f);
    assert_int_equal(count_clusters(&f, "sharp"), 6);
    expect_beauty(&f, 0);
    end_film(&f);
}

/* A pixel does not have extra clusters because the one before it had. */
static void the_next_pixel_has_no_extra_clusters(void **state)
{
    (void)state;
    Fixture f;
    begin_film(&f, 1, 8, 6, 4, 2);
    f.params.extra = 4;
    create_film(&f);
    for (int x = 1; x >= 0; x--) {
        for (int k = 0; k < 8; k++) {
            begin_path(&f);
            hit(&f, 0, k / 8.0, 0.5, rgb_grey(0.5f), SHARP);
            f.hits.last->at.direct = !x;
            connect_light(&f, rgb_grey(1));
            end_path(&f);
        }
        film_pixel_end(f.pixel, x, 0);
    }
    make_set(&f);
    for (int k = 0; k < 8; k++) {
        char name[32];
        snprintf(name, sizeof name, "uv_Floor_sharp%d", k + 1);
        assert_true(part(&f, name)[5] > 0);
        assert_int_equal(part(&f, name)[2] > 0, k < 4);
    }
    end_film(&f);
}

/* Four broad places of equal light, far apart or in two pairs, where each kind may have extra clusters or not. */
static void broad_clusters_are_more_where_that_shows(void **state)
{
    (void)state;
    static const struct {
        int extra, count;
        double places[4];
    } cases[] = {{0, 2, {0, 0.25, 0.5, 0.75}},
                 {8, 4, {0, 0.25, 0.5, 0.75}},
                 {1, 4, {0, 0.25, 0.5, 0.75}},
                 {8, 2, {0, 0.001, 0.5, 0.501}},
                 {8, 3, {0, 0.25, 0.5, 0.501}}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        Fixture f;
        begin_film(&f, 1, 16, 6, 4, 2);
        f.params.extra = cases[k].extra;
        create_film(&f);
        for (int n = 0; n < 16; n++)
            one_hit(&f, cases[k].places[n % 4], 0.5, rgb_grey(0.5f), BROAD, rgb_grey(1));
        finish_film(&f);
        assert_int_equal(count_clusters(&f, "broad"), cases[k].count);
        for (int n = 0; n < 4 && cases[k].count == 4; n++) {
            char name[32];
            snprintf(name, sizeof name, "Floor_broad%d", n + 1);
            expect_place(&f, name, cases[k].places[n], 0);
        }
        expect_beauty(&f, 0);
        end_film(&f);
    }
}

/* Interreflections at four places of each of so many targets. Returns how many the first target has. */
static int count_interreflections(int ntargets, int extra)
{
    Fixture f;
    const int paths = 64 * ntargets;
    begin_film(&f, ntargets, paths, 6, 4, 2);
    f.params.extra = extra;
    create_film(&f);
    for (int n = 0; n < paths; n++) {
        begin_path(&f);
        hit(&f, 0, 0.5, 0.5, rgb_grey(0.5f), SHARP);
        hit(&f, n % ntargets, n / ntargets % 4 * 0.25, 0.5, rgb_grey(0.5f), BROAD);
        connect_light(&f, rgb_grey(1));
        end_path(&f);
    }
    finish_film(&f); /* which fails where a mixture has too many footprints */
    const int count = count_clusters(&f, "interreflection");
    expect_beauty(&f, 0);
    end_film(&f);
    return count;
}

/* All targets' interreflections are one mixture, which has room for 20. */
static void interreflections_are_fewer_on_many_targets(void **state)
{
    (void)state;
    static const int counts[RETEX_MAX_TARGETS] = {4, 4, 4, 4, 4, 3, 2, 2};
    for (int n = 1; n <= RETEX_MAX_TARGETS; n++) {
        assert_int_equal(count_interreflections(n, 8), counts[n - 1]);
        assert_int_equal(count_interreflections(n, 0), 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(either_kind_may_have_all),
        cmocka_unit_test(kinds_make_room_for_each_other),
        cmocka_unit_test(no_more_than_there_may_be),
        cmocka_unit_test(far_points_claim_no_clusters),
        cmocka_unit_test(further_hits_have_two_places),
        cmocka_unit_test(further_hits_weigh_by_light_through_textures),
        cmocka_unit_test(too_many_parts_are_refused),
        cmocka_unit_test(extra_clusters_are_bounded),
        cmocka_unit_test(the_next_pixel_has_no_extra_clusters),
        cmocka_unit_test(extra_clusters_merge_what_is_near),
        cmocka_unit_test(broad_clusters_are_more_where_that_shows),
        cmocka_unit_test(interreflections_are_fewer_on_many_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
