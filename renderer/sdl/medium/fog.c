/* fog, and what is in the way of the air. */
#include "sdl/medium/air.h"
#include "shape/shape.h"

static Fog *fog_new(Sdl *sdl)
{
    Fog *fog = sdl_alloc(sdl, sizeof *fog);
    *fog = (Fog){.up = {0, 1, 0}, .turbulence = {.lambda = 2, .omega = 0.5, .octaves = 6}, .turbulence_depth = 0.5};
    return fog;
}

static FogKind fog_kind(Sdl *sdl)
{
    const double type = sdl_float(sdl);
    if (type != 1 && type != 2)
        sdl_error(sdl, "fog_type %g: there are 1, constant, and 2, ground fog", type);
    return type == 2 ? FOG_GROUND : FOG_CONSTANT;
}

static void fog_item(Sdl *sdl, Fog *fog)
{
    Transform by;
    const Fog *known = accept_ident_of_word(sdl, "fog");
    if (known)
        *fog = *known;
    else if (sdl_accept(sdl, "fog_type"))
        fog->kind = fog_kind(sdl);
    else if (sdl_accept(sdl, "distance"))
        fog->distance = sdl_float(sdl);
    else if (sdl_accept(sdl, "fog_offset"))
        fog->offset = sdl_float(sdl);
    else if (sdl_accept(sdl, "fog_alt"))
        fog->altitude = sdl_float(sdl);
    else if (sdl_accept(sdl, "turb_depth"))
        fog->turbulence_depth = sdl_float(sdl);
    else if (sdl_accept(sdl, "up"))
        fog->up = sdl_vector(sdl);
    else if (accept_turbulence(sdl, &fog->turbulence))
        fog->has_turbulence = 1;
    else if (accept_transform(sdl, &by))
        fog->up = transform_vector(&by, fog->up);
    else if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl)) {
        const Rgbft c = sdl_color(sdl);
        fog->color = rgb(c.r, c.g, c.b);
        fog->filter = c.filter, fog->transmit = c.transmit;
    } else
        sdl_expected(sdl, "a colour, distance, fog_type or another word of fog, a transform or }");
}

Fog *parse_fog(Sdl *sdl)
{
    Fog *fog = fog_new(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        fog_item(sdl, fog), sdl_optional_comma(sdl);
    fog->up = vec_normalize(fog->up);
    return fog;
}

/* ---- at the end of reading ---- */

/* As in POV-Ray, no distance is no fog. */
static void drop_empty_fogs(Sdl *sdl)
{
    for (Fog **fog = &sdl_scene(sdl)->fogs; *fog;) {
        if (!((*fog)->distance > 0)) {
            if ((*fog)->distance < 0)
                sdl_warn(sdl, "fog of a negative distance is left out");
            *fog = (*fog)->next;
        } else
            fog = &(*fog)->next;
    }
}

static int has_inside(const Primitive *p)
{
    return p->shape.mesh ? p->shape.mesh->closed_inside : p->shape.ops->inside != NULL;
}

void complete_air(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    drop_empty_fogs(sdl);
    for (int i = 0; (scene->fogs || scene->rainbows || scene->has_media) && i < scene->nprimitives; i++)
        scene->primitives[i].is_solid = !scene->primitives[i].hollow && has_inside(&scene->primitives[i]);
}
