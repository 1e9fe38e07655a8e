/* Where the waves of `ripples` and `waves` come from: POV-Ray's points on the unit sphere, each with a frequency. */
#ifndef RENDERER_PATTERN_WAVE_SOURCES_H
#define RENDERER_PATTERN_WAVE_SOURCES_H

#include "pattern/pattern.h"

enum { WAVE_SOURCES_MAX = 256 };

typedef struct WaveSource {
    Vec3 at;
    double frequency; /* of `waves` */
} WaveSource;

const WaveSource *wave_sources(void); /* WAVE_SOURCES_MAX of them; thread-safe */

/* How many of them count. */
static inline int wave_count(const Pattern *pattern)
{
    return pattern->number_of_waves ? *pattern->number_of_waves : 10;
}

#endif
