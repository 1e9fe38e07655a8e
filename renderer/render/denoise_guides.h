/* The features that denoising is guided by, free of noise: normals, positions, albedos and target coverage of the
 * surfaces that each pixel sees, directly and in mirrors and through clear glass. They are the parts guide_… of
 * <retex/host/denoise_data.h>.
 *
 * They are averages over sample points of the pixel: paths report what their camera rays hit (FirstHitObserver). */
#ifndef RENDERER_RENDER_DENOISE_GUIDES_H
#define RENDERER_RENDER_DENOISE_GUIDES_H

#include <retex/host/denoise_data.h>
#include "film/film.h"
#include "path/shading.h"
#include "render/first_hit.h"

/* Sample points of a pixel, and as many more as it needs where they do not all see the same. Powers of 2, because such
 * numbers of samples are well distributed. */
enum { GUIDE_SAMPLES = 16, GUIDE_SAMPLES_QUICK = 4 };

typedef struct DenoiseGuides {
    FirstHitWindow window;
    int samples;
    int split; /* 1: the set is for retexturing, so that the albedo of targets is unknown */
    int guides[RETEX_FEATURE_COUNT], covers[RETEX_MAX_TARGETS]; /* images of the film */
} DenoiseGuides;

/* One thread's sums over the sample points of a pixel. */
typedef struct PixelGuides PixelGuides;

/* samples: one of GUIDE_SAMPLES…. */
int denoise_guides_create(DenoiseGuides *guides, Film *film, const FirstHitWindow *window, int split, int samples,
                          RetexError *err);

/* An array of so many. */
int pixel_guides_create(PixelGuides **pixels, int count, const DenoiseGuides *guides, RetexError *err);
void pixel_guides_close(PixelGuides **pixels);
PixelGuides *pixel_guides_at(PixelGuides *pixels, int k);

/* Add a sample point by the first hit of its camera ray: a FirstHitObserver. pixel: PixelGuides. */
int denoise_guides_observe(void *pixel, const Ray *ray, const Hit *hit, const Shading *shading);
/* How many more sample points the pixel needs. */
int denoise_guides_missing(const PixelGuides *pixel);
/* Add sample points without paths: trace up to ACCEL_PACKET camera rays. */
void denoise_guides_trace(PixelGuides *pixel, const Ray *rays, int count);
/* Store the averages of the pixel and begin the next pixel. */
void denoise_guides_pixel_end(PixelGuides *pixel, FilmPixel *film, int x, int y);

/* Add the parts to the set that the film became. */
int denoise_guides_finish(const DenoiseGuides *guides, Film *film, RetexSet *set, RetexError *err);

#endif
