/* Layers: every look-up is that of the textures one by one, laid over each other; placement, squares and surfaces go to
 * all of them. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/filter.h"
#include "texture/layer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/host/texture_lookup.h>
#include <retex/image_file.h>

#include <cmocka.h>

enum { POINTS = 200 };
static char names[3][64];

/* Images with alpha, in files. */
static int write_images(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        RetexImage im = {0};
        RetexError err = {0};
        test_random_image(&im, 24 + 8 * k, 16, 4, (uint32_t)k + 5, 0, 1);
        snprintf(names[k], sizeof names[k], "/tmp/retex-layers-%ld-%d.exr", (long)getpid(), k);
        test_must(retex_image_write(&im, names[k], NULL, 1, &err), &err);
        retex_image_free(&im);
    }
    return 0;
}

static int remove_images(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++)
        unlink(names[k]);
    return 0;
}

static RetexTextureSpec layer_of(int image, double x, double y, double width, double rotate)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.image, names[image]);
    strcpy(spec.target, "T");
    spec.wrap[0] = spec.wrap[1] = RETEX_WRAP_BLACK;
    spec.width[0] = width;
    spec.rotate = rotate;
    spec.has_at = 1;
    spec.at[0] = x, spec.at[1] = y;
    spec.uv_scale[0] = 2, spec.uv_scale[1] = 3;
    return spec;
}

/* The whole: an image, or the original, and two layers. */
static RetexTextureSpec whole_of(const RetexTextureSpec layers[2], int is_original)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    if (!is_original)
        strcpy(spec.image, names[0]);
    strcpy(spec.target, "T");
    spec.uv_scale[0] = 2, spec.uv_scale[1] = 3;
    spec.nlayers = 2;
    for (int k = 0; k < 2; k++)
        test_must(retex_texture_layer_set(&spec, k, &layers[k], &err), &err);
    return spec;
}

static RetexTexture *load(const RetexTextureSpec *spec)
{
    RetexTexture *texture;
    RetexError err = {0};
    test_must(retex_texture_load(&texture, spec, 1, &err), &err);
    return texture;
}

/* Sums of what each has of the light: the upper one's colour by its alpha, then what is left. */
static void lay(double sum[4], double *left, const float rgba[4])
{
    for (int c = 0; c < 3; c++)
        sum[c] += *left * (double)rgba[3] * (double)rgba[c];
    sum[3] += *left * (double)rgba[3];
    *left *= 1 - (double)rgba[3];
}

static void assert_sum(const float rgba[4], const double sum[4])
{
    assert_float_equal((double)rgba[3], sum[3], 1e-5);
    for (int c = 0; c < 3; c++)
        assert_float_equal((double)(rgba[c] * rgba[3]), sum[c], 2e-5);
}

enum { LOOK_UPS = 5 };

/* All look-ups of a footprint. */
static void look_up(const RetexTexture *texture, double u, double v, double s, float rgba[LOOK_UPS][4])
{
    const double covariance[3] = {s * s, 0.2 * s * s, s * s}, axes[2][2] = {{s, 0.1 * s}, {-0.2 * s, s}};
    const float uv[3] = {(float)u, (float)v, 1}, spread[3] = {(float)s, (float)s, 0.2f};
    retex_texture_point(texture, u, v, rgba[0]);
    filter_gaussian(texture, u, v, covariance, rgba[1]);
    filter_disc(texture, u, v, covariance, rgba[2]);
    filter_parallelogram(texture, u, v, axes, rgba[3]);
    retex_texture_filter(texture, RETEX_TEXTURE_GAUSSIAN, uv, spread, 3, 1, rgba[4], 4);
}

/* apart: from the lowest on. */
static void compare(const RetexTexture *whole, RetexTexture *const apart[3])
{
    uint32_t seed = 9;
    for (int i = 0; i < POINTS; i++) {
        const double u = test_random(&seed), v = test_random(&seed), s = 0.2 * pow(test_random(&seed), 3);
        double sums[LOOK_UPS][4] = {{0}}, left[LOOK_UPS] = {1, 1, 1, 1, 1};
        float rgba[LOOK_UPS][4];
        for (int k = 2; k >= 0; k--) {
            if (!apart[k])
                continue;
            look_up(apart[k], u, v, s, rgba);
            for (int n = 0; n < LOOK_UPS; n++)
                lay(sums[n], &left[n], rgba[n]);
        }
        look_up(whole, u, v, s, rgba);
        for (int n = 0; n < LOOK_UPS; n++)
            assert_sum(rgba[n], sums[n]);
    }
}

static void test_look_ups(void **state)
{
    (void)state;
    for (int is_original = 0; is_original < 2; is_original++) {
        const RetexTextureSpec layers[2] = {layer_of(1, 0.8, 1.4, 1.1, 20), layer_of(2, 1.1, 1.7, 0.9, -70)};
        const RetexTextureSpec spec = whole_of(layers, is_original);
        RetexTextureSpec base = spec;
        base.nlayers = 0;
        RetexTexture *whole = load(&spec),
                     *apart[3] = {is_original ? NULL : load(&base), load(&layers[0]), load(&layers[1])};
        assert_false(retex_texture_is_opaque(whole));
        compare(whole, apart);
        RetexTexture *squares[4] = {NULL};
        RetexError err = {0};
        test_must(retex_texture_square(&squares[3], whole, 1, &err), &err);
        for (int k = is_original; k < 3; k++)
            test_must(retex_texture_square(&squares[k], apart[k], 1, &err), &err);
        compare(squares[3], squares);
        for (int k = 0; k < 4; k++)
            retex_texture_close(&squares[k]);
        for (int k = 0; k < 3; k++)
            retex_texture_close(&apart[k]);
        retex_texture_close(&whole);
    }
}

/* Placed anew, layers share their texels, and lie where they are told; with other images they do not. */
static void test_place(void **state)
{
    (void)state;
    const RetexTextureSpec layers[2] = {layer_of(1, 0.8, 1.4, 1.1, 20), layer_of(2, 1.1, 1.7, 0.9, -70)};
    const RetexTextureSpec moved[2] = {layer_of(1, 0.3, 0.9, 0.7, 50), layer_of(2, 1.5, 2.2, 1.3, 10)};
    const RetexTextureSpec swapped[2] = {layers[1], layers[0]};
    const RetexTextureSpec spec = whole_of(layers, 0), other = whole_of(moved, 0), wrong = whole_of(swapped, 0);
    RetexTexture *whole = load(&spec), *placed, *direct = load(&other);
    RetexError err = {0};
    float a[4], b[4];
    uint32_t seed = 2;
    test_must(retex_texture_place(&placed, whole, &other, &err), &err);
    for (int i = 0; i < POINTS; i++) {
        const double u = test_random(&seed), v = test_random(&seed);
        retex_texture_point(placed, u, v, a);
        retex_texture_point(direct, u, v, b);
        assert_memory_equal(a, b, sizeof a);
    }
    retex_texture_close(&placed);
    assert_int_equal(retex_texture_place(&placed, whole, &wrong, &err), RETEX_EINVAL);
    RetexTextureSpec surface = spec;
    surface.uv_scale[0] = 4;
    test_must(retex_texture_set_surface(whole, &surface, &err), &err);
    RetexTexture *wide = load(&surface);
    for (int i = 0; i < POINTS; i++) {
        const double u = test_random(&seed), v = test_random(&seed);
        retex_texture_point(whole, u, v, a);
        retex_texture_point(wide, u, v, b);
        assert_memory_equal(a, b, sizeof a);
    }
    retex_texture_close(&wide);
    retex_texture_close(&direct);
    retex_texture_close(&whole);
}

static void test_join(void **state)
{
    (void)state;
    const RetexTextureSpec layers[2] = {layer_of(1, 0, 0, 1, 0), layer_of(2, 0, 0, 1, 0)};
    RetexTextureSpec original = whole_of(layers, 1), base = RETEX_TEXTURE_SPEC_INIT, both = original;
    RetexError err = {0};
    strcpy(base.image, names[0]);
    test_must(retex_texture_spec_join(&both, &base, &err), &err);
    assert_true(both.nlayers == 2 && strcmp(both.image, names[0]) == 0 && strcmp(both.layers[1].image, names[2]) == 0);
    assert_int_equal(retex_texture_spec_join(&both, &base, &err), RETEX_EINVAL);
    test_must(retex_texture_spec_join(&both, &original, &err), &err);
    assert_int_equal(both.nlayers, 4);
    assert_int_equal(retex_texture_spec_join(&both, &original, &err), RETEX_EINVAL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_look_ups),
        cmocka_unit_test(test_place),
        cmocka_unit_test(test_join),
    };
    return cmocka_run_group_tests(tests, write_images, remove_images);
}
