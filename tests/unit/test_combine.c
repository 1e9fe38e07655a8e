/* Sampling and recombination, compared with a simple reference on random sets: regions, threads, cross terms, and
 * mistakes. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "retexture/combine_kernel.h"
#include "texture/filter.h"

static RetexTextureSpec constant_spec(const char *target, float r, float g, float b)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    snprintf(spec.target, sizeof spec.target, "%s", target);
    spec.constant = 1;
    spec.color[0] = r;
    spec.color[1] = g;
    spec.color[2] = b;
    return spec;
}

static double footprint_value(const RetexSet *set, int f, size_t i)
{
    const RetexImage *sampled = test_laid(set, f);
    return (double)(sampled ? sampled : &set->parts[set->footprints[f].albedo].image)->pixels[i];
}

/* Of random weights either all colours have some, or none has. */
static double mixture_value(const RetexSet *set, const RetexMixture *mixture, size_t i)
{
    double sum = 0, weights = 0;
    for (int k = 0; k < mixture->nshares; k++) {
        const RetexImage *weight = &set->parts[mixture->shares[k].weight].image;
        double w = (double)weight->pixels[weight->channels == 3 ? i : i / 3];
        sum += w * footprint_value(set, mixture->shares[k].footprint, i);
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

/* The scalar reference, straight from Eq. 4 of the supplement. */
static double reference_value(const RetexSet *set, int cross, size_t i)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        if ((term->role == RETEX_ROLE_CROSS2 && cross < 2) || (term->role == RETEX_ROLE_CROSS3 && cross < 3))
            continue;
        double product = (double)set->parts[term->radiance].image.pixels[i];
        for (int k = 0; k < term->nfactors; k++) {
            int f = test_factor_number(term->factors[k]);
            product *= f < 0 ? mixture_value(set, &set->mixtures[MIXTURE(f)], i) : footprint_value(set, f, i);
        }
        sum += product;
    }
    return sum;
}

static void check_picture(const RetexImage *picture, const RetexSet *set, int cross)
{
    for (size_t i = 0; i < (size_t)set->width * (size_t)set->height * 3; i++) {
        double want = reference_value(set, cross, i);
        if (fabs((double)picture->pixels[i] - want) > 1e-5 * fabs(want) + 1e-9)
            fail_msg("value %zu is %g, not %g", i, (double)picture->pixels[i], want);
    }
}

/* Lays these textures on the set, and no others. */
static void lay(RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads)
{
    RetexError err = {0};
    retex_set_lift(set, -1);
    test_must(retex_sample(set, specs, nspecs, nthreads, &err), &err);
}

static void test_reference(void **state)
{
    (void)state;
    RetexCombineParams params = RETEX_COMBINE_INIT;
    static const int sizes[][2] = {{48, 32}, {1, 1}, {517, 3}, {7, 61}};
    for (uint32_t n = 0; n < 8; n++) {
        RetexSet *set = test_set(sizes[n % 4][0], sizes[n % 4][1], n + 1);
        if (n >= 4)
            test_make_footprints(set);
        RetexTextureSpec specs[2] = {constant_spec("Wall", 0.9f, 0.1f, 0.4f), constant_spec("floor", 0.2f, 0.7f, 0)};
        for (int nspecs = 0; nspecs <= 2; nspecs++) {
            lay(set, specs, nspecs, 2);
            for (int cross = 0; cross <= 3; cross += cross ? 1 : 2) {
                RetexImage picture = {0};
                RetexError err = {0};
                params.cross = cross;
                test_must(retex_combine(&picture, set, &params, NULL, 2, &err), &err);
                check_picture(&picture, set, cross);
                retex_image_free(&picture);
            }
        }
        RetexImage picture = {0};
        retex_set_lift(set, -1);
        RetexError err = {0};
        test_must(retex_combine(&picture, set, NULL, NULL, 0, &err), &err);
        check_picture(&picture, set, 3);
        retex_image_free(&picture);
        retex_set_close(&set);
    }
}

/* Every sample is the texture's look-up at the stored footprint; where there is none it is black. */
static void test_samples(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 20, 3);
    RetexImage im = {0};
    RetexError err = {0};
    test_random_image(&im, 19, 33, 3, 5, 0, 1);
    char path[] = "/tmp/retex-texture-XXXXXX.exr";
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    close(fd);
    test_must(retex_image_write(&im, path, NULL, 1, &err), &err);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, "FLOOR"); /* found ignoring case */
    snprintf(spec.image, sizeof spec.image, "%s", path);
    spec.scale[0] = 2;
    spec.rotate = 20;
    RetexTexture *texture;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    lay(set, &spec, 1, 0);
    int floor_target = retex_set_find_target(set, "Floor"), empty = 0;
    for (int f = 0; f < set->nfootprints; f++) {
        if (set->footprints[f].target != floor_target) {
            assert_null(test_laid(set, f));
            continue;
        }
        for (size_t i = 0; i < 40 * 20; i++) {
            const float *uv = set->parts[set->footprints[f].uv].image.pixels + 3 * i;
            const float *sd = set->parts[set->footprints[f].spread].image.pixels + 2 * i;
            float want[4] = {0, 0, 0, 1};
            retex_texture_filter(texture, RETEX_TEXTURE_GAUSSIAN, uv, sd, 2, 1, want, 4);
            empty += !(uv[2] > 0);
            for (int c = 0; c < 3; c++)
                assert_float_equal(test_laid(set, f)->pixels[3 * i + (size_t)c], want[c], 1e-6);
        }
    }
    assert_true(empty > 0);
    assert_string_equal(set->targets[floor_target].texture, path);
    retex_texture_close(&texture);
    retex_image_free(&im);
    remove(path);
    retex_set_close(&set);
}

/* Through a transparent texture the original shows: the picture is the original one. */
static void test_transparent(void **state)
{
    (void)state;
    RetexSet *set = test_set(24, 24, 9);
    RetexImage clear = {0}, was = {0}, is = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&clear, 4, 4, 4, &err), &err);
    char path[] = "/tmp/retex-texture-XXXXXX.exr";
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    close(fd);
    test_must(retex_image_write(&clear, path, NULL, 1, &err), &err);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, "Floor");
    snprintf(spec.image, sizeof spec.image, "%s", path);
    test_must(retex_combine(&was, set, NULL, NULL, 1, &err), &err);
    lay(set, &spec, 1, 1);
    test_must(retex_combine(&is, set, NULL, NULL, 1, &err), &err);
    /* Where a footprint has no coverage its sample is black, and so is its albedo. */
    for (size_t i = 0; i < 24 * 24 * 3; i++)
        assert_float_equal(is.pixels[i], was.pixels[i], 1e-6f + 1e-6f * fabsf(was.pixels[i]));
    retex_image_free(&clear);
    retex_image_free(&was);
    retex_image_free(&is);
    remove(path);
    retex_set_close(&set);
}

static void test_threads(void **state)
{
    (void)state;
    RetexSet *set = test_set(150, 90, 4);
    test_make_footprints(set);
    RetexTextureSpec specs[2] = {constant_spec("Wall", 0.9f, 0.1f, 0.4f), constant_spec("Floor", 0.2f, 0.7f, 0)};
    RetexImage first = {0};
    RetexError err = {0};
    for (int threads = 1; threads <= 7; threads += threads) {
        lay(set, specs, 2, threads);
        RetexImage picture = {0};
        test_must(retex_combine(&picture, set, NULL, NULL, threads, &err), &err);
        if (!first.pixels)
            test_must(retex_image_copy(&first, &picture, &err), &err);
        assert_memory_equal(first.pixels, picture.pixels, 150 * 90 * 3 * sizeof(float));
        retex_image_free(&picture);
    }
    retex_image_free(&first);
    retex_set_close(&set);
}

static void test_region(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 30, 5);
    test_make_footprints(set);
    RetexImage whole = {0}, part = {0};
    RetexError err = {0};
    test_must(retex_combine(&whole, set, NULL, NULL, 1, &err), &err);
    test_must(retex_image_alloc(&part, 40, 30, 3, &err), &err);
    for (size_t i = 0; i < 40 * 30 * 3; i++)
        part.pixels[i] = -7;
    RetexRoi roi = {5, 6, 21, 19, 1, 2};
    test_must(retex_combine(&part, set, NULL, &roi, 2, &err), &err);
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 40; x++)
            for (int c = 0; c < 3; c++) {
                size_t i = retex_image_index(&part, x, y) + (size_t)c;
                int inside = x >= 5 && x < 21 && y >= 6 && y < 19 && c == 1;
                assert_true(part.pixels[i] == (inside ? whole.pixels[i] : -7));
            }
    RetexImage wrong = {0};
    test_must(retex_image_alloc(&wrong, 40, 31, 3, &err), &err);
    assert_int_equal(retex_combine(&wrong, set, NULL, NULL, 1, &err), RETEX_EINVAL);
    retex_image_free(&wrong);
    retex_image_free(&whole);
    retex_image_free(&part);
    retex_set_close(&set);
}

static void test_mistakes(void **state)
{
    (void)state;
    RetexSet *set = test_set(8, 8, 6), *other = test_set(9, 8, 6);
    RetexError err = {0};
    RetexTextureSpec specs[2] = {constant_spec("Wall", 1, 1, 1), constant_spec("wall", 0, 0, 0)};
    const int nparts = set->nparts;
    assert_int_equal(retex_sample(set, specs, 2, 1, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "two textures"));
    strcpy(specs[0].target, "Ceiling");
    assert_int_equal(retex_sample(set, specs, 1, 1, &err), RETEX_ENOTFOUND);
    assert_non_null(strstr(err.message, "Floor, Wall"));
    lay(other, specs + 1, 1, 1);
    assert_int_equal(retex_set_lay(set, other, &err), RETEX_EINVAL);
    assert_int_equal(set->nparts, nparts);
    assert_false(retex_set_has_laid(set));
    RetexImage picture = {0};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    params.cross = 1;
    assert_int_equal(retex_combine(&picture, set, &params, NULL, 1, &err), RETEX_EINVAL);
    set->terms[0].radiance = 999;
    assert_int_equal(retex_combine(&picture, set, NULL, NULL, 1, &err), RETEX_EFORMAT);
    retex_set_close(&set);
    retex_set_close(&other);
}

/* What is laid on one set is moved to another of the same render, and stays beside what is laid there. */
static void test_lay(void **state)
{
    (void)state;
    RetexSet *set = test_set(12, 8, 6), *both = test_set(12, 8, 6), *wall = test_set(12, 8, 6),
             *other = test_set(13, 8, 6);
    RetexError err = {0};
    RetexTextureSpec specs[2] = {constant_spec("Floor", 1, 0.5f, 0), constant_spec("Wall", 0, 0.5f, 1)};
    const int nparts = set->nparts;
    lay(set, specs, 1, 1);
    lay(wall, specs + 1, 1, 1);
    lay(both, specs, 2, 1);
    lay(other, specs, 1, 1);
    assert_int_equal(retex_set_lay(set, other, &err), RETEX_EINVAL);
    test_must(retex_set_lay(set, wall, &err), &err);
    assert_int_equal(set->nparts, both->nparts);
    for (int f = 0; f < both->nfootprints; f++)
        assert_memory_equal(test_laid(set, f)->pixels, test_laid(both, f)->pixels, 12 * 8 * 3 * sizeof(float));
    for (int t = 0; t < set->ntargets; t++)
        assert_string_equal(set->targets[t].texture, both->targets[t].texture);
    assert_false(retex_set_has_laid(wall));
    retex_set_lift(set, retex_set_find_target(set, "Floor"));
    for (int f = 0; f < set->nfootprints; f++)
        assert_int_equal(test_laid(set, f) != NULL, set->footprints[f].target == retex_set_find_target(set, "Wall"));
    retex_set_lift(set, -1);
    assert_int_equal(set->nparts, nparts);
    retex_set_close(&set);
    retex_set_close(&both);
    retex_set_close(&wall);
    retex_set_close(&other);
}

/* The kernel against its scalar meaning, and both timed. */
static void test_kernel(void **state)
{
    (void)state;
    enum { N = 1541 };
    static RetexImage images[1 + RETEX_MAX_FACTORS];
    const float *factors[RETEX_MAX_FACTORS];
    for (uint32_t i = 0; i <= RETEX_MAX_FACTORS; i++)
        test_random_image(&images[i], N, 1, 1, i, 0, 2);
    for (int k = 0; k < RETEX_MAX_FACTORS; k++)
        factors[k] = images[1 + k].pixels;
    for (int nfactors = 0; nfactors <= RETEX_MAX_FACTORS; nfactors++)
        for (size_t n = 0; n <= N; n += n < 9 ? 1 : 766) {
            float sum[N], want[N];
            for (size_t i = 0; i < N; i++)
                sum[i] = want[i] = (float)i;
            for (size_t i = 0; i < n; i++) {
                float product = images[0].pixels[i];
                for (int k = 0; k < nfactors; k++)
                    product *= factors[k][i];
                want[i] += product;
            }
            retex_combine_term_kernel(sum, images[0].pixels, factors, nfactors, n);
            assert_memory_equal(sum, want, sizeof sum);
        }
    for (int i = 0; i <= RETEX_MAX_FACTORS; i++)
        retex_image_free(&images[i]);
}

static void test_speed(void **state)
{
    (void)state;
    RetexSet *set = test_set(1280, 720, 8);
    RetexImage picture = {0};
    RetexError err = {0};
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    clock_t began = clock();
    test_must(retex_combine(&picture, set, NULL, NULL, 1, &err), &err);
    double fast = (double)(clock() - began) / CLOCKS_PER_SEC;
    volatile double sink = 0;
    began = clock();
    for (size_t i = 0; i < 1280 * 720 * 3; i++)
        sink = sink + reference_value(set, 3, i);
    double slow = (double)(clock() - began) / CLOCKS_PER_SEC;
    print_message("%d terms at 1280 x 720: %.1f ms a core, %.1f times the reference\n", set->nterms, 1e3 * fast,
                  slow / fast);
    retex_image_free(&picture);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reference), cmocka_unit_test(test_samples), cmocka_unit_test(test_transparent),
        cmocka_unit_test(test_threads),   cmocka_unit_test(test_region),  cmocka_unit_test(test_mistakes),
        cmocka_unit_test(test_lay),       cmocka_unit_test(test_kernel),  cmocka_unit_test(test_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
