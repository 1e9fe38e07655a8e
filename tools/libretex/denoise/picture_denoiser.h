/* Denoisers of other makers, which filter whole pictures. To add one: a file that defines a RetexPictureDenoiser, its
 * declaration here, and rows of the table in totals.c. Private to libretex. */
#ifndef RETEX_DENOISE_PICTURE_DENOISER_H
#define RETEX_DENOISE_PICTURE_DENOISER_H

#include <retex/budget.h>

/* Images of three floats a pixel, rows from the top without gaps. */
typedef struct RetexDenoiserImages {
    int width, height;
    const float *color;  /* noisy light, scene-linear, finite */
    const float *albedo; /* what it is multiplied by as far as that is known, 0..1 */
    const float *normal; /* of the surface that is seen, or 0 */
    float *result;       /* color without noise */
} RetexDenoiserImages;

typedef struct RetexPictureDenoiser {
    const char *name; /* for messages */
    /* Start, for any number of pictures. budget: may stop it, and has the memory that it may use; NULL = no limits. */
    int (*open)(void **state, int nthreads, const RetexBudget *budget, RetexError *err);
    int (*filter)(void *state, const RetexDenoiserImages *images, RetexError *err);
    void (*close)(void **state); /* NULL and pointers to NULL are fine */
} RetexPictureDenoiser;

/* Open Image Denoise 2. */
extern const RetexPictureDenoiser retex_oidn;

#endif
