/* What can only be done at the end of the scene: single triangles are gathered into meshes, images are loaded, the
 * trees of textures are made, colours are converted from the working space to scene-linear, emission is
 * derived from `ambient`, and names are listed.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "light/environment.h"
#include "sdl/camera/camera.h"
#include "sdl/medium/air.h"
#include "sdl/place/place.h"
#include "shade/pigment.h"
#include "shade/working_space.h"

/* ---- colours of the working space ---- */

/* Lights brighter than 1 stand in products with factors below it, which are not decoded: what is above 1 stays as it is
 * written, for 4 would become 24. */
static Rgb decode_light(const WorkingSpace *space, Rgb color)
{
    const Rgb decoded = working_decode(space, color);
    return rgb(fminf(decoded.r, fmaxf(color.r, 1)), fminf(decoded.g, fmaxf(color.g, 1)),
               fminf(decoded.b, fmaxf(color.b, 1)));
}

/* Until here the scene's space is linear: what is evaluated while reading gives numbers as written. */
static void decode_colors(Sdl *sdl)
{
    TextureState *textures = textures_of(sdl);
    Scene *scene = sdl_scene(sdl);
    const WorkingSpace *space = &scene->working_space;
    scene->working_space = working_space(sdl);
    for (ParsedPigment *p = textures->pigments; p; p = p->next)
        p->pigment.color = working_decode_pigment(space, p->pigment.color);
    for (ParsedFinish *f = textures->finishes; f; f = f->next) {
        f->finish.ambient = working_decode(space, f->finish.ambient);
        f->finish.emission = working_decode(space, f->finish.emission);
        f->finish.retex.sheen = working_decode(space, f->finish.retex.sheen);
        f->finish.reflection_min = working_decode(space, f->finish.reflection_min);
        f->finish.reflection_max = working_decode(space, f->finish.reflection_max);
    }
    for (int i = 0; i < scene->nlights; i++)
        scene->lights[i].color = decode_light(space, scene->lights[i].color);
    scene->background = working_decode(space, scene->background);
    scene->ambient_light = working_decode(space, scene->ambient_light);
    for (Fog *fog = scene->fogs; fog; fog = fog->next)
        fog->color = working_decode(space, fog->color);
    if (scene->sky)
        scene->sky->emission = working_decode(space, scene->sky->emission);
}

/* ---- images ---- */

static void load_finish_images(Sdl *sdl, const Finish *finish)
{
    normal_load(sdl, finish->retex.clearcoat_normal);
    const Pigment *const maps[] = {finish->retex.metallic_map,     finish->retex.roughness_map,
                                   finish->retex.transmission_map, finish->retex.clearcoat_map,
                                   finish->retex.sheen_map,        finish->retex.clearcoat_roughness_map,
                                   finish->retex.emission_map};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        if (maps[i])
            load_pigment_images(sdl, maps[i], maps[i] == finish->retex.emission_map);
}

static void load_leaf_images(Sdl *sdl, const ParsedTexture *texture, void *context)
{
    (void)context;
    load_pigment_images(sdl, texture->texture.pigment, finish_is_emitter(texture->texture.finish));
    normal_load(sdl, texture->texture.normal);
    if (texture->texture.finish)
        load_finish_images(sdl, texture->texture.finish);
}

/* ---- every texture in use ---- */

typedef void UseVisitor(Sdl *sdl, const Texture **texture, void *context);

static void each_texture(Sdl *sdl, UseVisitor *visit, void *context)
{
    Scene *scene = sdl_scene(sdl);
    for (int i = 0; i < scene->nprimitives; i++) {
        Primitive *p = &scene->primitives[i];
        visit(sdl, &p->texture, context);
        if (p->interior_texture)
            visit(sdl, &p->interior_texture, context);
        for (int j = 0; p->shape.textures && j < p->shape.textures->count; j++)
            visit(sdl, &p->shape.textures->list[j], context);
    }
    for (int i = 0; i < scene->ninstances; i++)
        if (scene->instances[i].texture)
            visit(sdl, &scene->instances[i].texture, context);
}

static void visit_load(Sdl *sdl, const Texture **texture, void *context)
{
    texture_visit(sdl, parsed_texture(*texture), load_leaf_images, NULL, context);
}

static void visit_complete(Sdl *sdl, const Texture **texture, void *context)
{
    (void)context;
    *texture = texture_complete(sdl, parsed_texture(*texture));
}

static void visit_albedo(Sdl *sdl, const Texture **texture, void *context)
{
    (void)context;
    for (int k = 0; k < texture_leaf_count(*texture); k++)
        check_albedo(sdl, texture_leaf(*texture, k));
}

/* What paths ask for at every vertex. */
static void complete_finishes(Sdl *sdl)
{
    const Rgb w = builder_of(sdl)->global.irid_wavelength;
    for (ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next) {
        const float path = (float)(2 * PI * f->finish.irid_thickness);
        if (builder_of(sdl)->global.has_subsurface)
            f->finish.mean_free_path =
                rgb_scale(f->finish.translucency, (float)(1 / builder_of(sdl)->global.mm_per_unit));
        f->finish.lambert = finish_is_lambert(&f->finish);
        f->finish.matte = finish_is_matte(&f->finish);
        f->finish.irid_noise = sdl_scene(sdl)->noise_generator;
        f->finish.irid_phase = rgb(w.r > 0 ? path / w.r : 0, w.g > 0 ? path / w.g : 0, w.b > 0 ? path / w.b : 0);
    }
}

/* ---- emitters ---- */

#define AMBIENT_SHINES 0.4f   /* from here on an ambient was made to shine */
#define AMBIENT_ORDINARY 0.1f /* POV-Ray's default: it stands for indirect light */

/* That of the scene's default, which was chosen for all surfaces. */
static float ordinary_ambient(Sdl *sdl)
{
    const ParsedTexture *of = textures_of(sdl)->default_texture;
    return of ? fmaxf(AMBIENT_ORDINARY, rgb_max(of->texture.finish->ambient)) : AMBIENT_ORDINARY;
}

/* The share of its ambient that shines. */
static float shining_share(const Finish *finish, float ordinary, float background)
{
    const float ambient = rgb_max(finish->ambient);
    if (finish->diffuse > 0 && ambient < 1 && background >= ambient)
        return 0;
    if (ambient >= AMBIENT_SHINES || (finish->diffuse == 0 && ambient > AMBIENT_ORDINARY))
        return 1;
    return ambient > ordinary ? (ambient - ordinary) / ambient : 0;
}

/* POV-Ray's background lights nothing but through radiosity, and who placed light sources saw surfaces without it.
 * Scenes with finishes of retex's own were made for it. */
static void find_background_light(Sdl *sdl)
{
    const TextureState *textures = textures_of(sdl);
    const GlobalSettings *global = &builder_of(sdl)->global;
    Scene *scene = sdl_scene(sdl);
    scene->background_only_seen = 0;
    for (int k = 0; k < scene->nlights && !global->radiosity; k++)
        scene->background_only_seen |= !rgb_is_black(scene->lights[k].color);
    for (const ParsedFinish *f = textures->finishes; f; f = f->next)
        scene->background_only_seen &= !f->finish.retex.present;
}

/* Whether POV-Ray would show ambient: it has none beside radiosity, but in scenes of old versions. */
static int has_ambient(Sdl *sdl)
{
    return !builder_of(sdl)->global.radiosity || sdl_version(sdl) < 3.7;
}

/* Small `ambient` stands for the indirect light that paths find; what is above it was made to be seen, and strong one
 * wholly, as that of skies, lamps and molecules. Beside a bright background that lights it stands for the light that
 * comes from there. --ambient and --no-ambient say it of all. Looks at the numbers as they are written. */
static void find_shining(Sdl *sdl)
{
    const Scene *scene = sdl_scene(sdl);
    const int asked = sdl_options(sdl)->ambient; /* above 0: all of it; below: none */
    const float ordinary = ordinary_ambient(sdl),
                background = scene->background_only_seen ? 0 : rgb_max(scene->background);
    for (ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next) {
        float share = asked > 0;
        if (asked == 0 && has_ambient(sdl))
            share = shining_share(&f->finish, ordinary, background);
        f->shines = share > 0;
        if (f->shines)
            f->finish.ambient = rgb_scale(f->finish.ambient, share);
    }
}

static void set_emission(Sdl *sdl)
{
    const Rgb light = sdl_scene(sdl)->ambient_light;
    for (ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next) {
        if (!f->shines)
            continue;
        f->finish.emission_of_ambient = rgb_is_black(f->finish.emission);
        f->finish.emission = rgb_add(f->finish.emission, rgb_mul(f->finish.ambient, light));
    }
}

/* What can be chosen for a target. Of two finishes of a name the later one is meant, which stands first. */
static void list_finishes(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    int count = 0;
    for (const ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next)
        count += f->name != NULL;
    scene->named_finishes = sdl_alloc(sdl, (size_t)(count + 1) * sizeof *scene->named_finishes);
    for (const ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next) {
        int k = 0;
        while (f->name && k < scene->nnamed_finishes && strcmp(scene->named_finishes[k].name, f->name) != 0)
            k++;
        if (f->name && k == scene->nnamed_finishes)
            scene->named_finishes[scene->nnamed_finishes++] = (NamedFinish){f->name, &f->finish};
    }
    for (int k = 0; 2 * k < scene->nnamed_finishes - 1; k++) { /* in the scene's order */
        NamedFinish *a = &scene->named_finishes[k], *b = &scene->named_finishes[scene->nnamed_finishes - 1 - k];
        const NamedFinish first = *a;
        *a = *b, *b = first;
    }
}

/* ---- names ---- */

typedef struct Names {
    int capacity;
    const char **table; /* open addressing, a power of two */
    size_t size;
} Names;

static size_t hash_name(const char *name)
{
    size_t hash = 1469598103u;
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 1099511u;
    return hash;
}

static size_t find_bucket(const Names *names, const char *name)
{
    size_t i = hash_name(name) & (names->size - 1);
    while (names->table[i] && strcmp(names->table[i], name) != 0)
        i = (i + 1) & (names->size - 1);
    return i;
}

static void grow_table(Sdl *sdl, Names *names)
{
    const Scene *scene = sdl_scene(sdl);
    names->size = names->size ? names->size * 2 : 256;
    names->table = sdl_alloc(sdl, names->size * sizeof *names->table);
    for (int i = 0; i < scene->nidents; i++)
        names->table[find_bucket(names, scene->idents[i])] = scene->idents[i];
}

static void list_names(Sdl *sdl, Names *names, const IdentList *idents)
{
    Scene *scene = sdl_scene(sdl);
    for (; idents; idents = idents->next) {
        if ((size_t)scene->nidents * 2 >= names->size)
            grow_table(sdl, names);
        size_t bucket = find_bucket(names, idents->name);
        if (names->table[bucket])
            continue;
        scene->idents = sdl_grow(sdl, scene->idents, scene->nidents, &names->capacity, sizeof *scene->idents);
        names->table[bucket] = scene->idents[scene->nidents++] = idents->name;
    }
}

static void list_texture_names(Sdl *sdl, Names *names, const Texture *texture)
{
    for (int k = 0; k < texture_leaf_count(texture); k++)
        list_names(sdl, names, texture_leaf(texture, k)->idents);
}

static void list_all_names(Sdl *sdl)
{
    const Scene *scene = sdl_scene(sdl);
    Names names = {0};
    const IdentList *last_texture = NULL, *last_object = NULL;
    for (int i = 0; i < scene->nprimitives; i++) {
        const Primitive *p = &scene->primitives[i];
        if (p->texture->tree || p->texture->idents != last_texture)
            list_texture_names(sdl, &names, p->texture), last_texture = p->texture->idents;
        if (p->interior_texture)
            list_texture_names(sdl, &names, p->interior_texture);
        for (int j = 0; p->shape.textures && j < p->shape.textures->count; j++)
            list_texture_names(sdl, &names, p->shape.textures->list[j]);
        if (p->idents != last_object)
            list_names(sdl, &names, last_object = p->idents);
    }
    for (int i = 0; i < scene->ninstances; i++) {
        const Instance *instance = &scene->instances[i];
        if (instance->texture && instance->texture->idents != last_texture)
            list_names(sdl, &names, last_texture = instance->texture->idents);
        if (instance->idents != last_object)
            list_names(sdl, &names, last_object = instance->idents);
    }
}

/* ---- */

static void build_sky(Sdl *sdl)
{
    Scene *scene = sdl_scene(sdl);
    const ParsedSky *sky = cameras_of(sdl)->sky;
    if (!sky || sky->npigments == 0)
        return;
    scene->sky = sdl_alloc(sdl, sizeof *scene->sky);
    scene->sky->npigments = sky->npigments;
    scene->sky->emission = sky->emission;
    scene->sky->filters = sdl_version(sdl) >= 3.7;
    scene->sky->pigments = sdl_alloc(sdl, (size_t)sky->npigments * sizeof *scene->sky->pigments);
    for (int i = 0; i < sky->npigments; i++) {
        gaps_report(sdl, &sky->pigments[i]->gaps);
        scene->sky->pigments[i] = &sky->pigments[i]->pigment;
    }
}

/* Once images are loaded and colours are decoded. */
static void find_sky_color(Sdl *sdl)
{
    const Scene *scene = sdl_scene(sdl);
    SkySphere *sky = scene->sky;
    const Vec3 up = vec3(0, 1, 0);
    for (int i = 0; sky && i < sky->npigments; i++)
        if (!pigment_is_constant(sky->pigments[i]))
            return;
    if (!sky)
        return;
    const Rgb light = sky_radiance(scene, up, 0);
    sky->color = sky_radiance(scene, up, 1);
    sky->has_one_color = sky->color.r == light.r && sky->color.g == light.g && sky->color.b == light.b;
}

static void load_images(Sdl *sdl)
{
    const Scene *scene = sdl_scene(sdl);
    each_texture(sdl, visit_load, NULL);
    for (int i = 0; scene->sky && i < scene->sky->npigments; i++)
        load_pigment_images(sdl, scene->sky->pigments[i], 1);
    normal_load(sdl, scene->camera.normal);
    complete_media(sdl);
    const ParsedPigment *bokeh = cameras_of(sdl)->bokeh;
    if (bokeh)
        load_pigment_images(sdl, &bokeh->pigment, 0);
    for (const ParsedFinish *f = textures_of(sdl)->finishes; f; f = f->next)
        if (f->name) /* a target may get it */
            load_finish_images(sdl, &f->finish);
}

void finalize_scene(Sdl *sdl)
{
    if (sdl_scene(sdl)->width == 0)
        camera_use(sdl, &cameras_of(sdl)->camera);
    camera_choose(sdl);
    build_sky(sdl);
    gather_triangles(sdl, places_of(sdl)->single_triangle);
    complete_prototypes(sdl);
    complete_csgs(sdl);
    load_images(sdl);
    each_texture(sdl, visit_complete, NULL);
    each_texture(sdl, visit_albedo, NULL);
    add_tangents(sdl);
    find_background_light(sdl);
    find_shining(sdl);
    decode_colors(sdl);
    find_sky_color(sdl);
    camera_finish(sdl);
    complete_finishes(sdl);
    set_emission(sdl);
    find_caustics(sdl);
    complete_air(sdl);
    list_finishes(sdl);
    list_all_names(sdl);
}
