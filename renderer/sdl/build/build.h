/* What builds the scene, as the language calls it. */
#ifndef RENDERER_SDL_BUILD_BUILD_H
#define RENDERER_SDL_BUILD_BUILD_H

#include "sdl/lang/parser.h"

extern const SdlBuilder scene_builder;

#endif
