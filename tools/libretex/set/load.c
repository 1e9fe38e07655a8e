/* Loads sets into memory, from the sources of their parts. */
#include <stdlib.h>
#include <string.h>
#include <retex/set_file.h>

#include "set/keep.h"
#include "set/manifest.h"
#include "set/references.h"
#include "set/source.h"

int retex_set_load(RetexSet *set, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX];

    /* the picture comes last: a pack may compute it from the other parts, which then need not be decoded twice */
    memset(wanted, 1, sizeof wanted);
    wanted[0] = 0;
    int code = retex_set_keep(set, wanted, NULL, nthreads, err);
    wanted[0] = 1;
    if (!code)
        code = retex_set_keep(set, wanted, NULL, nthreads, err);
    for (int i = 0; i < set->nparts && !code; i++)
        retex_part_set_source(&set->parts[i], NULL, 0);
    return code;
}

static uint64_t image_bytes(const RetexImage *image)
{
    return sizeof(float) * retex_image_index(image, 0, image->height);
}

uint64_t retex_set_bytes(const RetexSet *set)
{
    uint64_t bytes = 0;

    for (int i = 0; i < set->nparts; i++)
        bytes += image_bytes(&set->parts[i].image);
    return bytes;
}

typedef struct Reading {
    const RetexSet *set;
    const int *corrected; /* by target, or NULL: all */
    char *wanted;
} Reading;

static void mark_read(void *context, RetexPartUse use, int user, int *part)
{
    const Reading *r = context;
    const RetexTerm *term = use == RETEX_PART_RADIANCE || use == RETEX_PART_IMAGE ? &r->set->terms[user] : NULL;
    const int skipped = term && term->role == RETEX_ROLE_CORRECTION && r->corrected && !r->corrected[term->target];
    r->wanted[*part] |= use != RETEX_PART_ORIGINAL && !skipped;
}

/* Marks in `wanted` the parts that recombination reads; returns their bytes. */
static uint64_t list_read_parts(const RetexSet *set, const int *corrected, char wanted[RETEX_SET_PARTS_MAX])
{
    Reading reading = {set, corrected, wanted};
    uint64_t bytes = 0;

    memset(wanted, 0, RETEX_SET_PARTS_MAX);
    retex_set_visit_const_parts(set, mark_read, &reading);
    for (int i = 0; i < set->nparts; i++)
        if (wanted[i])
            bytes += image_bytes(&set->parts[i].image);
    return bytes;
}

uint64_t retex_set_preload_bytes(const RetexSet *set, const int *corrected)
{
    char wanted[RETEX_SET_PARTS_MAX];
    return list_read_parts(set, corrected, wanted);
}

int retex_set_preload(RetexSet *set, const int *corrected, uint64_t most_bytes, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX];
    const uint64_t bytes = list_read_parts(set, corrected, wanted);
    return bytes > most_bytes ? RETEX_OK : retex_set_keep(set, wanted, NULL, nthreads, err);
}
