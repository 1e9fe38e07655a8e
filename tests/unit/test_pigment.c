/* Pigments, compared with values of POV-Ray's pictures, and the UVs of targets. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <string.h>
#include <cmocka.h>
#include "pattern/pattern.h"
#include "pattern/warp.h"
#include "shade/pigment.h"
#include "shade/pigment_image.h"
#include "shade/pigment_image.h"

static const Vec2 nowhere = {0, 0};

static Pigment pigment(const PatternOps *ops)
{
    return (Pigment){.kind = PIGMENT_PATTERN,
                     .pattern = {.ops = ops, .vector = {1, 0, 0}, .frequency = 1, .wave_exponent = 1},
                     .transform = transform_identity()};
}

static double value(const Pigment *p, double x, double y)
{
    return pigment_eval(p, vec3(x, y, 0), nowhere).r;
}

static void assert_near(double a, double b)
{
    assert_true(fabs(a - b) < 2e-4);
}

/* Pixels of POV-Ray 3.7 at x = -2.95 and 2.65, y = .75. */
static void gradients_are_povray(void **state)
{
    const struct {
        Vec3 gradient;
        double frequency, phase;
        WaveKind wave;
        double at[2]; /* -2.95, 2.65 */
    } cases[] = {
        {{1, 0, 0}, 1, 0, WAVE_RAMP, {0.05, 0.65}},        {{2, 0, 0}, 1, 0, WAVE_RAMP, {0.05, 0.65}},
        {{1, 1, 0}, 1, 0, WAVE_RAMP, {0.4444, 0.4042}},    {{1, 0, 0}, 3, 0.25, WAVE_RAMP, {0.4001, 0.2000}},
        {{1, 0, 0}, 1, 0, WAVE_SINE, {0.6546, 0.0955}},    {{1, 0, 0}, 1, 0, WAVE_TRIANGLE, {0.1, 0.7}},
        {{1, 0, 0}, 1, 0, WAVE_SCALLOP, {0.1565, 0.8910}}, {{1, 0, 0}, 1, 0, WAVE_CUBIC, {0.0073, 0.7183}},
        {{1, 0, 0}, 1, 0, WAVE_POLY, {0.0025, 0.4225}},    {{1, 0, 0}, -1, 0.1, WAVE_RAMP, {0.05, 0.45}},
        {{1, 0, 0}, 0, 0.1, WAVE_RAMP, {0.05, 0.65}},      {{-1, 0, 0}, 1, 0, WAVE_RAMP, {0.95, 0.35}},
        {{1, 0, 0}, 50, 0, WAVE_RAMP, {0.5015, 0.4997}},
    };

    (void)state;
    for (size_t i = 0; i < sizeof(cases) / sizeof(cases[0]); i++) {
        Pigment p = pigment(&pattern_gradient);
        p.pattern.vector = vec_normalize(cases[i].gradient);
        p.pattern.frequency = cases[i].frequency;
        p.pattern.phase = cases[i].phase;
        p.pattern.wave = cases[i].wave;
        p.pattern.wave_exponent = 2;
        assert_near(value(&p, -2.95, 0.75), cases[i].at[0]);
        assert_near(value(&p, 2.65, 0.75), cases[i].at[1]);
    }
}

static void color_maps(void **state)
{
    ColorMapEntry entries[] = {{0.2, {1, 0, 0, 0, 0}, NULL},
                               {0.5, {0, 0, 0, 0, 0}, NULL},
                               {0.5, {0.5f, 0, 0, 0, 0.2f}, NULL},
                               {0.7, {1, 1, 1, 0.4f, 0}, NULL}};
    Pigment p = pigment(&pattern_gradient);

    (void)state;
    p.map = (ColorMap){4, entries};
    assert_near(value(&p, 0.1, 0), 1);
    assert_near(value(&p, 0.35, 0), 0.5);
    assert_near(value(&p, 0.5, 0), 0);
    assert_near(value(&p, 0.6, 0), 0.75);
    assert_near(value(&p, 0.26, 0), 0.8); /* a fifth of the way from 1 to 0 */
    assert_near(value(&p, 0.65, 0), 0.875);
    assert_near(pigment_eval(&p, vec3(0.65, 0, 0), nowhere).filter, 0.3);
    assert_near(pigment_eval(&p, vec3(0.65, 0, 0), nowhere).transmit, 0.05);
    assert_near(value(&p, 0.9, 0), 1);
    assert_false(pigment_is_opaque(&p));
    assert_false(pigment_is_constant(&p));
    p.map.count = 1;
    assert_true(pigment_is_constant(&p));
    assert_true(pigment_is_opaque(&p));
}

static void checkers(void **state)
{
    ColorMapEntry colors[] = {{0, {1, 0, 0, 0, 0}, NULL}, {1, {0, 1, 0, 0, 0}, NULL}};
    Pigment p = pigment(&pattern_checker);

    (void)state;
    p.map = (ColorMap){2, colors};
    assert_true(value(&p, 0.5, 0.5) == 1 && value(&p, 1.5, 0.5) == 0 && value(&p, -0.5, 0.5) == 0 &&
                value(&p, -0.5, -0.5) == 1);
    for (int z = -2; z < 3; z++)
        assert_true(pigment_eval(&p, vec3(0.5, 0.5, z + 0.5), nowhere).r == (z % 2 == 0));
    /* a hair below a boundary counts as beyond it, so that a plane through one does not speckle */
    assert_true(value(&p, 1 - 0.5e-10, 0.5) == 0 && value(&p, 1 - 2e-10, 0.5) == 1);
    p.transform = transform_then(transform_scale(vec3(2, 2, 2)), transform_translate(vec3(1, 0, 0)));
    assert_true(value(&p, 2.9, 0.5) == 1 && value(&p, 3.1, 0.5) == 0);
    p.uv_mapping = 1;
    p.transform = transform_scale(vec3(0.5, 0.5, 1));
    assert_true(pigment_eval(&p, vec3(9, 9, 9), (Vec2){0.75, 0.25}).g == 1);
    assert_false(pigment_is_constant(&p));
    colors[1].color.filter = 0.5f;
    assert_false(pigment_is_opaque(&p));
    colors[0].color = colors[1].color;
    assert_true(pigment_is_constant(&p));
    for (int k = 0; k < 5; k++) {
        Rgbft *c = &colors[1].color, was = *c;
        *(float *[]){&c->r, &c->g, &c->b, &c->filter, &c->transmit}[k] += 0.125f;
        assert_false(pigment_is_constant(&p));
        *c = was;
    }
}

/* Seen in POV-Ray: 1e-10 below the end of mortar is mortar, 1e-11 below it is brick. */
static void bricks(void **state)
{
    ColorMapEntry colors[] = {{0, {0, 0, 0, 0, 0}, NULL}, {1, {1, 0, 0, 0, 0}, NULL}};
    Pigment p = pigment(&pattern_brick);

    (void)state;
    p.map = (ColorMap){2, colors};
    p.pattern.number = 0.5;
    p.pattern.vector = vec3(8, 3, 4.5);
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < 3; k++) {
            const double at = k == 0 ? -2e-10 : k == 1 ? -1e-11 : 0;
            const Vec3 q = axis == 0 ? vec3(at, 1, 1) : axis == 1 ? vec3(1, at, 1) : vec3(1, 4, at);

            assert_true(pigment_eval(&p, q, nowhere).r == (k > 0));
        }
}

/* ---- images ---- */

#define WIDTH 4
#define HEIGHT 2

/* Texel (x, y) from the top left has red x / 4, green y / 2, alpha 1 or, at its right half, .25. */
static ImageMap image_map(MapType type)
{
    float pixels[WIDTH * HEIGHT * 4];
    RetexImage image = {WIDTH, HEIGHT, 4, pixels};
    ImageMap map = {.width = WIDTH, .height = HEIGHT, .map_type = type};

    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float texel[4] = {(float)(i % WIDTH) / WIDTH, (float)(i / WIDTH) / HEIGHT, 0.5f, i % WIDTH < 2 ? 1 : 0.25f};
        memcpy(pixels + 4 * i, texel, sizeof(texel));
    }
    assert_int_equal(retex_texture_create(&map.texture, &image, NULL, 0, NULL), 0);
    return map;
}

static void images_are_povray(void **state)
{
    ImageMap map = image_map(MAP_PLANAR);
    Pigment p = {.kind = PIGMENT_IMAGE, .transform = transform_identity()};
    Rgbft c;

    (void)state;
    p.image = &map;
    c = pigment_eval(&p, vec3(0.3, 0.2, 7), nowhere); /* lower row, second texel */
    assert_true(c.r == 0.25f && c.g == 0.5f && c.filter == 0 && c.transmit == 0);
    c = pigment_eval(&p, vec3(-0.2, 1.9, 0), nowhere); /* repeats */
    assert_true(c.r == 0.75f && c.g == 0);
    assert_true(pigment_is_opaque(&p));
    map.has_alpha = 1;
    c = pigment_eval(&p, vec3(0.8, 0.2, 0), nowhere);
    assert_true(c.r == 0.75f && c.transmit == 0.75f);
    map.filter_all = 0.25f;
    map.transmit_all = 0.125f;
    c = pigment_eval(&p, vec3(0.8, 0.2, 0), nowhere);
    assert_true(c.filter == 0.25f && c.transmit == 0.875f);
    assert_false(pigment_is_opaque(&p));
    map.has_alpha = 0;
    map.interpolate = 2;
    assert_near(value(&p, 0.25, 0.25), 0.125);
    assert_near(value(&p, 0, 0.25), 0.15); /* wraps round; colours weigh by their alpha */
    map.once = 1;
    assert_true(pigment_eval(&p, vec3(1.1, 0.5, 0), nowhere).transmit == 1);
    assert_true(pigment_eval(&p, vec3(0.9, 0.5, 0), nowhere).transmit == 0.125f);
    map.map_type = MAP_CYLINDRICAL; /* round about it is closed, above and below it ends */
    assert_true(pigment_eval(&p, vec3(-1, 0.5, -1), nowhere).transmit == 0.125f);
    assert_true(pigment_eval(&p, vec3(-1, 1.1, -1), nowhere).transmit == 1);
    assert_true(image_is_outside(&map, (Vec2){1.5, 0.5}) == 0 && image_is_outside(&map, (Vec2){0.5, -0.1}) == 1);
    map.map_type = MAP_SPHERICAL;
    assert_true(pigment_eval(&p, vec3(-1, 7, -1), nowhere).transmit == 0.125f);
    retex_texture_close(&map.texture);
}

/* Each texel is found at its middle, whatever the sizes: quotients such as 15/49 times 49 are not whole. */
static void texels_of_odd_images(void **state)
{
    (void)state;
    for (int size = 3; size <= 61; size += 2) {
        RetexImage image;
        ImageMap map = {.width = size, .height = size, .map_type = MAP_PLANAR};
        Pigment p = {.kind = PIGMENT_IMAGE, .transform = transform_identity(), .image = &map};
        RetexError err;
        assert_int_equal(retex_image_alloc(&image, size, size, 3, &err), 0);
        for (int i = 0; i < size * size; i++) {
            image.pixels[3 * i] = (float)(i % size) / 64;
            image.pixels[3 * i + 1] = (float)(size - 1 - i / size) / 64; /* rows from below */
            image.pixels[3 * i + 2] = 0;
        }
        assert_int_equal(retex_texture_create(&map.texture, &image, NULL, 0, NULL), 0);
        for (int i = 0; i < 4 * size; i++) { /* also between texels, in whose middle they are themselves */
            map.interpolate = (int[]){0, 2, 3, 4}[i / size];
            map.has_alpha = map.interpolate > 0; /* then colours are weighed here */
            const int x = i % size, y = size - 1 - x;
            const Rgbft c = pigment_eval(&p, vec3((x + 0.5) / size, (y + 0.5) / size, 0), nowhere);
            assert_near(c.r, x / 64.0);
            assert_near(c.g, y / 64.0);
        }
        retex_texture_close(&map.texture);
        retex_image_free(&image);
    }
}

/* A warp changes where the image is read, and not the UV of a replacement. */
static void warped_images(void **state)
{
    ImageMap map = image_map(MAP_PLANAR);
    Pigment p = {.kind = PIGMENT_IMAGE, .transform = transform_identity()}, straight;
    Warp warp = {.apply = warp_repeat, .repeat = {.axis = 0, .width = 0.25f, .flip = {1, 1, 1}, .offset = {0, 0.5, 0}}};
    Vec2 target;

    (void)state;
    p.image = &map;
    straight = p;
    p.pattern.warps = &warp;
    for (int i = 0; i < 8; i++) {
        const double x = 0.1 + i * 0.25;
        const Rgbft seen = pigment_eval(&p, vec3(x, 0.2, 3), nowhere);
        const Rgbft there = pigment_eval(&straight, vec3(0.1, 0.2 + 0.5 * i, 0), nowhere);
        assert_true(seen.r == there.r && seen.g == there.g);
        assert_true(pigment_eval_image(&p, vec3(x, 0.2, 3), &target).g == there.g);
        assert_true(target.u == x && target.v == 0.2);
    }
    retex_texture_close(&map.texture);
}

static void assert_uv(Vec2 uv, double u, double v)
{
    assert_near(uv.u, u);
    assert_near(uv.v, v);
}

static void projections(void **state)
{
    ImageMap map = {.map_type = MAP_SPHERICAL};

    (void)state;
    assert_uv(pigment_image_uv(&map, vec3(0, 0, -3)), 0.75, 0.5);
    assert_uv(pigment_image_uv(&map, vec3(2, 2, 0)), 0, 0.75);
    assert_uv(pigment_image_uv(&map, vec3(0, -1, 0)), 0, 0);
    map.map_type = MAP_CYLINDRICAL;
    assert_uv(pigment_image_uv(&map, vec3(0, 1.2, 5)), 0.25, 1.2);
    /* A light probe has all directions within a circle of radius 1/2, by their angle from z. */
    map.map_type = MAP_ANGULAR;
    assert_uv(pigment_image_uv(&map, vec3(0, 0, 2)), 0.5, 0.5);
    assert_uv(pigment_image_uv(&map, vec3(3, 0, 0)), 0.75, 0.5);
    assert_uv(pigment_image_uv(&map, vec3(0, -1, 1)), 0.5, 0.375);
    assert_uv(pigment_image_uv(&map, vec3(-3e-9, 4e-9, -1)), 0.2, 0.9);
    map.map_type = MAP_TORUS;
    assert_uv(pigment_image_uv(&map, vec3(-1.5, 0, 0)), 0.5, 0.5);
    assert_uv(pigment_image_uv(&map, vec3(0, 0.5, 1)), 0.25, 0.75);
}

/* ---- targets ---- */

static void target_uvs(void **state)
{
    ImageMap map = {.map_type = MAP_CYLINDRICAL};
    Pigment p = {.kind = PIGMENT_COLOR, .transform = transform_identity()};
    Vec2 mapped = {0.5, 0.25}, natural = {0.1, 0.2};
    Vec3 at = {2, 4, 6};

    (void)state;
    p.transform = transform_scale(vec3(2, 2, 2));
    assert_uv(target_uv(&p, at, vec3(1, 0, 0), &mapped, &natural), 0.1, 0.2);
    assert_uv(target_uv(&p, at, vec3(1, 0.2, 0), &mapped, NULL), 3, 2);
    assert_uv(target_uv(&p, at, vec3(0, -1, 0), NULL, NULL), 1, 3);
    assert_uv(target_uv(&p, at, vec3(0, 0.1, 1), NULL, NULL), 1, 2);
    p.uv_mapping = 1;
    assert_uv(target_uv(&p, at, vec3(1, 0, 0), &mapped, &natural), 0.25, 0.125);
    p.uv_mapping = 0;
    p.kind = PIGMENT_IMAGE;
    p.image = &map;
    assert_uv(target_uv(&p, vec3(0, 4, 6), vec3(1, 0, 0), &mapped, &natural), 0.25, 2);
}

/* A pigment and its bake agree at every texel's centre. */
static void bakes(void **state)
{
    const double low[2] = {-1, 0.5}, high[2] = {3, 2.5};
    ImageMap map = image_map(MAP_PLANAR);
    Pigment p = pigment(&pattern_gradient); /* which looks the same from no two sides */
    RetexImage baked = {0};

    (void)state;
    p.image = &map;
    p.pattern.vector = vec3(0.3, 0.8, 0.5), p.pattern.frequency = 0.1;
    p.transform = transform_rotate(vec3(0, 0, 90));
    for (int k = 0; k < 4; k++) {
        int axis = k < 3 ? k : 2;
        p.kind = k < 3 ? PIGMENT_PATTERN : PIGMENT_IMAGE;
        assert_int_equal(pigment_bake(&baked, &p, axis, low, high, 40, 20, 1, NULL), 0);
        for (int y = 0; y < 20; y++)
            for (int x = 0; x < 40; x++) {
                double u = -1 + 0.1 * (x + 0.5), v = 2.5 - 0.1 * (y + 0.5);
                Vec3 q = axis == 0 ? vec3(0, v, u) : axis == 1 ? vec3(u, 0, v) : vec3(u, v, 0), normal;
                Vec3 world = transform_point(&p.transform, q);
                normal = transform_normal(&p.transform, vec3(axis == 0, axis == 1, axis == 2));
                assert_uv(target_uv(&p, world, normal, NULL, NULL), u, v);
                assert_near(pigment_eval(&p, world, nowhere).r, baked.pixels[retex_image_index(&baked, x, y)]);
            }
        retex_image_free(&baked);
    }
    assert_int_equal(pigment_bake(&baked, &p, 3, low, high, 4, 4, 1, NULL), RETEX_EINVAL);
    retex_texture_close(&map.texture);
}

/* ---- the table ---- */

/* Each keyword once; a pattern without a value has a name for the warning; lists of colours are not too long. */
static void rows_are_whole(void **state)
{
    (void)state;
    assert_true(pattern_count() <= 64); /* Gaps of sdl/state/builder.h */
    assert_int_equal(pattern_find("checkers"), -1);
    for (int i = 0; i < pattern_count(); i++) {
        const PatternOps *ops = pattern_at(i);
        assert_true(ops->value || ops->name);
        assert_in_range(ops->colors, 0, PATTERN_COLORS);
        assert_int_equal(pattern_find(ops->keyword), i);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_are_povray),
        cmocka_unit_test(color_maps),
        cmocka_unit_test(bricks),
        cmocka_unit_test(checkers),
        cmocka_unit_test(rows_are_whole),
        cmocka_unit_test(images_are_povray),
        cmocka_unit_test(texels_of_odd_images), cmocka_unit_test(warped_images),
        cmocka_unit_test(projections),
        cmocka_unit_test(target_uvs),
        cmocka_unit_test(bakes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
