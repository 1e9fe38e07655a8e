/* Pigments that are no albedo: a surface of such a colour would give back more light than it gets. What shines may be
 * as bright as it likes. Each is warned of once, where its colour is written. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/build/builder.h"

/* White, and some for rounding. */
#define MOST_ALBEDO 1.001

int finish_emits(const Finish *finish)
{
    const int lamp = rgb_max(finish->ambient) >= 1 && finish->diffuse == 0;
    return lamp || !rgb_is_black(finish->emission) || (finish->diffuse <= 0 && !finish->retex.present);
}

/* How many times the light that arrives a surface of this finish gives back, all its colour being white. */
static double white_of(const Finish *finish)
{
    return finish->retex.present ? 1 : finish->diffuse;
}

typedef struct Brightest {
    Rgbft color;
    double share; /* of the light that it gives back */
} Brightest;

static void look_at(Sdl *sdl, const Finish *finish, Rgbft c, Brightest *found)
{
    const Rgb linear = decode_color(sdl, rgb(c.r, c.g, c.b));
    const double opaque = 1 - c.filter - c.transmit, share = rgb_max(linear) * opaque * white_of(finish);
    if (fmaxf(c.r, fmaxf(c.g, c.b)) > MOST_ALBEDO && share > found->share)
        *found = (Brightest){c, share};
}

static void look_at_all(Sdl *sdl, const Pigment *pigment, const Finish *finish, Brightest *found)
{
    if (pigment->kind == PIGMENT_COLOR)
        look_at(sdl, finish, pigment->color, found);
    if (pigment->kind != PIGMENT_PATTERN)
        return;
    const int colors = pigment->pattern.ops->colors;
    for (int i = 0; i < colors; i++)
        look_at(sdl, finish, pigment->colors[i], found);
    for (int i = 0; !colors && i < pigment->map.count; i++)
        look_at(sdl, finish, pigment->map.entries[i].color, found);
}

static int was_told(Sdl *sdl, const ParsedPigment *pigment)
{
    for (const ParsedPigment *p = builder_of(sdl)->pigments; p; p = p->next)
        if (p->told && p->line == pigment->line && strcmp(p->file, pigment->file) == 0)
            return 1;
    return 0;
}

void check_albedo(Sdl *sdl, const Texture *texture)
{
    ParsedPigment *pigment = (ParsedPigment *)texture->pigment;
    Brightest found = {.share = MOST_ALBEDO};
    if (!pigment->line || finish_emits(texture->finish))
        return;
    look_at_all(sdl, &pigment->pigment, texture->finish, &found);
    if (found.share <= MOST_ALBEDO || was_told(sdl, pigment))
        return;
    pigment->told = 1;
    const Rgbft c = found.color;
    const double largest = fmaxf(c.r, fmaxf(c.g, c.b));
    sdl_warn_at(sdl, pigment->file, pigment->line,
                "a surface of rgb <%g,%g,%g> gives back more light than it gets: colours go from 0 to 1%s", (double)c.r,
                (double)c.g, (double)c.b, largest > 4 && largest <= 255 ? ", not to 255" : "");
}
