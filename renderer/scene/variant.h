/* Other textures on the scene's targets. */
#ifndef RENDERER_SCENE_VARIANT_H
#define RENDERER_SCENE_VARIANT_H

#include <retex/set.h>
#include <retex/texture.h>
#include "base/vec.h"

#define VARIANTS_MAX 16 /* pictures of one traversal */

/* What lies on the targets in one of several pictures: a texture, or NULL for the original. */
typedef struct RenderVariant {
    const RetexTexture *textures[RETEX_MAX_TARGETS];
    const Rgb *constants; /* or NULL; by target, a colour instead of all textures */
} RenderVariant;

#endif
