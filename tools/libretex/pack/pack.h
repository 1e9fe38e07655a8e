/* An open pack: read-only, shared by threads. Private to what opens and decodes packs. */
#ifndef RETEX_PACK_PACK_H
#define RETEX_PACK_PACK_H

#include "pack/format.h"
#include "pack/zip.h"
#include "set/source.h"

typedef struct RetexPack {
    RetexSetSource methods; /* first */
    RetexInput *input;
    RetexZipList entries;
    RetexPackPart *parts;
    const RetexSet *set; /* that owns it */
    int nparts;
    RetexPackScales levels;
    const RetexZipEntry *level_entries[RETEX_PACK_LEVELS_MAX];
    RetexInput *whole; /* of a smaller set: the pack that it is in; else NULL */
    int has_promise;
    RetexPackPromise promise;
} RetexPack;

#endif
