/* See lib_stage.h. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include "camera/camera.h"
#include "set/laid.h"
#include "lib_stage.h"

Camera stage_orthographic(Vec3 location, Vec3 direction, Vec3 right, Vec3 up)
{
    return (Camera){
        .ops = &camera_orthographic, .location = location, .direction = direction, .right = right, .up = up};
}

void stage_open(Stage *s)
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

Primitive *stage_add(Stage *s, const ShapeOps *ops, Transform transform, float r, float g, float b)
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

RetexSet *stage_render(Stage *s, int spp, int plain, int threads)
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

void stage_close(Stage *s)
{
    scene_close(&s->scene);
}

void stage_open_targets(Stage *s)
{
    stage_open(s);
    s->scene->background = rgb(0.6f, 0.7f, 1);
    stage_add(s, &shape_plane, stage_at(0, -1, 0, 1), 0.7f, 0.5f, 0.3f);
    stage_add(s, &shape_sphere, stage_at(0, 0, 0, 1), 0.3f, 0.8f, 0.4f);
    stage_add(s, &shape_sphere, stage_at(2, 2.5, -1, 0.5), 1, 0.9f, 0.8f);
    s->finishes[1].specular = 0.3, s->finishes[1].roughness = 0.02;
    s->finishes[2].diffuse = 0, s->finishes[2].emission = rgb_grey(10);
    s->scene->ntargets = 2;
    strcpy(s->scene->targets[0].name, "Floor");
    strcpy(s->scene->targets[1].name, "Ball");
    s->primitives[0].target = 0, s->primitives[1].target = 1;
}

const float *stage_pixel(const RetexSet *set, int x, int y)
{
    return set->parts[0].image.pixels + retex_image_index(&set->parts[0].image, x, y);
}

const float *stage_part(const RetexSet *set, const char *name, int x, int y)
{
    int part = retex_set_find_part(set, name);
    if (part < 0)
        fail_msg("no part %s", name);
    const RetexImage *image = &set->parts[part].image;
    return image->pixels + retex_image_index(image, x, y);
}

void stage_expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.6f, should be %.6f within %g", what, value, wanted, tolerance);
}

Transform stage_at(double x, double y, double z, double scale)
{
    return transform_then(transform_scale(vec3(scale, scale, scale)), transform_translate(vec3(x, y, z)));
}
