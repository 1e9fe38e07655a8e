/* The least that recombining a set can take: post_floor SET [THREADS]
 *
 * Opens a set or a pack as retex-combine does, reads and decodes every row of the parts that recombination looks at
 * where all targets have new textures without alpha, and keeps nothing: no texture, no arithmetic, no picture. Strips
 * of rows are read side by side by all threads, what is smaller than the picture before the rest, as in combining.
 * Prints how many parts that were and their bytes as floats.
 *
 * */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>

#include <retex/parallel.h>
#include <retex/picture.h>
#include <retex/set_file.h>

#include "set/rows.h"
#include "set/set.h"

typedef struct Floor {
    const RetexSet *set;
    char *wanted; /* by part */
    int is_small; /* parts smaller than the picture now, or those of its size */
    atomic_int code;
    RetexError *errors; /* by thread, as are: */
    RetexRowReader **readers;
} Floor;

static void want(const Floor *work, int part)
{
    if (part >= 0)
        work->wanted[part] = 1;
}

static void want_footprint(const Floor *work, int footprint)
{
    const RetexFootprint *f = &work->set->footprints[footprint];
    want(work, f->uv);
    want(work, f->spread);
}

static void want_mixture(const Floor *work, int mixture)
{
    const RetexMixture *m = &work->set->mixtures[mixture];
    for (int k = 0; k < m->nshares; k++) {
        want(work, m->shares[k].weight);
        want_footprint(work, m->shares[k].footprint);
    }
}

/* What the terms of the polynomial refer to: of several targets none is left whose edit needs corrections. */
static void choose(const Floor *work)
{
    for (int t = 0; t < work->set->nterms; t++) {
        const RetexTerm *term = &work->set->terms[t];
        if (term->role == RETEX_ROLE_PICTURE ||
            (term->role == RETEX_ROLE_CORRECTION &&
             !(retex_correction_weight(work->set->ntargets, work->set->ntargets) > 0)))
            continue;
        want(work, term->radiance);
        want(work, retex_term_image(term));
        for (int k = 0; k < term->nfactors; k++) {
            if (term->factors[k].kind == RETEX_FACTOR_FOOTPRINT)
                want_footprint(work, term->factors[k].index);
            else if (term->factors[k].kind == RETEX_FACTOR_MIXTURE)
                want_mixture(work, term->factors[k].index);
        }
    }
}

static int is_chosen(const Floor *work, int part)
{
    return work->wanted[part] && (work->set->parts[part].image.height < work->set->height) == work->is_small;
}

static int read_strip(const Floor *work, RetexRowReader *reader, int part, int strip, RetexError *err)
{
    const int height = work->set->parts[part].image.height, y0 = strip * RETEX_PICTURE_STRIP;
    int code = RETEX_OK;
    for (int y = y0; !code && y < y0 + RETEX_PICTURE_STRIP && y < height; y++) {
        const float *row;
        code = retex_row_reader_get(reader, part, y, &row, err);
    }
    return code;
}

static void read_job(void *context, int strip, int thread)
{
    Floor *work = context;
    RetexRowReader **reader = &work->readers[thread];
    if (work->code)
        return;
    int code = *reader ? RETEX_OK : retex_row_reader_open(reader, work->set, &work->errors[thread]);
    for (int part = 0; !code && part < work->set->nparts; part++)
        if (is_chosen(work, part))
            code = read_strip(work, *reader, part, strip, &work->errors[thread]);
    if (code)
        atomic_store(&work->code, code);
}

static int read_all(Floor *work, int threads, RetexError *err)
{
    const int nstrips = (work->set->height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP;
    for (work->is_small = 1; !work->code && work->is_small >= 0; work->is_small--)
        retex_parallel(threads, nstrips, read_job, work);
    for (int i = 0; i < threads; i++) {
        retex_row_reader_close(&work->readers[i]);
        if (work->code && work->errors[i].code)
            *err = work->errors[i];
    }
    return work->code;
}

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    const int threads = retex_threads(argc > 2 ? atoi(argv[2]) : 0);
    double bytes = 0;
    int parts = 0;

    if (argc < 2) {
        fprintf(stderr, "usage: post_floor SET [THREADS]\n");
        return 2;
    }
    int code = retex_set_open(argv[1], &set, threads, &err);
    if (!code) {
        Floor work = {.set = set,
                      .wanted = calloc((size_t)set->nparts + 1, 1),
                      .errors = calloc((size_t)threads, sizeof *work.errors),
                      .readers = calloc((size_t)threads, sizeof *work.readers)};
        code = work.wanted && work.errors && work.readers ? RETEX_OK : retex_fail(&err, RETEX_ENOMEM, "no memory");
        if (!code)
            choose(&work);
        if (!code)
            code = read_all(&work, threads, &err);
        for (int i = 0; !code && i < set->nparts; i++)
            if (work.wanted[i]) {
                parts++;
                bytes += sizeof(float) * (double)retex_image_index(&set->parts[i].image, 0, set->parts[i].image.height);
            }
        free(work.wanted);
        free(work.errors);
        free(work.readers);
    }
    if (code)
        fprintf(stderr, "post_floor: %s: %s\n", argv[1], err.message);
    else
        printf("%d parts, %.0f bytes\n", parts, bytes);
    retex_set_close(&set);
    return code ? 2 : 0;
}
