/* photons{…} of an object or a light source. */
#include "sdl/object/object.h"

static void set_flag(Sdl *sdl, unsigned *flags, unsigned flag)
{
    *flags = sdl_optional_bool(sdl, 1) ? *flags | flag : *flags & ~flag;
}

void parse_photons(Sdl *sdl, unsigned *flags)
{
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        if (sdl_accept(sdl, "target"))
            set_flag(sdl, flags, OBJECT_PHOTON_TARGET);
        else if (sdl_accept(sdl, "refraction"))
            set_flag(sdl, flags, OBJECT_PHOTONS_REFRACT);
        else if (sdl_accept(sdl, "reflection"))
            set_flag(sdl, flags, OBJECT_PHOTONS_REFLECT);
        else if (sdl_accept(sdl, "collect") || sdl_accept(sdl, "pass_through") || sdl_accept(sdl, "area_light"))
            sdl_optional_bool(sdl, 1);
        else
            sdl_expected(sdl, "target, refraction, reflection, collect, pass_through, area_light or } in photons");
}
