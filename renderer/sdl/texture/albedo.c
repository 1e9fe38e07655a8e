/* Warns of pigments that are no albedo: a surface of such a colour would reflect more light than arrives. Emitters may
 * have any colour. Each pigment is warned of once, at the line where its colour is written. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/texture/texture.h"

/* 1, and a margin for rounding. */
#define LARGEST_ALBEDO 1.001

int finish_is_emitter(const Finish *finish)
{
    const int lamp = rgb_max(finish->ambient) >= 1 && finish->diffuse == 0;
    return lamp || !rgb_is_black(finish->emission) || (finish->diffuse <= 0 && !finish->retex.present);
}

/* The share of the light that a white surface of this finish reflects. */
static double reflectance_of_white(const Finish *finish)
{
    return finish->retex.present ? 1 : finish->diffuse;
}

typedef struct Brightest {
    Rgbft color;
    double share; /* of the light that it reflects */
} Brightest;

static void consider_color(Sdl *sdl, const Finish *finish, Rgbft c, Brightest *found)
{
    const Rgb linear = decode_color(sdl, rgb(c.r, c.g, c.b));
    const double opaque = 1 - c.filter - c.transmit, share = rgb_max(linear) * opaque * reflectance_of_white(finish);
    if (fmaxf(c.r, fmaxf(c.g, c.b)) > LARGEST_ALBEDO && share > found->share)
        *found = (Brightest){c, share};
}

static void find_brightest(Sdl *sdl, const Pigment *pigment, const Finish *finish, Brightest *found)
{
    if (pigment->kind == PIGMENT_COLOR)
        consider_color(sdl, finish, pigment->color, found);
    if (pigment->kind != PIGMENT_PATTERN)
        return;
    for (int i = 0; i < pigment->map.count; i++) {
        const ColorMapEntry *entry = &pigment->map.entries[i];
        if (entry->pigment)
            find_brightest(sdl, entry->pigment, finish, found);
        else
            consider_color(sdl, finish, entry->color, found);
    }
}

static int was_warned_about(Sdl *sdl, const ParsedPigment *pigment)
{
    for (const ParsedPigment *p = textures_of(sdl)->pigments; p; p = p->next)
        if (p->warned && p->line == pigment->line && strcmp(p->file, pigment->file) == 0)
            return 1;
    return 0;
}

void check_albedo(Sdl *sdl, const Texture *texture)
{
    ParsedPigment *pigment = (ParsedPigment *)parsed_pigment(texture->pigment);
    Brightest found = {.share = LARGEST_ALBEDO};
    if (!pigment->line || finish_is_emitter(texture->finish))
        return;
    find_brightest(sdl, &pigment->pigment, texture->finish, &found);
    if (found.share <= LARGEST_ALBEDO || was_warned_about(sdl, pigment))
        return;
    pigment->warned = 1;
    const Rgbft c = found.color;
    const double largest = fmaxf(c.r, fmaxf(c.g, c.b));
    sdl_warn_at(sdl, pigment->file, pigment->line,
                "a surface of rgb <%g,%g,%g> gives back more light than it gets: colours go from 0 to 1%s", (double)c.r,
                (double)c.g, (double)c.b, largest > 4 && largest <= 255 ? ", not to 255" : "");
}
