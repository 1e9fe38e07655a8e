/* Laid repeats: where each bond has which place of the image, and joints, against its definition in the plane; the
 * share of joints; what differs from repeat to repeat. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/lay.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/host/texture_lookup.h>

#include <cmocka.h>

enum { POINTS = 4000 };

/* A place of a repeat: u, v from 0 to 1; or -1: in a joint. */
typedef struct Place {
    double u, v;
} Place;

static const Place in_joint = {-1, -1};

/* An image whose red is u, whose green is v, whose blue is 0. */
static RetexImage gradient(int width, int height)
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, width, height, 3, &err), &err);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            float *p = im.pixels + 3 * ((size_t)y * (size_t)width + (size_t)x);
            p[0] = (float)((x + 0.5) / width);
            p[1] = (float)(1 - (y + 0.5) / height);
            p[2] = 0;
        }
    return im;
}

static RetexTextureSpec spec_of(RetexRepeat repeat, double width, double height, double grout)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    spec.repeat = repeat;
    spec.width[0] = width, spec.width[1] = height;
    spec.uv_scale[0] = spec.uv_scale[1] = 1;
    spec.grout = grout;
    spec.grout_color[0] = spec.grout_color[1] = 0, spec.grout_color[2] = 1;
    return spec;
}

static RetexTexture *create(const RetexTextureSpec *spec, int width, int height)
{
    RetexTexture *texture;
    RetexError err = {0};
    RetexImage im = gradient(width, height);
    test_must(retex_texture_create(&texture, &im, spec, 2, &err), &err);
    retex_image_free(&im);
    return texture;
}

/* ---- the bonds, in the plane: x right, y up ---- */

/* In a repeat with a joint at its right and upper end. */
static Place in_repeat(double x, double y, const RetexTextureSpec *spec)
{
    return x > spec->width[0] || y > spec->width[1] ? in_joint : (Place){x / spec->width[0], y / spec->width[1]};
}

/* In one that was turned counter-clockwise. */
static Place in_turned(double x, double y, const RetexTextureSpec *spec)
{
    return x > spec->width[1] || y > spec->width[0] ? in_joint : (Place){y / spec->width[0], 1 - x / spec->width[1]};
}

static double wrapped(double x, double period)
{
    return x - floor(x / period) * period;
}

static Place in_rows(double x, double y, const RetexTextureSpec *spec)
{
    const double p = spec->width[0] + spec->grout, q = spec->width[1] + spec->grout;
    if (spec->repeat == RETEX_REPEAT_BRICK && wrapped(floor(y / q), 2) == 1)
        x -= p / 2;
    if (spec->repeat == RETEX_REPEAT_HALF_DROP && wrapped(floor(x / p), 2) == 1)
        y += q / 2;
    return in_repeat(wrapped(x, p), wrapped(y, q), spec);
}

/* Looks for the block that the place is in. */
static Place in_herringbone(double x, double y, const RetexTextureSpec *spec)
{
    const int is_tall = spec->width[1] > spec->width[0];
    const double l = spec->width[is_tall] + spec->grout, s = spec->width[!is_tall] + spec->grout;
    for (int a = -60; a < 60; a++)
        for (int b = -20; b < 20; b++) {
            const double left = x - a * s - b * (l + s), low = y - a * s - b * (s - l);
            const double up_left = left - l, up_low = low - s + l;
            if (left >= 0 && left < l && low >= 0 && low < s)
                return is_tall ? in_turned(left, low, spec) : in_repeat(left, low, spec);
            if (up_left >= 0 && up_left < s && up_low >= 0 && up_low < l)
                return is_tall ? in_repeat(up_left, up_low, spec) : in_turned(up_left, up_low, spec);
        }
    fail_msg("no block at %g, %g", x, y);
    return in_joint;
}

static Place in_basket(double x, double y, const RetexTextureSpec *spec)
{
    const double l = spec->width[0] + spec->grout, s = spec->width[1] + spec->grout;
    const int stands = wrapped(floor(x / l) + floor(y / l), 2) == 1;
    x = wrapped(x, l), y = wrapped(y, l);
    return stands ? in_turned(wrapped(x, s), y, spec) : in_repeat(x, wrapped(y, s), spec);
}

/* In the hexagon whose middle is nearest. */
static Place in_hexagon(double x, double y, const RetexTextureSpec *spec)
{
    const double p = spec->width[0] + spec->grout;
    double nearest = INFINITY, next = INFINITY, dx = 0, dy = 0;
    for (int row = -12; row < 12; row++)
        for (int column = -12; column < 12; column++) {
            const double right = x - p * (column + 0.5 * row), up = y - p * sqrt(0.75) * row, far = hypot(right, up);
            if (far < nearest)
                next = nearest, nearest = far, dx = right, dy = up;
            else if (far < next)
                next = far;
        }
    /* how far the edge between both is */
    const double to_edge = (next * next - nearest * nearest) / (2 * p);
    const double seen = fmin(1, spec->width[1] / spec->width[0] * sqrt(0.75)); /* of the image's width */
    return to_edge < spec->grout / 2 ? in_joint
                                     : (Place){0.5 + dx / spec->width[0] * seen, 0.5 + dy / spec->width[1] * seen};
}

typedef Place Bond(double x, double y, const RetexTextureSpec *spec);

/* Places that are farther than three texels from a joint or an end have the image's place, or the joint's colour. */
static void compare(RetexTextureSpec spec, int width, int height, Bond *bond, double tolerance)
{
    RetexTexture *texture = create(&spec, width, height);
    const double texel = spec.width[0] / width, far = 3 * texel,
                 high = spec.width[1] > 0 ? spec.width[1] : spec.width[0] * height / width;
    uint32_t seed = 7;
    int compared = 0, joints = 0;
    for (int i = 0; i < POINTS; i++) {
        const double x = 3 * test_random(&seed) - 1, y = 3 * test_random(&seed) - 1;
        const Place at = bond(x, y, &spec);
        int is_inside = 1;
        for (int k = 0; k < 4; k++) {
            const Place near = bond(x + (k % 2 ? far : -far), y + (k / 2 ? far : -far), &spec);
            is_inside &= (near.u < 0) == (at.u < 0) &&
                         (at.u < 0 || hypot((near.u - at.u) * spec.width[0], (near.v - at.v) * high) < 1.5 * far);
        }
        if (!is_inside)
            continue;
        float rgba[4];
        retex_texture_point(texture, x, y, rgba);
        compared++;
        joints += at.u < 0;
        if (at.u < 0 && rgba[2] < 0.99f)
            fail_msg("repeat %d at %g, %g: no joint, %g of %g", (int)spec.repeat, x, y, (double)rgba[2], spec.width[0]);
        if (at.u >= 0 && (fabs((double)rgba[0] - at.u) > tolerance ||
                          fabs((double)rgba[1] - at.v) > tolerance * width / height || rgba[2] > 0.01f))
            fail_msg("repeat %d at %g, %g: %g, %g and not %g, %g", (int)spec.repeat, x, y, (double)rgba[0],
                     (double)rgba[1], at.u, at.v);
    }
    assert_true(compared > POINTS / 3);
    assert_true(joints > 20 || !(spec.grout > 4 * far));
    retex_texture_close(&texture);
}

static void test_bonds(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        const double grout = wide ? 0.06 : 0;
        compare(spec_of(RETEX_REPEAT_STRAIGHT, 0.4, 0.2, grout), 160, 80, in_rows, 0.01);
        compare(spec_of(RETEX_REPEAT_STRAIGHT, 0.4, 0.2, grout), 151, 40, in_rows, 0.02);
        compare(spec_of(RETEX_REPEAT_BRICK, 0.4, 0.2, grout), 160, 80, in_rows, 0.01);
        compare(spec_of(RETEX_REPEAT_HALF_DROP, 0.4, 0.2, grout), 160, 80, in_rows, 0.01);
        compare(spec_of(RETEX_REPEAT_HERRINGBONE, 0.6 - grout, 0.2 - grout, grout), 240, 80, in_herringbone, 0.02);
        compare(spec_of(RETEX_REPEAT_HERRINGBONE, 0.5 - grout, 0.2 - grout, grout), 250, 100, in_herringbone, 0.02);
        compare(spec_of(RETEX_REPEAT_HERRINGBONE, 0.2 - grout, 0.6 - grout, grout), 80, 240, in_herringbone, 0.02);
        compare(spec_of(RETEX_REPEAT_HERRINGBONE, 0.2 - grout, 0.2 - grout, grout), 80, 80, in_herringbone, 0.02);
        compare(spec_of(RETEX_REPEAT_BASKET, 0.6 - grout, 0.2 - grout, grout), 240, 80, in_basket, 0.02);
        compare(spec_of(RETEX_REPEAT_HEXAGON, 0.4, 0.4, grout), 160, 160, in_hexagon, 0.02);
        compare(spec_of(RETEX_REPEAT_HEXAGON, 0.4, 0.8, grout), 160, 320, in_hexagon, 0.02);
    }
}

/* Without a height, a repeat has the image's proportions. */
static void test_heights_by_aspect(void **state)
{
    (void)state;
    const RetexRepeat repeats[] = {RETEX_REPEAT_STRAIGHT, RETEX_REPEAT_BRICK, RETEX_REPEAT_HERRINGBONE};
    for (int k = 0; k < 3; k++) {
        RetexTextureSpec spec = spec_of(repeats[k], 0.6, 0, 0.02);
        RetexTexture *by_aspect = create(&spec, 90, 30);
        spec.width[1] = 0.2;
        RetexTexture *given = create(&spec, 90, 30);
        uint32_t seed = 3;
        for (int i = 0; i < 300; i++) {
            const double x = 3 * test_random(&seed), y = 3 * test_random(&seed);
            float a[4], b[4];
            retex_texture_point(by_aspect, x, y, a);
            retex_texture_point(given, x, y, b);
            for (int c = 0; c < 4; c++)
                assert_float_equal(a[c], b[c], 1e-5);
        }
        retex_texture_close(&by_aspect);
        retex_texture_close(&given);
    }
}

static long area_of_blocks(const RetexLayout *layout)
{
    long area = 0;
    for (int k = 0; k < layout->nblocks; k++)
        area += (long)(layout->block[0] + layout->joint[0]) * (layout->block[1] + layout->joint[1]);
    return area;
}

/* Every texel is painted: none stays NaN. The areas of rectangles add up to the image's, so none is painted twice. */
static void test_no_gaps(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int n = 0; n < 300; n++) {
        const int has_grout = n / 8 % 2, turns = n / 16 % 2;
        const int width = 2 + (int)(60 * test_random(&seed)), height = 2 + (int)(60 * test_random(&seed));
        RetexTextureSpec spec = spec_of((RetexRepeat)(n % RETEX_REPEATS), 0.01 * width, 0.01 * height,
                                        has_grout ? 0.02 * test_random(&seed) : 0);
        RetexError err = {0};
        RetexLayout layout;
        spec.vary = turns ? RETEX_VARY_TURN : 0;
        test_must(retex_layout_make(&layout, &spec, width, height, &err), &err);
        if (!layout.is_hexagonal)
            assert_int_equal(area_of_blocks(&layout), (long)layout.width * layout.height);
        RetexTexels image = {layout.width, layout.height, 0, NULL}, tile = {1, 1, 0, NULL};
        assert_int_equal(retex_texels_alloc(&image), 0);
        assert_int_equal(retex_texels_alloc(&tile), 0);
        retex_texture_store_texel(&tile, 0, (const float[4]){0, 1, 0, 1});
        float *texels = image.texels;
        const size_t count = (size_t)image.width * (size_t)image.height;
        for (size_t i = 0; i < 4 * count; i++)
            texels[i] = NAN;
        retex_layout_paint(&layout, &spec, &tile, 1, &image, 2);
        for (size_t i = 0; i < 4 * count; i++)
            assert_false(isnan(texels[i]));
        free(image.texels);
        free(tile.texels);
        retex_layout_free(&layout);
    }
}

/* Joints have the share of the area that they have, also where they are narrower than a texel. */
static void test_share_of_joints(void **state)
{
    (void)state;
    static const double covariance[3] = {1e4, 0, 1e4};
    for (int n = 0; n < 3 * RETEX_REPEATS; n++) {
        const RetexRepeat repeat = (RetexRepeat)(n % RETEX_REPEATS);
        const double grout = (const double[]){0.003, 0.012, 0.05}[n / RETEX_REPEATS], w = 0.6 - grout, h = 0.2 - grout;
        const double q = 0.6 / sqrt(0.75);
        const double share = repeat == RETEX_REPEAT_HEXAGON ? 1 - (w / 0.6) * (w / 0.6) : 1 - w * h / (0.6 * 0.2);
        if (repeat == RETEX_REPEAT_MIRROR)
            continue;
        RetexTextureSpec spec = spec_of(repeat, w, repeat == RETEX_REPEAT_HEXAGON ? q : h, grout);
        RetexTexture *texture = create(&spec, 90, repeat == RETEX_REPEAT_HEXAGON ? 104 : 30);
        float rgba[4];
        filter_gaussian(texture, 0.3, 0.4, covariance, rgba);
        assert_float_equal(rgba[2], share, 0.03 * share + 0.002);
        retex_texture_close(&texture);
    }
}

/* A colour with joints: as sharp as joints are. */
static void test_colors(void **state)
{
    (void)state;
    RetexTextureSpec spec = spec_of(RETEX_REPEAT_STRAIGHT, 0.5, 0, 0.01);
    RetexTexture *texture;
    RetexError err = {0};
    float rgba[4];
    spec.constant = 1;
    spec.color[0] = 0.25f, spec.color[1] = 0.5f;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    retex_texture_point(texture, 0.25, 0.4, rgba);
    assert_true(rgba[0] == 0.25f && rgba[1] == 0.5f && rgba[2] == 0);
    retex_texture_point(texture, 0.505, 0.505, rgba);
    assert_true(rgba[0] == 0 && rgba[2] == 1);
    retex_texture_point(texture, 0.4975, 0.25, rgba);
    assert_true(rgba[0] > 0.24f);
    retex_texture_close(&texture);
}

/* ---- what differs ---- */

/* Looks at the corners of many repeats; the number of different ways in which they lie, and of tiles. */
static int count_ways(RetexTextureSpec spec, int width, int height)
{
    RetexTexture *texture = create(&spec, width, height);
    const double high = spec.width[1] > 0 ? spec.width[1] : spec.width[0] * height / width;
    int seen[64] = {0}, count = 0;
    for (int i = 0; i < 16; i++)
        for (int j = 0; j < 16; j++) {
            float low[4], right[4];
            const double x = i * spec.width[0], y = j * high;
            retex_texture_point(texture, x + 0.1 * spec.width[0], y + 0.2 * high, low);
            retex_texture_point(texture, x + 0.9 * spec.width[0], y + 0.2 * high, right);
            int way = (low[0] > 0.5f) + 2 * (low[1] > 0.5f) + 4 * (right[0] > 0.5f) + 8 * (right[1] > 0.5f);
            count += !seen[way]++;
        }
    retex_texture_close(&texture);
    return count;
}

static void test_vary(void **state)
{
    (void)state;
    RetexTextureSpec square = spec_of(RETEX_REPEAT_STRAIGHT, 0.2, 0.2, 0), plank = spec_of(0, 0.4, 0.2, 0);
    assert_int_equal(count_ways(square, 40, 40), 1);
    square.vary = plank.vary = RETEX_VARY_TURN;
    assert_int_equal(count_ways(square, 40, 40), 4);
    assert_int_equal(count_ways(plank, 40, 20), 2);
    square.width[1] = plank.width[1] = 0; /* as high as the image's shape tells */
    assert_int_equal(count_ways(square, 40, 40), 4);
    assert_int_equal(count_ways(plank, 40, 20), 2);
    square.width[1] = plank.width[1] = 0.2;
    square.vary = plank.vary = RETEX_VARY_FLIP;
    assert_int_equal(count_ways(square, 40, 40), 4);
    assert_int_equal(count_ways(plank, 40, 20), 4);
    square.vary = RETEX_VARY_FLIP | RETEX_VARY_TURN;
    assert_int_equal(count_ways(square, 40, 40), 8);
}

/* The same seed has the same, another one something else; a shifted image has all that it had. */
static void test_seeds(void **state)
{
    (void)state;
    static const double covariance[3] = {1e4, 0, 1e4};
    float of[3][4], mean[4];
    for (int n = 0; n < 3; n++) {
        RetexTextureSpec spec = spec_of(RETEX_REPEAT_BRICK, 0.2, 0.1, 0);
        spec.vary = RETEX_VARY_SHIFT;
        spec.vary_seed = n == 2 ? 5 : 4;
        RetexTexture *texture = create(&spec, 40, 20);
        retex_texture_point(texture, 0.33, 0.27, of[n]);
        filter_gaussian(texture, 0, 0, covariance, mean);
        assert_float_equal(mean[0], 0.5, 5e-3);
        retex_texture_close(&texture);
    }
    assert_memory_equal(of[0], of[1], sizeof of[0]);
    assert_true(fabsf(of[0][0] - of[2][0]) > 0.01f);
}

static void test_refused(void **state)
{
    (void)state;
    RetexTextureSpec specs[] = {spec_of(0, 0, 0, 0.1),
                                spec_of(RETEX_REPEAT_BASKET, 0, 0, 0),
                                spec_of(0, 0.1, 0.1, -1),
                                spec_of(0, 0.1, 0.1, 0.2),
                                spec_of(RETEX_REPEAT_BASKET, 1, 1e-3, 0),
                                spec_of(RETEX_REPEAT_MIRROR, 1, 1, 0.1),
                                spec_of(RETEX_REPEATS, 1, 1, 0)};
    RetexImage im = gradient(4, 4);
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        RetexTexture *texture;
        RetexError err = {0};
        assert_int_equal(retex_texture_create(&texture, &im, &specs[i], 1, &err), RETEX_EINVAL);
        assert_null(texture);
    }
    retex_image_free(&im);
}

/* What would be larger than an image can be is refused, with its size. */
static void test_too_large(void **state)
{
    (void)state;
    const RetexTextureSpec spec = spec_of(RETEX_REPEAT_BRICK, 1, 1, 0);
    RetexImage im = gradient(2, 40000);
    RetexTexture *texture;
    RetexError err = {0};
    assert_int_equal(retex_texture_create(&texture, &im, &spec, 1, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "2 x 80000 texels"));
    assert_null(texture);
    retex_image_free(&im);
}

/* As many copies side by side as the limits allow: 16 along each axis, 256 blocks, 2^26 texels. */
static void test_copies(void **state)
{
    (void)state;
    static const int sizes[][2] = {{40, 20},   {1000, 1000}, {3000, 900},  {900, 3000},
                                   {2500, 20}, {20, 2500},   {4000, 3000}, {16, 16}};
    for (RetexRepeat repeat = RETEX_REPEAT_STRAIGHT; repeat <= RETEX_REPEAT_HALF_DROP; repeat++)
        for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
            const int *of = sizes[k];
            RetexTextureSpec spec = spec_of(repeat, of[0], of[1], 0);
            RetexLayout one, all;
            RetexError err = {0};
            test_must(retex_layout_make(&one, &spec, of[0], of[1], &err), &err);
            spec.vary = RETEX_VARY_SHIFT;
            test_must(retex_layout_make(&all, &spec, of[0], of[1], &err), &err);
            const int across = all.width / one.width, up = all.height / one.height;
            assert_true(across * one.width == all.width && up * one.height == all.height);
            assert_int_equal(all.nblocks, across * up * one.nblocks);
            for (int more = 0; more < 3; more++) { /* one more along either axis is too much */
                const double a = across + (more == 1), u = up + (more == 2);
                const int fits =
                    a <= 16 && u <= 16 && a * u * one.nblocks <= 256 && a * u * one.width * one.height <= 1 << 26;
                assert_int_equal(fits, more == 0);
            }
            retex_layout_free(&one);
            retex_layout_free(&all);
        }
}

/* Of a colour with joints as wide as of a picture of a thousand texels, but in few enough, also where repeats turn. */
static void test_texels_of_colors(void **state)
{
    static const struct {
        RetexRepeat repeat;
        double grout;
        int least;
    } all[] = {{RETEX_REPEAT_STRAIGHT, 0.1, 500}, {RETEX_REPEAT_STRAIGHT, 0.004, 500},
               {RETEX_REPEAT_BRICK, 0.1, 500},    {RETEX_REPEAT_HEXAGON, 0.1, 400},
               {RETEX_REPEAT_BASKET, 0.1, 400},   {RETEX_REPEAT_HERRINGBONE, 0.1, 150}};
    (void)state;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexLayout layout;
        RetexError err;
        spec.repeat = all[i].repeat;
        spec.width[0] = 1.2, spec.width[1] = 0.6;
        spec.grout = all[i].grout;
        spec.vary = RETEX_VARY_FLIP;
        test_must(retex_layout_make(&layout, &spec, 1, 1, &err), &err);
        assert_in_range(layout.block[1], all[i].least, 1200);
        assert_in_range((long)layout.width * layout.height, 1, 10 << 20);
        if (all[i].repeat == RETEX_REPEAT_STRAIGHT) /* a whole number, but for rounding of repeats */
            assert_true(fabs(layout.grout[0] - rint(layout.grout[0])) < 0.05);
        retex_layout_free(&layout);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bonds),     cmocka_unit_test(test_heights_by_aspect),
        cmocka_unit_test(test_no_gaps),   cmocka_unit_test(test_share_of_joints),
        cmocka_unit_test(test_colors),    cmocka_unit_test(test_vary),
        cmocka_unit_test(test_seeds),     cmocka_unit_test(test_refused),
        cmocka_unit_test(test_too_large), cmocka_unit_test(test_copies),
        cmocka_unit_test(test_texels_of_colors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
