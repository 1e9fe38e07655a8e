/* cutaway_textures: which textures cut faces show, by the membership of points in boxes, and their targets. */
#include <stdio.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include "accel/accel.h"
#include "path/leaves.h"

/* Everything that cuts without a texture is a sphere; what is cut are boxes. */
#define BODIES                                                                                                         \
    V37 "#default{texture{pigment{rgb <1,1,0>}}} #declare T=texture{pigment{rgb <0,1,0>}} "                            \
        "#declare A=box{<-1.5,-1,-1>,<.4,1,1> pigment{rgb <1,0,0>}} "                                                  \
        "#declare B=box{<-.4,-.8,-.9>,<1.5,.8,1.2> texture{T}} "                                                       \
        "#declare C=box{<-1.2,-.4,-2>,<.3,.5,2> pigment{rgb <0,0,1>}} "

static const Vec3 boxes[3][2] = {
    {{-1.5, -1, -1}, {0.4, 1, 1}}, {{-0.4, -0.8, -0.9}, {1.5, 0.8, 1.2}}, {{-1.2, -0.4, -2}, {0.3, 0.5, 2}}};

static double beyond(double x, double low, double high)
{
    return fmax(low - x, x - high);
}

/* 1 inside, 0 outside, -1 too close to tell. */
static int in_box(int box, Vec3 p)
{
    const Vec3 low = boxes[box][0], high = boxes[box][1];
    const double out = fmax(beyond(p.x, low.x, high.x), fmax(beyond(p.y, low.y, high.y), beyond(p.z, low.z, high.z)));
    return fabs(out) < 1e-6 ? -1 : out < 0;
}

/* How much red, green, blue and the default texture count at a point that is in some of the boxes. */
typedef void Weigh(const int in[3], int weights[4]);

static void red_and_green(const int in[3], int weights[4])
{
    weights[0] = in[0], weights[1] = in[1];
}

static void all(const int in[3], int weights[4])
{
    red_and_green(in, weights), weights[2] = in[2];
}

static void red_without_blue(const int in[3], int weights[4])
{
    weights[0] = in[0] && !in[2], weights[1] = in[1];
}

static void red_twice(const int in[3], int weights[4])
{
    weights[0] = in[0] + in[2], weights[1] = in[1];
}

static void red_alone(const int in[3], int weights[4])
{
    (void)in, weights[0] = 1;
}

static void green_alone(const int in[3], int weights[4])
{
    (void)in, weights[1] = 1;
}

static void default_alone(const int in[3], int weights[4])
{
    (void)in, weights[3] = 1;
}

static void red_and_default(const int in[3], int weights[4])
{
    weights[0] = in[0], weights[3] = in[1];
}

static Rgb weighted_mean(const int weights[4])
{
    const float sum = (float)(weights[0] + weights[1] + weights[2] + weights[3]);
    return rgb((float)(weights[0] + weights[3]) / sum, (float)(weights[1] + weights[3]) / sum, (float)weights[2] / sum);
}

static Rgb mean_color(const Leaves *leaves)
{
    Rgb sum = {0, 0, 0};
    for (int k = 0; k < leaves->count; k++) {
        const Rgbft c = leaves->leaf[k].color;
        sum = rgb_add(sum, rgb_scale(rgb(c.r, c.g, c.b), leaves_share(leaves, k)));
    }
    return sum;
}

static const struct {
    const char *text;
    Weigh *weigh;
} scenes[] = {
    {"difference{union{object{A} object{B}} sphere{<0,.7,-1>,1} cutaway_textures}", red_and_green},
    {"difference{merge{object{A} object{B}} sphere{<0,.7,-1>,1} sphere{<-.8,-.4,-1>,.4} cutaway_textures}",
     red_and_green},
    {"intersection{sphere{0,.7} object{A} object{B} cutaway_textures}", red_and_green},
    {"intersection{union{object{A} object{B} object{C}} sphere{0,1.1} cutaway_textures}", all},
    {"difference{difference{union{object{A} object{B}} sphere{<0,.7,-1>,1}} sphere{<.5,-.8,-.6>,.7} cutaway_textures}",
     red_and_green},
    {"difference{difference{union{object{A} object{B}} sphere{<0,.7,-1>,1} cutaway_textures} plane{-x,-.2 pigment{rgb "
     "1}}}",
     red_and_green},
    {"intersection{union{difference{object{A} object{C}} object{B}} sphere{0,1.1} cutaway_textures}", red_without_blue},
    {"difference{object{A} union{sphere{<-.5,.7,-1>,.6} sphere{<-1,-.5,-1>,.5}} cutaway_textures}", red_alone},
    {"difference{union{union{box{<-1.5,-1,-1>,<.4,1,1>} box{<-1.2,-.4,-2>,<.3,.5,2>} pigment{rgb <1,0,0>}} object{B}} "
     "sphere{<0,.3,-1>,1} cutaway_textures}",
     red_twice},
    {"difference{union{object{A} box{<-.4,-.8,-.9>,<1.5,.8,1.2>}} sphere{<0,.7,-1>,1} cutaway_textures}",
     red_and_default},
    /* a texture for the whole is that of the parts without one, and without the word there is the default texture */
    {"difference{union{object{A} object{B}} sphere{<0,.7,-1>,1} cutaway_textures texture{T}}", green_alone},
    {"#declare D=difference{union{object{A} object{B}} sphere{<0,.7,-1>,1} cutaway_textures} object{D texture{T}}",
     green_alone},
    {"difference{union{object{A} object{B}} sphere{<0,.7,-1>,1}}", default_alone},
    {"intersection{object{A} union{sphere{0,.5} sphere{<0,.5,0>,.4}} cutaway_textures}", default_alone},
};

static void show_the_operands_that_contain_them(void **unused)
{
    enum { RAYS = 3000, SEEN = 150 };
    uint32_t state = 5;
    (void)unused;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        char text[2048];
        Accel *accel;
        int seen = 0;
        snprintf(text, sizeof text, "%s %s", BODIES, scenes[i].text);
        Scene *scene = parse(text);
        assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
        for (int k = 0; k < RAYS; k++) {
            const Vec3 from = {6 * test_random(&state) - 3, 6 * test_random(&state) - 3, -5};
            const Vec3 to = {3 * test_random(&state) - 1.5, 2 * test_random(&state) - 1, test_random(&state) - 1};
            const Ray ray = {from, vec_normalize(vec_sub(to, from)), 0, INFINITY};
            Hit hit;
            Surface s;
            Leaves leaves;
            int in[3], weights[4] = {0};
            if (!accel_intersect(accel, &ray, RAY_CAMERA, &hit) ||
                scene->primitives[hit.primitive].shape.ops != &shape_sphere)
                continue;
            surface_at(&s, scene, &ray, &hit);
            for (int box = 0; box < 3; box++)
                in[box] = in_box(box, s.position);
            if (in[0] < 0 || in[1] < 0 || in[2] < 0)
                continue;
            scenes[i].weigh(in, weights);
            const Rgb expected = weighted_mean(weights);
            leaves_at(&leaves, &s, vec_scale(ray.direction, -1), 1);
            const Rgb found = mean_color(&leaves);
            seen++;
            if (fabsf(found.r - expected.r) + fabsf(found.g - expected.g) + fabsf(found.b - expected.b) > 1e-5f)
                fail_msg("%s at %g %g %g: %g %g %g, expected %g %g %g", scenes[i].text, s.position.x, s.position.y,
                         s.position.z, (double)found.r, (double)found.g, (double)found.b, (double)expected.r,
                         (double)expected.g, (double)expected.b);
        }
        assert_true(seen > SEEN);
        accel_close(&accel);
        scene_close(&scene);
    }
}

/* What a ray along z through x, y meets. */
static Leaves leaves_through(const Scene *scene, const Accel *accel, double x, double y)
{
    const Ray ray = {{x, y, -5}, {0, 0, 1}, 0, INFINITY};
    Hit hit;
    Surface s;
    Leaves leaves;
    assert_true(accel_intersect(accel, &ray, RAY_CAMERA, &hit));
    surface_at(&s, scene, &ray, &hit);
    leaves_at(&leaves, &s, vec3(0, 0, -1), 1);
    return leaves;
}

static void are_targets_as_the_operands_are(void **unused)
{
    const char *const names[] = {"T", "A"};
    Accel *accel;
    (void)unused;
    Scene *scene = parse(BODIES "difference{union{object{A} object{B}} sphere{<0,.3,-1>,.9} cutaway_textures}");
    assert_int_equal(scene_resolve_targets(scene, names, 2, NULL), 0);
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    Leaves leaves = leaves_through(scene, accel, -0.6, 0.3);
    assert_int_equal(leaves.count, 1);
    assert_int_equal(leaves.leaf[0].target, 1);
    leaves = leaves_through(scene, accel, 0.6, 0.3);
    assert_int_equal(leaves.count, 1);
    assert_int_equal(leaves.leaf[0].target, 0);
    leaves = leaves_through(scene, accel, 0, 0.3);
    assert_int_equal(leaves.count, 2);
    assert_int_equal(leaves.leaf[0].target + leaves.leaf[1].target, 1);
    assert_near(leaves.leaf[0].weight, 0.5);
    accel_close(&accel);
    scene_close(&scene);
}

/* Of many copies each has its own texture, where it has one. */
static void are_those_of_each_copy(void **unused)
{
    Accel *accel;
    (void)unused;
    Scene *scene =
        parse(BODIES "#declare D=difference{union{object{A} object{B} union{#for(I,1,400) sphere{2*z,.1} #end}} "
                     "sphere{<0,.3,-1>,.9} cutaway_textures} "
                     "#for(I,0,20) object{D translate 5*I*x #if(mod(I,2)) texture{T} #end} #end");
    assert_int_equal(accel_create(&accel, scene, 1, NULL), 0);
    for (int i = 0; i <= 20; i++) {
        const Leaves leaves = leaves_through(scene, accel, 5 * i - 0.6, 0.3);
        assert_int_equal(leaves.count, 1);
        assert_near(leaves.leaf[0].color.r, i % 2 ? 0 : 1);
        assert_near(leaves.leaf[0].color.g, i % 2 ? 1 : 0);
    }
    accel_close(&accel);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(show_the_operands_that_contain_them),
        cmocka_unit_test(are_targets_as_the_operands_are),
        cmocka_unit_test(are_those_of_each_copy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
