/* Rows of footprints: the kernels of all processors give the same bits, and agree closely with the filters that
 * compute one footprint at a time. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/batch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { COUNT = 3000 };

typedef struct Footprints {
    float uv[3 * COUNT], spread[3 * COUNT], rgba[4 * COUNT], other[4 * COUNT];
} Footprints;
static Footprints footprints; /* of the test that runs */

/* Anywhere in 2 x 2 repeats; the shorter standard deviation between two limits, in texels, the longer up to so many
 * times as long. Every tenth has no coverage. */
static void scatter(int width, int height, double least, double most, double aspect, uint32_t seed)
{
    for (int i = 0; i < COUNT; i++) {
        double shorter = least * pow(most / least, test_random(&seed)), cov[3];
        test_turned_covariance(cov, shorter * pow(aspect, test_random(&seed)), shorter, M_PI * test_random(&seed));
        float *uv = footprints.uv + 3 * i, *spread = footprints.spread + 3 * i;
        uv[0] = (float)(2 * test_random(&seed) - 0.5);
        uv[1] = (float)(2 * test_random(&seed) - 0.5);
        uv[2] = i % 10 ? 1 : 0;
        spread[0] = (float)(sqrt(cov[0]) / width);
        spread[1] = (float)(sqrt(cov[2]) / height);
        spread[2] = (float)(cov[1] / sqrt(cov[0] * cov[2]));
    }
}

/* One at a time. */
static void filter_singly(const RetexTexture *texture, RetexTextureFilter shape, float *rgba)
{
    for (int i = 0; i < COUNT; i++, rgba += 4) {
        const float *uv = footprints.uv + 3 * i, *s = footprints.spread + 3 * i;
        double u = (double)s[0], v = (double)s[1], cov[3] = {u * u, (double)s[2] * u * v, v * v};
        memset(rgba, 0, 4 * sizeof *rgba);
        if (uv[2] > 0)
            (shape == RETEX_TEXTURE_DISC ? filter_disc : filter_gaussian)(texture, (double)uv[0],
                                                                                        (double)uv[1], cov, rgba);
    }
}

/* The surface, where it has ends: they cut most of the footprints that scatter() spreads more than a little. */
static const double ends[2][2] = {{-0.2, 0.9}, {0.1, 1.3}};

static RetexTexture *make_cut_texture(RetexImage *im, RetexWrap wrap_u, RetexWrap wrap_v, int cut)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    spec.wrap[0] = wrap_u;
    spec.wrap[1] = wrap_v;
    for (int axis = 0; axis < 2 && cut; axis++) {
        spec.uv_min[axis] = ends[axis][0];
        spec.uv_max[axis] = ends[axis][1];
    }
    test_must(retex_texture_create(&texture, im, &spec, 0, &err), &err);
    retex_image_free(im);
    return texture;
}

static RetexTexture *make_texture(RetexImage *im, RetexWrap wrap_u, RetexWrap wrap_v)
{
    return make_cut_texture(im, wrap_u, wrap_v, 0);
}

/* As if it had been read from a file of integers. */
static RetexTexture *narrowed(const RetexTexture *texture)
{
    const RetexTextureLevel *level = &texture->levels[0];
    RetexTexels texels = {level->width, level->height, 1, NULL};
    RetexTexture *narrow = calloc(1, sizeof *narrow);
    assert_non_null(narrow);
    assert_int_equal(retex_texels_alloc(&texels), 0);
    for (int i = 0; i < 4 * level->width * level->height; i++)
        ((uint16_t *)texels.texels)[i] = (uint16_t)(((const float *)level->texels)[i] * NARROW_ONE + 0.5f);
    narrow->spec = texture->spec;
    memcpy(narrow->repeats, texture->repeats, sizeof narrow->repeats);
    memcpy(narrow->matrix, texture->matrix, sizeof narrow->matrix);
    assert_int_equal(retex_texture_build_pyramid(narrow, &texels, 1), 0);
    return narrow;
}

static void test_same_bits(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {45, 27}, {300, 7}, {1, 40}, {1, 1}, {512, 256}};
    const int level = (int)retex_cpu_level();
    for (int n = 0; n < 2 * 6 * 16; n++) {
        const int *size = sizes[n / 16 % 6], cut = n >= 6 * 16;
        RetexImage im = {0};
        test_random_image(&im, size[0], size[1], 4, (uint32_t)n, 0, 1);
        RetexTexture *wide = make_cut_texture(&im, (RetexWrap)(n % 4), (RetexWrap)(n / 4 % 4), cut);
        RetexTexture *textures[2] = {wide, narrowed(wide)};
        scatter(size[0], size[1], 0.05, 30, 40, (uint32_t)n);
        for (int i = 0; i < 6; i++) {
            const RetexTexture *texture = textures[i / 3];
            RetexTextureFilter shape = (RetexTextureFilter)(i % 3);
            retex_texture_filter(texture, shape, footprints.uv, footprints.spread, 3, COUNT, footprints.rgba, 4);
            for (int k = 0; k <= level; k++) {
                retex_texture_filter_batches(retex_texture_batch_kernels[k], texture, shape, footprints.uv,
                                             footprints.spread, 3, COUNT, footprints.other, 4);
                assert_memory_equal(footprints.rgba, footprints.other, sizeof footprints.rgba);
            }
            for (size_t f = 0; f < COUNT; f += 37) { /* alone, as in a row */
                float alone[4], colors[3];
                retex_texture_filter(texture, shape, footprints.uv + 3 * f, footprints.spread + 3 * f, 3, 1, alone, 4);
                assert_memory_equal(footprints.rgba + 4 * f, alone, sizeof alone);
                retex_texture_filter(texture, shape, footprints.uv + 3 * f, footprints.spread + 3 * f, 3, 1, colors, 3);
                assert_memory_equal(footprints.rgba + 4 * f, colors, sizeof colors);
            }
        }
        retex_texture_close(&textures[0]);
        retex_texture_close(&textures[1]);
    }
}

/* ---- the same colours ---- */

static double encode(double v)
{
    return v <= 0.0031308 ? v * 12.92 : 1.055 * pow(v, 1 / 2.4) - 0.055;
}

typedef struct Difference {
    double psnr;    /* of sRGB, times alpha */
    double bias[3]; /* of linear colours, times alpha */
} Difference;

static Difference compare(const RetexTexture *texture, RetexTextureFilter shape)
{
    Difference d = {0, {0, 0, 0}};
    double squares = 0;
    int count = 0;
    retex_texture_filter(texture, shape, footprints.uv, footprints.spread, 3, COUNT, footprints.rgba, 4);
    filter_singly(texture, shape, footprints.other);
    for (int i = 0; i < COUNT; i++) {
        const float *is = footprints.rgba + 4 * i, *should = footprints.other + 4 * i;
        assert_float_equal(is[3], should[3], 0.07);
        if (!(should[3] > 0))
            continue;
        count++;
        for (int c = 0; c < 3; c++) {
            double e = (encode((double)is[c]) - encode((double)should[c])) * (double)should[3];
            squares += e * e;
            d.bias[c] += ((double)is[c] - (double)should[c]) * (double)should[3];
        }
    }
    for (int c = 0; c < 3; c++)
        d.bias[c] /= count;
    d.psnr = -10 * log10(squares / (3 * count) + 1e-20);
    return d;
}

static void expect_alike(const char *name, const RetexTexture *texture, double least)
{
    int width, height;
    retex_texture_size(texture, &width, &height);
    for (int shape = RETEX_TEXTURE_DISC; shape <= RETEX_TEXTURE_GAUSSIAN; shape++) {
        scatter(width, height, 0.2, 4, 4, 5);
        Difference d = compare(texture, (RetexTextureFilter)shape);
        print_message("%s, %s: %.1f dB, bias %+.6f %+.6f %+.6f\n", name, shape ? "Gaussian" : "disc", d.psnr, d.bias[0],
                      d.bias[1], d.bias[2]);
        assert_true(d.psnr >= least);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(d.bias[c]) < 3e-4);
    }
}

/* Of what is committed for the scenes: a painting, stone, wood, cloth. */
static void test_pictures_alike(void **state)
{
    (void)state;
    static const char *const names[] = {"scenes/living-room/textures/painting.jpg", "scenes/textures/travertine.jpg",
                                        "scenes/textures/walnut-herringbone.jpg",
                                        "scenes/living-room/textures/linen.jpg"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexTexture *texture;
        RetexError err = {0};
        strcpy(spec.image, names[i]);
        test_must(retex_texture_load(&texture, &spec, 0, &err), &err);
        assert_int_equal(texture->narrow, 1);
        expect_alike(names[i], texture, 55);
        retex_texture_close(&texture);
    }
}

/* Whether the kernel filters all footprints itself. */
static int filters_all(const RetexTexture *texture, RetexTextureFilter shape)
{
    return !retex_texture_filter_batches(retex_texture_batch_kernels[0], texture, shape, footprints.uv,
                                         footprints.spread, 3, COUNT, footprints.other, 4);
}

/* Gaussian needles are widened, long discs are filtered on coarser levels, and the reference skips texels along the
 * length of both. */
static void test_needles_alike(void **state)
{
    (void)state;
    static const double longest[] = {16, 64, 300};                  /* standard deviations */
    static const double least[2][3] = {{58, 49, 47}, {71, 71, 59}}; /* dB */
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    strcpy(spec.image, "scenes/textures/walnut-herringbone.jpg");
    test_must(retex_texture_load(&texture, &spec, 0, &err), &err);
    for (int i = 0; i < 6; i++) {
        const RetexTextureFilter shape = i < 3 ? RETEX_TEXTURE_GAUSSIAN : RETEX_TEXTURE_DISC;
        scatter(1024, 1024, 0.2, 1, longest[i % 3], 7);
        Difference d = compare(texture, shape);
        print_message("%s, up to %g times as long as wide: %.1f dB, bias %+.6f %+.6f %+.6f\n",
                      i < 3 ? "Gaussian" : "disc", longest[i % 3], d.psnr, d.bias[0], d.bias[1], d.bias[2]);
        assert_true(d.psnr >= least[i / 3][i % 3]);
        for (int c = 0; c < 3; c++)
            assert_true(fabs(d.bias[c]) < 3e-4);
        assert_true(filters_all(texture, shape));
    }
    retex_texture_close(&texture);
}

/* What covers thousands of repeats, however narrow it is, has the mean of the texture. */
static void test_far_surfaces(void **state)
{
    (void)state;
    static const double deviations[] = {1100, 30000, 65504};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    strcpy(spec.image, "scenes/textures/walnut-herringbone.jpg");
    test_must(retex_texture_load(&texture, &spec, 0, &err), &err);
    float mean[4];
    filter_gaussian(texture, 0.5, 0.5, (const double[3]){4, 0, 4}, mean);
    for (int i = 0; i < COUNT; i++) {
        for (int k = 0; k < 2; k++) {
            footprints.uv[3 * i + k] = (float)(i * (k ? 37 : -53));
            footprints.spread[3 * i + k] = (float)deviations[i / (k ? 3 : 1) % 3];
        }
        footprints.uv[3 * i + 2] = 1;
        footprints.spread[3 * i + 2] = (float)(i / 9 % 3 - 1);
    }
    for (int shape = RETEX_TEXTURE_DISC; shape <= RETEX_TEXTURE_BROAD; shape++) {
        assert_true(filters_all(texture, (RetexTextureFilter)shape));
        for (int i = 0; i < 4 * COUNT; i++)
            assert_float_equal(footprints.other[i], mean[i % 4], 2e-3f);
    }
    retex_texture_close(&texture);
}

/* Broad footprints: those more than twice as long as wide are filtered as if they were as much wider as takes them
 * there, on coarser levels than others. */
static void test_broad(void **state)
{
    (void)state;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    strcpy(spec.image, "scenes/textures/walnut-herringbone.jpg");
    test_must(retex_texture_load(&texture, &spec, 0, &err), &err);
    double squares = 0;
    int count = 0;
    uint32_t seed = 9;
    for (int i = 0; i < COUNT; i++) {
        const double longer = 1 + 30 * test_random(&seed), ratio = 1 + 10 * test_random(&seed);
        const double shorter = longer / ratio, lacks = fmax(longer * longer / 4 - shorter * shorter, 0);
        double cov[3], wide[3], unit = 1.0 / 1024;
        float is[4], should[4], uv[3] = {(float)test_random(&seed), (float)test_random(&seed), 1};
        test_turned_covariance(cov, longer, shorter, M_PI * test_random(&seed));
        for (int k = 0; k < 3; k++)
            wide[k] = (cov[k] + (k == 1 ? 0 : lacks)) * unit * unit;
        const float spread[3] = {(float)(sqrt(cov[0]) * unit), (float)(sqrt(cov[2]) * unit),
                                 (float)(cov[1] / sqrt(cov[0] * cov[2]))};
        retex_texture_filter(texture, RETEX_TEXTURE_BROAD, uv, spread, 3, 1, is, 4);
        filter_gaussian(texture, (double)uv[0], (double)uv[1], wide, should);
        for (int c = 0; c < 3; c++, count++) {
            const double e = encode((double)is[c]) - encode((double)should[c]);
            squares += e * e;
        }
    }
    print_message("broad: %.1f dB\n", -10 * log10(squares / count));
    assert_true(-10 * log10(squares / count) > 50);
    retex_texture_close(&texture);
}

/* Dark grey and nearly white, from a function of x and y in texels, each texel the average of 4 x 4 points. */
static RetexTexture *draw(int size, int (*white)(double x, double y))
{
    RetexImage im = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&im, size, size, 3, &err), &err);
    for (int i = 0; i < size * size; i++)
        for (int k = 0; k < 16; k++) {
            float share = (white(i % size + (k % 4 + 0.5) / 4, i / size + (k / 4 + 0.5) / 4) ? 0.9f : 0.05f) / 16;
            for (int c = 0; c < 3; c++)
                im.pixels[3 * i + c] += share;
        }
    return make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
}

static int checker(double x, double y)
{
    return ((int)(x / 32) + (int)(y / 32)) % 2;
}

/* Lines of strokes, upright, level and round. */
static int letters(double x, double y)
{
    int column = (int)(x / 20), line = (int)(y / 32);
    double s = x - 20 * column - 10, t = y - 32 * line - 16, r = hypot(s, t);
    if (fabs(t) > 10 || fabs(s) > 8)
        return 1;
    switch ((column * 7 + line * 3) % 4) {
    case 0:
        return !(fabs(s) < 1.5 || (fabs(t) < 1.5 && s > 0));
    case 1:
        return !(r > 5.5 && r < 8);
    case 2:
        return !(fabs(s - 0.6 * t) < 1.5);
    default:
        return !(s < -5.5 || fabs(t + 8) < 1.5);
    }
}

static void test_edges_alike(void **state)
{
    (void)state;
    RetexTexture *textures[2] = {draw(512, checker), draw(640, letters)};
    expect_alike("checker", textures[0], 45);
    expect_alike("letters", textures[1], 45);
    for (int i = 0; i < 2; i++)
        retex_texture_close(&textures[i]);
}

/* Borders, alpha, odd sizes, and what is much larger than the texture. */
static void test_borders_alike(void **state)
{
    (void)state;
    static const int sizes[][2] = {{128, 128}, {91, 37}, {64, 9}};
    for (int n = 0; n < 3 * 16; n++) {
        const int *size = sizes[n / 16];
        RetexImage im = {0};
        test_random_image(&im, size[0], size[1], 4, (uint32_t)n, 0.2, 0.8);
        RetexTexture *wide = make_texture(&im, (RetexWrap)(n % 4), (RetexWrap)(n / 4 % 4));
        RetexTexture *textures[2] = {wide, narrowed(wide)};
        scatter(size[0], size[1], 0.2, 60, 8, (uint32_t)n);
        for (int i = 0; i < 4; i++)
            assert_true(compare(textures[i / 2], (RetexTextureFilter)(i % 2)).psnr > 44); /* white noise */
        retex_texture_close(&textures[0]);
        retex_texture_close(&textures[1]);
    }
}

/* Gaussians that the surface's ends cut, little or much, on every way; also turned by quarters, and mirrored. */
static void test_cut_alike(void **state)
{
    (void)state;
    static const int sizes[][2] = {{512, 512}, {91, 37}, {8, 8}};
    const int level = (int)retex_cpu_level();
    for (int n = 0; n < 3 * 4; n++) {
        const int *size = sizes[n / 4];
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexError err = {0};
        RetexImage im = {0};
        RetexTexture *texture;
        test_random_image(&im, size[0], size[1], 3, (uint32_t)n, 0.2, 0.8);
        spec.rotate = 90 * (n % 4);
        spec.flip[0] = n % 2;
        for (int axis = 0; axis < 2; axis++) {
            spec.uv_min[axis] = ends[axis][0];
            spec.uv_max[axis] = ends[axis][1];
        }
        test_must(retex_texture_create(&texture, &im, &spec, 0, &err), &err);
        scatter(size[0], size[1], 0.2, size[0], 4, (uint32_t)n);
        for (int i = 0; i < 3 * COUNT; i++) /* a mean of places on the surface is one too */
            if (i % 3 < 2)
                footprints.uv[i] =
                    (float)(ends[i % 3][0] + (ends[i % 3][1] - ends[i % 3][0]) * ((double)footprints.uv[i] + 0.5) / 2);
        filter_singly(texture, RETEX_TEXTURE_GAUSSIAN, footprints.other);
        for (int k = 0; k <= level; k++) {
            double squares = 0, largest = 0;
            retex_texture_filter_batches(retex_texture_batch_kernels[k], texture, RETEX_TEXTURE_GAUSSIAN, footprints.uv,
                                         footprints.spread, 3, COUNT, footprints.rgba, 4);
            for (int i = 0; i < 4 * COUNT; i++) {
                double e = fabs((double)footprints.rgba[i] - (double)footprints.other[i]);
                squares += e * e;
                largest = e > largest ? e : largest;
            }
            print_message("%d x %d, turned by %g: rms %.5f, at most %.4f\n", size[0], size[1], spec.rotate,
                          sqrt(squares / (4 * COUNT)), largest);
            assert_true(sqrt(squares / (4 * COUNT)) < 4e-3); /* of white noise */
            assert_true(largest < 0.05);                     /* where little is left of one */
        }
        retex_texture_close(&texture);
        retex_image_free(&im);
    }
}

/* Small levels have more texels around them than the image has: what find_row and wrap_index say lies there. */
static void test_small_levels_padded(void **state)
{
    (void)state;
    for (int n = 0; n < 16; n++) {
        RetexImage im = {0};
        int padded = 0;
        test_random_image(&im, 700, 577, 4, (uint32_t)n, 0, 1);
        RetexTexture *texture = make_texture(&im, (RetexWrap)(n % 4), (RetexWrap)(n / 4 % 4));
        assert_null(texture->levels[0].padded);
        for (int l = 0; l < texture->nlevels; l++) {
            const RetexTextureLevel *level = &texture->levels[l];
            const int edge = level->padding, width = level->width + 2 * edge;
            for (int y = -edge; level->padded && y + 4 <= level->height + edge; y += 3)
                for (int x = -edge; x + 4 <= level->width + edge; x += 3) {
                    float block[4][16];
                    retex_texture_copy_block(texture, level, x, y, (char *)block);
                    for (int j = 0; j < 4; j++) {
                        size_t at = (size_t)(y + j + edge) * (size_t)width + (size_t)(x + edge);
                        assert_memory_equal(block[j], (const float *)level->padded + 4 * at, sizeof block[j]);
                    }
                }
            padded += level->padded != NULL;
        }
        assert_true(padded >= 8);
        retex_texture_close(&texture);
    }
}

/* ---- a texture that moves ---- */

/* A footprint in steps of a fiftieth of a texel: it goes as smoothly as the reference, and the mean of its colours is
 * the same. */
static void test_steady(void **state)
{
    (void)state;
    RetexTexture *texture = draw(640, letters);
    uint32_t seed = 9;
    for (int n = 0; n < 60; n++) {
        double shorter = 0.2 * pow(20, test_random(&seed)), longer = shorter * pow(4, test_random(&seed)), cov[3];
        double angle = M_PI * test_random(&seed), u = test_random(&seed), v = test_random(&seed);
        test_turned_covariance(cov, longer, shorter, angle);
        for (int i = 0; i < COUNT; i++) {
            footprints.uv[3 * i] = (float)(u + i * cos(angle) / 50 / 640);
            footprints.uv[3 * i + 1] = (float)(v + i * sin(angle) / 50 / 640);
            footprints.uv[3 * i + 2] = 1;
            footprints.spread[3 * i] = (float)(sqrt(cov[0]) / 640);
            footprints.spread[3 * i + 1] = (float)(sqrt(cov[2]) / 640);
            footprints.spread[3 * i + 2] = (float)(cov[1] / sqrt(cov[0] * cov[2]));
        }
        RetexTextureFilter shape = n % 2 ? RETEX_TEXTURE_GAUSSIAN : RETEX_TEXTURE_DISC;
        retex_texture_filter(texture, shape, footprints.uv, footprints.spread, 3, COUNT, footprints.rgba, 4);
        filter_singly(texture, shape, footprints.other);
        double sums[2] = {0, 0}, squares[2] = {0, 0}, jumps[2] = {0, 0};
        for (int i = 0; i < COUNT; i++)
            for (int k = 0; k < 2; k++) {
                const float *p = k ? footprints.other : footprints.rgba;
                double value = (double)p[4 * i], step = i ? fabs(value - (double)p[4 * i - 4]) : 0;
                sums[k] += value / COUNT;
                squares[k] += value * value / COUNT;
                jumps[k] = step > jumps[k] ? step : jumps[k];
            }
        for (int k = 0; k < 2; k++)
            squares[k] = sqrt(fmax(squares[k] - sums[k] * sums[k], 0));
        assert_float_equal(sums[0], sums[1], 6e-3); /* of sixty texels, by chance along an edge */
        assert_float_equal(squares[0], squares[1], 5e-3);
        assert_true(jumps[0] < 1.5 * jumps[1] + 0.002);
    }
    retex_texture_close(&texture);
}

/* ---- odd requests ---- */

static void test_odd(void **state)
{
    (void)state;
    static const float odd[] = {0, 1e-30f, 1e-4f, 1, 1e6f, 1e30f, -1, NAN, INFINITY, -0.5f, 1e9f};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *constant;
    RetexError err = {0};
    RetexImage im = {0};
    test_random_image(&im, 33, 20, 4, 1, 0, 1);
    RetexTexture *texture = make_texture(&im, RETEX_WRAP_REPEAT, RETEX_WRAP_CLAMP);
    uint32_t seed = 3;
    for (int i = 0; i < 3 * COUNT; i++) {
        footprints.uv[i] = odd[(int)(11 * test_random(&seed))];
        footprints.spread[i] = odd[(int)(11 * test_random(&seed))];
    }
    spec.constant = 1;
    spec.color[1] = 7;
    test_must(retex_texture_load(&constant, &spec, 1, &err), &err);
    for (int shape = 0; shape < 3; shape++)
        for (int k = 0; k < 2; k++) {
            retex_texture_filter(k ? constant : texture, (RetexTextureFilter)shape, footprints.uv, footprints.spread, 3,
                                 COUNT, footprints.rgba, 4);
            retex_texture_filter(k ? constant : texture, (RetexTextureFilter)shape, footprints.uv, footprints.spread, 3,
                                 COUNT, footprints.other, 3);
            for (int i = 0; i < COUNT; i++) {
                assert_memory_equal(footprints.other + 3 * i, footprints.rgba + 4 * i, 3 * sizeof(float));
                const float *p = footprints.rgba + 4 * i, seen = footprints.uv[3 * i + 2] > 0 ? 1 : 0;
                for (int c = 0; c < 4; c++)
                    assert_true(p[c] >= 0 && p[c] <= seen * (k ? 7 : 1.0001f));
                if (k)
                    assert_true(p[3] == seen && p[1] == 7 * seen);
            }
        }
    retex_texture_close(&texture);
    retex_texture_close(&constant);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bits),     cmocka_unit_test(test_pictures_alike),
        cmocka_unit_test(test_needles_alike), cmocka_unit_test(test_far_surfaces),
        cmocka_unit_test(test_broad),
        cmocka_unit_test(test_edges_alike),   cmocka_unit_test(test_borders_alike),
        cmocka_unit_test(test_cut_alike),     cmocka_unit_test(test_small_levels_padded),
        cmocka_unit_test(test_steady),        cmocka_unit_test(test_odd),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
