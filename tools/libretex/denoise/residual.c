/* See residual.h. */
#include "denoise/residual.h"

#include <math.h>

#include "set/set.h"

enum { NEIGHBOURS = 4 }; /* pixels to each side over which the variance is averaged, in the row */

/* What one lamp adds to a signal of all light, in one pixel and channel. */
typedef struct Product {
    const RetexSignal *signal;
    double kept;     /* the lamp's value in all light; 0: it adds nothing */
    double value;    /* of the product */
    double variance; /* up to a factor that all have */
} Product;

static float *light_at(const RetexDenoiser *d, const RetexSignalMember *member, int x, int y)
{
    RetexImage *im = &d->set->parts[member->part].image;
    return im->pixels + retex_image_index(im, x, y);
}

static double total_of(const RetexDenoiser *d, const RetexSignal *signal, int x, int y, int c)
{
    double total = 0;
    for (int k = 0; k < signal->nmembers; k++)
        if (!signal->members[k].corrects)
            total += (double)signal->members[k].weight * (double)light_at(d, &signal->members[k], x, y)[c];
    return total;
}

/* The variance of a lamp's light of value 1. */
static double variance_of(const RetexDenoiser *d, const RetexSignal *signal, int x, int y)
{
    const RetexImage *noise = &d->set->parts[signal->noise].image;
    const int end = x + NEIGHBOURS + 1 < noise->width ? x + NEIGHBOURS + 1 : noise->width;
    double sum = 0;
    for (int u = x > NEIGHBOURS ? x - NEIGHBOURS : 0; u < end; u++)
        for (int c = 0; c < 3; c++) {
            const double n = (double)noise->pixels[retex_image_index(noise, u, y) + (size_t)c];
            sum += n * n;
        }
    return isfinite(sum) ? sum : 0;
}

/* Members keep their proportions; where all are 0 the first one takes all. */
static void set_total(const RetexDenoiser *d, const RetexSignal *signal, int x, int y, int c, double total)
{
    const double old = total_of(d, signal, x, y, c);
    for (int k = 0; k < signal->nmembers; k++) {
        float *light = &light_at(d, &signal->members[k], x, y)[c];
        if (signal->members[k].corrects)
            continue;
        if (!(old > 0)) {
            *light = (float)(total / (double)signal->members[k].weight);
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

static void share(const RetexDenoiser *d, const RetexSignal *whole, Product *products, int count, int x, int y, int c)
{
    const double total = fmax(total_of(d, whole, x, y, c), 0);
    double residual = total;
    for (int k = 0; k < count; k++)
        residual -= products[k].value;
    if (!isfinite(residual))
        return;
    for (int k = 0; k < count && residual != 0; k++) /* each time at least one product becomes 0 */
        residual = add_residual(products, count, residual);
    close_sum(products, count, total);
    for (int k = 0; k < count; k++)
        set_total(d, products[k].signal, x, y, c, products[k].value / products[k].kept);
}

/* The products of a signal of all light with a value above 0. */
static int list_products(Product *products, const RetexDenoiser *d, const RetexSignal *whole, int x, int y, int c)
{
    int count = 0;
    for (int s = 0; s < d->signals.count && count < RETEX_PARAMETERS_MAX; s++) {
        const RetexSignal *signal = &d->signals.of[s];
        if (signal->lamp < 0 || signal->target != whole->target || signal->kind != whole->kind)
            continue;
        const double kept = (double)d->set->parameters[signal->lamp].kept[c];
        if (!(kept > 0))
            continue;
        products[count++] = (Product){.signal = signal,
                                      .kept = kept,
                                      .value = kept * fmax(total_of(d, signal, x, y, c), 0),
                                      .variance = kept * kept * variance_of(d, signal, x, y)};
    }
    return count;
}

void retex_denoise_share_residual(const RetexDenoiser *d, int y)
{
    Product products[RETEX_PARAMETERS_MAX];
    if (!retex_set_has_role(d->set, RETEX_ROLE_LAMP))
        return;
    for (int s = 0; s < d->signals.count; s++)
        for (int x = d->roi.x0; x < d->roi.x1 && d->signals.of[s].lamp < 0; x++)
            for (int c = 0; c < 3; c++) {
                const int count = list_products(products, d, &d->signals.of[s], x, y, c);
                if (count)
                    share(d, &d->signals.of[s], products, count, x, y, c);
            }
}
