/* Cameras: each projection against its closed form, lenses, and rays from meshes. */
#include "lib_scene_text.h"

#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "camera/camera.h"

enum { WIDTH = 40, HEIGHT = 20 };
#define DEGREE (PI / 180)

static Scene *scene_of(const char *camera)
{
    char text[1024];
    snprintf(text, sizeof text, V37 "%s", camera);
    return parse(text);
}

static Ray ray_at(const Scene *scene, double x, double y)
{
    return camera_ray(&scene->camera, WIDTH, HEIGHT, x, y, NULL);
}

/* Where a point is in the picture: -0.5 to 0.5, to the right and up. */
static double part_x(double x)
{
    return x / WIDTH - 0.5;
}
static double part_y(double y)
{
    return 0.5 - y / HEIGHT;
}

/* Every seventh of a pixel or so, also on the edges. */
#define EACH_POINT(x, y)                                                                                               \
    for (double y = 0; y <= HEIGHT; y += 1.25)                                                                         \
        for (double x = 0; x <= WIDTH; x += 0.9)

static void check_unit(const Ray *ray)
{
    assert_near(vec_length(ray->direction), 1);
}

/* Longitude from z to x, latitude towards y. */
static double longitude(const Ray *ray)
{
    return atan2(ray->direction.x, ray->direction.z);
}
static double latitude(const Ray *ray)
{
    return asin(fmax(-1, fmin(1, ray->direction.y)));
}

static void test_perspective_angle(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{perspective right 2*x up y angle 100}");
    Ray left = ray_at(scene, 0, HEIGHT / 2.0), top = ray_at(scene, WIDTH / 2.0, 0);
    assert_near(longitude(&left), -50 * DEGREE);
    assert_near(tan(latitude(&top)), tan(50 * DEGREE) / 2);
    scene_close(&scene);
}

/* The angle from the axis is proportional to the distance from the middle of the picture, on the same side. */
static void test_fisheye(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{fisheye right 2*x up y angle 250}");
    int none = 0;
    EACH_POINT(x, y)
    {
        const Ray ray = ray_at(scene, x, y);
        const double dx = 4 * part_x(x), dy = 2 * part_y(y), distance = hypot(dx, dy);
        if (distance > 1) {
            assert_false(camera_ray_exists(&ray));
            none++;
            continue;
        }
        assert_true(camera_ray_exists(&ray));
        check_unit(&ray);
        assert_near(atan2(hypot(ray.direction.x, ray.direction.y), ray.direction.z), distance * 125 * DEGREE);
        assert_near(ray.direction.x * dy, ray.direction.y * dx);
        assert_true(ray.direction.x * dx >= -1e-12 && ray.direction.y * dy >= -1e-12);
    }
    assert_true(none > 100);
    scene_close(&scene);
}

static void test_ultra_wide_angle(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{ultra_wide_angle right 2*x up y angle 200}");
    Ray right = ray_at(scene, WIDTH, HEIGHT / 2.0), top = ray_at(scene, WIDTH / 2.0, 0);
    assert_near(longitude(&right), 100 * DEGREE);
    assert_near(latitude(&top), 50 * DEGREE);
    EACH_POINT(x, y)
    {
        const Ray ray = ray_at(scene, x, y);
        const double a = part_x(x) * 200 * DEGREE, b = part_y(y) * 100 * DEGREE;
        check_unit(&ray);
        assert_near(ray.direction.x * sin(b), ray.direction.y * sin(a));
        assert_near(ray.direction.z * sin(b), ray.direction.y * cos(a) * cos(b));
    }
    scene_close(&scene);
}

/* At some points by hand: with square pixels, the middle, the top at 1.411269 - .09439 + .25674 radians, and below. */
static void test_omnimax(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{omnimax right x up y}");
    Ray middle = ray_at(scene, WIDTH / 2.0, HEIGHT / 2.0), top = ray_at(scene, WIDTH / 2.0, 0);
    assert_near(middle.direction.z, 1);
    assert_near(top.direction.y, sin(1.573619));
    assert_near(top.direction.z, cos(1.573619));
    const double angle = 0.5 * 1.411269 - 0.125 * 0.09439 + 0.03125 * 0.25674;
    Ray right = ray_at(scene, WIDTH * 0.75, HEIGHT / 2.0);
    assert_near(longitude(&right), angle);
    Ray below = ray_at(scene, WIDTH / 2.0, HEIGHT * 0.75);
    assert_near(latitude(&below), -angle);
    below = ray_at(scene, WIDTH / 2.0, HEIGHT * 0.78); /* the angle is 45 degrees at .5569 of the radius */
    assert_false(camera_ray_exists(&below));
    scene_close(&scene);
    /* twice as wide as high: the circle is as wide as the picture would be at 1.283458, and its top at the top */
    scene = scene_of("camera{omnimax right 2*x up y}");
    top = ray_at(scene, WIDTH / 2.0, 0);
    assert_near(top.direction.y, sin(1.573619));
    Ray corner = ray_at(scene, WIDTH * 0.95, HEIGHT / 2.0), edge = ray_at(scene, WIDTH * 0.8, HEIGHT / 2.0);
    assert_false(camera_ray_exists(&corner));
    assert_true(camera_ray_exists(&edge));
    scene_close(&scene);
}

static void test_panoramic(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{panoramic right x up y}");
    EACH_POINT(x, y)
    {
        const Ray ray = ray_at(scene, x, y);
        check_unit(&ray);
        assert_near(latitude(&ray), part_y(y) * PI);
        if (y > 0 && y < HEIGHT)
            assert_near(longitude(&ray), part_x(x) * PI);
    }
    scene_close(&scene);
}

static void test_spherical(void **state)
{
    (void)state;
    Scene *scene = scene_of("camera{spherical right 4/3*x up y angle 300, 100}");
    EACH_POINT(x, y)
    {
        const Ray ray = ray_at(scene, x, y);
        check_unit(&ray);
        assert_near(longitude(&ray), part_x(x) * 300 * DEGREE);
        assert_near(latitude(&ray), part_y(y) * 100 * DEGREE);
    }
    scene_close(&scene);
    scene = scene_of("camera{spherical angle 120}"); /* half of it vertically */
    Ray top = ray_at(scene, WIDTH / 2.0, 0);
    assert_near(latitude(&top), 30 * DEGREE);
    scene_close(&scene);
    scene = scene_of("camera{spherical}");
    Ray corner = ray_at(scene, WIDTH * 0.75, HEIGHT * 0.25);
    assert_near(longitude(&corner), 90 * DEGREE);
    assert_near(latitude(&corner), 45 * DEGREE);
    scene_close(&scene);
}

/* Of type 1, rays meet the cylinder of radius 1 at the longitude and height that the picture's point has; of type 2
 * the same with x and y changed over; types 3 and 4 start at that height. */
static void test_cylinders(void **state)
{
    (void)state;
    Scene *scenes[4];
    char text[100];
    for (int k = 0; k < 4; k++) {
        snprintf(text, sizeof text, "camera{cylinder %d location <0,0,7> right 3*x up 5*y angle 140}", k + 1);
        scenes[k] = scene_of(text);
    }
    EACH_POINT(x, y)
    {
        Ray r[4];
        for (int k = 0; k < 4; k++) {
            r[k] = ray_at(scenes[k], x, y);
            check_unit(&r[k]);
        }
        const double across = part_x(x) * 140 * DEGREE, along = part_y(y) * 140 * DEGREE;
        assert_near(longitude(&r[0]), across);
        assert_near(r[0].direction.y / hypot(r[0].direction.x, r[0].direction.z), 5 * part_y(y));
        assert_near(atan2(r[1].direction.y, r[1].direction.z), along);
        assert_near(r[1].direction.x / hypot(r[1].direction.y, r[1].direction.z), 3 * part_x(x));
        assert_vec(r[2].origin, 0, 5 * part_y(y), 7);
        assert_vec(r[2].direction, sin(across), 0, cos(across));
        assert_vec(r[3].origin, 3 * part_x(x), 0, 7);
        assert_vec(r[3].direction, 0, sin(along), cos(along));
    }
    for (int k = 0; k < 4; k++)
        scene_close(&scenes[k]);
    expect_error(V37 "camera{cylinder 5}", "type 1 to 4");
    expect_error(V37 "camera{cylinder 0}", "type 1 to 4");
}

/* ---- what is written ---- */

static void test_identifier_keeps_size(void **state)
{
    (void)state;
    Scene *scene =
        scene_of("#declare C = camera{orthographic location -10*z look_at 0 angle 90} camera{C translate y}");
    assert_near(vec_length(scene->camera.right), 20);
    assert_vec(scene->camera.location, 0, 1, -10);
    scene_close(&scene);
}

/* Before version 3.5 the order counts: here angle takes the right vector of before, and look_at is taken from 0. */
static void test_old_order(void **state)
{
    (void)state;
    static const char camera[] = "camera{angle 90 look_at z right 4*x location <0,0,-3>}";
    char text[200];
    snprintf(text, sizeof text, "#version 3.1; %s", camera);
    Scene *scene = parse(text);
    assert_near(scene->camera.direction.z, 1.33 / 2);
    assert_near(scene->camera.right.x, 4);
    scene_close(&scene);
    scene = scene_of(camera);
    assert_near(scene->camera.direction.z, 2);
    scene_close(&scene);
}

/* A view that would be wrong stops, unless one is content with it; strict has precedence. */
static void test_what_is_not_supported(void **state)
{
    (void)state;
    static const char text[] = V37 "camera{user_defined{location{function{0}}} right 2*x}";
    SdlOptions options = SDL_OPTIONS_INIT;
    RetexError err = {0};
    Scene *scene;
    assert_int_equal(parse_with(&scene, text, &options, &err), RETEX_EUNSUPPORTED);
    assert_non_null(strstr(err.message, "`user_defined` is not supported yet"));
    assert_non_null(strstr(err.message, "--lenient"));
    options.lenient = 1;
    assert_int_equal(parse_with(&scene, text, &options, &err), 0);
    assert_non_null(strstr(messages, "warning: `user_defined` is not supported yet: a perspective camera is used"));
    assert_ptr_equal(scene->camera.ops, &camera_perspective);
    scene_close(&scene);
    options.strict = 1;
    assert_int_equal(parse_with(&scene, text, &options, &err), RETEX_EUNSUPPORTED);
}

/* ---- normals ---- */

/* What POV-Ray shows of a sphere of radius 1 about the origin whose colour is the place on it, as half floats, in a
 * picture of 8x6 pixels (povray +W8 +H6 -A -J +FE): its pigment is an average of gradients. */
static void rays_are_tilted_as_by_povray(void **state)
{
    (void)state;
    static const struct {
        const char *camera;
        int x, y;
        Vec3 seen;
    } cases[] = {
        {"perspective", 2, 1, {-0.6924, 0.5576, 0.4570}},
        {"perspective", 5, 4, {0.3232, -0.3433, 0.8818}},
        {"orthographic", 2, 1, {-0.6926, 0.5771, 0.4336}},
        {"orthographic", 5, 4, {0.3223, -0.3413, 0.8828}},
        {"fisheye", 2, 1, {-0.1465, -0.2837, 0.9473}},
        {"fisheye", 5, 4, {0.5371, 0.0039, 0.8428}},
        {"omnimax", 2, 1, {-0.4907, 0.8125, 0.3145}},
        {"omnimax", 5, 4, {0.9863, -0.1665, -0.0034}},
        {"ultra_wide_angle", 2, 1, {-0.6184, 0.2891, 0.7305}},
        {"ultra_wide_angle", 5, 4, {-0.5356, 0.8359, 0.1211}},
        {"panoramic", 2, 1, {-0.7156, 0.5410, 0.4424}},
        {"panoramic", 5, 4, {0.1045, -0.7205, 0.6855}},
        {"cylinder 1 up 2*y", 2, 1, {0.6709, -0.7412, -0.0068}},
        {"cylinder 1 up 2*y", 5, 4, {-0.3169, -0.7733, 0.5488}},
        {"cylinder 2 right 2*x", 2, 1, {-0.8975, -0.0771, 0.4346}},
        {"cylinder 2 right 2*x", 5, 4, {-0.4839, 0.8740, -0.0522}},
        {"cylinder 3", 2, 1, {-0.3970, 0.4082, 0.8223}},
        {"cylinder 3", 5, 4, {-0.2339, 0.7402, 0.6299}},
        {"cylinder 4", 2, 1, {-0.9458, -0.0479, 0.3213}},
        {"cylinder 4", 5, 4, {-0.8765, 0.3818, 0.2930}},
        {"spherical", 2, 1, {-0.8240, 0.2832, -0.4907}},
        {"spherical", 5, 4, {0.3145, -0.7791, 0.5420}},
        {"perspective rotate 30*z translate <.1,0,.2>", 2, 1, {-0.6343, 0.4297, 0.6426}},
        {"perspective rotate 30*z translate <.1,0,.2>", 5, 4, {0.4248, -0.1475, 0.8926}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[1024];
        const char *moved = strstr(cases[k].camera, " rotate");
        const int kind = (int)(moved ? moved - cases[k].camera : (long)strlen(cases[k].camera));
        snprintf(text, sizeof text, V37 "camera{%.*s location 0 normal{bumps 2 scale .3} %s}", kind, cases[k].camera,
                 moved ? moved : "");
        Scene *scene = parse(text);
        const Ray ray = camera_ray(&scene->camera, 8, 6, cases[k].x + 0.5, cases[k].y + 0.5, NULL);
        check_unit(&ray);
        const double b = vec_dot(ray.origin, ray.direction), c = vec_dot(ray.origin, ray.origin) - 1;
        const Vec3 seen = vec_mad(ray.origin, ray.direction, -b + sqrt(b * b - c));
        if (vec_length(vec_sub(seen, cases[k].seen)) > 2e-3)
            fail_msg("%s: %g %g %g", cases[k].camera, seen.x, seen.y, seen.z);
        scene_close(&scene);
    }
    /* uv_mapping has no meaning here; and a normal without bumps changes nothing, not even how sharp a lens is */
    Scene *plain = scene_of("camera{direction 3*z}"), *level = scene_of("camera{direction 3*z normal{bumps 0}}");
    Scene *mapped = scene_of("camera{normal{bumps 1 uv_mapping}}");
    check_unit(&(Ray){.direction = ray_at(mapped, 3, 4).direction});
    plain->camera.lens = level->camera.lens = (CameraLens){.aperture = 0.4, .focal_distance = 7};
    const Ray a = camera_ray(&plain->camera, 8, 6, 2, 1, (float[]){0.3f, 0.4f}),
              b = camera_ray(&level->camera, 8, 6, 2, 1, (float[]){0.3f, 0.4f});
    assert_near(vec_length(vec_sub(a.direction, b.direction)), 0);
    scene_close(&plain), scene_close(&level), scene_close(&mapped);
}

/* ---- the lens ---- */

static void lens_point(int k, int count, float sample[2])
{
    sample[0] = (float)((k + 0.5) / count);
    sample[1] = (float)fmod(k * 0.6180339887498949, 1);
}

/* Share of a disc of radius 1 beyond x. */
static double segment(double x)
{
    return x >= 1 ? 0 : x <= -1 ? 1 : (acos(x) - x * sqrt(1 - x * x)) / PI;
}

/* The share of rays through a pixel that pass the edge of a half plane is that of the lens's disc, in perspective. */
static void test_lens_blurs_an_edge(void **state)
{
    (void)state;
    enum { COUNT = 40000 };
    Scene *scene = scene_of("camera{location <1,2,0> direction 2*z right 2*x up y aperture 1.6 blur_samples 9"
                            " focal_point <1,2,5>}");
    const double radius = 0.4, depths[] = {2, 4.5, 5, 9};
    for (int d = 0; d < 4; d++)
        for (double edge = -0.5; edge <= 0.5; edge += 0.05) {
            int beyond = 0;
            for (int k = 0; k < COUNT; k++) {
                float sample[2];
                lens_point(k, COUNT, sample);
                const Ray ray = camera_ray(&scene->camera, WIDTH, HEIGHT, 26, 7, sample);
                check_unit(&ray);
                const double t = (depths[d] - ray.origin.z) / ray.direction.z;
                beyond += ray.origin.x + t * ray.direction.x > 1 + edge;
                assert_near(ray.origin.z, 0);
                assert_true(hypot(ray.origin.x - 1, ray.origin.y - 2) <= radius * (1 + 1e-9));
            }
            const double middle = part_x(26) * depths[d]; /* right is as long as direction */
            const double scale = radius * (1 - depths[d] / 5), from = edge - middle;
            const double expected = fabs(scale) < 1e-9 ? from < 0 : segment(from / fabs(scale));
            if (fabs(from) > 1e-6)
                assert_true(fabs((double)beyond / COUNT - expected) < 0.004);
        }
    scene_close(&scene);
}

static void test_lens_of_other_kinds(void **state)
{
    (void)state;
    static const char *const kinds[] = {"orthographic", "fisheye", "panoramic", "cylinder 3", "spherical"};
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        char text[200];
        snprintf(text, sizeof text, "camera{%s right x up y aperture 0.8 blur_samples 4, 9 focal_point 3*z}", kinds[i]);
        Scene *scene = scene_of(text);
        const Ray sharp = ray_at(scene, 21, 9);
        Vec3 focus = {0, 0, 0};
        for (int k = 0; k < 50; k++) { /* all rays cross in one point */
            float sample[2];
            lens_point(k, 50, sample);
            const Ray ray = camera_ray(&scene->camera, WIDTH, HEIGHT, 21, 9, sample);
            const Vec3 aside = vec_sub(ray.origin, sharp.origin);
            const double across = vec_length(vec_cross(ray.direction, sharp.direction));
            if (k == 0) {
                const double t = vec_length(vec_cross(aside, ray.direction)) / across;
                focus = vec_mad(sharp.origin, sharp.direction, t);
                assert_true(t > 2.8 && t < 3.2);
            }
            assert_near(vec_length(vec_cross(vec_sub(focus, ray.origin), ray.direction)), 0);
        }
        scene_close(&scene);
    }
}

static void test_lens_without_samples_is_sharp(void **state)
{
    (void)state;
    static const char *const cameras[] = {"camera{aperture 2 focal_point z}", "camera{blur_samples 9}",
                                          "camera{aperture 0 blur_samples 9}"};
    for (int k = 0; k < 3; k++) {
        Scene *scene = scene_of(cameras[k]);
        assert_false(camera_needs_sample(&scene->camera));
        scene_close(&scene);
    }
}

/* White in one quarter, a third as bright in another. */
static void test_bokeh(void **state)
{
    (void)state;
    enum { COUNT = 30000 };
    Scene *scene = scene_of("camera{aperture 4 blur_samples 9 bokeh{pigment{gradient x color_map{"
                            "[0.5 rgb 0][0.5 rgb 1/3][0.75 rgb 1/3][0.75 rgb 1]}}}}");
    int bright = 0;
    for (int k = 0; k < COUNT; k++) {
        float sample[2];
        lens_point(k, COUNT, sample);
        const Ray ray = camera_ray(&scene->camera, WIDTH, HEIGHT, 20, 10, sample);
        assert_true(ray.origin.x >= -1e-6 && ray.origin.x <= 1 && fabs(ray.origin.y) <= 1);
        bright += ray.origin.x > 0.5;
    }
    assert_true(fabs((double)bright / COUNT - 0.75) < 0.01);
    scene_close(&scene);
    scene = scene_of("camera{aperture 4 blur_samples 9 bokeh{pigment{rgb 0}}}"); /* POV-Ray gives up, too */
    double sum = 0;
    for (int k = 0; k < COUNT; k++) {
        float sample[2];
        lens_point(k, COUNT, sample);
        sum += fabs(camera_ray(&scene->camera, WIDTH, HEIGHT, 20, 10, sample).origin.x);
    }
    assert_true(fabs(sum / COUNT - 0.5) < 0.01);
    scene_close(&scene);
}

/* ---- rays from meshes ---- */

/* A row of faces at z = 0, the k-th with its middle at x = k + 1/3, and one without area before them, which does not
 * count. Normals are -z. */
static void write_faces(char *text, size_t size, int count, double y)
{
    size_t used = (size_t)snprintf(text, size, "mesh{triangle{0,x,2*x}");
    for (int k = 0; k < count; k++)
        used += (size_t)snprintf(text + used, size - used, "triangle{<%d,%g,0>,<%d,%g,0>,<%d,%g,0>}", k, y, k, y + 1,
                                 k + 1, y);
    snprintf(text + used, size - used, "}");
}

static void test_mesh_rows(void **state)
{
    (void)state;
    char faces[8192], more[8192], text[20000];
    write_faces(faces, sizeof faces, 100, 0);
    write_faces(more, sizeof more, 50, 5);
    snprintf(text, sizeof text, V37 "camera{mesh_camera{2 0 9 %s %s} location 0.5*z}", faces, more);
    Scene *scene = parse(text);
    static const struct {
        double x, y;
        int face; /* or -1 */
    } cases[] = {{0.1, 0.9, 0}, {39.9, 0.1, 39}, {3.5, 1.5, 3}, {3.5, 2.5, 43}, {19.5, 3.5, 99}, {20.5, 3.5, -1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const Ray ray = ray_at(scene, cases[k].x, cases[k].y);
        assert_int_equal(camera_ray_exists(&ray), cases[k].face >= 0);
        if (cases[k].face < 0)
            continue;
        assert_vec(ray.origin, cases[k].face + 1.0 / 3, 1.0 / 3, 0.5 * ray.direction.z);
        assert_near(fabs(ray.direction.z), 1);
        assert_near(ray.tmax, 9);
    }
    /* the second number of rays comes from the second mesh */
    assert_true(camera_needs_sample(&scene->camera));
    const float low[2] = {0.4f, 0}, high[2] = {0.6f, 0};
    assert_near(camera_ray(&scene->camera, WIDTH, HEIGHT, 3, 0.5, low).origin.y, 1.0 / 3);
    assert_near(camera_ray(&scene->camera, WIDTH, HEIGHT, 3, 0.5, high).origin.y, 5 + 1.0 / 3);
    const double forward = ray_at(scene, 3, 0.5).direction.z;
    scene_close(&scene);

    snprintf(text, sizeof text, V37 "camera{mesh_camera{1 1 %s %s} direction -z}", faces, more);
    scene = parse(text); /* one after the other, and backwards */
    assert_vec(ray_at(scene, 19.5, 3.5).origin, 99 + 1.0 / 3, 1.0 / 3, 0);
    assert_vec(ray_at(scene, 20.5, 3.5).origin, 1.0 / 3, 5 + 1.0 / 3, 0);
    assert_near(ray_at(scene, 20.5, 3.5).direction.z, -forward);
    assert_false(isfinite(ray_at(scene, 20.5, 3.5).tmax));
    scene_close(&scene);

    snprintf(text, sizeof text, V37 "#declare M = %s camera{mesh_camera{1 2 mesh{M} mesh{M rotate 180*y}}}", faces);
    scene = parse(text); /* side by side: columns count on */
    assert_vec(ray_at(scene, 19.5, 2.5).origin, 39 + 1.0 / 3, 1.0 / 3, 0);
    Ray ray = ray_at(scene, 20.5, 2.5);
    assert_vec(ray.origin, -(40 + 1.0 / 3), 1.0 / 3, 0);
    assert_near(ray.direction.z, -forward);
    scene_close(&scene);
}

/* A square of two faces whose UV is a quarter of itself, turned by transforms; without UV nothing is seen. */
static void test_mesh_by_uv(void **state)
{
    (void)state;
    static const char square[] =
        "mesh2{vertex_vectors{4,<0,0,0>,<2,0,0>,<2,2,0>,<0,2,0>} normal_vectors{4,-z,<.6,0,-.8>,<.6,0,-.8>,-z}"
        "uv_vectors{4,<0,0>,<0.5,0>,<0.5,0.5>,<0,0.5>} face_indices{2,<0,1,2>,<0,2,3>} translate 3*y}";
    char text[1000];
    for (int smooth = 0; smooth < 2; smooth++) {
        snprintf(text, sizeof text, V37 "camera{mesh_camera{1 3 %s %s}}", square, smooth ? "smooth" : "");
        Scene *scene = parse(text);
        EACH_POINT(x, y)
        {
            const Ray ray = ray_at(scene, x, y);
            const double px = fmin(x, WIDTH - 1), py = fmin(fmax(y - 1, 0), HEIGHT - 1);
            const double u = (px - 0.5) / WIDTH, v = 1 - (py + 0.5) / HEIGHT;
            if (fabs(u) < 1e-9 || fabs(u - 0.5) < 1e-9 || fabs(v - 0.5) < 1e-9)
                continue;
            assert_int_equal(camera_ray_exists(&ray), u > 0 && u < 0.5 && v > 0 && v < 0.5);
            if (!camera_ray_exists(&ray))
                continue;
            assert_vec(ray.origin, 4 * u, 3 + 4 * v, 0);
            const Vec3 normal = smooth ? vec_normalize(vec3(1.2 * u, 0, -1 + 0.4 * u)) : vec3(0, 0, -1);
            assert_near(fabs(vec_dot(ray.direction, normal)), 1);
        }
        scene_close(&scene);
    }
}

/* mesh_camera{RAYS DISTRIBUTION MESHES [smooth]}: what is refused, and with which words. */
static void test_mesh_errors(void **state)
{
    (void)state;
#define MESH " mesh{triangle{0,x,y}}"
    static const struct {
        const char *inside, *error;
    } cases[] = {{"0 0" MESH, "at least one ray"},  {"1 4" MESH, "distribution 0 to 3"},
                 {"2 3" MESH, "2 and 3 have one ray"}, {"2 0" MESH, "one for each ray"},
                 {"1 0" MESH " smooth", "smooth needs"}, {"1 0 mesh{}", "triangles"},
                 {"1 0", "needs a mesh"}};
#undef MESH
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char text[300];
        snprintf(text, sizeof text, V37 "camera{mesh_camera{%s}}", cases[k].inside);
        expect_error(text, cases[k].error);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_perspective_angle),
        cmocka_unit_test(rays_are_tilted_as_by_povray),
        cmocka_unit_test(test_fisheye),
        cmocka_unit_test(test_ultra_wide_angle),
        cmocka_unit_test(test_omnimax),
        cmocka_unit_test(test_panoramic),
        cmocka_unit_test(test_spherical),
        cmocka_unit_test(test_cylinders),
        cmocka_unit_test(test_identifier_keeps_size),
        cmocka_unit_test(test_old_order),
        cmocka_unit_test(test_what_is_not_supported),
        cmocka_unit_test(test_lens_blurs_an_edge),
        cmocka_unit_test(test_lens_of_other_kinds),
        cmocka_unit_test(test_lens_without_samples_is_sharp),
        cmocka_unit_test(test_bokeh),
        cmocka_unit_test(test_mesh_rows),
        cmocka_unit_test(test_mesh_by_uv),
        cmocka_unit_test(test_mesh_errors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
