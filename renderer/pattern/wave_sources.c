#include "pattern/wave_sources.h"
#include <pthread.h>
#include <stdint.h>
#include "base/noise.h"

static WaveSource sources[WAVE_SOURCES_MAX];

static void make_sources(void)
{
    uint32_t random = (uint32_t)-560851967;
    for (int i = 0; i < WAVE_SOURCES_MAX; i++) {
        random = random * 1812433253u + 12345u;
        sources[i].at = vec_normalize(noise_vector(vec3(i, 0, 0)));
        sources[i].frequency = (random >> 16 & 0x7fff) * 0.000030518509476 + 0.01;
    }
}

const WaveSource *wave_sources(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, make_sources);
    return sources;
}
