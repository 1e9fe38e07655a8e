/* Samples: new textures filtered at the footprints of a set, the first half of a retexture. */
#ifndef RETEX_SAMPLES_H
#define RETEX_SAMPLES_H

#include <retex/set.h>
#include <retex/texture.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Samples are opaque. Sample i is the image of footprint i of the set: RGB, of the size of the footprint's parts. Where
 * the footprint's target keeps its original there is none. Of textures with a map of finishes or normals there are
 * further images, which the calls here do not give: colours times the weights of each finish, and gates. */
typedef struct RetexSamples RetexSamples;

typedef struct RetexSamplesInfo {
    size_t size;       /* sizeof(RetexSamplesInfo): a later version may add members at the end */
    int width, height; /* of the set */
    int nfootprints, ntargets;
} RetexSamplesInfo;

/* Fill what info->size says that the caller knows. */
void retex_samples_get_info(const RetexSamples *samples, RetexSamplesInfo *info);
static inline RetexSamplesInfo retex_samples_info(const RetexSamples *samples)
{
    RetexSamplesInfo info;
    info.size = sizeof info;
    retex_samples_get_info(samples, &info);
    return info;
}
/* Of a target, 0..ntargets-1: its name; its texture in words, for people to read, "" = it keeps its original. They
 * belong to the samples. */
const char *retex_samples_target(const RetexSamples *samples, int target);
const char *retex_samples_texture(const RetexSamples *samples, int target);

/* Create samples of a set without any image: every target keeps its original. */
int retex_samples_create(RetexSamples **samples, const RetexSet *set, RetexError *err);
void retex_samples_close(RetexSamples **samples); /* NULL and pointers to NULL are fine */

/* Filter textures at every footprint of their targets. specs[0..nspecs) name their targets; a target named twice is an
 * error, a target that is not named keeps its original. *samples is created. Where a texture is transparent the
 * footprint's original albedo shows through. Output is the same to the bit for every nthreads. */
int retex_sample(RetexSamples **samples, const RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads,
                 RetexError *err);

/* As retex_sample, with textures that were loaded already, by target, of these specs (see retex_textures_load); of a
 * set that may be open, and with little of set and samples in memory: images as large as the picture go band by band
 * into a band store in the folder of `near`, the file that the samples are for; "-" is standard output. */
int retex_sample_textures(RetexSamples **samples, const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                          const RetexTextureSpec *specs, int nspecs, const char *near, int nthreads, RetexError *err);

/* Move the images of `more` into samples, where they replace those of the same footprints; both must be of the same
 * set. `more` keeps no image and is still the caller's to close. On failure both are as they were. */
int retex_samples_merge(RetexSamples *samples, RetexSamples *more, int nthreads, RetexError *err);

/* Let samples name the file of their set: retex_set_write then writes its absolute path, its size and the checksum of
 * its manifest, which has those of all parts, where it writes samples alone. set is as it was read from, or opened in,
 * that file, which is a regular one. path NULL: name none. */
int retex_samples_refer(RetexSamples *samples, const RetexSet *set, const char *path, RetexError *err);
/* The path of the file that samples name; "" = none. It belongs to the samples. */
const char *retex_samples_set_path(const RetexSamples *samples);

/* 1 if there is an image for that footprint: in memory, in the band store or in the source. */
int retex_samples_have(const RetexSamples *samples, int footprint);
/* Bring all images into memory, and close the band store and the source. */
int retex_samples_load(RetexSamples *samples, int nthreads, RetexError *err);
/* Check that samples were made for this set: same size, targets and footprints. */
int retex_samples_check(const RetexSamples *samples, const RetexSet *set, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
