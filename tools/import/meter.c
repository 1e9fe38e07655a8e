/* See meter.h. Light is judged by means of 4 x 4 pixels, so that the noise of few samples is no darkness. */
#include "import/meter.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/color.h>

#define LEAST_REFLECTANCE 0.02 /* less is black, or shines itself */
#define DARK_CARD 0.18 /* of a meter of incident light: the least reflectance of what is seen that it is set to */
#define BRIGHT_CARD 0.45
#define DARKEST 0.0039  /* 5 % of the range of sRGB */
#define MOST_DARKER 1.5 /* stops by which a picture is darker than its surfaces want, for what else is in it */
#define MOST_DARKER_THINGS 3.0 /* the same of things before a backdrop, which is a third of the picture or more */
enum { SIDE = 4 };      /* of a block, pixels */

static double luminance_at(const RetexImage *image, int x, int y)
{
    const float *p = image->pixels + retex_image_index(image, x, y);
    return fmax(retex_luminance((double)p[0], (double)p[1], (double)p[2]), 0);
}

static MeterBlock block_of(Meter *meter, const RetexImage *light, const RetexImage *depth,
                           const RetexImage *reflectance, int x0, int y0, double *all)
{
    MeterBlock block = {0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = x0 + i % SIDE, y = y0 + i / SIDE;
        *all += luminance_at(light, x, y) / (SIDE * SIDE);
        if (!isfinite(depth->pixels[retex_image_index(depth, x, y)])) {
            meter->empty++, meter->backdrop += luminance_at(light, x, y);
            continue;
        }
        block.light += luminance_at(light, x, y), block.reflectance += luminance_at(reflectance, x, y);
        block.pixels++;
    }
    if (block.pixels)
        block.light /= block.pixels, block.reflectance /= block.pixels;
    for (int i = 0; i < SIDE * SIDE; i++) {
        const int x = x0 + i % SIDE, y = y0 + i / SIDE;
        block.faint +=
            isfinite(depth->pixels[retex_image_index(depth, x, y)]) && luminance_at(light, x, y) < block.light / 30;
    }
    return block;
}

static int compare_light(const void *a, const void *b)
{
    const double x = ((const MeterBlock *)a)->light, y = ((const MeterBlock *)b)->light;
    return (x > y) - (x < y);
}

/* What shines itself, such as panes with a picture of the sky, need not be in the range: only what reflects light is
 * judged, if it is a third of what is seen. With baked light, nothing reflects. */
static void leave_out_what_shines(Meter *meter)
{
    int count = 0, kept = 0;
    for (int i = 0; i < meter->count; i++)
        count += meter->blocks[i].reflectance > LEAST_REFLECTANCE;
    for (int i = 0; i < meter->count && 3 * count >= meter->count; i++)
        if (meter->blocks[i].reflectance > LEAST_REFLECTANCE)
            meter->blocks[kept++] = meter->blocks[i];
    meter->count = kept ? kept : meter->count;
}

static void judge(Meter *meter)
{
    double sum = 0, reflectance = 0, faint = 0, pixels = 0;
    leave_out_what_shines(meter);
    qsort(meter->blocks, (size_t)meter->count, sizeof *meter->blocks, compare_light);
    meter->bright = meter->count ? meter->blocks[9 * meter->count / 10].light : 0;
    meter->dark = !(meter->bright > 0);
    if (meter->dark > 0)
        return;
    for (int i = 0; i < meter->count; i++) {
        sum += log2(fmax(meter->blocks[i].light, meter->bright / 256));
        reflectance += meter->blocks[i].reflectance / meter->count;
    }
    const double card = fmin(fmax(reflectance, DARK_CARD), BRIGHT_CARD);
    meter->stops = log2(card) - sum / meter->count;
    meter->stops += fmax(fmin(log2(METER_BRIGHTEST / meter->bright) - meter->stops, 0), -1); /* windows may be white */
    for (int i = 0; i < meter->count; i++) {
        const MeterBlock *b = &meter->blocks[i];
        const int is_dark = b->light * exp2(meter->stops) < DARKEST;
        meter->dark += (is_dark && b->reflectance > LEAST_REFLECTANCE) / (double)meter->count; /* black things may be */
        meter->white += (b->light > METER_BRIGHTEST) / (double)meter->count;
        faint += is_dark ? 0 : b->faint, pixels += is_dark ? 0 : b->pixels;
    }
    meter->is_noisy = faint > 0.25 * pixels;
}

double meter_lit(const Meter *meter, double stops)
{
    int count = 0;
    for (int i = 0; i < METER_BLOCKS; i++) {
        const double shown = meter->all[i] * exp2(stops);
        count += shown > DARKEST && shown < METER_BRIGHTEST;
    }
    return count / (double)METER_BLOCKS;
}

double meter_whole_stops(const Meter *meter)
{
    double best = meter->stops, most = meter_lit(meter, best);
    const double darker = 3 * meter->empty > METER_WIDTH * METER_HEIGHT ? MOST_DARKER_THINGS : MOST_DARKER;
    for (double less = 0.1; less <= darker && most < METER_ENOUGH_LIT; less += 0.1) {
        const double lit = meter_lit(meter, meter->stops - less);
        if (lit > most + 0.01)
            best = meter->stops - less, most = lit;
    }
    return best;
}

static int compare_numbers(const void *a, const void *b)
{
    return (*(const double *)a > *(const double *)b) - (*(const double *)a < *(const double *)b);
}

double meter_brightest(const Meter *meter)
{
    double all[METER_BLOCKS];
    memcpy(all, meter->all, sizeof all);
    qsort(all, METER_BLOCKS, sizeof *all, compare_numbers);
    return all[(int)(METER_ENOUGH_LIT * METER_BLOCKS)];
}

static const RetexImage *image_of(const RetexSet *set, const char *name)
{
    const RetexPart *part = retex_set_part(set, name ? retex_set_find_part(set, name) : 0);
    return part ? &part->image : NULL;
}

double meter_mean(const Meter *meter)
{
    double mean = 0;
    for (int i = 0; i < meter->count; i++)
        mean += meter->blocks[i].light / meter->count;
    return mean;
}

int meter_is_bare(const Meter *meter)
{
    return meter->empty > METER_WIDTH * METER_HEIGHT / 5 && meter->backdrop < meter->bright / 32;
}

void meter_read(Meter *meter, const RetexSet *set)
{
    const RetexImage *light = image_of(set, NULL), *depth = image_of(set, "depth"),
                     *reflectance = image_of(set, "reflectance");
    memset(meter, 0, sizeof *meter);
    for (int i = 0; light && depth && reflectance && i < METER_BLOCKS; i++) {
        const int across = METER_WIDTH / SIDE;
        const MeterBlock block =
            block_of(meter, light, depth, reflectance, i % across * SIDE, i / across * SIDE, &meter->all[i]);
        if (2 * block.pixels >= SIDE * SIDE)
            meter->blocks[meter->count++] = block;
    }
    meter->backdrop /= meter->empty ? meter->empty : 1;
    judge(meter);
}
