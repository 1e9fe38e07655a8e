/* Patterns that are noise, or made of it. */
#include "pattern/pattern.h"

static const ColorMapEntry bozo_colors[] = {
    {.value = 0, .color = {1, 1, 1, 0, 0}},   {.value = 0.4, .color = {1, 1, 1, 0, 0}},
    {.value = 0.4, .color = {0, 1, 0, 0, 0}}, {.value = 0.6, .color = {0, 1, 0, 0, 0}},
    {.value = 0.6, .color = {0, 0, 1, 0, 0}}, {.value = 0.8, .color = {0, 0, 1, 0, 0}},
    {.value = 0.8, .color = {1, 0, 0, 0, 0}}, {.value = 1, .color = {1, 0, 0, 0, 0}}};
static const ColorMapEntry agate_colors[] = {{.value = 0, .color = {1, 1, 1, 0, 0}},
                                             {.value = 0.5, .color = {0.95f, 0.75f, 0.5f, 0, 0}},
                                             {.value = 0.5, .color = {0.9f, 0.7f, 0.5f, 0, 0}},
                                             {.value = 0.6, .color = {0.9f, 0.7f, 0.4f, 0, 0}},
                                             {.value = 0.6, .color = {1, 0.7f, 0.4f, 0, 0}},
                                             {.value = 1, .color = {0.6f, 0.3f, 0, 0, 0}}};
static const ColorMapEntry marble_colors[] = {{.value = 0, .color = {0.9f, 0.8f, 0.8f, 0, 0}},
                                              {.value = 0.9, .color = {0.9f, 0.08f, 0.08f, 0, 0}},
                                              {.value = 0.9, .color = {0, 0, 0, 0, 0}},
                                              {.value = 1, .color = {0, 0, 0, 0, 0}}};
static const ColorMapEntry wood_colors[] = {{.value = 0, .color = {0.666f, 0.312f, 0.2f, 0, 0}},
                                            {.value = 0.6, .color = {0.666f, 0.312f, 0.2f, 0, 0}},
                                            {.value = 0.6, .color = {0.4f, 0.1333f, 0.066f, 0, 0}},
                                            {.value = 1, .color = {0.4f, 0.1333f, 0.066f, 0, 0}}};

#define MAP(name)                                                                                                      \
    &(const ColorMap)                                                                                                  \
    {                                                                                                                  \
        .count = sizeof name / sizeof *name, .entries = (ColorMapEntry *)name                                          \
    }

/* Sums of octaves take the noise of generators 2 and 3 twice as steep about a half. */
static double octave(int generator, Vec3 p)
{
    const double value = noise_value(p, generator);
    return generator == NOISE_ORIGINAL ? value : 2 * value - 0.5;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

double turbulence_value(const Turbulence *t, int generator, Vec3 p)
{
    const int count = noise_octaves(t->octaves);
    double sum = clamp(octave(generator, p)), frequency = (float)t->lambda, share = (float)t->omega;
    for (int i = 1; i < count; i++) {
        sum += share * octave(generator, vec_scale(p, frequency));
        frequency *= (float)t->lambda;
        share *= (float)t->omega;
    }
    return sum;
}

static double turbulence(const Pattern *pattern, Vec3 p)
{
    return turbulence_value(&pattern->turbulence, pattern_noise_generator(pattern), p);
}

static double noise(const Pattern *pattern, const PatternPoint *point)
{
    return pattern_noise(pattern, point->p);
}

static double dents(const Pattern *pattern, const PatternPoint *point)
{
    const double value = pattern_noise(pattern, point->p);
    return value * value * value;
}

static double granite(const Pattern *pattern, const PatternPoint *point)
{
    const int original = pattern_noise_generator(pattern) == NOISE_ORIGINAL;
    double sum = 0, frequency = 1;
    for (int i = 0; i < 6; i++, frequency *= 2) {
        const double value = pattern_noise(pattern, vec_scale(point->p, 4 * frequency));
        sum += (original ? fabs(0.5 - value) : fmin(fabs(1 - 2 * value), 0.5)) / frequency;
    }
    return sum;
}

static double wrinkles(const Pattern *pattern, const PatternPoint *point)
{
    const int generator = pattern_noise_generator(pattern);
    double sum = clamp(octave(generator, point->p)), frequency = 2;
    for (int i = 1; i < 10; i++, frequency *= 2)
        sum += clamp(octave(generator, vec_scale(point->p, frequency))) / frequency;
    return sum / 2;
}

static double agate(const Pattern *pattern, const PatternPoint *point)
{
    const double by = pattern->agate_turbulence * turbulence(pattern, point->p);
    const double value = (1 + sin(2 * PI * (1.3 * by + 1.1 * point->p.z))) / 2;
    return value > 0 ? pow(fmin(value, 1), 0.77) : 0;
}

static double marble(const Pattern *pattern, const PatternPoint *point)
{
    const double amount = pattern->turbulence.amount.x;
    return amount != 0 ? point->p.x + amount * turbulence(pattern, point->p) : point->p.x;
}

static double wood(const Pattern *pattern, const PatternPoint *point)
{
    const Turbulence *t = &pattern->turbulence;
    const Vec3 p = point->p, amount = t->amount;
    if (amount.x == 0 && amount.y == 0)
        return hypot(p.x, p.y);
    const Vec3 by = noise_turbulence(p, t->lambda, t->omega, t->octaves);
    return hypot(p.x + sin(2 * PI * (p.x + by.x) * amount.x), p.y + sin(2 * PI * (p.y + by.y) * amount.y));
}

const PatternOps pattern_agate = {.keyword = "agate", .map = MAP(agate_colors), .value = agate};
const PatternOps pattern_bozo = {.keyword = "bozo", .map = MAP(bozo_colors), .value = noise};
const PatternOps pattern_bumps = {.keyword = "bumps", .value = noise};
const PatternOps pattern_dents = {.keyword = "dents", .value = dents};
const PatternOps pattern_granite = {.keyword = "granite", .value = granite};
const PatternOps pattern_marble = {
    .keyword = "marble", .map = MAP(marble_colors), .wave = WAVE_TRIANGLE, .has_turbulence = 1, .value = marble};
const PatternOps pattern_spotted = {.keyword = "spotted", .value = noise};
const PatternOps pattern_wood = {
    .keyword = "wood", .map = MAP(wood_colors), .wave = WAVE_TRIANGLE, .has_turbulence = 1, .value = wood};
const PatternOps pattern_wrinkles = {.keyword = "wrinkles", .value = wrinkles};
