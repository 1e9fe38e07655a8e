/* Waves about points: of one length (ripples) or of several. */
#include "pattern/pattern.h"
#include "pattern/wave_sources.h"

/* At the source itself the distance counts as 1. */
static double distance_from(const WaveSource *source, Vec3 p)
{
    const double distance = vec_length(vec_sub(p, source->at));
    return distance == 0 ? 1 : distance;
}

/* The frequency and the phase count here, and once more as of any pattern. */
static double wave(const Pattern *pattern, double distance)
{
    return sin(2 * PI * (distance * pattern->frequency + pattern->phase));
}

static double ripples(const Pattern *pattern, const PatternPoint *point)
{
    const WaveSource *source = wave_sources();
    const int count = wave_count(pattern);
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += wave(pattern, distance_from(&source[i], point->p));
    return (1 + sum / count) / 2;
}

static double waves(const Pattern *pattern, const PatternPoint *point)
{
    const WaveSource *source = wave_sources();
    const int count = wave_count(pattern);
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += wave(pattern, distance_from(&source[i], point->p) * source[i].frequency) / source[i].frequency;
    return 0.2 * sum / count + 0.5;
}

const PatternOps pattern_ripples = {.keyword = "ripples", .value = ripples};
const PatternOps pattern_waves = {.keyword = "waves", .value = waves};
