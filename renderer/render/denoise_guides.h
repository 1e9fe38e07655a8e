/* The features that denoising is guided by, free of noise: normals, positions, albedos and target coverage of the
 * surfaces that each pixel sees, directly and in mirrors and through clear glass. They are the parts guide_… of
 * <retex/denoise_data.h>.
 *
 * Places of a pixel are those of its first samples: paths report what their camera rays meet (FirstHitObserver). */
#ifndef RENDERER_RENDER_DENOISE_GUIDES_H
#define RENDERER_RENDER_DENOISE_GUIDES_H

#include <retex/denoise_data.h>
#include "film/film.h"
#include "path/shading.h"
#include "render/first_hit.h"

typedef struct DenoiseGuides {
    FirstHitWindow window;
    int split;          /* what lies on targets is not known */
    int guides[RETEX_FEATURE_COUNT], covers[RETEX_MAX_TARGETS]; /* images of the film */
} DenoiseGuides;

/* Sums over those places of a pixel that see anything. */
typedef struct Sight {
    int places;
    Vec3 normal, position;
} Sight;

/* One thread's sums over the places of the current pixel; begin with zeros. */
typedef struct PixelGuides {
    const DenoiseGuides *of;
    int places, uneven;    /* so far; uneven: they do not all see the same */
    Sight first, seen;
    int specular;
    double luminance, luminance_squared; /* of the albedos */
    int primitive, differ; /* that the first place sees; whether others see another one */
    Rgb albedo;
    double roughness, metallic;
    double cover[RETEX_MAX_TARGETS];
} PixelGuides;

int denoise_guides_create(DenoiseGuides *guides, Film *film, const FirstHitWindow *window, int split, RetexError *err);

/* Add a place, given what its camera ray meets: a FirstHitObserver. pixel: PixelGuides. */
int denoise_guides_look(void *pixel, const Ray *ray, const Hit *hit, const Shading *shading);
/* How many more places the pixel needs. */
int denoise_guides_missing(const PixelGuides *pixel);
/* Add places without paths, along up to ACCEL_PACKET camera rays. */
void denoise_guides_look_along(PixelGuides *pixel, const Ray *rays, int count);
/* Store the pixel's and begin the next. */
void denoise_guides_pixel_end(PixelGuides *pixel, FilmPixel *film, int x, int y);

/* Add the parts to the set that the film became. */
int denoise_guides_finish(const DenoiseGuides *guides, Film *film, RetexSet *set, RetexError *err);

#endif
