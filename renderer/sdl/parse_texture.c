/* texture, material, interior: pigment and finish put together, in layers. */
#include <string.h>
#include "sdl/scene_side.h"

SideTexture *side_texture_copy(Sdl *sdl, const SideTexture *from)
{
    SideTexture *texture = sdl_alloc(sdl, sizeof *texture);
    *texture = *from;
    return texture;
}

static const SidePigment *pigment_of(const SideTexture *t)
{
    return (const SidePigment *)t->texture.pigment;
}
static const SideFinish *finish_of(const SideTexture *t)
{
    return (const SideFinish *)t->texture.finish;
}

/* A pigment with uv_mapping lies in the surface's own space: what moves the surface does not move it. */
const SideTexture *side_texture_moved(Sdl *sdl, const SideTexture *texture, const Transform *by)
{
    if (!texture || side_transform_is_identity(by))
        return texture;
    SideTexture *moved = side_texture_copy(sdl, texture);
    moved->below = side_texture_moved(sdl, texture->below, by);
    if (!texture->texture.pigment->uv_mapping) {
        SidePigment *pigment = side_pigment_new(sdl, pigment_of(texture));
        pigment->pigment.transform = transform_then(pigment->pigment.transform, *by);
        moved->texture.pigment = &pigment->pigment;
    }
    return moved;
}

const SideTexture *side_texture_over(Sdl *sdl, const SideTexture *top, const SideTexture *bottom)
{
    if (!bottom)
        return top;
    SideTexture *texture = side_texture_copy(sdl, top);
    texture->below = side_texture_over(sdl, top->below ? top->below : bottom, top->below ? bottom : NULL);
    if (!side_pigment_opaque(pigment_of(top)))
        gaps_add(&texture->gaps, GAP_LAYERED);
    return texture;
}

const SideTexture *side_texture_named(Sdl *sdl, const SideTexture *texture, const IdentList *more)
{
    if (!texture || !more)
        return texture;
    SideTexture *named = side_texture_copy(sdl, texture);
    named->texture.idents = sdl_ident_join(sdl, texture->texture.idents, more);
    named->below = side_texture_named(sdl, texture->below, more);
    return named;
}

/* Layers are not blended: the topmost that hides what is under it is shown, or the lowest. */
const SideTexture *side_texture_visible(const SideTexture *texture)
{
    while (texture->below && !side_pigment_opaque(pigment_of(texture)))
        texture = texture->below;
    return texture;
}

/* ---- texture ---- */

static void set_pigment(SideTexture *texture, SidePigment *pigment)
{
    if (texture->texture.uv_mapping)
        pigment->pigment.uv_mapping = 1;
    texture->texture.pigment = &pigment->pigment;
}

int side_accept_texture_part(Sdl *sdl, const SideTexture **texture)
{
    int pigment = sdl_is(sdl, "pigment"), finish = sdl_is(sdl, "finish"), normal = sdl_is(sdl, "normal");
    if (!pigment && !finish && !normal)
        return 0;
    SideTexture *changed = side_texture_copy(sdl, *texture ? *texture : side_of(sdl)->default_texture);
    sdl_next(sdl);
    if (pigment)
        set_pigment(changed, side_pigment_block(sdl, pigment_of(changed)));
    else if (finish)
        changed->texture.finish = &side_finish_block(sdl, finish_of(changed))->finish;
    else {
        gaps_add(&changed->gaps, GAP_NORMAL);
        sdl_skip_block(sdl);
    }
    *texture = changed;
    return 1;
}

/* `texture{PIGMENT}`, `texture{FINISH}`, `texture{NORMAL}`: an old habit that is still allowed. */
static int accept_part_ident(Sdl *sdl, const SideTexture **texture)
{
    const SidePigment *pigment = side_accept_ident(sdl, VALUE_PIGMENT);
    const SideFinish *finish = pigment ? NULL : side_accept_ident(sdl, VALUE_FINISH);
    if (!pigment && !finish && !side_peek_ident(sdl, VALUE_NORMAL))
        return 0;
    SideTexture *changed = side_texture_copy(sdl, *texture);
    if (pigment)
        set_pigment(changed, side_pigment_new(sdl, pigment));
    else if (finish)
        changed->texture.finish = &finish->finish;
    else {
        sdl_next(sdl);
        gaps_add(&changed->gaps, GAP_NORMAL);
    }
    *texture = changed;
    return 1;
}

static const SideTexture *pattern_texture(Sdl *sdl, SidePigment *pigment, const SideTexture *first, const Gaps *gaps)
{
    SideTexture *texture = side_texture_copy(sdl, first ? side_texture_visible(first) : side_of(sdl)->default_texture);
    texture->texture.pigment = &pigment->pigment;
    texture->texture.idents = NULL;
    texture->below = NULL;
    gaps_join(&texture->gaps, gaps);
    return texture;
}

/* tiles{ texture{…} tile2 texture{…} }: an old form of a checker; the first texture is that of the odd fields. */
static const SideTexture *tiles(Sdl *sdl)
{
    const SideTexture *first = NULL;
    SidePigment *pigment = side_pigment_new(sdl, NULL);
    pigment->pigment.kind = PIGMENT_CHECKER;
    sdl_expect(sdl, "{");
    side_color_list(sdl, &pigment->pigment.checker[1], 1, pigment, &first, 1);
    sdl_expect(sdl, "tile2");
    side_color_list(sdl, &pigment->pigment.checker[0], 1, pigment, &first, 1);
    sdl_expect(sdl, "}");
    return pattern_texture(sdl, pigment, first, &pigment->gaps);
}

static const SideTexture *material_map(Sdl *sdl)
{
    const SideTexture *first = NULL;
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "texture")) {
            const SideTexture *texture = side_texture_block(sdl);
            if (!first)
                first = texture;
        } else if (sdl_peek(sdl)->kind == TOKEN_END)
            sdl_expected(sdl, "} of the material_map");
        else
            sdl_next(sdl);
    }
    if (!first)
        sdl_error(sdl, "a material_map without textures");
    SideTexture *texture = side_texture_copy(sdl, first);
    gaps_add(&texture->gaps, GAP_MATERIAL_MAP);
    return texture;
}

/* One item of a texture's body; *whole becomes 1 where a pattern took the rest of it. */
static void texture_item(Sdl *sdl, const SideTexture **texture, char end, int *whole)
{
    Transform by;
    const SideTexture *known = side_accept_ident(sdl, VALUE_TEXTURE);
    if (known)
        *texture = known;
    else if (side_accept_texture_part(sdl, texture) || accept_part_ident(sdl, texture))
        ;
    else if (side_accept_transform(sdl, &by))
        *texture = side_texture_moved(sdl, *texture, &by);
    else if (sdl_accept(sdl, "no_bump_scale"))
        sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "uv_mapping")) {
        SideTexture *changed = side_texture_copy(sdl, *texture);
        changed->texture.uv_mapping = sdl_optional_bool(sdl, 1);
        set_pigment(changed, side_pigment_new(sdl, pigment_of(changed)));
        *texture = changed;
    } else if (sdl_accept(sdl, "tiles"))
        *texture = tiles(sdl);
    else if (sdl_accept(sdl, "material_map"))
        *texture = material_map(sdl);
    else {
        Gaps gaps = {{0}};
        const SideTexture *first = NULL;
        int uv_mapping = (*texture)->texture.uv_mapping;
        SidePigment *pigment = side_texture_pattern(sdl, end, &first, &gaps);
        SideTexture *made = side_texture_copy(sdl, pattern_texture(sdl, pigment, first, &gaps));
        made->texture.uv_mapping = uv_mapping;
        set_pigment(made, pigment);
        *texture = made;
        *whole = 1;
    }
}

const SideTexture *side_texture_body(Sdl *sdl, char end)
{
    const char closing[2] = {end, 0};
    const SideTexture *texture = side_of(sdl)->default_texture;
    int whole = 0;
    side_enter(sdl);
    while (!whole && !sdl_accept(sdl, closing))
        texture_item(sdl, &texture, end, &whole);
    side_leave(sdl);
    return texture;
}

const SideTexture *side_texture_block(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    return side_texture_body(sdl, '}');
}

/* ---- interior ---- */

static void interior_item(Sdl *sdl, SideInterior *interior)
{
    Interior *i = &interior->interior;
    const SideInterior *known = side_accept_ident(sdl, VALUE_INTERIOR);
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
    } else if (side_peek_ident(sdl, VALUE_OTHER)) {
        gaps_add(&interior->gaps, GAP_MEDIA);
        sdl_next(sdl);
    } else
        sdl_expected(sdl, "ior, fade_distance, fade_power, fade_color, media or } in interior");
}

const SideInterior *side_interior_block(Sdl *sdl, const SideInterior *from)
{
    SideInterior *interior = sdl_alloc(sdl, sizeof *interior);
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

const SideMaterial *side_material_block(Sdl *sdl)
{
    SideMaterial *material = sdl_alloc(sdl, sizeof *material);
    Transform by;
    side_enter(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        const SideMaterial *known = side_accept_ident(sdl, VALUE_MATERIAL);
        if (known)
            *material = *known;
        else if (sdl_accept(sdl, "texture"))
            material->texture = side_texture_over(sdl, side_texture_block(sdl), material->texture);
        else if (sdl_accept(sdl, "interior_texture"))
            material->interior_texture = side_texture_over(sdl, side_texture_block(sdl), material->interior_texture);
        else if (sdl_accept(sdl, "interior"))
            material->interior = side_interior_block(sdl, material->interior);
        else if (side_accept_transform(sdl, &by)) {
            material->texture = side_texture_moved(sdl, material->texture, &by);
            material->interior_texture = side_texture_moved(sdl, material->interior_texture, &by);
        } else if (!side_accept_texture_part(sdl, &material->texture))
            sdl_expected(sdl, "texture, interior, interior_texture or a transform in material");
    }
    side_leave(sdl);
    return material;
}
