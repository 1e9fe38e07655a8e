/* Packs, strip by strip: any rows of any part, from several threads at once, without unpacking the rest. */
#ifndef RETEX_PACK_STRIPS_H
#define RETEX_PACK_STRIPS_H

#include <retex/set.h>

#include "io/input.h"
#include "base/row_span.h"

typedef struct RetexPack RetexPack; /* an open pack: read-only, shared by threads */

/* Open a pack. *set is created; its parts have sizes but no pixels, and the pack is its source. *input belongs to the
 * set from then on, and is NULL. */
int retex_pack_open(RetexSet **set, RetexInput **input, RetexError *err);
RetexPack *retex_pack_of(const RetexSet *set); /* that it was opened from, or NULL */
void retex_pack_close(RetexPack **pack);       /* NULL and pointers to NULL are fine */

/* A thread's means of decoding, which keep the strip of each part that was met last. */
typedef struct RetexPackScratch RetexPackScratch;
int retex_pack_scratch_create(RetexPackScratch **scratch, const RetexPack *pack, RetexError *err);
void retex_pack_scratch_close(RetexPackScratch **scratch); /* NULL and pointers to NULL are fine */

/* A part's row y of its own rows, interleaved; NULL where all of it is 0. Beside the span it is 0. It is the scratch's,
 * and stays until the next call for the same part. Strips of 64 rows are decoded whole: cheapest is one row after the
 * other. */
int retex_pack_row(RetexPackScratch *scratch, int part, int y, const float **row, RetexRowSpan *span, RetexError *err);

/* Bytes that a part takes in the pack, and how it is coded: "jpeg", "planes", … */
uint64_t retex_pack_part_bytes(const RetexPack *pack, int part);
const char *retex_pack_part_codec(const RetexPack *pack, int part);

/* Compare all checksums, those of smaller sets too; the set was opened from it. */
int retex_pack_verify(RetexSet *set, int nthreads, RetexError *err);

#endif
