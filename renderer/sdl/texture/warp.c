/* Warps of patterns, and turbulence. */
#include "pattern/pattern.h"
#include "pattern/warp.h"
#include "sdl/texture/texture.h"

int accept_turbulence(Sdl *sdl, Turbulence *t)
{
    if (sdl_accept(sdl, "turbulence"))
        t->amount = sdl_vector(sdl);
    else
        return sdl_accept_float(sdl, "octaves", &t->octaves) || sdl_accept_float(sdl, "omega", &t->omega) ||
               sdl_accept_float(sdl, "lambda", &t->lambda);
    return 1;
}

/* A repeated black hole lies within its block, wherever chance moves it: else the block grows. */
static void fit_block(double *center, double *repeat, double displacement, double radius)
{
    if (*repeat <= 0) {
        *repeat = 0;
        return;
    }
    *center = fmax(*center, radius);
    *repeat = fmax(*repeat, *center + radius + displacement);
}

static void black_hole(Sdl *sdl, Warp *warp)
{
    struct BlackHole *hole = &warp->hole;
    hole->center = sdl_vector(sdl);
    sdl_expect(sdl, ",");
    hole->radius = sdl_float(sdl);
    hole->strength = 1, hole->falloff = 2;
    while (!sdl_is(sdl, "}")) {
        if (sdl_accept(sdl, "inverse"))
            hole->is_inverse = sdl_optional_bool(sdl, 1);
        else if (sdl_accept(sdl, "type"))
            sdl_float(sdl);
        else if (sdl_accept(sdl, "repeat"))
            hole->repeat = sdl_vector(sdl);
        else if (sdl_accept(sdl, "turbulence"))
            hole->displacement = sdl_vector(sdl);
        else if (!sdl_accept_float(sdl, "strength", &hole->strength) &&
                 !sdl_accept_float(sdl, "falloff", &hole->falloff))
            sdl_expected(sdl, "strength, falloff, inverse, repeat or turbulence");
        sdl_optional_comma(sdl);
    }
    fit_block(&hole->center.x, &hole->repeat.x, hole->displacement.x, hole->radius);
    fit_block(&hole->center.y, &hole->repeat.y, hole->displacement.y, hole->radius);
    fit_block(&hole->center.z, &hole->repeat.z, hole->displacement.z, hole->radius);
}

static void repeat(Sdl *sdl, Warp *warp)
{
    const Vec3 along = sdl_vector(sdl);
    Vec3 flip = {0};
    warp->repeat.axis = along.x != 0 ? 0 : along.y != 0 ? 1 : 2;
    warp->repeat.width = (float)(along.x + along.y + along.z);
    if ((along.x != 0) + (along.y != 0) + (along.z != 0) != 1)
        sdl_error(sdl, "repeat needs a direction along one axis");
    while (!sdl_is(sdl, "}")) {
        if (sdl_accept(sdl, "flip"))
            flip = sdl_vector(sdl);
        else if (sdl_accept(sdl, "offset"))
            warp->repeat.offset = sdl_vector(sdl);
        else
            sdl_expected(sdl, "flip or offset");
        sdl_optional_comma(sdl);
    }
    warp->repeat.flip = vec3(flip.x != 0 ? -1 : 1, flip.y != 0 ? -1 : 1, flip.z != 0 ? -1 : 1);
}

static void set_orientation(Sdl *sdl, Warp *warp, Vec3 orientation)
{
    if (vec_length(orientation) == 0)
        sdl_error(sdl, "a warp needs a direction, not the zero vector");
    warp->mapping.orientation = vec_normalize(orientation);
}

static void mapping(Sdl *sdl, Warp *warp)
{
    warp->mapping.orientation = vec3(0, 0, 1);
    warp->mapping.major_radius = 1;
    if (warp->apply == warp_planar && !sdl_is(sdl, "}")) {
        set_orientation(sdl, warp, sdl_vector(sdl));
        sdl_optional_comma(sdl);
        warp->mapping.offset = sdl_float(sdl);
    }
    while (!sdl_is(sdl, "}")) {
        if (sdl_accept(sdl, "orientation"))
            set_orientation(sdl, warp, sdl_vector(sdl));
        else if (!sdl_accept_float(sdl, "dist_exp", &warp->mapping.distance_exponent) &&
                 !sdl_accept_float(sdl, "major_radius", &warp->mapping.major_radius))
            sdl_expected(sdl, "orientation, dist_exp or major_radius");
        sdl_optional_comma(sdl);
    }
}

static void turbulence(Sdl *sdl, Warp *warp)
{
    warp->turbulence = TURBULENCE_INIT;
    warp->turbulence.amount = sdl_vector(sdl);
    while (accept_turbulence(sdl, &warp->turbulence))
        sdl_optional_comma(sdl);
}

static const struct {
    const char *word;
    WarpFunction *apply;
    void (*parse)(Sdl *, Warp *);
} kinds[] = {
    {"black_hole", warp_black_hole, black_hole},
    {"repeat", warp_repeat, repeat},
    {"planar", warp_planar, mapping},
    {"cylindrical", warp_cylindrical, mapping},
    {"spherical", warp_spherical, mapping},
    {"toroidal", warp_toroidal, mapping},
    {"cubic", warp_cubic, mapping},
    {"turbulence", warp_turbulence, turbulence},
};

int accept_warp(Sdl *sdl, Pigment *pigment)
{
    const Transform *transform = &pigment->transform;
    if (!sdl_accept(sdl, "warp"))
        return 0;
    Warp *warp = sdl_alloc(sdl, sizeof *warp);
    *warp = (Warp){.next = pigment->pattern.warps, .is_moved = !transform_is_identity(transform), .moved = *transform};
    sdl_expect(sdl, "{");
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && !warp->apply; i++)
        if (sdl_accept(sdl, kinds[i].word)) {
            warp->apply = kinds[i].apply;
            kinds[i].parse(sdl, warp);
        }
    if (!warp->apply)
        sdl_expected(sdl, "black_hole, repeat, turbulence, planar, cylindrical, spherical, toroidal or cubic");
    sdl_expect(sdl, "}");
    pigment->pattern.warps = warp;
    return 1;
}
