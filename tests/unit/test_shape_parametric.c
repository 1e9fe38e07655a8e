/* Parametric surfaces: their meshes against the surfaces' equations. */
#include "lib_implicit.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "lib_scene_text.h"

#define SPHERE "parametric{function{sin(u)*cos(v)} function{sin(u)*sin(v)} function{cos(u)} <0,0>,<pi,2*pi> "

static const Mesh *mesh_of(Scene *scene)
{
    assert_int_equal(scene->nprimitives, 1);
    assert_non_null(scene->primitives[0].shape.mesh);
    return scene->primitives[0].shape.mesh;
}

/* How far the middle of the worst face is from the unit sphere, and the worst normal from its corner's. */
static void worst(const Mesh *mesh, double *distance, double *angle)
{
    *distance = *angle = 0;
    for (int i = 0; i < mesh->nfaces; i++) {
        const MeshFace *f = &mesh->faces[i];
        Vec3 sum = {0, 0, 0};
        for (int k = 0; k < 3; k++) {
            const Vec3 p = mesh->vertices[f->vertex[k]];
            const Vec2 uv = mesh->uvs[f->uv[k]];
            sum = vec_add(sum, p);
            *distance = fmax(*distance, fabs(vec_length(p) - 1));
            assert_true(fabs(p.z - cos(uv.u)) < 1e-3);
            if (f->normal[k] >= 0)
                *angle = fmax(*angle, vec_length(vec_cross(mesh->normals[f->normal[k]], vec_normalize(p))));
        }
        *distance = fmax(*distance, fabs(vec_length(vec_scale(sum, 1.0 / 3)) - 1));
    }
}

static void test_sphere(void **state)
{
    (void)state;
    double distance, angle;
    Scene *scene = parse(V37 SPHERE "contained_by{box{-1.1,1.1}} accuracy .001}");
    worst(mesh_of(scene), &distance, &angle);
    assert_true(distance < .001 && distance > 1e-5);
    assert_true(angle < 1e-3); /* at the poles, elsewhere 1e-9 */
    assert_false(scene->primitives[0].shape.ops->inside && mesh_of(scene)->closed_inside);
    scene_close(&scene);
    Scene *finer = parse(V37 SPHERE "contained_by{sphere{0,1.1}} accuracy .00005 max_gradient 3 precompute 12 x,y,z}");
    worst(mesh_of(finer), &distance, &angle);
    assert_true(distance < 1.5 * .00005);
    scene_close(&finer);
}

/* What the container cuts off, and the area of what it leaves. */
static double area_of(const char *options)
{
    char text[1024];
    snprintf(text, sizeof text, "%s%s%s", V37 SPHERE, options, "}");
    Scene *scene = parse(text);
    const Mesh *mesh = mesh_of(scene);
    double area = 0;
    for (int i = 0; i < mesh->nfaces; i++) {
        const int *v = mesh->faces[i].vertex;
        area += 0.5 * vec_length(vec_cross(vec_sub(mesh->vertices[v[1]], mesh->vertices[v[0]]),
                                           vec_sub(mesh->vertices[v[2]], mesh->vertices[v[0]])));
    }
    scene_close(&scene);
    return area;
}

static void test_container(void **state)
{
    (void)state;
    /* zones of a sphere: 2 pi h */
    assert_true(fabs(area_of("contained_by{box{<-2,-2,-.3>,<2,2,.4>}}") - 2 * PI * .7) < .01);
    assert_true(fabs(area_of("contained_by{box{<.2,-2,-2>,<2,2,2>}}") - 2 * PI * .8) < .01);
    assert_true(fabs(area_of("contained_by{box{<0,0,0>,2}}") - PI / 2) < .01);
    assert_true(fabs(area_of("") - 4 * PI) < .02); /* -1 to 1 */
    /* the part of it within 1 of (0, 0, 1): a cap of height 1/2 */
    assert_true(fabs(area_of("contained_by{sphere{z,1}}") - PI) < .01);
}

static void test_forms(void **state)
{
    (void)state;
    /* parameters by other names, contents alone, a singular point, and numbers that are none */
    Scene *scene = parse(V37 "parametric{function(a,b){a} function(a,b){b} function(u,v){u*v} <1,1>,<0,0>}");
    assert_true(mesh_of(scene)->nfaces >= 2);
    scene_close(&scene);
    scene = parse(V37 "parametric{ u*cos(v), u*sin(v), u, <0,0>,<1,2*pi> }");
    assert_true(mesh_of(scene)->nfaces > 100);
    scene_close(&scene);
    scene = parse(V37 "parametric{ function{ln(u)} function{v} function{0} <-1,0>,<1,1> }");
    for (int i = 0; i < mesh_of(scene)->nvertices; i++)
        assert_true(isfinite(mesh_of(scene)->vertices[i].x));
    scene_close(&scene);
    scene = parse(V37 "sphere{0,1} parametric{ function{u} function{v} function{5} <0,0>,<1,1> }");
    assert_int_equal(scene->nprimitives, 1);
    assert_non_null(strstr(messages, "nothing is in its container"));
    scene_close(&scene);
    expect_error("parametric{ function(a,b,c,d){a} function{v} function{5} <0,0>,<1,1> }", "4 arguments");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sphere),
        cmocka_unit_test(test_container),
        cmocka_unit_test(test_forms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
