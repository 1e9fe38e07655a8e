/* Recombination: the polynomial of a set evaluated with textures that are laid on it, or given; and its expected
 * error. */
#ifndef RETEX_COMBINE_H
#define RETEX_COMBINE_H

#include <retex/budget.h>
#include <retex/develop.h>
#include <retex/picture.h>
#include <retex/laid.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Samples of one texture on one target, kept from one picture to the next. */
typedef struct RetexKeptSamples RetexKeptSamples;

/* Begin with RETEX_COMBINE_INIT. */
typedef struct RetexCombineParams {
    size_t size;
    int cross;  /* highest hit count whose cross terms are used: 0, 2 or 3 (default); the supplement's ablation */
    int y0, y1; /* retex_retexture and retex_estimate_error make only rows y0 <= y < y1; default 0, 0 = all */
    int x0, x1; /* and of these only x0 <= x < x1, the rest is 0 or its value; default 0, 0 = all */
    const float *parameters; /* the value of each parameter of the set, three numbers each, scene-linear, not negative;
                                those of kind CORRECTION are not read. Default NULL: as rendered */
    int terms_only; /* 1: the sum of terms, though part 0 may be the result, see RETEX_ROLE_PICTURE; default 0 */
    const RetexDevelop *develop; /* borrowed: how the picture is developed; retex_estimate_error does not read it.
                                    Default NULL: not at all */
    RetexKeptSamples *const *kept; /* RETEX_MAX_TARGETS of them, by target, NULL where none are kept: for the texture
                                    that the call has there; no other call may use them meanwhile. Default NULL:
                                    none at all */
} RetexCombineParams;
#define RETEX_COMBINE_INIT                                                                                             \
    {                                                                                                                  \
        sizeof(RetexCombineParams), 3, 0, 0, 0, 0, NULL, 0, NULL, NULL                                                 \
    }

/* dst (RGB, the set's size) = sum of terms times factors. A target on which no texture is laid keeps its original.
 * The beauty part is read only where nothing is edited and a term of role PICTURE says that it is the result. */
int retex_combine(RetexImage *dst, const RetexSet *set, const RetexCombineParams *params /* NULL = defaults */,
                  const RetexRoi *roi /* NULL = all */, int nthreads /* 0 = all cores */, RetexError *err);

/* Load textures for a set's targets: textures[t], NULL where target t is given none. specs name their targets, each at
 * most once; the set must hold these targets' footprints. To be closed by the caller, also after a failure. */
int retex_textures_load(RetexTexture *textures[RETEX_MAX_TARGETS], const RetexSet *set, const RetexTextureSpec *specs,
                        int nspecs, int nthreads, RetexError *err);
/* Check textures against a set before anything is read: their targets and what they need of them. */
int retex_textures_check(const RetexSet *set, const RetexTextureSpec *specs, int nspecs, RetexError *err);
/* Put a texture that was loaded for a target of another set on this target, without reading it again. */
int retex_textures_move(RetexTexture *texture, const RetexSet *set, int target, RetexError *err);
/* Put the image of a texture on a target in another way: *placed has the placement of spec, whose target it names, and
 * shares the texels of `texture`, which must be closed later. RETEX_EINVAL where spec needs other texels: another image
 * or colour space, another wrap mode, another kind of repeats. */
int retex_textures_place(RetexTexture **placed, const RetexTexture *texture, const RetexSet *set,
                         const RetexTextureSpec *spec, RetexError *err);
void retex_textures_close(RetexTexture *textures[RETEX_MAX_TARGETS]);

/* Receives rows y0 <= y < y1 of a picture, RGB interleaved; y0 is a multiple of RETEX_PICTURE_STRIP, y1 the next one or
 * the picture's height; where only some rows are made, also the first and the last of these. Called from several
 * threads at once, in any order; returns 0 or a negative RetexCode. */
typedef int RetexRowSink(void *context, int y0, int y1, const float *rows, RetexError *err);

/* A RetexRowSink that keeps the rows: context is a RetexImage, RGB of the picture's size. */
int retex_image_keep_rows(void *image, int y0, int y1, const float *rows, RetexError *err);

/* Sampling and recombination in one pass, strip by strip. The rows are those that retex_combine would give after
 * retex_sample had laid these textures on the set, which stays as it is. */
int retex_retexture(const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                    const RetexCombineParams *params /* NULL = defaults */, RetexRowSink *sink, void *context,
                    int nthreads /* 0 = all cores */, RetexError *err);

/* Keep samples of one texture on a target of the set, empty at first: each row of a footprint that a call with them in
 * its params filters is kept if the budget has the memory, and found by later calls, whose pictures are the same to the
 * bit. The caller has others for another texture, and for the same one in another placement. The set must stay as it is
 * until they are closed. budget may be NULL: no limit. */
int retex_kept_samples_create(RetexKeptSamples **kept, const RetexSet *set, int target, RetexBudget *budget,
                              RetexError *err);
void retex_kept_samples_close(RetexKeptSamples **kept); /* NULL and pointers to NULL are fine */

typedef struct RetexKeptSamplesInfo {
    size_t size;     /* sizeof(RetexKeptSamplesInfo): a later version may add members at the end */
    uint64_t bytes;  /* what the budget is charged with */
    uint64_t lacked; /* bytes of rows that were filtered and for which it had no memory */
    uint64_t made, found; /* rows that were filtered, and that were found, so far */
} RetexKeptSamplesInfo;
/* Fill what info->size says that the caller knows. */
void retex_kept_samples_get_info(const RetexKeptSamples *kept, RetexKeptSamplesInfo *info);

/* The exposure, in stops, that brings the log-average luminance of the whole picture that retex_retexture makes, before
 * it is developed, to 0.18, the reflectance of a grey card: the geometric mean over its pixels that are not black, as
 * in Reinhard, Stark, Shirley and Ferwerda, 'Photographic Tone Reproduction for Digital Images' (2002), Eq. 1. 0 where
 * all are black; within RETEX_EXPOSURE_MAX. It takes as long as making the picture. */
int retex_auto_exposure(double *exposure, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                        const RetexCombineParams *params /* NULL = defaults */, int nthreads /* 0 = all cores */,
                        RetexError *err);

/* The expected error of what retex_retexture makes of the same arguments, as rows of a picture: the standard deviation,
 * per channel and scene-linear, of the difference to rendering again with these textures at the set's sample count. It
 * is computed from the variance of the textures within the footprints, the light that multiplies them there, and the
 * light with more hits than the set keeps; targets without a texture add no error. */
int retex_estimate_error(const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                         const RetexCombineParams *params /* NULL = defaults */, RetexRowSink *sink, void *context,
                         int nthreads /* 0 = all cores */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
