/* texture, material, interior: pigment and finish put together, in layers. */
#include <string.h>
#include "pattern/patterns.h"
#include "sdl/build/builder.h"
#include "shade/pigment.h"

ParsedTexture *texture_copy(Sdl *sdl, const ParsedTexture *from)
{
    ParsedTexture *texture = sdl_alloc(sdl, sizeof *texture);
    *texture = *from;
    return texture;
}

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

/* A pigment with uv_mapping lies in the surface's own space: what moves the surface does not move it. */
const ParsedTexture *texture_moved(Sdl *sdl, const ParsedTexture *texture, const Transform *by)
{
    if (!texture || transform_is_identity(by))
        return texture;
    ParsedTexture *moved = texture_copy(sdl, texture);
    moved->below = texture_moved(sdl, texture->below, by);
    set_normal(moved, normal_moved(sdl, normal_of(texture), by));
    if (!texture->texture.pigment->uv_mapping) {
        ParsedPigment *pigment = pigment_new(sdl, pigment_of(texture));
        pigment->pigment.transform = transform_then(pigment->pigment.transform, *by);
        moved->texture.pigment = &pigment->pigment;
    }
    return moved;
}

const ParsedTexture *texture_over(Sdl *sdl, const ParsedTexture *top, const ParsedTexture *bottom)
{
    if (!bottom)
        return top;
    ParsedTexture *texture = texture_copy(sdl, top);
    texture->below = texture_over(sdl, top->below ? top->below : bottom, top->below ? bottom : NULL);
    if (!pigment_is_opaque(top->texture.pigment))
        gaps_add(&texture->gaps, GAP_LAYERED);
    return texture;
}

const ParsedTexture *texture_named(Sdl *sdl, const ParsedTexture *texture, const IdentList *more)
{
    if (!texture || !more)
        return texture;
    ParsedTexture *named = texture_copy(sdl, texture);
    named->texture.idents = sdl_ident_join(sdl, texture->texture.idents, more);
    named->below = texture_named(sdl, texture->below, more);
    return named;
}

/* Layers are not blended: the topmost that hides what is under it is shown, or the lowest. */
const ParsedTexture *texture_visible(const ParsedTexture *texture)
{
    while (texture->below && !pigment_is_opaque(texture->texture.pigment))
        texture = texture->below;
    return texture;
}

/* ---- texture ---- */

static void set_pigment(ParsedTexture *texture, ParsedPigment *pigment)
{
    if (texture->texture.uv_mapping)
        pigment->pigment.uv_mapping = 1;
    texture->texture.pigment = &pigment->pigment;
}

int accept_texture_part(Sdl *sdl, const ParsedTexture **texture)
{
    int pigment = sdl_is(sdl, "pigment"), finish = sdl_is(sdl, "finish"), normal = sdl_is(sdl, "normal");
    if (!pigment && !finish && !normal)
        return 0;
    ParsedTexture *changed = texture_copy(sdl, *texture ? *texture : builder_of(sdl)->default_texture);
    sdl_next(sdl);
    if (pigment)
        set_pigment(changed, parse_pigment(sdl, pigment_of(changed)));
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
    ParsedTexture *changed = texture_copy(sdl, *texture);
    if (pigment)
        set_pigment(changed, pigment_new(sdl, pigment));
    else if (finish)
        changed->texture.finish = &finish->finish;
    else
        set_normal(changed, normal_changed(sdl, normal, changed->texture.uv_mapping, 0));
    *texture = changed;
    return 1;
}

static const ParsedTexture *pattern_texture(Sdl *sdl, ParsedPigment *pigment, const ParsedTexture *first,
                                            const Gaps *gaps)
{
    ParsedTexture *texture = texture_copy(sdl, first ? texture_visible(first) : builder_of(sdl)->default_texture);
    texture->texture.pigment = &pigment->pigment;
    texture->texture.idents = NULL;
    texture->below = NULL;
    gaps_join(&texture->gaps, gaps);
    return texture;
}

/* tiles{ texture{…} tile2 texture{…} }: an old form of a checker; the first texture is that of the odd fields. */
static const ParsedTexture *tiles(Sdl *sdl)
{
    const ParsedTexture *first = NULL;
    ParsedPigment *pigment = pigment_new(sdl, NULL);
    pigment->pigment.kind = PIGMENT_PATTERN;
    pigment->pigment.pattern.ops = &pattern_checker;
    sdl_expect(sdl, "{");
    ParsedColorMap *map = color_list_new(sdl, 2);
    parse_color_list(sdl, map, 1, 1, &first, 1);
    sdl_expect(sdl, "tile2");
    parse_color_list(sdl, map, 0, 1, &first, 1);
    sdl_expect(sdl, "}");
    pigment_set_map(pigment, map);
    return pattern_texture(sdl, pigment, first, &pigment->gaps);
}

static const ParsedTexture *material_map(Sdl *sdl)
{
    const ParsedTexture *first = NULL;
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "texture")) {
            const ParsedTexture *texture = parse_texture(sdl);
            if (!first)
                first = texture;
        } else if (sdl_peek(sdl)->kind == TOKEN_END)
            sdl_expected(sdl, "} of the material_map");
        else
            sdl_next(sdl);
    }
    if (!first)
        sdl_error(sdl, "a material_map without textures");
    ParsedTexture *texture = texture_copy(sdl, first);
    gaps_add(&texture->gaps, GAP_MATERIAL_MAP);
    return texture;
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
        ParsedTexture *changed = texture_copy(sdl, *texture);
        set_normal(changed, normal_changed(sdl, normal_of(changed), 0, sdl_optional_bool(sdl, 1)));
        *texture = changed;
    } else if (sdl_accept(sdl, "uv_mapping")) {
        ParsedTexture *changed = texture_copy(sdl, *texture);
        changed->texture.uv_mapping = sdl_optional_bool(sdl, 1);
        set_pigment(changed, pigment_new(sdl, pigment_of(changed)));
        set_normal(changed, normal_changed(sdl, normal_of(changed), changed->texture.uv_mapping, 0));
        *texture = changed;
    } else if (sdl_accept(sdl, "tiles"))
        *texture = tiles(sdl);
    else if (sdl_accept(sdl, "material_map"))
        *texture = material_map(sdl);
    else {
        Gaps gaps = {0};
        const ParsedTexture *first = NULL;
        int uv_mapping = (*texture)->texture.uv_mapping;
        ParsedPigment *pigment = parse_texture_pattern(sdl, end, &first, &gaps);
        ParsedTexture *made = texture_copy(sdl, pattern_texture(sdl, pigment, first, &gaps));
        made->texture.uv_mapping = uv_mapping;
        set_pigment(made, pigment);
        *texture = made;
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
        i->ior = sdl_float(sdl);
    else if (sdl_accept(sdl, "fade_distance"))
        i->fade_distance = sdl_float(sdl);
    else if (sdl_accept(sdl, "fade_power"))
        i->fade_power = sdl_float(sdl);
    else if (sdl_accept(sdl, "fade_color") || sdl_accept(sdl, "fade_colour")) {
        Rgbft c = sdl_color(sdl);
        i->fade_color = rgb(c.r, c.g, c.b);
    } else if (sdl_accept(sdl, "caustics") || sdl_accept(sdl, "refraction") || sdl_accept(sdl, "dispersion_samples"))
        sdl_float(sdl);
    else if (sdl_accept(sdl, "dispersion")) {
        if (sdl_float(sdl) != 1)
            gaps_add(&interior->gaps, GAP_DISPERSION);
    } else if (sdl_accept(sdl, "media")) {
        gaps_add(&interior->gaps, GAP_MEDIA);
        sdl_skip_block(sdl);
    } else if (peek_ident(sdl, VALUE_OTHER)) {
        gaps_add(&interior->gaps, GAP_MEDIA);
        sdl_next(sdl);
    } else
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
            material->interior_texture = texture_moved(sdl, material->interior_texture, &by);
        } else if (!accept_texture_part(sdl, &material->texture))
            sdl_expected(sdl, "texture, interior, interior_texture or a transform in material");
    }
    statement_end(sdl);
    return material;
}
