/* From a finish to a BSDF. */
#ifndef RENDERER_SHADE_MATERIAL_H
#define RENDERER_SHADE_MATERIAL_H

#include "shade/bsdf.h"
#include "shape/surface.h"

/* The BSDF of a surface seen along wo. The rest comes from the pigment: filter, transmit and pigment_opacity. */
void bsdf_setup(Bsdf *bsdf, const Surface *surface, Vec3 wo, float filter, float transmit, float opacity);
/* The same for light of one wavelength, where the interior has dispersion. */
void bsdf_setup_wavelength(Bsdf *bsdf, const Surface *surface, Vec3 wo, float filter, float transmit, float opacity,
                           double wavelength);
/* Without the lobe of light that passes straight or refracted. */
void bsdf_stop_passing(Bsdf *bsdf);
/* The normals on wo's side: for shading, and the shape's own. */
void bsdf_normals(const Surface *surface, Vec3 wo, Vec3 *normal, Vec3 *geometric);

#endif
