/* Normal maps: weights of a texel as sums of normals, placed and mirrored; textures that share texels; which way green
 * points; what sets may say of normals. */
#include "lib_error.h"
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include <retex/edit.h>
#include <retex/host/texture_lookup.h>
#include <retex/set.h>

#include "texture/folder.h"
#include "texture/normal_map.h"

enum { TEXELS = 8 };
#define TILT 15.0

static char folder[] = "/tmp/retex-normal-maps-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char path[128];
    (void)state;
    snprintf(path, sizeof path, "%s/map.exr", folder);
    unlink(path);
    return rmdir(folder);
}

static unsigned seed = 1;
static double number(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (double)(seed >> 8) / (1 << 24);
}

/* The normal that weights stand for. */
static void normal_of(const float weights[4], double n[3])
{
    const double s = sin(TILT * M_PI / 180), c = cos(TILT * M_PI / 180);
    n[0] = (double)weights[1] * s;
    n[1] = (double)weights[2] * s;
    n[2] = (double)weights[0] + (double)(weights[1] + weights[2]) * c;
}

/* From the surface to the texture, as retex-edit(5) has it, without sizes. */
static void place(const RetexTextureSpec *spec, double n[3])
{
    const double a = spec->rotate * M_PI / 180, x = n[0] * (spec->scale[0] < 0 ? -1 : 1),
                 y = n[1] * (spec->scale[1] < 0 ? -1 : 1);
    n[0] = (cos(a) * x - sin(a) * y) * (spec->flip[0] ? -1 : 1);
    n[1] = (sin(a) * x + cos(a) * y) * (spec->flip[1] ? -1 : 1);
}

static void check_normal(const RetexTextureSpec *spec, int is_dx, const int mirrored[2])
{
    const double x = number() - 1.02, y = number() + 0.02, z = 0.5 + number(), length = sqrt(x * x + y * y + z * z);
    const float rgba[4] = {(float)(0.5 + x / length / 2), (float)(0.5 + y / length / 2), (float)(0.5 + z / length / 2),
                           1};
    float weights[4];
    double n[3];
    retex_normal_map_weights(spec, is_dx, mirrored, rgba, weights);
    assert_float_equal(weights[0] + weights[1] + weights[2] + weights[3], 1, 1e-5);
    normal_of(weights, n);
    place(spec, n);
    assert_float_equal(n[0], x / length * (mirrored[0] ? -1 : 1), 1e-5);
    assert_float_equal(n[1], y / length * (mirrored[1] ? -1 : 1) * (is_dx ? -1 : 1), 1e-5);
    assert_float_equal(n[2], z / length, 1e-5);
}

static void normals_turn_with_the_texture(void **state)
{
    (void)state;
    for (int i = 0; i < 64; i++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        const int mirrored[2] = {i >> 4 & 1, i >> 5 & 1};
        spec.normal_tilt = TILT;
        spec.rotate = i & 8 ? 90 * (i % 5) : 720 * number() - 360;
        spec.scale[0] = i & 1 ? -2 : 3, spec.scale[1] = i & 2 ? -0.5 : 1;
        spec.flip[0] = i & 4, spec.flip[1] = i % 3 == 0;
        check_normal(&spec, i % 7 == 0, mirrored);
    }
}

static void check_weights(const float rgba[4], double w0, double w1, double w2)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    const int mirrored[2] = {0, 0};
    float weights[4];
    spec.normal_tilt = TILT;
    retex_normal_map_weights(&spec, 0, mirrored, rgba, weights);
    assert_float_equal(weights[0], w0, 1e-5);
    assert_float_equal(weights[1], w1, 1e-5);
    assert_float_equal(weights[2], w2, 1e-5);
}
#define TEXEL(...) ((const float[4]){__VA_ARGS__})

static void texels_that_say_nothing_are_flat(void **state)
{
    (void)state;
    const float s = (float)sin(TILT * M_PI / 180), c = (float)cos(TILT * M_PI / 180);
    check_weights(TEXEL(128 / 255.0f, 127 / 255.0f, 1, 1), 1, 0, 0); /* the nearest that 8 bits have */
    check_weights(TEXEL(0.5f, 0.5f, 0.75f, 1), 1, 0, 0);
    check_weights(TEXEL(0, 0, 0, 0), 1, 0, 0); /* clear */
    check_weights(TEXEL(0.5f, 0.5f, 0.5f, 1), 1, 0, 0);
    check_weights(TEXEL(NAN, 0.5f, 1, 1), 1, 0, 0);
    check_weights(TEXEL(INFINITY, 0.5f, 1, 1), 1, 0, 0);
    check_weights(TEXEL(0.5f + s / 2, 0.5f, 0.5f + c / 2, 1), 0, 1, 0); /* the tilted ones themselves */
    check_weights(TEXEL(0.5f, 0.5f + s / 2, 0.5f + c / 2, 1), 0, 0, 1);
    check_weights(TEXEL(1, 0.5f, 0, 1), (double)(-c / s), (double)(1 / s), 0); /* not from below */
}

/* ---- textures ---- */

static RetexTextureSpec write_map(void)
{
    RetexImage im = {0};
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    params.is_data = 1;
    snprintf(spec.finish, sizeof spec.finish, "%s/map.exr", folder);
    test_must(retex_image_alloc(&im, TEXELS, TEXELS, 3, &err), &err);
    for (int i = 0; i < 3 * TEXELS * TEXELS; i++)
        im.pixels[i] = (float)(0.25 + number() / 2 + (i % 3 == 2 ? 0.25 : 0));
    test_must(retex_image_write(&im, spec.finish, &params, 1, &err), &err);
    retex_image_free(&im);
    spec.constant = 1;
    spec.color[0] = 0.5f;
    spec.normal = RETEX_NORMAL_GL;
    spec.nfinishes = 3;
    spec.normal_tilt = TILT;
    return spec;
}

static void look_up(const RetexTexture *texture, double u, double v, double n[3])
{
    float weights[4];
    assert_int_equal(retex_texture_finishes(texture, u, v, 0, weights), 3);
    normal_of(weights, n);
}

/* Repeats that are mirrored along an axis have the other sign along it, and are else those of wrap = repeat. */
static void mirrored_repeats_mirror_normals(void **state)
{
    (void)state;
    RetexError err = {0};
    for (int k = 1; k < 5; k++) {
        RetexTextureSpec spec = write_map();
        RetexTexture *plain = NULL, *texture = NULL;
        test_must(retex_texture_load(&plain, &spec, 1, &err), &err);
        for (int axis = 0; axis < 2 && k < 4; axis++)
            spec.wrap[axis] = k >> axis & 1 ? RETEX_WRAP_MIRROR : RETEX_WRAP_REPEAT;
        spec.repeat = k == 4 ? RETEX_REPEAT_MIRROR : RETEX_REPEAT_STRAIGHT;
        test_must(retex_texture_load(&texture, &spec, 2, &err), &err);
        for (int i = 0; i < 100; i++) {
            /* inside of a repeat, half a texel from its border: beyond, both interpolate with another texel */
            const double at[2] = {(0.5 + (TEXELS - 1) * number()) / TEXELS, (0.5 + (TEXELS - 1) * number()) / TEXELS};
            double n[3], expected[3], place_of[2];
            look_up(plain, at[0], at[1], expected);
            for (int axis = 0; axis < 2; axis++) {
                const int turn = (int)(6 * number()) - 3, is_mirrored = (k == 4 || k >> axis & 1) && turn % 2 != 0;
                place_of[axis] = turn + (is_mirrored ? 1 - at[axis] : at[axis]);
                expected[axis] *= is_mirrored ? -1 : 1;
            }
            look_up(texture, place_of[0], place_of[1], n);
            for (int c = 0; c < 3; c++)
                assert_float_equal(n[c], expected[c], 1e-5);
        }
        retex_texture_close(&plain);
        retex_texture_close(&texture);
    }
}

/* Across the border of a mirrored repeat the component along the axis is 0 in the middle. */
static void mirrored_repeats_meet(void **state)
{
    (void)state;
    RetexTextureSpec spec = write_map();
    RetexTexture *texture = NULL;
    RetexError err = {0};
    spec.repeat = RETEX_REPEAT_MIRROR;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    for (int i = 0; i < 20; i++) {
        double n[3];
        look_up(texture, (double)(i % 4), number(), n);
        assert_float_equal(n[0], 0, 1e-5);
        look_up(texture, number(), (double)(i % 4), n);
        assert_float_equal(n[1], 0, 1e-5);
    }
    retex_texture_close(&texture);
}

static void only_the_same_turn_shares_texels(void **state)
{
    (void)state;
    char path[128];
    RetexTextureSpec spec = write_map();
    RetexTexture *texture = NULL, *placed = NULL, *own = NULL;
    RetexError err = {0};
    snprintf(path, sizeof path, "%s/map.exr", folder);
    strcpy(spec.image, path);
    spec.constant = 0, spec.rotate = 30, spec.repeat = RETEX_REPEAT_MIRROR;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    RetexTextureSpec other = spec;
    other.scale[0] = 2, other.scale[1] = 3, other.offset[0] = 0.3;
    test_must(retex_texture_place(&placed, texture, &other, &err), &err);
    test_must(retex_texture_load(&own, &other, 1, &err), &err);
    for (int i = 0; i < 20; i++) {
        double a[3], b[3];
        const double u = 3 * number(), v = 3 * number();
        look_up(placed, u, v, a);
        look_up(own, u, v, b);
        for (int c = 0; c < 3; c++)
            assert_float_equal(a[c], b[c], 1e-6);
    }
    retex_texture_close(&placed);
    retex_texture_close(&own);
    for (int k = 0; k < 5; k++) {
        other = spec;
        if (k == 0)
            other.rotate = 31;
        else if (k < 3)
            other.flip[k - 1] = 1;
        else if (k == 3)
            other.scale[1] = -1;
        else
            other.normal = RETEX_NORMAL_DX;
        assert_int_equal(retex_texture_place(&placed, texture, &other, &err), RETEX_EINVAL);
    }
    retex_texture_close(&texture);
}

/* ---- names, options and sets ---- */

static void names_tell_where_green_points(void **state)
{
    (void)state;
    static const char *const down[] = {"wall_nor_dx_2k.png", "a/Bricks075_1K-JPG_NormalDX.jpg", "x-normal-DirectX.exr"},
                             *const up[] = {"wall_nor_gl_2k.png", "Bricks_NormalGL.jpg", "normal.png", "dx.png", "dx",
                                            "nor_dx/wall.png",    "wall_nor_dx"};
    for (size_t k = 0; k < sizeof down / sizeof *down; k++)
        assert_true(retex_texture_name_is_dx(down[k]));
    for (size_t k = 0; k < sizeof up / sizeof *up; k++)
        assert_false(retex_texture_name_is_dx(up[k]));
}

static void sets_have_normals_of_three_finishes(void **state)
{
    (void)state;
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_set_create(&set, 4, 4, &err), &err);
    RetexTarget target = {.name = "Wall", .original = -1, .nfinishes = 3, .finish = 1, .normal_tilt = TILT};
    test_must(retex_set_add_target(set, &target, NULL, &err), &err);
    assert_float_equal(retex_set_target(set, 0)->normal_tilt, TILT, 0);
    RetexTarget wrong[4] = {target, target, target, target};
    wrong[0].normal_tilt = 90, wrong[1].normal_tilt = NAN, wrong[2].finish = 2, wrong[3].nfinishes = 2;
    for (int k = 0; k < 4; k++)
        assert_int_equal(retex_set_add_target(set, &wrong[k], NULL, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_turn_with_the_texture),       cmocka_unit_test(texels_that_say_nothing_are_flat),
        cmocka_unit_test(mirrored_repeats_mirror_normals),     cmocka_unit_test(mirrored_repeats_meet),
        cmocka_unit_test(only_the_same_turn_shares_texels),    cmocka_unit_test(names_tell_where_green_points),
        cmocka_unit_test(sets_have_normals_of_three_finishes),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
