/* Light sources of every kind against POV-Ray: tests/data/lights.txt has what it shows of a plane, a sphere and its
 * shadow in their light (tests/lib/povray_lights.py). */
#include "lib_scene.h"

#include <math.h>
#include <stdio.h>
#include "accel/accel.h"
#include "light/source.h"

/* Of 64. Shadows may begin in the middle of a pixel, which POV-Ray samples; an `orient` grid is turned about its axis
 * in another way. */
#define MOST_EDGES 2
#define MOST_EDGES_ORIENT 5
#define TOLERANCE 0.01

static char scene_text[2048], lights_text[2048];

typedef struct Case {
    Scene *scene;
    Accel *accel;
    int points, edges;
} Case;

/* How many samples along a side of an area_light meet each of its lights as often as they weigh. */
static int side_samples(const Light *light, int size)
{
    return !light->area ? 1 : light->area_illumination ? size : 64;
}

/* Radiance of a white surface in the light of one source. */
static Rgb shaded(const Case *c, const Light *light, const Surface *surface)
{
    const int n1 = side_samples(light, light->size1), n2 = side_samples(light, light->size2);
    Rgb sum = {0, 0, 0};
    for (int k = 0; k < n1 * n2; k++) {
        LightSample s;
        const float u1 = (float)((k % n1 + 0.5) / n1), u2 = (float)(((double)(k / n1) + 0.5) / n2);
        if (!light_reaches(light, surface->primitive->light_group) ||
            !source_sample(light, surface->position, u1, u2, &s))
            continue;
        const Ray ray = {accel_offset(surface->position, surface->geometric_normal, s.shadow_direction),
                         s.shadow_direction, 0, s.shadow_distance * (1 - 1e-6)};
        if (!s.shadowless && accel_occluded(c->accel, &ray, RAY_SHADOW, 0))
            continue;
        const double cosine = fmax(0, vec_dot(s.direction, surface->geometric_normal));
        sum = rgb_add(sum, rgb_scale(s.radiance, (float)(cosine / PI / n1 / n2)));
    }
    return sum;
}

static Rgb seen_from_above(const Case *c, double x, double z)
{
    const Ray ray = {{x, 10, z}, {0, -1, 0}, 0, INFINITY};
    Rgb sum = {0, 0, 0};
    Hit hit;
    Surface surface;
    assert_true(accel_intersect(c->accel, &ray, RAY_CAMERA, &hit));
    surface_at(&surface, c->scene, &ray, &hit);
    for (int k = 0; k < c->scene->nlights; k++)
        sum = rgb_add(sum, shaded(c, &c->scene->lights[k], &surface));
    return sum;
}

static void close_case(Case *c)
{
    if (c->edges > (strstr(lights_text, "orient") ? MOST_EDGES_ORIENT : MOST_EDGES))
        fail_msg("%s: %d of %d points differ from POV-Ray's", lights_text, c->edges, c->points);
    if (c->accel)
        accel_close(&c->accel);
    if (c->scene)
        scene_close(&c->scene);
    c->edges = c->points = 0;
}

static void open_case(Case *c)
{
    char text[4096];
    snprintf(text, sizeof text, "%s %s", scene_text, lights_text);
    c->scene = test_scene(text);
    assert_int_equal(accel_create(&c->accel, c->scene, 1, NULL), 0);
}

static void compare_point(Case *c, const char *line)
{
    double x, z, r, g, b;
    assert_int_equal(sscanf(line, "%lf %lf %lf %lf %lf", &x, &z, &r, &g, &b), 5);
    const Rgb found = seen_from_above(c, x, z);
    const double off = fmax(fabs((double)found.r - r), fmax(fabs((double)found.g - g), fabs((double)found.b - b)));
    c->points++;
    c->edges += off > TOLERANCE * fmax(fmax(r, g), fmax(b, 0.1));
}

static void lights_are_those_of_povray(void **state)
{
    (void)state;
    FILE *file = fopen("tests/data/lights.txt", "r");
    char line[2048];
    Case c = {0};
    int cases = 0;
    assert_non_null(file);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\n")] = 0;
        if (!strncmp(line, "scene ", 6)) {
            snprintf(scene_text, sizeof scene_text, "%s", line + 6);
        } else if (!strncmp(line, "lights ", 7)) {
            close_case(&c);
            snprintf(lights_text, sizeof lights_text, "%s", line + 7);
            open_case(&c), cases++;
        } else {
            compare_point(&c, line);
        }
    }
    close_case(&c);
    fclose(file);
    assert_true(cases > 40);
}

/* With jitter the lights of a grid are spread over all of it, and a little beyond. */
static void jitter_spreads_a_grid(void **state)
{
    (void)state;
    Scene *scene = test_scene("light_source { 0, 1 area_light 4*x, 4*z, 3, 3 jitter } sphere { 0, 1 }");
    enum { N = 128 };
    int counts[6] = {0};
    for (int k = 0; k < N; k++) {
        const Vec3 p = source_point(&scene->lights[0], vec3(0, 0, 0), (float)((k + 0.5) / N), 0.5f);
        assert_true(fabs(p.x) < 3);
        counts[(int)(p.x + 3)]++;
    }
    /* lights at -2, 0 and 2 weigh 1, 2 and 1 */
    for (int k = 0; k < 6; k++)
        assert_int_equal(counts[k], k == 2 || k == 3 ? N / 4 : N / 8);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lights_are_those_of_povray),
        cmocka_unit_test(jitter_spreads_a_grid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
