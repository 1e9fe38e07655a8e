/* A set, one strip of rows after the other, so that it need not fit into memory. Private to libretex. */
#ifndef RETEX_COMPACT_STRIPS_H
#define RETEX_COMPACT_STRIPS_H

#include "compact/light.h"

#define RETEX_COMPACT_STRIP_ROWS 64 /* a multiple of all scales */

/* Process a strip of light->set->height rows; first: the picture's row of its first row. The strip has rows of the
 * parts of the picture's size only. */
typedef int RetexCompactStripJob(void *context, const RetexCompactLight *light, int first, RetexError *err);

/* Call job for all strips, in order. */
int retex_compact_strips(const RetexCompactLight *light, RetexCompactStripJob *job, void *context, int nthreads,
                         RetexError *err);

#endif
