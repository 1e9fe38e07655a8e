/* Patterns that tilt normals by vectors of noise, waves or cells. */
#include <stdlib.h>
#include "base/noise.h"
#include "pattern/cubes.h"
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
    const int count = wave_count(&b->pattern);
    for (int i = 0; i < count; i++) {
        const Vec3 away = vec_sub(p, sources[i].at);
        const double length = vec_length(away), distance = length > 0 ? length : 1;
        const double frequency = of_waves ? sources[i].frequency : 1;
        const double wave = sin(2 * PI * (distance * b->pattern.frequency * frequency + b->pattern.phase));
        n = vec_mad(n, away, b->size * wave / (frequency * distance * count));
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

static Vec3 quilted(const Normal *b, Vec3 p, Vec3 n)
{
    const Vec3 from = vec3(p.x - floor(p.x) - 0.5, p.y - floor(p.y) - 0.5, p.z - floor(p.z) - 0.5);
    return vec_mad(n, from, b->size * quilted_curve(&b->pattern, vec_length(from)));
}

static double facet_distance(const struct Facets *facets, Vec3 by)
{
    if (facets->metric == 2)
        return vec_dot(by, by);
    if (facets->metric == 1)
        return by.x + by.y + by.z; /* as POV-Ray has it */
    return pow(fabs(by.x), facets->metric) + pow(fabs(by.y), facets->metric) + pow(fabs(by.z), facets->metric);
}

/* The nearest of points, of which each unit cube has one at random: in the cubes that POV-Ray looks into. */
static Vec3 facet_of(const struct Facets *facets, Vec3 p)
{
    const Vec3 own = vec3(floor(p.x + 1e-10), floor(p.y + 1e-10), floor(p.z + 1e-10));
    double least = HUGE_VAL;
    Vec3 nearest = p;
    for (int x = -2; x <= 2; x++)
        for (int y = -2; y <= 2; y++)
            for (int z = -2; z <= 2; z++) {
                const Vec3 cube = vec_add(own, vec3(x, y, z)), at = vec_add(cube, noise_cell(cube));
                const double distance = facet_distance(facets, vec_sub(at, p));
                if ((abs(x) == 2) + (abs(y) == 2) + (abs(z) == 2) <= 1 && distance < least)
                    least = distance, nearest = at;
            }
    return nearest;
}

/* The normal is that of its facet; or, by coords, each facet is tilted along the surface. */
static Vec3 facets(const Normal *b, Vec3 p, Vec3 n)
{
    n = vec_normalize(n);
    const double scale = b->facets.size < 1e-6 ? 1e6 : 1 / b->facets.size;
    const Vec3 facet = facet_of(&b->facets, vec_scale(b->facets.coords != 0 ? p : n, scale));
    if (b->facets.coords == 0)
        return facet;
    const Vec3 v = noise_vector(facet);
    return vec_mad(n, vec_mad(v, n, -vec_dot(v, n)), b->facets.coords);
}

NormalVectors *normal_vectors(const PatternOps *pattern)
{
    static const struct Row {
        const PatternOps *pattern;
        NormalVectors *vectors;
    } rows[] = {{&pattern_bumps, bumps},     {&pattern_dents, dents}, {&pattern_wrinkles, wrinkles},
                {&pattern_ripples, ripples}, {&pattern_waves, waves}, {&pattern_quilted, quilted},
                {&pattern_facets, facets}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].pattern == pattern)
            return rows[i].vectors;
    return NULL;
}
