/* Checkpoints: finished bands are kept in a file, and a later render reads them. See checkpoints.h. */
#include <unistd.h>
#include "render/checkpoints.h"

int checkpoint_open(RetexBandStore **store, const RenderParams *p, int width, int height, RetexError *err)
{
    *store = NULL;
    if (p->resume)
        return retex_band_store_open(store, width, height, p->key, p->checkpoint, err);
    if (!p->stored)
        return RETEX_OK;
    int code = retex_band_store_create(store, width, height, p->key, p->output, err);
    if (!code && p->rounded)
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
    if (!p->resume && film_save(film, p->key, p->checkpoint, &why))
        return retex_fail(err, RETEX_ESTOPPED, "stopped; what was finished is lost: %s", why.message);
    return retex_fail(err, RETEX_ESTOPPED, "stopped; %d of %d bands are finished and in %s: %s", done, film_bands(film),
                      p->checkpoint, "the same command with --resume goes on");
}
