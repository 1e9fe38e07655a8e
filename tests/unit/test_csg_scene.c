/* CSG beside its hits: what emitting operands shine, whose interior and texture faces have, the language, limits. */
#include <stdio.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include "accel/accel.h"
#include "light/lights.h"

/* ---- emitters ---- */

static uint32_t state = 7;

static Ray ray_from(Vec3 origin, Vec3 direction, double end)
{
    return (Ray){origin, direction, 0, end};
}

/* The solid angle of what emits, from samples of its area. */
static double sampled_angle(const Lights *lights, const Accel *accel, Vec3 point, int count)
{
    const LightSampleContext context = {.position = point};
    double sum = 0;

    for (int i = 0; i < count; i++) {
        float u[4];
        LightSample s;
        for (int k = 0; k < 4; k++)
            u[k] = (float)(0.999999 * test_random(&state));
        LightPick pick = lights_pick(lights, &context, u[0], u[1]);
        if (!lights_sample(lights, &context, &pick, u[2], u[3], &s))
            continue;
        assert_true(s.pdf > 0);
        Ray ray = ray_from(point, s.direction, s.distance * (1 - 1e-6));
        if (!accel_occluded(accel, &ray, RAY_SHADOW, 0))
            sum += 1 / ((double)s.pdf * s.pick_probability);
    }
    return sum / count;
}

/* … from rays. The density of sampling each hit is told, for shapes that can be sampled. */
static double seen_angle(const Scene *scene, const Lights *lights, const Accel *accel, Vec3 point, int count)
{
    const LightSampleContext context = {.position = point};
    int seen = 0;

    for (int i = 0; i < count; i++) {
        double z = 2 * test_random(&state) - 1, angle = 2 * PI * test_random(&state), rho = sqrt(1 - z * z);
        Ray ray = ray_from(point, vec3(rho * cos(angle), rho * sin(angle), z), INFINITY);
        Hit hit;
        Surface s;
        if (!accel_intersect(accel, &ray, RAY_BOUNCE, &hit))
            continue;
        surface_at(&s, scene, &ray, &hit);
        if (s.texture->finish->emission.r <= 0)
            continue;
        seen++;
        assert_true(lights_emitter_pdf(lights, &context, hit.primitive, &s) > 0);
    }
    return 4 * PI * seen / count;
}

static void emitters_shine_where_they_are_left(void **unused)
{
    /* The cuts themselves are dark. The last two have an inside that is seen. */
    static const char *const scenes[] = {
        "intersection{box{-1,1 texture{Lamp}} plane{x,.3 texture{Dark}}}",
        "difference{sphere{0,1.2 texture{Lamp}} sphere{<.6,-1.4,0>,1 texture{Dark}}}",
        ("difference{mesh{triangle{-1,<1,-1,-1>,<0,1,0>} triangle{-1,<0,1,0>,<0,-1,1>} inside_vector y texture{Lamp}} "
         "cylinder{-3*y,3*y,.3 texture{Dark}}}"),
        "sphere{0,1.2 texture{Lamp} clipped_by{plane{y,.3 inverse}}}",
        "sphere{0,1.2 texture{Lamp} clipped_by{box{-1,1 inverse}}}",
    };
    const Vec3 points[] = {{-0.4, -3, 0.2}, {0.5, -2, 2}};
    enum { SAMPLES = 300000 };

    (void)unused;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        char text[1024];
        Accel *accel;
        Lights *lights;
        snprintf(text, sizeof text,
                 V37 "#declare Lamp=texture{pigment{rgb 1} finish{emission 1}} "
                     "#declare Dark=texture{pigment{rgb 0}} %s",
                 scenes[i]);
        Scene *scene = parse(text);
        assert_int_equal(scene->ncsgs, 1);
        assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
        assert_int_equal(lights_create(&lights, scene, 0, NULL), 0);
        for (int k = 0; k < 2; k++) {
            double sampled = sampled_angle(lights, accel, points[k], SAMPLES);
            double seen = seen_angle(scene, lights, accel, points[k], SAMPLES);
            if (fabs(sampled - seen) > 0.05 * seen + 1e-3)
                fail_msg("%s: %g of samples, %g of rays", scenes[i], sampled, seen);
        }
        lights_close(&lights);
        accel_close(&accel);
        scene_close(&scene);
    }
}

/* ---- whose texture and interior ---- */

static void cut_faces_take_after_the_first_operand(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "difference{sphere{0,1 pigment{rgb .5} interior{ior 1.5}} box{0,1}}"
                             "difference{sphere{0,1 pigment{rgb .5}} box{0,1} cutaway_textures}"
                             "intersection{sphere{0,1} box{0,1 interior{ior 2}} pigment{rgb .2} interior{ior 1.3}}");
    const Primitive *p = scene->primitives;
    assert_int_equal(scene->nprimitives, 6);
    assert_ptr_equal(p[1].interior, p[0].interior);
    assert_ptr_not_equal(p[1].texture, p[0].texture);
    assert_int_equal(p[1].inverse, 1);
    assert_ptr_equal(p[3].texture, p[2].texture);
    assert_near(p[4].interior->ior, 1.3);
    assert_near(p[5].interior->ior, 2);
    assert_ptr_equal(p[4].texture, p[5].texture);
    scene_close(&scene);
}

/* ---- the language ---- */

static void identifiers_are_objects(void **unused)
{
    (void)unused;
    Scene *scene = parse(V37 "#declare A = sphere{0,1} #declare B = plane{y,0} A "
                             "object{A clipped_by{B translate y}} intersection{sphere{0,2} B}");
    assert_int_equal(scene->nprimitives, 4);
    assert_int_equal(scene->ncsgs, 2);
    scene_close(&scene);
    expect_error("union{#declare A = sphere{0,1} #declare B = plane{y,0} A B}", "expected");
}

static void nesting_has_an_end(void **unused)
{
    const char *loop = V37 "#declare A=sphere{0,1} #for (I,1,1000) #declare A=sphere{0,1 clipped_by{%s}} #end";
    char text[256];

    (void)unused;
    snprintf(text, sizeof text, loop, "object{A}");
    expect_error(text, "nested more than 400 deep");
    snprintf(text, sizeof text, loop, "object{A} object{A}");
    expect_error(text, "parts");
}

/* ---- the language's functions ---- */

static void functions_see_what_is_left(void **unused)
{
    (void)unused;
    Scene *scene = parse(
        V37 "#declare D = difference{box{-1,1} sphere{0,1.2} translate 5*x} #declare N = <0,0,0>; "
            "#if (inside(D, 5*x)) #error \"in the hole\" #end #if (!inside(D, <5.95,.95,.95>)) #error \"corner\" #end "
            "#declare P = trace(D, <5,0,-5>, z, N); #if (vlength(N) > 0) #error \"through both holes\" #end "
            "#declare P = trace(D, <5.6,.7,-5>, z, N); "
            "#if (vlength(P - <5.6,.7,-1>) > 1e-9 | N.z > -.999) #error \"front\" #end "
            "#declare P = trace(D, <5.6,.7,-.99>, z, N); "
            "#if (abs(vlength(P - 5*x) - 1.2) > 1e-9 | vdot(N, P - 5*x) > -1) #error \"cut\" #end "
            "#declare C = sphere{0,1 clipped_by{plane{y,0}} translate y}; "
            "#declare P = trace(C, <0,5,0>, -y, N); #if (vlength(P) > 1e-9) #error \"clip\" #end "
            "#if (inside(C, 1.5*y) | !inside(C, .5*y)) #error \"clip\" #end");
    scene_close(&scene);
}

/* As in POV-Ray: all of a ray that meets the bounding object, or begins in it, meets the object. */
static void bounds_are_the_objects_themselves(void **unused)
{
    static const struct {
        Vec3 origin, direction;
        double t; /* 0: nothing is met */
    } rays[] = {
        {{5, 0, 3}, {-1, 0, 0}, 0}, /* beside the sphere */
        {{5, 0, 1.9}, {-1, 0, 0}, 4},
        {{5, 0.9, 1.9}, {-1, 0, 0}, 0}, /* beside the sphere, within the box round it */
        {{0.5, 0, 1.9}, {0, 1, 0}, 0.8660254037844386},
        {{0.8, 0, 0}, {0.0995037190209989, 0, 0.995037190209989}, 2.0099751242241780}, /* from within, to the rim */
    };
    Scene *scene = parse(V37 "quadric{<1,1,0>,0,0,-1 bounded_by{sphere{0,2}}}");
    Accel *accel;
    RetexError err = {0};

    (void)unused;
    assert_int_equal(accel_create(&accel, scene, 1, &err), 0);
    for (size_t i = 0; i < sizeof rays / sizeof *rays; i++) {
        const Ray ray = ray_from(rays[i].origin, rays[i].direction, INFINITY);
        Hit hit;
        assert_int_equal(accel_intersect(accel, &ray, RAY_CAMERA, &hit), rays[i].t > 0);
        assert_int_equal(accel_occluded(accel, &ray, RAY_SHADOW, 0), rays[i].t > 0);
        assert_true(rays[i].t == 0 || fabs(hit.t - rays[i].t) < 1e-9);
    }
    accel_close(&accel);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(emitters_shine_where_they_are_left),
        cmocka_unit_test(cut_faces_take_after_the_first_operand),
        cmocka_unit_test(identifiers_are_objects),
        cmocka_unit_test(nesting_has_an_end),
        cmocka_unit_test(functions_see_what_is_left),
        cmocka_unit_test(bounds_are_the_objects_themselves),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
