/* The difference of two pictures: PSNR, relMSE, mean and largest errors, FLIP. See <retex/metrics.h>. Each row is
 * summed separately, and rows are added in order, so that the figures are the same for every number of threads. */
#include <retex/metrics.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>
#include <retex/parallel.h>

#include "metrics/flip.h"

#define PSNR_MAX 120.0
#define RELMSE_EPSILON 0.01
#define REL_FLOOR 1e-3

typedef struct RowSums {
    double square_encoded, relative_square, absolute, max_abs, max_rel;
    long counted, nonfinite;
    int worst; /* index of the sample where max_abs is */
} RowSums;

typedef struct MetricsJob {
    const RetexImage *image, *reference;
    RowSums *rows;
} MetricsJob;

static double srgb_encode_clipped(double v)
{
    return retex_srgb_encode(v < 0 ? 0 : v > 1 ? 1 : v);
}

static void sum_row(void *context, int y, int thread)
{
    (void)thread;
    MetricsJob *job = context;
    const float *a = job->image->pixels + retex_image_index(job->image, 0, y);
    const float *b = job->reference->pixels + retex_image_index(job->reference, 0, y);
    RowSums s = {0};
    for (int i = 0; i < 3 * job->image->width; i++) {
        if (!isfinite(a[i]) || !isfinite(b[i])) {
            s.nonfinite++;
            continue;
        }
        double difference = fabs((double)a[i] - (double)b[i]);
        s.counted++;
        if (difference == 0)
            continue;
        double encoded = srgb_encode_clipped(a[i]) - srgb_encode_clipped(b[i]);
        s.square_encoded += encoded * encoded;
        s.relative_square += difference * difference / ((double)b[i] * b[i] + RELMSE_EPSILON);
        s.absolute += difference;
        s.max_rel = fmax(s.max_rel, difference / fmax(fabs((double)b[i]), REL_FLOOR));
        if (difference > s.max_abs) {
            s.max_abs = difference;
            s.worst = i;
        }
    }
    job->rows[y] = s;
}

static void add_rows(RetexMetrics *m, const RowSums *rows, int height)
{
    double square = 0, relative = 0, absolute = 0;
    long counted = 0;
    m->worst.channel = 'R';
    for (int y = 0; y < height; y++) {
        const RowSums *s = &rows[y];
        square += s->square_encoded;
        relative += s->relative_square;
        absolute += s->absolute;
        counted += s->counted;
        m->nonfinite += s->nonfinite;
        m->max_rel = fmax(m->max_rel, s->max_rel);
        if (s->max_abs > m->max_abs) {
            m->max_abs = s->max_abs;
            m->worst.x = s->worst / 3;
            m->worst.y = y;
            m->worst.channel = "RGB"[s->worst % 3];
        }
    }
    double n = counted > 0 ? (double)counted : 1;
    m->psnr = square > 0 ? fmin(PSNR_MAX, -10 * log10(square / n)) : PSNR_MAX;
    m->relmse = relative / n;
    m->mae = absolute / n;
}

/* Mean and 99th percentile: the smallest value (to 1/65536) that 99% of the pixels do not exceed. */
static int summarise_flip(RetexMetrics *m, const RetexImage *map, RetexError *err)
{
    enum { BINS = 65537 };
    size_t n = (size_t)map->width * (size_t)map->height, *bins = calloc(BINS, sizeof *bins);
    if (!bins)
        return retex_fail(err, RETEX_ENOMEM, "no memory for FLIP's percentile");
    double sum = 0;
    for (size_t i = 0; i < n; i++) {
        sum += (double)map->pixels[i];
        bins[(size_t)ceil((double)map->pixels[i] * (BINS - 1))]++;
    }
    m->flip_mean = sum / (double)n;
    size_t below = 0, bin = 0;
    for (; bin < BINS - 1; bin++) {
        below += bins[bin];
        if ((double)below >= 0.99 * (double)n)
            break;
    }
    m->flip_p99 = (double)bin / (BINS - 1);
    free(bins);
    return 0;
}

int retex_metrics(RetexMetrics *metrics, const RetexImage *image, const RetexImage *reference, int nthreads,
                  RetexError *err)
{
    if (image->width < 1 || image->height < 1 || image->channels != 3 || reference->channels != 3)
        return retex_fail(err, RETEX_EINVAL, "metrics compare pictures of 3 channels");
    if (image->width != reference->width || image->height != reference->height)
        return retex_fail(err, RETEX_EINVAL, "the pictures' sizes differ: %d x %d and %d x %d", image->width,
                          image->height, reference->width, reference->height);
    MetricsJob job = {image, reference, calloc((size_t)image->height, sizeof(RowSums))};
    if (!job.rows)
        return retex_fail(err, RETEX_ENOMEM, "no memory to compare pictures");
    RetexImage map = {0};
    int code = retex_flip_map(&map, image, reference, nthreads, err);
    if (!code) {
        memset(metrics, 0, sizeof *metrics);
        retex_parallel(nthreads, image->height, sum_row, &job);
        add_rows(metrics, job.rows, image->height);
        code = summarise_flip(metrics, &map, err);
    }
    retex_image_free(&map);
    free(job.rows);
    return code;
}
