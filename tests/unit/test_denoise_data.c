/* The denoising data of a render: noise is half of the difference between the two halves of the samples, and guides
 * are right for surfaces at known positions. */
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include <retex/denoise.h>

#include "film/film.h"
#include "film/footprints/footprints.h"
#include "film/paper/paper.h"
#include "render/render.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"
#include "set/signals.h"

static Scene *read_scene(const char *text, const char *declare, const char *const *targets, int ntargets)
{
    char path[] = "/tmp/retex-denoise-data-XXXXXX.pov";
    RetexError err = {0};
    SdlOptions options = SDL_OPTIONS_INIT;
    Scene *scene = NULL;
    int file = mkstemps(path, 4);
    assert_true(file >= 0 && write(file, text, strlen(text)) == (ssize_t)strlen(text) && !close(file));
    options.declares = &declare, options.ndeclares = declare != NULL;
    test_must(sdl_read(&scene, path, &options, &scene_builder, &err), &err);
    unlink(path);
    test_must(scene_resolve_targets(scene, targets, ntargets, &err), &err);
    return scene;
}

static RetexSet *render(const Scene *scene, const RenderParams *params)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    test_must(render_scene(&set, scene, params, NULL, &err), &err);
    return set;
}

static const float *pixel(const RetexSet *set, const char *name, int x, int y)
{
    int k = retex_set_find_part(set, name);
    if (k < 0)
        fail_msg("there is no part %s", name);
    return set->parts[k].image.pixels + retex_image_index(&set->parts[k].image, x, y);
}

static void expect(double value, double wanted, double tolerance, const char *what)
{
    if (!(fabs(value - wanted) <= tolerance))
        fail_msg("%s: %.8f, should be %.8f within %g", what, value, wanted, tolerance);
}

static void expect3(const RetexSet *set, const char *name, int x, int y, double a, double b, double c)
{
    const float *p = pixel(set, name, x, y);
    const double wanted[3] = {a, b, c};
    char what[128];
    snprintf(what, sizeof what, "%s at %d,%d", name, x, y);
    for (int k = 0; k < 3; k++)
        expect(p[k], wanted[k], 1e-5, what);
}

/* ---- noise ---- */

/* A glossy floor and a wall that light one another, a ball and a lamp: all signals, and further hits. */
static const char room[] = "global_settings { assumed_gamma 1 }\n"
                           "camera { location <0, 2, -6> look_at <0, 1, 0> }\n"
                           "#declare Floor = texture { pigment { checker rgb 0.8 rgb <0.7, 0.3, 0.2> }\n"
                           "  finish { diffuse 0.6 reflection { 0.2 } specular 0.3 roughness 0.05 } }\n"
                           "#declare Wall = texture { pigment { rgb <0.3, 0.6, 0.4> } finish { diffuse 0.8 } }\n"
                           "plane { y, 0 texture { Floor } }\n"
                           "plane { z, 4 texture { Wall } }\n"
                           "sphere { <0.5, 1, 0>, 1 pigment { rgb 0.9 } finish { diffuse 0.3 reflection { 0.5 } } }\n"
                           "box { <-1, 4, -1>, <1, 4.1, 1> pigment { rgb 1 } finish { emission 8 diffuse 0 } }\n"
                           "sky_sphere { pigment { rgb 0.1 } }\n";

static const char *const room_targets[] = {"Floor", "Wall"};

static RenderParams small(int spp)
{
    RenderParams p = RENDER_PARAMS_INIT;
    p.width = 40, p.height = 30, p.spp = spp, p.nthreads = 2, p.seed = 3, p.denoise_data = 1;
    return p;
}

/* The signal's picture in a set, in double; none: zero. */
static double total(const RetexSet *set, const RetexSignals *signals, const RetexSignal *like, size_t value)
{
    double sum = 0;
    for (int k = 0; k < signals->count; k++) {
        const RetexSignal *s = &signals->of[k];
        if (s->target != like->target || s->kind != like->kind)
            continue;
        for (int m = 0; m < s->nmembers; m++)
            sum += (double)s->members[m].weight * set->parts[s->members[m].part].image.pixels[value];
    }
    return sum;
}

/* The first samples of a render are those of a render of fewer: so its halves are known. Coefficients of layout
 * footprints are rounded, by no more than a small share of the pixel with white targets. */
static void compare_halves(const RetexSet *all, const RetexSet *half, double tolerance)
{
    RetexSignals signals, halves;
    RetexError err = {0};
    double scale = 0, squares = 0;
    int first = all->spp / 2, rest = all->spp - first;
    test_must(retex_signals_open(&signals, all, &err), &err);
    test_must(retex_signals_open(&halves, half, &err), &err);
    for (int k = 0; k < signals.count; k++) {
        const RetexImage *noise = &all->parts[signals.of[k].noise].image;
        for (size_t i = 0; i < (size_t)all->width * (size_t)all->height * 3; i++) {
            double m = total(all, &signals, &signals.of[k], i), m1 = total(half, &halves, &signals.of[k], i),
                   m2 = (all->spp * m - first * m1) / rest;
            expect(noise->pixels[i], (m1 - m2) / 2, tolerance * (1 + fabs(m)), all->parts[signals.of[k].noise].name);
            squares += (double)noise->pixels[i] * noise->pixels[i];
            scale += m * m;
        }
    }
    assert_true(squares > 1e-4 * scale && squares < scale);
    retex_signals_close(&signals);
    retex_signals_close(&halves);
}

static void noise_is_half_the_difference_of_halves(void **state)
{
    (void)state;
    for (int ntargets = 0; ntargets <= 2; ntargets++)
        for (int paper = 0; paper < 2; paper++)
            for (int spp = 16; spp <= 17; spp++) {
                Scene *scene = read_scene(room, NULL, room_targets, ntargets);
                RenderParams p = small(spp), h = small(spp / 2);
                p.paper = h.paper = paper;
                RetexSet *all = render(scene, &p), *half = render(scene, &h);
                assert_true(retex_denoise_has_data(all) && retex_denoise_has_data(half));
                compare_halves(all, half, ntargets && !paper ? 1e-3 : 1e-5);
                retex_set_close(&all);
                retex_set_close(&half);
                scene_close(&scene);
            }
}

/* The product of the brightness of all hits of a term but the first. */
static double expected_weight(const RetexSet *set, const RetexTerm *term, const double *brightness)
{
    double weight = 1;
    for (int k = 1; k < term->nfactors; k++) {
        int target;
        RetexFootprintKind kind;
        if (!retex_factor_is_hit(term->factors[k]))
            continue;
        retex_factor_target(set, term->factors[k], &target, &kind);
        weight *= brightness[target];
        if (term->factors[k].kind == RETEX_FACTOR_MIXTURE) /* of both targets, or of one */
            for (int i = 0; i < set->mixtures[term->factors[k].index].nshares; i++)
                if (set->footprints[set->mixtures[term->factors[k].index].shares[i].footprint].target != target)
                    weight *= fmax(1, brightness[1 - target] / brightness[target]), i = 1 << 20;
    }
    return weight;
}

/* Noise is that of sums in which further hits weigh as their targets are bright in the scene, in the mean, but at least
 * 1/2. Terms tell these weights, where the set has noise. */
static void further_hits_weigh_as_targets_are_bright(void **state)
{
    (void)state;
    static const struct {
        const char *floor, *wall;
        double brightness[2];
    } cases[] = {
        {"checker rgb 1 rgb 0.7 scale 30", "rgb 0.8", {0.85, 0.8}},
        {"rgbf <1, 0.5, 0.25, 0.5>", "rgb 3", {0.2126 + 0.7152 / 2 + 0.0722 / 4, 1}},
        {"image_map { ppm \"IMAGE\" gamma 1 interpolate 2 }", "checker rgb 0.9 rgb 0.9", {(1 + 127.0 / 255) / 2, 0.9}}};
    char image[] = "/tmp/retex-denoise-image-XXXXXX.ppm";
    const int file = mkstemps(image, 4);
    assert_true(file >= 0 && dprintf(file, "P3 2 1 2 1 1 1 2 2 2\n") > 0 && !close(file));
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        for (int paper = 0; paper < 2; paper++) {
            char text[2048], *at;
            snprintf(text, sizeof text,
                     "global_settings { assumed_gamma 1 } camera { location <0, 2, -6> look_at <0, 1, 0> }\n"
                     "#declare Floor = texture { pigment { %s } finish { diffuse 0.8 } }\n"
                     "#declare Wall = texture { pigment { %s } finish { diffuse 0.8 } }\n"
                     "plane { y, 0 texture { Floor } } plane { z, 4 texture { Wall } }\n"
                     "sphere { <0, 4, 0>, 1 pigment { rgb 1 } finish { emission 8 } }\n",
                     cases[k].floor, cases[k].wall);
            if ((at = strstr(text, "IMAGE"))) {
                char rest[2048];
                snprintf(rest, sizeof rest, "%s", at + 5);
                snprintf(at, sizeof text - (size_t)(at - text), "%s%s", image, rest);
            }
            Scene *scene = read_scene(text, NULL, room_targets, 2);
            RenderParams p = small(16), h = small(8);
            int further = 0;
            p.paper = h.paper = paper;
            RetexSet *all = render(scene, &p), *half = render(scene, &h);
            compare_halves(all, half, paper ? 1e-5 : 1e-3);
            for (int t = 0; t < all->nterms; t++) {
                const RetexTerm *term = &all->terms[t];
                if (retex_term_hits(term) < 2 || term->role == RETEX_ROLE_CORRECTION) {
                    assert_true(term->noise_weight == 0);
                    continue;
                }
                expect((double)term->noise_weight, expected_weight(all, term, cases[k].brightness), 1e-5, "weight");
                further++;
            }
            assert_true(further > 6);
            p.denoise_data = 0;
            RetexSet *without = render(scene, &p);
            for (int t = 0; t < without->nterms; t++)
                assert_true(without->terms[t].noise_weight == 0);
            retex_set_close(&all);
            retex_set_close(&half);
            retex_set_close(&without);
            scene_close(&scene);
        }
    unlink(image);
}

/* Light through several panes of glass that is a target: squared noise as stored, and as it is among seeds. Both halves
 * of a pixel's samples together are spread more evenly than each, so that there is somewhat less among seeds. */
static void further_light_has_the_noise_that_is_stored(void **state)
{
    (void)state;
    static const char glass[] =
        "global_settings { assumed_gamma 1 } camera { location <0, 0, -6> look_at 0 }\n"
        "#declare Glass = texture { pigment { rgbf <1, 1, 1, 1> } finish { diffuse 0\n"
        "  reflection { 0.05 } } }\n"
        "#declare Slab = box { <-4, -3, 0>, <4, 3, 0.2> texture { Glass } interior { ior 1.1 } }\n"
        "object { Slab } object { Slab translate z } object { Slab translate 2 * z }\n"
        "plane { z, 4 pigment { rgb 0.8 } finish { diffuse 1 } }\n"
        "sphere { <2, 3, 3>, 0.3 pigment { rgb 1 } finish { emission 40 } }\n";
    enum { SEEDS = 12, VALUES = 16 * 12 * 3 };
    static const char *const targets[] = {"Glass"};
    static double sum[VALUES], squares[VALUES];
    Scene *scene = read_scene(glass, NULL, targets, 1);
    double stored = 0, real = 0;
    for (int k = 0; k < SEEDS; k++) {
        RetexSignals signals;
        RetexError err = {0};
        RenderParams p = small(16);
        p.width = 16, p.height = 12, p.seed = (uint32_t)k + 1;
        RetexSet *set = render(scene, &p);
        test_must(retex_signals_open(&signals, set, &err), &err);
        for (int s = 0; s < signals.count; s++)
            for (int i = 0; i < VALUES && signals.of[s].target == 0 && signals.of[s].kind == RETEX_FOOTPRINT_SHARP;
                 i++) {
                double light = 0;
                for (int m = 0; m < signals.of[s].nmembers; m++) {
                    assert_float_equal(signals.of[s].members[m].bright, 1, 1e-6);
                    light += (double)set->parts[signals.of[s].members[m].part].image.pixels[i];
                }
                sum[i] += light, squares[i] += light * light;
                stored += pow((double)set->parts[signals.of[s].noise].image.pixels[i], 2) / SEEDS;
            }
        retex_signals_close(&signals);
        retex_set_close(&set);
    }
    for (int i = 0; i < VALUES; i++)
        real += (squares[i] - sum[i] * sum[i] / SEEDS) / (SEEDS - 1);
    printf("# squared noise: %.3g stored, %.3g among seeds\n", stored, real);
    assert_true(real > 0 && stored > 0.8 * real && stored < 2 * real);
    scene_close(&scene);
}

static int count_data(const RetexSet *set)
{
    int count = 0;
    for (int k = 0; k < set->nparts; k++)
        count += !strncmp(set->parts[k].name, "noise_", 6) || !strncmp(set->parts[k].name, "guide_", 6);
    return count;
}

static void parts_are_those_of_the_terms(void **state)
{
    (void)state;
    static const char *const footprints[] = {"noise_indep", "noise_Floor_sharp", "noise_Floor_broad",
                                             "noise_Wall_sharp", "noise_Wall_broad"},
                             *const paper[] = {"noise_indep", "noise_Floor_hit", "noise_Wall_hit"};
    for (int layout = 0; layout < 2; layout++) {
        Scene *scene = read_scene(room, NULL, room_targets, 2);
        RenderParams p = small(4);
        p.paper = layout;
        RetexSet *set = render(scene, &p);
        int count = layout ? 3 : 5;
        for (int k = 0; k < count; k++) {
            int found = retex_set_find_part(set, layout ? paper[k] : footprints[k]);
            assert_true(found > 0);
            assert_int_equal(set->parts[found].type, RETEX_HALF);
        }
        assert_int_equal(count_data(set), count + 7 + 2);
        assert_int_equal(set->parts[retex_set_find_part(set, "guide_position")].type, RETEX_FLOAT);
        assert_int_equal(set->parts[retex_set_find_part(set, "guide_cover_Wall")].type, RETEX_HALF);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

/* Light without noise is a signal too, and a target that nothing shows is none. */
static void signals_without_noise_have_their_part(void **state)
{
    (void)state;
    static const char text[] = "camera { location <0, 0, -5> look_at 0 }\n"
                               "#declare Wall = pigment { rgb 1 }\n"
                               "sphere { <0, 0, -9>, 1 pigment { Wall } }\n"
                               "background { rgb 1 }\n";
    static const char *const targets[] = {"Wall"};
    for (int paper = 0; paper < 2; paper++) {
        Scene *scene = read_scene(text, NULL, targets, 1);
        RenderParams p = small(4);
        p.paper = paper;
        RetexSet *set = render(scene, &p);
        assert_true(retex_denoise_has_data(set));
        assert_true((retex_set_find_part(set, "noise_Wall_hit") >= 0) == paper); /* it has all its terms always */
        assert_true(retex_set_find_part(set, "noise_Wall_sharp") < 0);
        for (int c = 0; c < 3; c++)
            assert_true(pixel(set, "noise_indep", 20, 15)[c] == 0);
        retex_set_close(&set);
        scene_close(&scene);
    }
}

static void one_sample_tells_nothing(void **state)
{
    (void)state;
    Scene *scene = read_scene(room, NULL, room_targets, 2);
    RenderParams p = small(1);
    RetexSet *set = render(scene, &p);
    assert_int_equal(count_data(set), 0);
    retex_set_close(&set);
    scene_close(&scene);
}

/* Three numbers a pixel for each signal. */
static void the_film_counts_its_noise(void **state)
{
    (void)state;
    static const struct {
        int split, paper, spp, ntargets, signals;
    } cases[] = {{0, 0, 2, 0, 1}, {1, 0, 2, 1, 3}, {1, 0, 2, 2, 5}, {1, 1, 2, 2, 3}, {1, 0, 1, 2, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        FilmParams with = {.split = cases[k].split,
                           .layout = cases[k].paper ? &paper_layout : &footprints_layout,
                           .spp = cases[k].spp,
                           .orders = 6};
        FilmParams without = with;
        with.noise = 1;
        assert_int_equal(film_floats(&with, cases[k].ntargets) - film_floats(&without, cases[k].ntargets),
                         3 * cases[k].signals);
    }
}

static void expect_same(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nparts, b->nparts);
    assert_int_equal(a->nterms, b->nterms);
    assert_int_equal(a->nfootprints, b->nfootprints);
    assert_memory_equal(a->terms, b->terms, sizeof *a->terms * (size_t)a->nterms);
    for (int k = 0; k < a->nparts; k++) {
        const RetexImage *x = &a->parts[k].image, *y = &b->parts[k].image;
        assert_string_equal(a->parts[k].name, b->parts[k].name);
        assert_int_equal(a->parts[k].type, b->parts[k].type);
        assert_true(x->width == y->width && x->height == y->height && x->channels == y->channels);
        if (memcmp(x->pixels, y->pixels, sizeof(float) * (size_t)x->width * (size_t)x->height * (size_t)x->channels))
            fail_msg("%s is not the same", a->parts[k].name);
    }
}

/* Without the data, and with it dropped, a set is what it always was; an irradiance pass is not in the way. */
static void the_rest_of_the_set_is_the_same(void **state)
{
    (void)state;
    for (int paper = 0; paper < 2; paper++) {
        Scene *scene = read_scene(room, NULL, room_targets, 2);
        RenderParams p = small(6);
        p.paper = paper, p.aovs = RETEX_AOV_ALL, p.control_data = paper;
        RetexSet *with = render(scene, &p);
        p.denoise_data = 0;
        RetexSet *without = render(scene, &p);
        assert_int_equal(count_data(without), 0);
        assert_false(retex_denoise_has_data(without));
        assert_true(count_data(with) > 9);
        retex_denoise_drop_data(with);
        expect_same(with, without);
        retex_set_close(&with);
        retex_set_close(&without);
        scene_close(&scene);
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    static const int threads[] = {2, 7};
    for (int ntargets = 0; ntargets <= 2; ntargets += 2)
        for (int paper = 0; paper < 2; paper++)
            for (int k = 0; k < 2; k++) {
                Scene *scene = read_scene(room, NULL, room_targets, ntargets);
                RenderParams p = small(5);
                p.paper = paper, p.width = 70, p.height = 50, p.nthreads = 1;
                RetexSet *one = render(scene, &p);
                p.nthreads = threads[k];
                RetexSet *more = render(scene, &p);
                expect_same(one, more);
                retex_set_close(&one);
                retex_set_close(&more);
                scene_close(&scene);
            }
}

/* ---- guides ---- */

/* Looking along z at 4 x 3 units, a pixel is 1/8 wide. Behind: a wall at z = 5, up to y = 1.2; before it a mirror at
 * the left, which shows a plane behind the camera, and a pane of glass at the right; between them a ball of radius 0.7,
 * a lamp, a clear sheet that bends nothing, rough metal. */
static const char bench[] =
    "global_settings { assumed_gamma 1 }\n"
    "camera { orthographic location <0, 0, -10> direction z right 4 * x up 3 * y }\n"
    "#declare Wall = texture { pigment { rgb <0.1, 0.2, 0.3> } finish { diffuse 0.8 } }\n"
    "#declare Back = texture { pigment { rgb <0.2, 0.4, 0.6> } finish { diffuse 0.8 } }\n"
    "box { <-3, -3, 5>, <3, 1.2, 6> texture { Wall } }\n"
    "#if (BACK) plane { -z, 20 texture { Back } } #end\n"
    "box { <-2, -1, 0>, <-1, 1, 0.1> pigment { rgb 0.7 } finish { diffuse 0.1 reflection { 0.5 } } }\n"
    "box { <1, -1, 0>, <2, 1, 0.5> pigment { rgbt 1 } interior { ior 1.5 }\n"
    "  finish { diffuse 0 reflection { 0, 1 fresnel on } conserve_energy } }\n"
    "sphere { 0, 0.7 pigment { rgb <0.8, 0.1, 0.1> } finish { diffuse 0.6 specular 0.5 } }\n"
    "box { <-0.25, -1.25, -1>, <0.25, -1, -0.9> pigment { rgb <1, 0, 0> } finish { emission 5 diffuse 0 } }\n"
    "box { <-1, 0.75, 0>, <-0.75, 1, 0.2> pigment { rgbf <1, 1, 1, 0.7> } finish { diffuse 0.6 } }\n"
    "box { <0.75, 0.75, 0>, <1, 1, 0.2> pigment { rgb <1, 0.8, 0.4> }\n"
    "  finish { retex { metallic 1 roughness 0.25 } } }\n"
    "background { rgb 1 }\n";

enum { WIDTH = 32, HEIGHT = 24 };

static RetexSet *render_samples(Scene **scene, const char *back, int ntargets, int plain, int spp)
{
    static const char *const targets[] = {"Wall", "Back"};
    RenderParams p = RENDER_PARAMS_INIT;
    *scene = read_scene(bench, back, targets, ntargets);
    p.width = WIDTH, p.height = HEIGHT, p.spp = spp, p.nthreads = 2, p.denoise_data = 1, p.plain = plain;
    return render(*scene, &p);
}

static RetexSet *render_bench(Scene **scene, const char *back, int ntargets, int plain)
{
    return render_samples(scene, back, ntargets, plain, 2);
}

static double x_of(int x)
{
    return -2 + 0.125 * (x + 0.5);
}

static double y_of(int y)
{
    return 1.5 - 0.125 * (y + 0.5);
}

/* The mean of places that lie about the pixel's centre by samples' own spread. */
static void expect_place(const RetexSet *set, const char *name, int x, int y, double z)
{
    const float *p = pixel(set, name, x, y);
    expect(p[0], x_of(x), 0.125 / 32, name);
    expect(p[1], y_of(y), 0.125 / 32, name);
    expect(p[2], z, 1e-4, name);
}

/* First hit and what is seen, by kind of surface: a column and row whose pixel lies wholly on one. */
static void guides_tell_what_lies_where(void **state)
{
    (void)state;
    static const struct {
        const char *what;
        int x, y;
        double first_z, specular, seen_z, normal_z, albedo[3], material[3], wall, back;
    } cases[] = {
        {"wall", 9, 18, 5, 0, 5, -1, {1, 1, 1}, {1, 0, 0}, 1, 0},
        {"mirror", 2, 12, 0, 1, -20, 1, {1, 1, 1}, {1, 0, 0}, 0, 0.5},
        {"glass", 28, 12, 0, 1, 5, -1, {1, 1, 1}, {1, 0, 0}, 0.96 * 0.96, 0},
        {"lamp", 15, 21, -1, 0, -1, -1, {1, 1, 1}, {1, 0, 0}, 0, 0},
        {"sheet", 9, 5, 0, 1, 5, -1, {1, 1, 1}, {1, 0, 0}, 0.7 * 0.7, 0},
        {"metal", 22, 5, 0, 0, 0, -1, {1, 0.8, 0.4}, {0.25, 1, 0}, 0, 0},
    };
    Scene *scene;
    RetexSet *set = render_bench(&scene, "BACK=1", 2, 0);
    assert_true(retex_denoise_has_data(set));
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        int x = cases[k].x, y = cases[k].y;
        expect3(set, "guide_normal", x, y, 0, 0, -1);
        expect_place(set, "guide_position", x, y, cases[k].first_z);
        expect(pixel(set, "guide_specular", x, y)[0], cases[k].specular, 0, cases[k].what);
        expect3(set, "guide_seen_normal", x, y, 0, 0, cases[k].normal_z);
        expect_place(set, "guide_seen_position", x, y, cases[k].seen_z);
        const double *a = cases[k].albedo, *m = cases[k].material;
        expect3(set, "guide_seen_albedo", x, y, a[0], a[1], a[2]);
        expect3(set, "guide_seen_material", x, y, m[0], m[1], m[2]);
        expect(pixel(set, "guide_cover_Wall", x, y)[0], cases[k].wall, 1e-5, cases[k].what);
        expect(pixel(set, "guide_cover_Back", x, y)[0], cases[k].back, 1e-5, cases[k].what);
    }
    retex_set_close(&set);
    scene_close(&scene);
}

/* Half of a pixel beyond the wall's edge, a pixel in the sky, and a mirror that shows the sky. */
static void guides_of_the_sky(void **state)
{
    (void)state;
    Scene *scene;
    RetexSet *set = render_bench(&scene, "BACK=0", 1, 0);
    for (int k = 0; k < 2; k++) { /* sky, mirror */
        int x = k ? 2 : 15, y = k ? 12 : 0;
        expect3(set, "guide_normal", x, y, 0, 0, -k);
        expect(pixel(set, "guide_specular", x, y)[0], k, 0, "sky");
        if (!k)
            expect3(set, "guide_position", x, y, 0, 0, 0);
        expect3(set, "guide_seen_normal", x, y, 0, 0, 0);
        expect3(set, "guide_seen_position", x, y, 0, 0, 0);
        expect3(set, "guide_seen_albedo", x, y, 1, 1, 1);
        expect3(set, "guide_seen_material", x, y, 0, 0, 1);
        expect(pixel(set, "guide_cover_Wall", x, y)[0], 0, 0, "sky");
    }
    /* the third row begins at y = 1.25: 0.4 of it lies above the wall */
    expect(pixel(set, "guide_seen_material", 15, 2)[2], 0.4, 1.0 / 16, "share that hits nothing");
    expect(pixel(set, "guide_cover_Wall", 15, 2)[0], 0.6, 1.0 / 16, "share of the wall");
    expect(pixel(set, "guide_position", 15, 2)[2], 5, 1e-5, "position over those that hit");
    expect3(set, "guide_normal", 15, 2, 0, 0, -1);
    expect(pixel(set, "guide_seen_material", 15, 2)[0], 1, 1e-5, "roughness over those that hit");
    retex_set_close(&set);
    scene_close(&scene);
}

/* Share of a pixel outside of the ball. */
static double beside_ball(int x, int y)
{
    enum { STEPS = 64 };
    int outside = 0;
    for (int j = 0; j < STEPS; j++)
        for (int i = 0; i < STEPS; i++) {
            double u = -2 + 0.125 * (x + (i + 0.5) / STEPS), v = 1.5 - 0.125 * (y + (j + 0.5) / STEPS);
            outside += u * u + v * v > 0.7 * 0.7;
        }
    return (double)outside / (STEPS * STEPS);
}

/* A target that is seen again in a mirror of its own covers a pixel once. */
static void covers_count_a_target_once(void **state)
{
    static const char *const targets[] = {"Floor", "Mirror"};
    (void)state;
    Scene *scene = read_scene("camera { location 0 look_at z } #declare Floor = texture { pigment { rgb 1 } }\n"
                              "#declare Mirror = texture { pigment { rgb 0 } finish { diffuse 0 reflection { 1 } } }\n"
                              "plane { z, 3 texture { Mirror } } plane { z, -2 texture { Mirror } }\n"
                              "plane { y, -1e6 texture { Floor } }\n",
                              NULL, targets, 2);
    RenderParams p = small(4);
    RetexSet *set = render(scene, &p);
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 40; x++) {
            expect(pixel(set, "guide_cover_Mirror", x, y)[0], 1, 1e-3, "a mirror in itself");
            expect(pixel(set, "guide_specular", x, y)[0], 1, 0, "mirror");
        }
    retex_set_close(&set);
    scene_close(&scene);
}

static void cover_is_the_share_of_the_pixel(void **state)
{
    (void)state;
    Scene *scene;
    RetexSet *set = render_bench(&scene, "BACK=1", 1, 0);
    int partial = 0;
    double area = 0;
    for (int y = 6; y < 18; y++)
        for (int x = 10; x < 22; x++) {
            double cover = pixel(set, "guide_cover_Wall", x, y)[0];
            expect(cover, beside_ball(x, y), 0.12, "cover");
            area += (1 - cover) / 64;
            partial += cover > 0 && cover < 1;
            if (cover == 0)
                expect3(set, "guide_seen_albedo", x, y, 0.8, 0.1, 0.1);
        }
    expect(area, 3.14159265 * 0.7 * 0.7, 0.01, "area of the ball");
    assert_true(partial > 20);
    retex_set_close(&set);
    scene_close(&scene);
}

/* Without targets, the colours are those that are shown; nothing has a cover. */
static void plain_guides_show_all_colors(void **state)
{
    (void)state;
    Scene *scene;
    RetexSet *set = render_bench(&scene, "BACK=1", 2, 1);
    assert_true(retex_denoise_has_data(set));
    assert_int_equal(count_data(set), 1 + 7);
    expect3(set, "guide_seen_albedo", 9, 18, 0.1, 0.2, 0.3);
    expect3(set, "guide_seen_albedo", 2, 12, 0.2, 0.4, 0.6);
    retex_set_close(&set);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexError err = {0};
    RetexTexture *texture = NULL;
    RetexTextureSpec spec = {0};
    test_must(test_texture_spec(&spec, NULL, "Wall=rgb(0.5,0.25,1)", &err), &err);
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    RenderVariant variant = {.textures = {texture}};
    p.width = WIDTH, p.height = HEIGHT, p.spp = 2, p.denoise_data = 1, p.plain = 1;
    p.variants = &variant, p.nvariants = 1;
    set = render(scene, &p);
    expect3(set, "guide_seen_albedo", 9, 18, 0.5, 0.25, 1);
    expect3(set, "guide_seen_albedo", 28, 12, 0.5, 0.25, 1);
    retex_set_close(&set);
    retex_texture_close(&texture);
    scene_close(&scene);
}

/* Whether paths look, or nothing but the guides, the places are the same. */
static void more_samples_change_no_guide(void **state)
{
    (void)state;
    Scene *scene;
    RetexSet *few = render_bench(&scene, "BACK=1", 2, 0);
    scene_close(&scene);
    RetexSet *many = render_samples(&scene, "BACK=1", 2, 0, 80);
    int count = 0;
    for (int k = 0; k < few->nparts; k++) {
        const RetexImage *image = &few->parts[k].image;
        if (strncmp(few->parts[k].name, "guide_", 6))
            continue;
        count++;
        assert_memory_equal(image->pixels, pixel(many, few->parts[k].name, 0, 0),
                            (size_t)WIDTH * HEIGHT * (size_t)image->channels * sizeof(float));
    }
    assert_int_equal(count, 7 + 2);
    retex_set_close(&few);
    retex_set_close(&many);
    scene_close(&scene);
}

/* A part of the picture has the guides that the whole has there. */
static void a_crop_has_the_guides_of_the_whole(void **state)
{
    (void)state;
    Scene *scene;
    RetexSet *whole = render_bench(&scene, "BACK=1", 2, 0);
    RenderParams p = RENDER_PARAMS_INIT;
    p.width = WIDTH, p.height = HEIGHT, p.spp = 2, p.denoise_data = 1;
    memcpy(p.crop, (int[4]){5, 3, 10, 9}, sizeof p.crop);
    RetexSet *part = render(scene, &p);
    for (int y = 0; y < 9; y++)
        for (int x = 0; x < 10; x++) {
            const float *wanted = pixel(whole, "guide_seen_position", 5 + x, 3 + y);
            expect3(part, "guide_seen_position", x, y, wanted[0], wanted[1], wanted[2]);
            expect(pixel(part, "guide_cover_Wall", x, y)[0], pixel(whole, "guide_cover_Wall", 5 + x, 3 + y)[0], 0,
                   "cover");
        }
    retex_set_close(&whole);
    retex_set_close(&part);
    scene_close(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_half_the_difference_of_halves),
        cmocka_unit_test(further_hits_weigh_as_targets_are_bright),
        cmocka_unit_test(further_light_has_the_noise_that_is_stored),
        cmocka_unit_test(parts_are_those_of_the_terms),
        cmocka_unit_test(signals_without_noise_have_their_part),
        cmocka_unit_test(one_sample_tells_nothing),
        cmocka_unit_test(the_film_counts_its_noise),
        cmocka_unit_test(the_rest_of_the_set_is_the_same),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(guides_tell_what_lies_where),
        cmocka_unit_test(guides_of_the_sky),
        cmocka_unit_test(covers_count_a_target_once),
        cmocka_unit_test(cover_is_the_share_of_the_pixel),
        cmocka_unit_test(plain_guides_show_all_colors),
        cmocka_unit_test(more_samples_change_no_guide),
        cmocka_unit_test(a_crop_has_the_guides_of_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
