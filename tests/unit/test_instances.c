/* Copies of compounds, which become instances: a scene that declares its compounds once is compared with one that
 * writes each copy out by a macro, whose compounds are all different. */
#include <stdio.h>
#include <string.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include <retex/budget.h>
#include "accel/accel.h"
#include "path/shading.h"

enum { TEXT_SIZE = 16384, RAYS = 60000 };

static uint32_t state = 11;

static double between(double low, double high)
{
    return low + (high - low) * test_random(&state);
}
static Vec3 within(double size)
{
    double x = between(-size, size), y = between(-size, size), z = between(-size, size);

    return vec3(x, y, z);
}

/* A CSG, and a union with triangles, curved shapes and CSG; some parts have textures, flags and names of their own. */
static const char contents[] =
    "#declare T=texture{pigment{checker rgb<.9,.3,.2>, rgb<.2,.3,.9> scale .3}}\n"
    "#declare Clear=texture{pigment{rgbf<.9,.3,.2,.8>}}\n"
    "#declare Leaf=texture{pigment{gradient x color_map{[0 rgb 0] [1 rgb 1]} scale .4} normal{gradient y .5}}\n"
    "#declare Ball=sphere{<.2,0,.3>,.4}\n"
    "#macro C() difference{ merge{sphere{0,1} box{-.8,.8} cylinder{-1.2*y,1.2*y,.3 texture{Leaf}}}"
    " cylinder{-2*x,2*x,.4} cylinder{-2*z,2*z,.4 pigment{rgb<.1,.8,.1>}} sphere{y,.4}"
    " intersection{sphere{-y,.5} box{-2,2}} bounded_by{sphere{0,2}} } #end\n"
    "#macro U() union{ torus{.5,.1} object{Ball}"
    " sphere{<1.3,0,-.6>,.4 clipped_by{plane{y,.1}} interior_texture{pigment{rgb .1}}} box{-1,-.6 texture{Leaf}}"
    " cone{y,.2,2*y,0 no_shadow}"
    " mesh{ triangle{<1,0,0>,<1,1,0>,<1,0,1>} triangle{<1,0,0>,<1,1,0>,<2,0,-1>} }"
    " triangle{<-1,0,0>,<-1,1,0>,<-1,0,1>} triangle{<-1,0,0>,<-1,1,0>,<-2,0,-1>}"
    " difference{ sphere{<0,1,1>,.5} plane{z,1} } sphere{<-1,1,-1>,.4 texture{Clear}}"
    " union{ box{1.1,1.4} sphere{1.5,.2 no_image} rotate 20*y } } #end\n";
static const char placing[] =
    "#declare S=seed(4);\n#declare i=0; #while (i < 5000)\n"
    "object{ %s scale <.4+.4*rand(S),.4+.4*rand(S),(.4+.4*rand(S))*(mod(i,3)=1?-1:1)>"
    " rotate 360*<rand(S),rand(S),rand(S)> #if (mod(i,5)=1) texture{T} #end"
    " translate <-30+60*rand(S),-6+12*rand(S),-30+60*rand(S)>"
    " #if (mod(i,7)=2) texture{T} #end #if (mod(i,11)=3) texture{Clear} #end #if (mod(i,13)=4) no_shadow #end }\n"
    "#declare i=i+1; #end\n"
    "union{ %s object{Marked rotate <3,5,7>} %s texture{T} scale 2 translate 9*y }\n";

static Scene *scene_of(int shared)
{
    static char text[TEXT_SIZE], copies[2048];
    const char *one = shared ? "#if (mod(i,2)) CC #else UU #end" : "#if (mod(i,2)) C() #else U() #end";
    char *out = text;

    snprintf(copies, sizeof copies, placing, one, shared ? "object{UU}" : "object{U()}",
             shared ? "object{CC translate 3*x}" : "object{C() translate 3*x}");
    out += snprintf(out, sizeof text, "%s%s#declare Marked=object{%s}\n", V37, contents, shared ? "UU" : "U()");
    if (shared)
        snprintf(text, sizeof text, "%s%s#declare CC=C(); #declare UU=U();\n#declare Marked=object{UU}\n%s", V37,
                 contents, copies);
    else
        snprintf(out, sizeof text - (size_t)(out - text), "%s", copies);
    return parse(text);
}

static void assert_same_hit(const Scene *a, const Scene *b, const Ray *ray, const Hit *h, const Hit *g, int *marked)
{
    Shading s, r;

    shading_at(&s, a, NULL, 0, ray, h);
    shading_at(&r, b, NULL, 0, ray, g);
    assert_int_equal(s.surface.target, r.surface.target);
    assert_int_equal(s.surface.backside, r.surface.backside);
    assert_true(vec_length(vec_sub(s.surface.position, r.surface.position)) < 1e-9);
    assert_true(vec_length(vec_sub(s.surface.geometric_normal, r.surface.geometric_normal)) < 1e-6);
    assert_true(vec_length(vec_sub(s.surface.shading_normal, r.surface.shading_normal)) < 1e-6);
    assert_true(vec_length(vec_sub(s.bsdf.normal, r.bsdf.normal)) < 1e-4);
    assert_true(fabs(s.albedo.g - r.albedo.g) < 1e-4 && s.filter == r.filter);
    if (s.surface.target >= 0) {
        const Vec2 u = surface_target_uv(&s.surface), v = surface_target_uv(&r.surface);
        assert_true(fabs(u.u - v.u) < 1e-5 && fabs(u.v - v.v) < 1e-5);
        marked[s.surface.target]++;
    }
}

/* All that shading reads of a hit, and what shadow rays meet. Where edges are met, or a checker changes, float or the
 * last bit decides. */
static void instances_are_as_what_they_stand_for(void **unused)
{
    static const char *const targets[] = {"Ball", "T", "Marked", "Leaf"};
    Scene *one = scene_of(1), *two = scene_of(0);
    Accel *a, *b;
    RetexError err = {0};
    int hits = 0, odd = 0, of_instances = 0, clear = 0, marked[4] = {0};

    (void)unused;
    assert_true(one->ninstances > 500 && one->nprimitives < two->nprimitives / 2);
    assert_int_equal(two->ninstances, 0);
    assert_int_equal(scene_resolve_targets(one, targets, 4, &err), 0);
    assert_int_equal(scene_resolve_targets(two, targets, 4, &err), 0);
    test_must(accel_create(&a, one, 1, &err), &err);
    test_must(accel_create(&b, two, 1, &err), &err);
    for (int i = 0; i < RAYS; i++) {
        const Vec3 from = within(40);
        const Ray ray = {from, vec_normalize(vec_sub(within(20), from)), 0, i % 3 ? INFINITY : between(1, 60)};
        const RayKind kind = (RayKind)(1 << i % 3);
        Hit h, g;
        int met = accel_intersect(a, &ray, kind, &h);
        odd += met != accel_intersect(b, &ray, kind, &g) ||
               accel_visibility(a, &ray, i & 1) != accel_visibility(b, &ray, i & 1);
        clear += accel_visibility(b, &ray, 1) == VISIBILITY_TRANSPARENT;
        if (!met || g.primitive < 0)
            continue;
        if (fabs(h.t - g.t) > 1e-9) {
            odd++;
            continue;
        }
        hits++, of_instances += h.instance != NULL;
        assert_int_equal(accel_is_transparent(a, &h), accel_is_transparent(b, &g));
        assert_same_hit(one, two, &ray, &h, &g, marked);
    }
    assert_true(odd <= RAYS / 10000);
    assert_true(hits > RAYS / 4 && of_instances > hits / 4 && clear > 100);
    for (int i = 0; i < 4; i++)
        assert_true(marked[i] > 20);
    accel_close(&a);
    accel_close(&b);
    scene_close(&one);
    scene_close(&two);
}

/* A forest: what a copy costs does not depend on its size. */
static void copies_take_little_memory(void **unused)
{
    static const char text[] =
        V37 "#declare S=seed(1); #declare Tree=union{ #declare i=0; #while (i < 1000)"
            " sphere{<rand(S),rand(S),rand(S)>,.02 #if (mod(i,3)) pigment{bozo} #end} #declare i=i+1; #end }\n"
            "#declare i=0; #while (i < 10000) object{Tree rotate 360*rand(S)*y translate <mod(i,100),0,i/100>"
            " pigment{rgb rand(S)}} #declare i=i+1; #end";
    RetexBudget *budget = NULL;
    RetexError err = {0};
    SdlOptions options = {0};
    Scene *scene;
    Accel *accel;

    (void)unused;
    test_must(retex_budget_create(&budget, &err), &err);
    retex_budget_set_memory(budget, 100000000);
    options.budget = budget;
    test_must(parse_with(&scene, text, &options, &err), &err);
    test_must(accel_create_within(&accel, scene, 1, budget, &err), &err);
    assert_true(scene->ninstances > 9900 && scene->nprimitives < 20000);
    accel_close(&accel);
    scene_close(&scene);
    retex_budget_close(&budget);
}

/* What an instance cannot be: an emitter, for lights are chosen among primitives. */
static void emitters_stay_apart(void **unused)
{
    Scene *scene = parse(V37 "#declare L=union{ sphere{0,.1 finish{emission 1}} box{1,2} }"
                             "#declare i=0; #while (i < 6000) object{L translate i*3*x} #declare i=i+1; #end");

    (void)unused;
    assert_int_equal(scene->ninstances, 0);
    assert_int_equal(scene->nprimitives, 12000);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(instances_are_as_what_they_stand_for),
        cmocka_unit_test(copies_take_little_memory),
        cmocka_unit_test(emitters_stay_apart),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
