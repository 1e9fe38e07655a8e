/* Scenes from text: the parsed scene, or its error. */
#ifndef LIB_SCENE_TEXT_H
#define LIB_SCENE_TEXT_H

#include "lib_test.h"
#include "scene/scene.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

extern char messages[8192]; /* of the last scene that was parsed, one per line */

int parse_with(Scene **scene, const char *text, SdlOptions *options, RetexError *err);
Scene *parse(const char *text);
void expect_error(const char *text, const char *part);
void assert_near(double a, double b);
void assert_vec(Vec3 a, double x, double y, double z);
void assert_color(Rgbft c, double r, double g, double b);
const Primitive *only(const Scene *scene);
Rgbft color_at(const Primitive *p, double x, double y, double z);

#define V37 "#version 3.7; global_settings{assumed_gamma 1} "

#endif
