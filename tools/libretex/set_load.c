/* From a set's spool, or from the pack it was opened from, into memory. */
#include <stdlib.h>

#include <retex/parallel.h>
#include <retex/set.h>

#include "pack_bands.h"

typedef struct LoadJob {
    RetexSet *set;
    int *codes; /* by part */
    RetexError *errors;
} LoadJob;

static void load_part(void *context, int index, int thread)
{
    LoadJob *job = context;
    RetexPart *part = &job->set->parts[index];

    (void)thread;
    if (!part->spooled)
        return;
    RetexImage loaded = {0};
    job->codes[index] = retex_spool_load(job->set->spool, part->spooled - 1, &loaded, &job->errors[index]);
    if (job->codes[index])
        return;
    part->image = loaded;
    part->spooled = 0;
}

int retex_set_load(RetexSet *set, int nthreads, RetexError *err)
{
    if (set->pack)
        return retex_pack_load(set, nthreads, err);
    LoadJob job = {set, calloc((size_t)set->nparts + 1, sizeof *job.codes),
                   calloc((size_t)set->nparts + 1, sizeof *job.errors)};
    int code = job.codes && job.errors ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to load a set");

    if (!code && set->spool)
        retex_parallel(nthreads, set->nparts, load_part, &job);
    for (int i = 0; !code && i < set->nparts; i++)
        if (job.codes[i])
            code = retex_fail(err, job.codes[i], "%s", job.errors[i].message);
    free(job.codes);
    free(job.errors);
    if (!code)
        retex_spool_close(&set->spool);
    return code;
}
