/* What a BSDF or an emitter gives, split into what the albedo multiplies and what it does not: d * albedo + i. */
#ifndef RENDERER_SHADE_SPLIT_H
#define RENDERER_SHADE_SPLIT_H

#include "base/vec.h"

/* In place of every texture where paths are chosen, so that they do not depend on textures. */
#define NEUTRAL_ALBEDO 0.8f

typedef struct Split { Rgb d, i; } Split;

static inline Rgb split_apply(Split s, Rgb albedo) { return rgb_add(rgb_mul(s.d, albedo), s.i); }
static inline Split split_times(Split s, float by) { return (Split){rgb_scale(s.d, by), rgb_scale(s.i, by)}; }
static inline float split_neutral(Split s) { return rgb_luminance(split_apply(s, rgb_grey(NEUTRAL_ALBEDO))); }

#endif
