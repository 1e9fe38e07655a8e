/* See checkpoints.h. */
#include <unistd.h>
#include "film/bands.h"
#include "render/checkpoints.h"

int pieces_open(RetexSpool **spool, const RenderParams *p, int width, int height, RetexError *err)
{
    if (p->resume)
        return retex_spool_open(spool, width, height, p->key, p->journal, 1, err);
    if (p->spooled || p->nshards || p->nmerged)
        return retex_spool_create(spool, width, height, p->key, p->output, err);
    return RETEX_OK;
}

/* The bands of one file that a shard left. */
static int merge_file(RetexSpool *spool, RetexSpool *from, int bands, const char *path, RetexError *err)
{
    int code = RETEX_OK;
    for (int band = 0; band < bands && !code; band++) {
        if (!retex_spool_committed(from, band))
            continue;
        code = retex_spool_committed(spool, band)
                   ? retex_fail(err, RETEX_EINVAL, "%s has rows that another file of --merge has too", path)
                   : retex_spool_copy_band(spool, from, band, err);
    }
    return code;
}

int pieces_merge(RetexSpool *spool, const RenderParams *p, int width, int height, RetexError *err)
{
    int code = RETEX_OK, missing = 0, bands = (height + BAND_LINES - 1) / BAND_LINES;
    for (int k = 0; k < p->nmerged && !code; k++) {
        RetexSpool *from = NULL;
        code = retex_spool_open(&from, width, height, p->key, p->merged[k], 0, err);
        if (!code)
            code = merge_file(spool, from, bands, p->merged[k], err);
        retex_spool_close(&from);
    }
    for (int band = 0; band < bands && p->nmerged; band++)
        missing += !retex_spool_committed(spool, band);
    if (!code && missing)
        code = retex_fail(err, RETEX_EINVAL,
                          "--merge: %d of %d bands are in none of the files: a shard is missing or damaged", missing,
                          bands);
    return code;
}

int pieces_keep(Film *film, const RenderParams *p, RetexError *err)
{
    int done = film_bands_done(film);
    RetexError why;
    retex_budget_hold(p->budget);
    if (p->resume && !done)
        unlink(p->journal);
    if (!p->journal || !done)
        return retex_budget_check(p->budget, err);
    if (!p->resume && film_keep(film, p->key, p->journal, 0, &why))
        return retex_fail(err, RETEX_ESTOPPED, "stopped; what was finished is lost: %s", why.message);
    return retex_fail(err, RETEX_ESTOPPED, "stopped; %d of %d bands are finished and in %s: %s", done, film_bands(film),
                      p->journal, "the same command with --resume goes on");
}
