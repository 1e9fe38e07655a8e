/* Packs of version 1, which are still read. */
#ifndef RETEX_PACK_V1_H
#define RETEX_PACK_V1_H

#include "pack/zip.h"
#include <retex/set.h>

/* Decode all parts of a set that the manifest described: they have sizes, and get pixels. */
int pack_v1_read(RetexSet *set, const RetexInput *input, const ZipList *entries, const char *manifest, int nthreads,
                 RetexError *err);

#endif
