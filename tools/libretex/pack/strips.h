/* Packs, strip by strip: any rows of any part, from several threads at once, without unpacking the rest. */
#ifndef RETEX_PACK_STRIPS_H
#define RETEX_PACK_STRIPS_H

#include <retex/set.h>

#include "base/row_span.h"

typedef struct RetexPack RetexPack;

/* A thread's means of decoding, which keep the strip of each part that was met last. */
typedef struct RetexPackScratch RetexPackScratch;
int retex_pack_scratch_create(RetexPackScratch **scratch, const RetexPack *pack, RetexError *err);
void retex_pack_scratch_close(RetexPackScratch **scratch); /* NULL and pointers to NULL are fine */
const RetexPack *retex_pack_of_scratch(const RetexPackScratch *scratch);

/* A part's row y of its own rows, interleaved; NULL where all of it is 0. Beside the span it is 0. It is the scratch's,
 * and stays until the next call for the same part. Strips of 64 rows are decoded whole: cheapest is one row after the
 * other. */
int retex_pack_row(RetexPackScratch *scratch, int part, int y, const float **row, RetexRowSpan *span, RetexError *err);

#endif
