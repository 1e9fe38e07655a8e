/* Sets with lamps that can be changed, made compact: their pictures are those of the whole set in the same colours of
 * the lamps, as exactly as without these; footprints are shared, and lie where they lie without lamps. */
#include "lib_compact.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <retex/metrics.h>

#include "lib_folder.h"
#include "pack/plan.h"

enum { PARAMETERS = 2 };
static const float colors[][3 * PARAMETERS] = {
    {1, 0.5f, 2, 1, 1, 1}, {0.25f, 3, 0, 1, 0, 2}, {0, 0, 0, 1, 1, 1}, {1, 0.5f, 2, 0, 0, 0}, {0, 0, 0, 0, 0, 0}};
enum { COLORS = sizeof colors / sizeof *colors };

/* The picture with one colour as a texture, or the originals, and lamps of these colours. */
static RetexImage lit_picture(const RetexSet *set, const float *constant, const float *lamps)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    RetexCombineParams params = RETEX_COMBINE_INIT;
    RetexImage image = {0};
    params.parameters = lamps;
    for (int t = 0; t < set->ntargets && constant; t++) {
        specs[t] = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        strcpy(specs[t].target, set->targets[t].name);
        specs[t].constant = 1;
        memcpy(specs[t].color, constant, sizeof specs[t].color);
    }
    test_combine(&image, set, specs, constant ? set->ntargets : 0, &params);
    return image;
}

static void expect_same_pictures(const RetexSet *a, const RetexSet *b, const float *constant)
{
    for (int k = 0; k < COLORS; k++)
        expect_same_image(lit_picture(a, constant, colors[k]), lit_picture(b, constant, colors[k]));
}

static RetexSet *lamp_set(int ntargets, int count)
{
    RetexSet *set = whole_set(ntargets, count);
    test_divide_light(set);
    return set;
}

/* What is exact of a compact set without lamps is exact with them, in all of their colours. */
static void lamps_change_as_in_the_whole_set(void **state)
{
    (void)state;
    for (int ntargets = 1; ntargets <= 2; ntargets++)
        for (int scale = 1; scale <= 8; scale *= 2) {
            RetexSet *set = lamp_set(ntargets, 3), *compact = compacted(set, scale, scale, scale),
                     *whole = compacted(set, 4, 8, 1);
            expect_same_pictures(set, compact, grey);
            expect_same_pictures(set, whole, bright);
            expect_same_pictures(set, whole, NULL);
            retex_set_close(&set);
            retex_set_close(&compact);
            retex_set_close(&whole);
        }
}

/* Terms read their lamps from the set alone, so that it may be packed, and packed again. */
static void packs_hold_lamps(void **state)
{
    (void)state;
    RetexSet *set = lamp_set(1, 2), *pack;
    RetexError err = {0};
    RetexPackParams params = RETEX_PACK_INIT;
    for (int again = 0; again < 2; again++) {
        test_must(retex_pack_write(set, test_in_folder("lamps.retex"), &params, NULL, 2, &err), &err);
        test_must(retex_set_read(test_in_folder("lamps.retex"), &pack, 2, &err), &err);
        assert_true(retex_set_find_part(pack, "dep_T0_sharp_lamp1") > 0);
        assert_true(retex_set_find_part(pack, "gain_T0_broad_lamp2") > 0);
        for (int k = 0; k < COLORS; k++) {
            RetexImage one = lit_picture(set, NULL, colors[k]), other = lit_picture(pack, NULL, colors[k]);
            RetexMetrics metrics;
            test_must(retex_metrics(&metrics, &other, &one, 1, &err), &err);
            assert_true(metrics.psnr > 45);
            retex_image_free(&one);
            retex_image_free(&other);
        }
        retex_set_close(&set);
        set = pack;
    }
    retex_set_close(&set);
}

/* As rendered the light is that of the set without lamps, so that footprints and weights are the same, and as many. */
static void footprints_are_those_of_all_light(void **state)
{
    (void)state;
    RetexSet *set = whole_set(2, 3), *lit = lamp_set(2, 3), *one = compacted(set, 4, 8, 2),
             *all = compacted(lit, 4, 8, 2);
    assert_int_equal(one->nfootprints, all->nfootprints);
    assert_int_equal(one->nmixtures, all->nmixtures);
    int compared = 0;
    for (int i = 1; i < one->nparts; i++) {
        const char *name = one->parts[i].name;
        const int part = retex_set_find_part(all, name);
        if (strncmp(name, "uv_", 3) != 0 && strncmp(name, "weight_", 7) != 0 && strncmp(name, "albedo_", 7) != 0)
            continue;
        assert_true(part > 0);
        const RetexImage *a = &one->parts[i].image, *b = &all->parts[part].image;
        for (size_t k = 0; k < retex_image_index(a, 0, a->height); k++, compared++)
            assert_float_equal(a->pixels[k], b->pixels[k], 1.01 / 512);
    }
    assert_true(compared > 0);
    retex_set_close(&set);
    retex_set_close(&lit);
    retex_set_close(&one);
    retex_set_close(&all);
}

/* Light that two lamps have in turn, so that it is even while both are on: gains of each must be whole all the same. */
static void scales_are_for_each_lamp(void **state)
{
    (void)state;
    for (int edge = 0; edge < 2; edge++) {
        RetexSet *set = whole_set(1, 1), *compact;
        RetexError err = {0};
        RetexParameter lamp = {.kind = RETEX_PARAMETER_COLOR, .target = -1, .value = {1, 1, 1}};
        const int nterms = set->nterms;
        for (int t = 1; t < nterms; t++)
            for (int k = 0; k < 2; k++) {
                RetexTerm term = set->terms[t];
                const int part = k ? add_part(set, "RGB", "light", t) : term.radiance;
                int number = k;
                strcpy(lamp.name, k ? "B" : "A");
                if (t == 1)
                    test_must(retex_set_add_parameter(set, &lamp, &number, &err), &err);
                for (int y = 0; y < HIGH; y++)
                    for (int x = 0; x < WIDE; x++) {
                        const int on = edge ? (x / 5 + y / 5 + k) % 2 : 1, later = retex_term_hits(&term) - 1;
                        /* the sum of a kind is even for each lamp too */
                        const float light = later > 1 ? 0 : later ? (float)on * 0.2f : 0.3f - (float)on * 0.12f;
                        put_rgb(set, part, x, y, light, light, light);
                    }
                term.radiance = part;
                test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_PARAMETER, number), &err), &err);
                if (k)
                    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
                else
                    set->terms[t] = term;
            }
        for (int i = 0; i < set->nfootprints; i++)
            for (int k = 0; k < WIDE * HIGH; k++)
                put(set, i, k % WIDE, k / WIDE, 0.3f, 0.4f, 1);
        test_must(retex_set_compact(&compact, set, NULL, 2, &err), &err);
        const int gain = retex_set_find_part(compact, "gain_T0_sharp_lamp1");
        assert_true(gain > 0);
        assert_int_equal(retex_set_scale(compact, &compact->parts[gain].image), edge ? 1 : 8);
        retex_set_close(&set);
        retex_set_close(&compact);
    }
}

/* Whether a term has a parameter. */
static int has_lamp(const RetexTerm *term, int lamp)
{
    int has = 0;
    for (int k = 0; k < term->nfactors; k++)
        has |= term->factors[k].kind == RETEX_FACTOR_PARAMETER && term->factors[k].index == lamp;
    return has;
}

/* A set of light of the first lamp, which was rendered in these values, all other light on targets being 0. */
static RetexSet *set_of_one_lamp(float value)
{
    RetexSet *set = lamp_set(1, 2);
    for (int c = 0; c < 3; c++)
        set->parameters[0].value[c] = value;
    for (int t = 0; t < set->nterms; t++) {
        const float light = !has_lamp(&set->terms[t], 0) ? !retex_term_hits(&set->terms[t]) : value > 0 ? 1 / value : 1;
        for (int i = 0; i < 3 * WIDE * HIGH; i++)
            set->parts[set->terms[t].radiance].image.pixels[i] *= light;
    }
    return set;
}

/* A lamp that was off has light all the same, which somebody may turn on. One that was far brighter than others, whose
 * radiance is so much smaller, is packed as finely, and in as many bytes. */
static void values_as_rendered_do_not_matter(void **state)
{
    (void)state;
    const float values[] = {1, 0, 4096};
    size_t bytes[3];
    for (int k = 0; k < 3; k++) {
        RetexSet *set = set_of_one_lamp(values[k]), *pack;
        RetexError err = {0};
        RetexMetrics metrics;
        const float on = k == 2 ? values[k] : 1, lamps[3 * PARAMETERS] = {on, on, on, 1, 1, 1};
        test_must(retex_pack_write(set, test_in_folder("values.retex"), NULL, &bytes[k], 2, &err), &err);
        test_must(retex_set_read(test_in_folder("values.retex"), &pack, 2, &err), &err);
        RetexImage one = lit_picture(set, bright, lamps), other = lit_picture(pack, bright, lamps);
        test_must(retex_metrics(&metrics, &other, &one, 1, &err), &err);
        assert_true(metrics.psnr > 45);
        retex_image_free(&one);
        retex_image_free(&other);
        retex_set_close(&pack);
        retex_set_close(&set);
    }
    assert_in_range(bytes[2], 0, bytes[0] + bytes[0] / 20);
}

/* ---- terms of role LAMP ---- */

enum { LAMPS = 3 };

static RetexSet *set_of_lamp_terms(int ntargets, int count, int off)
{
    RetexSet *set = whole_set(ntargets, count);
    test_add_lamp_terms(set, off, 0);
    return set;
}

/* The values that lamps were kept with, but for one that is so many times as bright; -1: for none. alone: others are
 * off. */
static void lamp_values(float values[3 * LAMPS], const RetexSet *set, int lamp, float gain, int alone)
{
    for (int i = 0; i < LAMPS; i++)
        for (int c = 0; c < 3; c++)
            values[3 * i + c] = set->parameters[i].kept[c] * (i == lamp ? gain : (float)!alone);
}

/* The mixture of all footprints of a single hit's kind. */
static int mixture_of(const RetexSet *set, const RetexTerm *term)
{
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            if (set->mixtures[m].shares[k].footprint == term->factors[0].index)
                return m;
    fail_msg("a footprint is in no mixture");
    return -1;
}

/* Light of a lamp that one footprint shows becomes light of all footprints of the kind: one term for all of these. */
static void join_single_hits(RetexSet *set)
{
    int count = 0;
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm term = set->terms[t];
        int same = 0;
        if (term.role == RETEX_ROLE_LAMP && retex_term_hits(&term) == 1) {
            term.factors[0] = retex_factor(RETEX_FACTOR_MIXTURE, mixture_of(set, &term));
            while (same < count && (set->terms[same].role != RETEX_ROLE_LAMP || set->terms[same].nfactors != 2 ||
                                    memcmp(set->terms[same].factors, term.factors, 2 * sizeof *term.factors) != 0))
                same++;
        } else
            same = count;
        if (same == count)
            set->terms[count++] = term;
        else
            for (int i = 0; i < 3 * WIDE * HIGH; i++)
                set->parts[set->terms[same].radiance].image.pixels[i] += set->parts[term.radiance].image.pixels[i];
    }
    set->nterms = count;
}

/* Each lamp alone, and several, are as in the whole set where textures are what gains are exact for; all together are
 * all light. Lamps may tell footprints apart, or not. */
static void single_lamps_are_gains_of_all_light(void **state)
{
    (void)state;
    float values[3 * LAMPS];
    for (int ntargets = 1; ntargets <= 2; ntargets++)
        for (int off = 0; off < 3; off++) {
            RetexSet *set = set_of_lamp_terms(ntargets, 3, off % 2);
            if (off == 2)
                join_single_hits(set);
            RetexSet *compact = compacted(set, 1, 1, 1), *small = compacted(set, 8, 8, 8),
                     *plain = whole_set(ntargets, 3), *none = compacted(plain, 8, 8, 8);
            for (int lamp = 0; lamp < LAMPS; lamp++) {
                lamp_values(values, set, lamp, 3, 1);
                expect_same_image(lit_picture(set, grey, values), lit_picture(compact, grey, values));
                lamp_values(values, set, lamp, 3, 0);
                expect_same_image(lit_picture(set, grey, values), lit_picture(compact, grey, values));
            }
            lamp_values(values, set, -1, 1, 0);
            expect_same_image(lit_picture(none, bright, NULL), lit_picture(small, bright, values));
            retex_set_close(&set);
            retex_set_close(&compact);
            retex_set_close(&small);
            retex_set_close(&plain);
            retex_set_close(&none);
        }
}

/* Light of a lamp is packed as gains, as fine where it is dim, in fewer bytes than as radiance. */
static void packs_hold_gains_of_single_lamps(void **state)
{
    (void)state;
    RetexSet *set = set_of_lamp_terms(2, 3, 1), *pack;
    RetexError err = {0};
    float values[3 * LAMPS];
    test_must(retex_pack_write(set, test_in_folder("single.retex"), NULL, NULL, 2, &err), &err);
    test_must(retex_set_read(test_in_folder("single.retex"), &pack, 2, &err), &err);
    assert_true(retex_set_find_part(pack, "gain_T0_sharp_lamp1") > 0);
    assert_true(retex_set_find_part(pack, "gain_lamp3") > 0);
    assert_int_equal(retex_set_find_part(pack, "dep_T0_sharp_lamp1"), -1);
    for (int lamp = 0; lamp < LAMPS; lamp++)
        for (int times = 1; times <= 20; times += 19) {
            RetexMetrics metrics;
            lamp_values(values, set, lamp, (float)times, 1);
            RetexImage one = lit_picture(set, bright, values), other = lit_picture(pack, bright, values);
            test_must(retex_metrics(&metrics, &other, &one, 1, &err), &err);
            if (!(metrics.psnr > 38))
                fail_msg("lamp %d, %d times: %g dB", lamp, times, metrics.psnr);
            retex_image_free(&one);
            retex_image_free(&other);
        }
    retex_set_close(&set);
    retex_set_close(&pack);
}

/* What two lamps have more and less than a third of light that meets the target once, and of light that meets none. */
typedef float Uneven(int x, int y);

static float edges(int x, int y)
{
    return (x / 5 + y / 5) % 2 ? 0.2f : -0.2f;
}

static float nothing(int x, int y)
{
    (void)x, (void)y;
    return 0;
}

/* The scales of gains of the lamps: of light that meets the target sharply, and of light that does not. */
static void scales_of_lamps(int met[LAMPS], int other[LAMPS], Uneven *of_met, Uneven *of_other)
{
    RetexSet *set = set_of_lamp_terms(1, 1, 0), *compact;
    RetexCompactParams params = RETEX_COMPACT_INIT;
    RetexError err = {0};
    params.noise = 0;
    for (int t = 0; t < set->nterms; t++) {
        RetexTerm *term = &set->terms[t];
        const int lamp = retex_set_term_lamp(set, term), hits = retex_term_hits(term);
        const int sharp = hits == 1 && set->footprints[term->factors[0].index].kind == RETEX_FOOTPRINT_SHARP;
        Uneven *of = sharp ? of_met : hits ? nothing : of_other;
        for (int y = 0; y < HIGH; y++)
            for (int x = 0; x < WIDE; x++) {
                const float uneven = of(x, y);
                const float share = 1 / 3.0f + (lamp == 2 ? 0 : lamp ? -uneven : uneven);
                float *rgb = pixel(set, term->radiance, x, y);
                for (int c = 0; c < 3 && (lamp >= 0 || retex_term_is_light(term)); c++)
                    rgb[c] = 0.05f * (lamp < 0 ? 1 : share / set->parameters[lamp].kept[c]);
            }
    }
    test_must(retex_set_compact(&compact, set, &params, 2, &err), &err);
    for (int lamp = 0; lamp < LAMPS; lamp++) {
        char name[32];
        snprintf(name, sizeof name, "gain_T0_sharp_lamp%d", lamp + 1);
        const int gain = retex_set_find_part(compact, name);
        snprintf(name, sizeof name, "gain_lamp%d", lamp + 1);
        const int share = retex_set_find_part(compact, name);
        assert_true(gain > 0 && share > 0);
        met[lamp] = retex_set_scale(compact, &compact->parts[gain].image);
        other[lamp] = retex_set_scale(compact, &compact->parts[share].image);
    }
    retex_set_close(&set);
    retex_set_close(&compact);
}

/* Gains of a lamp are small where its share of all light is even, and whole where it has edges. */
static void scales_are_for_each_single_lamp(void **state)
{
    int met[LAMPS], other[LAMPS];
    (void)state;
    for (int where = 0; where < 2; where++) {
        scales_of_lamps(met, other, where ? nothing : edges, where ? edges : nothing);
        for (int lamp = 0; lamp < LAMPS; lamp++) {
            assert_int_equal(met[lamp], where || lamp == 2 ? 8 : 1);
            assert_int_equal(other[lamp], !where || lamp == 2 ? 8 : 1);
        }
    }
}

static double mean_of(const RetexSet *set, int part)
{
    const RetexImage *im = &set->parts[part].image;
    const int count = im->width * im->height * im->channels;
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += (double)im->pixels[i];
    return sum / count;
}

/* A gain of a lamp: its step in levels of 255, whose radiance it is of, and how much light of the lamp has it. */
typedef struct Gain {
    int part, radiance, lamp;
    double step, share;
} Gain;

static int find_gains(Gain *gains, const RetexSet *set, const RetexPackPart *plan)
{
    double sums[LAMPS] = {0};
    int count = 0;
    for (int t = 0; t < set->nterms; t++) {
        const RetexTerm *term = &set->terms[t];
        int part = -1, at = 0;
        for (int k = 0; k < term->nfactors && term->role == RETEX_ROLE_LAMP; k++)
            part = term->factors[k].kind == RETEX_FACTOR_IMAGE ? term->factors[k].index : part;
        if (part < 0 || plan[part].codec != RETEX_PACK_JPEG)
            continue;
        const double share =
            mean_of(set, term->radiance) * mean_of(set, part) * pow((double)grey[0], retex_term_hits(term));
        while (at < count && gains[at].part != part)
            at++;
        if (at == count)
            gains[count++] = (Gain){part, term->radiance, retex_set_term_lamp(set, term),
                                    255 * plan[part].jpeg_step / plan[part].curve.levels, 0};
        gains[at].share = fmax(gains[at].share, share);
    }
    for (int k = 0; k < count; k++)
        sums[gains[k].lamp] += gains[k].share;
    for (int k = 0; k < count; k++)
        gains[k].share /= sums[gains[k].lamp];
    return count;
}

/* What adds little to the picture by a lamp has larger steps. Gains of the same radiance are compared, whose steps are
 * alike for the same share. */
static void steps_of_lamps_follow_their_light(void **state)
{
    (void)state;
    const RetexPackQuantizer quantizer = retex_pack_quantizer(45);
    RetexSet *set = set_of_lamp_terms(2, 3, 0), *compact = compacted(set, 1, 1, 1);
    RetexPackPart *plan = calloc((size_t)compact->nparts, sizeof *plan);
    Gain *gains = calloc((size_t)compact->nparts, sizeof *gains);
    RetexError err = {0};
    int compared = 0, different = 0;
    test_must(retex_pack_plan(plan, compact, &quantizer, 1, &err), &err);
    const int count = find_gains(gains, compact, plan);
    for (int i = 0; i < count; i++)
        for (int k = 0; k < i; k++) {
            double finer[2];
            for (int n = 0; n < 2; n++)
                finer[n] = fmax(1.0 / 32, fmin(1, pow(gains[n ? i : k].share / 0.3, 0.7)));
            if (gains[i].radiance != gains[k].radiance)
                continue;
            compared++, different += finer[0] != finer[1];
            if (!(fabs(gains[i].step * finer[1] / (gains[k].step * finer[0]) - 1) < 0.01))
                fail_msg("%s has a step of %g and a share of %g, %s of %g and %g", compact->parts[gains[i].part].name,
                         gains[i].step, gains[i].share, compact->parts[gains[k].part].name, gains[k].step,
                         gains[k].share);
        }
    printf("# %d gains, %d pairs compared, %d of unlike steps\n", count, compared, different);
    assert_true(compared > 10 && different > 10);
    free(plan);
    free(gains);
    retex_set_close(&set);
    retex_set_close(&compact);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_change_as_in_the_whole_set),  cmocka_unit_test(packs_hold_lamps),
        cmocka_unit_test(footprints_are_those_of_all_light), cmocka_unit_test(scales_are_for_each_lamp),
        cmocka_unit_test(values_as_rendered_do_not_matter),  cmocka_unit_test(single_lamps_are_gains_of_all_light),
        cmocka_unit_test(packs_hold_gains_of_single_lamps),  cmocka_unit_test(scales_are_for_each_single_lamp),
        cmocka_unit_test(steps_of_lamps_follow_their_light),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
