/* Views of a set with some of its parts, for writing. */
#ifndef RETEX_SET_PARTS_H
#define RETEX_SET_PARTS_H

#include "set/set.h"

/* Append a part without pixels and without a source; width 0 = the set's own size. */
int retex_set_add_absent(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int width,
                         int height, int *index, RetexError *err);

/* 1 if a term, footprint, mixture or target refers to the part. */
int retex_part_is_used(const RetexSet *set, int part);

/* 1 if only denoising reads the part: see <retex/host/denoise_data.h>. */
int retex_part_is_denoise_data(const RetexSet *set, int part);

/* Whether a part of that name is noise. */
int retex_name_is_noise(const char *name);
/* Whether a part of that name is a feature. */
int retex_name_is_feature(const char *name);
/* The scale that all present parts of a footprint have; 1 where none is present; 0 where they differ. */
int retex_set_footprint_scale(const RetexSet *set, int footprint);

/* Round a row of a part in memory to what a file holds, so that it does not matter whether it has been in one. */
void retex_part_round_row(RetexPart *part, int y);
/* The same for all parts in memory of the set's height. */
void retex_set_round_to_types(RetexSet *set, int nthreads);

/* The parts of a set that go into a file: arrays of the view's own, pixels borrowed from the set. */
typedef struct RetexSetView {
    RetexSet set;
    int *source; /* part i of the view is part source[i] of the set */
} RetexSetView;

/* in_view[i]: 1 if part i is in it. Targets and footprints refer to -1 where their part is not; parts of terms and
 * mixtures must be there. */
int retex_set_view_make(RetexSetView *view, const RetexSet *set, const char *in_view, RetexError *err);
void retex_set_view_free(RetexSetView *view);

/* Make an image a factor of a term that has all others: the first where it is smaller than the picture, else the
 * last. */
int retex_term_add_image(RetexTerm *term, const RetexSet *set, int part, RetexError *err);

#endif
