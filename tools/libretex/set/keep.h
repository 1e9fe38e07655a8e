/* Brings rows of parts out of their sources, into memory or into a band store. Private to libretex. */
#ifndef RETEX_SET_KEEP_H
#define RETEX_SET_KEEP_H

#include <retex/host/band_store.h>

#include "set/set.h"

/* Bring the parts that are wanted (wanted[i]: 1) and have no pixels out of their sources: into memory or, those of the
 * picture's size, into the band store; store NULL: all into memory. What is in memory keeps its source beside. The
 * parts own the store then; it is closed if none needs it, and after a failure, when all parts are as they were. */
int retex_set_keep(RetexSet *set, const char *wanted, RetexBandStore *store, int nthreads, RetexError *err);

#endif
