/* Parsers of shapes: what stands between `{` and the modifiers. */
#ifndef RENDERER_SDL_OBJECT_SHAPE_H
#define RENDERER_SDL_OBJECT_SHAPE_H

#include "sdl/object/object.h"
#include "shape/isosurface.h"
#include "shape/shapes.h"
#include "shape/text.h"

typedef void ShapeParser(Sdl *sdl, Object *object);    /* what stands between `{` and the modifiers */
/* Keywords that are not the name of a shape's operations. */
#define SHAPE_KEYWORDS(X) \
    X(bicubic_patch) X(cubic) X(cylinder) X(mesh2) X(parametric) X(polygon) X(polynomial) X(quadric) \
    X(quartic) X(smooth_triangle) X(triangle)
#define X(name) ShapeParser parse_##name;
SHAPE_TABLE(X)
SHAPE_KEYWORDS(X)
#undef X
/* isosurface.c: also of other shapes that a function gives */
int accept_container(Sdl *sdl, Container *container);
double positive_or(Sdl *sdl, const char *what, double value, double instead); /* warns where it is not */

/* font.c: a font's letters, in units of its size. Each file is read and each letter is made once. */
typedef struct Font Font;
typedef struct Letter {
    const Glyph *glyph; /* NULL: blank */
    double advance;     /* to the next letter */
    double bearing;     /* from the pen to the left edge */
} Letter;
Font *font_open(Sdl *sdl, const char *name);
unsigned font_letter_index(Font *font, unsigned long character); /* 0: the font lacks it */
const Letter *font_letter(Sdl *sdl, Font *font, unsigned index);
double font_kerning(const Font *font, unsigned left, unsigned right);

#endif
