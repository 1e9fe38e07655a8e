/* See combine.h. */
#include "pack/combine.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "retexture/combine_rows.h"
#include "base/half.h"
#include "set/manifest.h"
#include "set/references.h"

/* --- what is needed --- */

typedef struct Needed {
    const RetexSet *set;
    char *parts;
} Needed;

static void mark_part(void *context, RetexPartUse use, int user, int *part)
{
    const Needed *needed = context;
    if (use == RETEX_PART_RADIANCE || use == RETEX_PART_IMAGE)
        needed->parts[*part] |= retex_term_is_light(&needed->set->terms[user]);
    else
        needed->parts[*part] |= use == RETEX_PART_WEIGHT || use == RETEX_PART_ALBEDO;
}

/* Mark the parts that recombination with the originals reads; 0 where one is not there. */
static int mark_needed(char *parts, const RetexSet *set)
{
    Needed needed = {set, parts};
    int ok = 1;
    memset(parts, 0, (size_t)set->nparts);
    retex_set_visit_const_parts(set, mark_part, &needed);
    for (int i = 0; i < set->nfootprints; i++)
        ok = ok && set->footprints[i].albedo >= 0;
    for (int i = 0; i < set->nparameters; i++) /* of which the order of additions depends */
        ok = ok && set->parameters[i].kind == RETEX_PARAMETER_CORRECTION;
    return ok;
}

int retex_pack_combine_fits(const RetexSet *set, RetexError *err)
{
    char needed[RETEX_SET_PARTS_MAX];
    const RetexPart *picture = &set->parts[0];
    int ok = set->nterms > 0 && picture->image.channels == 3 && mark_needed(needed, set);
    for (int i = 0; ok && i < set->nparts; i++)
        if (i == 0 || needed[i])
            ok = !(i == 0 && needed[i]) && set->parts[i].image.width == set->width &&
                 set->parts[i].image.height == set->height;
    return ok ? retex_combine_check(set, err) : 0;
}

typedef struct Rounding {
    const RetexSet *set;
    char needed[RETEX_SET_PARTS_MAX];
    atomic_int differs;
} Rounding;

static void compare_with_halves(void *context, int part, int thread)
{
    enum { RUN = 256 };
    Rounding *r = context;
    const RetexImage *im = &r->set->parts[part].image;
    const size_t count = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
    uint16_t halves[RUN];
    float rounded[RUN];
    (void)thread;
    if (!r->needed[part] || r->set->parts[part].type != RETEX_HALF)
        return;
    for (size_t i = 0; i < count && !r->differs; i += RUN) {
        const size_t n = count - i < RUN ? count - i : RUN;
        retex_half_from_float(halves, im->pixels + i, n);
        retex_half_to_float(rounded, halves, n);
        if (memcmp(rounded, im->pixels + i, n * sizeof *rounded) != 0)
            r->differs = 1;
    }
}

int retex_pack_combine_is_stored(const RetexSet *set, int nthreads)
{
    Rounding rounding = {.set = set};
    if (!mark_needed(rounding.needed, set))
        return 0;
    retex_parallel(nthreads, set->nparts, compare_with_halves, &rounding);
    return !rounding.differs;
}

/* --- differences --- */

/* The recombined rows, and room for one channel of them as numbers. */
typedef struct Recombined {
    float *rows;
    int32_t *numbers;
} Recombined;

static int recombine(Recombined *r, const RetexPackModelStrip *strip, const RetexSet *set, int y0, RetexError *err)
{
    const size_t pixels = (size_t)strip->width * (size_t)strip->rows;
    *r = (Recombined){malloc(3 * pixels * sizeof *r->rows), malloc(pixels * sizeof *r->numbers)};
    return r->rows && r->numbers ? retex_combine_original_rows(r->rows, set, y0, y0 + strip->rows, err)
                                 : retex_fail(err, RETEX_ENOMEM, "no memory for the picture of a pack");
}

/* Add their numbers to the strip's, or take them from these; they may wrap. */
static void apply(RetexPackModelStrip *strip, const Recombined *r, RetexPixelType type, uint32_t sign)
{
    const RetexPackMap bits = {.kind = RETEX_PACK_MAP_BITS};
    const size_t pixels = (size_t)strip->width * (size_t)strip->rows;
    for (int c = 0; c < 3; c++) {
        retex_pack_map_numbers(r->numbers, r->rows + c, 3, pixels, &bits, type);
        for (size_t i = 0; i < pixels; i++)
            strip->numbers[c][i] = (int32_t)((uint32_t)strip->numbers[c][i] + sign * (uint32_t)r->numbers[i]);
    }
}

static void recombined_free(Recombined *r)
{
    free(r->rows);
    free(r->numbers);
}

int retex_pack_combine_subtract(RetexPackModelStrip *strip, const RetexSet *set, int y0, int *finite, RetexError *err)
{
    Recombined r;
    int code = recombine(&r, strip, set, y0, err);
    for (size_t i = 0; !code && i < 3 * (size_t)strip->width * (size_t)strip->rows; i++)
        *finite = *finite && isfinite(r.rows[i]);
    if (!code)
        apply(strip, &r, set->parts[0].type, UINT32_MAX);
    recombined_free(&r);
    return code;
}

int retex_pack_combine_add(RetexPackModelStrip *strip, const RetexSet *set, int y0, RetexError *err)
{
    Recombined r;
    int code = recombine(&r, strip, set, y0, err);
    if (!code)
        apply(strip, &r, set->parts[0].type, 1);
    recombined_free(&r);
    return code;
}
