/* Dispersion: the index of refraction by wavelength, and the colour of light of one wavelength. A wavelength is a
 * number from 0, the red end of POV-Ray's spectrum, to 1, its violet end; light that has not been dispersed has all of
 * them alike. */
#ifndef RENDERER_SHADE_DISPERSION_H
#define RENDERER_SHADE_DISPERSION_H

#include "base/vec.h"

/* The index of refraction over that of the middle of the spectrum. dispersion: that of the violet end over that of the
 * red end. */
double dispersion_scale(double dispersion, double wavelength);
/* White light's share of a wavelength, by colour. The mean over the spectrum is 1. */
Rgb dispersion_color(double wavelength);

#endif
