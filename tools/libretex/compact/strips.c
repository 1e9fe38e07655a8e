/* Reads a set strip by strip. See strips.h. */
#include "compact/strips.h"

#include "set/strip.h"
#include "set/set.h"

int retex_compact_strips(const RetexCompactLight *light, RetexCompactStripJob *job, void *context, int nthreads,
                         RetexError *err)
{
    const int height = light->set->height;
    RetexCompactLight strip = *light;
    RetexSetStrip *rows;
    int code = retex_set_strip_open(&rows, light->set, RETEX_COMPACT_STRIP_ROWS, 0, err);
    for (int y = 0; y < height && !code; y += RETEX_COMPACT_STRIP_ROWS) {
        RetexSet *set;
        code = retex_set_strip_load(&set, rows, y,
                                    height - y < RETEX_COMPACT_STRIP_ROWS ? height - y : RETEX_COMPACT_STRIP_ROWS,
                                    nthreads, err);
        strip.set = set;
        if (!code)
            code = job(context, &strip, y, err);
    }
    retex_set_strip_close(&rows);
    return code;
}
