/* Smaller sets: see <retex/reduce.h>. plan.h says what becomes of each part, block.h makes single pixels. */
#include <retex/reduce.h>

#include <math.h>
#include <stdlib.h>

#include <retex/parallel.h>

#include "base/jobs.h"
#include "reduce/block.h"
#include "set/laid.h"
#include "set/parts.h"
#include "set/set.h"
#include "set/strip.h"

#define STRIP_ROWS 48 /* a multiple of all scales */

typedef struct Reduction {
    const RetexSet *set;
    RetexReducePlan plan;
    int scale;
    const RetexSet *rows;
    int first; /* the picture's row of the first of rows */
    RetexReduceScratch **scratch;
} Reduction;

static void reduce_row(void *context, int by, int thread)
{
    const Reduction *r = context;
    const int width = r->plan.reduced->width, y = by * r->scale;
    for (int bx = 0; bx < width; bx++) {
        const int x = bx * r->scale, right = r->rows->width - x, below = r->rows->height - y;
        const RetexReduceBlock block = {
            .plan = &r->plan,
            .rows = r->rows,
            .x = x,
            .y = y,
            .width = right < r->scale ? right : r->scale,
            .height = below < r->scale ? below : r->scale,
            .to = (size_t)(r->first / r->scale + by) * (size_t)width + (size_t)bx,
        };
        retex_reduce_block(&block, r->scratch[thread]);
    }
}

/* The set as strips see it: they load no parts that are not wanted, as those have no size. */
static int hide_parts(RetexSet *seen, const RetexSet *set, const RetexReducePlan *plan, RetexError *err)
{
    *seen = *set;
    seen->parts = malloc(((size_t)set->nparts + 1) * sizeof *seen->parts);
    if (!seen->parts)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to reduce a set");
    for (int i = 0; i < set->nparts; i++) {
        seen->parts[i] = set->parts[i];
        if (plan->rules[i] == RETEX_REDUCE_DROPPED || plan->rules[i] == RETEX_REDUCE_ORIGINAL)
            seen->parts[i].image.width = 0;
    }
    return RETEX_OK;
}

static int reduce_strips(Reduction *r, int nthreads, RetexError *err)
{
    const int height = r->set->height;
    RetexSet seen, *rows;
    RetexSetStrip *strip = NULL;
    int code = hide_parts(&seen, r->set, &r->plan, err);
    if (!code)
        code = retex_set_strip_open(&strip, &seen, STRIP_ROWS, 0, err);
    for (r->first = 0; r->first < height && !code; r->first += STRIP_ROWS) {
        const int count = height - r->first < STRIP_ROWS ? height - r->first : STRIP_ROWS;
        code = retex_set_strip_load(&rows, strip, r->first, count, nthreads, err);
        r->rows = rows;
        if (!code)
            retex_parallel(nthreads, (count + r->scale - 1) / r->scale, reduce_row, r);
    }
    retex_set_strip_close(&strip);
    free(seen.parts);
    return code;
}

/* ---- originals ---- */

/* The mean over an interval of a line of `count` values, `stride` apart. */
static double mean_between(const float *line, size_t stride, double begin, double end, int count)
{
    double sum = 0;
    for (int i = (int)begin; i < count && i < end; i++)
        sum += (fmin(i + 1, end) - fmax(i, begin)) * (double)line[(size_t)i * stride];
    return sum / (end - begin);
}

/* Make an image smaller: each pixel is the mean over what it covers. */
static int shrink(RetexImage *to, const RetexImage *from, RetexError *err)
{
    const size_t channels = (size_t)from->channels;
    const double right = (double)from->width / to->width, down = (double)from->height / to->height;
    RetexImage wide = {0};
    int code = retex_image_alloc(&wide, to->width, from->height, from->channels, err);
    for (int y = 0; y < from->height && !code; y++)
        for (int x = 0; x < to->width; x++)
            for (size_t c = 0; c < channels; c++)
                wide.pixels[retex_image_index(&wide, x, y) + c] =
                    (float)mean_between(from->pixels + retex_image_index(from, 0, y) + c, channels, x * right,
                                        (x + 1) * right, from->width);
    for (int y = 0; y < to->height && !code; y++)
        for (size_t i = 0; i < channels * (size_t)to->width; i++)
            to->pixels[retex_image_index(to, 0, y) + i] = (float)mean_between(
                wide.pixels + i, channels * (size_t)to->width, y * down, (y + 1) * down, from->height);
    retex_image_free(&wide);
    return code;
}

static int reduce_original(void *context, int part, int thread, RetexError *err)
{
    const Reduction *r = context;
    const RetexImage *size = &r->set->parts[part].image;
    RetexImage whole = {0};
    (void)thread;
    if (r->plan.rules[part] != RETEX_REDUCE_ORIGINAL)
        return RETEX_OK;
    int code = retex_image_alloc(&whole, size->width, size->height, size->channels, err);
    if (!code)
        code = retex_set_part_rows(&whole, r->set, part, 0, err);
    if (!code)
        code = shrink(&r->plan.reduced->parts[r->plan.to[part]].image, &whole, err);
    retex_image_free(&whole);
    return code;
}

/* ---- all of it ---- */

static int make_scratch(Reduction *r, int nthreads, RetexError *err)
{
    r->scratch = calloc((size_t)nthreads, sizeof(RetexReduceScratch *));
    for (int i = 0; i < nthreads; i++)
        if (!r->scratch || !(r->scratch[i] = retex_reduce_scratch_create()))
            return retex_fail(err, RETEX_ENOMEM, "not enough memory to reduce a set");
    return RETEX_OK;
}

int retex_set_reduce(RetexSet **reduced, const RetexSet *set, int scale, int nthreads, RetexError *err)
{
    Reduction r = {.set = set, .scale = scale};
    const int threads = retex_threads(nthreads);
    *reduced = NULL;
    if (scale < 2 || scale > RETEX_REDUCE_SIDE || STRIP_ROWS % scale)
        return retex_fail(err, RETEX_EINVAL, "a set is reduced by 2, 3, 4, 6 or 8, not by %d", scale);
    int code = retex_set_check_bare(set, "a smaller set", err);
    if (!code)
        code = retex_reduce_plan_open(&r.plan, set, scale, err);
    if (!code)
        code = make_scratch(&r, threads, err);
    if (!code)
        code = reduce_strips(&r, threads, err);
    if (!code)
        code = retex_jobs_run(threads, set->nparts, reduce_original, &r, err);
    if (!code) {
        retex_set_round_to_types(r.plan.reduced, threads);
        *reduced = r.plan.reduced;
    } else {
        retex_set_close(&r.plan.reduced);
    }
    for (int i = 0; i < threads && r.scratch; i++)
        free(r.scratch[i]);
    free(r.scratch);
    retex_reduce_plan_close(&r.plan);
    return code;
}
