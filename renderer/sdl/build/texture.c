/* texture, material, interior: pigment and finish put together. */
#include "sdl/build/builder.h"

static const ParsedPigment *pigment_of(const ParsedTexture *t)
{
    return (const ParsedPigment *)t->texture.pigment;
}
static const ParsedFinish *finish_of(const ParsedTexture *t)
{
    return (const ParsedFinish *)t->texture.finish;
}

static const ParsedNormal *normal_of(const ParsedTexture *t)
{
    return (const ParsedNormal *)t->texture.normal;
}

static void set_normal(ParsedTexture *texture, const ParsedNormal *normal)
{
    texture->texture.normal = normal ? &normal->normal : NULL;
}

/* ---- texture ---- */

static void set_pigment(ParsedTexture *texture, ParsedPigment *pigment)
{
    if (texture->texture.uv_mapping)
        pigment->pigment.uv_mapping = 1;
    texture->texture.pigment = &pigment->pigment;
}

/* Of a texture whose pigment, normal or finish is going to be changed. */
static ParsedTexture *plain_copy(Sdl *sdl, const ParsedTexture *texture)
{
    if (texture->map)
        sdl_error(sdl, "a pattern of textures has no pigment, normal or finish of its own");
    return texture_copy(sdl, texture);
}

int accept_texture_part(Sdl *sdl, const ParsedTexture **texture)
{
    int pigment = sdl_is(sdl, "pigment"), finish = sdl_is(sdl, "finish"), normal = sdl_is(sdl, "normal");
    if (!pigment && !finish && !normal)
        return 0;
    ParsedTexture *changed = plain_copy(sdl, *texture ? *texture : builder_of(sdl)->default_texture);
    sdl_next(sdl);
    if (pigment)
        set_pigment(changed,
                    (changed->texture.uv_mapping ? parse_pigment : parse_shared_pigment)(sdl, pigment_of(changed)));
    else if (finish)
        changed->texture.finish = &parse_finish(sdl, finish_of(changed))->finish;
    else
        set_normal(changed, normal_changed(sdl, parse_normal(sdl, normal_of(changed)), changed->texture.uv_mapping, 0));
    *texture = changed;
    return 1;
}

/* `texture{PIGMENT}`, `texture{FINISH}`, `texture{NORMAL}`: an old habit that is still allowed. */
static int accept_part_ident(Sdl *sdl, const ParsedTexture **texture)
{
    const ParsedPigment *pigment = accept_ident(sdl, VALUE_PIGMENT);
    const ParsedFinish *finish = pigment ? NULL : accept_ident(sdl, VALUE_FINISH);
    const ParsedNormal *normal = pigment || finish ? NULL : accept_ident(sdl, VALUE_NORMAL);
    if (!pigment && !finish && !normal)
        return 0;
    ParsedTexture *changed = plain_copy(sdl, *texture);
    if (pigment)
        set_pigment(changed, pigment_new(sdl, pigment));
    else if (finish)
        changed->texture.finish = &finish->finish;
    else
        set_normal(changed, normal_changed(sdl, normal, changed->texture.uv_mapping, 0));
    *texture = changed;
    return 1;
}

/* One item of a texture's body; *whole becomes 1 where a pattern took the rest of it. */
static void texture_item(Sdl *sdl, const ParsedTexture **texture, char end, int *whole)
{
    Transform by;
    const ParsedTexture *known = accept_ident(sdl, VALUE_TEXTURE);
    if (known)
        *texture = known;
    else if (accept_texture_part(sdl, texture) || accept_part_ident(sdl, texture))
        ;
    else if (accept_transform(sdl, &by))
        *texture = texture_moved(sdl, *texture, &by);
    else if (sdl_accept(sdl, "no_bump_scale")) {
        ParsedTexture *changed = plain_copy(sdl, *texture);
        set_normal(changed, normal_changed(sdl, normal_of(changed), 0, sdl_optional_bool(sdl, 1)));
        *texture = changed;
    } else if (sdl_accept(sdl, "uv_mapping")) {
        ParsedTexture *changed = plain_copy(sdl, *texture);
        changed->texture.uv_mapping = sdl_optional_bool(sdl, 1);
        set_pigment(changed, pigment_new(sdl, pigment_of(changed)));
        set_normal(changed, normal_changed(sdl, normal_of(changed), changed->texture.uv_mapping, 0));
        *texture = changed;
    } else if (sdl_accept(sdl, "tiles"))
        *texture = parse_tiles(sdl);
    else if (sdl_accept(sdl, "material_map"))
        *texture = parse_material_map(sdl);
    else {
        *texture = parse_texture_pattern(sdl, end, (*texture)->texture.uv_mapping);
        *whole = 1;
    }
}

const ParsedTexture *parse_texture_body(Sdl *sdl, char end)
{
    const char closing[2] = {end, 0};
    const ParsedTexture *texture = builder_of(sdl)->default_texture;
    int whole = 0;
    statement_begin(sdl);
    while (!whole && !sdl_accept(sdl, closing))
        texture_item(sdl, &texture, end, &whole);
    statement_end(sdl);
    return texture;
}

const ParsedTexture *parse_texture(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    return parse_texture_body(sdl, '}');
}

/* ---- interior ---- */

static void interior_item(Sdl *sdl, ParsedInterior *interior)
{
    Interior *i = &interior->interior;
    const ParsedInterior *known = accept_ident(sdl, VALUE_INTERIOR);
    if (known)
        *interior = *known;
    else if (sdl_accept(sdl, "ior"))
        i->ior = sdl_float(sdl), interior->has_ior = 1;
    else if (sdl_accept(sdl, "fade_distance"))
        i->fade_distance = sdl_float(sdl);
    else if (sdl_accept(sdl, "fade_power"))
        i->fade_power = sdl_float(sdl);
    else if (sdl_accept(sdl, "fade_color") || sdl_accept(sdl, "fade_colour")) {
        Rgbft c = sdl_color(sdl);
        i->fade_color = rgb(c.r, c.g, c.b);
    } else if (sdl_accept(sdl, "caustics")) {
        if (sdl_float(sdl) != 0)
            gaps_add(&interior->gaps, GAP_FAKE_CAUSTICS);
    } else if (sdl_accept(sdl, "refraction") || sdl_accept(sdl, "dispersion_samples"))
        sdl_float(sdl);
    else if (sdl_accept(sdl, "dispersion"))
        i->dispersion = sdl_float(sdl);
    else if (sdl_accept(sdl, "media"))
        i->media = media_with(sdl, i->media, parse_media(sdl));
    else
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
