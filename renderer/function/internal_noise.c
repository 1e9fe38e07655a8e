/* Functions of noise: multifractals, after Musgrave's in 'Texturing and Modeling'. */
#include "base/noise.h"
#include "function/internal.h"

static int generator_of(double number)
{
    return (int)(function_bits(number) & 3);
}

/* -1 to 1 */
static double signed_noise(Vec3 p, int generator)
{
    return 2 * noise_value(p, generator) - 1;
}

/* The number of octaves, with a bound on those that a scene may ask for. */
static double octaves_of(double number)
{
    return fmin(number, 10000);
}

/* H, lacunarity, octaves, offset, T, generator */
double internal_hetero_mf(const double *p)
{
    const int generator = generator_of(p[8]);
    const double octaves = octaves_of(p[5]), offset = p[6], fall = pow(p[4], -p[3]);
    const int64_t power = function_bits(fmin(p[7], 10000));
    Vec3 at = vec3(p[0], p[1], p[2]);
    double value = signed_noise(at, generator) + offset, share = fall;
    at = vec_scale(at, p[4]);
    for (int i = 1; i < octaves; i++) {
        double more = (signed_noise(at, generator) + offset) * share;
        for (int64_t k = 0; k < power; k++)
            more *= value;
        value += more;
        at = vec_scale(at, p[4]);
        share *= fall;
    }
    const double rest = octaves - trunc(octaves);
    if (rest != 0)
        value += rest * (signed_noise(at, generator) + offset) * share * value;
    return value;
}

/* lambda, octaves, omega, offset, ridge, generator */
double internal_ridge(const double *p)
{
    const int generator = generator_of(p[8]);
    const double lambda = p[3], octaves = octaves_of(p[4]), omega = p[5], offset = p[6], ridge = p[7];
    const double height = 1 / fmax(ridge, 1 - ridge), scale = 1 / fmax(offset, 1 - offset);
    const double whole = trunc(octaves), rest = octaves - whole;
    const Vec3 at = vec3(p[0], p[1], p[2]);
    double value = fabs(noise_value(at, generator) - ridge) * height - offset, total = 1, frequency = lambda,
           share = omega;
    for (int i = 2; i <= whole; i++) {
        value += share * (fabs(noise_value(vec_scale(at, frequency), generator) - ridge) * height - offset);
        total += share;
        frequency *= lambda;
        share *= omega;
    }
    if (rest != 0) {
        value += rest * share * (fabs(noise_value(vec_scale(at, frequency), generator) - ridge) * height - offset);
        total += rest * share;
    }
    return value * scale / total;
}

static double ridge_at(Vec3 at, double offset, int generator)
{
    const double ridge = offset - fabs(signed_noise(at, generator));
    return ridge * ridge;
}

/* H, lacunarity, octaves, offset, gain, generator */
double internal_ridged_mf(const double *p)
{
    const int generator = generator_of(p[8]);
    const double lacunarity = p[4], octaves = octaves_of(p[5]), offset = p[6], gain = p[7];
    Vec3 at = vec3(p[0], p[1], p[2]);
    double ridge = ridge_at(at, offset, generator), value = ridge, frequency = 1;
    for (int i = 1; i < octaves; i++) {
        at = vec_scale(at, lacunarity);
        frequency *= lacunarity;
        const double weight = fmin(1, fmax(0, ridge * gain));
        ridge = weight * ridge_at(at, offset, generator);
        value += ridge * pow(frequency, -p[3]);
    }
    return value;
}

double internal_noise_generator(const double *p)
{
    return noise_value(vec3(p[0], p[1], p[2]), generator_of(p[3]));
}
