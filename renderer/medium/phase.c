#include "medium/phase.h"

/* POV-Ray's factors for Rayleigh's and the two Mie functions. They are somewhat above those of functions whose mean
 * over all directions is 1. */
static const double povray_factor[] = {
    [PHASE_MIE_HAZY] = 0.576655375, [PHASE_MIE_MURKY] = 0.495714547, [PHASE_RAYLEIGH] = 0.799372013};

static double hazy(double cosine)
{
    const double x = (1 + cosine) / 2, x2 = x * x, x4 = x2 * x2;
    return 1 + 9 * x4 * x4;
}

static double murky(double cosine)
{
    const double x = (1 + cosine) / 2, x2 = x * x, x4 = x2 * x2, x8 = x4 * x4, x16 = x8 * x8;
    return 1 + 50 * x16 * x16;
}

static double henyey_greenstein(double g, double cosine)
{
    const double d = 1 + g * g - 2 * g * cosine;
    return (1 - g * g) / (d * sqrt(d));
}

/* *mean: over all directions. */
static double shape_of(const Medium *medium, double cosine, double *mean)
{
    *mean = 1;
    switch (medium->phase) {
    case PHASE_MIE_HAZY:
        *mean = 2;
        return hazy(cosine);
    case PHASE_MIE_MURKY:
        *mean = 83.0 / 33;
        return murky(cosine);
    case PHASE_RAYLEIGH:
        *mean = 4.0 / 3;
        return 1 + cosine * cosine;
    case PHASE_HENYEY_GREENSTEIN:
        return henyey_greenstein(medium->eccentricity, cosine);
    case PHASE_ISOTROPIC:
        break;
    }
    return 1;
}

double phase_density(const Medium *medium, double cosine)
{
    double mean;
    const double value = shape_of(medium, cosine, &mean);
    return value / (4 * PI * mean);
}

static double factor_of(const Medium *medium)
{
    const int has_factor = medium->phase != PHASE_ISOTROPIC && medium->phase != PHASE_HENYEY_GREENSTEIN;
    return has_factor ? povray_factor[medium->phase] : 1;
}

double phase_of_sources(const Medium *medium, double cosine)
{
    double mean;
    const double value = shape_of(medium, cosine, &mean);
    return value * factor_of(medium) / PI;
}

double phase_source_scale(const Medium *medium)
{
    double mean;
    shape_of(medium, 0, &mean);
    return 4 * mean * factor_of(medium);
}

/* Of 1 + a x^(n - 1), x uniform with a probability, else by the power. */
static double sample_power(double u, double a, int n)
{
    const double uniform = 1 / (1 + a / n);
    return u < uniform ? 2 * u / uniform - 1 : 2 * pow((u - uniform) / (1 - uniform), 1.0 / n) - 1;
}

static double sample_rayleigh(double u)
{
    const double t = 2 * (2 * u - 1), root = cbrt(t + sqrt(t * t + 1));
    return root - 1 / root;
}

static double sample_henyey_greenstein(double g, double u)
{
    if (fabs(g) < 1e-3)
        return 2 * u - 1 + 1.5 * g * 4 * u * (1 - u);
    const double s = (1 - g * g) / (1 - g + 2 * g * u);
    return (1 + g * g - s * s) / (2 * g);
}

static double sample_cosine(const Medium *medium, double u)
{
    switch (medium->phase) {
    case PHASE_MIE_HAZY:
        return sample_power(u, 9, 9);
    case PHASE_MIE_MURKY:
        return sample_power(u, 50, 33);
    case PHASE_RAYLEIGH:
        return sample_rayleigh(u);
    case PHASE_HENYEY_GREENSTEIN:
        return sample_henyey_greenstein(medium->eccentricity, u);
    case PHASE_ISOTROPIC:
        break;
    }
    return 2 * u - 1;
}

Vec3 phase_sample(const Medium *medium, Vec3 before, float u, float v, double *density)
{
    const double cosine = fmax(-1, fmin(1, sample_cosine(medium, u))), sine = sqrt(1 - cosine * cosine);
    double s, c;
    Vec3 x, y;
    vec_frame(before, &x, &y);
    turn_sincos(v, &s, &c);
    *density = phase_density(medium, cosine);
    return vec_mad(vec_mad(vec_scale(before, cosine), x, sine * c), y, sine * s);
}
