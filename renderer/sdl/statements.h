/* The statements that build the scene, as the language calls them. */
#ifndef RENDERER_SDL_STATEMENTS_H
#define RENDERER_SDL_STATEMENTS_H

#include "sdl/lang/parser.h"

extern const SdlBuilder scene_builder;

#endif
