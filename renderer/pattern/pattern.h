/* What a pattern is: a row with its value at a point and what is written after its keyword. */
#ifndef RENDERER_PATTERN_PATTERN_H
#define RENDERER_PATTERN_PATTERN_H

#include "base/noise.h"
#include "pattern/patterns.h"

/* What stands between the keyword and the list of colours; sdl/texture/pattern.c reads it. */
typedef enum PatternArguments {
    ARGUMENTS_NONE,
    ARGUMENTS_FLOAT,  /* Pattern.number */
    ARGUMENTS_VECTOR, /* Pattern.vector, a direction of any length */
    /* Pattern.data, which sdl/texture/pattern_data.c makes */
    ARGUMENTS_BRICK, /* nothing, but mortar and brick_size may follow: Pattern.number, Pattern.vector */
    ARGUMENTS_DENSITY_FILE,
    ARGUMENTS_FRACTAL,
    ARGUMENTS_FUNCTION,
    ARGUMENTS_IMAGE,
    ARGUMENTS_OBJECT, /* in braces, with the list of colours */
    ARGUMENTS_PAVEMENT,
    ARGUMENTS_PIGMENT,
    ARGUMENTS_SLOPE,
    ARGUMENTS_TILING, /* Pattern.number, from 1 to 27 */
    ARGUMENTS_BLOCK /* read over */
} PatternArguments;

/* Where a pattern is evaluated. */
typedef struct PatternPoint {
    Vec3 p;      /* in pattern space */
    Vec3 normal; /* of the surface there, in the world, towards the viewer; zero where there is none: sky, functions */
    Vec3 view;   /* the direction of the ray that sees it, in the world; zero where there is none */
} PatternPoint;

struct PatternOps {
    const char *keyword;
    PatternArguments arguments;
    int colors; /* it chooses among so many colours; 0: it makes a value, which a wave and a color_map turn into one */
    const ColorMap *map; /* its colours where none are written; or NULL: black to white, or of six red, green and blue,
                            yellow, cyan and magenta */
    WaveKind wave;       /* where none is written */
    int has_turbulence;  /* value() uses Pattern.turbulence in its own way, so that the point is not moved by it */
    /* At a point that is warped already: which colour, from 0; or the value, before the wave. NULL: not supported. */
    double (*value)(const Pattern *pattern, const PatternPoint *point);
    const char *name; /* in the warning that it is not supported */
};

/* The colours of several patterns where none are written. */
extern const ColorMap pattern_blue_green_red;

/* All patterns, also those that are not supported. */
int pattern_count(void);
const PatternOps *pattern_at(int index);
int pattern_find(const char *keyword); /* its index, or -1 */

/* POV-Ray's defaults: no turbulence, no warps, frequency 1. */
#define TURBULENCE_INIT ((Turbulence){.lambda = 2, .omega = 0.5, .octaves = 6})
#define PATTERN_INIT                                                                                                   \
    ((Pattern){.frequency = 1,                                                                                         \
               .wave_exponent = 1,                                                                                     \
               .turbulence = TURBULENCE_INIT,                                                                          \
               .agate_turbulence = 1,                                                                                  \
               .control = {1, 1},                                                                                      \
               .crackle = {.form = {-1, 1, 0}, .metric = 2}})

/* POV-Ray's order: from the point through the warps, the last written first, and turbulence; the value there; then
 * frequency, phase and wave. The value is 0..1, or which colour. */
double pattern_value(const Pattern *pattern, const PatternPoint *point);
/* Its two halves: only the point's way; only the value, at a point that went it. Pigments of a map are evaluated at the
 * point that went it. */
Vec3 pattern_warp(const Pattern *pattern, Vec3 p);
double pattern_value_at(const Pattern *pattern, const PatternPoint *warped);

static inline double triangle_wave(double x)
{
    const double offset = x - floor(x);
    return offset >= 0.5 ? 2 * (1 - offset) : 2 * offset;
}

static inline int pattern_is_warped(const Pattern *pattern)
{
    const Vec3 turbulence = pattern->turbulence.amount;
    return pattern->warps || turbulence.x != 0 || turbulence.y != 0 || turbulence.z != 0;
}

static inline int pattern_noise_generator(const Pattern *pattern)
{
    return pattern->noise_generator ? *pattern->noise_generator : NOISE_RANGE_CORRECTED;
}
/* The sum of octaves of turbulence, of values and not of vectors; its amount does not count. */
double turbulence_value(const Turbulence *turbulence, int generator, Vec3 p);
static inline double pattern_noise(const Pattern *pattern, Vec3 p)
{
    return noise_value(p, pattern_noise_generator(pattern));
}

#endif
