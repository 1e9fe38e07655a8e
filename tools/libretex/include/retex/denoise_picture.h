/* Denoising a picture that is no set: an EXR file of any renderer. Its layers are filtered as sets are, by the noise
 * that a second render, a variance or the picture itself tells, with its normals, albedo and positions as guides. */
#ifndef RETEX_DENOISE_PICTURE_H
#define RETEX_DENOISE_PICTURE_H

#include <retex/access.h>
#include <retex/denoise.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Told, in the calling thread, what was found and what is assumed: one line. important: 0 for people who ask for
 * details. */
typedef void RetexPictureNote(void *context, int important, const char *text);

/* Names are those of channels without their last letter, such as "ViewLayer.Combined" or only "Combined"; of one
 * channel alone the whole name. Begin with RETEX_DENOISE_PICTURE_INIT. */
typedef struct RetexDenoisePictureParams {
    size_t size;
    const char *const *layers; /* the layers to denoise; default NULL = the picture */
    int nlayers;
    const char *other_half;    /* path of a second render of the same frame, with other random numbers and as many
                                  samples: the result is made of both; NULL, the default: there is none */
    const char *variance;      /* layer with the variance of the mean of each pixel; NULL, the default: none */
    const char *normal, *albedo, *position, *depth; /* layers; NULL, the default: those with well known names */
    const RetexAccess *access; /* which files may be read; NULL, the default = any; accept_damaged: 1 = pixels that are
                                  no numbers become the mean of those around */
    RetexPictureNote *note;    /* NULL, the default = nobody is told */
    void *note_context;
} RetexDenoisePictureParams;
#define RETEX_DENOISE_PICTURE_INIT                                                                                     \
    { sizeof(RetexDenoisePictureParams), NULL, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL }

/* 1 if the file is an EXR without the manifest of a set; of what cannot be read, 0. "-" is not read, and so 0. */
int retex_is_picture(const char *path, const RetexAccess *access);

/* Denoise layers of the EXR file `path` ("-" is standard input) into the EXR file `output` ("-" is standard output).
 * All other channels keep their bits. Where several layers add up to the picture, the picture becomes the sum of the
 * denoised ones. The same to the bit for every nthreads. */
int retex_denoise_picture(const char *path, const char *output,
                          const RetexDenoisePictureParams *picture /* NULL = defaults */,
                          const RetexDenoiseParams *params /* NULL = defaults */, int nthreads, RetexError *err);

/* Read the light groups of an EXR file of Cycles, layers Combined_NAME beside Combined, as the lamps of a set without
 * targets, with what retex_denoise needs; what is of no group is the lamp `rest`. All lamps add up to the picture: rest
 * may be below 0 where the picture was denoised or clamped and the groups were not. `layers` may name the picture;
 * where Blender has denoised it, the default is the one before that, Noisy Image. The set is in memory. */
int retex_set_read_light_groups(RetexSet **set, const char *path,
                                const RetexDenoisePictureParams *picture /* NULL = defaults */,
                                const RetexBudget *budget /* limits the pixels; NULL = no limit */, int nthreads,
                                RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
