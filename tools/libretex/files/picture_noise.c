/* See picture_noise.h. */
#include "files/picture_noise.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

enum { RADIUS = 3, PLANES = 4 }; /* of the window of a variance; products of three channels, and their weight */

#define LEAST_ALBEDO 0.2f
#define NORMALS_AGREE 0.05f /* squared difference */
#define ALBEDOS_AGREE 0.05f
#define LEAST_WEIGHT 6      /* differences that a variance needs */
#define LEAST_OF_FOUR 0.79f /* the least of the four estimates, over the variance, where there is nothing but noise */

static const int directions[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};

typedef struct Estimate {
    RetexImage *variance;
    const RetexImage *picture, *normal, *albedo;
    float *products, *rows; /* PLANES floats a pixel: squared differences times weight, and weight; sums along rows */
    int direction;
} Estimate;

static size_t pixel_at(const RetexImage *image, int x, int y)
{
    return (size_t)y * (size_t)image->width + (size_t)x;
}

/* 1 if the features of two pixels agree. */
static int agree(const Estimate *e, size_t p, size_t q)
{
    float normal = 0, albedo = 0;
    for (size_t c = 0; c < 3; c++) {
        if (e->normal) {
            const float d = e->normal->pixels[3 * p + c] - e->normal->pixels[3 * q + c];
            normal += d * d;
        }
        if (e->albedo) {
            const float d = e->albedo->pixels[3 * p + c] - e->albedo->pixels[3 * q + c];
            albedo += d * d;
        }
    }
    return normal <= NORMALS_AGREE && albedo <= ALBEDOS_AGREE;
}

/* By what a pixel is divided. */
static float modulation(const Estimate *e, size_t p, size_t c)
{
    return e->albedo ? fmaxf(LEAST_ALBEDO, e->albedo->pixels[3 * p + c]) : 1;
}

static float divided(const Estimate *e, size_t p, size_t c)
{
    return e->picture->pixels[3 * p + c] / modulation(e, p, c);
}

/* The squared second differences of a row, along the direction. */
static void find_products(void *context, int y, int thread)
{
    const Estimate *e = context;
    const RetexImage *im = e->picture;
    const int dx = directions[e->direction][0], dy = directions[e->direction][1];
    (void)thread;
    for (int x = 0; x < im->width; x++) {
        float *to = e->products + PLANES * pixel_at(im, x, y);
        memset(to, 0, sizeof *to * PLANES);
        if (x < dx || x + dx >= im->width || y < abs(dy) || y + abs(dy) >= im->height)
            continue;
        const size_t p = pixel_at(im, x, y), a = pixel_at(im, x - dx, y - dy), b = pixel_at(im, x + dx, y + dy);
        if (!agree(e, p, a) || !agree(e, p, b))
            continue;
        for (size_t c = 0; c < 3; c++) {
            const float d = 2 * divided(e, p, c) - divided(e, a, c) - divided(e, b, c);
            to[c] = d * d / 6;
        }
        to[3] = 1;
    }
}

static void sum_row(void *context, int y, int thread)
{
    const Estimate *e = context;
    const int width = e->picture->width;
    (void)thread;
    for (int x = 0; x < width; x++) {
        float sums[PLANES] = {0};
        for (int k = x < RADIUS ? 0 : x - RADIUS; k <= x + RADIUS && k < width; k++)
            for (int c = 0; c < PLANES; c++)
                sums[c] += e->products[PLANES * pixel_at(e->picture, k, y) + (size_t)c];
        memcpy(e->rows + PLANES * pixel_at(e->picture, x, y), sums, sizeof sums);
    }
}

/* Keeps the smaller of this direction's variance and that of those before; below 0: there is none yet. */
static void keep_smaller(void *context, int y, int thread)
{
    const Estimate *e = context;
    const RetexImage *im = e->picture;
    (void)thread;
    for (int x = 0; x < im->width; x++) {
        float sums[PLANES] = {0};
        for (int k = y < RADIUS ? 0 : y - RADIUS; k <= y + RADIUS && k < im->height; k++)
            for (int c = 0; c < PLANES; c++)
                sums[c] += e->rows[PLANES * pixel_at(im, x, k) + (size_t)c];
        const size_t p = pixel_at(im, x, y);
        for (size_t c = 0; c < 3 && sums[3] >= LEAST_WEIGHT; c++) {
            float *to = &e->variance->pixels[3 * p + c];
            const float variance = sums[c] / sums[3];
            *to = *to < 0 || variance < *to ? variance : *to;
        }
    }
}

/* Of pixels with too few like ones around, the variance is not known, and so nothing there is filtered. */
static void finish_row(void *context, int y, int thread)
{
    const Estimate *e = context;
    (void)thread;
    for (int x = 0; x < e->picture->width; x++)
        for (size_t c = 0; c < 3; c++) {
            const size_t p = pixel_at(e->picture, x, y);
            float *to = &e->variance->pixels[3 * p + c];
            const float m = modulation(e, p, c);
            *to = *to < 0 ? 0 : *to * m * m / LEAST_OF_FOUR;
        }
}

int retex_picture_estimate_variance(RetexImage *variance, const RetexImage *picture, const RetexImage *normal,
                                    const RetexImage *albedo, int nthreads, RetexError *err)
{
    const size_t pixels = (size_t)picture->width * (size_t)picture->height;
    const int threads = retex_threads(nthreads);
    Estimate e = {.variance = variance, .picture = picture, .normal = normal, .albedo = albedo};
    int code = retex_image_alloc(variance, picture->width, picture->height, 3, err);
    e.products = malloc(sizeof(float) * PLANES * pixels);
    e.rows = malloc(sizeof(float) * PLANES * pixels);
    if (!code && (!e.products || !e.rows))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate a picture's noise");
    for (size_t i = 0; i < 3 * pixels && !code; i++)
        variance->pixels[i] = -1;
    for (; e.direction < 4 && !code; e.direction++) {
        retex_parallel(threads, picture->height, find_products, &e);
        retex_parallel(threads, picture->height, sum_row, &e);
        retex_parallel(threads, picture->height, keep_smaller, &e);
    }
    if (!code)
        retex_parallel(threads, picture->height, finish_row, &e);
    free(e.products);
    free(e.rows);
    return code;
}

/* ---- drawing ---- */

typedef struct Draw {
    RetexImage *variance;
    uint32_t seed;
} Draw;

/* A well mixed number from a count. */
static uint64_t mix(uint64_t n)
{
    n += 0x9e3779b97f4a7c15u;
    n = (n ^ (n >> 30)) * 0xbf58476d1ce4e5b9u;
    n = (n ^ (n >> 27)) * 0x94d049bb133111ebu;
    return n ^ (n >> 31);
}

/* A number of the normal distribution, by Box and Muller. */
static float normal_number(uint32_t seed, uint64_t pixel)
{
    const uint64_t bits = mix(mix(seed) + pixel);
    const double u = ((double)(bits >> 40) + 0.5) / 16777216, v = (double)(bits & 0xffffff) / 16777216;
    return (float)(sqrt(-2 * log(u)) * cos(6.283185307179586 * v));
}

static void draw_row(void *context, int y, int thread)
{
    const Draw *d = context;
    (void)thread;
    for (int x = 0; x < d->variance->width; x++) {
        const size_t p = pixel_at(d->variance, x, y);
        const float number = normal_number(d->seed, p);
        for (size_t c = 0; c < 3; c++) {
            float *value = &d->variance->pixels[3 * p + c];
            *value = *value > 0 ? number * sqrtf(*value) : 0;
        }
    }
}

void retex_picture_draw_noise(RetexImage *variance, uint32_t seed, int nthreads)
{
    Draw draw = {variance, seed};
    retex_parallel(retex_threads(nthreads), variance->height, draw_row, &draw);
}
