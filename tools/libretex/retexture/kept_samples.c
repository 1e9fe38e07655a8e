/* See kept_samples.h and <retex/combine.h>. */
#include "retexture/kept_samples.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/assert.h>

#include "base/params.h"
#include "set/set.h"

enum { FINISHES = 1 + RETEX_FINISHES_MAX }; /* without one, and each of them */

struct RetexKeptSamples {
    const RetexSet *set;
    RetexBudget *budget;
    int target;
    RetexKeptRow **rows; /* by footprint and finish; NULL where there can be none */
    uint64_t own_bytes;  /* without colours */
    _Atomic uint64_t bytes, lacked;
    _Atomic uint64_t made, found;
};

static int height_of(const RetexSet *set, int footprint)
{
    return set->parts[set->footprints[footprint].uv].image.height;
}

static RetexKeptRow *row_of(const RetexKeptSamples *kept, int footprint, int finish, int y)
{
    RETEX_ASSERT(kept->set->footprints[footprint].target == kept->target); /* others have no rows */
    RETEX_ASSERT(finish < kept->set->targets[kept->target].nfinishes);
    RETEX_ASSERT(y >= 0 && y < height_of(kept->set, footprint)); /* rows of the footprint's size */
    return &kept->rows[footprint * FINISHES + (finish < 0 ? 0 : 1 + finish)][y];
}

static size_t row_bytes(RetexRowSpan span)
{
    return retex_span_is_empty(span) ? 0 : 3 * sizeof(float) * (size_t)(span.end - span.begin);
}

/* Allocates the tables of rows. With kept->rows NULL only counts their bytes. */
static int make_tables(RetexKeptSamples *kept)
{
    const RetexSet *set = kept->set;
    const int finishes = 1 + set->targets[kept->target].nfinishes;
    kept->own_bytes = sizeof *kept + (size_t)set->nfootprints * FINISHES * sizeof *kept->rows;
    for (int f = 0; f < set->nfootprints; f++) {
        const RetexFootprint *footprint = &set->footprints[f];
        if (footprint->target != kept->target || footprint->uv < 0 || footprint->uv >= set->nparts)
            continue;
        const size_t height = (size_t)height_of(set, f);
        kept->own_bytes += (size_t)finishes * height * sizeof **kept->rows;
        for (int k = 0; k < finishes && kept->rows; k++)
            if (!(kept->rows[f * FINISHES + k] = calloc(height, sizeof **kept->rows)))
                return RETEX_ENOMEM;
    }
    return RETEX_OK;
}

int retex_kept_samples_create(RetexKeptSamples **samples, const RetexSet *set, int target, RetexBudget *budget,
                              RetexError *err)
{
    *samples = NULL;
    if (target < 0 || target >= set->ntargets)
        return retex_fail(err, RETEX_EINVAL, "the set has no target %d", target);
    RetexKeptSamples *kept = calloc(1, sizeof *kept);
    if (!kept)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory to keep samples");
    *kept = (RetexKeptSamples){.set = set, .target = target};
    (void)make_tables(kept);
    int code = retex_budget_charge(budget, kept->own_bytes, "kept samples", err);
    if (!code) {
        kept->budget = budget;
        kept->bytes = kept->own_bytes;
        kept->rows = calloc((size_t)set->nfootprints * FINISHES + 1, sizeof *kept->rows);
        if (!kept->rows || make_tables(kept))
            code = retex_fail(err, RETEX_ENOMEM, "not enough memory to keep samples");
    }
    if (code)
        retex_kept_samples_close(&kept);
    *samples = kept;
    return code;
}

void retex_kept_samples_close(RetexKeptSamples **samples)
{
    RetexKeptSamples *kept = samples ? *samples : NULL;
    if (!kept)
        return;
    for (int i = 0; kept->rows && i < kept->set->nfootprints * FINISHES; i++) {
        for (int y = 0; kept->rows[i] && y < height_of(kept->set, i / FINISHES); y++)
            free(kept->rows[i][y].colors);
        free(kept->rows[i]);
    }
    retex_budget_release(kept->budget, kept->bytes);
    free(kept->rows);
    free(kept);
    *samples = NULL;
}

void retex_kept_samples_get_info(const RetexKeptSamples *kept, RetexKeptSamplesInfo *info)
{
    const RetexKeptSamplesInfo own = {0, kept->bytes, kept->lacked, kept->made, kept->found};
    (void)RETEX_PARAMS_RETURN(info, &own, NULL);
}

int retex_kept_samples_check(const RetexKeptSamples *kept, const RetexSet *set, int target, RetexError *err)
{
    return kept->set == set && kept->target == target
               ? RETEX_OK
               : retex_fail(err, RETEX_EINVAL, "samples that are kept of another set or target");
}

const RetexKeptRow *retex_kept_samples_find(RetexKeptSamples *kept, int footprint, int finish, int y,
                                            RetexRowSpan columns)
{
    const RetexKeptRow *row = row_of(kept, footprint, finish, y);
    if (retex_span_is_empty(row->columns) || row->columns.begin > columns.begin || row->columns.end < columns.end)
        return NULL;
    kept->found++;
    return row;
}

void retex_kept_samples_add(RetexKeptSamples *kept, int footprint, int finish, int y, RetexRowSpan columns,
                            RetexRowSpan span, const float *row)
{
    RetexKeptRow *own = row_of(kept, footprint, finish, y);
    const size_t bytes = row_bytes(span), old = row_bytes(own->span);
    RETEX_ASSERT(!own->colors == !old); /* what is not empty is in memory */
    RETEX_ASSERT(!bytes || row);
    kept->made++;
    if (own->colors) {
        free(own->colors);
        retex_budget_release(kept->budget, old);
        kept->bytes -= old;
    }
    *own = (RetexKeptRow){NULL, {0, 0}, {0, 0}};
    if (bytes && retex_budget_charge(kept->budget, bytes, "kept samples", NULL)) {
        kept->lacked += bytes;
        return;
    }
    if (bytes && !(own->colors = malloc(bytes))) {
        retex_budget_release(kept->budget, bytes);
        return;
    }
    if (bytes)
        memcpy(own->colors, row + 3 * (size_t)span.begin, bytes);
    kept->bytes += bytes;
    own->span = bytes ? span : (RetexRowSpan){0, 0};
    own->columns = columns;
}
