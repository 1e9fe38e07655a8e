/* Patterns that tilt normals by vectors of noise, waves or cells. */
#include "base/noise.h"
#include "pattern/pattern.h"
#include "shade/normal.h"

static Vec3 bumps(const Normal *b, Vec3 p, Vec3 n)
{
    return vec_mad(n, noise_vector(p), b->size);
}

static Vec3 dents(const Normal *b, Vec3 p, Vec3 n)
{
    const double depth = noise_value(p, NOISE_RANGE_CORRECTED);
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

typedef struct Row {
    const char *keyword;
    NormalVectors *vectors;
} Row;

NormalVectors *normal_vectors(const PatternOps *pattern)
{
    static const Row rows[] = {{"bumps", bumps}, {"dents", dents}, {"wrinkles", wrinkles}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (pattern_at(pattern_find(rows[i].keyword)) == pattern)
            return rows[i].vectors;
    return NULL;
}
