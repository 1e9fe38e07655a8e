/* Loads sets into memory, from the sources of their parts. */
#include <stdlib.h>
#include <string.h>
#include <retex/set_file.h>

#include "set/transfer.h"
#include "set/manifest.h"
#include "set/references.h"
#include "set/source.h"

/* Loads those of the wanted parts that have no pixels; on failure none is loaded. */
static int load_parts(RetexSet *set, const char *wanted, int nthreads, RetexError *err)
{
    RetexImage *loaded = calloc((size_t)set->nparts + 1, sizeof *loaded);
    RetexImageTransfer *images = calloc((size_t)set->nparts + 1, sizeof *images);
    int missing = 0, code = loaded && images ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to load a set");

    for (int i = 0; !code && i < set->nparts; i++) {
        const RetexImage *shape = &set->parts[i].image;
        if (!wanted[i] || shape->pixels)
            continue;
        images[missing++] = (RetexImageTransfer){.part = i, .image = &loaded[i]};
        code = retex_image_alloc(&loaded[i], shape->width, shape->height, shape->channels, err);
    }
    if (!code)
        code = retex_transfer_images(images, missing, set, NULL, nthreads, err);
    for (int i = 0; loaded && i < set->nparts; i++)
        if (code)
            retex_image_free(&loaded[i]);
        else if (loaded[i].pixels)
            set->parts[i].image = loaded[i];
    free(loaded);
    free(images);
    return code;
}

int retex_set_load(RetexSet *set, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX];

    /* the picture comes last: a pack may compute it from the other parts, which then need not be decoded twice */
    memset(wanted, 1, sizeof wanted);
    wanted[0] = 0;
    int code = load_parts(set, wanted, nthreads, err);
    wanted[0] = 1;
    if (!code)
        code = load_parts(set, wanted, nthreads, err);
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
    return bytes > most_bytes ? RETEX_OK : load_parts(set, wanted, nthreads, err);
}
