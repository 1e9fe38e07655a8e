/* See dispersion.h. */
#include <math.h>
#include "shade/dispersion.h"

/* A part of the spectrum that a colour sees: a parabola. */
typedef struct Hump {
    double middle, half_width, height;
} Hump;

/* Fitted to pictures of POV-Ray 3.7 of a white line through a prism with dispersion_samples 100; the heights are such
 * that the integral of each colour is 1. Red sees the violet end too. */
static const Hump red = {0.217, 0.238, 3.043245}, violet = {0.921, 0.097, 0.314977};
static const Hump green = {0.418, 0.261, 2.873563}, blue = {0.742, 0.279, 2.699354};

static double hump_value(const Hump *h, double wavelength)
{
    const double x = (wavelength - h->middle) / h->half_width;
    return h->height * fmax(0, 1 - x * x);
}

double dispersion_scale(double dispersion, double wavelength)
{
    return pow(dispersion, wavelength - 0.5);
}

Rgb dispersion_color(double wavelength)
{
    return rgb((float)(hump_value(&red, wavelength) + hump_value(&violet, wavelength)),
               (float)hump_value(&green, wavelength), (float)hump_value(&blue, wavelength));
}
