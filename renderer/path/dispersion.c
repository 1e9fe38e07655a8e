/* Dispersion: from the first surface on that refracts by wavelength, a path has one wavelength, chosen by a sample
 * number of its own. Its throughput is multiplied by the colour of that wavelength, whose mean is white. Neither looks
 * at a texture.
 *
 * A path that has all wavelengths refracts by one of them, but what it reflects is of all: its Fresnel term is that of
 * the middle of the spectrum, so that reflected and refracted light add up to what came. Where light may be reflected
 * totally at some wavelengths only, the path has one wavelength before it. */
#include "path/internal.h"
#include "shade/dispersion.h"

void path_take_wavelength(PathWorker *w, Path *path, float wavelength)
{
    path->wavelength = wavelength;
    path_scale(w, path, dispersion_color(wavelength));
}

void disperse(PathWorker *w, Path *path, Vertex *v, Vec3 wo)
{
    const Sampler sampler = {path->key, path->sample};
    Bsdf *b = &v->s.bsdf;
    float u, unused;
    sampler_pair(&sampler, DIMENSION_WAVELENGTH, &u, &unused);
    if (path->wavelength < 0 && b->eta >= 1 && !v->s.surface.backside) {
        const double scale = dispersion_scale(v->s.surface.primitive->interior->dispersion, u);
        b->bend *= (float)scale;
        v->wavelength = u;
        return;
    }
    if (path->wavelength < 0)
        path_take_wavelength(w, path, u);
    shading_bsdf_wavelength(&v->s, wo, path->wavelength);
}
