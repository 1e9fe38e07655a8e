/* The identity of retexturing, of scenes that a test writes. */
#ifndef LIB_IDENTITY_H
#define LIB_IDENTITY_H

#include "lib_scene.h"
#include "render/render.h"

/* A plain picture of the scene, or a set. */
RetexSet *render_text(const char *text, int width, int height, int spp, int plain, int max_depth);
/* The mean of a picture's pixels, by colour. */
void mean_color(const RetexSet *set, double mean[3]);
/* With one colour on the target, the scene's set is the plain picture; with another colour it is the picture of the
 * scene that has it. Paths must not have more hits than a set keeps. */
void assert_identity(const char *text, const char *target, int spp, int max_depth);

#endif
