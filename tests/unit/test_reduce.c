/* A set of fewer pixels has the light of the blocks, by term, and footprints with their moments: compared with loops
 * over the definition. */
#include "lib_compact.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static const int scales[] = {2, 3, 4, 6, 8};
enum { SCALES = sizeof scales / sizeof *scales };

static RetexSet *reduced(const RetexSet *set, int scale, int nthreads)
{
    RetexError err = {0};
    RetexSet *small;
    test_must(retex_set_reduce(&small, set, scale, nthreads, &err), &err);
    assert_int_equal(small->width, (set->width + scale - 1) / scale);
    assert_int_equal(small->height, (set->height + scale - 1) / scale);
    return small;
}

/* The mean over a block of a sum of parts: of those terms of a set that have this number of hits, and of these the
 * first on this footprint's target and of its kind, where the set has the footprint. */
static double mean_light(const RetexSet *set, int bx, int by, int scale, const RetexTerm *like, int c)
{
    double sum = 0;
    int pixels = 0;
    for (int y = by * scale; y < (by + 1) * scale && y < set->height; y++)
        for (int x = bx * scale; x < (bx + 1) * scale && x < set->width; x++) {
            pixels++;
            for (int t = 0; t < set->nterms; t++) {
                const RetexTerm *term = &set->terms[t];
                if (term->role == like->role && term->target == like->target && term->nfactors == like->nfactors)
                    sum += (double)pixel(set, term->radiance, x, y)[c];
            }
        }
    return sum / pixels;
}

/* With weights of unknown sums the light of mixtures is that of single terms; it is the same in total. */
static void light_stays_by_term(void **state)
{
    (void)state;
    for (int s = 0; s < SCALES; s++) {
        RetexSet *set = whole_set(2, 4), *small = reduced(set, scales[s], 2);
        assert_int_equal(small->nterms, set->nterms);
        assert_int_equal(small->nfootprints, set->nfootprints);
        for (int t = 0; t < set->nterms; t++)
            for (int y = 0; y < small->height; y++)
                for (int x = 0; x < small->width; x++)
                    for (int c = 0; c < 3; c++) {
                        const double was = mean_light(set, x, y, scales[s], &set->terms[t], c);
                        assert_float_equal(mean_light(small, x, y, 1, &set->terms[t], c), was, 1e-3 * was + 1e-6);
                    }
        retex_set_close(&set);
        retex_set_close(&small);
    }
}

/* The mean of a picture over a block. */
static double mean_of(const RetexImage *image, int bx, int by, int scale, int c)
{
    double sum = 0;
    int pixels = 0;
    for (int y = by * scale; y < (by + 1) * scale && y < image->height; y++)
        for (int x = bx * scale; x < (bx + 1) * scale && x < image->width; x++, pixels++)
            sum += (double)image->pixels[retex_image_index(image, x, y) + (size_t)c];
    return sum / pixels;
}

static void expect_averaged(const RetexSet *set, const RetexSet *small, int scale, const float *constant, double most)
{
    RetexImage whole = picture(set, constant), averaged = picture(small, constant);
    for (int y = 0; y < small->height; y++)
        for (int x = 0; x < small->width; x++)
            for (int c = 0; c < 3; c++) {
                const double is = (double)averaged.pixels[retex_image_index(&averaged, x, y) + (size_t)c];
                const double was = mean_of(&whole, x, y, scale, c);
                assert_float_equal(is, was, most * was + 1e-6);
            }
    retex_image_free(&whole);
    retex_image_free(&averaged);
}

static void one_color_is_the_averaged_picture(void **state)
{
    (void)state;
    for (int s = 0; s < SCALES; s++)
        for (int count = 1; count <= 4; count += 3) {
            RetexSet *set = whole_set(2, count), *small = reduced(set, scales[s], 2);
            expect_averaged(set, small, scales[s], bright, 1e-5);
            expect_averaged(set, small, scales[s], NULL, 2e-3); /* all have one albedo; weights are rounded */
            retex_set_close(&set);
            retex_set_close(&small);
        }
}

/* One term's radiance has a pixel of light 1 and one of light 3 at known places. */
static void moments_are_merged(void **state)
{
    RetexSet *set = start_set(4, 4, 1);
    const int footprint = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGB");
    (void)state;
    add_term(set, 1, footprint, 0);
    put(set, footprint, 0, 1, 0.25f, 0.5f, 1);
    put_spread(set, footprint, 0, 1, 0.125f, 0.0625f, 0.5f);
    put_rgb(set, light_part(set, 0), 0, 1, 1, 1, 1);
    put_rgb(set, set->footprints[0].albedo, 0, 1, 1, 0.5f, 0);
    put(set, footprint, 1, 1, 0.75f, 0.25f, 0.5f);
    put_spread(set, footprint, 1, 1, 0.0625f, 0.25f, -0.25f);
    put_rgb(set, light_part(set, 0), 1, 1, 3, 3, 3);
    put_rgb(set, set->footprints[0].albedo, 1, 1, 0.2f, 0.5f, 0.8f);
    RetexSet *small = reduced(set, 2, 1);
    const float *uv = pixel(small, small->footprints[0].uv, 0, 0);
    const float *spread = pixel(small, small->footprints[0].spread, 0, 0);
    const double u = 0.625, v = 0.3125; /* means */
    const double uu = (0.125 * 0.125 + 3 * 0.0625 * 0.0625) / 4 + (0.375 * 0.375 + 3 * 0.125 * 0.125) / 4;
    const double vv = (0.0625 * 0.0625 + 3 * 0.25 * 0.25) / 4 + (0.1875 * 0.1875 + 3 * 0.0625 * 0.0625) / 4;
    const double covariance =
        (0.5 * 0.125 * 0.0625 - 3 * 0.25 * 0.0625 * 0.25) / 4 - (0.375 * 0.1875 + 3 * 0.125 * 0.0625) / 4;
    assert_float_equal(uv[0], u, sqrt(uu) / 32);
    assert_float_equal(uv[1], v, sqrt(vv) / 32);
    assert_float_equal(uv[2], 1.5 / 4, 2e-3);
    assert_float_equal(spread[0], sqrt(uu), sqrt(uu) / 100);
    assert_float_equal(spread[1], sqrt(vv), sqrt(vv) / 100);
    assert_float_equal(spread[2], covariance / sqrt(uu * vv), 0.02);
    EXPECT(1e-3f, pixel(small, light_part(small, 0), 0, 0), 1, 1, 1);
    EXPECT(1e-3f, pixel(small, small->footprints[0].albedo, 0, 0), 0.4f, 0.5f, 0.6f);
    assert_true(pixel(small, small->footprints[0].uv, 1, 1)[2] == 0);
    assert_int_equal(small->spp, 4 * set->spp);
    retex_set_close(&set);
    retex_set_close(&small);
}

/* Of two footprints in each pixel, the near ones of all pixels are merged, and the far ones, whose light stays theirs:
 * also where the order of the members changes from pixel to pixel. */
static void light_goes_with_its_footprint(void **state)
{
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_SHARP, 2);
    (void)state;
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        for (int k = 0; k < 2; k++) {
            const int far = (i + k) % 2, x = i % WIDTH, y = i / WIDTH;
            put(set, k, x, y, far ? 0.75f : 0.25f, 0.5f, 0.5f);
            put_spread(set, k, x, y, 0.01f, 0.01f, 0);
            put_rgb(set, light_part(set, k), x, y, far ? 1 : 0, far ? 0 : 2, (float)k);
        }
    RetexSet *small = reduced(set, 4, 1);
    for (int k = 0; k < 2; k++) {
        EXPECT(1e-3f, pixel(small, small->footprints[k].uv, 1, 0), k ? 0.75f : 0.25f, 0.5f, 0.5f);
        EXPECT(1e-3f, pixel(small, light_part(small, k), 1, 0), k ? 1 : 0, k ? 0 : 2, 0.5f);
    }
    retex_set_close(&set);
    retex_set_close(&small);
}

/* A mixture of near and far footprints, in a dark pixel of near ones and three bright ones of far ones. Weights are
 * relative to their sum in the pixel. */
static void weights_follow_light(void **state)
{
    RetexSet *set = again_set(RETEX_FOOTPRINT_SHARP, 2);
    (void)state;
    for (int i = 0; i < 4; i++) {
        const int x = i % 2, y = i / 2;
        for (int f = 0; f < 4; f++) {
            put(set, f, x, y, f % 2 ? 0.75f : 0.25f, 0.5f, 0.5f);
            put_spread(set, f, x, y, 0.01f, 0.01f, 0);
            put_share(set, f, x, y, i == 0 ? (f % 2 ? 0 : 8) : (f % 2 ? 3 : 1));
        }
        put_light(set, 0, x, y, 1);
        put_light(set, 1, x, y, 1);
        put_again(set, x, y, i == 0 ? 1 : 3);
    }
    RetexSet *small = reduced(set, 2, 1);
    /* light 1 is all near, of light 9 a quarter */
    const float near_share = (1 + 9 * 0.25f) / 10;
    for (int f = 0; f < 4; f++)
        assert_float_equal(*pixel(small, share_part(small, f), 0, 0), (f % 2 ? 1 - near_share : near_share), 2e-3);
    retex_set_close(&set);
    retex_set_close(&small);
}

/* A parallelogram in quarters of light 1 to 4, u = x / 8, v = y / 8 in its middle; one pixel, if any, is off. */
static RetexSet *set_of_quarters(int width, int height, int off)
{
    RetexSet *set = start_set(width, height, 1);
    RetexError err = {0};
    RetexFootprint f = {.target = 0, .kind = RETEX_FOOTPRINT_SHARP, .hit = 9};
    add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGB");
    add_term(set, 1, 0, 0);
    f.uv = add_part(set, "RGA", "whole", 0), f.spread = add_part(set, "RGBA", "axes", 0);
    f.albedo = add_part(set, "RGB", "whole-albedo", 0);
    for (f.quadrant = 1; f.quadrant <= RETEX_QUADRANTS; f.quadrant++) {
        test_must(retex_set_add_footprint(set, &f, NULL, &err), &err);
        const int light = add_term(set, 1, f.quadrant, 0);
        for (int i = 0; i < width * height; i++)
            put_rgb(set, light, i % width, i / width, (float)f.quadrant, (float)(i % width), (float)(i / width));
    }
    for (int i = 0; i < width * height; i++) {
        const float axes[] = {0.125f, 0, 0, 0.125f};
        put(set, 1, i % width, i / width, ((float)(i % width) + 0.5f) / 8 + (i == off ? 0.1f : 0),
            ((float)(i / width) + 0.5f) / 8, 1);
        memcpy(pixel(set, f.spread, i % width, i / width), axes, sizeof axes);
    }
    return set;
}

/* The block's quarters have the light of the pixels' quarters that are in them, also those of an odd number. */
static void parallelograms_become_larger(void **state)
{
    (void)state;
    for (int scale = 2; scale <= 4; scale++) {
        RetexSet *set = set_of_quarters(2 * scale, scale, -1), *small = reduced(set, scale, 1);
        const float middle = (float)scale / 16, side = (float)scale / 8;
        EXPECT(1e-3f, pixel(small, small->footprints[1].uv, 1, 0), 3 * middle, middle, 1);
        EXPECT(1e-3f, pixel(small, small->footprints[1].spread, 1, 0), side, 0, 0, side);
        for (int q = 0; q < RETEX_QUADRANTS; q++) {
            double sum[3] = {0};
            for (int i = 0; i < 4 * scale * scale; i++) { /* quarters of pixels */
                const int x = i % (2 * scale), y = i / (2 * scale);
                if ((x >= scale) + 2 * (y >= scale) != q)
                    continue;
                sum[0] += 1 + x % 2 + 2 * (y % 2);
                sum[1] += scale + x / 2, sum[2] += y / 2;
            }
            for (int c = 0; c < 3; c++)
                assert_float_equal(pixel(small, light_part(small, 1 + q), 1, 0)[c], sum[c] / (scale * scale), 1e-3);
        }
        assert_true(pixel(small, small->footprints[0].uv, 1, 0)[2] == 0);
        retex_set_close(&set);
        retex_set_close(&small);
    }
}

/* Where pixels are not one parallelogram, they become ellipses with the same light. */
static void bent_parallelograms_become_ellipses(void **state)
{
    RetexSet *set = set_of_quarters(4, 2, 0), *small = reduced(set, 2, 1);
    double all = 0;
    (void)state;
    assert_true(pixel(small, small->footprints[1].uv, 0, 0)[2] == 0);
    assert_true(pixel(small, small->footprints[1].uv, 1, 0)[2] > 0);
    assert_true(pixel(small, small->footprints[0].uv, 0, 0)[2] > 0);
    for (int k = 0; k < 5; k++)
        all += (double)pixel(small, light_part(small, k), 0, 0)[0];
    assert_float_equal(all, 10, 1e-2);
    assert_float_equal(pixel(small, light_part(small, 0), 0, 0)[0], 10, 1e-2);
    retex_set_close(&set);
    retex_set_close(&small);
}

/* Surfaces that close: near 0 and near 1 are the same place. */
static void closed_surfaces_merge_across_the_seam(void **state)
{
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_SHARP, 1);
    (void)state;
    set->targets[0].periodic[0] = 1;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        put(set, 0, i % WIDTH, i / WIDTH, i % 2 ? 0.99f : 0.01f, 0.5f, 1);
        put_light(set, 0, i % WIDTH, i / WIDTH, 1);
    }
    RetexSet *small = reduced(set, 4, 1);
    const float *uv = pixel(small, small->footprints[0].uv, 0, 0);
    assert_true(uv[0] < 0.005f || uv[0] > 0.995f);
    assert_float_equal(pixel(small, small->footprints[0].spread, 0, 0)[0], 0.01, 1e-3);
    retex_set_close(&set);
    retex_set_close(&small);
}

/* Depths are those in the middle of the block, originals are averaged, and data for denoising is left out. */
static void other_parts(void **state)
{
    RetexSet *set = whole_set(1, 2);
    RetexError err = {0};
    int depth, original, noise;
    (void)state;
    test_must(retex_set_add_part(set, "depth", "R", RETEX_FLOAT, 0, 0, &depth, &err), &err);
    test_must(retex_set_add_part(set, "original_T0", "RGB", RETEX_FLOAT, 7, 4, &original, &err), &err);
    test_must(retex_set_add_part(set, "guide_normal", "RGB", RETEX_HALF, 0, 0, &noise, &err), &err);
    set->targets[0].original = original;
    for (int i = 0; i < WIDE * HIGH; i++)
        *pixel(set, depth, i % WIDE, i / WIDE) = i == 0 ? INFINITY : (float)i;
    for (int i = 0; i < 28; i++)
        put_rgb(set, original, i % 7, i / 7, (float)(i % 7), (float)(i / 7), 1);
    RetexSet *small = reduced(set, 4, 1);
    const int small_depth = retex_set_find_part(small, "depth"), texture = small->targets[0].original;
    assert_true(*pixel(small, small_depth, 0, 0) == 2 * WIDE + 2);
    assert_true(*pixel(small, small_depth, 12, 9) == 36 * WIDE + 49); /* the last block has two pixels */
    assert_int_equal(small->parts[texture].image.width, 2);
    assert_int_equal(small->parts[texture].image.height, 1);
    EXPECT(1e-5f, pixel(small, texture, 0, 0), (1 + 2 + 0.5f * 3) / 3.5f, 1.5f, 1);
    assert_int_equal(retex_set_find_part(small, "guide_normal"), -1);
    retex_set_close(&set);
    retex_set_close(&small);
}

static void threads_and_files_make_no_difference(void **state)
{
    RetexSet *set = whole_set(2, 3), *opened = NULL;
    RetexError err = {0};
    char path[] = "/tmp/test_reduce_XXXXXX";
    const int file = mkstemp(path);
    (void)state;
    assert_true(file >= 0);
    close(file);
    test_must(retex_set_write(set, path, NULL, 1, &err), &err);
    test_must(retex_set_open(path, &opened, 1, &err), &err);
    RetexSet *of[] = {reduced(set, 4, 1), reduced(set, 4, 3), reduced(opened, 4, 2)};
    for (int i = 1; i < 3; i++)
        for (int p = 0; p < of[0]->nparts; p++) {
            const RetexImage *a = &of[0]->parts[p].image, *b = &of[i]->parts[p].image;
            const size_t bytes = (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float);
            assert_memory_equal(a->pixels, b->pixels, bytes);
        }
    for (int i = 0; i < 3; i++)
        retex_set_close(&of[i]);
    retex_set_close(&set);
    retex_set_close(&opened);
    unlink(path);
}

static void expect_refused(RetexSet *set, int scale, int code, const char *message)
{
    RetexError err = {0};
    RetexSet *small = set;
    assert_int_equal(retex_set_reduce(&small, set, scale, 1, &err), code);
    assert_null(small);
    assert_string_equal(err.message, message);
    retex_set_close(&set);
}

static void what_cannot_be_reduced(void **state)
{
    RetexSet *set = whole_set(1, 2);
    (void)state;
    expect_refused(set, 5, RETEX_EINVAL, "a set is reduced by 2, 3, 4, 6 or 8, not by 5");
    set = whole_set(1, 2);
    RetexSet *compact = compacted(set, 4, 8, 4);
    retex_set_close(&set);
    expect_refused(compact, 2, RETEX_EUNSUPPORTED,
                   "the set cannot be reduced: its images have several sizes, as those of packs have");
    expect_refused(test_set(16, 9, 1), 2, RETEX_EUNSUPPORTED,
                   "the set cannot be reduced: it is not of layout footprints");
    set = whole_set(1, 2);
    set->terms[1].radiance = set->terms[2].radiance;
    expect_refused(set, 2, RETEX_EUNSUPPORTED, "the set cannot be reduced: its parts are used for several things");
}

/* A term of one of two footprints is missing, as it never had light: the other's light may come to it. */
static void missing_terms_are_added(void **state)
{
    RetexSet *set = cluster_set(RETEX_FOOTPRINT_BROAD, 2);
    int far = 0;
    (void)state;
    set->nterms--;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        put(set, 0, i % WIDTH, i / WIDTH, i % 2 ? 0.75f : 0.25f, 0.5f, 1);
        put_light(set, 0, i % WIDTH, i / WIDTH, i % 2 ? 3 : 1);
    }
    RetexSet *small = reduced(set, 2, 1);
    assert_int_equal(small->nterms, 3);
    assert_int_equal(small->terms[2].factors[0].index, 1);
    for (int k = 0; k < 2; k++) {
        const int is_far = pixel(small, small->footprints[k].uv, 0, 0)[0] > 0.5f;
        EXPECT(3e-3f, pixel(small, light_part(small, k), 0, 0), 0.5f + is_far, 0.5f + is_far, 0.5f + is_far);
        far += is_far;
    }
    assert_int_equal(far, 1);
    retex_set_close(&set);
    retex_set_close(&small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_stays_by_term),
        cmocka_unit_test(one_color_is_the_averaged_picture),
        cmocka_unit_test(moments_are_merged),
        cmocka_unit_test(light_goes_with_its_footprint),
        cmocka_unit_test(weights_follow_light),
        cmocka_unit_test(parallelograms_become_larger),
        cmocka_unit_test(bent_parallelograms_become_ellipses),
        cmocka_unit_test(closed_surfaces_merge_across_the_seam),
        cmocka_unit_test(other_parts),
        cmocka_unit_test(threads_and_files_make_no_difference),
        cmocka_unit_test(what_cannot_be_reduced),
        cmocka_unit_test(missing_terms_are_added),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
