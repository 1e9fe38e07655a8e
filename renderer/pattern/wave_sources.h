/* Where the waves of `ripples` and `waves` come from: POV-Ray's points on the unit sphere, each with a frequency. */
#ifndef RENDERER_PATTERN_WAVE_SOURCES_H
#define RENDERER_PATTERN_WAVE_SOURCES_H

#include "base/vec.h"

enum { WAVE_SOURCES = 10 }; /* POV-Ray's default number_of_waves */

typedef struct WaveSource {
    Vec3 at;
    double frequency; /* of `waves` */
} WaveSource;

const WaveSource *wave_sources(void); /* WAVE_SOURCES of them; thread-safe */

#endif
