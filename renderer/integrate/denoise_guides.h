/* What denoising goes by, free of noise: normals, places, colours and cover of what each pixel sees, and of what it
 * sees in mirrors and through clear glass. The parts guide_… of <retex/denoise.h>. */
#ifndef RENDERER_INTEGRATE_DENOISE_GUIDES_H
#define RENDERER_INTEGRATE_DENOISE_GUIDES_H

#include "integrate/first_hit.h"

/* Add the parts to a set that knows its targets. split: what lies on targets is not known. */
int denoise_guides_add(RetexSet *set, const FirstHitWindow *window, int split, RetexError *err);

#endif
