/* Pixels that one target covers, seen directly: their parallelograms are those of the scene's geometry, and their
 * quarters have the light that clusters have. Pixels that see anything else have clusters. */
#include <math.h>
#include <stdio.h>
#include "lib_scene.h"
#include "render/render.h"
#include "set/set.h"
#include "film/footprints/pixel.h"

enum { WIDTH = 24, HEIGHT = 18 };

#define PLANE "plane { y, 0 pigment { T } finish { ambient 0 diffuse .8 } }"

/* size: 0 of a pinhole. */
static RetexSet *render(const char *objects, double aperture, RenderParams p)
{
    static const char *const target = "T";
    char text[1024];
    RetexError err = {0};
    RetexSet *set = NULL;
    snprintf(text, sizeof text,
             "#version 3.7; global_settings { assumed_gamma 1 } #declare T = pigment { rgb .5 }\n"
             "camera { location <.1,3,-4> look_at <.1,0,0> right x*4/3 angle 40 aperture %g focal_point <0,2,-2>\n"
             "  blur_samples 4 }\n"
             "light_source { <20,50,-30> rgb 1 } %s",
             aperture, objects);
    Scene *scene = test_scene(text);
    assert_int_equal(scene_resolve_targets(scene, &target, 1, NULL), 0);
    scene->width = WIDTH, scene->height = HEIGHT;
    p.spp = 256, p.nthreads = 1;
    test_must(render_scene(&set, scene, &p, NULL, &err), &err);
    scene_close(&scene);
    return set;
}

/* UV of the plane at a place in the picture, in pixels. */
static void plane_uv(double x, double y, double uv[2])
{
    const double length = 2.0 / 3 / tan(20 * M_PI / 180); /* of the camera's direction */
    const double across = (x / WIDTH - 0.5) * 4 / 3, up = 0.5 - y / HEIGHT;
    const double down = 0.6 * length - 0.8 * up, forward = 0.8 * length + 0.6 * up;
    uv[0] = 0.1 + across * 3 / down;
    uv[1] = -4 + forward * 3 / down;
}

static const float *pixel_of(const RetexSet *set, const char *name, int i)
{
    const int part = retex_set_find_part(set, name);
    return part < 0 ? NULL : set->parts[part].image.pixels + (size_t)set->parts[part].image.channels * (size_t)i;
}

static double light_of(const RetexSet *set, RetexRole role, int i)
{
    double sum = 0;
    for (int t = 0; t < set->nterms; t++)
        if (set->terms[t].role == role)
            sum += (double)set->parts[set->terms[t].radiance].image.pixels[3 * i];
    return sum;
}

static void quadrants_fill_pixels(void **state)
{
    (void)state;
    RenderParams p = RENDER_PARAMS_INIT, without = RENDER_PARAMS_INIT;
    without.no_quadrants = 1;
    RetexSet *set = render(PLANE, 0, p), *clusters = render(PLANE, 0, without);
    assert_int_equal(set->nfootprints, 4);
    assert_int_equal(retex_set_find_part(clusters, "axes_T_quadrants"), -1);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const float *uv = pixel_of(set, "uv_T_quadrants", i), *axes = pixel_of(set, "axes_T_quadrants", i);
        double at[2], low[2], high[2];
        plane_uv(x + 0.5, y + 0.5, at);
        assert_float_equal(uv[2], 0.25, 1e-3f);
        for (int side = 0; side < 2; side++) {
            plane_uv(x + (side ? 0.5 : 0), y + (side ? 0 : 0.5), low);
            plane_uv(x + (side ? 0.5 : 1), y + (side ? 1 : 0.5), high);
            const double size = hypot(high[0] - low[0], high[1] - low[1]);
            for (int k = 0; k < 2; k++) {
                assert_float_equal(axes[2 * side + k], (float)(high[k] - low[k]), (float)(0.02 * size));
                assert_float_equal(uv[k], (float)at[k], (float)(0.02 * size));
            }
        }
        assert_float_equal(light_of(set, RETEX_ROLE_SHARP, i), light_of(clusters, RETEX_ROLE_SHARP, i), 1e-4);
    }
    for (int k = 0; k < 4; k++)
        assert_int_equal(set->footprints[k].quadrant, k + 1);
    retex_set_close(&set);
    retex_set_close(&clusters);
}

/* The shadow's edge of a box far above goes down through a column of pixels: quarters have light of their own, and
 * together what clusters have. */
static void quadrants_have_their_own_light(void **state)
{
    (void)state;
    static const char *const scene = PLANE " box { <-90,9,-90>, <3.7312,9.1,90> no_image pigment { rgb 0 } }";
    RenderParams p = RENDER_PARAMS_INIT, without = RENDER_PARAMS_INIT;
    p.max_depth = without.max_depth = 2, without.no_quadrants = 1;
    RetexSet *set = render(scene, 0, p), *clusters = render(scene, 0, without);
    int edges = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float left = 0, right = 0;
        for (int k = 1; k <= 4 && pixel_of(set, "uv_T_quadrants", i)[2] > 0; k++) {
            char name[32];
            snprintf(name, sizeof name, "dep_T_quadrant%d", k);
            *(k % 2 ? &left : &right) += pixel_of(set, name, i)[0];
        }
        assert_true(left <= right + 1e-4f);
        edges += left < 0.9f * right;
        assert_float_equal(light_of(set, RETEX_ROLE_SHARP, i), light_of(clusters, RETEX_ROLE_SHARP, i), 1e-4);
    }
    assert_in_range(edges, HEIGHT / 2, 2 * HEIGHT);
    retex_set_close(&set);
    retex_set_close(&clusters);
}

static int count_covered(RetexSet *set)
{
    int count = 0;
    for (int i = 0; i < WIDTH * HEIGHT && retex_set_find_part(set, "uv_T_quadrants") >= 0; i++)
        count += pixel_of(set, "uv_T_quadrants", i)[2] > 0;
    for (int k = 0; k < set->nfootprints; k++)
        for (int i = 0; i < k; i++) /* quadrants and clusters have numbers of their own */
            assert_int_not_equal(set->footprints[i].hit, set->footprints[k].hit);
    retex_set_close(&set);
    return count;
}

static void other_pixels_have_clusters(void **state)
{
    (void)state;
    RenderParams p = RENDER_PARAMS_INIT, gaussian = RENDER_PARAMS_INIT;
    gaussian.gaussian = 1;
    assert_int_equal(count_covered(render(PLANE, 0, gaussian)), 0);
    assert_int_equal(count_covered(render(PLANE, 1.5, p)), 0); /* out of focus */
    /* a sphere of a third of the picture: neither its outline nor the steep places beside it */
    const int sphere =
        count_covered(render("sphere { <.1,0,0>, 1 pigment { T } finish { ambient 0 diffuse .8 } }", 0, p));
    assert_in_range(sphere, 20, 110);
    /* behind something */
    const int behind = count_covered(render(PLANE " box { <-1,0,-1>, <1,.5,1> pigment { rgb 1 } }", 0, p));
    assert_in_range(behind, 250, WIDTH * HEIGHT - 60);
    /* in a mirror alone */
    assert_int_equal(count_covered(render("plane { y, -9 pigment { T } finish { ambient 0 diffuse .8 } rotate 180*x }"
                                          " plane { y, 0 pigment { rgb 0 } finish { reflection 1 } }",
                                          0, p)),
                     0);
}

/* Of an even map, the regression is the map, wherever the paths of a pixel lie. */
static void an_even_map_is_found(void **state)
{
    (void)state;
    static const int periodic[1][2] = {{0, 0}};
    unsigned seed = 1;
    for (int n = 0; n < 50; n++) {
        double map[6];
        for (int k = 0; k < 6; k++)
            map[k] = 2 * test_random(&seed) - 1;
        if (fabs(map[0] * map[3] - map[1] * map[2]) < 0.05)
            continue;
        Quadrants q = {.target = QUADRANTS_NONE};
        for (int k = 0; k < 20; k++) {
            const double x = 0.5 * test_random(&seed) * test_random(&seed) + (k % 2 ? 0.5 : 0);
            const double y = 0.5 * test_random(&seed) + (k / 2 % 2 ? 0.5 : 0);
            const float place[2] = {(float)x, (float)y};
            const SeenTarget seen = {.uv = {map[0] * place[0] + map[2] * place[1] + map[4],
                                            map[1] * place[0] + map[3] * place[1] + map[5]},
                                     .place = {place[0], place[1]}};
            quadrants_start_path(&q, &seen, periodic);
        }
        PixelMap found;
        q.weight = 1;
        assert_int_equal(quadrants_find_map(&q, periodic, &found), 1);
        for (int k = 0; k < 4; k++)
            assert_true(fabs(found.axes[k] - map[k]) < 1e-9);
        for (int k = 0; k < 2; k++)
            assert_true(fabs(found.uv[k] - (map[k] + map[2 + k]) / 2 - map[4 + k]) < 1e-9);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quadrants_fill_pixels),
        cmocka_unit_test(quadrants_have_their_own_light),
        cmocka_unit_test(other_pixels_have_clusters),
        cmocka_unit_test(an_even_map_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
