/* Colours as people write them: one grammar for options, tables, edits and messages. */
#ifndef RETEX_COLOR_TEXT_H
#define RETEX_COLOR_TEXT_H

#include <retex/error.h>
#include <retex/nearest.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Read a colour, which becomes scene-linear with the primaries of Rec. 709, in one of these forms:
 *
 *     rgb(0.8,0.1,0.1)     scene-linear numbers, 0 or more
 *     srgb(0.9,0.35,0.35)  numbers as a display is sent them, by the curve of sRGB (IEC 61966-2-1), from 0 to 1
 *     #f80  #ff8800        the same as hexadecimal digits, one or two for each of red, green and blue
 *     tomato               the same by one of the 148 names of CSS
 *
 * Capitals are as good as small letters, and there may be blanks around the text and within its parentheses.
 *
 * RETEX_EPARSE: the text begins as a colour does, and goes on otherwise. RETEX_ENOTFOUND: it is no colour, and may be
 * the name of a file. Names of files begin neither with `rgb(` nor with `srgb(`, and with `#` only if there is a point
 * or a slash in them. A file that is called as a colour is read as `./red`. */
int retex_color_parse(float color[3], const char *text, RetexError *err);

/* Advice for the end of the message that a file cannot be read: "; is red meant?" for `rde`, or "" where no name of a
 * colour is near, or a point or a slash says that a file is meant. Returns text. */
const char *retex_color_meant(const char *name, char text[RETEX_MEANT_SIZE]);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
