/* A set with some of its parts, for writing. */
#ifndef RETEX_SET_PARTS_H
#define RETEX_SET_PARTS_H

#include <retex/set.h>

/* Whether a term, footprint, mixture or target names the part. */
int retex_part_is_used(const RetexSet *set, int part);

/* Whether only denoising reads the part: see <retex/denoise.h>. */
int retex_part_is_denoise_data(const RetexSet *set, int part);

/* What of a set goes into a file: arrays of its own, the pixels borrowed. */
typedef struct RetexSetView {
    RetexSet set;
    int *source; /* part i of the view is part source[i] of the set */
} RetexSetView;

/* kept[i]: whether part i is in it. Targets and footprints refer to -1 where a part is not; those of terms and mixtures
 * must be in it. */
int retex_set_view_make(RetexSetView *view, const RetexSet *set, const char *kept, RetexError *err);
void retex_set_view_free(RetexSetView *view);

#endif
