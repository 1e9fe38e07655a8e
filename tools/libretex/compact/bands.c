/* Reads a set band by band. See bands.h. */
#include "compact/bands.h"

#include "set/band.h"
#include "set/set.h"

int retex_compact_bands(const RetexCompactLight *light, RetexCompactBandJob *job, void *context, int nthreads,
                        RetexError *err)
{
    const int height = light->set->height;
    RetexCompactLight band = *light;
    RetexSetBand *rows;
    int code = retex_set_band_open(&rows, light->set, RETEX_COMPACT_BAND_ROWS, 0, err);
    for (int y = 0; y < height && !code; y += RETEX_COMPACT_BAND_ROWS) {
        RetexSet *set;
        code = retex_set_band_load(
            &set, rows, y, height - y < RETEX_COMPACT_BAND_ROWS ? height - y : RETEX_COMPACT_BAND_ROWS, nthreads, err);
        band.set = set;
        if (!code)
            code = job(context, &band, y, err);
    }
    retex_set_band_close(&rows);
    return code;
}
