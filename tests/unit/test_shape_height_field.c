/* height_field: crossings against a loop over all of its triangles, heights and places as POV-Ray's trace() gives them,
 * pictures of 8 and 16 bits; and bicubic_patch against the surface's own formula. */
#include "lib_scene_text.h"
#include "lib_shape.h"
#include "shape/height_field.h"
#include "shape/surface.h"

#include <retex/image_file.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint32_t state = 11;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}

/* ---- crossings ---- */

/* Distance along the ray to a triangle; *doubtful where the ray meets its rim or is in its plane. */
static int triangle(const Ray *ray, Vec3 a, Vec3 b, Vec3 c, double *t, int *doubtful)
{
    const Vec3 e1 = vec_sub(b, a), e2 = vec_sub(c, a), across = vec_cross(ray->direction, e2);
    const Vec3 from = vec_sub(ray->origin, a), over = vec_cross(from, e1);
    const double volume = vec_dot(e1, across), u = vec_dot(from, across) / volume;
    const double v = vec_dot(ray->direction, over) / volume, least = fmin(fmin(u, v), 1 - u - v);

    *t = vec_dot(e2, over) / volume;
    *doubtful |= !(fabs(least) > 1e-7);
    return least > 0 && *t > 0;
}

static Vec3 corner(const Primitive *p, int i, int j)
{
    const HeightField *f = p->shape.data;
    const double height = (double)f->heights[j * f->width + i] / HEIGHT_UNITS;

    return transform_point(&p->transform, vec3((double)i / (f->width - 1), height, (double)j / (f->height - 1)));
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int all_triangles(const Primitive *p, const Ray *ray, double *list, int *doubtful)
{
    const HeightField *f = p->shape.data;
    int count = 0;

    for (int j = 0; j + 1 < f->height; j++)
        for (int i = 0; i + 1 < f->width; i++) {
            const Vec3 a = corner(p, i, j), b = corner(p, i + 1, j), c = corner(p, i, j + 1);
            const Vec3 d = corner(p, i + 1, j + 1);
            for (int k = 0; k < 2; k++)
                if (triangle(ray, k ? d : a, b, c, &list[count], doubtful)) {
                    const Vec3 at = vec_mad(ray->origin, ray->direction, list[count]);
                    const double y = transform_inverse_point(&p->transform, at).y * HEIGHT_UNITS;
                    *doubtful |= fabs(y - f->water) < 1e-3;
                    count += y >= f->water;
                }
        }
    qsort(list, (size_t)count, sizeof *list, by_value);
    return count;
}

static void test_against_triangles(void **unused)
{
    static const int sizes[][2] = {{2, 2}, {5, 4}, {17, 9}, {20, 33}};
    static const double scales[] = {1e-4, 1, 1e5};
    int met = 0, doubts = 0;
    (void)unused;
    for (int n = 0; n < 24; n++) {
        char text[400];
        const double scale = scales[n % 3];
        snprintf(text, sizeof text,
                 V37 "height_field{function %d,%d{.5+.4*sin(%d*x+1)*cos(%d*y+x*9)} %s scale %g*<1,%g,1.5>"
                     " rotate <20,%d,5> translate %g*y}",
                 sizes[n % 4][0], sizes[n % 4][1], 5 + n, 40 - n, n % 5 == 4 ? "water_level .5" : "", scale,
                 n % 2 ? .3 : 1., 30 * n, n % 7 == 6 ? 100 * scale : 0);
        Scene *scene = parse(text);
        const Primitive *p = only(scene);
        for (int i = 0; i < 400; i++) {
            static double expected[4000];
            TestCrossing list[TEST_CROSSINGS];
            const Vec3 aim = transform_point(&p->transform, vec3(between(0, 1), between(.1, .9), between(0, 1)));
            Vec3 d = test_direction(&state);
            if (i % 8 < 3)
                d = vec_normalize(transform_vector(&p->transform, vec3(i % 8 == 0, i % 8 == 1 ? -1 : 0, i % 8 == 2)));
            const Ray ray = {vec_mad(aim, d, -scale * (i % 3 == 0 ? .2 : i % 3 == 1 ? 3 : 300)), d, 0, INFINITY};
            int doubtful = 0;
            const int wanted = all_triangles(p, &ray, expected, &doubtful);
            const int count = test_all_crossings(p, ray, list);
            if (doubtful) {
                doubts++;
                continue;
            }
            if (count != wanted)
                fail_msg("scene %d ray %d: %d crossings, not %d", n, i, count, wanted);
            for (int k = 0; k < count; k++) {
                assert_true(fabs(list[k].t - expected[k]) < 1e-9 * (scale + vec_length(ray.origin)));
                met++;
            }
        }
        scene_close(&scene);
    }
    assert_true(met > 5000 && doubts < 400);
}

/* ---- heights ---- */

static void check_height(const Primitive *p, double x, double z, double y)
{
    const Ray ray = {vec3(x, 5, z), vec3(0, -1, 0), 0, 100};
    double t;
    int face;
    assert_true(shape_intersect(p, &ray, &t, &face));
    if (fabs(5 - t - y) > 2e-6)
        fail_msg("height %.7f at %g %g, not %.7f", 5 - t, x, z, y);
    assert_true(p->shape.ops->inside(&p->shape, vec3(x, y - 1e-5, z)));
    assert_false(p->shape.ops->inside(&p->shape, vec3(x, y + 1e-5, z)));
}

/* Values of POV-Ray 3.7.0.10. */
static void test_functions(void **unused)
{
    (void)unused;
    Scene *scene =
        parse(V37 "height_field{function 5,4{x*x*.5+y*.25}}"
                  "height_field{function 5,4{pigment{gradient x color_map{[0 rgb <1,0,0>][1 rgb <0,1,1>]}}}}");
    const Primitive *p = &scene->primitives[0];
    check_height(p, .001, .001, .2498598);
    check_height(p, .999, .001, .7488598);
    check_height(p, .001, .999, .0003750);
    check_height(p, .3, .6, .1499939);
    check_height(p, .1, .15, .2249870);
    check_height(p + 1, .001, .001, .2973878);
    check_height(p + 1, .3, .6, .4187836);
    assert_true(p->shape.ops->inside(&p->shape, vec3(.5, -7, .5)));
    assert_false(p->shape.ops->inside(&p->shape, vec3(1.01, -7, .5)));
    scene_close(&scene);
}

static const float rows[4][5] = {
    {37, 235, 140, 72, 255}, {137, 203, 133, 79, 192}, {144, 129, 204, 71, 237}, {252, 134, 25, 178, 20}};

static Scene *picture_scene(const char *folder, const char *name, int channels, const char *after)
{
    char path[200], text[300];
    RetexImage image = {0};
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    const char *folders[] = {folder};
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene;

    params.colorspace = "linear";
    snprintf(path, sizeof path, "%s/%s", folder, name);
    assert_int_equal(retex_image_alloc(&image, 5, 4, channels, &err), 0);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 5; i++)
            for (int c = 0; c < channels; c++)
                image.pixels[retex_image_index(&image, i, j) + (size_t)c] =
                    (c == 1 ? rows[3 - j][i] : rows[j][i]) / 255;
    if (retex_image_write(&image, path, &params, 1, &err))
        fail_msg("%s", err.message);
    retex_image_free(&image);
    snprintf(text, sizeof text, V37 "height_field{\"%.*s\" %s}", (int)strcspn(name, channels == 1 ? "." : ""), name,
             after); /* grey.png as \"grey\" */
    options.include_paths = folders;
    options.ninclude_paths = 1;
    if (parse_with(&scene, text, &options, &err))
        fail_msg("%s", err.message);
    unlink(path);
    return scene;
}

static void test_pictures(void **unused)
{
    char folder[] = "/tmp/test_heights_XXXXXX";
    (void)unused;
    assert_non_null(mkdtemp(folder));
    Scene *scene = picture_scene(folder, "grey.png", 1, "water_level .4");
    const Primitive *p = only(scene);
    const HeightField *f = p->shape.data;
    assert_int_equal(f->heights[0], 252 * 257); /* the lowest row of the picture is at z = 0 */
    check_height(p, .001, .001, .9850987);
    check_height(p, .1, .15, .6125397);
    check_height(p, .2, .05, .5545013);
    const Ray under = {vec3(.999, 5, .001), vec3(0, -1, 0), 0, 100};
    double t;
    int face;
    assert_false(shape_intersect(p, &under, &t, &face));
    scene_close(&scene);
    scene = picture_scene(folder, "colour.png", 3, "smooth");
    f = only(scene)->shape.data;
    assert_int_equal(f->heights[0], 252 * 256 + 37);
    assert_int_equal(f->heights[4], 20 * 256 + 255);
    assert_true(f->smooth);
    scene_close(&scene);
    rmdir(folder);
}

/* 3 x 2 pixels of two bits: the indices 0 1 2 above 3 2 0, of a palette of four colours. */
static const unsigned char indexed[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00, 0x00, 0x00,
    0x03, 0x00, 0x00, 0x00, 0x02, 0x02, 0x03, 0x00, 0x00, 0x00, 0xe0, 0x1a, 0x8e, 0x89, 0x00, 0x00, 0x00, 0x0c, 0x50,
    0x4c, 0x54, 0x45, 0x00, 0xff, 0x00, 0xff, 0x00, 0x00, 0x00, 0x00, 0xff, 0x09, 0x09, 0x09, 0x1f, 0x57, 0x96, 0xe4,
    0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x90, 0x60, 0x78, 0x00, 0x00, 0x01, 0x2c, 0x00,
    0xf9, 0x37, 0xa9, 0xf0, 0xd9, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

/* Indices of a palette are heights, whatever the colours. As by POV-Ray's trace(). */
static void test_palette(void **unused)
{
    char folder[] = "/tmp/test_heights_XXXXXX", path[200];
    const char *folders[] = {folder};
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    Scene *scene;

    (void)unused;
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/indexed.png", folder);
    options.include_paths = folders;
    options.ninclude_paths = 1;
    for (size_t size = sizeof indexed; size >= 26; size -= size > 60 ? 12 : 1) { /* whole, and cut off */
        FILE *file = fopen(path, "wb");
        assert_non_null(file);
        assert_int_equal(fwrite(indexed, 1, size, file), size);
        fclose(file);
        const int status = parse_with(&scene, V37 "height_field{png \"indexed.png\"}", &options, &err);
        assert_int_equal(status == 0, size == sizeof indexed);
        if (status == 0) {
            check_height(only(scene), .001, .001, .0116992);
            check_height(only(scene), .3, .4, .0046875);
            scene_close(&scene);
        } else
            assert_non_null(strstr(err.message, "indexed.png`: "));
    }
    unlink(path);
    rmdir(folder);
}

/* 6 x 5 pixels, which Pillow reads so: codes of 3 to 5 bits that stand for several pixels, some of them before they are
 * known. */
static const unsigned char gif[] = {0x47, 0x49, 0x46, 0x38, 0x37, 0x61, 0x06, 0x00, 0x05, 0x00, 0x81, 0x00, 0x00,
                                    0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x09, 0x2c,
                                    0x00, 0x00, 0x00, 0x00, 0x06, 0x00, 0x05, 0x00, 0x00, 0x02, 0x0a, 0x84, 0x1f,
                                    0x92, 0x39, 0xed, 0xc0, 0xa0, 0x98, 0xb4, 0x00, 0x00, 0x3b};
static const char gif_indices[] = "000000121212333333012301222222";
enum { GIF_SIZE = sizeof gif, GIF_FLAGS = 34, GIF_DATA_END = GIF_SIZE - 4 };

static int gif_scene(Scene **scene, const char *folder, const unsigned char *bytes, size_t size, const char *kind,
                     RetexError *err)
{
    char path[200], text[200];
    const char *folders[] = {folder};
    SdlOptions options = SDL_OPTIONS_INIT;
    options.include_paths = folders;
    options.ninclude_paths = 1;
    snprintf(path, sizeof path, "%s/heights.gif", folder);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
    snprintf(text, sizeof text, V37 "height_field{%s \"heights.gif\"}", kind);
    const int status = parse_with(scene, text, &options, err);
    unlink(path);
    return status;
}

/* The rows of an interlaced picture are stored every eighth first, then those in the middle, and so on. */
static void test_gif(void **unused)
{
    static const int stored[5] = {0, 3, 2, 4, 1};
    char folder[] = "/tmp/test_heights_XXXXXX";
    RetexError err = {0};
    Scene *scene;
    (void)unused;
    assert_non_null(mkdtemp(folder));
    for (int interlaced = 0; interlaced < 2; interlaced++)
        for (int pot = 0; pot < 2; pot++) {
            unsigned char bytes[GIF_SIZE];
            memcpy(bytes, gif, sizeof gif);
            bytes[GIF_FLAGS] = interlaced ? 0x40 : 0;
            assert_int_equal(gif_scene(&scene, folder, bytes, GIF_SIZE, pot ? "pot" : "gif", &err), 0);
            const HeightField *f = only(scene)->shape.data;
            const int width = pot ? 3 : 6;
            assert_int_equal(f->width, width);
            assert_int_equal(f->height, 5);
            for (int j = 0; j < 5; j++)
                for (int i = 0; i < width; i++) {
                    const char *row = gif_indices + 6 * (interlaced ? stored[j] : j);
                    assert_int_equal(f->heights[(4 - j) * width + i],
                                     256 * (row[i] - '0') + (pot ? row[i + 3] - '0' : 0));
                }
            scene_close(&scene);
        }
    for (size_t size = 6; size < GIF_DATA_END; size++) { /* cut off */
        assert_int_not_equal(gif_scene(&scene, folder, gif, size, "gif", &err), 0);
        assert_non_null(strstr(err.message, "heights.gif`: "));
    }
    for (int at = 0; at < GIF_SIZE; at++) { /* damaged: heights or a message */
        unsigned char bytes[GIF_SIZE];
        memcpy(bytes, gif, sizeof gif);
        bytes[at] ^= 0xff;
        if (gif_scene(&scene, folder, bytes, GIF_SIZE, "gif", &err) == 0)
            scene_close(&scene);
        else
            assert_non_null(strstr(err.message, "height"));
    }
    rmdir(folder);
}

static void test_normals_of_fields(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "height_field{function 65,65{.5*x*x+.25*(1-y)} smooth scale <2,3,4>}");
    const Primitive *p = only(scene);
    for (int i = 0; i < 100; i++) {
        const Ray ray = {vec3(between(.1, 1.9), 9, between(.1, 3.9)), vec3(0, -1, 0), 0, 100};
        Hit hit = {.primitive = 0};
        Surface s;
        assert_true(shape_intersect(p, &ray, &hit.t, &hit.face));
        surface_at(&s, scene, &ray, &hit);
        /* y = 3/8 x^2 + 3/16 z, in the world */
        const Vec3 exact = vec_normalize(vec3(-.75 * ray.origin.x, 1, -3. / 16));
        assert_true(vec_length(vec_sub(s.shading_normal, exact)) < 2e-3);
        assert_true(vec_length(vec_sub(s.geometric_normal, exact)) < 2e-2);
        assert_true(fabs(surface_uv(&s).natural.u - ray.origin.x / 2) < 1e-12);
        assert_true(fabs(surface_uv(&s).natural.v - ray.origin.z / 4) < 1e-12);
    }
    scene_close(&scene);
}

/* Of trace(), by POV-Ray 3.7.0.10: heights of a few units, made as wide as they are high. */
static void test_smooth_normals_against_povray(void **unused)
{
    static const struct {
        double x, z, normal[3];
    } cases[] = {{.0005, .0007, {-.667296, .333450, .665978}},   {.0005, 1.0007, {-.990623, .124535, -.056186}},
                 {1.0005, 1.0007, {-.262682, .708483, .655020}}, {1.9995, 2.9993, {.218648, .308555, -.925736}},
                 {2.9995, 1.9993, {-.938037, .234525, .255117}}, {1.5, 1.25, {-.217060, .942530, .254013}},
                 {1.25, 1.5, {-.360144, .875551, .322037}},      {1.2, 1.1, {-.219392, .824783, .521153}},
                 {1.8, 1.7, {-.625806, .711410, -.319785}},      {1.5, 1.75, {-.572048, .819397, -.036738}},
                 {1.9, 1.2, {-.059279, .996829, -.053076}}};
    (void)unused;
    Scene *scene = parse(V37 "#declare H = array[4][4] {{3,1,4,1},{5,9,2,6},{5,3,5,8},{9,7,9,3}}"
                             "#declare I = function(x,i) { select(abs(x-i)-.3, 1, 0) }"
                             "#declare V = function(x,y) {"
                             "#for(i,0,3) #for(j,0,3) H[i][j]*I(x*3,i)*I((1-y)*3,j) + #end #end 0 }"
                             "height_field{function 4,4{(V(x,y)+.25)/65536} smooth scale <3,65536,3>}");
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Ray ray = {vec3(cases[k].x, 50, cases[k].z), vec3(0, -1, 0), 0, 100};
        const double *n = cases[k].normal;
        Hit hit = {.primitive = 0};
        Surface s;
        assert_true(shape_intersect(only(scene), &ray, &hit.t, &hit.face));
        surface_at(&s, scene, &ray, &hit);
        if (vec_length(vec_sub(s.shading_normal, vec3(n[0], n[1], n[2]))) > 1e-3)
            fail_msg("%g %g: %f %f %f", cases[k].x, cases[k].z, s.shading_normal.x, s.shading_normal.y,
                     s.shading_normal.z);
    }
    scene_close(&scene);
}

static void test_errors(void **unused)
{
    (void)unused;
    expect_error(V37 "height_field{png \"nowhere.png\"}", "cannot find the image `nowhere.png`");
    expect_error(V37 "height_field{png \"colors.inc\"}", "height_field: ");
    expect_error(V37 "height_field{function 1,5{x}}", "a height_field of 1 by 5 points");
    expect_error(V37 "height_field{function 70000,5{x}}", "a height_field of 70000 by 5 points");
}

/* ---- bicubic_patch ---- */

#define BENT                                                                                                           \
    "<0,0,0>,<1,0,2>,<2,0,2>,<3,0,0>,<0,1,0>,<1,1,2>,<2,1,2>,<3,1,0>,<0,2,0>,<1,2,2>,<2,2,2>,<3,2,0>,<0,3,0>,<1,3,2>," \
    "<2,3,2>,<3,3,0>"

/* z = 6 s (1 - s) at x = 3 s; steps as POV-Ray's trace() shows them. */
static void test_patch(void **unused)
{
    static const struct {
        const char *options;
        int faces;
        double error;
    } cases[] = {{"type 0 flatness 0 u_steps 3 v_steps 3", 128, .0235},
                 {"type 1 u_steps 0, v_steps 3", 16, .0235},
                 {"type 1 flatness 0, u_steps 3", 16, 2},
                 {"type 1 flatness .1 u_steps 5 v_steps 5", 32, .1},
                 {"type 1", 2, 2}};
    (void)unused;
    for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
        char text[600];
        double worst = 0;
        snprintf(text, sizeof text, V37 "bicubic_patch{%s " BENT "}", cases[n].options);
        Scene *scene = parse(text);
        const Primitive *p = only(scene);
        const Mesh *mesh = p->shape.mesh;
        if (n != 3)
            assert_int_equal(mesh->nfaces, cases[n].faces);
        else
            assert_true(mesh->nfaces > 2 && mesh->nfaces < 2048);
        for (int i = 0; i < mesh->nvertices; i++) {
            const double s = mesh->vertices[i].x / 3;
            assert_true(fabs(mesh->vertices[i].z - 6 * s * (1 - s)) < 1e-12);
            assert_near(mesh->uvs[i].u, s);
            assert_near(mesh->uvs[i].v, mesh->vertices[i].y / 3);
            const Vec3 exact = vec_normalize(vec3(2 * (1 - 2 * s), 0, -1));
            assert_true(fabs(fabs(vec_dot(vec_normalize(mesh->normals[i]), exact)) - 1) < 1e-9);
        }
        for (int i = 0; i < 200; i++) {
            const double s = between(.01, .99);
            const Ray ray = {vec3(3 * s, between(.1, 2.9), -5), vec3(0, 0, 1), 0, 100};
            double t;
            int face;
            assert_true(shape_intersect(p, &ray, &t, &face));
            worst = fmax(worst, fabs(t - 5 - 6 * s * (1 - s)));
        }
        assert_true(worst <= cases[n].error && (n == 3 || worst > cases[n].error / 4));
        scene_close(&scene);
    }
    expect_error(V37 "bicubic_patch{type 2 " BENT "}", "a bicubic_patch of type 2");
    expect_error(V37 "bicubic_patch{type 1 u_steps 13 " BENT "}", "a bicubic_patch of 13 steps");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_against_triangles),
        cmocka_unit_test(test_functions),
        cmocka_unit_test(test_pictures),
        cmocka_unit_test(test_palette),
        cmocka_unit_test(test_gif),
        cmocka_unit_test(test_normals_of_fields),
        cmocka_unit_test(test_smooth_normals_against_povray),
        cmocka_unit_test(test_errors),
        cmocka_unit_test(test_patch),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
