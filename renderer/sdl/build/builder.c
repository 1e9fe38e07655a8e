/* What the language calls: the builder's state, statements at top level, declarations, and the report of what is not
 * supported. */
#include <string.h>
#include "pattern/pattern.h"
#include "sdl/build/build.h"
#include "base/noise.h"
#include "sdl/build/builder.h"

#define MAX_NESTING 200

static const struct {
    const char *name, *instead;
} gap_names[GAP_COUNT] = {
#define X(id, name, instead) [GAP_##id] = {name, instead},
    GAP_TABLE(X)
#undef X
};

void gaps_add(Gaps *gaps, Gap gap)
{
    gaps->bits |= (uint64_t)1 << gap;
}

void gaps_add_pattern(Gaps *gaps, int pattern)
{
    gaps->patterns |= (uint64_t)1 << pattern;
}

void gaps_join(Gaps *gaps, const Gaps *other)
{
    gaps->bits |= other->bits;
    gaps->patterns |= other->patterns;
}

void gaps_report(Sdl *sdl, const Gaps *gaps)
{
    for (int i = 0; gaps->patterns >> i && i < pattern_count(); i++)
        if (gaps->patterns >> i & 1) {
            const PatternOps *pattern = pattern_at(i);
            sdl_unsupported(sdl, pattern->name, "its mean colour is used");
        }
    for (int i = 0; gaps->bits >> i && i < GAP_COUNT; i++)
        if (gaps->bits >> i & 1)
            sdl_unsupported(sdl, gap_names[i].name, gap_names[i].instead);
}

/* ---- small helpers of all files ---- */

void statement_begin(Sdl *sdl)
{
    if (++builder_of(sdl)->depth > MAX_NESTING)
        sdl_error(sdl, "statements are nested more than %d deep", MAX_NESTING);
}

void statement_end(Sdl *sdl)
{
    builder_of(sdl)->depth--;
}

void *builder_grow(Sdl *sdl, void *array, int count, int *capacity, size_t size)
{
    if (count < *capacity)
        return array;
    if (*capacity > 1 << 28)
        sdl_error(sdl, "more than %d things of one kind", *capacity);
    *capacity = *capacity ? *capacity * 2 : 16;
    void *larger = sdl_alloc(sdl, (size_t)*capacity * size);
    if (count > 0)
        memcpy(larger, array, (size_t)count * size);
    return larger;
}

Value *peek_ident(Sdl *sdl, ValueKind kind)
{
    const Token *token = sdl_peek(sdl);
    return token->kind == TOKEN_IDENT && token->value && token->value->kind == kind ? token->value : NULL;
}

void *accept_ident(Sdl *sdl, ValueKind kind)
{
    Value *value = peek_ident(sdl, kind);
    if (!value)
        return NULL;
    void *data = value->data;
    sdl_next(sdl);
    return data;
}

void *accept_ident_of_word(Sdl *sdl, const char *word)
{
    const Value *value = peek_ident(sdl, VALUE_OTHER);
    return value && value->word && strcmp(value->word, word) == 0 ? accept_ident(sdl, VALUE_OTHER) : NULL;
}

int is_float_start(Sdl *sdl)
{
    const Token *token = sdl_peek(sdl);
    switch (token->kind) {
    case TOKEN_NUMBER:
        return 1;
    case TOKEN_IDENT:
        return token->value && token->value->kind == VALUE_FLOAT;
    case TOKEN_PUNCT:
        return token->punct == '-' || token->punct == '+' || token->punct == '(';
    default:
        return !sdl_is_color_start(sdl) && sdl_is_expression_start(sdl) && !sdl_is(sdl, "<");
    }
}

double optional_float(Sdl *sdl, double missing)
{
    return is_float_start(sdl) ? sdl_float(sdl) : missing;
}

void skip_statement(Sdl *sdl)
{
    sdl_next(sdl);
    sdl_skip_block(sdl);
}

/* ---- state ---- */

static void begin(Sdl *sdl)
{
    Builder *builder = sdl_alloc(sdl, sizeof *builder);
    sdl_set_builder_state(sdl, builder);
    builder->assumed_gamma = 1;
    camera_default(&builder->camera);
    ParsedTexture *texture = sdl_alloc(sdl, sizeof *texture);
    texture->texture.pigment = &pigment_new(sdl, NULL)->pigment;
    texture->texture.finish = &finish_new(sdl, NULL)->finish;
    builder->default_texture = texture;
    Scene *scene = sdl_scene(sdl);
    scene->ambient_light = rgb_grey(1);
    builder->irid_wavelength = rgb(0.70f, 0.52f, 0.48f);
    builder->mm_per_unit = 10;
    scene->number_of_waves = 10;
    scene->noise_generator = NOISE_RANGE_CORRECTED;
}

static void finish(Sdl *sdl)
{
    finalize_scene(sdl);
}

static void set_default(Sdl *sdl)
{
    Builder *builder = builder_of(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_is(sdl, "texture"))
            sdl_next(sdl), builder->default_texture = parse_texture(sdl);
        else if (sdl_is(sdl, "camera"))
            sdl_next(sdl), builder->camera = *parse_camera(sdl);
        else if (sdl_is(sdl, "radiosity"))
            skip_statement(sdl);
        else if (!accept_texture_part(sdl, &builder->default_texture))
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

/* Words whose value is known of, so that it can be named and handed on, but means nothing here. */
static int declare_ignored(Sdl *sdl, Value *value)
{
    static const char *const words[] = {"radiosity", NULL};
    for (int i = 0; words[i]; i++)
        if (sdl_is(sdl, words[i])) {
            skip_statement(sdl);
            set(value, VALUE_OTHER, NULL);
            value->word = words[i];
            return 1;
        }
    return 0;
}

static int declare_surface(Sdl *sdl, Value *value)
{
    Builder *builder = builder_of(sdl);
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
        set(value, VALUE_FINISH, parse_finish(sdl, (const ParsedFinish *)builder->default_texture->texture.finish));
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
    else if (sdl_accept(sdl, "pigment_map")) {
        set(value, VALUE_OTHER, parse_pigment_map(sdl));
        value->word = "pigment_map";
    } else if (sdl_accept(sdl, "texture_map")) {
        set(value, VALUE_OTHER, parse_texture_map(sdl));
        value->word = "texture_map";
    } else if (sdl_accept(sdl, "normal_map")) {
        set(value, VALUE_OTHER, parse_normal_map(sdl));
        value->word = "normal_map";
    } else if (sdl_accept(sdl, "slope_map")) {
        set(value, VALUE_OTHER, parse_slope_map(sdl));
        value->word = "slope_map";
    } else
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

static int declare_air(Sdl *sdl, Value *value)
{
    if (sdl_accept(sdl, "fog")) {
        set(value, VALUE_OTHER, parse_fog(sdl));
        value->word = "fog";
    } else if (sdl_accept(sdl, "rainbow")) {
        set(value, VALUE_OTHER, parse_rainbow(sdl));
        value->word = "rainbow";
    } else if (sdl_accept(sdl, "media")) {
        set(value, VALUE_OTHER, parse_media(sdl));
        value->word = "media";
    } else if (sdl_accept(sdl, "density")) {
        set(value, VALUE_OTHER, parse_density(sdl));
        value->word = "density";
    } else
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
    if (declare_air(sdl, value))
        return 1;
    if (sdl_accept(sdl, "camera")) {
        set(value, VALUE_CAMERA, parse_camera(sdl));
        return 1;
    }
    if (sdl_accept(sdl, "sky_sphere")) {
        set(value, VALUE_SKY_SPHERE, parse_sky_sphere(sdl));
        return 1;
    }
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
        camera->name = sdl_ident_add(sdl, NULL, name, line)->name, camera->next = builder_of(sdl)->cameras;
        builder_of(sdl)->cameras = value->data = camera;
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
    builder_of(sdl)->sky = parse_sky_sphere(sdl);
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
    const int has_name = sdl_peek(sdl)->kind == TOKEN_IDENT;
    const Object *object = accept_object(sdl);
    if (!object)
        sdl_expected(sdl, "an object, a light, a camera or a directive");
    place_object(sdl, object);
    if (!has_name)
        object_done(sdl, object);
}

const SdlBuilder scene_builder = {
    .begin = begin,
    .declare = declare,
    .name = add_name,
    .statement = statement,
    .set_default = set_default,
    .finish = finish,
    .extent = object_extent,
    .trace = object_trace,
    .inside = object_inside,
    .field = parse_field,
};
