/* global_settings, background and sky_sphere. */
#include <math.h>
#include <string.h>
#include <retex/develop.h>
#include <retex/target_name.h>
#include "pattern/wave_sources.h"
#include "sdl/camera/camera.h"
#include "sdl/object/object.h"

static void assumed_gamma(Sdl *sdl)
{
    GlobalSettings *global = &builder_of(sdl)->global;
    global->has_assumed_gamma = 1;
    global->gamma_version = sdl_version(sdl);
    global->gamma_srgb = sdl_accept(sdl, "srgb");
    global->assumed_gamma = global->gamma_srgb ? 2.2 : sdl_float(sdl);
    if (!(global->assumed_gamma > 0.1 && global->assumed_gamma < 10))
        sdl_error(sdl, "assumed_gamma %g is not sensible", global->assumed_gamma);
}

/* What a renderer of another kind does not need: a number, a colour, a word or a block. */
static void ignored(Sdl *sdl)
{
    builder_of(sdl)->global.photons |= sdl_is(sdl, "photons");
    static const char *const blocks[] = {"radiosity", "photons", "subsurface", "tracing", NULL};
    for (int i = 0; blocks[i]; i++)
        if (sdl_is(sdl, blocks[i])) {
            builder_of(sdl)->global.radiosity |= i == 0;
            builder_of(sdl)->global.has_subsurface |= i == 2;
            skip_statement(sdl);
            return;
        }
    static const char *const settings[] = {"adc_bailout", "max_intersections", "max_trace_level",
                                           "hf_gray_16",  "charset",           NULL};
    for (int i = 0; settings[i]; i++)
        if (sdl_accept(sdl, settings[i])) {
            if (strcmp(settings[i], "charset") == 0)
                sdl_next(sdl);
            else
                sdl_optional_bool(sdl, 1);
            return;
        }
    sdl_expected(sdl, "a global setting or }");
}

/* `retex_names { "IDENTIFIER" "name" … }` */
static void parse_names(Sdl *sdl)
{
    GlobalSettings *global = &builder_of(sdl)->global;
    Scene *scene = sdl_scene(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        SceneName name;
        name.ident = sdl_string(sdl);
        name.name = sdl_string(sdl);
        scene->names = sdl_grow(sdl, scene->names, scene->nnames, &global->name_capacity, sizeof *scene->names);
        scene->names[scene->nnames++] = name;
        sdl_optional_comma(sdl);
    }
}

enum { OFFERED_MAX = 64 };

/* `retex_targets { "NAME" "SELECTOR,…" … }`; of one name the last. */
static void parse_targets(Sdl *sdl)
{
    GlobalSettings *global = &builder_of(sdl)->global;
    Scene *scene = sdl_scene(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        const char *name = sdl_string(sdl);
        int k = 0;
        if (strlen(name) >= RETEX_NAME_MAX || !retex_target_name_is_valid(name))
            sdl_error(sdl, "retex_targets: `%s` is no name of a target: 1 to %d letters, digits, spaces and `_-.+()`",
                      name, RETEX_NAME_MAX - 1);
        while (k < scene->noffered && strcmp(scene->offered[k].name, name) != 0)
            k++;
        if (k == OFFERED_MAX)
            sdl_error(sdl, "retex_targets: more than %d", OFFERED_MAX);
        if (k == scene->noffered)
            scene->offered = sdl_grow(sdl, scene->offered, scene->noffered++, &global->offered_capacity,
                                      sizeof *scene->offered);
        scene->offered[k] = (SceneTarget){name, sdl_string(sdl)};
        sdl_optional_comma(sdl);
    }
}

/* `retex_exposure STOPS` */
static void parse_exposure(Sdl *sdl)
{
    const double stops = sdl_float(sdl);
    if (!(fabs(stops) <= RETEX_EXPOSURE_MAX))
        sdl_error(sdl, "retex_exposure %g: an exposure is -%d to %d stops", stops, RETEX_EXPOSURE_MAX,
                  RETEX_EXPOSURE_MAX);
    sdl_scene(sdl)->exposure = stops;
}

void parse_global_settings(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    sdl_expect(sdl, "{");
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "assumed_gamma"))
            assumed_gamma(sdl);
        else if (sdl_accept(sdl, "retex_names"))
            parse_names(sdl);
        else if (sdl_accept(sdl, "retex_targets"))
            parse_targets(sdl);
        else if (sdl_accept(sdl, "retex_exposure"))
            parse_exposure(sdl);
        else if (sdl_accept(sdl, "ambient_light")) {
            Rgbft c = sdl_color(sdl);
            scene->ambient_light = rgb(c.r, c.g, c.b);
        } else if (sdl_accept(sdl, "irid_wavelength")) {
            const Rgbft c = sdl_color(sdl);
            builder_of(sdl)->global.irid_wavelength = rgb(c.r, c.g, c.b);
        } else if (sdl_accept(sdl, "mm_per_unit")) {
            builder_of(sdl)->global.mm_per_unit = sdl_float(sdl);
            if (!(builder_of(sdl)->global.mm_per_unit > 0))
                sdl_error(sdl, "mm_per_unit must be above 0");
        } else if (sdl_accept(sdl, "number_of_waves")) {
            const double count = sdl_float(sdl);
            if (!(count >= 1 && count <= WAVE_SOURCES_MAX))
                sdl_error(sdl, "number_of_waves %g: there are 1 to %d", count, WAVE_SOURCES_MAX);
            scene->number_of_waves = (int)count;
        } else if (sdl_accept(sdl, "noise_generator")) {
            const double generator = sdl_float(sdl);
            if (!(generator >= 1 && generator < 4))
                sdl_error(sdl, "noise_generator %g: there are 1, 2 and 3", generator);
            scene->noise_generator = (int)generator;
        } else
            ignored(sdl);
        sdl_optional_comma(sdl);
    }
}

void parse_background(Sdl *sdl)
{
    sdl_expect(sdl, "{");
    Rgbft c = sdl_color(sdl);
    sdl_expect(sdl, "}");
    sdl_scene(sdl)->background = rgb(c.r, c.g, c.b);
}

static void sky_pigment(Sdl *sdl, ParsedSky *sky)
{
    const int most = (int)(sizeof sky->pigments / sizeof *sky->pigments);
    if (sky->npigments == most)
        sdl_error(sdl, "a sky_sphere has at most %d pigments", most);
    sky->pigments[sky->npigments++] = parse_pigment(sdl, default_pigment(sdl));
}

static void sky_move(Sdl *sdl, ParsedSky *sky, const Transform *by)
{
    sky->transform = transform_then(sky->transform, *by);
    for (int i = 0; i < sky->npigments; i++) {
        ParsedPigment *pigment = pigment_new(sdl, sky->pigments[i]);
        pigment->pigment.transform = transform_then(pigment->pigment.transform, *by);
        sky->pigments[i] = pigment;
    }
}

const ParsedSky *parse_sky_sphere(Sdl *sdl)
{
    ParsedSky *sky = sdl_alloc(sdl, sizeof *sky);
    Transform by;
    sky->emission = rgb_grey(1);
    sky->transform = transform_identity();
    sdl_expect(sdl, "{");
    const ParsedSky *known = accept_ident(sdl, VALUE_SKY_SPHERE);
    if (known)
        *sky = *known;
    while (!sdl_accept(sdl, "}")) {
        if (sdl_accept(sdl, "pigment"))
            sky_pigment(sdl, sky);
        else if (sdl_accept(sdl, "emission")) {
            Rgbft c = sdl_color(sdl);
            sky->emission = rgb(c.r, c.g, c.b);
        } else if (accept_transform(sdl, &by))
            sky_move(sdl, sky, &by);
        else
            sdl_expected(sdl, "pigment, emission, a transform or } in sky_sphere");
    }
    return sky;
}
