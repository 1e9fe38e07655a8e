/* Checkpoints: finished bands are kept in a file, and a later render reads them. See checkpoints.h. */
#include <stdlib.h>
#include <unistd.h>
#include "film/bands.h"
#include "render/checkpoints.h"

static int count_bands(int height)
{
    return (height + BAND_LINES - 1) / BAND_LINES;
}

/* ---- shards ---- */

int checkpoint_is_in_shard(const RenderParams *p, int band)
{
    return !p->nshards || band % p->nshards == p->shard - 1;
}

/* Check that a file has no rows of another shard. */
static int check_shard(const RetexBandStore *store, const RenderParams *p, int bands, const char *path, RetexError *err)
{
    for (int band = 0; band < bands; band++)
        if (retex_band_store_committed(store, band) && !checkpoint_is_in_shard(p, band))
            return retex_fail(err, RETEX_EINVAL, "%s has rows of another shard: each shard needs an output of its own",
                              path);
    return RETEX_OK;
}

/* Copy the bands that the store does not have. */
static int take_bands(RetexBandStore *store, const RetexBandStore *from, int bands, RetexError *err)
{
    int code = RETEX_OK;
    for (int band = 0; band < bands && !code; band++)
        if (retex_band_store_committed(from, band) && !retex_band_store_committed(store, band))
            code = retex_band_store_copy_band(store, from, band, err);
    return code;
}

/* Open the checkpoint of a shard. It is locked while the shard is rendered: a second render with the same output is
 * refused. A file that is the output already must be of this shard; its bands are taken over. */
static int open_shard(RetexBandStore **store, const RenderParams *p, int width, int height, RetexError *err)
{
    RetexBandStore *from = NULL;
    RetexError why = {0};
    const int bands = count_bands(height);
    int code = RETEX_OK;
    if (access(p->output, F_OK) == 0 && retex_band_store_open(&from, width, height, p->key, p->output, 0, &why))
        return retex_fail(err, why.code, "--shard replaces only an earlier output of the same shard: %s", why.message);
    if (from)
        code = check_shard(from, p, bands, p->output, err);
    if (!code)
        code = retex_band_store_open(store, width, height, p->key, p->checkpoint, 1, err);
    if (!code)
        code = check_shard(*store, p, bands, p->checkpoint, err);
    if (!code && from)
        code = take_bands(*store, from, bands, err);
    retex_band_store_close(&from);
    return code;
}

/* ---- merging ---- */

static int fail_missing(int missing, int bands, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL,
                      "--merge: %d of %d bands are in none of the files: a shard is missing or damaged", missing,
                      bands);
}

/* Note the file, number k + 1, as the owner of its bands. */
static int own_bands(int *owners, const char *committed, const RenderParams *p, int k, int bands, RetexError *err)
{
    for (int band = 0; band < bands; band++) {
        if (committed[band] && owners[band])
            return retex_fail(err, RETEX_EINVAL, "%s and %s have the same rows: is a shard given twice?",
                              p->merged[owners[band] - 1], p->merged[k]);
        if (committed[band])
            owners[band] = k + 1;
    }
    return RETEX_OK;
}

/* Before pixels are read or rendered: check that all files of --merge are of this render, and that together they have
 * each band once. */
static int check_merged(const RenderParams *p, int width, int height, RetexError *err)
{
    const int bands = count_bands(height);
    int *owners = calloc((size_t)bands, sizeof *owners); /* by band: number of the file that has it, 0 = none */
    char *committed = malloc((size_t)bands);
    int code = owners && committed ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory for %d bands", bands);
    int missing = 0;
    for (int k = 0; k < p->nmerged && !code; k++) {
        code = retex_band_store_index(committed, width, height, p->key, p->merged[k], err);
        if (!code)
            code = own_bands(owners, committed, p, k, bands, err);
    }
    for (int band = 0; band < bands && !code; band++)
        missing += !owners[band];
    if (missing)
        code = fail_missing(missing, bands, err);
    free(owners);
    free(committed);
    return code;
}

int checkpoint_merge(RetexBandStore *store, const RenderParams *p, int width, int height, RetexError *err)
{
    int code = RETEX_OK, missing = 0, bands = count_bands(height);
    for (int k = 0; k < p->nmerged && !code; k++) {
        RetexBandStore *from = NULL;
        code = retex_band_store_open(&from, width, height, p->key, p->merged[k], 0, err);
        if (!code)
            code = take_bands(store, from, bands, err);
        retex_band_store_close(&from);
    }
    for (int band = 0; band < bands && p->nmerged; band++)
        missing += !retex_band_store_committed(store, band);
    return code || !missing ? code : fail_missing(missing, bands, err); /* in damaged files, fewer than in the index */
}

/* ---- checkpoints ---- */

int checkpoint_open(RetexBandStore **store, const RenderParams *p, int width, int height, RetexError *err)
{
    *store = NULL;
    if (p->nshards)
        return open_shard(store, p, width, height, err);
    if (p->resume)
        return retex_band_store_open(store, width, height, p->key, p->checkpoint, 1, err);
    int code = p->nmerged ? check_merged(p, width, height, err) : RETEX_OK;
    if (!code && (p->stored || p->nmerged))
        code = retex_band_store_create(store, width, height, p->key, p->output, err);
    if (!code && *store && p->rounded)
        retex_band_store_set_fast(*store);
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
