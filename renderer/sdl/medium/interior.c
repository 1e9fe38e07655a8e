/* interior, material. */
#include "sdl/medium/interior.h"

/* ---- interior ---- */

static void interior_item(Sdl *sdl, ParsedInterior *interior)
{
    Interior *i = &interior->interior;
    const ParsedInterior *known = accept_ident(sdl, VALUE_INTERIOR);
    if (known)
        *interior = *known;
    else if (sdl_accept(sdl, "ior"))
        i->ior = sdl_float(sdl), interior->has_ior = 1;
    else if (sdl_accept(sdl, "fade_color") || sdl_accept(sdl, "fade_colour")) {
        Rgbft c = sdl_color(sdl);
        i->fade_color = rgb(c.r, c.g, c.b);
    } else if (sdl_accept(sdl, "caustics")) {
        if (sdl_float(sdl) != 0)
            gaps_add(&interior->gaps, GAP_FAKE_CAUSTICS);
    } else if (sdl_accept(sdl, "refraction") || sdl_accept(sdl, "dispersion_samples"))
        sdl_float(sdl);
    else if (sdl_accept(sdl, "media"))
        i->media = media_with(sdl, i->media, parse_media(sdl));
    else if (!sdl_accept_float(sdl, "fade_distance", &i->fade_distance) &&
             !sdl_accept_float(sdl, "fade_power", &i->fade_power) &&
             !sdl_accept_float(sdl, "dispersion", &i->dispersion))
        sdl_expected(sdl, "ior, fade_distance, fade_power, fade_color, media or } in interior");
}

const ParsedInterior *parse_interior(Sdl *sdl, const ParsedInterior *from)
{
    ParsedInterior *interior = sdl_alloc(sdl, sizeof *interior);
    if (from)
        *interior = *from;
    else
        interior->interior.ior = 1;
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        interior_item(sdl, interior);
    if (!interior->has_ior)
        interior->interior.dispersion = 1; /* as in POV-Ray */
    return interior;
}

/* ---- material ---- */

const ParsedMaterial *parse_material(Sdl *sdl)
{
    ParsedMaterial *material = sdl_alloc(sdl, sizeof *material);
    Transform by;
    statement_begin(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        const ParsedMaterial *known = accept_ident(sdl, VALUE_MATERIAL);
        if (known)
            *material = *known;
        else if (sdl_accept(sdl, "texture"))
            material->texture = texture_over(sdl, parse_texture(sdl), material->texture);
        else if (sdl_accept(sdl, "interior_texture"))
            material->interior_texture = texture_over(sdl, parse_texture(sdl), material->interior_texture);
        else if (sdl_accept(sdl, "interior"))
            material->interior = parse_interior(sdl, material->interior);
        else if (accept_transform(sdl, &by)) {
            material->texture = texture_moved(sdl, material->texture, &by);
            material->interior = interior_moved(sdl, material->interior, &by);
            material->interior_texture = texture_moved(sdl, material->interior_texture, &by);
        } else if (!accept_texture_part(sdl, &material->texture))
            sdl_expected(sdl, "texture, interior, interior_texture or a transform in material");
    }
    statement_end(sdl);
    return material;
}
