/* finish: how a surface reflects and emits light. Only reads what is written; shade/material.c maps it to a BSDF. */
#include <stddef.h>
#include <string.h>
#include "sdl/texture/texture.h"

ParsedFinish *finish_new(Sdl *sdl, const ParsedFinish *from)
{
    TextureState *textures = textures_of(sdl);
    ParsedFinish *finish = sdl_alloc(sdl, sizeof *finish);
    if (from)
        *finish = *from;
    else
        finish->finish = (Finish){FINISH_DEFAULTS, .ambient = {0.1f, 0.1f, 0.1f}};
    finish->name = NULL;
    finish->next = textures->finishes;
    textures->finishes = finish;
    return finish;
}

static Rgb opaque_color(Sdl *sdl)
{
    Rgbft c = sdl_color(sdl);
    return rgb(c.r, c.g, c.b);
}

static double in_range(Sdl *sdl, const char *word, double low, double high)
{
    double value = sdl_float(sdl);
    if (!(value >= low && value <= high))
        sdl_error(sdl, "%s must lie between %g and %g, not %g", word, low, high, value);
    return value;
}

/* `reflection C`, or `reflection{ [MIN,] MAX [fresnel] [falloff F] [exponent E] [metallic M] }`. */
static void reflection(Sdl *sdl, Finish *f)
{
    if (!sdl_accept(sdl, "{")) {
        f->reflection_min = f->reflection_max = opaque_color(sdl);
        f->reflection_falloff = 1;
        f->reflection_fresnel = 0;
        return;
    }
    int two = 0;
    f->reflection_min = f->reflection_max = opaque_color(sdl);
    sdl_optional_comma(sdl);
    if (sdl_is_color_start(sdl) || sdl_is_expression_start(sdl)) {
        f->reflection_max = opaque_color(sdl);
        two = 1;
    }
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "fresnel")) {
            f->reflection_fresnel = sdl_optional_bool(sdl, 1);
            /* With one colour it is the maximum: seen straight on, a Fresnel mirror does not reflect by itself. */
            if (f->reflection_fresnel && !two)
                f->reflection_min = rgb_grey(0);
        } else if (sdl_accept(sdl, "metallic"))
            f->reflection_metallic = optional_float(sdl, 1);
        else if (!sdl_accept_float(sdl, "falloff", &f->reflection_falloff) &&
                 !sdl_accept_float(sdl, "exponent", &f->reflection_exponent))
            sdl_expected(sdl, "fresnel, falloff, exponent, metallic or } in reflection");
    }
}

/* `[second_uv] { PIGMENT }` */
const Pigment *parse_uv_pigment(Sdl *sdl)
{
    const int second = sdl_accept(sdl, "second_uv");
    ParsedPigment *pigment = parse_pigment(sdl, NULL);
    pigment->pigment.uv_mapping = 1;
    pigment->pigment.second_uv = second;
    return &pigment->pigment;
}

/* Numbers and maps of our extension: words, and where they go. */
static int retex_number(Sdl *sdl, Finish *f)
{
    static const struct {
        const char *word;
        double low, high;
        size_t offset;
    } numbers[] = {
        {"metallic", 0, 1, offsetof(Finish, retex.metallic)},
        {"roughness", 0, 1, offsetof(Finish, retex.roughness)},
        {"ior", 1, 10, offsetof(Finish, retex.ior)},
        {"specular_tint", 0, 1, offsetof(Finish, retex.specular_tint)},
        {"transmission", 0, 1, offsetof(Finish, retex.transmission)},
        {"clearcoat", 0, 1, offsetof(Finish, retex.clearcoat)},
        {"clearcoat_roughness", 0, 1, offsetof(Finish, retex.clearcoat_roughness)},
        {"sheen_roughness", 0, 1, offsetof(Finish, retex.sheen_roughness)},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (sdl_accept(sdl, numbers[i].word)) {
            *(double *)((char *)f + numbers[i].offset) =
                in_range(sdl, numbers[i].word, numbers[i].low, numbers[i].high);
            return 1;
        }
    return 0;
}

static int retex_map(Sdl *sdl, Finish *f)
{
    static const struct {
        const char *word;
        size_t offset;
    } maps[] = {
        {"metallic_map", offsetof(Finish, retex.metallic_map)},
        {"roughness_map", offsetof(Finish, retex.roughness_map)},
        {"transmission_map", offsetof(Finish, retex.transmission_map)},
        {"emission_map", offsetof(Finish, retex.emission_map)},
        {"clearcoat_map", offsetof(Finish, retex.clearcoat_map)},
        {"clearcoat_roughness_map", offsetof(Finish, retex.clearcoat_roughness_map)},
        {"sheen_map", offsetof(Finish, retex.sheen_map)},
    };
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (sdl_accept(sdl, maps[i].word)) {
            *(const Pigment **)((char *)f + maps[i].offset) = parse_uv_pigment(sdl);
            return 1;
        }
    return 0;
}

/* `clearcoat_normal_map { PIGMENT } [SCALE]` */
static const Normal *retex_normal(Sdl *sdl)
{
    Normal *normal = sdl_alloc(sdl, sizeof *normal);
    *normal = (Normal){.kind = NORMAL_TANGENT, .vectors = parse_uv_pigment(sdl)};
    normal->size = optional_float(sdl, 1);
    return normal;
}

/* Our extension: retex{ NUMBERS, MAPS, sheen COLOR, clearcoat_normal_map{ PIGMENT } }. */
static void retex_block(Sdl *sdl, Finish *f)
{
    f->retex.present = 1;
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (retex_number(sdl, f) || retex_map(sdl, f))
            continue;
        if (sdl_accept(sdl, "sheen")) {
            const Rgb c = opaque_color(sdl);
            f->retex.sheen = rgb(not_negative(c.r), not_negative(c.g), not_negative(c.b));
        } else if (sdl_accept(sdl, "clearcoat_normal_map"))
            f->retex.clearcoat_normal = retex_normal(sdl);
        else
            sdl_expected(sdl, "metallic, roughness, ior, specular_tint, transmission, clearcoat, clearcoat_roughness, "
                              "sheen, sheen_roughness, a map of these, emission_map or } in retex");
    }
}

/* irid{ AMOUNT [thickness T] [turbulence T] }: a thin film. */
static void irid(Sdl *sdl, Finish *f)
{
    sdl_expect(sdl, "{");
    f->irid = sdl_float(sdl);
    if (f->irid > 1)
        sdl_warn(sdl, "irid %g would make light: 1 is taken", f->irid);
    while (!sdl_accept(sdl, "}"))
        if (!sdl_accept_float(sdl, "thickness", &f->irid_thickness) &&
            !sdl_accept_float(sdl, "turbulence", &f->irid_turbulence))
            sdl_expected(sdl, "thickness, turbulence or } in irid");
}

static void subsurface(Sdl *sdl, Finish *f)
{
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}"))
        if (sdl_accept(sdl, "translucency")) {
            const Rgb c = opaque_color(sdl);
            f->translucency = rgb(not_negative(c.r), not_negative(c.g), not_negative(c.b));
        } else
            sdl_expected(sdl, "translucency or } in subsurface");
}

static void diffuse(Sdl *sdl, Finish *f)
{
    f->diffuse_albedo = sdl_accept(sdl, "albedo");
    f->diffuse = sdl_float(sdl);
    sdl_optional_comma(sdl);
    f->diffuse_back = optional_float(sdl, 0);
}

/* Keywords with one plain number. */
static int accept_number(Sdl *sdl, ParsedFinish *finish)
{
    static const struct {
        const char *word;
        size_t offset;
    } numbers[] = {
        {"brilliance", offsetof(Finish, brilliance)},
        {"crand", offsetof(Finish, crand)},
        {"phong_size", offsetof(Finish, phong_size)},
        {"roughness", offsetof(Finish, roughness)},
        {"reflection_exponent", offsetof(Finish, reflection_exponent)},
    };
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (sdl_accept(sdl, numbers[i].word)) {
            *(double *)((char *)&finish->finish + numbers[i].offset) = sdl_float(sdl);
            return 1;
        }
    return 0;
}

/* Keywords of old scenes, whose place is interior now. */
static int accept_old(Sdl *sdl, ParsedFinish *finish)
{
    if (sdl_accept(sdl, "ior"))
        finish->ior = sdl_float(sdl);
    else if (sdl_accept(sdl, "caustics") || sdl_accept(sdl, "refraction"))
        sdl_float(sdl);
    else
        return 0;
    return 1;
}

static void item(Sdl *sdl, ParsedFinish *finish)
{
    Finish *f = &finish->finish;
    if (accept_number(sdl, finish) || accept_old(sdl, finish))
        return;
    if (sdl_accept(sdl, "ambient"))
        f->ambient = opaque_color(sdl);
    else if (sdl_accept(sdl, "emission"))
        f->emission = opaque_color(sdl);
    else if (sdl_accept(sdl, "diffuse"))
        diffuse(sdl, f);
    else if (sdl_accept(sdl, "phong")) {
        f->phong_albedo = sdl_accept(sdl, "albedo");
        f->phong = sdl_float(sdl);
    } else if (sdl_accept(sdl, "specular")) {
        f->specular_albedo = sdl_accept(sdl, "albedo");
        f->specular = sdl_float(sdl);
    } else if (sdl_accept(sdl, "metallic"))
        f->metallic = optional_float(sdl, 1);
    else if (sdl_accept(sdl, "reflection"))
        reflection(sdl, f);
    else if (sdl_accept(sdl, "conserve_energy"))
        f->conserve_energy = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "use_alpha"))
        f->use_alpha = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "fresnel")) {
        if (optional_float(sdl, 1) != 0)
            gaps_add(&finish->gaps, GAP_FINISH_FRESNEL);
    } else if (sdl_accept(sdl, "retex"))
        retex_block(sdl, f);
    else if (sdl_accept(sdl, "irid"))
        irid(sdl, f);
    else if (sdl_accept(sdl, "subsurface"))
        subsurface(sdl, f);
    else
        sdl_expected(sdl, "a finish keyword or }");
}

ParsedFinish *parse_finish(Sdl *sdl, const ParsedFinish *from)
{
    sdl_expect(sdl, "{");
    const ParsedFinish *known = accept_ident(sdl, VALUE_FINISH);
    ParsedFinish *finish = finish_new(sdl, known ? known : from);
    while (!sdl_accept(sdl, "}"))
        if ((known = accept_ident(sdl, VALUE_FINISH))) {
            ParsedFinish *next = finish->next;
            *finish = *known;
            finish->name = NULL, finish->next = next;
        } else
            item(sdl, finish);
    return finish;
}
