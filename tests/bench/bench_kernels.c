/* Optimised kernels against the plain references that the unit tests compare them with. */
#include <math.h>
#include <retex/combine.h>
#include <stdio.h>
#include <stdlib.h>

#include "lib_filter.h"
#include "bench.h"
#include "retexture/combine_kernel.h"
#include "base/half.h"
#include "lib_test.h"
#include "texture/filter.h"

/* ---- half ---- */

enum { VALUES = 1 << 14 }; /* stays in the cache, as a row of a picture does */

typedef struct Halves {
    float floats[VALUES];
    uint16_t halves[VALUES];
} Halves;

static void to_float(void *context)
{
    Halves *h = context;
    retex_half_to_float(h->floats, h->halves, VALUES);
}

static void to_float_scalar(void *context)
{
    Halves *h = context;
    retex_half_to_float_scalar(h->floats, h->halves, VALUES);
}

static void from_float(void *context)
{
    Halves *h = context;
    retex_half_from_float(h->halves, h->floats, VALUES);
}

static void from_float_scalar(void *context)
{
    Halves *h = context;
    retex_half_from_float_scalar(h->halves, h->floats, VALUES);
}

/* ---- one term of the polynomial ---- */

typedef struct Term {
    RetexImage images[5]; /* sum, radiance, factors */
    const float *factors[3];
    int nfactors;
} Term;

static void term_kernel(void *context)
{
    Term *t = context;
    retex_combine_term_kernel(t->images[0].pixels, t->images[1].pixels, t->factors, t->nfactors, VALUES);
}

static void term_reference(void *context)
{
    Term *t = context;
    for (size_t i = 0; i < VALUES; i++) {
        float product = t->images[1].pixels[i];
        for (int k = 0; k < t->nfactors; k++)
            product *= t->factors[k][i];
        t->images[0].pixels[i] += product;
    }
}

/* ---- a whole picture, as Eq. 4 of the paper's supplement says it ---- */

static void picture(void *context)
{
    RetexImage image = {0};
    RetexError err = {0};
    test_must(retex_combine(&image, context, NULL, NULL, 1, &err), &err);
    bench_sink = image.pixels[0];
    retex_image_free(&image);
}

static void picture_reference(void *context)
{
    const RetexSet *set = context;
    RetexImage image = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&image, set->width, set->height, 3, &err), &err);
    for (size_t i = 0; i < (size_t)set->width * (size_t)set->height * 3; i++)
        for (int t = 0; t < set->nterms; t++) {
            const RetexTerm *term = &set->terms[t];
            float product = set->parts[term->radiance].image.pixels[i];
            for (int k = 0; k < term->nfactors; k++)
                product *= set->parts[set->footprints[term->factors[k].index].albedo].image.pixels[i];
            image.pixels[i] += product;
        }
    bench_sink = image.pixels[0];
    retex_image_free(&image);
}

/* ---- filtering ---- */

typedef struct Filter {
    RetexTexture *texture;
    double longer, shorter; /* standard deviations, in repeats; the longer axis lies at 30 degrees */
} Filter;

static void gaussian(void *context)
{
    const Filter *f = context;
    double a = f->longer * f->longer, b = f->shorter * f->shorter;
    float rgba[4];
    filter_gaussian(f->texture, 0.3, 0.7, (double[3]){0.75 * a + 0.25 * b, 0.433 * (a - b), 0.25 * a + 0.75 * b},
                           rgba);
    bench_sink = rgba[0];
}

/* Points at the pitch of texels, out to 3 standard deviations: what the sum over texels stands for. */
static void gaussian_reference(void *context)
{
    const Filter *f = context;
    int width, height;
    retex_texture_size(f->texture, &width, &height);
    double reach[2] = {3 * f->longer, 3 * f->shorter}, total = 0, sum[3] = {0, 0, 0};
    for (double s = -reach[0]; s <= reach[0]; s += 1.0 / width)
        for (double t = -reach[1]; t <= reach[1]; t += 1.0 / height) {
            double w = exp(-0.5 * (s * s / (f->longer * f->longer) + t * t / (f->shorter * f->shorter)));
            float rgba[4];
            retex_texture_point(f->texture, 0.3 + 0.866 * s - 0.5 * t, 0.7 + 0.5 * s + 0.866 * t, rgba);
            for (int k = 0; k < 3; k++)
                sum[k] += w * (double)rgba[k];
            total += w;
        }
    bench_sink = (float)((sum[0] + sum[1] + sum[2]) / total);
}

/* ---- rows of footprints ---- */

enum { SIDE = 64 };

/* A piece of a picture, SIDE by SIDE pixels, with a texture's footprints side by side as on a surface. */
typedef struct Rows {
    RetexTexture *texture;
    RetexTextureFilter shape;
    float uv[3 * SIDE * SIDE], spread[3 * SIDE * SIDE], axes[4 * SIDE * SIDE], rgba[4 * SIDE * SIDE];
} Rows;

static void rows_at_once(void *context)
{
    Rows *r = context;
    const int straight = r->shape == RETEX_TEXTURE_PARALLELOGRAM;
    retex_texture_filter(r->texture, r->shape, r->uv, straight ? r->axes : r->spread, straight ? 4 : 3, SIDE * SIDE,
                         r->rgba, 4);
    bench_sink = r->rgba[0];
}

static void rows_one_by_one(void *context)
{
    Rows *r = context;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double u = (double)r->spread[3 * i], v = (double)r->spread[3 * i + 1];
        double covariance[3] = {u * u, (double)r->spread[3 * i + 2] * u * v, v * v};
        const float *axes = r->axes + 4 * i;
        const double sides[2][2] = {{(double)axes[0], (double)axes[1]}, {(double)axes[2], (double)axes[3]}};
        if (r->shape == RETEX_TEXTURE_PARALLELOGRAM) {
            filter_parallelogram(r->texture, (double)r->uv[3 * i], (double)r->uv[3 * i + 1], sides,
                                        r->rgba + 4 * i);
            continue;
        }
        (r->shape == RETEX_TEXTURE_DISC ? filter_disc : filter_gaussian)(
            r->texture, (double)r->uv[3 * i], (double)r->uv[3 * i + 1], covariance, r->rgba + 4 * i);
    }
    bench_sink = r->rgba[0];
}

/* A box pixel filter of width w has the standard deviation w / sqrt(12): that many texels lie between pixels. */
static void lay_rows(Rows *r, double shorter, double longer, int texels)
{
    double covariance[3], pitch = sqrt(12.0);
    test_turned_covariance(covariance, longer, shorter, 0.5);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double s = pitch * longer * (i % SIDE), t = pitch * shorter * (i / SIDE); /* along the ellipse's axes */
        r->uv[3 * i] = (float)(0.1 + (cos(0.5) * s - sin(0.5) * t) / texels);
        r->uv[3 * i + 1] = (float)(0.2 + (sin(0.5) * s + cos(0.5) * t) / texels);
        r->uv[3 * i + 2] = 1;
        r->spread[3 * i] = (float)(sqrt(covariance[0]) / texels);
        r->spread[3 * i + 1] = (float)(sqrt(covariance[2]) / texels);
        r->spread[3 * i + 2] = (float)(covariance[1] / sqrt(covariance[0] * covariance[2]));
        r->axes[4 * i] = (float)(pitch * longer * cos(0.5) / texels);
        r->axes[4 * i + 1] = (float)(pitch * longer * sin(0.5) / texels);
        r->axes[4 * i + 2] = (float)(-pitch * shorter * sin(0.5) / texels);
        r->axes[4 * i + 3] = (float)(pitch * shorter * cos(0.5) / texels);
    }
}

static void bench_rows(void)
{
    static const double sizes[][2] = {{0.3, 0.3}, {0.5, 0.5}, {0.7, 0.7}, {1, 1},   {2, 2},
                                      {4, 4},     {0.5, 1},   {1, 2},     {0.5, 2}, {1, 4}};
    static Rows rows;
    RetexImage image = {0};
    RetexError err = {0};
    char name[96];
    test_random_image(&image, 2048, 2048, 3, 1, 0, 1);
    test_must(retex_texture_create(&rows.texture, &image, NULL, 0, &err), &err);
    retex_image_free(&image);
    bench_section("Rows of footprints, times as fast as one by one");
    static const RetexTextureFilter shapes[] = {RETEX_TEXTURE_DISC, RETEX_TEXTURE_GAUSSIAN,
                                                RETEX_TEXTURE_PARALLELOGRAM};
    static const char *const names[] = {"disc", "Gaussian", "parallelogram"};
    for (int shape = 0; shape < 3; shape++)
        for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
            rows.shape = shapes[shape];
            lay_rows(&rows, sizes[i][0], sizes[i][1], 2048);
            snprintf(name, sizeof name, "%s of %g x %g texels", names[shape], sizes[i][0], sizes[i][1]);
            bench_pair(name, rows_at_once, rows_one_by_one, &rows);
            bench_rate("    millions a second, a core", rows_at_once, &rows, SIDE * SIDE * 1e-6);
        }
    retex_texture_close(&rows.texture);
}

void bench_kernels(void)
{
    static Halves halves;
    uint32_t seed = 1;
    Term term = {.nfactors = 0};
    RetexImage image = {0};
    RetexError err = {0};
    char name[96];

    bench_section("Times as fast as the scalar reference");
    for (int i = 0; i < VALUES; i++)
        halves.floats[i] = (float)exp(16 * test_random(&seed) - 8);
    retex_half_from_float(halves.halves, halves.floats, VALUES);
    bench_pair("half to float", to_float, to_float_scalar, &halves);
    bench_pair("float to half", from_float, from_float_scalar, &halves);

    for (uint32_t i = 0; i < 5; i++)
        test_random_image(&term.images[i], VALUES, 1, 1, i, 0, 1);
    for (int k = 0; k < 3; k++)
        term.factors[k] = term.images[2 + k].pixels;
    for (; term.nfactors <= 3; term.nfactors++) {
        snprintf(name, sizeof name, "one term of %d factors", term.nfactors);
        bench_pair(name, term_kernel, term_reference, &term);
    }
    for (int i = 0; i < 5; i++)
        retex_image_free(&term.images[i]);

    RetexSet *set = test_set(640, 360, 1);
    bench_pair("recombination of a set, 640x360, two targets of three hits", picture, picture_reference, set);
    retex_set_close(&set);

    static const double sizes[][2] = {{0.5, 0.5}, {1.5, 1}, {8, 2}, {30, 30}};
    Filter filter;
    test_random_image(&image, 1024, 1024, 3, 1, 0, 1);
    test_must(retex_texture_create(&filter.texture, &image, NULL, 0, &err), &err);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        filter.longer = sizes[i][0] / 1024;
        filter.shorter = sizes[i][1] / 1024;
        snprintf(name, sizeof name, "texture filtered over %g x %g texels, against points a texel apart", sizes[i][0],
                 sizes[i][1]);
        bench_pair(name, gaussian, gaussian_reference, &filter);
    }
    retex_texture_close(&filter.texture);
    retex_image_free(&image);
    bench_rows();
}
