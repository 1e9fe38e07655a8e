/* Numbers of the working space and light: the curve is odd, so that negative numbers keep their sign. */
#include <math.h>
#include <retex/color.h>
#include "shade/working_space.h"

static float decode(const WorkingSpace *space, float x)
{
    const double v = fabs(x);

    return (float)copysign(space->kind == WORKING_SRGB ? retex_srgb_decode(v) : pow(v, space->gamma), x);
}

static float encode(const WorkingSpace *space, float x)
{
    const double v = fabs(x);

    return (float)copysign(space->kind == WORKING_SRGB ? retex_srgb_encode(v) : pow(v, 1 / space->gamma), x);
}

int working_is_linear(const WorkingSpace *space)
{
    return !space || space->kind == WORKING_LINEAR;
}

Rgb working_decode(const WorkingSpace *space, Rgb c)
{
    return working_is_linear(space) ? c : rgb(decode(space, c.r), decode(space, c.g), decode(space, c.b));
}

Rgb working_encode(const WorkingSpace *space, Rgb c)
{
    return working_is_linear(space) ? c : rgb(encode(space, c.r), encode(space, c.g), encode(space, c.b));
}

static Rgbft with_color(Rgbft from, Rgb c)
{
    return (Rgbft){c.r, c.g, c.b, from.filter, from.transmit};
}

Rgbft working_decode_pigment(const WorkingSpace *space, Rgbft c)
{
    return working_is_linear(space) ? c : with_color(c, working_decode(space, rgb(c.r, c.g, c.b)));
}

Rgbft working_encode_pigment(const WorkingSpace *space, Rgbft c)
{
    return working_is_linear(space) ? c : with_color(c, working_encode(space, rgb(c.r, c.g, c.b)));
}
