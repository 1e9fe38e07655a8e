/* Colours between the scene's working space and scene-linear. */
#ifndef RENDERER_SHADE_WORKING_SPACE_H
#define RENDERER_SHADE_WORKING_SPACE_H

#include "scene/scene.h"

int working_is_linear(const WorkingSpace *space /* NULL: linear */);
Rgb working_decode(const WorkingSpace *space, Rgb color); /* to scene-linear */
Rgb working_encode(const WorkingSpace *space, Rgb linear);

/* The same of pigments' colours: filter and transmit are shares, not colours. */
Rgbft working_decode_pigment(const WorkingSpace *space, Rgbft color);
Rgbft working_encode_pigment(const WorkingSpace *space, Rgbft linear);

#endif
