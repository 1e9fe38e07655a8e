/* Checkpoints: finished bands are kept in a file, and a later render reads them. See checkpoints.h. */
#include <unistd.h>
#include "film/bands.h"
#include "render/checkpoints.h"

int checkpoint_open(RetexBandStore **store, const RenderParams *p, int width, int height, RetexError *err)
{
    if (p->resume)
        return retex_band_store_open(store, width, height, p->key, p->checkpoint, 1, err);
    if (p->stored || p->nshards || p->nmerged)
        return retex_band_store_create(store, width, height, p->key, p->output, err);
    return RETEX_OK;
}

/* Merge the bands of the file of one shard. */
static int merge_file(RetexBandStore *store, RetexBandStore *from, int bands, const char *path, RetexError *err)
{
    int code = RETEX_OK;
    for (int band = 0; band < bands && !code; band++) {
        if (!retex_band_store_committed(from, band))
            continue;
        code = retex_band_store_committed(store, band)
                   ? retex_fail(err, RETEX_EINVAL, "%s has rows that another file of --merge has too", path)
                   : retex_band_store_copy_band(store, from, band, err);
    }
    return code;
}

int checkpoint_merge(RetexBandStore *store, const RenderParams *p, int width, int height, RetexError *err)
{
    int code = RETEX_OK, missing = 0, bands = (height + BAND_LINES - 1) / BAND_LINES;
    for (int k = 0; k < p->nmerged && !code; k++) {
        RetexBandStore *from = NULL;
        code = retex_band_store_open(&from, width, height, p->key, p->merged[k], 0, err);
        if (!code)
            code = merge_file(store, from, bands, p->merged[k], err);
        retex_band_store_close(&from);
    }
    for (int band = 0; band < bands && p->nmerged; band++)
        missing += !retex_band_store_committed(store, band);
    if (!code && missing)
        code = retex_fail(err, RETEX_EINVAL,
                          "--merge: %d of %d bands are in none of the files: a shard is missing or damaged", missing,
                          bands);
    return code;
}

int checkpoint_save(Film *film, const RenderParams *p, RetexError *err)
{
    int done = film_bands_done(film);
    RetexError why;
    retex_budget_hold(p->budget);
    if (p->resume && !done)
        unlink(p->checkpoint);
    if (!p->checkpoint || !done)
        return retex_budget_check(p->budget, err);
    if (!p->resume && film_save(film, p->key, p->checkpoint, 0, &why))
        return retex_fail(err, RETEX_ESTOPPED, "stopped; what was finished is lost: %s", why.message);
    return retex_fail(err, RETEX_ESTOPPED, "stopped; %d of %d bands are finished and in %s: %s", done, film_bands(film),
                      p->checkpoint, "the same command with --resume goes on");
}
