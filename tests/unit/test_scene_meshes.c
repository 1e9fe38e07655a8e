/* What the language builds: meshes and polygons, and refused ones; compounds. */
#include "lib_scene_text.h"
#include "shape/csg.h"
#include "shape/shape.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

/* ---- meshes ---- */

static const char mesh2_text[] =
    V37 "mesh2{ vertex_vectors{4, <0,0,0>,<1,0,0>,<1,1,0>,<0,1,0>} normal_vectors{1,<0,0,1>}"
        " uv_vectors{4 <0,0>,<1,0>,<1,1>,<0,1>}"
        " texture_list{2, texture{pigment{rgb <1,0,0>}} texture{pigment{rgb <0,1,0>}}}"
        " face_indices{2, <0,1,2>,0, <0,2,3>,1} normal_indices{2,<0,0,0>,<0,0,0>} translate 5*x }";

static void test_mesh2(void **state)
{
    (void)state;
    Scene *scene = parse(mesh2_text);
    const Primitive *p = only(scene);
    const Mesh *mesh = p->shape.mesh;
    assert_int_equal(mesh->nvertices, 4);
    assert_int_equal(mesh->nfaces, 2);
    assert_int_equal(mesh->faces[1].texture, 1);
    assert_int_equal(mesh->faces[1].normal[2], 0);
    assert_int_equal(mesh->faces[1].uv[2], 3); /* by the vertices' indices */
    assert_color(p->shape.textures->list[1]->pigment->color, 0, 1, 0);
    assert_vec(transform_point(&p->transform, mesh->vertices[1]), 6, 0, 0);
    scene_close(&scene);
}

static void test_mesh2_errors(void **state)
{
    (void)state;
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} face_indices{1,<0,1,3>}}", "vertex 3");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} face_indices{1,<0,-1,2>}}", "vertex -1");
    expect_error(V37 "mesh2{vertex_vectors{4,<0,0,0>,<1,0,0>,<0,1,0>} face_indices{1,<0,1,2>}}", "only 3 are there");
    expect_error(V37 "mesh2{vertex_vectors{2,<0,0,0>,<1,0,0>,<0,1,0>} face_indices{1,<0,1,1>}}", "more than");
    expect_error(V37 "mesh2{vertex_vectors{1e12,0,x,y}}", "number of elements");
    expect_error(V37 "mesh2{vertex_vectors{-1,0}}", "number of elements");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} texture_list{1,texture{}} face_indices{1,<0,1,2>,1}}", "texture 1");
    expect_error(V37 "mesh2{vertex_vectors{3,0,x,y} uv_vectors{1,<0,0>} face_indices{1,<0,1,2>}"
                     " uv_indices{1,<0,0,1>}}",
                 "UV 1");
    expect_error(V37 "mesh2{face_indices{0}}", "vertex_vectors");
}

static void test_mesh(void **state)
{
    (void)state;
    Scene *scene = parse(
        V37 "#declare A = texture{pigment{rgb 1}} #declare B = texture{pigment{rgb <1,0,0>}}"
            "mesh{ triangle{0,x,y texture{A}} smooth_triangle{0,z,x,z,y,z uv_vectors <0,0>,<1,0>,<0,1> texture{B}}"
            " triangle{0,x,z texture{A}} triangle{0,z,y} inside_vector y pigment{rgb <0,0,1>} }");
    const Mesh *mesh = only(scene)->shape.mesh;
    assert_int_equal(mesh->nfaces, 4);
    assert_int_equal(only(scene)->shape.textures->count, 2);
    assert_int_equal(mesh->faces[2].texture, mesh->faces[0].texture);
    assert_int_equal(mesh->faces[3].texture, -1);
    assert_int_equal(mesh->faces[0].normal[0], -1);
    assert_true(mesh->faces[1].normal[2] >= 0 && mesh->faces[1].uv[2] >= 0);
    assert_true(mesh->closed_inside);
    scene_close(&scene);
}

/* Each corner has a texture of its own: shares by barycentric weights, and one texture where they are the same. */
static void test_corner_textures(void **state)
{
    static const char *const texts[2] = {
        V37 "mesh2{vertex_vectors{4,0,x,y,z} texture_list{3,texture{pigment{rgb x}},texture{pigment{rgb y}},"
            "texture{pigment{rgb z}}} face_indices{3,<0,1,3>,1,<0,1,2>,0,1,2,<0,2,3>,1,1,1}}",
        V37 "#declare X=texture{pigment{rgb x}} #declare Y=texture{pigment{rgb y}} #declare Z=texture{pigment{rgb z}}"
            "mesh{triangle{0,x,z texture{Y}} triangle{0,x,y texture_list{X Y Z}} triangle{0,y,z texture_list{Y Y Y}}}"};
    (void)state;
    for (int k = 0; k < 2; k++) {
        Scene *scene = parse(texts[k]);
        const Primitive *p = only(scene);
        const double b1 = .3, b2 = .5;
        int counts[3] = {0, 0, 0}, n = 20000;
        for (int i = 0; i < n; i++) {
            Surface s = {.primitive = p, .face = 1, .position = vec3(b1 + 1e-9 * i, b2, 0), .b1 = b1, .b2 = b2};
            const Rgbft c = p->shape.textures->list[p->shape.ops->texture(&s)]->pigment->color;
            counts[c.r > 0 ? 0 : c.g > 0 ? 1 : 2]++;
            for (s.face = 0; s.face < 3; s.face += 2)
                assert_color(p->shape.textures->list[p->shape.ops->texture(&s)]->pigment->color, 0, 1, 0);
        }
        assert_true(fabs(counts[0] - .2 * n) < 300 && fabs(counts[1] - .3 * n) < 300);
        scene_close(&scene);
    }
}

static void test_loose_triangles(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "#declare Net = union{ triangle{0,x,y} triangle{x,y,z translate z}"
                             "  smooth_triangle{0,z,x,z,y,z} pigment{rgb 1} }"
                             "object{Net translate 3*x} sphere{0,1} triangle{0,x,y no_shadow} triangle{0,x,z} "
                             "triangle{0,y,z} object{Net}");
    assert_int_equal(scene->nprimitives, 5);
    assert_int_equal(scene->primitives[3].shape.mesh->nfaces, 2);
    assert_ptr_equal(scene->primitives[4].shape.mesh, scene->primitives[0].shape.mesh);
    const Mesh *mesh = scene->primitives[0].shape.mesh;
    assert_int_equal(mesh->nfaces, 3);
    assert_vec(transform_point(&scene->primitives[0].transform, mesh->vertices[3]), 4, 0, 1);
    assert_int_equal(mesh->faces[0].normal[0], -1);
    assert_vec(mesh->normals[mesh->faces[2].normal[1]], 0, 0, 1);
    assert_string_equal(scene->primitives[0].idents->name, "Net");
    scene_close(&scene);
}

static double mesh_area(const Scene *scene)
{
    double area = 0;
    const Mesh *mesh = only(scene)->shape.mesh;
    for (int i = 0; i < mesh->nfaces; i++) {
        const int *v = mesh->faces[i].vertex;
        area += 0.5 * vec_length(vec_cross(vec_sub(mesh->vertices[v[1]], mesh->vertices[v[0]]),
                                           vec_sub(mesh->vertices[v[2]], mesh->vertices[v[0]])));
    }
    return area;
}

static void test_polygons(void **state)
{
    (void)state;
    struct {
        const char *text;
        double area;
    } cases[] = {
        {"polygon{5,<0,0>,<2,0>,<2,1>,<0,1>,<0,0>}", 2},
        {"polygon{4,<0,0>,<2,0>,<2,1>,<0,1>}", 2},                                       /* not closed */
        {"polygon{10,<0,0>,<4,0>,<4,4>,<0,4>,<0,0>,<1,1>,<1,2>,<2,2>,<2,1>,<1,1>}", 15}, /* a hole */
        {"polygon{7,<0,0>,<3,0>,<3,3>,<2,3>,<2,1>,<0,1>,<0,0>}", 5},                     /* an L */
        {"polygon{5,<0,0>,<2,2>,<2,0>,<0,2>,<0,0>}", 2},                                 /* a bow tie */
        /* Two squares that overlap: even-odd leaves the common part out. */
        {"polygon{10,<0,0>,<2,0>,<2,2>,<0,2>,<0,0>,<1,1>,<3,1>,<3,3>,<1,3>,<1,1>}", 6},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[512];
        snprintf(text, sizeof text, "%s%s", V37, cases[i].text);
        /* In a plane that leans: areas must not change. */
        char *brace = strrchr(text, '}');
        snprintf(brace, sizeof text - (size_t)(brace - text), " rotate <20,30,40>}");
        Scene *scene = parse(text);
        assert_near(mesh_area(scene), cases[i].area);
        scene_close(&scene);
    }
    expect_error(V37 "polygon{2,0,x}", "points");
    Scene *scene = parse(V37 "polygon{4,0,x,2*x,0}");
    assert_int_equal(scene->nprimitives, 0);
    scene_close(&scene);
}

/* A five-pointed star drawn in one stroke: even-odd leaves its middle empty. */
static void test_star(void **state)
{
    (void)state;
    char text[1024] = V37 "polygon{6";
    for (int i = 0; i <= 5; i++) {
        double a = 2 * PI * (2 * i % 5) / 5;
        snprintf(text + strlen(text), sizeof text - strlen(text), ",<%.17g,%.17g>", cos(a), sin(a));
    }
    strcat(text, "}");
    Scene *scene = parse(text);
    double r = cos(2 * PI / 5) / cos(PI / 5), pentagon = 2.5 * r * r * sin(2 * PI / 5);
    assert_near(mesh_area(scene), 10 * 0.5 * r * sin(PI / 5) - pentagon);
    scene_close(&scene);
}

/* ---- compounds ---- */

static void test_csg(void **state)
{
    (void)state;
    Scene *scene = parse(V37 "difference{box{-1,1} sphere{0,1.2} pigment{rgb 1}} "
                             "intersection{plane{y,0} sphere{0,1} box{0,1}} merge{sphere{0,1} sphere{x,1}} "
                             "union{sphere{0,1} sphere{x,1}} union{sphere{0,1} sphere{x,1} inverse}");
    assert_int_equal(scene->nprimitives, 11);
    assert_int_equal(scene->ncsgs, 4);
    for (int i = 0; i < 11; i++) {
        assert_int_equal(scene->primitives[i].csg == NULL, i == 7 || i == 8);
        assert_int_equal(scene->primitives[i].inverse, i == 1 || i > 8);
    }
    assert_int_equal(scene->primitives[9].csg->parent->kind, CSG_INTERSECTION);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_mesh2),
        cmocka_unit_test(test_mesh2_errors),
        cmocka_unit_test(test_corner_textures),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_loose_triangles),
        cmocka_unit_test(test_polygons),
        cmocka_unit_test(test_star),
        cmocka_unit_test(test_csg),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
