/* Bumps: normals that `normal` statements tilt, compared with those of POV-Ray's pictures in tests/data/normals.txt
 * (tests/lib/povray_normals.py), and the rules for transforms and maps. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "lib_scene_text.h"
#include "shade/normal.h"
#include "shape/surface.h"

#define RADIUS 1.5

/* A sphere with these bumps. */
static Scene *sphere(Vec3 centre, const char *bumps)
{
    char text[2048];
    snprintf(text, sizeof text, V37 "sphere { <%.9g,%.9g,%.9g>, 1.5 pigment { rgb 1 } normal { %s } }", centre.x,
             centre.y, centre.z, bumps);
    return parse(text);
}

static Vec3 tilted(const Scene *scene, Vec3 p)
{
    const Ray ray = {vec3(p.x, p.y, p.z - 5), {0, 0, 1}, 0, INFINITY};
    const Hit hit = {.t = 5, .primitive = 0};
    Surface surface;
    surface_at(&surface, scene, &ray, &hit);
    return normal_tilted(surface.texture->normal, &surface, surface.shading_normal, ray.direction);
}

static void normals_are_povray(void **state)
{
    (void)state;
    FILE *file = fopen("tests/data/normals.txt", "r");
    char line[1024], bumps[1024] = "", folder[1024];
    Scene *scene = NULL;
    double worst = 0;
    int bad = 0, count = 0, failed = 0;
    assert_non_null(file);
    assert_non_null(getcwd(folder, sizeof folder));
    assert_int_equal(chdir("tests/data"), 0); /* bump_maps are there */
    for (int more = 1; more;) {
        Vec3 p, base, n;
        more = fgets(line, sizeof line, file) != NULL;
        line[strcspn(line, "\n")] = 0;
        if (more && sscanf(line, "at %lf %lf %lf %lf %lf %lf %lf %lf %lf", &p.x, &p.y, &p.z, &base.x, &base.y, &base.z,
                           &n.x, &n.y, &n.z) == 9) {
            if (!scene)
                scene = sphere(vec_mad(p, base, -RADIUS), bumps);
            if (strstr(messages, "not supported"))
                continue;
            const double difference = vec_length(vec_sub(tilted(scene, p), vec_normalize(n)));
            worst = fmax(worst, difference);
            bad += difference > 1e-3, count++;
            continue;
        }
        if (scene && bad) {
            print_error("%s: %d of %d differ, by %.5f at most\n", bumps, bad, count, worst);
            failed++;
        }
        if (scene)
            scene_close(&scene);
        worst = 0, bad = count = 0;
        snprintf(bumps, sizeof bumps, "%s", line + (strncmp(line, "normal ", 7) == 0 ? 7 : 0));
    }
    fclose(file);
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(failed, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_are_povray),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
