/* What the language calls: statements at top level and declarations. */
#include "sdl/statements.h"

#include <string.h>

#include "base/noise.h"
#include "sdl/camera/camera.h"
#include "sdl/medium/air.h"
#include "sdl/place/place.h"

/* ---- state ---- */

static void begin(Sdl *sdl)
{
    Builder *builder = sdl_alloc(sdl, sizeof *builder);
    sdl_set_builder_state(sdl, builder);
    texture_begin(sdl);
    object_begin(sdl);
    camera_begin(sdl);
    place_begin(sdl);
    Scene *scene = sdl_scene(sdl);
    scene->ambient_light = rgb_grey(1);
    builder->global.assumed_gamma = 1;
    builder->global.irid_wavelength = rgb(0.70f, 0.52f, 0.48f);
    builder->global.mm_per_unit = 10;
    scene->number_of_waves = 10;
    scene->noise_generator = NOISE_RANGE_CORRECTED;
}

static void set_default(Sdl *sdl)
{
    TextureState *textures = textures_of(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_is(sdl, "texture"))
            sdl_next(sdl), textures->default_texture = parse_texture(sdl);
        else if (sdl_is(sdl, "camera"))
            sdl_next(sdl), cameras_of(sdl)->camera = *parse_camera(sdl);
        else if (sdl_is(sdl, "radiosity"))
            skip_statement(sdl);
        else if (!accept_texture_part(sdl, &textures->default_texture))
            sdl_expected(sdl, "texture, pigment, normal, finish or camera in #default");
    }
}

/* ---- declarations ---- */

static void set(Value *value, ValueKind kind, const void *data)
{
    memset(value, 0, sizeof *value);
    value->kind = kind;
    value->data = (void *)data; /* immutable from here on, whatever Value's type says */
}

/* What has no kind of its own is told by its word. */
static void set_other(Value *value, const char *word, const void *data)
{
    set(value, VALUE_OTHER, data);
    value->word = word;
}

/* Words whose value is known of, so that it can be named and handed on, but means nothing here. */
static int declare_ignored(Sdl *sdl, Value *value)
{
    static const char *const words[] = {"radiosity", NULL};
    for (int i = 0; words[i]; i++)
        if (sdl_is(sdl, words[i])) {
            skip_statement(sdl);
            set_other(value, words[i], NULL);
            return 1;
        }
    return 0;
}

static int declare_surface(Sdl *sdl, Value *value)
{
    if (sdl_accept(sdl, "texture")) {
        const ParsedTexture *texture = parse_texture(sdl);
        /* `texture{…} texture{…}` is one value of two layers. Directives that follow are not run: the next #declare
         * may use the very name that is being declared. */
        while (sdl_accept_written(sdl, "texture"))
            texture = texture_over(sdl, parse_texture(sdl), texture);
        set(value, VALUE_TEXTURE, texture);
    } else if (sdl_accept(sdl, "pigment"))
        set(value, VALUE_PIGMENT, parse_pigment(sdl, default_pigment(sdl)));
    else if (sdl_accept(sdl, "finish"))
        set(value, VALUE_FINISH, parse_finish(sdl, parsed_finish(textures_of(sdl)->default_texture->texture.finish)));
    else if (sdl_accept(sdl, "normal"))
        set(value, VALUE_NORMAL, parse_normal(sdl, default_normal(sdl)));
    else if (sdl_accept(sdl, "interior"))
        set(value, VALUE_INTERIOR, parse_interior(sdl, NULL));
    else if (sdl_accept(sdl, "material"))
        set(value, VALUE_MATERIAL, parse_material(sdl));
    else
        return 0;
    return 1;
}

static int declare_map(Sdl *sdl, Value *value)
{
    if (sdl_accept(sdl, "color_map") || sdl_accept(sdl, "colour_map"))
        set(value, VALUE_COLOR_MAP, parse_color_map(sdl));
    else if (sdl_accept(sdl, "pigment_map"))
        set_other(value, "pigment_map", parse_pigment_map(sdl));
    else if (sdl_accept(sdl, "texture_map"))
        set_other(value, "texture_map", parse_texture_map(sdl));
    else if (sdl_accept(sdl, "normal_map"))
        set_other(value, "normal_map", parse_normal_map(sdl));
    else if (sdl_accept(sdl, "slope_map"))
        set_other(value, "slope_map", parse_slope_map(sdl));
    else
        return 0;
    return 1;
}

/* `#declare B = A;` where A is no number: the same thing, which then has both names. */
static int declare_same(Sdl *sdl, Value *value)
{
    const Token *token = sdl_peek(sdl);
    if (token->kind != TOKEN_IDENT || !token->value)
        return 0;
    switch (token->value->kind) {
    case VALUE_TRANSFORM:
    case VALUE_PIGMENT:
    case VALUE_NORMAL:
    case VALUE_FINISH:
    case VALUE_TEXTURE:
    case VALUE_INTERIOR:
    case VALUE_MATERIAL:
    case VALUE_OBJECT:
    case VALUE_CAMERA:
    case VALUE_LIGHT:
    case VALUE_COLOR_MAP:
    case VALUE_SKY_SPHERE:
    case VALUE_OTHER:
        *value = *token->value;
        sdl_next(sdl);
        return 1;
    default:
        return 0;
    }
}

/* What is around all objects. */
static int declare_around(Sdl *sdl, Value *value)
{
    if (sdl_accept(sdl, "fog"))
        set_other(value, "fog", parse_fog(sdl));
    else if (sdl_accept(sdl, "rainbow"))
        set_other(value, "rainbow", parse_rainbow(sdl));
    else if (sdl_accept(sdl, "media"))
        set_other(value, "media", parse_media(sdl));
    else if (sdl_accept(sdl, "density"))
        set_other(value, "density", parse_density(sdl));
    else if (sdl_accept(sdl, "camera"))
        set(value, VALUE_CAMERA, parse_camera(sdl));
    else if (sdl_accept(sdl, "sky_sphere"))
        set(value, VALUE_SKY_SPHERE, parse_sky_sphere(sdl));
    else
        return 0;
    return 1;
}

static int declare(Sdl *sdl, Value *value)
{
    if (declare_same(sdl, value) || declare_surface(sdl, value) || declare_map(sdl, value) ||
        declare_ignored(sdl, value))
        return 1;
    if (sdl_accept(sdl, "transform")) {
        Transform *transform = sdl_alloc(sdl, sizeof *transform);
        *transform = parse_transform(sdl);
        set(value, VALUE_TRANSFORM, transform);
        return 1;
    }
    if (declare_around(sdl, value))
        return 1;
    const Object *object = accept_object(sdl);
    if (object)
        set(value, object->kind == OBJECT_LIGHT ? VALUE_LIGHT : VALUE_OBJECT, object);
    return object != NULL;
}

static void add_name(Sdl *sdl, Value *value, const char *name, int line)
{
    switch (value->kind) {
    case VALUE_TEXTURE:
        value->data = (void *)texture_named(sdl, value->data, sdl_ident_add(sdl, NULL, name, line));
        break;
    case VALUE_PIGMENT: {
        ParsedPigment *pigment = pigment_new(sdl, value->data);
        pigment->pigment.idents = sdl_ident_add(sdl, pigment->pigment.idents, name, line);
        value->data = pigment;
        break;
    }
    case VALUE_FINISH: {
        ParsedFinish *finish = finish_new(sdl, value->data);
        finish->name = sdl_ident_add(sdl, NULL, name, line)->name;
        value->data = finish;
        break;
    }
    case VALUE_CAMERA: {
        ParsedCamera *camera = sdl_alloc(sdl, sizeof *camera);
        *camera = *(const ParsedCamera *)value->data;
        camera->name = sdl_ident_add(sdl, NULL, name, line)->name, camera->next = cameras_of(sdl)->cameras;
        cameras_of(sdl)->cameras = value->data = camera;
        break;
    }
    case VALUE_INTERIOR: {
        ParsedInterior *interior = sdl_alloc(sdl, sizeof *interior);
        *interior = *(const ParsedInterior *)value->data;
        interior->interior.idents = sdl_ident_add(sdl, interior->interior.idents, name, line);
        value->data = interior;
        break;
    }
    case VALUE_MATERIAL: {
        ParsedMaterial *material = sdl_alloc(sdl, sizeof *material);
        *material = *(const ParsedMaterial *)value->data;
        material->idents = sdl_ident_add(sdl, material->idents, name, line);
        value->data = material;
        break;
    }
    case VALUE_LIGHT:
    case VALUE_OBJECT: {
        Object *object = sdl_alloc(sdl, sizeof *object);
        *object = *(const Object *)value->data;
        object->idents = sdl_ident_add(sdl, object->idents, name, line);
        value->data = object;
        break;
    }
    default:
        break;
    }
}

/* ---- statements ---- */

static void statement_camera(Sdl *sdl)
{
    camera_use(sdl, parse_camera(sdl));
}
static void statement_sky_sphere(Sdl *sdl)
{
    cameras_of(sdl)->sky = parse_sky_sphere(sdl);
}

static void statement_fog(Sdl *sdl)
{
    Fog *fog = parse_fog(sdl);
    fog->next = sdl_scene(sdl)->fogs;
    sdl_scene(sdl)->fogs = fog;
}

static void statement_rainbow(Sdl *sdl)
{
    place_rainbow(sdl, parse_rainbow(sdl));
}

static void statement_media(Sdl *sdl)
{
    sdl_scene(sdl)->media = media_with(sdl, sdl_scene(sdl)->media, parse_media(sdl));
}

static void statement(Sdl *sdl)
{
    static const struct {
        const char *word;
        void (*parse)(Sdl *sdl);
    } statements[] = {
        {"camera", statement_camera},     {"global_settings", parse_global_settings},
        {"background", parse_background}, {"sky_sphere", statement_sky_sphere},
        {"fog", statement_fog},           {"rainbow", statement_rainbow},
        {"media", statement_media},       {"default", set_default} /* old scenes leave out the # */,
    };
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++)
        if (sdl_accept(sdl, statements[i].word)) {
            statements[i].parse(sdl);
            return;
        }
    const Inherited world = {.to_world = transform_identity()};
    const int has_name = sdl_peek(sdl)->kind == TOKEN_IDENT;
    const Object *object = accept_object(sdl);
    if (!object)
        sdl_expected(sdl, "an object, a light, a camera or a directive");
    place_object(sdl, object, &world);
    if (!has_name)
        object_done(sdl, object);
}

const SdlBuilder scene_builder = {
    .begin = begin,
    .declare = declare,
    .name = add_name,
    .statement = statement,
    .set_default = set_default,
    .finish = finalize_scene,
    .extent = object_extent,
    .trace = object_trace,
    .inside = object_inside,
    .field = parse_field,
};
