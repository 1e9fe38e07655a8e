/* texture: pigment, finish and normal put together. */
#include "sdl/texture/texture.h"

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
    ParsedTexture *changed = plain_copy(sdl, *texture ? *texture : textures_of(sdl)->default_texture);
    sdl_next(sdl);
    if (pigment)
        set_pigment(changed, (changed->texture.uv_mapping ? parse_pigment : parse_shared_pigment)(
                                 sdl, parsed_pigment(changed->texture.pigment)));
    else if (finish)
        changed->texture.finish = &parse_finish(sdl, parsed_finish(changed->texture.finish))->finish;
    else
        set_normal(changed, normal_changed(sdl, parse_normal(sdl, parsed_normal(changed->texture.normal)),
                                           changed->texture.uv_mapping, 0));
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

/* A texture's body while it is read. */
typedef struct Body {
    const ParsedTexture *texture;
    int uv_mapping; /* it says so itself: until its end, transforms move its pigment and its normal all the same */
    int is_whole;   /* a pattern took the rest of it */
} Body;

static void texture_item(Sdl *sdl, Body *body, char end)
{
    const ParsedTexture **texture = &body->texture;
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
        set_normal(changed, normal_changed(sdl, parsed_normal(changed->texture.normal), 0, sdl_optional_bool(sdl, 1)));
        *texture = changed;
    } else if (sdl_accept(sdl, "uv_mapping"))
        body->uv_mapping = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "tiles"))
        *texture = parse_tiles(sdl);
    else if (sdl_accept(sdl, "material_map"))
        *texture = parse_material_map(sdl);
    else {
        *texture = parse_texture_pattern(sdl, end, body->uv_mapping || (*texture)->texture.uv_mapping);
        body->is_whole = 1;
    }
}

const ParsedTexture *parse_texture_body(Sdl *sdl, char end)
{
    const char closing[2] = {end, 0};
    Body body = {textures_of(sdl)->default_texture, 0, 0};
    statement_begin(sdl);
    while (!body.is_whole && !sdl_accept(sdl, closing))
        texture_item(sdl, &body, end);
    statement_end(sdl);
    return body.uv_mapping && !body.is_whole ? texture_uv_mapped(sdl, body.texture) : body.texture;
}

const ParsedTexture *parse_texture(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    return parse_texture_body(sdl, '}');
}

void texture_begin(Sdl *sdl)
{
    ParsedTexture *texture = sdl_alloc(sdl, sizeof *texture);
    builder_of(sdl)->texture = sdl_alloc(sdl, sizeof *builder_of(sdl)->texture);
    texture->texture.pigment = &pigment_new(sdl, NULL)->pigment;
    texture->texture.finish = &finish_new(sdl, NULL)->finish;
    textures_of(sdl)->default_texture = texture;
}
