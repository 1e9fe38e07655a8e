/* Blocks of pixels that become pixels. Private to libretex. */
#ifndef RETEX_REDUCE_BLOCK_H
#define RETEX_REDUCE_BLOCK_H

#include "reduce/plan.h"

#define RETEX_REDUCE_SIDE 8 /* pixels of a block's side, at most */

typedef struct RetexReduceScratch RetexReduceScratch;  /* one for each thread */
RetexReduceScratch *retex_reduce_scratch_create(void); /* NULL: no memory */

/* A block: pixels of `rows`, some rows of the set, and the pixel of the reduced set that they become. */
typedef struct RetexReduceBlock {
    const RetexReducePlan *plan;
    const RetexSet *rows;
    int x, y, width, height; /* in rows; 1 to RETEX_REDUCE_SIDE a side */
    size_t to;               /* number of the pixel in the reduced set */
} RetexReduceBlock;

/* Compute all of the reduced pixel. */
void retex_reduce_block(const RetexReduceBlock *block, RetexReduceScratch *scratch);

#endif
