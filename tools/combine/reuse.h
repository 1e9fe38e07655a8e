/* What rows of a table have in common: textures that several of them put on the same target in the same way. Each is
 * filtered at the footprints of the set once, as far as memory goes. */
#ifndef RETEX_COMBINE_REUSE_H
#define RETEX_COMBINE_REUSE_H

#include <retex/combine.h>
#include <retex/edit.h>

/* A texture that a row has in common with others. */
typedef struct ReuseUse {
    int row, target;
    int texture;
    int next;   /* the next row that has it, or -1 */
    char *text; /* the texture as an edit has it, while the rows are planned */
} ReuseUse;

typedef struct ReusedTexture {
    RetexKeptSamples *samples; /* NULL: none are kept */
    int next;                  /* row that will find them, or -1 */
    uint64_t lacked;           /* bytes that they had lacked before the row that is made */
} ReusedTexture;

/* Zero-initialized. */
typedef struct Reuse {
    ReuseUse *uses; /* by row */
    int nuses, capacity;
    ReusedTexture *textures;
    int ntextures;
    RetexBudget *budget; /* of all samples */
    RetexKeptSamples *kept[RETEX_MAX_TARGETS]; /* of the row that is made, as RetexCombineParams has them */
    uint64_t most_bytes, made, found;          /* of the whole batch */
} Reuse;

/* Add the textures of a row; rows come in order. Then plan: samples may take at most so many bytes. */
int reuse_add_row(Reuse *reuse, const RetexSet *set, int row, const RetexTextureSpec *specs, int count,
                  RetexError *err);
int reuse_plan(Reuse *reuse, uint64_t bytes, RetexError *err);

/* Before and after the picture of a row is made; rows come in order, and some may be left out. */
void reuse_begin(Reuse *reuse, const RetexSet *set, int row);
void reuse_end(Reuse *reuse, int row);
void reuse_close(Reuse *reuse);

#endif
