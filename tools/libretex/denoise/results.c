/* See results.h. */
#include "denoise/results.h"

#include <stdlib.h>

#include "denoise/footprints.h"
#include "denoise/passed.h"
#include "denoise/totals.h"

#define LEAST_WEIGHT 0.02f /* weight below which a neighbour is not pooled */

/* A pixel of the tile. */
typedef struct TilePixel {
    int x, y; /* in the picture */
    size_t i; /* index in sums */
} TilePixel;

/* A row of the tile's results. */
typedef struct TileRow {
    int x, y, count; /* in the picture */
    size_t p, i;     /* indices of its first pixel in planes and in sums */
} TileRow;
typedef float RowValues[DENOISE_TILE];

/* The filtered totals of one channel, of which passed receives both halves. */
static void filtered_totals(RowValues totals, const RetexTileSignal *r, const TileRow *row, int c, float *passed)
{
    RowValues sum = {0};
    for (int h = 0; h < 2; h++) {
        RowValues half = {0};
        for (int k = 0; k < CHOICES; k++) {
            const float *restrict value = k ? r->candidates[k - 1].sum[h][c] + row->i : r->half[h][c] + row->p,
                                  *restrict chosen = r->chosen[k] + row->i;
            for (int x = 0; x < row->count; x++)
                half[x] += chosen[x] * value[x];
        }
        for (int x = 0; x < row->count; x++) {
            passed[DENOISE_PASSED * x + DENOISE_PASSED_HALVES + 3 * h + c] = half[x];
            sum[x] += half[x];
        }
    }
    const float *restrict modulation = r->modulation[c] + row->p;
    for (int x = 0; x < row->count; x++) {
        const float total = 0.5f * modulation[x] * sum[x];
        passed[DENOISE_PASSED * x + DENOISE_PASSED_TOTAL + c] = totals[x] = total > 0 ? total : 0;
    }
}

/* The totals of the members filtered with the first candidate's weights. */
static void totals_of_members(RowValues totals, const RetexTileSignal *r, const RetexSignal *signal, const TileRow *row,
                              int c)
{
    int image = r->nclusters > 0;
    for (int x = 0; x < row->count; x++)
        totals[x] = r->nclusters ? r->sums[c][row->i + (size_t)x] : 0;
    for (int k = 0; k < signal->nmembers; k++) {
        if (signal->members[k].cluster >= 0)
            continue;
        const float *restrict sum = r->sums[3 * image++ + c] + row->i, weight = signal->members[k].bright;
        for (int x = 0; x < row->count; x++)
            totals[x] += weight * sum[x];
    }
}

/* The share of an image in the filtered totals: members keep the proportions that the first candidate's weights give.
 * Where these are all 0, or for a single image, which is not filtered, the first image takes all. */
static void image_values(RowValues values, const RetexTileSignal *r, const TileRow *row, int image, int c,
                         const RowValues total, const RowValues members, float weight)
{
    const float *restrict sum = r->sums[3 * image + c] + row->i;
    for (int x = 0; x < row->count; x++) {
        const float share = sum[x] / members[x]; /* both may be so small that only their quotient is a normal number */
        values[x] = members[x] > 0 ? total[x] * share : image ? 0 : total[x] / weight;
    }
}

/* A correction, which may have either sign, with the first candidate's weights. */
static void correction_values(RowValues values, const RetexTileSignal *r, const TileRow *row, int image, int c)
{
    const RetexDenoiseSums *s = &r->candidates[0];
    for (int x = 0; x < row->count; x++) {
        const size_t i = row->i + (size_t)x;
        const float norm = 0.5f * (s->norm[0][i] + s->norm[1][i]);
        values[x] = norm > 0 ? r->mean_modulation[row->p + (size_t)x] * (r->sums[3 * image + c][i] / norm) : 0;
    }
}

/* Steps to each side at which neighbours lie within the window. */
static int neighbour_reach(const RetexDenoiser *d)
{
    int reach = d->params.radius / NEIGHBOUR_STEP;
    return reach > NEIGHBOUR_REACH ? NEIGHBOUR_REACH : reach;
}

int retex_tile_neighbour(const RetexDenoiser *d, int dx, int dy)
{
    int reach = neighbour_reach(d);
    if (dx % NEIGHBOUR_STEP || dy % NEIGHBOUR_STEP || abs(dx) > reach * NEIGHBOUR_STEP ||
        abs(dy) > reach * NEIGHBOUR_STEP)
        return -1;
    return (dy / NEIGHBOUR_STEP + reach) * (2 * reach + 1) + dx / NEIGHBOUR_STEP + reach;
}

static int find_neighbours(RetexNeighbour *out, const RetexDenoiser *d, const float *const *weights,
                           const TilePixel *at)
{
    int count = 1, number = 0, reach = neighbour_reach(d);
    out[0] = (RetexNeighbour){at->x, at->y, 1};
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++, number++) {
            const float weight = weights[number] ? weights[number][at->i] : 0;
            if ((dx || dy) && weight > LEAST_WEIGHT)
                out[count++] = (RetexNeighbour){at->x + NEIGHBOUR_STEP * dx, at->y + NEIGHBOUR_STEP * dy, weight};
        }
    return count;
}

/* Puts in what another denoiser made of the totals. */
static void mix_totals(RowValues total[3], const RetexDenoiser *d, int signal, const TileRow *row)
{
    for (int x = 0; x < row->count && d->totals; x++) {
        float color[3] = {total[0][x], total[1][x], total[2][x]};
        retex_denoise_mix_total(color, d, signal, row->x + x, row->y);
        for (int c = 0; c < 3; c++)
            total[c][x] = color[c];
    }
}

static void add_row_sums(RetexSignalSums *sums, const RetexTileSignal *r, const TileRow *row, int c)
{
    for (size_t p = row->p; p < row->p + (size_t)row->count; p++) {
        const float light = r->modulation[c][p] * (0.5f * (r->half[0][c][p] + r->half[1][c][p])),
                    noise = r->modulation[c][p] * (0.5f * (r->half[0][c][p] - r->half[1][c][p]));
        sums->before[c] += light;
        sums->lost[c] += r->modulation[c][p] * r->lost[c][p];
        sums->variance[c] += (double)noise * noise;
        sums->lit += c == 1 && light > 0;
    }
}

/* Distributes light to the clusters of a signal. */
static void share_row(const RetexTileSignal *r, const RetexDenoiser *d, const RetexSignal *signal, const TileRow *row,
                      RowValues light[3], RetexDenoisedRows *out)
{
    RetexNeighbour neighbours[NEIGHBOURS_MAX];
    for (int x = 0; x < row->count; x++) {
        const TilePixel at = {row->x + x, row->y, row->i + (size_t)x};
        const float color[3] = {light[0][x], light[1][x], light[2][x]};
        neighbours[0] = (RetexNeighbour){at.x, at.y, 1};
        const int count = r->is_empty ? 1 : find_neighbours(neighbours, d, (const float *const *)r->neighbours, &at);
        retex_denoise_share_light(d->footprints, d, signal, at.x, at.y, neighbours, count, color, out);
    }
}

static void finish_row(const RetexTileSignal *r, const RetexDenoiser *d, const RetexSignal *signal, const TileRow *row,
                       RetexDenoisedRows *out, RetexSignalSums *sums)
{
    const int number = (int)(signal - d->signals.of);
    RowValues total[3], members[3], values[3];
    for (int c = 0; c < 3; c++)
        filtered_totals(total[c], r, row, c, retex_denoise_passed_at(d->passed, d, number, row->x, row->y));
    mix_totals(total, d, number, row);
    for (int c = 0; c < 3; c++) {
        totals_of_members(members[c], r, signal, row, c);
        add_row_sums(sums, r, row, c);
    }
    for (int k = 0, image = r->nclusters > 0; k < signal->nmembers; k++) {
        const RetexSignalMember *m = &signal->members[k];
        if (m->cluster >= 0)
            continue;
        float *to = out->parts[m->part] + 3 * ((size_t)(row->y - out->first) * (size_t)d->set->width + (size_t)row->x);
        for (int c = 0; c < 3; c++) {
            if (m->corrects)
                correction_values(values[c], r, row, image, c);
            else
                image_values(values[c], r, row, image, c, total[c], members[c], m->bright);
        }
        for (int x = 0; x < row->count; x++)
            for (int c = 0; c < 3; c++)
                to[3 * x + c] = values[c][x];
        image++;
    }
    for (int c = 0; c < 3 && r->nclusters; c++)
        image_values(values[c], r, row, 0, c, total[c], members[c], 1);
    if (r->nclusters)
        share_row(r, d, signal, row, values, out);
}

/* Row y of the tile's results, which begin at column `left` of the picture. */
static TileRow row_of(const RetexDenoiser *d, const RetexDenoisedRows *out, int left, int y)
{
    const int end = left + DENOISE_STEP < d->roi.x1 ? left + DENOISE_STEP : d->roi.x1, v = y + DENOISE_MARGIN;
    return (TileRow){left, out->first + y, end - left, denoise_at(DENOISE_MARGIN, v),
                     (size_t)v * DENOISE_TILE + DENOISE_MARGIN};
}

void retex_tile_finish(const RetexTileSignal *r, const RetexDenoiser *d, const RetexSignal *signal, int left,
                       RetexDenoisedRows *out, RetexSignalSums *sums)
{
    for (int y = 0; y < out->rows; y++) {
        const TileRow row = row_of(d, out, left, y);
        finish_row(r, d, signal, &row, out, sums);
    }
}

void retex_tile_pool(const RetexDenoiser *d, const float *const alike[NEIGHBOURS_MAX], int left, RetexDenoisedRows *out)
{
    RetexNeighbour neighbours[NEIGHBOURS_MAX];
    for (int y = 0; y < out->rows; y++) {
        const TileRow row = row_of(d, out, left, y);
        for (int x = 0; x < row.count; x++) {
            const TilePixel at = {row.x + x, row.y, row.i + (size_t)x};
            const int count = find_neighbours(neighbours, d, alike, &at);
            retex_denoise_share_later(d->footprints, d, at.x, at.y, neighbours, count, out);
        }
    }
}
