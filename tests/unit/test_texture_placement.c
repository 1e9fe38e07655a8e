/* How a texture lies on its target: every transform is exact on points and on footprints, for means and covariances;
 * images of shifted repeats; squares. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/pyramid.h"

#include <math.h>
#include <string.h>

#include <cmocka.h>

typedef struct Map {
    double m[2][2], offset[2];
} Map;

static RetexTexture *create(const RetexImage *im, const RetexTextureSpec *spec)
{
    RetexTexture *texture;
    RetexError err = {0};
    test_must(retex_texture_create(&texture, im, spec, 0, &err), &err);
    return texture;
}

static void map_covariance(double out[3], const Map *map, const double c[3])
{
    const double(*m)[2] = map->m;
    for (int i = 0; i < 3; i++) {
        int a = i / 2, b = (i + 1) / 2;
        out[i] = m[a][0] * m[b][0] * c[0] + (m[a][0] * m[b][1] + m[a][1] * m[b][0]) * c[1] + m[a][1] * m[b][1] * c[2];
    }
}

static void assert_colors(const float a[4], const float b[4], double tolerance)
{
    for (int k = 0; k < 4; k++)
        assert_float_equal(a[k], b[k], tolerance);
}

/* `edited` at a place is `plain` at where the map takes it. */
static void compare(const RetexTexture *edited, const RetexTexture *plain, const Map *map, double smallest,
                    double largest, double tolerance, uint32_t seed)
{
    for (int i = 0; i < 150; i++) {
        double u = 4 * test_random(&seed) - 2, v = 4 * test_random(&seed) - 2, cov[3], moved[3];
        double longer = smallest * pow(largest / smallest, test_random(&seed)), angle = M_PI * test_random(&seed);
        double tu = map->m[0][0] * u + map->m[0][1] * v + map->offset[0];
        double tv = map->m[1][0] * u + map->m[1][1] * v + map->offset[1];
        float a[4], b[4];
        test_turned_covariance(cov, longer, longer * pow(6, -test_random(&seed)), angle);
        map_covariance(moved, map, cov);
        retex_texture_point(edited, u, v, a);
        retex_texture_point(plain, tu, tv, b);
        assert_colors(a, b, 2e-4);
        retex_texture_nearest(edited, u, v, a);
        retex_texture_nearest(plain, tu, tv, b);
        assert_colors(a, b, 1e-6);
        filter_gaussian(edited, u, v, cov, a);
        filter_gaussian(plain, tu, tv, moved, b);
        assert_colors(a, b, tolerance);
        filter_disc(edited, u, v, cov, a);
        filter_disc(plain, tu, tv, moved, b);
        assert_colors(a, b, tolerance);
    }
}

static Map product(double a00, double a01, double a10, double a11, const Map *b)
{
    Map map = {{{a00 * b->m[0][0] + a01 * b->m[1][0], a00 * b->m[0][1] + a01 * b->m[1][1]},
                {a10 * b->m[0][0] + a11 * b->m[1][0], a10 * b->m[0][1] + a11 * b->m[1][1]}},
               {0, 0}};
    return map;
}

static void test_edits(void **state)
{
    (void)state;
    RetexImage im = {0};
    test_random_image(&im, 48, 20, 4, 3, 0, 1);
    for (uint32_t i = 0; i < 24; i++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT, wraps = RETEX_TEXTURE_SPEC_INIT;
        uint32_t seed = 100 + i;
        spec.scale[0] = (0.3 + test_random(&seed)) * (i & 1 ? -1 : 1);
        spec.scale[1] = 0.3 + test_random(&seed);
        spec.rotate = i % 3 ? 720 * test_random(&seed) - 360 : 90 * (double)(i / 3);
        spec.offset[0] = 3 * test_random(&seed) - 1.5;
        spec.offset[1] = 3 * test_random(&seed) - 1.5;
        spec.flip[0] = i & 4 ? 1 : 0;
        spec.flip[1] = i & 8 ? 1 : 0;
        spec.wrap[0] = wraps.wrap[0] = (RetexWrap)(i % 3);
        spec.wrap[1] = wraps.wrap[1] = (RetexWrap)(i / 3 % 3);
        double c = cos(spec.rotate * M_PI / 180), s = sin(spec.rotate * M_PI / 180);
        Map map = {{{spec.scale[0], 0}, {0, spec.scale[1]}}, {0, 0}};
        if (i & 2) { /* a repeat of 0.7 x 0.4 or by the aspect, on a target of 1.5 x 0.8 */
            spec.width[0] = 0.7;
            spec.width[1] = i & 16 ? 0.4 : 0;
            spec.uv_scale[0] = 1.5;
            spec.uv_scale[1] = 0.8;
            map = product(1.5, 0, 0, 0.8, &map);
        }
        map = product(c, -s, s, c, &map);
        if (i & 2)
            map = product(1 / 0.7, 0, 0, 1 / (i & 16 ? 0.4 : 0.7 * 20 / 48), &map);
        map = product(spec.flip[0] ? -1 : 1, 0, 0, spec.flip[1] ? -1 : 1, &map);
        for (int axis = 0; axis < 2; axis++)
            map.offset[axis] = spec.flip[axis] ? 1 - spec.offset[axis] : spec.offset[axis];
        RetexTexture *edited = create(&im, &spec), *plain = create(&im, &wraps);
        compare(edited, plain, &map, 0.005, 2, 5e-4, seed);
        retex_texture_close(&edited);
        retex_texture_close(&plain);
    }
    retex_image_free(&im);
}

/* Around a column of 5.03 x 2, whose UV closes in u, a width means the nearest whole number of repeats. */
static void test_closed_surfaces(void **state)
{
    (void)state;
    static const struct {
        double width, rotate, scale;
        RetexRepeat repeat;
        RetexWrap wrap;
        double around, upwards; /* repeats; 0: not fitted */
    } cases[] = {
        {1, 0, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, 5, 4},
        {1, 180, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, -5, -4},
        {1, 90, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, 10, -2}, /* 5.03 over the height of .5 */
        {1, 0, -0.72, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, -4, 2.88},
        {20, 0, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, 1, 0.2},
        {1, 0, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_MIRROR, 6, 4}, /* an even number */
        {1, 0, 1, RETEX_REPEAT_HALF_DROP, RETEX_WRAP_REPEAT, 6, 4},
        {1, 0, 1, RETEX_REPEAT_BRICK, RETEX_WRAP_REPEAT, 5, 4},
        {1, 0, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_CLAMP, 0, 0},
        {1, 45, 1, RETEX_REPEAT_STRAIGHT, RETEX_WRAP_REPEAT, 0, 0},
    };
    RetexImage im = {0};
    test_random_image(&im, 60, 30, 3, 8, 0, 1);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const int fitted = cases[k].around != 0, turned = cases[k].rotate == 90;
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        spec.width[0] = cases[k].width, spec.rotate = cases[k].rotate, spec.repeat = cases[k].repeat;
        spec.scale[0] = cases[k].scale, spec.scale[1] = fabs(cases[k].scale);
        spec.wrap[0] = cases[k].wrap;
        spec.uv_scale[0] = 5.03, spec.uv_scale[1] = 2;
        RetexTexture *open = create(&im, &spec);
        spec.periodic[0] = 1;
        RetexTexture *closed = create(&im, &spec);
        RetexTextureSpec plain = RETEX_TEXTURE_SPEC_INIT;
        plain.repeat = cases[k].repeat, plain.wrap[0] = cases[k].wrap;
        RetexTexture *straight = create(&im, &plain);
        uint32_t seed = 1;
        for (int i = 0; i < 50; i++) {
            const double u = test_random(&seed), v = test_random(&seed), x = cases[k].around * u,
                         y = cases[k].upwards * v;
            float a[4], b[4];
            retex_texture_point(closed, u, v, a);
            retex_texture_point(fitted ? straight : open, fitted ? (turned ? y : x) : u, fitted ? (turned ? x : y) : v,
                                b);
            assert_colors(a, b, 5e-3);
            retex_texture_point(closed, u + 1, v, b);
            if (fitted)
                assert_colors(a, b, 5e-3); /* no seam */
        }
        retex_texture_close(&open), retex_texture_close(&closed), retex_texture_close(&straight);
    }
    retex_image_free(&im);
}

/* A plank of 1.2 x 0.2 turned by 90 degrees on a floor of 6 x 3: 0.2 of it along u, 1.2 along v. */
static void test_planks(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    test_random_image(&im, 60, 10, 3, 8, 0, 1);
    spec.width[0] = 1.2;
    spec.uv_scale[0] = 6;
    spec.uv_scale[1] = 3;
    spec.rotate = 90;
    RetexTexture *turned = create(&im, &spec), *plain = create(&im, NULL);
    uint32_t seed = 1;
    for (int i = 0; i < 50; i++) {
        double x = 6 * test_random(&seed), y = 3 * test_random(&seed);
        float a[4], b[4];
        retex_texture_point(turned, x / 6, y / 3, a);
        retex_texture_point(plain, -y / 1.2, x / 0.2, b);
        assert_colors(a, b, 2e-4);
    }
    retex_texture_close(&turned);
    retex_texture_close(&plain);
    retex_image_free(&im);
}

/* The mirrored image in place of the flip. */
static void test_flips(void **state)
{
    (void)state;
    RetexImage im = {0}, mirrored = {0};
    RetexError err = {0};
    test_random_image(&im, 33, 17, 4, 4, 0, 1);
    for (int flips = 1; flips < 4; flips++)
        for (int wrap = 0; wrap < 3; wrap++) {
            RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
            spec.wrap[0] = spec.wrap[1] = (RetexWrap)wrap;
            test_must(retex_image_alloc(&mirrored, im.width, im.height, 4, &err), &err);
            for (int y = 0; y < im.height; y++)
                for (int x = 0; x < im.width; x++)
                    memcpy(mirrored.pixels + retex_image_index(&mirrored, x, y),
                           im.pixels + retex_image_index(&im, flips & 1 ? im.width - 1 - x : x,
                                                         flips & 2 ? im.height - 1 - y : y),
                           4 * sizeof(float));
            RetexTexture *plain = create(&mirrored, &spec);
            spec.flip[0] = flips & 1;
            spec.flip[1] = flips >> 1;
            RetexTexture *flipped = create(&im, &spec);
            Map same = {{{1, 0}, {0, 1}}, {0, 0}};
            compare(flipped, plain, &same, 0.005, 0.5, 2e-3, 9);
            retex_texture_close(&plain);
            retex_texture_close(&flipped);
            retex_image_free(&mirrored);
        }
    retex_image_free(&im);
}

/* Four repeats by four, each shifted as the repeat says, drawn texel by texel. */
static void draw_repeats(RetexImage *out, const RetexImage *im, RetexRepeat repeat)
{
    RetexError err = {0};
    int w = im->width, h = im->height;
    test_must(retex_image_alloc(out, 4 * w, 4 * h, 4, &err), &err);
    for (int y = 0; y < 4 * h; y++)
        for (int x = 0; x < 4 * w; x++) {
            int row = (4 * h - 1 - y) / h, column = x / w; /* rows of repeats count from below */
            int from_x = x + 4 * w - (repeat == RETEX_REPEAT_BRICK && row % 2 ? w / 2 : 0);
            int from_y = y + 4 * h - (repeat == RETEX_REPEAT_HALF_DROP && column % 2 ? h / 2 : 0);
            memcpy(out->pixels + retex_image_index(out, x, y),
                   im->pixels + retex_image_index(im, from_x % w, from_y % h), 4 * sizeof(float));
        }
}

static void test_shifted_repeats(void **state)
{
    (void)state;
    static const int sizes[][2] = {{32, 16}, {24, 24}, {33, 17}, {7, 20}, {1, 5}, {1, 1}, {9, 1}};
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++)
        for (int k = 0; k < 2; k++) {
            RetexImage im = {0}, drawn = {0};
            RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
            spec.repeat = k ? RETEX_REPEAT_HALF_DROP : RETEX_REPEAT_BRICK;
            test_random_image(&im, sizes[n][0], sizes[n][1], 4, 5, 0, 1);
            draw_repeats(&drawn, &im, spec.repeat);
            RetexTexture *repeated = create(&im, &spec), *plain = create(&drawn, NULL);
            int width, height, halves = n == 0; /* 32 x 16 */
            retex_texture_size(repeated, &width, &height);
            assert_int_equal(width, im.width);
            assert_int_equal(height, im.height);
            Map quarter = {{{0.25, 0}, {0, 0.25}}, {0, 0}};
            /* other sizes are halved in other places of the pyramid, which on white noise shows */
            compare(repeated, plain, &quarter, 0.005, 3, halves ? 1e-3 : 0.1, 21);
            retex_texture_close(&repeated);
            spec.flip[0] = 1;
            spec.offset[1] = 0.25;
            spec.scale[0] = 2;
            repeated = create(&im, &spec);
            Map placed = {{{-0.5, 0}, {0, 0.25}}, {0.25, 0.0625}};
            compare(repeated, plain, &placed, 0.005, 3, halves ? 1e-3 : 0.1, 22);
            retex_texture_close(&repeated);
            retex_texture_close(&plain);
            retex_image_free(&im);
            retex_image_free(&drawn);
        }
}

static void test_mirrored_repeats(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT, wrapped = RETEX_TEXTURE_SPEC_INIT;
    Map same = {{{1, 0}, {0, 1}}, {0, 0}};
    test_random_image(&im, 20, 30, 4, 5, 0, 1);
    spec.repeat = RETEX_REPEAT_MIRROR;
    wrapped.wrap[0] = wrapped.wrap[1] = RETEX_WRAP_MIRROR;
    RetexTexture *a = create(&im, &spec), *b = create(&im, &wrapped);
    compare(a, b, &same, 0.005, 1, 0, 3);
    retex_texture_close(&a);
    retex_texture_close(&b);
    spec.wrap[1] = wrapped.wrap[1] = RETEX_WRAP_CLAMP; /* an axis without repeats has none to mirror */
    a = create(&im, &spec);
    b = create(&im, &wrapped);
    compare(a, b, &same, 0.005, 1, 0, 3);
    retex_texture_close(&a);
    retex_texture_close(&b);
    retex_image_free(&im);
}

static void test_square(void **state)
{
    (void)state;
    RetexImage im = {0}, squared = {0};
    RetexError err = {0};
    Map same = {{{1, 0}, {0, 1}}, {0, 0}};
    test_random_image(&im, 30, 22, 4, 6, 0, 1);
    test_must(retex_image_copy(&squared, &im, &err), &err);
    for (int i = 0; i < im.width * im.height; i++) {
        if (i % 7 == 0)
            im.pixels[4 * i + 3] = squared.pixels[4 * i + 3] = 0;
        for (int c = 0; c < 3; c++)
            squared.pixels[4 * i + c] *= squared.pixels[4 * i + c];
    }
    for (int repeat = 0; repeat < 4; repeat++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexTexture *texture, *a, *b;
        spec.repeat = (RetexRepeat)repeat;
        spec.rotate = 20;
        spec.offset[0] = 0.3;
        spec.flip[1] = 1;
        texture = create(&im, &spec);
        b = create(&squared, &spec);
        test_must(retex_texture_square(&a, texture, 0, &err), &err);
        compare(a, b, &same, 0.005, 1, 1e-5, 3);
        int size[4];
        retex_texture_size(a, &size[0], &size[1]);
        retex_texture_size(texture, &size[2], &size[3]);
        assert_memory_equal(size, size + 2, 2 * sizeof *size);
        retex_texture_close(&texture);
        retex_texture_close(&a);
        retex_texture_close(&b);
    }
    retex_image_free(&im);
    retex_image_free(&squared);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture, *a;
    float p[4];
    spec.constant = 1;
    spec.color[0] = 0.5f;
    spec.color[1] = 1e30f; /* becomes 65504 */
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    test_must(retex_texture_square(&a, texture, 0, &err), &err);
    filter_disc(a, 3, 4, (double[3]){1, 0, 1}, p);
    assert_memory_equal(p, ((float[4]){0.25f, 65504.0f * 65504.0f, 0, 1}), sizeof p);
    retex_texture_close(&texture);
    retex_texture_close(&a);
}

/* A texture placed anew is the one that is made for that placement, and outlives neither its texels nor the other. */
static void test_placed_anew(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexTextureSpec specs[6];
    uint32_t seed = 5;
    test_random_image(&im, 13, 8, 4, 9, 0, 1);
    for (int i = 0; i < 6; i++) {
        specs[i] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        specs[i].repeat = i < 4 ? (RetexRepeat)i : RETEX_REPEAT_STRAIGHT;
        specs[i].wrap[0] = specs[i].wrap[1] = i == 4 ? RETEX_WRAP_CLAMP : i == 5 ? RETEX_WRAP_BLACK : RETEX_WRAP_REPEAT;
    }
    for (int i = 0; i < 6; i++) {
        RetexTexture *base = create(&im, &specs[i]), *placed;
        RetexTextureSpec spec = specs[i];
        RetexError err = {0};
        spec.scale[0] = 1.7;
        spec.rotate = 31;
        spec.offset[1] = 0.3;
        spec.flip[0] = 1;
        spec.width[0] = 0.6;
        spec.uv_scale[0] = 2;
        spec.uv_scale[1] = 3;
        spec.uv_max[0] = spec.uv_max[1] = 1;
        RetexTexture *wanted = create(&im, &spec);
        test_must(retex_texture_place(&placed, base, &spec, &err), &err);
        for (int k = 0; k < 100; k++) {
            double u = 4 * test_random(&seed) - 2, v = 4 * test_random(&seed) - 2, cov[3];
            float a[4], b[4];
            test_turned_covariance(cov, 0.2 * test_random(&seed), 0.1, test_random(&seed));
            filter_gaussian(placed, u, v, cov, a);
            filter_gaussian(wanted, u, v, cov, b);
            assert_colors(a, b, 0);
            retex_texture_point(placed, u, v, a);
            retex_texture_point(wanted, u, v, b);
            assert_colors(a, b, 0);
        }
        assert_true(retex_texture_bytes(base) >= 13 * 8 * 16 && retex_texture_bytes(placed) == 0);
        retex_texture_close(&placed);
        for (int k = 0; k < 6; k++) /* others need other texels */
            if (k != i) {
                assert_int_equal(retex_texture_place(&placed, base, &specs[k], &err), RETEX_EINVAL);
                assert_null(placed);
            }
        spec.scale[0] = 0;
        assert_int_equal(retex_texture_place(&placed, base, &spec, &err), RETEX_EINVAL);
        strcpy(spec.image, "another.png");
        spec.scale[0] = 1;
        assert_int_equal(retex_texture_place(&placed, base, &spec, &err), RETEX_EINVAL);
        retex_texture_close(&wanted);
        retex_texture_close(&base);
    }
    retex_image_free(&im);
}

static void must_fail(const RetexImage *im, const RetexTextureSpec *spec, const char *says)
{
    RetexTexture *texture;
    RetexError err = {0};
    assert_int_equal(retex_texture_create(&texture, im, spec, 0, &err), RETEX_EINVAL);
    assert_null(texture);
    if (!strstr(err.message, says))
        fail_msg("'%s' does not say '%s'", err.message, says);
}

static void test_mistakes(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexTexture *texture;
    RetexError err = {0};
    test_random_image(&im, 4, 4, 3, 6, 0, 1);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, "Floor");
    assert_int_equal(retex_texture_spec_needs_scale(&spec), 0);
    spec.width[0] = 2;
    assert_int_equal(retex_texture_spec_needs_scale(&spec), 1);
    must_fail(&im, &spec, "the size of target Floor is not known");
    spec.uv_scale[0] = 1;
    must_fail(&im, &spec, "the size of target Floor is not known");
    spec.uv_scale[1] = NAN;
    must_fail(&im, &spec, "the size of target Floor is not known");
    spec.uv_scale[1] = 1;
    spec.width[1] = -1;
    must_fail(&im, &spec, "width");
    spec.width[0] = INFINITY;
    spec.width[1] = 0;
    must_fail(&im, &spec, "width");
    spec.width[0] = 0;
    spec.width[1] = 1;
    must_fail(&im, &spec, "width");
    spec.width[1] = 0;
    spec.repeat = RETEX_REPEAT_BRICK;
    spec.wrap[1] = RETEX_WRAP_BLACK;
    must_fail(&im, &spec, "repeat on both axes");
    spec.repeat = (RetexRepeat)9;
    must_fail(&im, &spec, "number 9");
    retex_image_free(&im);
    spec = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT; /* a constant has no size to need */
    spec.constant = 1;
    spec.width[0] = 2;
    assert_int_equal(retex_texture_spec_needs_scale(&spec), 0);
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    retex_texture_close(&texture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edits),  cmocka_unit_test(test_closed_surfaces), cmocka_unit_test(test_planks),
        cmocka_unit_test(test_flips),  cmocka_unit_test(test_shifted_repeats), cmocka_unit_test(test_mirrored_repeats),
        cmocka_unit_test(test_square), cmocka_unit_test(test_placed_anew),     cmocka_unit_test(test_mistakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
