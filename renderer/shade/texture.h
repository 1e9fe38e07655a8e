/* What can be said of a texture as a whole, tree or not. */
#ifndef RENDERER_SHADE_TEXTURE_H
#define RENDERER_SHADE_TEXTURE_H

#include "scene/scene.h"

/* 1 where light nowhere passes it: of layers, where one is opaque. */
int texture_is_opaque(const Texture *texture);
/* The mean of its leaves' emission; black where none emits. */
Rgb texture_emission(const Texture *texture);
/* Whether direct-light samples look for its light: that of some leaf, see finish_is_sampled. */
int texture_is_sampled(const Texture *texture);

#endif
