/* Whole renders of scenes with closed forms, built without the scene language: furnaces, one light over a plane, the
 * irradiance of an emitter, Fresnel at a slab, the edge of a filter. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include "lib_stage.h"
#include "light/sources.h"
#include "set/laid.h"

static void furnace_is_invisible(void **state)
{
    (void)state;
    /* a white sphere under a white sky vanishes, diffuse or glass */
    for (int glass = 0; glass < 2; glass++) {
        Stage s;
        stage_open(&s);
        s.scene->background = rgb_grey(1);
        stage_add(&s, &shape_sphere, stage_at(0, 0, 0, 1), 1, 1, 1);
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
                mean += stage_pixel(set, x, y)[1] / (16 * 12);
                stage_expect(stage_pixel(set, x, y)[1], 1, glass ? 0.25 : 0.1, "furnace pixel");
            }
        stage_expect(mean, 1, 0.003, "furnace mean");
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
    s.scene->camera = stage_orthographic(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
    stage_add(&s, &shape_plane, transform_identity(), 0.5f, 0.25f, 1);
    s.scene->nlights = 1;
    s.lights[0] = (Light){.ops = &light_point, .location = {0.5, 2, 0}, .color = {1, 1, 0.5f}};
    RetexSet *set = stage_render(&s, 64, 0, 2);
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            double px = 4 * ((x + 0.5) / 16 - 0.5) - 0.5, pz = 3 * (0.5 - (y + 0.5) / 12),
                   c = 2 / sqrt(px * px + pz * pz + 4);
            stage_expect(stage_pixel(set, x, y)[0], 0.5 * c, 2e-3, "red");
            stage_expect(stage_pixel(set, x, y)[1], 0.25 * c, 1e-3, "green");
            stage_expect(stage_pixel(set, x, y)[2], 0.5 * c, 2e-3, "blue");
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
        s.scene->camera = stage_orthographic(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
        stage_add(&s, &shape_plane, transform_identity(), 1, 0.5f, 0.25f);
        s.finishes[0].diffuse = 0.3;
        s.finishes[0].phong = s.finishes[0].specular = k > 0 ? 0.2 : 0;
        s.finishes[0].phong_size = 5, s.finishes[0].roughness = 0.2;
        s.scene->nlights = 1;
        s.lights[0] = (Light){.ops = &light_point, .location = {0, 2, 0}, .color = {1, 1, 1}, .shadowless = k < 2};
        sets[k] = stage_render(&s, 1, 1, 1);
        stage_close(&s);
    }
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++) {
            const double plain = stage_pixel(sets[0], x, y)[2];
            stage_expect(stage_pixel(sets[1], x, y)[2], plain, 1e-6, "shadowless");
            assert_true(stage_pixel(sets[2], x, y)[2] > plain * 1.1);
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
    s.scene->camera = stage_orthographic(vec3(0, 1, 0), vec3(0, -1, 0), vec3(0.02, 0, 0), vec3(0, 0, 0.015));
    stage_add(&s, &shape_plane, transform_identity(), 0.6f, 0.6f, 0.6f);
    stage_add(&s, &shape_sphere, stage_at(0, 3, 0, 0.5), 1, 1, 1);
    s.finishes[1].diffuse = 0, s.finishes[1].emission = rgb_grey(8);
    RetexSet *set = stage_render(&s, 256, 0, 2);
    double mean = 0;
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++)
            mean += stage_pixel(set, x, y)[0] / (16 * 12);
    stage_expect(mean, 0.6 * 8 * (0.5 / 3) * (0.5 / 3), 2e-4, "radiance below the sphere");
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
            s.scene->camera = stage_orthographic(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
            s.scene->background = rgb(colors[0], colors[1], colors[2]);
            s.scene->background_only_seen = only_seen;
            stage_add(&s, &shape_plane, transform_identity(), 1, 1, 1);
            s.finishes[0].diffuse = !mirror, s.finishes[0].reflection_max = rgb_grey(mirror ? 0.8f : 0);
            s.finishes[0].reflection_min = s.finishes[0].reflection_max;
            RetexSet *set = stage_render(&s, 16, 0, 1);
            for (int c = 0; c < 3; c++)
                stage_expect(stage_pixel(set, 5, 5)[c],
                             mirror      ? 0.8 * colors[c]
                             : only_seen ? 0
                                         : colors[c],
                             1e-4, "light");
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
    s.scene->camera = stage_orthographic(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
    s.scene->background = rgb_grey(1);
    stage_add(&s, &shape_plane, transform_identity(), 1, 1, 1);
    stage_add(&s, &shape_plane, stage_at(0, -1, 0, 1), 0, 0, 0);
    s.pigments[0].color = (Rgbft){1, 1, 1, 0, 1};
    s.interiors[0].ior = 1.5;
    s.finishes[0].diffuse = 0, s.finishes[0].reflection_max = rgb_grey(1), s.finishes[0].reflection_fresnel = 1;
    RetexSet *set = stage_render(&s, 4096, 0, 2);
    double mean = 0;
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 16; x++)
            mean += stage_pixel(set, x, y)[0] / (16 * 12);
    stage_expect(mean, 0.04, 5e-4, "reflectance");
    retex_set_close(&set);
    stage_close(&s);
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
        s.scene->camera = stage_orthographic(vec3(0, 0, -5), vec3(0, 0, 1), vec3(16, 0, 0), vec3(0, 12, 0));
        stage_add(&s, &shape_box,
                  transform_then(transform_scale(vec3(20, 40, 1)), transform_translate(vec3(0, -20, 0))), 1, 1, 1);
        s.finishes[0].diffuse = 0, s.finishes[0].emission = rgb_grey(1);
        p.plain = 1, p.spp = 1024, p.gaussian = gaussian;
        assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
        for (int x = 4; x < 12; x++) {
            const double distance = x + 0.5 - 8, sharp = distance > 0;
            stage_expect(stage_pixel(set, x, 6)[0], gaussian ? 0.5 * (1 + erf(distance / 0.5 / sqrt(2))) : sharp, 0.01,
                         "an edge");
        }
        retex_set_close(&set);
        stage_close(&s);
    }
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
            s.scene->camera = stage_orthographic(vec3(0, 0, -5), vec3(0, 0, 1), vec3(0.02, 0, 0), vec3(0, 0.015, 0));
            stage_add(&s, &shape_disc, stage_at(0, 0, 0, 2), 1, 1, 1)->shape.r1 = 0;
            Primitive *wall = stage_add(&s, &shape_cone, stage_at(0, 0, -1, 1), 0, 0, 0);
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
                stage_add(&s, &shape_disc, stage_at(0, 0, -3, 20), 1, 1, 1)->shape.r1 = 0;
                s.pigments[3].color = (Rgbft){1, 1, 1, 0, 1};
            }
            RetexSet *set = stage_render(&s, 64, 1, 2);
            double mean = 0;
            for (int y = 0; y < 12; y++)
                for (int x = 0; x < 16; x++)
                    mean += stage_pixel(set, x, y)[0] / (16 * 12);
            stage_expect(mean, turned ? 0.125 : 0.5, turned ? 0.002 : 0.008, pane ? "through a pane" : "in sight");
            retex_set_close(&set);
            stage_close(&s);
        }
}

static void the_inside_is_another_surface(void **state)
{
    (void)state;
    /* the target is the sphere's outer texture; a camera in the sphere sees the inner one and its emission */
    Stage s;
    stage_open(&s);
    stage_add(&s, &shape_sphere, stage_at(0, 0, -5, 1), 1, 0, 0);
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
    stage_expect(stage_pixel(set, 8, 6)[1], 0.5, 1e-6, "the inner texture");
    stage_expect(stage_pixel(set, 8, 6)[0], 0, 1e-6, "the outer texture");
    retex_set_close(&set);
    stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furnace_is_invisible),
        cmocka_unit_test(point_light_over_a_plane),
        cmocka_unit_test(shadowless_lights_have_no_highlights),
        cmocka_unit_test(sphere_emitter_irradiance),
        cmocka_unit_test(background_may_light_nothing),
        cmocka_unit_test(slab_reflects_by_fresnel),
        cmocka_unit_test(filters_have_their_width),
        cmocka_unit_test(a_pane_hides_no_walls),
        cmocka_unit_test(the_inside_is_another_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
