/* Whole renders of scenes with closed forms, built without the scene language: furnaces, one light over a plane, the
 * irradiance of an emitter, Fresnel at a slab. And two promises of the renderer: pictures are the same to the bit for
 * any number of threads, and a set recombines to the picture. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <stdlib.h>
#include <string.h>
#include <retex/combine.h>
#include <retex/samples.h>
#include "camera/camera.h"
#include "path/path.h"
#include "render/render.h"

typedef struct Stage {
    Scene *scene;
    Pigment pigments[4];
    Finish finishes[4];
    Texture textures[4];
    Interior interiors[4];
    Primitive primitives[4];
    Light lights[2];
    int max_depth;                /* 0 = the renderer's own */
    int paper;                    /* the layout */
    const RenderVariant *variant; /* or NULL */
} Stage;

static Camera orthographic_camera(Vec3 location, Vec3 direction, Vec3 right, Vec3 up)
{
    return (Camera){
        .ops = &camera_orthographic, .location = location, .direction = direction, .right = right, .up = up};
}

static void stage_open(Stage *s)
{
    memset(s, 0, sizeof *s);
    Arena *arena = arena_create(0, NULL);
    s->scene = arena_alloc(arena, sizeof *s->scene);
    s->scene->arena = arena;
    s->scene->width = 16, s->scene->height = 12;
    s->scene->camera = (Camera){.ops = &camera_perspective,
                                .location = {0, 0, -5},
                                .direction = {0, 0, 1},
                                .right = {1.333, 0, 0},
                                .up = {0, 1, 0}};
    s->scene->primitives = s->primitives;
    s->scene->lights = s->lights;
}

/* One more primitive with a colour and POV-Ray's plain diffuse finish of 1. */
static Primitive *stage_add(Stage *s, const ShapeOps *ops, Transform transform, float r, float g, float b)
{
    int k = s->scene->nprimitives++;
    s->pigments[k] = (Pigment){
        .kind = PIGMENT_COLOR, .color = {r, g, b, 0, 0}, .transform = transform_identity(), .pattern.frequency = 1};
    s->finishes[k] = (Finish){.diffuse = 1,
                              .brilliance = 1,
                              .reflection_falloff = 1,
                              .reflection_exponent = 1,
                              .phong_size = 40,
                              .roughness = 0.05};
    s->interiors[k] = (Interior){.ior = 1};
    s->textures[k] = (Texture){.pigment = &s->pigments[k], .finish = &s->finishes[k]};
    s->primitives[k] = (Primitive){.shape = {.ops = ops, .r0 = 1, .r1 = 1},
                                   .transform = transform,
                                   .texture = &s->textures[k],
                                   .interior = &s->interiors[k],
                                   .target = -1};
    return &s->primitives[k];
}

static RetexSet *stage_render(Stage *s, int spp, int plain, int threads)
{
    for (int k = 0; k < s->scene->nprimitives; k++)
        s->finishes[k].matte = finish_is_matte(&s->finishes[k]);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexError err = {0};
    RetexSet *set = NULL;
    p.spp = spp, p.plain = plain, p.nthreads = threads;
    p.paper = s->paper;
    p.variants = s->variant, p.nvariants = s->variant != NULL;
    if (s->max_depth)
        p.max_depth = s->max_depth;
    if (render_scene(&set, s->scene, &p, NULL, &err))
        fail_msg("render: %s", err.message);
    return set;
}

static void stage_close(Stage *s)
{
    scene_close(&s->scene);
}

static const float *pixel(const RetexSet *set, int x, int y)
{
    return set->parts[0].image.pixels + retex_image_index(&set->parts[0].image, x, y);
}

static void expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f within %g", what, value, wanted, tolerance);
}

static Transform at(double x, double y, double z, double scale)
{
    return transform_then(transform_scale(vec3(scale, scale, scale)), transform_translate(vec3(x, y, z)));
}

static void furnace_is_invisible(void **state)
{
    (void)state;
    /* a white sphere under a white sky vanishes, diffuse or glass */
    for (int glass = 0; glass < 2; glass++) {
        Stage s;
        stage_open(&s);
        s.scene->background = rgb_grey(1);
        stage_add(&s, &shape_sphere, at(0, 0, 0, 1), 1, 1, 1);
        if (glass) {
            s.pigments[0].color = (Rgbft){1, 1, 1, 0, 1};
            s.interiors[0].ior = 1.5;
            s.finishes[0].diffuse = 0, s.finishes[0].reflection_max = rgb_grey(1), s.finishes[0].reflection_fresnel = 1;
        }
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *set = NULL;
        p.spp = 256, p.max_depth = 200;
        assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
        double mean = 0;
        for (int y = 0; y < 12; y++)
            for (int x = 0; x < 16; x++) {
                mean += pixel(set, x, y)[1] / (16 * 12);
                expect(pixel(set, x, y)[1], 1, glass ? 0.25 : 0.1, "furnace pixel");
            }
        expect(mean, 1, 0.003, "furnace mean");
        retex_set_close(&set);
        stage_close(&s);
    }
}

static void point_light_over_a_plane(void **state)
{
    (void)state;
    /* L = albedo * colour * cos: no 1/pi, no falloff, as POV-Ray has it; exact, per pixel */
    Stage s;
    stage_open(&s);
    s.scene->camera = orthographic_camera(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
    stage_add(&s, &shape_plane, transform_identity(), 0.5f, 0.25f, 1);
    s.scene->nlights = 1;
    s.lights[0] = (Light){.kind = LIGHT_POINT, .location = {0.5, 2, 0}, .color = {1, 1, 0.5f}};
    RetexSet *set = stage_render(&s, 64, 0, 2);
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            double px = 4 * ((x + 0.5) / 16 - 0.5) - 0.5, pz = 3 * (0.5 - (y + 0.5) / 12),
                   c = 2 / sqrt(px * px + pz * pz + 4);
            expect(pixel(set, x, y)[0], 0.5 * c, 2e-3, "red");
            expect(pixel(set, x, y)[1], 0.25 * c, 1e-3, "green");
            expect(pixel(set, x, y)[2], 0.5 * c, 2e-3, "blue");
        }
    retex_set_close(&set);
    stage_close(&s);
}

/* Each pixel is as bright as without a highlight if the light has no shadows, and brighter if it has. */
static void shadowless_lights_have_no_highlights(void **state)
{
    (void)state;
    RetexSet *sets[3];
    for (int k = 0; k < 3; k++) {
        Stage s;
        stage_open(&s);
        s.scene->camera = orthographic_camera(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
        stage_add(&s, &shape_plane, transform_identity(), 1, 0.5f, 0.25f);
        s.finishes[0].diffuse = 0.3;
        s.finishes[0].phong = s.finishes[0].specular = k > 0 ? 0.2 : 0;
        s.finishes[0].phong_size = 5, s.finishes[0].roughness = 0.2;
        s.scene->nlights = 1;
        s.lights[0] = (Light){.kind = LIGHT_POINT, .location = {0, 2, 0}, .color = {1, 1, 1}, .shadowless = k < 2};
        sets[k] = stage_render(&s, 1, 1, 1);
        stage_close(&s);
    }
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            const double plain = pixel(sets[0], x, y)[2];
            expect(pixel(sets[1], x, y)[2], plain, 1e-6, "shadowless");
            assert_true(pixel(sets[2], x, y)[2] > plain * 1.1);
        }
    for (int k = 0; k < 3; k++)
        retex_set_close(&sets[k]);
}

static void sphere_emitter_irradiance(void **state)
{
    (void)state;
    /* a sphere of radius r at height h, radiance L: E = pi L (r/h)^2 straight below it */
    Stage s;
    stage_open(&s);
    s.scene->camera = orthographic_camera(vec3(0, 1, 0), vec3(0, -1, 0), vec3(0.02, 0, 0), vec3(0, 0, 0.015));
    stage_add(&s, &shape_plane, transform_identity(), 0.6f, 0.6f, 0.6f);
    stage_add(&s, &shape_sphere, at(0, 3, 0, 0.5), 1, 1, 1);
    s.finishes[1].diffuse = 0, s.finishes[1].emission = rgb_grey(8);
    RetexSet *set = stage_render(&s, 256, 0, 2);
    double mean = 0;
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++)
            mean += pixel(set, x, y)[0] / (16 * 12);
    expect(mean, 0.6 * 8 * (0.5 / 3) * (0.5 / 3), 2e-4, "radiance below the sphere");
    retex_set_close(&set);
    stage_close(&s);
}

static void background_may_light_nothing(void **state)
{
    (void)state;
    /* seen in a mirror and directly, in a stage with a white surface before it */
    const float colors[3] = {0.25f, 0.5f, 1};
    for (int mirror = 0; mirror < 2; mirror++)
        for (int only_seen = 0; only_seen < 2; only_seen++) {
            Stage s;
            stage_open(&s);
            s.scene->camera = orthographic_camera(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
            s.scene->background = rgb(colors[0], colors[1], colors[2]);
            s.scene->background_only_seen = only_seen;
            stage_add(&s, &shape_plane, transform_identity(), 1, 1, 1);
            s.finishes[0].diffuse = !mirror, s.finishes[0].reflection_max = rgb_grey(mirror ? 0.8f : 0);
            s.finishes[0].reflection_min = s.finishes[0].reflection_max;
            RetexSet *set = stage_render(&s, 16, 0, 1);
            for (int c = 0; c < 3; c++)
                expect(pixel(set, 5, 5)[c], mirror ? 0.8 * colors[c] : only_seen ? 0 : colors[c], 1e-4, "light");
            retex_set_close(&set);
            stage_close(&s);
        }
}

static void slab_reflects_by_fresnel(void **state)
{
    (void)state;
    /* a glass plane over a black ground under a sky of 1: head-on 0.04 */
    Stage s;
    stage_open(&s);
    s.scene->camera = orthographic_camera(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
    s.scene->background = rgb_grey(1);
    stage_add(&s, &shape_plane, transform_identity(), 1, 1, 1);
    stage_add(&s, &shape_plane, at(0, -1, 0, 1), 0, 0, 0);
    s.pigments[0].color = (Rgbft){1, 1, 1, 0, 1};
    s.interiors[0].ior = 1.5;
    s.finishes[0].diffuse = 0, s.finishes[0].reflection_max = rgb_grey(1), s.finishes[0].reflection_fresnel = 1;
    RetexSet *set = stage_render(&s, 4096, 0, 2);
    double mean = 0;
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++)
            mean += pixel(set, x, y)[0] / (16 * 12);
    expect(mean, 0.04, 5e-4, "reflectance");
    retex_set_close(&set);
    stage_close(&s);
}

/* A diffuse floor and sphere, both targets, under a sky and an emitter: light goes back and forth. */
static void target_stage(Stage *s)
{
    stage_open(s);
    s->scene->background = rgb(0.6f, 0.7f, 1);
    stage_add(s, &shape_plane, at(0, -1, 0, 1), 0.7f, 0.5f, 0.3f);
    stage_add(s, &shape_sphere, at(0, 0, 0, 1), 0.3f, 0.8f, 0.4f);
    stage_add(s, &shape_sphere, at(2, 2.5, -1, 0.5), 1, 0.9f, 0.8f);
    s->finishes[1].specular = 0.3, s->finishes[1].roughness = 0.02;
    s->finishes[2].diffuse = 0, s->finishes[2].emission = rgb_grey(10);
    s->scene->ntargets = 2;
    strcpy(s->scene->targets[0].name, "Floor");
    strcpy(s->scene->targets[1].name, "Ball");
    s->primitives[0].target = 0, s->primitives[1].target = 1;
}

static void bits_do_not_depend_on_threads(void **state)
{
    (void)state;
    RetexSet *sets[3];
    const int threads[3] = {1, 2, 7};
    Stage s;
    target_stage(&s);
    s.scene->width = 70, s.scene->height = 50;
    for (int k = 0; k < 3; k++)
        sets[k] = stage_render(&s, 8, 0, threads[k]);
    for (int k = 1; k < 3; k++) {
        assert_int_equal(sets[k]->nparts, sets[0]->nparts);
        assert_true(sets[k]->folded == sets[0]->folded);
        for (int p = 0; p < sets[0]->nparts; p++) {
            const RetexImage *a = &sets[0]->parts[p].image, *b = &sets[k]->parts[p].image;
            assert_string_equal(sets[k]->parts[p].name, sets[0]->parts[p].name);
            assert_memory_equal(a->pixels, b->pixels,
                                (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float));
        }
    }
    for (int k = 0; k < 3; k++)
        retex_set_close(&sets[k]);
    stage_close(&s);
}

/* A crop has the pixels of the whole picture, in the beauty, the AOVs and what denoising reads. */
static void crops_are_cut_from_the_whole(void **state)
{
    enum { X = 19, Y = 13, W = 30, H = 24 };
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *whole = NULL, *crop = NULL;
    int compared = 0;
    Stage s;

    (void)state;
    target_stage(&s);
    s.scene->width = 64, s.scene->height = 48;
    p.spp = 4, p.nthreads = 2, p.denoise_data = 1;
    p.aovs = RETEX_AOV_BIT(DEPTH) | RETEX_AOV_BIT(POSITION) | RETEX_AOV_BIT(NORMAL) | RETEX_AOV_BIT(IRRADIANCE);
    assert_int_equal(render_scene(&whole, s.scene, &p, NULL, NULL), 0);
    p.crop[0] = X, p.crop[1] = Y, p.crop[2] = W, p.crop[3] = H;
    assert_int_equal(render_scene(&crop, s.scene, &p, NULL, NULL), 0);
    for (int k = 0; k < crop->nparts; k++) {
        const RetexImage *part = &crop->parts[k].image;
        const int of = retex_set_find_part(whole, crop->parts[k].name);
        if (part->width != W || part->height != H) /* an original */
            continue;
        assert_true(of >= 0);
        for (int y = 0; y < H; y++)
            assert_memory_equal(part->pixels + retex_image_index(part, 0, y),
                                whole->parts[of].image.pixels + retex_image_index(&whole->parts[of].image, X, Y + y),
                                (size_t)(W * part->channels) * sizeof(float));
        compared++;
    }
    assert_true(compared > 20);
    retex_set_close(&whole);
    retex_set_close(&crop);
    stage_close(&s);
}

/* The bottom of a black well of depth 1 and radius 1, under a square that glows on both sides, each in its own way:
 * half of a bright sky's light. Seen from farther away than the well is deep, through a pane that changes nothing. */
static void a_pane_hides_no_walls(void **state)
{
    Vec3 corners[4] = {{-3, -3, -2.8}, {3, -3, -2.8}, {3, 3, -2.8}, {-3, 3, -2.8}};
    MeshFace faces[2] = {{{0, 1, 2}, {-1, -1, -1}, {-1, -1, -1}, -1}, {{0, 2, 3}, {-1, -1, -1}, {-1, -1, -1}, -1}};
    Mesh mesh = {.nvertices = 4, .nfaces = 2};

    (void)state;
    mesh.vertices = corners, mesh.faces = faces;
    for (int pane = 0; pane < 2; pane++)
        for (int turned = 0; turned < 2; turned++) {
            Stage s;
            Finish dim;
            Texture inside;
            stage_open(&s);
            s.scene->camera = orthographic_camera(vec3(0, 0, -5), vec3(0, 0, 1), vec3(0.02, 0, 0), vec3(0, 0.015, 0));
            stage_add(&s, &shape_disc, at(0, 0, 0, 2), 1, 1, 1)->shape.r1 = 0;
            Primitive *wall = stage_add(&s, &shape_cone, at(0, 0, -1, 1), 0, 0, 0);
            wall->shape.open = 1;
            Primitive *lamp = stage_add(&s, &shape_mesh, transform_identity(), 1, 1, 1);
            lamp->shape.mesh = &mesh, lamp->no_image = 1;
            /* its faces wind so that their normals point to +z, at the well */
            for (int k = 0; k < 2; k++)
                faces[k].vertex[1] = turned ? k + 2 : k + 1, faces[k].vertex[2] = turned ? k + 1 : k + 2;
            s.finishes[2].diffuse = 0, s.finishes[2].emission = rgb_grey(1);
            dim = s.finishes[2], dim.emission = rgb_grey(0.25f);
            inside = (Texture){.pigment = &s.pigments[2], .finish = &dim};
            lamp->interior_texture = &inside, lamp->interior_target = -1;
            if (pane) {
                stage_add(&s, &shape_disc, at(0, 0, -3, 20), 1, 1, 1)->shape.r1 = 0;
                s.pigments[3].color = (Rgbft){1, 1, 1, 0, 1};
            }
            RetexSet *set = stage_render(&s, 64, 1, 2);
            double mean = 0;
            for (int y = 0; y < 12; y++)
                for (int x = 0; x < 16; x++)
                    mean += pixel(set, x, y)[0] / (16 * 12);
            expect(mean, turned ? 0.125 : 0.5, turned ? 0.002 : 0.008, pane ? "through a pane" : "in sight");
            retex_set_close(&set);
            stage_close(&s);
        }
}

/* The edge of a bright half, between two columns of pixels: a box sees it sharply, a Gaussian of half a pixel by its
 * error function. */
static void filters_have_their_width(void **state)
{
    (void)state;
    for (int gaussian = 0; gaussian < 2; gaussian++) {
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *set = NULL;
        Stage s;
        stage_open(&s);
        s.scene->camera = orthographic_camera(vec3(0, 0, -5), vec3(0, 0, 1), vec3(16, 0, 0), vec3(0, 12, 0));
        stage_add(&s, &shape_box,
                  transform_then(transform_scale(vec3(20, 40, 1)), transform_translate(vec3(0, -20, 0))), 1, 1, 1);
        s.finishes[0].diffuse = 0, s.finishes[0].emission = rgb_grey(1);
        p.plain = 1, p.spp = 1024, p.gaussian = gaussian;
        assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
        for (int x = 4; x < 12; x++) {
            const double distance = x + 0.5 - 8, sharp = distance > 0;
            expect(pixel(set, x, 6)[0], gaussian ? 0.5 * (1 + erf(distance / 0.5 / sqrt(2))) : sharp, 0.01, "an edge");
        }
        retex_set_close(&set);
        stage_close(&s);
    }
}

static void compare(const RetexImage *a, const RetexImage *b, double tolerance, const char *what)
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height * 3; i++)
        if (!(fabs(a->pixels[i] - b->pixels[i]) <= tolerance * (0.01 + b->pixels[i])))
            fail_msg("%s: sample %zu is %.6f, should be %.6f", what, i, a->pixels[i], b->pixels[i]);
}

/* shiny: a floor with a smooth coat, and a ball that is half a rough metal. Some hits have a black dependent part then,
 * others have both parts. */
static void check_recombining(int paper, int shiny)
{
    /* constant originals: the polynomial is the picture; other constants: it is the other picture */
    Stage s;
    target_stage(&s);
    for (int k = 0; k < 2 && shiny; k++) {
        s.finishes[k].retex.present = 1, s.finishes[k].retex.ior = 1.5, s.finishes[k].retex.specular_tint = 1;
        s.finishes[k].retex.metallic = 0.6 * k, s.finishes[k].retex.roughness = 0.4 * k;
    }
    s.paper = paper;
    s.max_depth = paper ? RETEX_MAX_ORDERS + 1 : 5; /* no path has more hits than the set keeps: nothing is folded */
    RetexSet *set = stage_render(&s, 32, 0, 2), *plain = stage_render(&s, 32, 1, 2);
    assert_int_equal(plain->nterms, 0);
    assert_string_equal(set->layout, paper ? "paper" : "footprints");
    assert_true(set->folded == 0);
    compare(&plain->parts[0].image, &set->parts[0].image, 1e-5, "plain against set");
    RetexImage again = {0};
    assert_int_equal(retex_combine(&again, set, NULL, NULL, NULL, 0, NULL), 0);
    compare(&again, &set->parts[0].image, paper ? 1e-4 : 1e-3, "unedited"); /* footprints: rounded on purpose */
    retex_image_free(&again);
    retex_set_close(&plain);

    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    RetexTexture *textures[2];
    RetexSamples *samples = NULL;
    const float colors[2][3] = {{0.9f, 0.3f, 0.05f}, {0.1f, 0.05f, 0.8f}};
    RenderVariant replaced = {{NULL}, NULL};
    for (int k = 0; k < 2; k++) {
        strcpy(specs[k].target, k ? "Ball" : "Floor");
        specs[k].constant = 1;
        memcpy(specs[k].color, colors[k], sizeof colors[k]);
        assert_int_equal(retex_texture_load(&textures[k], &specs[k], 1, NULL), 0);
        replaced.textures[k] = textures[k];
    }
    s.variant = &replaced;
    plain = stage_render(&s, 32, 1, 2);
    assert_int_equal(retex_sample(&samples, set, specs, 2, 0, NULL), 0);
    assert_int_equal(retex_combine(&again, set, samples, NULL, NULL, 0, NULL), 0);
    compare(&again, &plain->parts[0].image, paper ? 2e-3 : 5e-3, "recoloured");
    retex_image_free(&again);
    retex_samples_close(&samples);
    for (int k = 0; k < 2; k++)
        retex_texture_close(&textures[k]);
    retex_set_close(&plain);
    retex_set_close(&set);
    stage_close(&s);
}

static void paper_recombines(void **state)
{
    (void)state;
    check_recombining(1, 0);
}

static void paper_recombines_shiny_targets(void **state)
{
    (void)state;
    check_recombining(1, 1);
}

static void footprints_recombine(void **state)
{
    (void)state;
    check_recombining(0, 0);
}

static void footprints_recombine_shiny_targets(void **state)
{
    (void)state;
    check_recombining(0, 1);
}

static void the_inside_is_another_surface(void **state)
{
    (void)state;
    /* the target is the sphere's outer texture; a camera in the sphere sees the inner one and its emission */
    Stage s;
    stage_open(&s);
    stage_add(&s, &shape_sphere, at(0, 0, -5, 1), 1, 0, 0);
    s.pigments[1] = (Pigment){
        .kind = PIGMENT_COLOR, .color = {0, 1, 0, 0, 0}, .transform = transform_identity(), .pattern.frequency = 1};
    s.finishes[1] = s.finishes[0];
    s.finishes[1].diffuse = 0, s.finishes[1].emission = rgb_grey(0.5f);
    s.textures[1] = (Texture){.pigment = &s.pigments[1], .finish = &s.finishes[1]};
    s.primitives[0].interior_texture = &s.textures[1], s.primitives[0].interior_target = -1;
    s.scene->ntargets = 1;
    strcpy(s.scene->targets[0].name, "Outside");
    s.primitives[0].target = 0;
    RetexSet *set = stage_render(&s, 4, 0, 1);
    assert_true(set->targets[0].share == 0);
    expect(pixel(set, 8, 6)[1], 0.5, 1e-6, "the inner texture");
    expect(pixel(set, 8, 6)[0], 0, 1e-6, "the outer texture");
    retex_set_close(&set);
    stage_close(&s);
}

static const float *part_pixel(const RetexSet *set, const char *name, int x, int y)
{
    int part = retex_set_find_part(set, name);
    if (part < 0)
        fail_msg("no part %s", name);
    const RetexImage *image = &set->parts[part].image;
    return image->pixels + retex_image_index(image, x, y);
}

static float part_at(const RetexSet *set, const char *name, int x, int y)
{
    return *part_pixel(set, name, x, y);
}

static void irradiance_knows_no_material(void **state)
{
    (void)state;
    /* a light of colour c brings pi c cos to what is black, shiny or shines itself; a sky of 1 brings pi */
    for (int sky = 0; sky < 2; sky++) {
        Stage s;
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *set = NULL;
        stage_open(&s);
        s.scene->camera = orthographic_camera(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
        stage_add(&s, &shape_plane, transform_identity(), 0, 0.25f, 1);
        s.finishes[0].diffuse = 0.3, s.finishes[0].emission = rgb_grey(2);
        s.finishes[0].reflection_max = rgb_grey(0.5f);
        s.finishes[0].reflection_metallic = 0.75;
        s.scene->nlights = !sky;
        s.scene->background = rgb_grey((float)sky);
        s.lights[0] = (Light){.kind = LIGHT_POINT, .location = {0.5, 2, 0}, .color = {1, 1, 0.5f}};
        p.spp = 64, p.plain = 1, p.aovs = RETEX_AOV_ALL;
        assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
        for (int y = 0; y < 12; y++)
            for (int x = 0; x < 16; x++) {
                double px = 4 * ((x + 0.5) / 16 - 0.5) - 0.5, pz = 3 * (0.5 - (y + 0.5) / 12);
                double wanted = sky ? PI : PI * 2 / sqrt(px * px + pz * pz + 4);
                expect(part_at(set, "irradiance", x, y), wanted, sky ? 0.02 : 1e-4, "irradiance");
                expect(part_at(set, "roughness", x, y), 0, 0, "roughness");
                expect(part_at(set, "metallic", x, y), 0.75, 1e-6, "metallic");
            }
        retex_set_close(&set);
        stage_close(&s);
    }
}

/* From inside a sphere of radius 2, over a plane at y = -1: what the ray through each pixel's centre meets. */
static void aovs_are_of_the_first_hit(void **state)
{
    (void)state;
    Stage s;
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *set = NULL;
    stage_open(&s);
    s.scene->camera.location = vec3(0, 0, 0);
    stage_add(&s, &shape_sphere, at(0, 0, 0, 2), 0.25f, 0.5f, 0.75f);
    stage_add(&s, &shape_plane, at(0, -1, 0, 1), 1, 1, 1);
    s.pigments[0].uv_mapping = 1;
    p.spp = 1, p.plain = 1, p.aovs = RETEX_AOV_ALL;
    assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            const Vec3 d = vec_normalize(vec3(1.333 * ((x + 0.5) / 16 - 0.5), 0.5 - (y + 0.5) / 12, 1));
            const int is_plane = d.y < 0 && -1 / d.y < 2;
            const double t = is_plane ? -1 / d.y : 2;
            const double n[3] = {is_plane ? 0 : -d.x, is_plane ? 1 : -d.y, is_plane ? 0 : -d.z};
            const double at[3] = {t * d.x, t * d.y, t * d.z}, albedo[3] = {0.25, 0.5, 0.75};
            expect(part_at(set, "depth", x, y), t, 1e-4, "depth");
            expect(part_at(set, "object", x, y), is_plane ? 2 : 1, 0, "object");
            for (int c = 0; c < 3; c++) {
                expect(part_pixel(set, "normal", x, y)[c], n[c], 1e-4, "normal");
                expect(part_pixel(set, "position", x, y)[c], at[c], 1e-4, "position");
                expect(part_pixel(set, "albedo", x, y)[c], is_plane ? 1 : albedo[c], 1e-6, "albedo");
            }
            if (!is_plane)
                expect(part_pixel(set, "uv", x, y)[1], 0.5 + asin(d.y) / PI, 1e-4, "v");
            expect(part_pixel(set, "uv", x, y)[2], 1, 0, "alpha of uv");
        }
    retex_set_close(&set);
    stage_close(&s);
}

static void variants_share_paths(void **state)
{
    (void)state;
    /* each variant is to the bit what it is alone; they differ; moments are those of the pictures */
    Stage s;
    target_stage(&s);
    RenderVariant variants[3] = {{{NULL}, NULL}, {{NULL}, NULL}, {{NULL}, NULL}};
    RetexTexture *textures[2];
    for (int k = 0; k < 2; k++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        spec.constant = 1, spec.color[k] = 0.7f;
        assert_int_equal(retex_texture_load(&textures[k], &spec, 1, NULL), 0);
        variants[k].textures[0] = textures[k];
    }
    variants[1].textures[1] = textures[0];
    RenderParams p = RENDER_PARAMS_INIT;
    RetexImage pictures[3] = {{0}};
    p.spp = 16, p.variants = variants, p.nvariants = 3, p.nthreads = 2;
    assert_int_equal(render_variants(pictures, s.scene, &p, NULL, NULL), 0);
    for (int k = 0; k < 3; k++) {
        s.variant = &variants[k];
        RetexSet *alone = stage_render(&s, 16, 1, 1);
        assert_memory_equal(alone->parts[0].image.pixels, pictures[k].pixels, 16 * 12 * 3 * sizeof(float));
        assert_memory_not_equal(pictures[k].pixels, pictures[(k + 1) % 3].pixels, 16 * 12 * 3 * sizeof(float));
        retex_set_close(&alone);
    }
    p.nvariants = VARIANTS_MAX + 1;
    assert_int_equal(render_variants(pictures, s.scene, &p, NULL, NULL), RETEX_EINVAL);
    for (int k = 0; k < 3; k++)
        retex_image_free(&pictures[k]);
    for (int k = 0; k < 2; k++)
        retex_texture_close(&textures[k]);
    stage_close(&s);
}

enum { BEYOND_A_WAVE = PATHS_MAX + 7 }; /* samples: some paths go side by side, the rest after them */

/* Control variates need each sample by itself: its light is what a picture of one more sample has more. */
static void moments_are_of_single_paths(void **state)
{
    (void)state;
    Stage s;
    target_stage(&s);
    double last[16 * 12] = {0}, squares[16 * 12] = {0};
    for (int spp = 1; spp <= BEYOND_A_WAVE; spp++) {
        RetexSet *set = stage_render(&s, spp, 1, 2);
        for (int k = 0; k < 16 * 12; k++) {
            double sum = (double)spp * pixel(set, k % 16, k / 16)[0], light = sum - last[k];
            squares[k] += light * light;
            last[k] = sum;
        }
        retex_set_close(&set);
    }
    for (int plain = 0; plain < 2; plain++) {
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *with, *without = stage_render(&s, BEYOND_A_WAVE, plain, 1);
        p.spp = BEYOND_A_WAVE, p.plain = plain, p.control_data = 1, p.nthreads = 2;
        assert_int_equal(render_scene(&with, s.scene, &p, NULL, NULL), 0);
        assert_memory_equal(pixel(with, 0, 0), pixel(without, 0, 0), 16 * 12 * 3 * sizeof(float));
        for (int k = 0; k < 16 * 12; k++) {
            double n = BEYOND_A_WAVE, wanted = (squares[k] - last[k] * last[k] / n) / (n * (n - 1));
            expect(part_at(with, "variance", k % 16, k / 16), wanted, 1e-7 + 1e-3 * wanted, "variance of the mean");
        }
        retex_set_close(&with);
        retex_set_close(&without);
    }
    stage_close(&s);
}

/* Samples of two halves take turns; each half is what a render has of so many samples with the half's seed. */
static void halves_are_renders_of_their_own(void **state)
{
    (void)state;
    Stage s;
    target_stage(&s);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *both, *alone;
    p.spp = 2 * BEYOND_A_WAVE + 1, p.control_data = 2, p.nthreads = 2;
    assert_int_equal(render_scene(&both, s.scene, &p, NULL, NULL), 0);
    p.control_data = 0, p.plain = 1;
    for (int half = 0; half < 2; half++) {
        const RetexImage *found = &both->parts[retex_set_find_part(both, half ? "beauty_b" : "beauty_a")].image;
        p.spp = BEYOND_A_WAVE + !half, p.seed = half ? hash_pair(0, 1) : 0;
        assert_int_equal(render_scene(&alone, s.scene, &p, NULL, NULL), 0);
        assert_memory_equal(found->pixels, pixel(alone, 0, 0), 16 * 12 * 3 * sizeof(float));
        retex_set_close(&alone);
    }
    /* the variance of the whole is that of both, each by its share of the samples */
    const float *variance = both->parts[retex_set_find_part(both, "variance")].image.pixels,
                *a = both->parts[retex_set_find_part(both, "variance_a")].image.pixels,
                *b = both->parts[retex_set_find_part(both, "variance_b")].image.pixels;
    const double whole = 2 * BEYOND_A_WAVE + 1, more = (BEYOND_A_WAVE + 1) / whole, less = BEYOND_A_WAVE / whole;
    double sum = 0, shares = 0, swapped = 0;
    for (int i = 0; i < 16 * 12 * 3; i++) {
        expect(variance[i], more * more * a[i] + less * less * b[i], 1e-9 + 1e-5 * fabs(variance[i]),
               "variance of both halves");
        sum += variance[i], shares += more * more * a[i] + less * less * b[i];
        swapped += fabs(variance[i] - less * less * a[i] - more * more * b[i]);
    }
    assert_true(sum > 0 && swapped > 1e-4 * shares);
    retex_set_close(&both);
    stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(furnace_is_invisible),
                                       cmocka_unit_test(point_light_over_a_plane),
                                       cmocka_unit_test(shadowless_lights_have_no_highlights),
                                       cmocka_unit_test(sphere_emitter_irradiance),
                                       cmocka_unit_test(background_may_light_nothing),
                                       cmocka_unit_test(slab_reflects_by_fresnel),
                                       cmocka_unit_test(crops_are_cut_from_the_whole),
                                       cmocka_unit_test(filters_have_their_width),
                                       cmocka_unit_test(a_pane_hides_no_walls),
                                       cmocka_unit_test(bits_do_not_depend_on_threads),
                                       cmocka_unit_test(paper_recombines),
                                       cmocka_unit_test(paper_recombines_shiny_targets),
                                       cmocka_unit_test(footprints_recombine_shiny_targets),
                                       cmocka_unit_test(footprints_recombine),
                                       cmocka_unit_test(the_inside_is_another_surface),
                                       cmocka_unit_test(aovs_are_of_the_first_hit),
                                       cmocka_unit_test(irradiance_knows_no_material),
                                       cmocka_unit_test(variants_share_paths),
                                       cmocka_unit_test(moments_are_of_single_paths),
                                       cmocka_unit_test(halves_are_renders_of_their_own)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
