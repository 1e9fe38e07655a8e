/* Opens packs, and says what is in them. Private to libretex. */
#ifndef RETEX_PACK_OPEN_H
#define RETEX_PACK_OPEN_H

#include <retex/set.h>

#include "io/input.h"

typedef struct RetexPack RetexPack;

/* Open a pack. *set is created; its parts have sizes but no pixels, and the pack is its source. *input belongs to the
 * set from then on, and is NULL. */
int retex_pack_open(RetexSet **set, RetexInput **input, RetexError *err);
RetexPack *retex_pack_of(const RetexSet *set); /* that it was opened from, or NULL */

uint64_t retex_pack_part_bytes(const RetexPack *pack, int part); /* that it takes in the pack */

/* Compare all checksums, those of smaller sets too; the set was opened from it. */
int retex_pack_verify(RetexSet *set, int nthreads, RetexError *err);

#endif
