/* AOVs that are averaged over the pixel: closed forms where an edge or nothing crosses it, the picture itself where
 * surfaces shine in their own colour, and a brute-force mean of the AOVs of a picture that is finer. */
#include <stdio.h>
#include "lib_scene_text.h"
#include <cmocka.h>
#include "render/render.h"

/* Five units wide and three high: five by three pixels are a unit each, and x = 0 halves the one at the centre. */
#define CAMERA "camera{orthographic location -9*z right 5*x up 3*y direction z} "
/* Left of x = 0 a wall that faces the camera, right of it a slope of 45 degrees to x = 1.75; beyond it nothing. */
#define ROOF                                                                                                           \
    CAMERA "box{<-9,-9,0>,<0,9,.1> pigment{rgb <.2,.4,.6>}} "                                                          \
           "mesh{triangle{<0,-90,0>,<0,90,0>,<1.75,-90,1.75>} triangle{<0,90,0>,<1.75,90,1.75>,<1.75,-90,1.75>} "      \
           "pigment{rgb <1,.5,0>}}"

static RetexSet *render(const char *text, const RenderParams *params)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    Scene *scene = parse(text);
    test_must(render_scene(&set, scene, params, NULL, &err), &err);
    scene_close(&scene);
    return set;
}

static RenderParams params_of(int width, int height, int spp)
{
    RenderParams p = RENDER_PARAMS_INIT;
    p.plain = 1, p.width = width, p.height = height, p.spp = spp, p.nthreads = 2;
    p.aovs = RETEX_AOV_BIT(ALBEDO_MEAN) | RETEX_AOV_BIT(NORMAL_MEAN);
    return p;
}

static const float *value(const RetexSet *set, const char *name, int x, int y)
{
    const int part = retex_set_find_part(set, name);
    assert_true(part >= 0);
    return set->parts[part].image.pixels + retex_image_index(&set->parts[part].image, x, y);
}

static void expect(const float *found, double tolerance, double r, double g, double b)
{
    const double wanted[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (!(fabs((double)found[c] - wanted[c]) <= tolerance))
            fail_msg("channel %d is %.6f, should be %.6f", c, (double)found[c], wanted[c]);
}

static void an_edge_is_the_mean_of_its_sides(void **state)
{
    const double h = sqrt(0.5);
    const RenderParams p = params_of(5, 3, 64);
    RetexSet *set = render(V37 ROOF, &p);

    (void)state;
    for (int y = 0; y < 3; y++) {
        expect(value(set, "albedo_mean", 0, y), 1e-6, 0.2, 0.4, 0.6);
        expect(value(set, "normal_mean", 0, y), 1e-6, 0, 0, -1);
        expect(value(set, "albedo_mean", 2, y), 1e-6, 0.6, 0.45, 0.3);
        /* shorter than 1 */
        expect(value(set, "normal_mean", 2, y), 1e-6, h / 2, 0, -(1 + h) / 2);
        expect(value(set, "albedo_mean", 3, y), 1e-6, 1, 0.5, 0);
        expect(value(set, "normal_mean", 3, y), 1e-6, h, 0, -h);
        /* nothing is 0 */
        expect(value(set, "albedo_mean", 4, y), 1e-6, 0.25, 0.125, 0);
        expect(value(set, "normal_mean", 4, y), 1e-6, 0.25 * h, 0, -0.25 * h);
    }
    retex_set_close(&set);
}

/* By the error function of the Gaussian of half a pixel; to some of the 256 samples. */
static void the_filter_is_the_pictures(void **state)
{
    RenderParams p = params_of(5, 3, 1024);
    p.gaussian = 1;
    RetexSet *set = render(V37 ROOF, &p);

    (void)state;
    for (int x = 0; x < 4; x++) {
        const double slope = 0.5 * (1 + erf((x - 2) / 0.5 / sqrt(2))),
                     nothing = 0.5 * (1 + erf((x - 3.75) / 0.5 / sqrt(2)));
        expect(value(set, "albedo_mean", x, 1), 0.02, 0.2 + 0.8 * slope - nothing, 0.4 + 0.1 * slope - 0.5 * nothing,
               0.6 - 0.6 * slope);
    }
    retex_set_close(&set);
}

/* What shines in its own colour is its own picture, through a lens too: the samples are the same ones. */
static void samples_are_the_pictures(void **state)
{
    static const char *const text = V37
        "camera{location -4*z look_at 0 right 4/3*x aperture .6 focal_point 0} #default{finish{emission 1 diffuse 0}}"
        "sphere{0,1 pigment{checker rgb <.1,.5,.9> rgb <.8,.6,.1> scale .2}}"
        "plane{y,-1.2 pigment{checker rgb .9 rgb <.1,.2,0> scale .3}}";

    (void)state;
    for (int k = 0; k < 4; k++) {
        RenderParams p = params_of(32, 24, k & 1 ? 16 : 64);
        p.gaussian = k >> 1, p.seed = (uint32_t)k;
        RetexSet *set = render(text, &p);
        for (int y = 0; y < 24; y++)
            for (int x = 0; x < 32; x++) {
                const float *beauty = value(set, "beauty", x, y);
                expect(value(set, "albedo_mean", x, y), 1e-5, (double)beauty[0], (double)beauty[1], (double)beauty[2]);
            }
        retex_set_close(&set);
    }
}

/* The mean of n by n pixels of a picture that is n times finer, each at its centre. */
static double finer_mean(const RetexSet *fine, const char *name, int n, int x, int y, int c)
{
    double sum = 0;
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++)
            sum += (double)value(fine, name, x * n + i, y * n + j)[c];
    return sum / (n * n);
}

static void means_are_those_of_a_finer_picture(void **state)
{
    static const char *const text =
        V37 "camera{location <0,1,-4> look_at 0 right 4/3*x} light_source{<3,9,-9>,1}"
            "sphere{0,1 pigment{checker rgb <.1,.5,.9> rgb <.8,.6,.1> scale .2} normal{bumps .3 scale .1}}"
            "plane{y,-1.2 texture{checker texture{pigment{rgb .9}} texture{pigment{rgb <.1,.2,0>}} scale .3}}";
    enum { W = 24, H = 18, N = 16 };
    static const char *const names[2][2] = {{"albedo_mean", "albedo"}, {"normal_mean", "normal"}};
    RenderParams p = params_of(W, H, 256), fine = params_of(N * W, N * H, 1);
    fine.aovs = RETEX_AOV_BIT(ALBEDO) | RETEX_AOV_BIT(NORMAL);
    RetexSet *set = render(text, &p), *many = render(text, &fine);

    (void)state;
    for (int k = 0; k < 2; k++) {
        double squares = 0, most = 0;
        for (int i = 0; i < W * H * 3; i++) {
            const int x = i / 3 % W, y = i / 3 / W, c = i % 3;
            const double off = (double)value(set, names[k][0], x, y)[c] - finer_mean(many, names[k][1], N, x, y, c);
            squares += off * off / (W * H * 3), most = fmax(most, fabs(off));
        }
        print_message("# %s: off by %.5f rms, at most %.5f\n", names[k][0], sqrt(squares), most);
        assert_true(sqrt(squares) < 0.016 && most < 0.1); /* half of a pixel beside it: more than 0.1 rms */
    }
    retex_set_close(&set);
    retex_set_close(&many);
}

/* A crop has the pixels of the whole, for any number of threads; pictures of few samples have means of 16. */
static void crops_and_few_samples(void **state)
{
    enum { X = 3, Y = 2, W = 9, H = 5 };
    static const char *const text =
        V37 "camera{location -4*z right 4/3*x} sphere{0,1 pigment{checker rgb 1 rgb 0 scale .1}}";
    RenderParams p = params_of(16, 12, 1), crop = p, enough = params_of(16, 12, 16);
    crop.crop[0] = X, crop.crop[1] = Y, crop.crop[2] = W, crop.crop[3] = H, crop.nthreads = 1;
    RetexSet *whole = render(text, &p), *part = render(text, &crop), *full = render(text, &enough);

    (void)state;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++)
            for (int k = 0; k < 2; k++) {
                const char *name = k ? "normal_mean" : "albedo_mean";
                const float *wanted = value(whole, name, X + x, Y + y);
                assert_memory_equal(value(part, name, x, y), wanted, 3 * sizeof(float));
                assert_memory_equal(value(full, name, X + x, Y + y), wanted, 3 * sizeof(float));
            }
    retex_set_close(&whole);
    retex_set_close(&part);
    retex_set_close(&full);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_is_the_mean_of_its_sides),
        cmocka_unit_test(the_filter_is_the_pictures),
        cmocka_unit_test(samples_are_the_pictures),
        cmocka_unit_test(means_are_those_of_a_finer_picture),
        cmocka_unit_test(crops_and_few_samples),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
