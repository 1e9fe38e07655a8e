/* Building sets: for renderers, and for whatever else makes a set of something that is none. <retex/set.h> says what a
 * set is, retex-set(5) what files of sets hold. */
#ifndef RETEX_HOST_SET_BUILD_H
#define RETEX_HOST_SET_BUILD_H

#include <retex/host/band_store.h>
#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Create a set without anything. Its first part has to be the beauty: "beauty", "RGB", RETEX_FLOAT. */
int retex_set_create(RetexSet **set, int width, int height, RetexError *err);
/* Take over what info says of the set as a whole, but for its size, id and counts: to be changed in a copy that
 * retex_set_info made. */
int retex_set_describe(RetexSet *set, const RetexSetInfo *info, RetexError *err);
/* Append a part; *index (may be NULL) receives its number. The image is allocated and zeroed; width 0 = the set's own
 * size. */
int retex_set_add_part(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int width, int height,
                       int *index, RetexError *err);
/* Append a part whose pixels are in a band store, under the same name, letters and type. Its rows are read from there
 * once retex_set_take_store has been called. */
int retex_set_add_stored(RetexSet *set, const char *name, const char *letters, RetexPixelType type, int image,
                         int *index, RetexError *err);
/* Let this be the band store of all parts that were appended without pixels since the last call. The set owns it from
 * now on, also after a failure; NULL: there is none. */
int retex_set_take_store(RetexSet *set, RetexBandStore *store, RetexError *err);
/* The image of a part, whose pixels a renderer writes, or exchanges for others of the same size. */
RetexImage *retex_set_mutable_image(RetexSet *set, int part);
/* A target whose UV ranges and so on become known later than its name. */
RetexTarget *retex_set_mutable_target(RetexSet *set, int target);
/* Append a copy; *index (may be NULL) receives its number. */
int retex_set_add_target(RetexSet *set, const RetexTarget *target, int *index, RetexError *err);
int retex_set_add_footprint(RetexSet *set, const RetexFootprint *footprint, int *index, RetexError *err);
int retex_set_add_mixture(RetexSet *set, const RetexMixture *mixture, int *index, RetexError *err);
int retex_set_add_parameter(RetexSet *set, const RetexParameter *parameter, int *index, RetexError *err);
/* Append a factor; RETEX_ELIMIT where there are too many. The index is checked by retex_set_add_term. */
int retex_term_add_factor(RetexTerm *term, RetexFactor factor, RetexError *err);
int retex_set_add_term(RetexSet *set, const RetexTerm *term, int *index, RetexError *err);
/* The same of a correction of term->target, which gets the parameter of that target as its last factor. The parameter
 * is added with the target's first correction. */
int retex_set_add_correction(RetexSet *set, const RetexTerm *term, int *index, RetexError *err);
/* Find the set's further_hits and further_ratio from the light of the terms that have a factor of quantity FURTHER, and
 * of those with one hit less; before it is rounded or filtered. max_depth is known. */
int retex_set_find_further(RetexSet *set, RetexError *err);
/* Remove a part to which no term, footprint, mixture or target refers; later parts move up, and references follow. */
void retex_set_remove_part(RetexSet *set, int part);
/* Remove all that is empty; empty[i]: 1 if part i is 0 everywhere. Footprints without UV are removed with their parts,
 * their shares in mixtures, and mixtures that lose all shares; a mixture of one share becomes that footprint. Terms
 * with hits are removed if their radiance or an image is empty, and noise parts of signals without terms. Parts that
 * something else refers to stay. All else keeps its order. */
void retex_set_prune(RetexSet *set, const char *empty);
/* Remove the terms and parameters of lamps, with the noise of their light: the set is as if rendered without them.
 * RETEX_EINVAL where a lamp is off in the picture, as it is on in all other terms. The set is in memory. */
int retex_set_drop_lamps(RetexSet *set, RetexError *err);
/* Round all numbers of a rendered set to what they are known to, by its noise parts; by less, if it has none: see
 * retex-set(5). Parts that are in a band store go into another one, which lies near the path `near` (NULL: in $TMPDIR
 * or /tmp). The set is in memory or in its band store. Sets without terms stay as they are. */
int retex_set_round(RetexSet *set, const char *near, int nthreads, RetexError *err);
/* Compute the set's id from its beauty's pixels: the renderer's last step. */
void retex_set_identify(RetexSet *set);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
