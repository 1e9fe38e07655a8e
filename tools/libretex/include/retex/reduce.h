/* Smaller sets: for pictures that are smaller than the set. */
#ifndef RETEX_REDUCE_H
#define RETEX_REDUCE_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Make a set of ceil(width / scale) x ceil(height / scale) pixels, each of which stands for a block of scale x scale of
 * the set's: what light is in the block, and where it met the targets. Pictures made of it are about those of the set,
 * averaged over blocks. scale: 2, 3, 4, 6 or 8. The set is one of layout footprints, as retex-render and retex-denoise
 * write it, or of layout plain; RETEX_EUNSUPPORTED where it is of layout paper, or compact, as that of a pack. It may
 * be in a file (retex_set_open), from which strips of rows are read; the smaller one is in memory. It has what
 * recombination reads, and no data for denoising. */
int retex_set_reduce(RetexSet **reduced, const RetexSet *set, int scale, int nthreads /* 0 = all cores */,
                     RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
