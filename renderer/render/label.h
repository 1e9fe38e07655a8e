/* Numbers of objects drawn into a picture. The letters are a table here: they need no font to be installed. */
#ifndef RENDERER_RENDER_LABEL_H
#define RENDERER_RENDER_LABEL_H

#include <retex/image.h>

/* Draw the text (digits and dots) in white with a dark edge around x, y, as large as a square with this half side
 * allows, at most 4 pixels for a dot of a letter; not at all where it is larger than the square. */
void label_draw(RetexImage *image, const char *text, int x, int y, int half_side);

#endif
