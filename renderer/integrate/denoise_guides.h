/* What denoising goes by, free of noise: normals, places, colours and cover of what each pixel sees, and of what it
 * sees in mirrors and through clear glass. The parts guide_… of <retex/denoise.h>. */
#ifndef RENDERER_INTEGRATE_DENOISE_GUIDES_H
#define RENDERER_INTEGRATE_DENOISE_GUIDES_H

#include "film/film.h"
#include "integrate/first_hit.h"

enum {
    GUIDE_NORMAL,
    GUIDE_POSITION,
    GUIDE_SPECULAR,
    GUIDE_SEEN_NORMAL,
    GUIDE_SEEN_POSITION,
    GUIDE_SEEN_ALBEDO,
    GUIDE_SEEN_MATERIAL,
    GUIDE_COUNT
};

typedef struct DenoiseGuides {
    FirstHitWindow window;
    int split;          /* what lies on targets is not known */
    int guides[GUIDE_COUNT], covers[RETEX_MAX_TARGETS]; /* images of the film */
} DenoiseGuides;

int denoise_guides_create(DenoiseGuides *guides, Film *film, const FirstHitWindow *window, int split, RetexError *err);
/* Fill them at a pixel of the window. */
void denoise_guides_pixel(const DenoiseGuides *guides, FilmPixel *pixel, int x, int y);
/* Add the parts to the set that the film became. */
int denoise_guides_finish(const DenoiseGuides *guides, Film *film, RetexSet *set, RetexError *err);

#endif
