/* What lies between objects: fog and rainbows. */
#ifndef RENDERER_SDL_MEDIUM_AIR_H
#define RENDERER_SDL_MEDIUM_AIR_H

#include "sdl/texture/pigment.h"

/* rainbow.c */
Rainbow *parse_rainbow(Sdl *sdl); /* after rainbow */
void place_rainbow(Sdl *sdl, const Rainbow *rainbow);

/* fog.c */
Fog *parse_fog(Sdl *sdl); /* after fog */
void complete_air(Sdl *sdl); /* at the end of reading */

#endif
