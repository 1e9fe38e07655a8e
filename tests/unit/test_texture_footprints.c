/* Measurements of the filter kernels: their mean and covariance, by filtering pictures of x, y, x^2, xy and y^2, and
 * their colours, compared with simple numerical integrals of the point look-up. */
#include "lib_filter.h"
#include "lib_test.h"
#include "texture/pyramid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

typedef void Filter(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

static RetexTexture *random_texture(int width, int height, uint32_t seed, int wrap_u, int wrap_v)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage im = {0};
    RetexTexture *texture;
    RetexError err = {0};
    spec.wrap[0] = (RetexWrap)wrap_u;
    spec.wrap[1] = (RetexWrap)wrap_v;
    test_random_image(&im, width, height, 4, seed, 0, 1);
    test_must(retex_texture_create(&texture, &im, &spec, 0, &err), &err);
    retex_image_free(&im);
    return texture;
}

/* ---- the kernel's covariance ---- */

/* Pictures of x, y, x^2 and of xy, y^2, in texels from the middle, y up; the squares divided, since colours end at
 * 65504. */
#define DIVISOR 8
typedef struct Moments {
    int width, height;
    RetexTexture *first, *second;
} Moments;

static void make_moments(Moments *m, int width, int height)
{
    RetexImage first = {0}, second = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&first, width, height, 3, &err), &err);
    test_must(retex_image_alloc(&second, width, height, 3, &err), &err);
    for (int row = 0; row < height; row++)
        for (int column = 0; column < width; column++) {
            double x = column + 0.5 - 0.5 * width, y = 0.5 * height - row - 0.5;
            float *p = first.pixels + retex_image_index(&first, column, row);
            float *q = second.pixels + retex_image_index(&second, column, row);
            p[0] = (float)x;
            p[1] = (float)y;
            p[2] = (float)(x * x / DIVISOR);
            q[0] = (float)(x * y / DIVISOR);
            q[1] = (float)(y * y / DIVISOR);
        }
    m->width = width;
    m->height = height;
    test_must(retex_texture_create(&m->first, &first, NULL, 0, &err), &err);
    test_must(retex_texture_create(&m->second, &second, NULL, 0, &err), &err);
    retex_image_free(&first);
    retex_image_free(&second);
}

static void free_moments(Moments *m)
{
    retex_texture_close(&m->first);
    retex_texture_close(&m->second);
}

/* What bilinear reconstruction adds to x^2, f (1 - f) at the fraction f between two texels, averaged over a footprint
 * of that variance around x: a Fourier series, each wave damped by the footprint's transform. */
static double tent_variance(double x, double variance, int disc)
{
    double sum = 1.0 / 6;
    for (int k = 1; k < 60; k++) {
        double z = 4 * M_PI * k * sqrt(variance);
        double damping = !disc ? exp(-z * z / 8) : z > 0 ? 2 * j1(z) / z : 1;
        sum -= cos(2 * M_PI * k * x) * damping / (M_PI * M_PI * k * k);
    }
    return sum;
}

typedef struct Errors {
    double worst, squares; /* of variances, relative */
    double mean;           /* of the mean's place, in standard deviations */
    int count;
} Errors;

/* One footprint, everything in texels: how far its realised variances lie from what they should be, along both axes. */
static void measure(const Moments *m, int disc, double x, double y, double longer, double shorter, double angle,
                    Errors *errors)
{
    Filter *filter = disc ? filter_disc : filter_gaussian;
    double cov[3], uv[3], w = m->width, h = m->height;
    float p[4], q[4];
    test_turned_covariance(cov, longer, shorter, angle);
    uv[0] = cov[0] / (w * w);
    uv[1] = cov[1] / (w * h);
    uv[2] = cov[2] / (h * h);
    filter(m->first, 0.5 + x / w, 0.5 + y / h, uv, p);
    filter(m->second, 0.5 + x / w, 0.5 + y / h, uv, q);
    double mx = (double)p[0], my = (double)p[1];
    double xx = DIVISOR * (double)p[2] - mx * mx - tent_variance(x + 0.5 * w - 0.5, cov[0], disc);
    double xy = DIVISOR * (double)q[0] - mx * my,
           yy = DIVISOR * (double)q[1] - my * my - tent_variance(y + 0.5 * h - 0.5, cov[2], disc);
    for (int axis = 0; axis < 2; axis++) {
        double c = cos(angle + axis * M_PI / 2), s = sin(angle + axis * M_PI / 2), sd = axis ? shorter : longer;
        double e = (c * c * xx + 2 * c * s * xy + s * s * yy) / (sd * sd) - 1, off = (c * (mx - x) + s * (my - y)) / sd;
        errors->squares += e * e;
        errors->count++;
        errors->mean = fabs(off) > errors->mean ? fabs(off) : errors->mean;
        errors->worst = fabs(e) > errors->worst ? fabs(e) : errors->worst;
    }
}

/* Sizes from 0.3 texel to where the footprint reaches the texture's border, in steps; elongations to 30 : 1; every
 * eighth footprint along an axis or a diagonal. */
static void measure_all(const Moments *m, int disc, Errors *errors)
{
    uint32_t seed = 23;
    int smaller = m->width < m->height ? m->width : m->height;
    double largest = (0.5 * smaller - 8) / (disc ? 2.6 : 3.8); /* standard deviations that a footprint reaches */
    for (double step = 0.3; step < largest; step *= 1.5)
        for (int i = 0; i < 600; i++) {
            double b = step * pow(1.5, test_random(&seed)), a = b * pow(30, test_random(&seed));
            a = a > largest ? largest : a;
            b = b > largest ? largest : b;
            double angle = i % 8 ? M_PI * test_random(&seed) : (i / 8) % 4 * M_PI / 4;
            double x = 0.5 * a * (2 * test_random(&seed) - 1), y = 0.5 * a * (2 * test_random(&seed) - 1);
            measure(m, disc, x, y, a, b, angle, errors);
        }
}

static void test_covariance(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1024, 1024}, {905, 603}, {1000, 511}};
    for (size_t n = 0; n < sizeof sizes / sizeof sizes[0]; n++) {
        Moments m;
        make_moments(&m, sizes[n][0], sizes[n][1]);
        for (int disc = 0; disc < 2; disc++) {
            Errors errors = {0};
            measure_all(&m, disc, &errors);
            double rms = sqrt(errors.squares / errors.count);
            print_message(
                "%s on %d x %d: variance off by %.2f%% rms, %.1f%% at worst; mean by %.4f standard deviations\n",
                disc ? "disc" : "Gaussian", m.width, m.height, 100 * rms, 100 * errors.worst, errors.mean);
            assert_true(rms < 0.003);
            assert_true(errors.worst < 0.04);
            assert_true(errors.mean < 0.01);
        }
        free_moments(&m);
    }
}

/* ---- against integrals ---- */

/* The point look-up averaged over an ellipse, in polar coordinates, every ring of equal share. */
static void integrate_disc(const RetexTexture *texture, double u, double v, const double covariance[3], int rings,
                           double rgba[4])
{
    double a = 2 * sqrt(covariance[0]), b = a > 0 ? 4 * covariance[1] / a : 0, rest = 4 * covariance[2] - b * b;
    double c = rest > 0 ? sqrt(rest) : 0, sum[4] = {0, 0, 0, 0};
    int spokes = 3 * rings;
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < spokes; j++) {
            double r = sqrt((i + 0.5) / rings), phi = 2 * M_PI * (j + 0.618 * i) / spokes;
            double s = r * cos(phi), t = r * sin(phi);
            float point[4];
            retex_texture_point(texture, u + a * s, v + b * s + c * t, point);
            for (int k = 0; k < 3; k++)
                sum[k] += (double)point[k] * (double)point[3];
            sum[3] += (double)point[3];
        }
    for (int k = 0; k < 4; k++)
        rgba[k] = sum[k] / (rings * spokes);
}

/* White noise, all wraps, any orientation. The integral itself is rough where a black axis ends. */
static void test_disc_integral(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {45, 27}, {64, 9}, {128, 100}};
    uint32_t seed = 17;
    double worst = 0, worst_black = 0, sum = 0;
    int count = 0;
    for (int n = 0; n < 4 * 16; n++) {
        const int *size = sizes[n / 16];
        RetexTexture *t = random_texture(size[0], size[1], (uint32_t)n, n % 4, n / 4 % 4);
        int black = n % 4 == RETEX_WRAP_BLACK || n / 4 % 4 == RETEX_WRAP_BLACK;
        for (int i = 0; i < 8; i++) {
            double longer = 0.3 * pow(80, test_random(&seed)), shorter = longer * pow(8, -test_random(&seed)), cov[3];
            double u = 1.4 * test_random(&seed) - 0.2, v = 1.4 * test_random(&seed) - 0.2, want[4];
            float got[4];
            test_turned_covariance(cov, longer, shorter, M_PI * test_random(&seed));
            cov[0] /= size[0] * size[0];
            cov[1] /= size[0] * size[1];
            cov[2] /= size[1] * size[1];
            filter_disc(t, u, v, cov, got);
            integrate_disc(t, u, v, cov, 100, want);
            for (int k = 0; k < 4; k++, count++) {
                double e = fabs((double)got[k] * (k < 3 ? (double)got[3] : 1) - want[k]);
                double *where = black ? &worst_black : &worst;
                *where = e > *where ? e : *where;
                sum += e;
            }
        }
        retex_texture_close(&t);
    }
    print_message("disc on white noise of 0..1: off by %.5f, %.4f at worst, with black wraps %.4f\n", sum / count,
                  worst, worst_black);
    assert_true(sum / count < 0.0007);
    assert_true(worst < 0.015);
    assert_true(worst_black < 0.015);
}

/* No disc is the point; one as large as many repeats is the mean; beside a clamped image lies its border; far from a
 * black one nothing. */
static void test_disc_limits(void **state)
{
    (void)state;
    static const int sizes[][2] = {{64, 64}, {37, 23}, {100, 1}, {1, 9}, {1, 1}, {255, 16}};
    uint32_t seed = 11;
    for (int n = 0; n < 6 * 16; n++) {
        const int *size = sizes[n / 16];
        int wrap_u = n % 4, wrap_v = n / 4 % 4;
        RetexTexture *t = random_texture(size[0], size[1], 7, wrap_u, wrap_v);
        float a[4], b[4], mean[4] = {0, 0, 0, 0};
        for (int i = 0; i < 50; i++) {
            double u = 0.05 + 0.9 * test_random(&seed), v = 0.05 + 0.9 * test_random(&seed), tiny = 1e-5 / size[0];
            retex_texture_point(t, u, v, a);
            filter_disc(t, u, v, (double[3]){0, 0, 0}, b);
            assert_memory_equal(a, b, sizeof a);
            filter_disc(t, u, v, (double[3]){tiny * tiny, 0, tiny * tiny}, b);
            for (int k = 0; k < 4; k++)
                assert_float_equal(a[k], b[k], 5e-3);
        }
        for (int y = 0; y < size[1]; y++)
            for (int x = 0; x < size[0]; x++) {
                retex_texture_nearest(t, (x + 0.5) / size[0], (y + 0.5) / size[1], a);
                for (int k = 0; k < 4; k++)
                    mean[k] += a[k] * (k < 3 ? a[3] : 1) / (float)(size[0] * size[1]);
            }
        static const double sds[] = {3, 20, 500, 1e6, 1e30};
        for (int i = 0; i < 5; i++) {
            double sd = sds[i], share = 1 / (4 * M_PI * sd * sd);
            filter_disc(t, 0.3 + i, 0.2 * i, (double[3]){sd * sd, 0, sd * sd}, b);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(b[k]) && b[k] >= 0 && b[k] <= 1.0001f);
            if (wrap_u == RETEX_WRAP_BLACK && wrap_v == RETEX_WRAP_BLACK && i < 3)
                assert_float_equal(b[3], mean[3] * share, 0.05 * mean[3] * share);
            for (int k = 0; k < 4 && wrap_u < 2 && wrap_v < 2; k++)
                assert_float_equal(b[k], k < 3 ? mean[k] / mean[3] : mean[3], 2e-3);
        }
        retex_texture_close(&t);
    }
}

/* Whatever is asked of whatever texture: finite colours, and none that is not between those of the texels. */
static void test_extremes(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 7}, {9, 1}, {2, 3}, {4096, 5}, {3, 8192}, {61, 64}};
    static const double places[] = {0.3, 0, 1, -0.5, 1e6, -1e18, 1e300, NAN, INFINITY};
    static const double covariances[][3] = {
        {0, 0, 0},       {1e-12, 0, 1e-12}, {1e-4, 0, 1e-4},  {1e-4, 1e-4, 1e-4}, {1, -0.99, 1},
        {1e6, 0, 1e-9},  {1e-9, 0, 1e6},    {1e6, 1e6, 1e6},  {1e12, 0, 1e12},    {1e300, 0, 0},
        {0, 0, 1e-300},  {NAN, 0, 1},       {1, NAN, 1},      {1, 0, INFINITY},   {-1, 0, -1},
        {1e-4, 5, 1e-4}, {0, 1, 0},         {1e5, -1e5, 1e5}, {3e-7, 0, 3e-7},    {0.25, 0, 0},
    };
    for (int n = 0; n < 7 * 16 * 3; n++) {
        const int *size = sizes[n / 48];
        int kind = n / 16 % 3; /* LDR; HDR; invisible */
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexImage im = {0};
        RetexError err = {0};
        RetexTexture *textures[2];
        float largest = kind == 1 ? 1e6f : 1;
        spec.wrap[0] = (RetexWrap)(n % 4);
        spec.wrap[1] = (RetexWrap)(n / 4 % 4);
        spec.repeat = n % 16 ? RETEX_REPEAT_STRAIGHT : kind == 1 ? RETEX_REPEAT_BRICK : RETEX_REPEAT_HALF_DROP;
        spec.rotate = n % 3 ? 0 : 45;
        spec.scale[0] = n % 5 ? 1 : 1e308;
        spec.offset[1] = n % 7 ? 0 : -1.7e308;
        test_random_image(&im, size[0], size[1], 4, 3, 0, (double)largest);
        for (int i = 0; i < size[0] * size[1]; i++)
            im.pixels[4 * i + 3] = kind == 2 ? 0 : kind == 1 && i % 5 == 0 ? 1e-38f : 1;
        test_must(retex_texture_create(&textures[0], &im, &spec, 0, &err), &err);
        test_must(retex_texture_square(&textures[1], textures[0], 0, &err), &err);
        for (int i = 0; i < 9 * 20 * 4; i++) {
            Filter *filter = i & 1 ? filter_disc : filter_gaussian;
            float p[4], limit = (i & 2 ? largest * largest : largest) * 1.001f;
            filter(textures[i / 2 % 2], places[i / 80], places[(i / 80 + i) % 9], covariances[i / 4 % 20], p);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(p[k]) && p[k] >= 0 && p[k] <= (k < 3 ? limit : 1));
            assert_true(kind != 2 || p[3] == 0);
        }
        retex_texture_close(&textures[0]);
        retex_texture_close(&textures[1]);
        retex_image_free(&im);
    }
}

/* ---- the surface's border ---- */

/* A quadrant each of red, green, blue and white, by u < 0.5 and v < 0.5. */
static RetexTexture *quadrants(int size, const RetexTextureSpec *spec)
{
    static const float colors[2][2][3] = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 1, 1}}};
    RetexImage im = {0};
    RetexTexture *texture;
    RetexError err = {0};
    test_must(retex_image_alloc(&im, size, size, 3, &err), &err);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            memcpy(im.pixels + retex_image_index(&im, x, y), colors[2 * y < size][2 * x >= size], sizeof colors[0][0]);
    test_must(retex_texture_create(&texture, &im, spec, 0, &err), &err);
    retex_image_free(&im);
    return texture;
}

static RetexTextureSpec placed(int way, int limited)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    spec.rotate = 90 * (double)(way % 4) - (way & 64 ? 360 : 0);
    spec.flip[0] = way >> 2 & 1;
    spec.flip[1] = way >> 3 & 1;
    spec.scale[0] = way & 16 ? -1 : 1;
    spec.scale[1] = way & 32 ? -1 : 1;
    for (int axis = 0; axis < 2 && limited; axis++)
        spec.uv_min[axis] = 0, spec.uv_max[axis] = 1;
    return spec;
}

/* In a corner of the surface, where the repeated image has all four colours side by side, only that of the corner is
 * seen, however the image is turned by quarters and mirrored. */
static void test_borders(void **state)
{
    (void)state;
    uint32_t seed = 41;
    for (int n = 0; n < 128 * 3; n++) {
        static const int sizes[] = {64, 50, 256};
        RetexTextureSpec cut = placed(n / 3, 1), whole = placed(n / 3, 0);
        RetexTexture *t = quadrants(sizes[n % 3], &cut), *without = quadrants(sizes[n % 3], &whole);
        int others = 0;
        for (int i = 0; i < 40; i++) {
            int right = i & 1, up = i >> 1 & 1;
            double u = 0.1 * test_random(&seed), v = 0.1 * test_random(&seed), cov[3] = {0, 0, 0};
            float got[4], want[4], mixed[4];
            u = right ? 1 - u : u;
            v = up ? 1 - v : v;
            cov[0] = pow(0.1 * pow(0.05, test_random(&seed)), 2);
            cov[2] = pow(0.1 * pow(0.05, test_random(&seed)), 2);
            filter_gaussian(t, u, v, cov, got);
            filter_gaussian(without, u, v, cov, mixed);
            retex_texture_nearest(t, right ? 0.75 : 0.25, up ? 0.75 : 0.25, want);
            for (int k = 0; k < 4; k++)
                assert_float_equal(got[k], want[k], 1e-5);
            others += memcmp(got, mixed, sizeof got) != 0;
        }
        assert_in_range(others, 10, 40);
        retex_texture_close(&t);
        retex_texture_close(&without);
    }
}

/* Mean of what a Gaussian leaves beyond a border at distance z below its mean, all in standard deviations. */
static double mean_above(double z)
{
    return exp(-0.5 * z * z) / sqrt(2 * M_PI) / (0.5 * erfc(z / sqrt(2)));
}

/* Pictures of x and y: where the mean of the rest lies, also of footprints that lie aslant. */
static void test_rest_of_a_footprint(void **state)
{
    (void)state;
    enum { SIZE = 512 };
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage im = {0};
    RetexTexture *texture;
    RetexError err = {0};
    uint32_t seed = 43;
    spec.wrap[0] = spec.wrap[1] = RETEX_WRAP_CLAMP;
    spec.uv_min[0] = 0.5, spec.uv_max[0] = 2;
    spec.uv_min[1] = -1, spec.uv_max[1] = 2;
    test_must(retex_image_alloc(&im, SIZE, SIZE, 3, &err), &err);
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            float *p = im.pixels + retex_image_index(&im, x, y);
            p[0] = ((float)x + 0.5f) / SIZE;
            p[1] = 1 - ((float)y + 0.5f) / SIZE;
        }
    test_must(retex_texture_create(&texture, &im, &spec, 0, &err), &err);
    double worst = 0;
    for (int i = 0; i < 4000; i++) {
        double su = 0.004 + 0.05 * test_random(&seed), sv = 0.004 + 0.05 * test_random(&seed);
        double correlation = i % 4 ? 1.9 * test_random(&seed) - 0.95 : 0, z = 3 * test_random(&seed);
        float got[4];
        filter_gaussian(texture, 0.5 + z * su, 0.5, (double[3]){su * su, correlation * su * sv, sv * sv}, got);
        double off = mean_above(-z), u = ((double)got[0] - 0.5) / su - z - off,
               v = ((double)got[1] - 0.5) / sv - correlation * off;
        double e = fmax(fabs(u), fabs(v));
        worst = fmax(worst, e);
    }
    print_message("mean of what is left of a footprint: off by %.4f standard deviations\n", worst);
    assert_true(worst < 0.1); /* at a border it would be 0.8 */
    retex_texture_close(&texture);
    retex_image_free(&im);
}

/* What is nowhere near a border is the same to the bit; so is all where the image is turned by other than quarters, and
 * of discs. A place outside, which only rounding makes, has a colour too. */
static void test_uncut(void **state)
{
    (void)state;
    static const double rotations[] = {0, 30, 90, 45, -89};
    uint32_t seed = 47;
    for (int n = 0; n < 5 * 16; n++) {
        RetexTextureSpec whole = RETEX_TEXTURE_SPEC_INIT, cut;
        RetexImage im = {0};
        RetexTexture *a, *b;
        RetexError err = {0};
        whole.wrap[0] = (RetexWrap)(n % 4);
        whole.wrap[1] = (RetexWrap)(n / 4 % 4);
        whole.rotate = rotations[n / 16];
        cut = whole;
        for (int axis = 0; axis < 2; axis++)
            cut.uv_min[axis] = -0.25, cut.uv_max[axis] = 1.5;
        test_random_image(&im, 48, 37, 4, 3, 0, 1);
        test_must(retex_texture_create(&a, &im, &whole, 0, &err), &err);
        test_must(retex_texture_create(&b, &im, &cut, 0, &err), &err);
        int turned = fmod(whole.rotate, 90) != 0, others = 0;
        int repeats = n % 4 <= RETEX_WRAP_MIRROR && n / 4 % 4 <= RETEX_WRAP_MIRROR;
        for (int i = 0; i < 200; i++) {
            double longer = 0.3 * pow(200, -test_random(&seed)), cov[3], p[2];
            float x[4], y[4];
            test_turned_covariance(cov, longer, longer * pow(10, -test_random(&seed)), M_PI * test_random(&seed));
            for (int axis = 0; axis < 2; axis++) { /* windows reach 3.25 standard deviations and some texels */
                double margin = turned ? 0 : 4.5 * longer + 0.3;
                p[axis] = -0.25 + margin + (1.75 - 2 * margin) * test_random(&seed);
            }
            if (turned || 4.5 * longer + 0.3 < 0.8) {
                filter_gaussian(a, p[0], p[1], cov, x);
                filter_gaussian(b, p[0], p[1], cov, y);
                assert_memory_equal(x, y, sizeof x);
            }
            p[0] = -0.25 + longer * test_random(&seed); /* at a border */
            filter_disc(a, p[0], p[1], cov, x);
            filter_disc(b, p[0], p[1], cov, y);
            assert_memory_equal(x, y, sizeof x);
            filter_gaussian(a, p[0], p[1], cov, x);
            filter_gaussian(b, p[0], p[1], cov, y);
            others += memcmp(x, y, sizeof x) != 0;
            p[0] = -0.25 - (i % 2 ? 1e-9 : 1000 * longer);
            filter_gaussian(b, p[0], p[1], cov, y);
            for (int k = 0; k < 4; k++)
                assert_true(isfinite(y[k]) && y[k] >= 0 && y[k] <= 1.0001f);
            assert_true(y[3] > 0 || !repeats);
        }
        assert_true(turned ? others == 0 : others > 50 || !repeats);
        retex_texture_close(&a);
        retex_texture_close(&b);
        retex_image_free(&im);
    }
}

static void test_speed(void **state)
{
    (void)state;
    RetexTexture *t = random_texture(1024, 1024, 1, RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT);
    static const struct {
        double longer, shorter, angle;
    } cases[] = {{0.5, 0.5, 0}, {1, 1, 0},   {1.5, 1, 0.5}, {2, 2, 0},
                 {3, 3, 0},     {30, 30, 0}, {10, 1, 0.5},  {30, 1, 0.5}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        double cov[3], rate[2];
        float p[4];
        test_turned_covariance(cov, cases[i].longer / 1024, cases[i].shorter / 1024, cases[i].angle);
        for (int disc = 0; disc < 2; disc++) {
            Filter *filter = disc ? filter_disc : filter_gaussian;
            clock_t began = clock();
            for (int k = 0; k < 50000; k++)
                filter(t, (k % 640) / 640.0, (k / 640) / 480.0, cov, p);
            rate[disc] = 0.05 * CLOCKS_PER_SEC / (double)(clock() - began);
        }
        print_message("footprint of %g x %g texels: Gaussian %.1f, disc %.1f M look-ups a second\n", cases[i].longer,
                      cases[i].shorter, rate[0], rate[1]);
    }
    retex_texture_close(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_covariance),  cmocka_unit_test(test_disc_integral),
        cmocka_unit_test(test_disc_limits), cmocka_unit_test(test_extremes),
        cmocka_unit_test(test_borders),     cmocka_unit_test(test_rest_of_a_footprint),
        cmocka_unit_test(test_uncut),       cmocka_unit_test(test_speed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
