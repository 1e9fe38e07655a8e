/* Rounds a rendered set before it is written, denoised or packed: see <retex/set.h>. Parts in memory are rounded
 * where they are, those of a band store on the way into another one. */
#include <stdlib.h>

#include <retex/host/band_store.h>
#include <retex/host/set_build.h>

#include "base/jobs.h"
#include "set/strip.h"
#include "precision/precision.h"
#include "set/parts.h"
#include "set/set.h"
#include "set/source.h"

enum { ROWS = 64 }; /* that are in memory at once */

typedef struct RoundedStore {
    const RetexSet *set, *rows;
    RetexBandStore *store; /* or NULL: all parts are in memory */
    int *images;           /* by part: its number in the store */
    int y;
} RoundedStore;

static int is_stored(const RetexPart *part)
{
    return !part->image.pixels && retex_part_store(part);
}

static int open_store(RoundedStore *s, const char *near, RetexError *err)
{
    const RetexSet *set = s->set;
    int code = retex_band_store_create(&s->store, set->width, set->height, set->id, near, err);
    s->images = calloc((size_t)set->nparts + 1, sizeof *s->images);
    if (!code && !s->images)
        code = retex_fail(err, RETEX_ENOMEM, "no memory to round a set");
    for (int k = 0; k < set->nparts && !code; k++) {
        const RetexPart *part = &set->parts[k];
        if (is_stored(part))
            code = retex_band_store_add(s->store, part->name, part->letters, part->type, &s->images[k], err);
    }
    return code;
}

static int store_part(void *context, int part, int thread, RetexError *err)
{
    const RoundedStore *s = context;
    const RetexImage *im = &s->rows->parts[part].image;
    int code = RETEX_OK;
    (void)thread;
    for (int y = 0; y < im->height && is_stored(&s->set->parts[part]) && !code; y += RETEX_BAND_ROWS)
        code = retex_band_store_put(s->store, s->images[part], (s->y + y) / RETEX_BAND_ROWS,
                                    im->pixels + retex_image_index(im, 0, y), err);
    return code;
}

static int round_rows(const RetexPrecision *precision, RoundedStore *s, RetexSetStrip *strip, int y, int nthreads,
                      RetexError *err)
{
    RetexSet *rows;
    const int left = s->set->height - y;
    int code = retex_set_strip_load(&rows, strip, y, left < ROWS ? left : ROWS, nthreads, err);
    if (!code) {
        retex_set_round_to_types(rows, nthreads); /* as those of a band store are */
        code = retex_precision_round(precision, rows, NULL, nthreads, err);
    }
    s->rows = rows, s->y = y;
    return code || !s->store ? code : retex_jobs_run(nthreads, s->set->nparts, store_part, s, err);
}

int retex_set_round(RetexSet *set, const char *near, int nthreads, RetexError *err)
{
    RoundedStore s = {.set = set};
    RetexPrecision *precision = NULL;
    RetexSetStrip *strip = NULL;
    if (!set->nterms)
        return RETEX_OK;
    int code = retex_precision_open(&precision, set, 1, err);
    for (int k = 0; k < set->nparts && !code && !s.store; k++)
        if (is_stored(&set->parts[k]))
            code = open_store(&s, near, err);
    if (!code)
        code = retex_set_strip_open(&strip, set, ROWS, 0, err);
    for (int y = 0; y < set->height && !code; y += ROWS)
        code = round_rows(precision, &s, strip, y, nthreads, err);
    retex_set_strip_close(&strip);
    retex_precision_close(&precision);
    RetexSetSource *rounded = NULL;
    if (!code && s.store) {
        code = retex_store_source_open(&rounded, s.store, err);
        s.store = NULL;
    }
    for (int k = 0; k < set->nparts && rounded; k++)
        if (is_stored(&set->parts[k]))
            retex_part_set_source(&set->parts[k], rounded, s.images[k]);
    retex_source_release(&rounded);
    retex_band_store_close(&s.store);
    free(s.images);
    return code;
}
