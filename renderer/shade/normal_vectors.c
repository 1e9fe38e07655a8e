/* Patterns that tilt normals by vectors of noise, waves or cells. */
#include "base/noise.h"
#include "pattern/pattern.h"
#include "pattern/wave_sources.h"
#include "shade/normal.h"

static Vec3 bumps(const Normal *b, Vec3 p, Vec3 n)
{
    return vec_mad(n, noise_vector(p), b->size);
}

static Vec3 dents(const Normal *b, Vec3 p, Vec3 n)
{
    const double depth = pattern_noise(&b->pattern, p);
    return vec_mad(n, noise_vector(p), b->size * depth * depth * depth);
}

static Vec3 wrinkles(const Normal *b, Vec3 p, Vec3 n)
{
    Vec3 sum = {0, 0, 0};
    double scale = 1;
    for (int octave = 0; octave < 10; octave++, scale *= 2) {
        const Vec3 v = noise_vector(vec_scale(p, scale));
        sum = vec_mad(sum, vec3(fabs(v.x), fabs(v.y), fabs(v.z)), 1 / scale);
    }
    return vec_mad(n, sum, b->size);
}

/* Away from the sources of waves and towards them. */
static Vec3 from_sources(const Normal *b, Vec3 p, Vec3 n, int of_waves)
{
    const WaveSource *sources = wave_sources();
    for (int i = 0; i < WAVE_SOURCES; i++) {
        const Vec3 away = vec_sub(p, sources[i].at);
        const double length = vec_length(away), distance = length > 0 ? length : 1;
        const double frequency = of_waves ? sources[i].frequency : 1;
        const double wave = sin(2 * PI * (distance * b->pattern.frequency * frequency + b->pattern.phase));
        n = vec_mad(n, away, b->size * wave / (frequency * distance * WAVE_SOURCES));
    }
    return n;
}

static Vec3 ripples(const Normal *b, Vec3 p, Vec3 n)
{
    return from_sources(b, p, n, 0);
}

static Vec3 waves(const Normal *b, Vec3 p, Vec3 n)
{
    return from_sources(b, p, n, 1);
}

typedef struct Row {
    const char *keyword;
    NormalVectors *vectors;
} Row;

NormalVectors *normal_vectors(const PatternOps *pattern)
{
    static const Row rows[] = {
        {"bumps", bumps}, {"dents", dents}, {"wrinkles", wrinkles}, {"ripples", ripples}, {"waves", waves}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (pattern_at(pattern_find(rows[i].keyword)) == pattern)
            return rows[i].vectors;
    return NULL;
}
