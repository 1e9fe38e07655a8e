/* Least-squares fit of prediction weights. See fit.h. */
#include "pack/fit.h"

#include <math.h>
#include <string.h>

void retex_pack_fit_begin_row(RetexPackFitChannel *channel, int y)
{
    const ptrdiff_t first = retex_pack_fit_place(channel, 0, y), above = retex_pack_fit_above(channel, first, y);
    for (int i = 1; i <= RETEX_PACK_FIT_LEFT; i++) {
        channel->numbers[first - i] = y > 0 ? channel->numbers[above] : channel->mean;
        channel->sizes[first - i] = y > 0 ? channel->sizes[above] : 0;
        channel->holes[first - i] = y > 0 ? channel->holes[above] : 0;
    }
    if (y > 0) { /* the margin to the right of the row above */
        const ptrdiff_t end = above + channel->width;
        channel->numbers[end] = channel->numbers[end - 1];
        channel->sizes[end] = channel->sizes[end - 1];
        channel->holes[end] = channel->holes[end - 1];
    }
}

/* The normal equations: weighted sums of products of terms. The last row has the products with the target. */
typedef struct Normal {
    double sum[RETEX_PACK_FIT_WEIGHTS + 1][RETEX_PACK_FIT_WEIGHTS + 1];
} Normal;

static void add_products(Normal *normal, const double *terms, int count, double weight)
{
    for (int i = 0; i < count; i++) {
        const double scaled = terms[i] * weight;
        for (int j = 0; j <= i; j++)
            normal->sum[i][j] += scaled * terms[j];
    }
}

/* Gaussian elimination without pivoting: the matrix is positive semidefinite. A small ridge on the diagonal gives
 * undetermined terms weights near 0. */
static void solve(double *solution, Normal *normal, int count)
{
    double(*a)[RETEX_PACK_FIT_WEIGHTS + 1] = normal->sum;
    double right[RETEX_PACK_FIT_WEIGHTS];
    for (int i = 0; i < count; i++) {
        right[i] = a[count][i];
        for (int j = 0; j < i; j++)
            a[j][i] = a[i][j];
    }
    for (int i = 0; i < count; i++) {
        a[i][i] += a[i][i] * 1e-7 + 1e-9;
        for (int k = i + 1; k < count; k++) {
            const double factor = a[k][i] / a[i][i];
            for (int j = i; j < count; j++)
                a[k][j] -= factor * a[i][j];
            right[k] -= factor * right[i];
        }
    }
    for (int i = count; i-- > 0;) {
        solution[i] = right[i];
        for (int j = i + 1; j < count; j++)
            solution[i] -= a[i][j] * solution[j];
        solution[i] /= a[i][i];
    }
}

static double step_of(const unsigned char *shifts, const RetexPackFitChannel *channel, int x, int y)
{
    return shifts ? (double)(INT64_C(1) << shifts[(size_t)y * (size_t)channel->width + (size_t)x]) : 1;
}

/* Distance between the rows used for fitting: some tens of thousands of numbers are enough. */
static int row_stride(const RetexPackFitChannel *channel)
{
    enum { ENOUGH = 30000 };
    const int stride = (int)((int64_t)channel->width * channel->rows / ENOUGH);
    return stride < 1 ? 1 : stride;
}

/* One round of iteratively reweighted least squares. robust: weight each number by 1 / (1 + its residual with the
 * current weights), so that outliers count less. */
static void fit_round(RetexPackFitChannel *channel, const unsigned char *shifts, int robust)
{
    const int count = channel->nweights;
    Normal normal = {0};
    for (int y = 0; y < channel->rows; y += row_stride(channel))
        for (int x = 0; x < channel->width; x++) {
            const ptrdiff_t at = retex_pack_fit_place(channel, x, y), above = retex_pack_fit_above(channel, at, y);
            int64_t terms[RETEX_PACK_FIT_WEIGHTS];
            double scaled[RETEX_PACK_FIT_WEIGHTS + 1];
            if (channel->holes[at])
                continue;
            const double step = step_of(shifts, channel, x, y), scale = 1 / step;
            retex_pack_fit_terms(terms, channel, at, above, count);
            for (int i = 0; i < count; i++)
                scaled[i] = (double)terms[i] * scale;
            scaled[count] = ((double)channel->numbers[at] - channel->numbers[at - 1]) * scale;
            double weight = 1;
            if (robust)
                weight =
                    1 / (1 + fabs((double)(channel->numbers[at] - retex_pack_fit_guess(channel, at, above))) * scale);
            add_products(&normal, scaled, count + 1, weight);
        }
    double weights[RETEX_PACK_FIT_WEIGHTS];
    solve(weights, &normal, count);
    for (int i = 0; i < count; i++) {
        const double weight = rint(weights[i] * (1 << RETEX_PACK_FIT_SHIFT));
        channel->weights[i] = (int16_t)(isfinite(weight) ? fmin(fmax(weight, INT16_MIN), INT16_MAX) : 0);
    }
}

/* Estimate the bits of all residuals. */
static double cost(const RetexPackFitChannel *channel, const unsigned char *shifts)
{
    double bits = 0;
    for (int y = 0; y < channel->rows; y += row_stride(channel))
        for (int x = 0; x < channel->width; x++) {
            const ptrdiff_t at = retex_pack_fit_place(channel, x, y), above = retex_pack_fit_above(channel, at, y);
            if (!channel->holes[at])
                bits += log2(1 + fabs((double)(channel->numbers[at] - retex_pack_fit_guess(channel, at, above))) /
                                     step_of(shifts, channel, x, y));
        }
    return bits;
}

void retex_pack_fit(RetexPackFitChannel *channel, const unsigned char *shifts)
{
    for (int y = 0; y < channel->rows; y++)
        retex_pack_fit_begin_row(channel, y);
    channel->by_fit = 0;
    const double plain = cost(channel, shifts);
    channel->by_fit = 1;
    fit_round(channel, shifts, 0);
    fit_round(channel, shifts, 1);
    channel->by_fit = cost(channel, shifts) < plain;
}
