/* The working space. Colours are numbers of it: linear with assumed_gamma 1 (and in scenes of version 3.7 that say
 * nothing), a power or sRGB with other values. Older scenes that say nothing compute in the display's own space, which
 * is taken as sRGB. Pigments, lights, sky, background, emission, ambient and reflection are decoded; factors such as
 * diffuse are not, for the sum of several lights has no equal in another space. */
#include "shade/working_space.h"

#include <math.h>

#include "sdl/state/builder.h"

WorkingSpace working_space(Sdl *sdl)
{
    const GlobalSettings *global = &builder_of(sdl)->global;
    WorkingSpace space = {.kind = WORKING_SRGB, .gamma = 1, .dark_filters_hide = sdl_version(sdl) < 3.7};
    if (!global->has_assumed_gamma)
        space.kind = sdl_version(sdl) >= 3.7 ? WORKING_LINEAR : WORKING_SRGB;
    else if (!global->gamma_srgb)
        space.kind = fabs(global->assumed_gamma - 1) < 1e-6 ? WORKING_LINEAR : WORKING_POWER,
        space.gamma = global->assumed_gamma;
    return space;
}

Rgb decode_color(Sdl *sdl, Rgb color)
{
    const WorkingSpace space = working_space(sdl);
    return working_decode(&space, color);
}
