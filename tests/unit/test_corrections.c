/* Corrections, through the film of both layouts: with one target edited, the others kept, a set gives the sum over its
 * paths of their light times the product of what each hit does. */
#include "film/footprints/footprints.h"
#include "film/paper/paper.h"
#include "lib_film.h"
#include "lib_folder.h"
#include "set/parts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include <retex/host/denoise_data.h>
#include <retex/set_file.h>

#define PATHS 40
#define HITS 6
#define SPP (1 << 18) /* steps of corrections are as small as those of coefficients */
#define PICTURES 16   /* by which targets are edited: bits */

static const Rgb COLOR = {0.9f, 0.4f, 0.05f}; /* of edited targets */
#define MOST_EACH 3 /* hits of one target on a path: corrections tell no more apart */

/* 1: sharp hits lie in the left half of a texture of two colours, COLOR and this one; all others in the right half. */
static int by_place;
static const Rgb OTHER = {0.1f, 0.7f, 0.95f};

/* The left pixel, by brute force. */
typedef struct Truth {
    double sum[PICTURES][3];
    Rgb value[PICTURES]; /* of the current path */
} Truth;

static Rgb random_rgb(uint32_t *seed, double low)
{
    return (Rgb){(float)(low + (1 - low) * test_random(seed)), (float)(low + (1 - low) * test_random(seed)),
                 (float)(low + (1 - low) * test_random(seed))};
}

static void add_hit(Fixture *f, Truth *truth, int target, int first, uint32_t *seed)
{
    const int both = test_random(seed) < 0.5;
    const Split split = {random_rgb(seed, 0.2), both ? random_rgb(seed, 0) : rgb_grey(0)};
    const Rgb albedo = random_rgb(seed, 0);
    int sharp = 0;
    if (by_place) {
        sharp = first && test_random(seed) < 0.5;
        split_hit(f, target, (sharp ? 0.25 : 0.75) + 0.02 * test_random(seed), 0.5, albedo, sharp, split);
    } else {
        split_hit(f, target, test_random(seed), test_random(seed), albedo, first && test_random(seed) < 0.5, split);
    }
    const Rgb edited = by_place && !sharp ? OTHER : COLOR;
    for (int e = 0; e < PICTURES; e++)
        truth->value[e] = rgb_mul(truth->value[e], split_apply(split, e >> target & 1 ? edited : albedo));
}

static void add_light(Fixture *f, Truth *truth, uint32_t *seed)
{
    const Rgb light = rgb_scale(random_rgb(seed, 0.5), (float)SPP / PATHS);
    connect_light(f, light);
    for (int e = 0; e < PICTURES; e++) {
        const Rgb more = rgb_mul(light, truth->value[e]);
        truth->sum[e][0] += (double)more.r / SPP, truth->sum[e][1] += (double)more.g / SPP;
        truth->sum[e][2] += (double)more.b / SPP;
    }
}

static void add_path(Fixture *f, Truth *truth, uint32_t *seed)
{
    int of[RETEX_MAX_TARGETS] = {0};
    const int nhits = (int)(test_random(seed) * (HITS + 1));
    begin_path(f);
    for (int e = 0; e < PICTURES; e++)
        truth->value[e] = rgb_grey(1);
    for (int k = 0; k < nhits; k++) {
        const int target = (int)(test_random(seed) * f->scene.ntargets);
        if (of[target]++ == MOST_EACH)
            break;
        add_hit(f, truth, target, k == 0, seed);
        if (test_random(seed) < 0.5)
            add_light(f, truth, seed);
    }
    add_light(f, truth, seed);
    end_path(f);
}

static void make(Fixture *f, Truth *truth, const FilmLayout *layout, int ntargets, uint32_t seed)
{
    begin_film(f, ntargets, SPP, 6, 2, 2);
    f->params.extra = seed % 2 ? 8 : 0;
    f->params.layout = layout;
    create_film(f);
    memset(truth, 0, sizeof *truth);
    for (int k = 0; k < PATHS; k++)
        add_path(f, truth, &seed);
    finish_film(f);
}

/* The picture with some targets in a colour, by retex_combine. */
static void combine(RetexImage *picture, const RetexSet *set, int edited)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count = 0;
    for (int t = 0; t < set->ntargets; t++) {
        if (!(edited >> t & 1))
            continue;
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        snprintf(spec.target, sizeof spec.target, "%s", set->targets[t].name);
        spec.constant = 1, spec.color[0] = COLOR.r, spec.color[1] = COLOR.g, spec.color[2] = COLOR.b;
        spec.constant = !by_place;
        snprintf(spec.image, sizeof spec.image, "%s", test_in_folder("halves.exr"));
        specs[count++] = spec;
    }
    test_combine(picture, set, specs, count, NULL);
}

static double largest_error(const Fixture *f, const Truth *truth, int edited)
{
    RetexImage picture = {0};
    double error = 0;
    combine(&picture, f->set, edited);
    for (size_t c = 0; c < 3; c++)
        error = fmax(error, fabs(picture.pixels[c] - truth->sum[edited][c]));
    retex_image_free(&picture);
    return error;
}

/* -1: the term is no correction. */
static int corrected_target(const RetexTerm *term)
{
    return term->role == RETEX_ROLE_CORRECTION ? term->target : -1;
}

static void remove_corrections(RetexSet *set)
{
    int count = 0;
    for (int t = 0; t < set->nterms; t++)
        if (retex_term_is_light(&set->terms[t]))
            set->terms[count++] = set->terms[t];
    set->nterms = count;
}

/* What rounding may do: coefficients and corrections are off by up to half a step of the pixel's white, each its own
 * way. */
static double bound(const Fixture *f)
{
    double most = 0;
    for (size_t c = 0; c < 3; c++) {
        double white = 0;
        for (int t = 0; t < f->set->nterms; t++)
            white += !retex_term_is_light(&f->set->terms[t])
                         ? 0
                         : (double)f->set->parts[f->set->terms[t].radiance].image.pixels[c];
        most = fmax(most, white);
    }
    return most * sqrt(f->set->nterms) / 3 / 8192;
}

static void check_layout(const FilmLayout *layout)
{
    for (uint32_t seed = 1; seed <= 6; seed++) {
        const int ntargets = seed % 2 ? 2 : 3;
        Fixture f;
        Truth truth;
        make(&f, &truth, layout, ntargets, seed);
        const double most = bound(&f);
        double with = 0, without = 0;
        for (int t = 0; t < ntargets; t++)
            with = fmax(with, largest_error(&f, &truth, 1 << t));
        assert_true(largest_error(&f, &truth, 0) < most);
        remove_corrections(f.set);
        for (int t = 0; t < ntargets; t++)
            without = fmax(without, largest_error(&f, &truth, 1 << t));
        printf("# seed %u: error %g, at most %g, without corrections %g\n", seed, with, most, without);
        assert_true(with < most);
        assert_true(without > 2 * most);
        end_film(&f);
    }
}

/* Corrections belong to the kind of footprint that light met first: with a texture that gives sharp ones another colour
 * than all others. */
static void corrections_know_their_kind(void **state)
{
    RetexImage halves = {0};
    RetexError err = {0};
    (void)state;
    test_must(retex_image_alloc(&halves, 64, 4, 3, &err), &err);
    for (int i = 0; i < 64 * 4; i++)
        memcpy(halves.pixels + 3 * i, i % 64 < 32 ? &COLOR : &OTHER, 3 * sizeof(float));
    test_must(retex_image_write(&halves, test_in_folder("halves.exr"), NULL, 1, &err), &err);
    retex_image_free(&halves);
    by_place = 1;
    for (uint32_t seed = 1; seed <= 6; seed++) {
        const int ntargets = seed % 2 ? 2 : 3;
        Fixture f;
        Truth truth;
        make(&f, &truth, &footprints_layout, ntargets, seed);
        for (int t = 0; t < ntargets; t++) {
            const double error = largest_error(&f, &truth, 1 << t);
            printf("# seed %u, target %d: error %g, at most %g\n", seed, t, error, 2 * bound(&f));
            assert_true(error < 2 * bound(&f)); /* colours are halves here */
        }
        end_film(&f);
    }
    by_place = 0;
}

static void footprints_are_exact(void **state)
{
    (void)state;
    check_layout(&footprints_layout);
}

static void paper_is_exact(void **state)
{
    (void)state;
    check_layout(&paper_layout);
}

/* Make the corrections terms like all others, with a part of their light. */
static void weigh_corrections(RetexSet *set, float weight)
{
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        if (term->role != RETEX_ROLE_CORRECTION)
            continue;
        for (size_t i = 0; i < 3; i++)
            set->parts[term->radiance].image.pixels[i] *= weight;
        term->role = RETEX_ROLE_INDEP;
        term->nfactors--; /* their weight */
    }
}

/* Between one edited target and all, corrections count in part. */
static void several_edited_targets_interpolate(void **state)
{
    (void)state;
    RetexImage picture = {0}, expected = {0};
    Fixture f;
    Truth truth;
    make(&f, &truth, &footprints_layout, 3, 2);
    assert_true(retex_correction_weight(3, 0) == 0 && retex_correction_weight(3, 1) == 1);
    assert_true(retex_correction_weight(3, 2) == 0.25 && retex_correction_weight(3, 3) == 0);
    assert_true(retex_correction_weight(2, 2) == 0 && retex_correction_weight(1, 1) == 1);
    combine(&picture, f.set, 5);
    int count = 0; /* those of the target that is kept do not count */
    for (int t = 0; t < f.set->nterms; t++)
        if (corrected_target(&f.set->terms[t]) != 1)
            f.set->terms[count++] = f.set->terms[t];
    f.set->nterms = count;
    weigh_corrections(f.set, 0.25f);
    combine(&expected, f.set, 5);
    for (size_t c = 0; c < 3; c++)
        assert_float_equal(picture.pixels[c], expected.pixels[c], 1e-5f * expected.pixels[c]);
    retex_image_free(&picture);
    retex_image_free(&expected);
    end_film(&f);
}

/* A table of pictures says whose corrections are brought into memory; all else is. */
static void only_those_asked_for_are_loaded(void **state)
{
    (void)state;
    static const int second[RETEX_MAX_TARGETS] = {0, 1};
    Fixture f;
    Truth truth;
    RetexError err = {0};
    make(&f, &truth, &footprints_layout, 2, 2);
    test_must(retex_set_write(f.set, test_in_folder("corrections.exr"), NULL, 1, &err), &err);
    for (int all = 0; all < 2; all++) {
        RetexSet *set = NULL;
        int corrections[2] = {0};
        test_must(retex_set_open(test_in_folder("corrections.exr"), &set, 1, &err), &err);
        test_must(retex_set_preload(set, all ? NULL : second, UINT64_MAX, 1, &err), &err);
        for (int t = 0; t < set->nterms; t++) {
            const int loaded = set->parts[set->terms[t].radiance].image.pixels != NULL,
                      of = corrected_target(&set->terms[t]);
            assert_int_equal(loaded, set->terms[t].role == RETEX_ROLE_PICTURE ? 0 : all || of != 0);
            corrections[0] += of == 0, corrections[1] += of == 1;
        }
        assert_true(corrections[0] > 0 && corrections[1] > 0);
        retex_set_close(&set);
    }
    end_film(&f);
}

/* Give each signal this noise, as a share of the left pixel's white. Returns the white. */
static double add_noise(RetexSet *set, double share)
{
    double white = 0;
    for (size_t c = 0; c < 3; c++) {
        double sum = 0;
        for (int t = 0; t < set->nterms; t++)
            sum +=
                !retex_term_is_light(&set->terms[t]) ? 0 : (double)set->parts[set->terms[t].radiance].image.pixels[c];
        white = fmax(white, sum);
    }
    test_add_denoise_data(set);
    for (int k = 0; k < set->nparts; k++) {
        RetexImage *im = &set->parts[k].image;
        for (int i = 0; retex_name_is_noise(set->parts[k].name) && i < 3 * im->width * im->height; i++)
            im->pixels[i] = (float)(share * white);
    }
    return white;
}

/* Corrections have steps of at most a 512th of white. */
static void corrections_are_rounded_to_a_512th(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++) {
        RetexError err = {0};
        Fixture f;
        Truth truth;
        float before[256][3];
        double most = 0;
        make(&f, &truth, seed <= 6 ? &footprints_layout : &paper_layout, seed % 2 ? 2 : 3, seed);
        f.set->spp = 1; /* noise as large as the light */
        const double white = add_noise(f.set, 0.5);
        assert_in_range(f.set->nterms, 1, 256);
        for (int t = 0; t < f.set->nterms; t++)
            memcpy(before[t], f.set->parts[f.set->terms[t].radiance].image.pixels, sizeof before[t]);
        test_must(retex_set_round(f.set, NULL, 1, &err), &err);
        for (int t = 0; t < f.set->nterms; t++) {
            const float *after = f.set->parts[f.set->terms[t].radiance].image.pixels;
            for (int c = 0; c < 3 && f.set->terms[t].role == RETEX_ROLE_CORRECTION; c++)
                most = fmax(most, fabs((double)(after[c] - before[t][c])) / white);
        }
        printf("# seed %u: moved by %g of white\n", seed, most);
        assert_true(most > 0.05 / 512 && most < 0.5001 / 512);
        end_film(&f);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(corrections_know_their_kind),
                                       cmocka_unit_test(footprints_are_exact),
                                       cmocka_unit_test(paper_is_exact),
                                       cmocka_unit_test(several_edited_targets_interpolate),
                                       cmocka_unit_test(only_those_asked_for_are_loaded),
                                       cmocka_unit_test(corrections_are_rounded_to_a_512th)};
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
