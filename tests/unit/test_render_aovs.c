/* What a render writes beside the picture, in scenes with closed forms; and crops. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include "lib_scene.h"
#include "lib_stage.h"
#include "light/sources.h"
#include "set/laid.h"

/* A crop has the pixels of the whole picture, in the beauty, the AOVs and what denoising reads. */
static void crops_are_cut_from_the_whole(void **state)
{
    enum { X = 19, Y = 13, W = 30, H = 24 };
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *whole = NULL, *crop = NULL;
    int compared = 0;
    Stage s;

    (void)state;
    stage_open_targets(&s);
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

/* All parts of a set of one pixel are what they are there in the set of the whole picture. */
static void expect_pixel(const RetexSet *alone, const RetexSet *whole, int x, int y)
{
    for (int k = 0; k < alone->nparts; k++) {
        const RetexImage *one = &alone->parts[k].image;
        const int part = retex_set_find_part(whole, alone->parts[k].name);
        if (strncmp(alone->parts[k].name, "original_", 9) == 0)
            continue;
        assert_true(part >= 0);
        const RetexImage *all = &whole->parts[part].image;
        assert_memory_equal(one->pixels, all->pixels + retex_image_index(all, x, y),
                            (size_t)one->channels * sizeof(float));
    }
}

/* Pixels are traced together, of sets and with data for denoising too; each is what it is alone, with any number of
 * samples. */
static void pixels_together_are_pixels_alone(void **state)
{
    (void)state;
    enum { W = 21, H = 19, SAMPLES = 7 }; /* tiles of several sizes */
    static const int samples[SAMPLES] = {1, 3, 7, 16, 50, 64, 65};
    for (int n = 0; n < 2 * SAMPLES; n++) {
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *whole = NULL;
        Stage s;
        stage_open_targets(&s);
        s.scene->width = W, s.scene->height = H;
        p.spp = samples[n % SAMPLES], p.nthreads = 2, p.plain = n < SAMPLES, p.denoise_data = n >= SAMPLES;
        assert_int_equal(render_scene(&whole, s.scene, &p, NULL, NULL), 0);
        for (int i = 0; i < 12; i++) {
            RetexSet *alone = NULL;
            p.crop[0] = (5 * i + 3) % W, p.crop[1] = (7 * i + 2) % H, p.crop[2] = p.crop[3] = 1;
            assert_int_equal(render_scene(&alone, s.scene, &p, NULL, NULL), 0);
            expect_pixel(alone, whole, p.crop[0], p.crop[1]);
            retex_set_close(&alone);
        }
        retex_set_close(&whole);
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
    stage_add(&s, &shape_sphere, stage_at(0, 0, 0, 2), 0.25f, 0.5f, 0.75f);
    stage_add(&s, &shape_plane, stage_at(0, -1, 0, 1), 1, 1, 1);
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
            stage_expect(*stage_part(set, "depth", x, y), t, 1e-4, "depth");
            stage_expect(*stage_part(set, "object", x, y), is_plane ? 2 : 1, 0, "object");
            for (int c = 0; c < 3; c++) {
                stage_expect(stage_part(set, "normal", x, y)[c], n[c], 1e-4, "normal");
                stage_expect(stage_part(set, "position", x, y)[c], at[c], 1e-4, "position");
                stage_expect(stage_part(set, "albedo", x, y)[c], is_plane ? 1 : albedo[c], 1e-6, "albedo");
            }
            if (!is_plane)
                stage_expect(stage_part(set, "uv", x, y)[1], 0.5 + asin(d.y) / PI, 1e-4, "v");
            stage_expect(stage_part(set, "uv", x, y)[2], 1, 0, "alpha of uv");
        }
    retex_set_close(&set);
    stage_close(&s);
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
        s.scene->camera = stage_orthographic(vec3(0, 5, 0), vec3(0, -1, 0), vec3(4, 0, 0), vec3(0, 0, 3));
        stage_add(&s, &shape_plane, transform_identity(), 0, 0.25f, 1);
        s.finishes[0].diffuse = 0.3, s.finishes[0].emission = rgb_grey(2);
        s.finishes[0].reflection_max = rgb_grey(0.5f);
        s.finishes[0].reflection_metallic = 0.75;
        s.scene->nlights = !sky;
        s.scene->background = rgb_grey((float)sky);
        s.lights[0] = (Light){.ops = &light_point, .location = {0.5, 2, 0}, .color = {1, 1, 0.5f}};
        p.spp = 64, p.plain = 1, p.aovs = RETEX_AOV_ALL;
        assert_int_equal(render_scene(&set, s.scene, &p, NULL, NULL), 0);
        for (int y = 0; y < 12; y++)
            for (int x = 0; x < 16; x++) {
                double px = 4 * ((x + 0.5) / 16 - 0.5) - 0.5, pz = 3 * (0.5 - (y + 0.5) / 12);
                double wanted = sky ? PI : PI * 2 / sqrt(px * px + pz * pz + 4);
                stage_expect(*stage_part(set, "irradiance", x, y), wanted, sky ? 0.02 : 1e-4, "irradiance");
                stage_expect(*stage_part(set, "roughness", x, y), 0, 0, "roughness");
                stage_expect(*stage_part(set, "metallic", x, y), 0.75, 1e-6, "metallic");
            }
        retex_set_close(&set);
        stage_close(&s);
    }
}

/* Mirrors and what light passes are sharp; highlights are as wide as they say; what has neither is matt. */
static void roughness_is_of_the_sharpest_lobe(void **state)
{
    static const struct {
        const char *material;
        double low, high;
    } cases[] = {{"pigment { rgb .5 } finish { diffuse .7 }", 1, 1},
                 {"pigment { rgb .5 } finish { reflection .3 }", 0, 0},
                 {"pigment { rgbf <.5, .5, .5, .4> }", 0, 0},
                 {"pigment { rgbt <.5, .5, .5, .4> }", 0, 0},
                 {"pigment { rgbf .9 } interior { ior 1.5 } finish { specular .5 roughness .1 }", 0, 0},
                 {"pigment { rgb .5 } finish { specular .5 roughness .1 }", 0.1, 0.9},
                 {"pigment { rgb .5 } finish { specular .5 roughness .001 }", 0.01, 0.3}};
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *set = NULL;
        char text[400];
        snprintf(text, sizeof text,
                 "#version 3.7; camera { location -3*z look_at 0 } light_source { -9*z, 1 } plane { z, 0 %s }",
                 cases[k].material);
        Scene *scene = test_scene(text);
        p.width = p.height = 4, p.spp = 4, p.plain = 1, p.aovs = RETEX_AOV_ALL;
        assert_int_equal(render_scene(&set, scene, &p, NULL, NULL), 0);
        const double roughness = (double)*stage_part(set, "roughness", 1, 1);
        if (!(roughness >= cases[k].low && roughness <= cases[k].high))
            fail_msg("case %zu: roughness %g", k, roughness);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(crops_are_cut_from_the_whole),      cmocka_unit_test(pixels_together_are_pixels_alone),
        cmocka_unit_test(aovs_are_of_the_first_hit),         cmocka_unit_test(irradiance_knows_no_material),
        cmocka_unit_test(roughness_is_of_the_sharpest_lobe),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
