/* See shrink.h. A pixel i of n that share a length covers i * length / n to (i + 1) * length / n; the picture's pixels
 * at both ends count by the part of them that is covered. */
#include "shrink.h"

#include <string.h>

#include <retex/parallel.h>

/* The pixels that pixel i of n covers of a length: first to last, all in full but for these two. */
typedef struct Cover {
    int first, last;
    float first_share, last_share; /* of one pixel; that of last is 0 where it is first */
    float scale;                   /* 1 / pixels covered */
} Cover;

static Cover cover_of(int i, int n, int length)
{
    /* in units of 1/n pixel */
    const int64_t begin = (int64_t)i * length, end = begin + length;
    Cover cover = {(int)(begin / n), (int)((end - 1) / n), 0, 0, (float)n / (float)length};
    const int64_t first_end = (int64_t)(cover.first + 1) * n;
    cover.first_share = (float)((end < first_end ? end : first_end) - begin) / (float)n;
    if (cover.last > cover.first)
        cover.last_share = (float)(end - (int64_t)cover.last * n) / (float)n;
    return cover;
}

void shrink_row(float *out, int width, const float *row, int x0, int x1)
{
    row += 3 * (size_t)x0;
    if (width == x1 - x0) {
        memcpy(out, row, 3 * sizeof *out * (size_t)width);
        return;
    }
    for (int i = 0; i < width; i++, out += 3) {
        const Cover cover = cover_of(i, width, x1 - x0);
        const float *first = row + 3 * (size_t)cover.first, *last = row + 3 * (size_t)cover.last;
        float sum[3];
        for (int c = 0; c < 3; c++)
            sum[c] = cover.first_share * first[c] + cover.last_share * last[c];
        for (const float *p = first + 3; p < last; p += 3)
            for (int c = 0; c < 3; c++)
                sum[c] += p[c];
        for (int c = 0; c < 3; c++)
            out[c] = cover.scale * sum[c];
    }
}

typedef struct Work {
    RetexImage *dst;
    const RetexImage *src;
} Work;

static void add_row(float *restrict sum, const float *restrict row, float share, size_t count)
{
    for (size_t i = 0; i < count; i++)
        sum[i] += share * row[i];
}

static void shrink_job(void *context, int y, int thread)
{
    const Work *work = context;
    const RetexImage *src = work->src;
    const size_t count = (size_t)src->width * (size_t)src->channels;
    const Cover cover = cover_of(y, work->dst->height, src->height);
    float *out = work->dst->pixels + retex_image_index(work->dst, 0, y);
    (void)thread;
    memset(out, 0, count * sizeof *out);
    add_row(out, src->pixels + retex_image_index(src, 0, cover.first), cover.scale * cover.first_share, count);
    for (int from = cover.first + 1; from < cover.last; from++)
        add_row(out, src->pixels + retex_image_index(src, 0, from), cover.scale, count);
    if (cover.last > cover.first)
        add_row(out, src->pixels + retex_image_index(src, 0, cover.last), cover.scale * cover.last_share, count);
}

void shrink_rows(RetexImage *dst, const RetexImage *src, int nthreads)
{
    Work work = {dst, src};
    retex_parallel(nthreads, dst->height, shrink_job, &work);
}
