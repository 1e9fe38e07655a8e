/* The sRGB curve and the luminance of linear Rec. 709 colours: each is defined here and nowhere else. The functions
 * whose names end in f compute in single precision. */
#ifndef RETEX_COLOR_H
#define RETEX_COLOR_H

#include <math.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* From scene-linear values to the values that a display is sent, and back: IEC 61966-2-1. Nothing is clipped. Values
 * below 0 lie on the straight part of the curve. */
static inline double retex_srgb_encode(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

static inline double retex_srgb_decode(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : pow((encoded + 0.055) / 1.055, 2.4);
}

static inline float retex_srgb_encodef(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

static inline float retex_srgb_decodef(float encoded)
{
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

/* Relative luminance of a scene-linear colour: 1 for white. */
static inline double retex_luminance(double red, double green, double blue)
{
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

static inline float retex_luminancef(float red, float green, float blue)
{
    return 0.2126f * red + 0.7152f * green + 0.0722f * blue;
}

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
