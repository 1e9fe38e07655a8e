/* LDR-FLIP: the difference that a person sees when two pictures alternate on a screen.
 *
 * Source: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild: 'FLIP: A Difference Evaluator for
 * Alternating Images', 2020. Each picture has two pipelines: colours, low-pass filtered as by the eye at that distance
 * (section 4.1.1), in Hunt-adjusted L*a*b* with the HyAB distance (4.1.2, 4.1.3); and edges and points (4.2). The
 * features increase the colour difference (4.3).
 *
 * All filters are sums of separable ones, so that one horizontal and one vertical pass suffice. The picture is
 * processed in strips of rows with a margin; a strip's result does not depend on the others. */
#include "metrics/flip.h"

#include <math.h>
#include <stdlib.h>

#include <retex/parallel.h>

enum { RADIUS = 10, TAPS = 2 * RADIUS + 1, STRIP = 32, ROWS = STRIP + 2 * RADIUS };

#define PIXELS_PER_DEGREE 67.0
#define FEATURE_WIDTH 0.082 /* degrees: of the edges and points the eye is most sensitive to */
#define COLOR_POWER 0.7f    /* q_c */
#define FEATURE_POWER 0.5f  /* q_f */
#define COLOR_KNEE 0.4f     /* p_c: below this share of the largest difference ... */
#define COLOR_KNEE_AT 0.95f /* p_t: ... values map to 0 .. p_t */

/* Horizontally filtered planes of a strip with margin; all but the last three serve the colour pipeline. */
enum { H_Y, H_CX, H_CZ1, H_CZ2, H_EDGE, H_POINT, H_SMOOTH, H_PLANES };
/* Planes that are compared, for a strip. */
enum { F_L, F_A, F_B, F_EDGE, F_POINT, F_PLANES };

typedef struct Filters {
    float y[TAPS], cx[TAPS], cz1[TAPS], cz2[TAPS]; /* contrast sensitivity; each sums to 1 */
    float cz1_share;                               /* weight of the first of the two blue-yellow Gaussians */
    float smooth[TAPS], edge[TAPS], point[TAPS];   /* Gaussian and its derivatives; +1 and -1 of positive, negative */
    float color_max;                               /* the largest colour difference, to the power q_c: green to blue */
} Filters;

typedef struct FlipJob {
    const RetexImage *image, *reference;
    RetexImage *map;
    Filters filters;
    float *scratch; /* per thread: padded rows, planes, features */
    size_t scratch_size;
} FlipJob;

/* --- colour --- */

static const float white[3] = {0.950428545f, 1.0f, 1.088900371f}; /* D65 */

static void xyz_from_rgb(float xyz[3], const float rgb[3])
{
    xyz[0] = 0.4123865f * rgb[0] + 0.3575915f * rgb[1] + 0.1804505f * rgb[2];
    xyz[1] = 0.2126368f * rgb[0] + 0.7151830f * rgb[1] + 0.0721802f * rgb[2];
    xyz[2] = 0.0193306f * rgb[0] + 0.1191972f * rgb[1] + 0.9503726f * rgb[2];
}

static void rgb_from_xyz(float rgb[3], const float xyz[3])
{
    rgb[0] = 3.2410032f * xyz[0] - 1.5373990f * xyz[1] - 0.4986159f * xyz[2];
    rgb[1] = -0.9692243f * xyz[0] + 1.8759300f * xyz[1] + 0.0415542f * xyz[2];
    rgb[2] = 0.0556394f * xyz[0] - 0.2040112f * xyz[1] + 1.0571490f * xyz[2];
}

/* The linear opponent space the contrast sensitivity is known in. */
static void ycxcz_from_rgb(float out[3], const float rgb[3])
{
    float xyz[3];
    xyz_from_rgb(xyz, rgb);
    for (int c = 0; c < 3; c++)
        xyz[c] /= white[c];
    out[0] = 116 * xyz[1] - 16;
    out[1] = 500 * (xyz[0] - xyz[1]);
    out[2] = 200 * (xyz[1] - xyz[2]);
}

static void rgb_from_ycxcz(float rgb[3], float y, float cx, float cz)
{
    float ny = (y + 16) / 116;
    float xyz[3] = {white[0] * (ny + cx / 500), white[1] * ny, white[2] * (ny - cz / 200)};
    rgb_from_xyz(rgb, xyz);
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    return t > delta * delta * delta ? cbrtf(t) : t / (3 * delta * delta) + 4.0f / 29;
}

/* L*a*b*, with a* and b* scaled by lightness: colours are more vivid in bright light (Hunt). */
static void hunt_lab_from_rgb(float lab[3], const float rgb[3])
{
    float xyz[3], f[3];
    xyz_from_rgb(xyz, rgb);
    for (int c = 0; c < 3; c++)
        f[c] = lab_curve(xyz[c] / white[c]);
    lab[0] = 116 * f[1] - 16;
    lab[1] = 0.01f * lab[0] * 500 * (f[0] - f[1]);
    lab[2] = 0.01f * lab[0] * 200 * (f[1] - f[2]);
}

static float hyab(float dl, float da, float db)
{
    return fabsf(dl) + sqrtf(da * da + db * db);
}

/* --- filters --- */

/* exp(-pi^2 x^2 / b), x in degrees, normalised; returns the sum before. */
static double csf_gaussian(float taps[TAPS], double b)
{
    double sum = 0, value[TAPS];
    for (int i = 0; i < TAPS; i++) {
        double x = (i - RADIUS) / PIXELS_PER_DEGREE;
        sum += value[i] = exp(-M_PI * M_PI * x * x / b);
    }
    for (int i = 0; i < TAPS; i++)
        taps[i] = (float)(value[i] / sum);
    return sum;
}

/* Scales so that positive values sum to 1 and negative ones to -1. */
static void balance(float taps[TAPS], const double value[TAPS])
{
    double positive = 0, negative = 0;
    for (int i = 0; i < TAPS; i++) {
        positive += fmax(value[i], 0);
        negative += fmax(-value[i], 0);
    }
    for (int i = 0; i < TAPS; i++)
        taps[i] = (float)(value[i] > 0 ? value[i] / positive : negative > 0 ? value[i] / negative : 0);
}

static void make_filters(Filters *f)
{
    /* Table 1 of the paper: a and b of the Gaussians; only blue-yellow has two. */
    csf_gaussian(f->y, 0.0047);
    csf_gaussian(f->cx, 0.0053);
    const double a1 = 34.1, b1 = 0.04, a2 = 13.5, b2 = 0.025;
    double s1 = csf_gaussian(f->cz1, b1), s2 = csf_gaussian(f->cz2, b2);
    double w1 = a1 * sqrt(M_PI / b1) * s1 * s1, w2 = a2 * sqrt(M_PI / b2) * s2 * s2;
    f->cz1_share = (float)(w1 / (w1 + w2));

    double deviation = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE, reach = ceil(3 * deviation);
    double smooth[TAPS], edge[TAPS], point[TAPS];
    for (int i = 0; i < TAPS; i++) {
        double x = i - RADIUS, g = fabs(x) <= reach ? exp(-x * x / (2 * deviation * deviation)) : 0;
        smooth[i] = g;
        edge[i] = -x * g;
        point[i] = (x * x / (deviation * deviation) - 1) * g;
    }
    balance(f->smooth, smooth);
    balance(f->edge, edge);
    balance(f->point, point);

    float green[3], blue[3];
    hunt_lab_from_rgb(green, (const float[3]){0, 1, 0});
    hunt_lab_from_rgb(blue, (const float[3]){0, 0, 1});
    f->color_max = powf(hyab(green[0] - blue[0], green[1] - blue[1], green[2] - blue[2]), COLOR_POWER);
}

/* dst[x] = sum of taps[k] * src[k * stride + x]: along a padded row with stride 1, down a plane with its width. */
static void convolve(float *restrict dst, const float *restrict src, size_t stride, const float taps[TAPS], int width)
{
    for (int x = 0; x < width; x++)
        dst[x] = 0;
    for (int k = 0; k < TAPS; k++)
        for (int x = 0; x < width; x++)
            dst[x] += taps[k] * src[(size_t)k * stride + (size_t)x];
}

/* --- one strip --- */

/* The row of a picture in YCxCz, three padded rows one after the other; edge pixels repeat outwards. Samples that are
 * not finite here or in `other` are 0. */
static void load_row(float *padded, const RetexImage *im, const RetexImage *other, int y)
{
    int width = im->width, length = width + 2 * RADIUS;
    const float *row = im->pixels + retex_image_index(im, 0, y), *twin = other->pixels + retex_image_index(other, 0, y);
    for (int x = 0; x < width; x++) {
        float rgb[3], out[3];
        for (int c = 0; c < 3; c++) {
            int finite = isfinite(row[3 * x + c]) && isfinite(twin[3 * x + c]);
            rgb[c] = finite ? fminf(fmaxf(row[3 * x + c], 0), 1) : 0;
        }
        ycxcz_from_rgb(out, rgb);
        for (int c = 0; c < 3; c++)
            padded[(size_t)c * (size_t)length + (size_t)(RADIUS + x)] = out[c];
    }
    for (int c = 0; c < 3; c++) {
        float *p = padded + (size_t)c * (size_t)length;
        for (int i = 0; i < RADIUS; i++) {
            p[i] = p[RADIUS];
            p[RADIUS + width + i] = p[RADIUS + width - 1];
        }
    }
}

/* Filter rows y0 - RADIUS .. y0 + rows + RADIUS horizontally into planes. */
static void filter_rows(float *planes, float *padded, const RetexImage *im, const RetexImage *other, const Filters *f,
                        int y0, int rows)
{
    static const struct {
        int from;
        size_t offset;
    } plan[H_PLANES] = {
        {0, offsetof(Filters, y)},      {1, offsetof(Filters, cx)},   {2, offsetof(Filters, cz1)},
        {2, offsetof(Filters, cz2)},    {0, offsetof(Filters, edge)}, {0, offsetof(Filters, point)},
        {0, offsetof(Filters, smooth)},
    };
    size_t width = (size_t)im->width, length = width + 2 * RADIUS;
    for (int r = 0; r < rows + 2 * RADIUS; r++) {
        int y = y0 - RADIUS + r;
        y = y < 0 ? 0 : y >= im->height ? im->height - 1 : y;
        load_row(padded, im, other, y);
        for (int p = 0; p < H_PLANES; p++) {
            const float *taps = (const float *)(const void *)((const char *)f + plan[p].offset);
            float *dst = planes + ((size_t)p * ROWS + (size_t)r) * width;
            convolve(dst, padded + (size_t)plan[p].from * length, 1, taps, im->width);
        }
    }
}

/* Vertical filters of row r of the strip, then colour and features. column: 5 rows of scratch. */
static void finish_row(float *features, const float *planes, float *column, const Filters *f, int r, int width)
{
    size_t w = (size_t)width;
#define PLANE(p) (planes + ((size_t)(p)*ROWS + (size_t)r) * w)
#define FEATURE(p) (features + ((size_t)(p)*STRIP + (size_t)r) * w)
    float *y = column, *cx = column + w, *cz1 = column + 2 * w, *cz2 = column + 3 * w;
    convolve(y, PLANE(H_Y), w, f->y, width);
    convolve(cx, PLANE(H_CX), w, f->cx, width);
    convolve(cz1, PLANE(H_CZ1), w, f->cz1, width);
    convolve(cz2, PLANE(H_CZ2), w, f->cz2, width);
    for (int x = 0; x < width; x++) {
        float rgb[3], lab[3];
        rgb_from_ycxcz(rgb, y[x], cx[x], f->cz1_share * cz1[x] + (1 - f->cz1_share) * cz2[x]);
        for (int c = 0; c < 3; c++)
            rgb[c] = fminf(fmaxf(rgb[c], 0), 1);
        hunt_lab_from_rgb(lab, rgb);
        FEATURE(F_L)[x] = lab[0];
        FEATURE(F_A)[x] = lab[1];
        FEATURE(F_B)[x] = lab[2];
    }
    float *across = column, *down = column + w;
    convolve(across, PLANE(H_EDGE), w, f->smooth, width);
    convolve(down, PLANE(H_SMOOTH), w, f->edge, width);
    for (int x = 0; x < width; x++)
        FEATURE(F_EDGE)[x] = sqrtf(across[x] * across[x] + down[x] * down[x]) / 116;
    convolve(across, PLANE(H_POINT), w, f->smooth, width);
    convolve(down, PLANE(H_SMOOTH), w, f->point, width);
    for (int x = 0; x < width; x++)
        FEATURE(F_POINT)[x] = sqrtf(across[x] * across[x] + down[x] * down[x]) / 116;
#undef PLANE
#undef FEATURE
}

static float pixel_error(const float a[F_PLANES], const float b[F_PLANES], float color_max)
{
    float color = powf(hyab(a[F_L] - b[F_L], a[F_A] - b[F_A], a[F_B] - b[F_B]), COLOR_POWER);
    float knee = COLOR_KNEE * color_max;
    color = color < knee ? color * COLOR_KNEE_AT / knee
                         : COLOR_KNEE_AT + (color - knee) / (color_max - knee) * (1 - COLOR_KNEE_AT);
    float feature = fmaxf(fabsf(a[F_EDGE] - b[F_EDGE]), fabsf(a[F_POINT] - b[F_POINT]));
    feature = powf(feature * (float)M_SQRT1_2, FEATURE_POWER);
    return fminf(powf(fminf(color, 1), fmaxf(1 - feature, 0)), 1);
}

static void flip_strip(void *context, int index, int thread)
{
    FlipJob *job = context;
    const RetexImage *pictures[2] = {job->image, job->reference};
    size_t width = (size_t)job->map->width;
    int y0 = index * STRIP, rows = job->map->height - y0 < STRIP ? job->map->height - y0 : STRIP;
    float *padded = job->scratch + (size_t)thread * job->scratch_size;
    float *planes = padded + 3 * (width + 2 * RADIUS), *column = planes + H_PLANES * ROWS * width;
    float *features[2] = {column + 4 * width, column + (4 + F_PLANES * STRIP) * width};

    for (int i = 0; i < 2; i++) {
        filter_rows(planes, padded, pictures[i], pictures[1 - i], &job->filters, y0, rows);
        for (int r = 0; r < rows; r++)
            finish_row(features[i], planes, column, &job->filters, r, (int)width);
    }
    for (int r = 0; r < rows; r++)
        for (size_t x = 0; x < width; x++) {
            float a[F_PLANES], b[F_PLANES];
            for (size_t p = 0; p < F_PLANES; p++) {
                a[p] = features[0][(p * STRIP + (size_t)r) * width + x];
                b[p] = features[1][(p * STRIP + (size_t)r) * width + x];
            }
            job->map->pixels[(size_t)(y0 + r) * width + x] = pixel_error(a, b, job->filters.color_max);
        }
}

int retex_flip_map(RetexImage *map, const RetexImage *image, const RetexImage *reference, int nthreads, RetexError *err)
{
    if (image->channels != 3 || reference->channels != 3 || image->width != reference->width ||
        image->height != reference->height)
        return retex_fail(err, RETEX_EINVAL, "FLIP compares two pictures of one size with 3 channels");
    int code = retex_image_alloc(map, image->width, image->height, 1, err);
    if (code)
        return code;
    size_t width = (size_t)image->width;
    FlipJob job = {.image = image, .reference = reference, .map = map};
    job.scratch_size = 3 * (width + 2 * RADIUS) + (H_PLANES * ROWS + 4 + 2 * F_PLANES * STRIP) * width;
    job.scratch = malloc((size_t)retex_threads(nthreads) * job.scratch_size * sizeof(float));
    if (!job.scratch) {
        retex_image_free(map);
        return retex_fail(err, RETEX_ENOMEM, "no memory for FLIP of %d x %d pixels", image->width, image->height);
    }
    make_filters(&job.filters);
    retex_parallel(nthreads, (image->height + STRIP - 1) / STRIP, flip_strip, &job);
    free(job.scratch);
    return 0;
}
