/* rainbow. */
#include <string.h>
#include "pattern/patterns.h"
#include "sdl/medium/air.h"

static const Rainbow *accept_rainbow_ident(Sdl *sdl)
{
    const Value *value = peek_ident(sdl, VALUE_OTHER);
    return value && value->word && strcmp(value->word, "rainbow") == 0 ? accept_ident(sdl, VALUE_OTHER) : NULL;
}

/* A gradient along x. */
static const Pigment *map_pigment(Sdl *sdl, const ParsedColorMap *map)
{
    ParsedPigment *pigment = pigment_new(sdl, NULL);
    pigment->pigment.kind = PIGMENT_PATTERN;
    pigment->pigment.pattern.ops = &pattern_gradient;
    pigment->pigment.pattern.vector = vec3(1, 0, 0);
    pigment_set_map(pigment, map);
    return &pigment->pigment;
}

static double half_angle(Sdl *sdl)
{
    return sdl_float(sdl) * PI / 360;
}

static void rainbow_item(Sdl *sdl, Rainbow *bow, int *has_falloff)
{
    const Rainbow *known = accept_rainbow_ident(sdl);
    if (known)
        *bow = *known;
    else if (sdl_accept(sdl, "direction"))
        bow->direction = sdl_vector(sdl);
    else if (sdl_accept(sdl, "up"))
        bow->up = sdl_vector(sdl);
    else if (sdl_accept(sdl, "angle"))
        bow->angle = 2 * half_angle(sdl);
    else if (sdl_accept(sdl, "width"))
        bow->width = 2 * half_angle(sdl);
    else if (sdl_accept(sdl, "distance"))
        bow->distance = sdl_float(sdl);
    else if (sdl_accept(sdl, "jitter"))
        bow->jitter = sdl_float(sdl);
    else if (sdl_accept(sdl, "arc_angle"))
        bow->arc = half_angle(sdl);
    else if (sdl_accept(sdl, "falloff_angle"))
        bow->falloff = half_angle(sdl), *has_falloff = 1;
    else if (sdl_accept(sdl, "color_map") || sdl_accept(sdl, "colour_map"))
        bow->colors = map_pigment(sdl, parse_color_map(sdl));
    else
        sdl_expected(sdl, "direction, angle, width, distance, color_map, jitter, up, arc_angle, falloff_angle or } in "
                          "rainbow");
}

Rainbow *parse_rainbow(Sdl *sdl)
{
    Rainbow *bow = sdl_alloc(sdl, sizeof *bow);
    int has_falloff = 0;
    *bow = (Rainbow){.up = {0, 1, 0}, .distance = 1e7, .arc = PI, .falloff = PI};
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        rainbow_item(sdl, bow, &has_falloff), sdl_optional_comma(sdl);
    if (has_falloff && bow->falloff > bow->arc)
        sdl_error(sdl, "falloff_angle is larger than arc_angle");
    return bow;
}

void place_rainbow(Sdl *sdl, const Rainbow *parsed)
{
    Scene *scene = sdl_scene(sdl);
    Rainbow *bow = sdl_alloc(sdl, sizeof *bow);
    *bow = *parsed;
    if (!(vec_length(bow->direction) > 0))
        sdl_error(sdl, "a rainbow needs a direction");
    bow->direction = vec_normalize(bow->direction);
    bow->right = vec_cross(bow->up, bow->direction);
    if (!(vec_length(bow->right) > 1e-9))
        sdl_error(sdl, "up of a rainbow lies along its direction");
    bow->right = vec_normalize(bow->right);
    bow->up = vec_cross(bow->direction, bow->right);
    if (!bow->colors || bow->width == 0 || !(bow->distance > 0))
        return; /* as in POV-Ray */
    bow->next = scene->rainbows;
    scene->rainbows = bow;
}
