/* The scene language: POV-Ray 3.7's core, read into a Scene. What is accepted is described in retex-scene(5). */
#ifndef RENDERER_SDL_SDL_H
#define RENDERER_SDL_SDL_H

#include "scene/scene.h"
#include "sdl/lang/options.h"

/* Parse a scene file. On failure *scene is NULL and err has file, line, column and what was expected. */
int sdl_parse_file(Scene **scene, const char *path, const SdlOptions *options /* NULL = defaults */, RetexError *err);

#endif
