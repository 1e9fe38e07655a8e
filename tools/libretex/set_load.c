/* From a set's spool or source into memory. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>
#include <retex/set.h>

#include "manifest.h"
#include "rows.h"
#include "set_source.h"

#define ROWS_A_JOB 64 /* a pack's band, some of a spool's */

typedef struct LoadJob {
    RetexSet *set;
    const char *wanted; /* by part */
    RetexImage *loaded; /* by part */
    int blocks;         /* a part, at most */
    atomic_int code;
    RetexError *errors; /* by thread */
} LoadJob;

static int load_rows(LoadJob *job, int part, int y0, int y1, RetexError *err)
{
    RetexImage *image = &job->loaded[part];
    RowReader *reader;
    int code = row_reader_open(&reader, job->set, err);
    for (int y = y0; !code && y < y1; y++) {
        const float *row;
        code = row_reader_get(reader, part, y, &row, err);
        if (!code && row)
            memcpy(image->pixels + retex_image_index(image, 0, y), row,
                   sizeof *row * (size_t)image->width * (size_t)image->channels);
    }
    row_reader_close(&reader);
    return code;
}

static void load_job(void *context, int index, int thread)
{
    LoadJob *job = context;
    const int part = index / job->blocks, y0 = index % job->blocks * ROWS_A_JOB;
    const RetexPart *p = &job->set->parts[part];
    int code = 0;

    if (job->code || !job->wanted[part] || p->image.pixels || y0 >= p->image.height)
        return;
    code = load_rows(job, part, y0, y0 + ROWS_A_JOB < p->image.height ? y0 + ROWS_A_JOB : p->image.height,
                     &job->errors[thread]);
    if (code)
        atomic_store(&job->code, code);
}

static int prepare(LoadJob *job, RetexError *err)
{
    int code = job->loaded && job->errors ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to load a set");

    for (int i = 0; !code && i < job->set->nparts; i++) {
        const RetexPart *part = &job->set->parts[i];
        const int blocks = (part->image.height + ROWS_A_JOB - 1) / ROWS_A_JOB;
        job->blocks = blocks > job->blocks ? blocks : job->blocks;
        if (job->wanted[i] && !part->image.pixels)
            code = retex_image_alloc(&job->loaded[i], part->image.width, part->image.height, part->image.channels, err);
    }
    return code;
}

static int load(RetexSet *set, const char *wanted, int nthreads, RetexError *err)
{
    const int threads = retex_threads(nthreads);
    LoadJob job = {.set = set,
                   .wanted = wanted,
                   .loaded = calloc((size_t)set->nparts + 1, sizeof *job.loaded),
                   .blocks = 1,
                   .errors = calloc((size_t)threads, sizeof *job.errors)};
    int code = prepare(&job, err);

    if (!code && (set->spool || set->source))
        retex_parallel(threads, set->nparts * job.blocks, load_job, &job);
    for (int i = 0; !code && job.code && i < threads; i++)
        if (job.errors[i].code) {
            code = job.errors[i].code;
            if (err)
                *err = job.errors[i];
        }
    for (int i = 0; job.loaded && i < set->nparts; i++) {
        if (code)
            retex_image_free(&job.loaded[i]);
        else if (wanted[i] && !set->parts[i].image.pixels)
            set->parts[i].image = job.loaded[i], set->parts[i].spooled = 0;
    }
    free(job.loaded);
    free(job.errors);
    return code;
}

int retex_set_load(RetexSet *set, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX];

    /* the picture last: a pack may make it from the other parts, which then need not be decoded twice */
    memset(wanted, 1, sizeof wanted);
    wanted[0] = 0;
    int code = load(set, wanted, nthreads, err);
    wanted[0] = 1;
    if (!code)
        code = load(set, wanted, nthreads, err);
    if (code)
        return code;
    retex_spool_close(&set->spool);
    if (set->source)
        set->source->close(set->source);
    set->source = NULL;
    return 0;
}

static uint64_t part_bytes(const RetexSet *set, int part)
{
    return sizeof(float) * retex_image_index(&set->parts[part].image, 0, set->parts[part].image.height);
}

uint64_t retex_set_bytes(const RetexSet *set)
{
    uint64_t bytes = 0;

    for (int i = 0; i < set->nparts; i++)
        bytes += part_bytes(set, i);
    return bytes;
}

static void want(char *wanted, int part)
{
    if (part >= 0)
        wanted[part] = 1;
}

int retex_set_keep(RetexSet *set, uint64_t most_bytes, int nthreads, RetexError *err)
{
    char wanted[RETEX_SET_PARTS_MAX] = {0};
    uint64_t bytes = 0;

    for (int i = 0; i < set->nterms; i++) {
        want(wanted, set->terms[i].radiance);
        want(wanted, set->terms[i].gain ? set->terms[i].gain : -1);
    }
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            want(wanted, set->mixtures[i].shares[k].weight);
    for (int i = 0; i < set->nfootprints; i++) {
        want(wanted, set->footprints[i].uv);
        want(wanted, set->footprints[i].spread);
        want(wanted, set->footprints[i].albedo);
    }
    for (int i = 0; i < set->nparts; i++)
        if (wanted[i])
            bytes += part_bytes(set, i);
    return bytes > most_bytes ? 0 : load(set, wanted, nthreads, err);
}
