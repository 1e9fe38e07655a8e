/* What denoising goes by, free of noise: normals, places, colours and cover of what each pixel sees, and of what it
 * sees in mirrors and through clear glass. The parts guide_… of <retex/denoise_data.h>.
 *
 * Paths look as they go: places of a pixel are those of its first samples, and what the camera's ray meets is known. */
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

/* One thread's: sums over the places of the pixel in hand; zeros to begin with. */
typedef struct PixelGuides {
    const DenoiseGuides *of;
    int places, uneven;    /* so far; these do not all see the same */
    Sight first, seen;
    int specular;
    double luminance, luminance_squared; /* of the albedos */
    int primitive, differ; /* the first place's and what it sees; whether others differ */
    Rgb albedo;
    double roughness, metallic;
    double cover[RETEX_MAX_TARGETS];
} PixelGuides;

int denoise_guides_create(DenoiseGuides *guides, Film *film, const FirstHitWindow *window, int split, RetexError *err);

/* What the next place sees, given what a ray from the camera meets: a FirstHitObserver. pixel: PixelGuides. */
int denoise_guides_look(void *pixel, const Ray *ray, const Hit *hit, const Shading *shading);
/* So many more places the pixel wants, at the least. */
int denoise_guides_missing(const PixelGuides *pixel);
/* Look at them where no path does, along up to ACCEL_PACKET rays. */
void denoise_guides_look_along(PixelGuides *pixel, const Ray *rays, int count);
/* Store the pixel's and begin the next. */
void denoise_guides_pixel_end(PixelGuides *pixel, FilmPixel *film, int x, int y);

/* Add the parts to the set that the film became. */
int denoise_guides_finish(const DenoiseGuides *guides, Film *film, RetexSet *set, RetexError *err);

#endif
