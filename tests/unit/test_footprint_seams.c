/* Footprints on shapes of all kinds, across the seams of those that close, against rays of the test's own: the mean and
 * the covariance of UV over a grid in each pixel, taken on from place to place. */
#include <math.h>
#include <stdio.h>
#include "accel/accel.h"
#include "camera/camera.h"
#include "lib_scene.h"
#include "path/shading.h"
#include "render/render.h"
#include "shape/surface.h"

enum { WIDTH = 20, HEIGHT = 20, GRID = 12, TURNS = 4 };

typedef struct Case {
    const char *shape;
    int closes[2]; /* u and v come back to where they began */
} Case;

static const Case cases[] = {
    {"sphere { 0, 1", {1, 0}},
    {"cylinder { -.8*y, .8*y, .8 open", {1, 0}},
    {"cone { -.8*y, 1, .8*y, .4 open", {1, 0}},
    {"torus { .8, .35 rotate 60*x", {1, 1}},
    {"superellipsoid { <.6,.5> rotate 90*x", {1, 0}},
    {"ovus { .8, .5 translate -.5*y", {1, 0}},
    {"lathe { quadratic_spline 5 <0,-1>, <.5,-.9>, <.9,0>, <.4,.8>, <.1,1>", {1, 0}},
    {"blob { threshold .3 sphere { -.3*y, 1, 1 } sphere { .4*y, .9, 1 }", {1, 0}},
    {"isosurface { function { x*x + y*y*1.3 + z*z - .8 } contained_by { sphere { 0, 1.2 } } max_gradient 4", {1, 0}},
    {"sphere { 0, 1 uv_mapping", {1, 0}},
    {"box { -.7, .7 rotate <30,20,0>", {0, 0}},
    {"polygon { 5, <-1,-1>, <1,-1>, <1,1>, <-1,1>, <-1,-1> rotate 40*x", {0, 0}},
    {"mesh { triangle { <-1,-1,0>, <1,-1,0>, <0,1,.5> } triangle { <-1,-1,0>, <0,1,.5>, <-1,1,0> }", {0, 0}},
};

/* What the grid of a pixel says; count 0: it is not all on one smooth part. */
typedef struct Reference {
    int count, crosses; /* crosses: some of it is beyond the seam */
    double mean[2], covariance[3];
} Reference;

static Vec2 uv_of(const Scene *scene, const Accel *accel, double x, double y, int *is_hit)
{
    const Ray ray = camera_ray(&scene->camera, WIDTH, HEIGHT, x, y, NULL);
    Surface surface;
    Hit hit;
    *is_hit = accel_intersect(accel, &ray, RAY_CAMERA, &hit);
    if (!*is_hit)
        return (Vec2){0, 0};
    surface_at(&surface, scene, &ray, &hit);
    return surface_target_uv(&surface);
}

static Reference reference(const Scene *scene, const Accel *accel, const Case *of, int x, int y)
{
    Reference r = {0};
    double uv[GRID * GRID][2], jump = 0;
    int is_hit;
    for (int k = 0; k < GRID * GRID; k++) {
        const Vec2 here = uv_of(scene, accel, x + (k % GRID + 0.5) / GRID, y + (k / GRID + 0.5) / GRID, &is_hit);
        const int from = k % GRID ? k - 1 : k - GRID; /* its neighbour before */
        if (!is_hit)
            return r;
        uv[k][0] = here.u, uv[k][1] = here.v;
        for (int c = 0; c < 2 && k > 0; c++) {
            const double turns = of->closes[c] ? round(uv[k][c] - uv[from][c]) : 0;
            uv[k][c] -= turns;
            r.crosses |= turns != 0;
            jump = fmax(jump, fabs(uv[k][c] - uv[from][c]));
        }
    }
    for (int k = 0; k < GRID * GRID; k++)
        r.mean[0] += uv[k][0] / GRID / GRID, r.mean[1] += uv[k][1] / GRID / GRID;
    for (int k = 0; k < GRID * GRID; k++) {
        const double u = uv[k][0] - r.mean[0], v = uv[k][1] - r.mean[1];
        r.covariance[0] += u * u / GRID / GRID, r.covariance[1] += u * v / GRID / GRID;
        r.covariance[2] += v * v / GRID / GRID;
    }
    const double spread = sqrt(r.covariance[0] + r.covariance[2]);
    r.count = spread < 0.08 && jump < spread; /* no pole, edge or outline */
    return r;
}

static const float *pixel_of(const RetexSet *set, const char *part, int x, int y)
{
    const int k = retex_set_find_part(set, part);
    if (k < 0)
        fail_msg("no part %s", part);
    return set->parts[k].image.pixels + retex_image_index(&set->parts[k].image, x, y);
}

static void compare(const Case *of, const RetexSet *set, const Reference *r, int x, int y)
{
    const float *uv = pixel_of(set, "uv_T_sharp1", x, y), *spread = pixel_of(set, "spread_T_sharp1", x, y);
    const double *wanted = r->covariance, size = sqrt(wanted[0] + wanted[2]);
    const double s[2] = {(double)spread[0], (double)spread[1]}, c = (double)spread[2];
    const double got[3] = {s[0] * s[0], c * s[0] * s[1], s[1] * s[1]};
    for (int k = 0; k < 2; k++) {
        double off = (double)uv[k] - r->mean[k];
        off -= of->closes[k] ? round(off) : 0;
        if (fabs(off) > 0.1 * size)
            fail_msg("%s: pixel %d,%d: mean %c %.6f, should be %.6f, spread %.6f", of->shape, x, y, "uv"[k],
                     (double)uv[k], r -> mean[k], size);
        if (of->closes[k] && !(uv[k] >= 0 && uv[k] <= 1))
            fail_msg("%s: pixel %d,%d: mean %c %.6f is not between 0 and 1", of->shape, x, y, "uv"[k], (double)uv[k]);
    }
    for (int k = 0; k < 3; k++)
        if (fabs(got[k] - wanted[k]) > 0.08 * size * size)
            fail_msg("%s: pixel %d,%d: covariance %d %.4g, should be %.4g", of->shape, x, y, k, got[k], wanted[k]);
}

static void footprints_go_across_seams(void **state)
{
    static const char *const target = "T";
    (void)state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        int compared = 0, crossed = 0;
        for (int turn = 0; turn < TURNS; turn++) {
            char text[1024];
            RetexError err = {0};
            RetexSet *set = NULL;
            Accel *accel;
            RenderParams p = RENDER_PARAMS_INIT;
            /* all light has the same weight */
            snprintf(text, sizeof text,
                     "#version 3.7; global_settings { assumed_gamma 1 } #declare T = pigment { rgb .5 }\n"
                     "camera { location <0,.7,-4> look_at 0 right x up y angle 34 }\n"
                     "%s pigment { T } finish { ambient 0 diffuse 0 emission 1 } rotate <0,%d + 7,12> }",
                     cases[k].shape, 360 / TURNS * turn);
            Scene *scene = test_scene(text);
            assert_int_equal(scene_resolve_targets(scene, &target, 1, NULL), 0);
            scene->width = WIDTH, scene->height = HEIGHT;
            p.spp = 256, p.nthreads = 1, p.max_depth = 2, p.clusters = 2, p.sharp = p.broad = 1, p.no_quadrants = 1;
            test_must(render_scene(&set, scene, &p, NULL, &err), &err);
            assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
            for (int c = 0; c < 2; c++)
                assert_int_equal(set->targets[0].periodic[c], cases[k].closes[c]);
            for (int i = 0; i < WIDTH * HEIGHT; i++) {
                const Reference r = reference(scene, accel, &cases[k], i % WIDTH, i / WIDTH);
                if (r.count > 0)
                    compare(&cases[k], set, &r, i % WIDTH, i / WIDTH);
                compared += r.count, crossed += r.count && r.crosses;
            }
            accel_close(&accel);
            retex_set_close(&set);
            scene_close(&scene);
        }
        if (compared < 150 || (crossed < 5) != !cases[k].closes[0])
            fail_msg("%s: %d pixels are compared, %d across the seam", cases[k].shape, compared, crossed);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(footprints_go_across_seams)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
