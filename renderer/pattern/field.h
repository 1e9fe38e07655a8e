/* What a pattern of a function, an object, a pigment or an image reads: Pattern.data. */
#ifndef RENDERER_PATTERN_FIELD_H
#define RENDERER_PATTERN_FIELD_H

#include "pattern/pattern.h"

typedef struct PatternField {
    /* Any thread may call it. steps: how many it may take, from which it subtracts those of functions. */
    double (*value)(const void *data, const PatternPoint *point, long *steps);
    const void *data;
} PatternField;

#endif
