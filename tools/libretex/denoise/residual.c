/* See residual.h. */
#include "denoise/residual.h"

#include <math.h>
#include <string.h>

#include "set/set.h"

enum {
    NEIGHBOURS = 4, /* pixels to each side over which the variance is averaged, in the row */
    PIXELS = 64     /* of a row, computed together */
};

static float *light_at(const RetexDenoiser *d, const RetexSignalMember *member, int x, int y)
{
    RetexImage *im = &d->set->parts[member->part].image;
    return im->pixels + retex_image_index(im, x, y);
}

/* Pixels of a row, from x on. */
typedef struct Span {
    int x, y, count;
} Span;

/* A signal in a span. */
typedef struct Totals {
    const RetexSignal *signal;
    double of[3 * PIXELS];    /* by pixel and channel */
    double variances[PIXELS]; /* of a lamp's light of value 1 */
} Totals;

/* What one lamp adds to a signal of all light, in one pixel and channel. */
typedef struct Product {
    const Totals *lamp;
    double kept;     /* the lamp's value in all light, above 0 */
    double value;    /* of the product */
    double variance; /* up to a factor that all have */
} Product;

static void find_totals(Totals *totals, const RetexDenoiser *d, const Span *at)
{
    double *restrict to = totals->of;
    memset(to, 0, sizeof totals->of);
    for (int k = 0; k < totals->signal->nmembers; k++) {
        const RetexSignalMember *member = &totals->signal->members[k];
        const float *restrict light = light_at(d, member, at->x, at->y);
        const double weight = (double)member->bright;
        for (int i = 0; i < 3 * at->count && !member->corrects; i++)
            to[i] += weight * (double)light[i];
    }
}

static void find_variances(Totals *totals, const RetexDenoiser *d, const Span *at)
{
    const RetexImage *noise = &d->set->parts[totals->signal->noise].image;
    const float *row = noise->pixels + retex_image_index(noise, 0, at->y);
    for (int k = 0; k < at->count; k++) {
        const int x = at->x + k, end = x + NEIGHBOURS + 1 < noise->width ? x + NEIGHBOURS + 1 : noise->width;
        double sum = 0;
        for (int i = x > NEIGHBOURS ? 3 * (x - NEIGHBOURS) : 0; i < 3 * end; i++)
            sum += (double)row[i] * (double)row[i];
        totals->variances[k] = isfinite(sum) ? sum : 0;
    }
}

/* Members keep their proportions; where all are 0 the first one takes all. */
static void set_total(const RetexDenoiser *d, const RetexSignal *signal, int x, int y, int c, double old, double total)
{
    for (int k = 0; k < signal->nmembers; k++) {
        float *light = &light_at(d, &signal->members[k], x, y)[c];
        if (signal->members[k].corrects)
            continue;
        if (!(old > 0)) {
            *light = (float)(total / (double)signal->members[k].bright);
            return;
        }
        *light = (float)(total * ((double)*light / old));
    }
}

/* How much of the residual a product takes, by the kinds of weights, the first of which has a sum. */
static double weight_of(const Product *p, int kind, double residual)
{
    if (!(p->kept > 0) || (residual < 0 && !(p->value > 0)))
        return 0;
    return kind == 0 ? p->variance : kind == 1 ? p->value : p->kept;
}

/* Adds the residual to the products. What would make one negative is left, and returned. */
static double add_residual(Product *products, int count, double residual)
{
    double sum = 0, left = 0;
    int kind = 0;
    for (; kind < 3 && !(sum > 0); kind++)
        for (int k = 0; k < count; k++)
            sum += weight_of(&products[k], kind, residual);
    for (int k = 0; k < count && sum > 0; k++) {
        Product *p = &products[k];
        p->value += residual * (weight_of(p, kind - 1, residual) / sum);
        left += fmin(p->value, 0);
        p->value = fmax(p->value, 0);
    }
    return left;
}

/* The largest product takes what rounding leaves. */
static void close_sum(Product *products, int count, double whole)
{
    int largest = 0;
    for (int k = 1; k < count; k++)
        if (products[k].value > products[largest].value)
            largest = k;
    for (int k = 0; k < count; k++)
        whole -= k == largest ? 0 : products[k].kept * (double)(float)(products[k].value / products[k].kept);
    products[largest].value = fmax(whole, 0);
}

static void share(const RetexDenoiser *d, double total, Product *products, int count, const Span *at, int pixel, int c)
{
    double residual = total;
    for (int k = 0; k < count; k++)
        residual -= products[k].value;
    if (!isfinite(residual))
        return;
    for (int k = 0; k < count && residual != 0; k++) /* each time at least one product becomes 0 */
        residual = add_residual(products, count, residual);
    close_sum(products, count, total);
    for (int k = 0; k < count; k++)
        set_total(d, products[k].lamp->signal, at->x + pixel, at->y, c, products[k].lamp->of[3 * pixel + c],
                  products[k].value / products[k].kept);
}

/* The products of a signal of all light with a value above 0. */
static int list_products(Product *products, const RetexDenoiser *d, const Totals *lamps, int nlamps, int pixel, int c)
{
    int count = 0;
    for (int k = 0; k < nlamps; k++) {
        const double kept = (double)d->set->parameters[lamps[k].signal->lamp].kept[c];
        if (kept > 0)
            products[count++] = (Product){.lamp = &lamps[k],
                                          .kept = kept,
                                          .value = kept * fmax(lamps[k].of[3 * pixel + c], 0),
                                          .variance = kept * kept * lamps[k].variances[pixel]};
    }
    return count;
}

/* The signals of lamps that are part of a signal of all light. */
static int list_lamps(Totals *lamps, const RetexDenoiser *d, const RetexSignal *whole)
{
    int count = 0;
    for (int s = 0; s < d->signals.count && count < RETEX_PARAMETERS_MAX; s++) {
        const RetexSignal *signal = &d->signals.of[s];
        if (signal->lamp >= 0 && signal->target == whole->target && signal->kind == whole->kind)
            lamps[count++].signal = signal;
    }
    return count;
}

static void share_signal(const RetexDenoiser *d, const RetexSignal *signal, const Span *at)
{
    Totals whole = {.signal = signal}, lamps[RETEX_PARAMETERS_MAX];
    Product products[RETEX_PARAMETERS_MAX];
    const int nlamps = list_lamps(lamps, d, signal);
    if (nlamps)
        find_totals(&whole, d, at);
    for (int k = 0; k < nlamps; k++) {
        find_totals(&lamps[k], d, at);
        find_variances(&lamps[k], d, at);
    }
    for (int pixel = 0; pixel < at->count && nlamps; pixel++)
        for (int c = 0; c < 3; c++) {
            const int count = list_products(products, d, lamps, nlamps, pixel, c);
            if (count)
                share(d, fmax(whole.of[3 * pixel + c], 0), products, count, at, pixel, c);
        }
}

void retex_denoise_share_residual(const RetexDenoiser *d, int y)
{
    if (!retex_set_has_role(d->set, RETEX_ROLE_LAMP))
        return;
    for (int x = d->roi.x0; x < d->roi.x1; x += PIXELS) {
        const Span at = {x, y, d->roi.x1 - x < PIXELS ? d->roi.x1 - x : PIXELS};
        for (int s = 0; s < d->signals.count; s++)
            if (d->signals.of[s].lamp < 0)
                share_signal(d, &d->signals.of[s], &at);
    }
}
