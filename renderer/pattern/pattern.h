/* What a pattern is: a row with its value at a point and what is written after its keyword. */
#ifndef RENDERER_PATTERN_PATTERN_H
#define RENDERER_PATTERN_PATTERN_H

#include "pattern/patterns.h"

/* What stands between the keyword and the list of colours; sdl/build/pattern.c reads it. */
typedef enum PatternArguments {
    ARGUMENTS_NONE,
    ARGUMENTS_FLOAT,  /* Pattern.number */
    ARGUMENTS_VECTOR, /* Pattern.vector, a direction of any length */
    /* read over so far */
    ARGUMENTS_BLOCK,
    ARGUMENTS_FILE,
    ARGUMENTS_JULIA,
    ARGUMENTS_MAGNET,
    ARGUMENTS_OBJECT,
    ARGUMENTS_SLOPE
} PatternArguments;

struct PatternOps {
    const char *keyword;
    PatternArguments arguments;
    int colors; /* it chooses among so many colours; 0: it makes a value, which a wave and a color_map turn into one */
    /* At a point of pattern space: which colour, from 0; or the value, before the wave. NULL: not supported. */
    double (*value)(const Pattern *pattern, Vec3 p);
    const char *name; /* in the warning that it is not supported */
};

/* All patterns, also those that are not supported. */
int pattern_count(void);
const PatternOps *pattern_at(int index);
int pattern_find(const char *keyword); /* its index, or -1 */

/* The value with the wave applied, 0..1; or which colour. */
double pattern_value(const Pattern *pattern, Vec3 p);

#endif
