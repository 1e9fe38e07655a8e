/* The values of lamps: what may be written for one, and what it makes of a lamp.
 *
 * A value is a product of factors, divided by `*`:
 *
 *     0  2.5                 numbers, 0 or more
 *     #ffd0a0  rgb(1,.8,.6)  colours, see retex/color_text.h
 *     3000K                  the colour of a black body, from 1000 to 40000 kelvins
 *
 * Numbers multiply the lamp's value as rendered, or, of a lamp that is off, the value that makes it shine. Colours
 * replace its colour, and keep its luminance: of a colour only the hue and saturation count. Several colours in a
 * product filter each other. Light of several colours is multiplied by a colour of luminance 1. */
#ifndef RETEX_LAMP_H
#define RETEX_LAMP_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_KELVIN_MIN 1000
#define RETEX_KELVIN_MAX 40000
#define RETEX_LAMP_TEXT_MAX 160 /* bytes of a value's text, with the final NUL */

typedef struct RetexLampValue {
    double gain;    /* the product of the numbers; 0 or more */
    int colored;    /* 1: it has a colour */
    float color[3]; /* scene-linear Rec. 709, of luminance 1 */
} RetexLampValue;

/* RETEX_EPARSE where the text is no value. */
int retex_lamp_value_parse(RetexLampValue *value, const char *text, RetexError *err);
/* The value as text, which parsed gives the value again: `2`, `rgb(…)` or `2*rgb(…)`. */
void retex_lamp_value_text(const RetexLampValue *value, char text[RETEX_LAMP_TEXT_MAX]);
/* What a parameter of kind COLOR becomes. RETEX_EINVAL where that is too large for a float. */
int retex_lamp_value_apply(float color[3], const RetexLampValue *value, const RetexParameter *lamp, RetexError *err);

/* The colour of a black body of so many kelvins, RETEX_KELVIN_MIN to RETEX_KELVIN_MAX, of luminance 1: Planck's law
 * seen by the CIE 1931 observer, in the fit of Wyman, Sloan and Shirley, 'Simple Analytic Approximations to the CIE XYZ
 * Color Matching Functions' (2013), the multi-lobe one; within .003 of its chromaticity from 2000 kelvins on. Channels
 * below 0, of blue under 1900 kelvins, become 0. White, 1 1 1, is D65, daylight: no black body is quite so, the nearest
 * one, of 6500 kelvins, is a little more purple. */
void retex_kelvin_color(float color[3], double kelvin);

/* The parameter of the lamp that a name means: exactly, else ignoring case if that is unique. RETEX_ENOTFOUND lists the
 * set's lamps, with the nearest name, or says that it has none. */
int retex_lamp_find(int *parameter, const RetexSet *set, const char *name, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
