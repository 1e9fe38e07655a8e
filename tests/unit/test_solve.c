/* Solving: the derivatives against finite differences, known colours, lamps and finishes are found, threads change
 * nothing, what the picture does not show is told, and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lib_test.h"
#include "set/set.h"
#include "solve/equations.h"

enum { WIDTH = 70, HEIGHT = 130 };

static RetexTexture *const NONE[RETEX_MAX_TARGETS];

/* kind: 0 paper, 1 footprints, 2 with lamps, 3 with light that goes on. */
static RetexSet *make(int kind)
{
    RetexSet *set = test_set(WIDTH, HEIGHT, 3);
    RetexError err = {0};
    for (int reversed = 0; reversed < 2; reversed++) { /* light that meets both targets */
        const RetexTerm term =
            test_term(set, set->terms[1 + reversed].radiance, 3, reversed ? (int[]){3, 0, 1} : (int[]){0, 3, 4});
        test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    }
    if (kind)
        test_make_footprints(set);
    if (kind == 2) { /* some of a lamp's light is lost, as in packs: lamps do not add up to all light */
        test_add_lamp_terms(set, 0, 0);
        for (int t = 0; t < set->nterms; t++)
            for (size_t i = 0; i < 3 * WIDTH * HEIGHT && retex_set_term_lamp(set, &set->terms[t]) == 1; i++)
                set->parts[set->terms[t].radiance].image.pixels[i] *= 0.8f;
    }
    if (kind == 3) {
        for (int t = 0; t < set->nterms; t++) {
            RetexTerm *term = &set->terms[t];
            if (!retex_term_hits(term))
                continue;
            RetexFactor further = term->factors[retex_term_hits(term) - 1];
            further.quantity = RETEX_QUANTITY_FURTHER;
            term->factors[term->nfactors++] = further;
        }
        set->further_hits = 5;
        for (int c = 0; c < 3; c++)
            set->further_ratio[c] = 0.5f + 0.2f * (float)c;
    }
    return set;
}

/* The picture with an edit, which is a text. */
static RetexImage edited(const RetexSet *set, const char *text)
{
    RetexCombineParams params = RETEX_COMBINE_INIT;
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL};
    float parameters[3 * RETEX_PARAMETERS_MAX];
    RetexImage picture = {0};
    RetexEdit *edit = NULL;
    RetexError err = {0};
    test_must(retex_edit_create(&edit, &err), &err);
    test_must(retex_edit_parse(edit, text, &err), &err);
    test_must(retex_edit_parameters(edit, set, parameters, &err), &err);
    params.parameters = parameters;
    test_must(retex_textures_load(textures, set, retex_edit_count(edit) ? retex_edit_texture(edit, 0) : NULL,
                                  retex_edit_count(edit), 1, &err),
              &err);
    test_must(retex_image_alloc(&picture, set->width, set->height, 3, &err), &err);
    test_must(retex_retexture(set, textures, &params, retex_image_keep_rows, &picture, 2, &err), &err);
    retex_textures_close(textures);
    retex_edit_close(&edit);
    return picture;
}

/* ---- derivatives ---- */

static double square_of(const RetexEquations *sums)
{
    return sums->square[0] + sums->square[1] + sums->square[2];
}

static void expect_gradient(int kind)
{
    RetexSet *set = make(kind);
    RetexImage picture = edited(set, "");
    float parameters[3 * RETEX_PARAMETERS_MAX];
    RetexEdit *edit = NULL;
    RetexError err = {0};
    RetexSolveModel model = {
        .set = set,
        .textures = NONE,
        .combine = RETEX_COMBINE_INIT,
        .picture = &picture,
        .dark = 0.1,
        .block = 4,
        .ncolumns = kind == 2 ? 4 : 2,
        .columns = {{0, "", {0, 1, 2}}, {1, "", {3, 4, 5}}, {-1, "Lamp", {6, 6, 6}}, {-1, "Window", {7, 8, 9}}}};
    const int numbers = kind == 2 ? 10 : 6;
    double values[10] = {0.3, 0.6, 0.2, 0.7, 0.15, 0.4, 1.7, 0.4, 1.5, 0.9};
    test_must(retex_edit_create(&edit, &err), &err);
    if (kind == 2)
        test_must(retex_edit_parse(edit, "light:Lamp=2;light:Window=2", &err), &err);
    test_must(retex_edit_parameters(edit, set, parameters, &err), &err);
    retex_edit_close(&edit);
    model.combine.parameters = parameters;
    model.combine.x1 = WIDTH, model.combine.y1 = HEIGHT;
    picture.pixels[100] = NAN;
    RetexEquations *sums = malloc(3 * sizeof *sums);
    const RetexSolveRows all = {1, 1};
    test_must(retex_equations_make(&sums[0], &model, values, all, 2, &err), &err);
    for (int i = 0; i < numbers; i++) {
        const double step = 1e-2, value = values[i];
        double gradient = 0, most = 0;
        for (int k = 0; k < 2; k++) {
            values[i] = k ? value + step : value - step;
            test_must(retex_equations_make(&sums[1 + k], &model, values, all, 2, &err), &err);
        }
        values[i] = value;
        for (int j = 0; j < model.ncolumns; j++)
            for (int c = 0; c < 3; c++) {
                gradient += model.columns[j].number[c] == i ? sums[0].gradient[c][j] : 0;
                most = fmax(most, fabs(sums[0].gradient[c][j]));
            }
        const double measured = (square_of(&sums[2]) - square_of(&sums[1])) / (4 * step);
        if (fabs(gradient - measured) > 2e-3 * fabs(measured) + 1e-4 * most)
            fail_msg("kind %d, number %d: derivative %g, not %g", kind, i, gradient, measured);
    }
    free(sums);
    retex_image_free(&picture);
    retex_set_close(&set);
}

static void derivatives_are_those_of_differences(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++)
        expect_gradient(kind);
}

/* ---- what is found ---- */

static RetexSolution *solve(const RetexSet *set, const RetexImage *picture, const char *unknowns, int threads)
{
    RetexSolveParams params = RETEX_SOLVE_INIT;
    RetexSolution *solution = NULL;
    RetexError err = {0};
    params.unknowns = unknowns;
    test_must(retex_solve(&solution, set, NONE, picture, &params, threads, &err), &err);
    return solution;
}

static void expect_values(const RetexSolution *solution, int index, const double wanted[3], double tolerance)
{
    const RetexUnknown *u = retex_solution_unknown(solution, index);
    assert_non_null(u);
    assert_true(u->seen);
    for (int c = 0; c < 3; c++)
        if (fabs(u->value[c] - wanted[c]) > tolerance * wanted[c])
            fail_msg("%s: channel %d is %g, not %g", u->name, c, u->value[c], wanted[c]);
}

static const double FLOOR[3] = {0.35, 0.08, 0.026}, WALL[3] = {0.25, 0.32, 0.4};
static const char COLORS[] = "Floor=rgb(0.35,0.08,0.026);Wall=rgb(0.25,0.32,0.4)";

/* One percent of noise in each number. */
static void add_noise(RetexImage *picture)
{
    uint32_t seed = 5;
    for (size_t i = 0; i < retex_image_index(picture, 0, picture->height); i++) {
        double sum = -6;
        for (int k = 0; k < 12; k++)
            sum += test_random(&seed);
        picture->pixels[i] *= (float)(1 + 0.01 * sum);
    }
}

static void known_colors_are_found(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        RetexSet *set = make(kind);
        RetexImage picture = edited(set, COLORS);
        RetexSolution *solution = solve(set, &picture, NULL, 2);
        expect_values(solution, 0, FLOOR, 1e-4);
        expect_values(solution, 1, WALL, 1e-4);
        assert_null(retex_solution_unknown(solution, 2));
        assert_null(retex_solution_unknown(solution, -1));
        retex_solution_close(&solution);
        add_noise(&picture);
        solution = solve(set, &picture, "Wall,Floor", 2);
        for (int c = 0; c < 3; c++) { /* within some standard errors, which are small but not too small */
            const RetexUnknown *wall = retex_solution_unknown(solution, 0),
                               *floor = retex_solution_unknown(solution, 1);
            assert_true(floor->error[c] > 1e-5 && floor->error[c] < 0.05);
            assert_true(fabs(floor->value[c] - FLOOR[c]) < 4 * floor->error[c]);
            assert_true(fabs(wall->value[c] - WALL[c]) < 4 * wall->error[c]);
        }
        retex_solution_close(&solution);
        retex_image_free(&picture);
        retex_set_close(&set);
    }
}

/* One target keeps its original: its corrections count. */
static void one_color_is_found_with_corrections(void **state)
{
    (void)state;
    RetexSet *set = make(0);
    RetexError err = {0};
    int part;
    const RetexParameter weight = {.name = "correction", .kind = RETEX_PARAMETER_CORRECTION, .target = 0};
    int number;
    test_must(retex_set_add_parameter(set, &weight, &number, &err), &err);
    test_must(retex_set_add_part(set, "off", "RGB", RETEX_HALF, 0, 0, &part, &err), &err);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        set->parts[part].image.pixels[i] = 0.25f;
    RetexTerm term = test_term(set, part, 1, (int[]){0});
    term.role = RETEX_ROLE_CORRECTION;
    term.factors[term.nfactors++] = retex_factor(RETEX_FACTOR_PARAMETER, number);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    RetexImage picture = edited(set, "Floor=rgb(0.35,0.08,0.026)");
    RetexSolution *solution = solve(set, &picture, "floor", 2);
    expect_values(solution, 0, FLOOR, 1e-4);
    retex_solution_close(&solution);
    retex_image_free(&picture);
    retex_set_close(&set);
}

static void expect_lamps(double strength_of_lamp)
{
    RetexSet *set = make(2);
    char text[200];
    snprintf(text, sizeof text, "%s;light:Lamp=%g;light:Window=1.5*rgb(1.2,0.9,1.4)", COLORS, strength_of_lamp);
    RetexImage picture = edited(set, text);
    RetexSolution *solution = solve(set, &picture, "light:Lamp,color:window,Floor,Wall", 2);
    RetexEdit *edit = NULL;
    RetexError err = {0};
    char *found = NULL;
    const RetexUnknown *lamp = retex_solution_unknown(solution, 0), *window = retex_solution_unknown(solution, 1);
    const double strength = retex_luminance(1.2, 0.9, 1.4);
    assert_float_equal(lamp->value[0], strength_of_lamp, 1e-4);
    expect_values(solution, 1, (double[]){1.5 * 1.2 / strength, 1.5 * 0.9 / strength, 1.5 * 1.4 / strength}, 1e-3);
    assert_string_equal(window->name, "Window");
    expect_values(solution, 2, FLOOR, 1e-3);
    expect_values(solution, 3, WALL, 1e-3);
    test_must(retex_edit_create(&edit, &err), &err);
    test_must(retex_solution_edit(solution, edit, &err), &err);
    test_must(retex_edit_text(edit, ';', &found, &err), &err);
    RetexImage again = edited(set, found); /* the edit makes the picture */
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
        assert_float_equal(again.pixels[i], picture.pixels[i], 1e-3 * (1 + fabs((double)picture.pixels[i])));
    free(found);
    retex_edit_close(&edit);
    retex_image_free(&again);
    retex_solution_close(&solution);
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* One that is off, and one that has light in common with the others. */
static void lamps_are_found(void **state)
{
    (void)state;
    expect_lamps(0);
    expect_lamps(0.6);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    RetexSet *set = make(2);
    RetexImage picture = edited(set, COLORS);
    add_noise(&picture);
    RetexSolution *one = solve(set, &picture, "Floor,Wall,light:Lamp", 1);
    for (int threads = 2; threads < 8; threads += 5) {
        RetexSolution *many = solve(set, &picture, "Floor,Wall,light:Lamp", threads);
        for (int i = 0; i < 3; i++)
            assert_memory_equal(retex_solution_unknown(one, i), retex_solution_unknown(many, i), sizeof(RetexUnknown));
        retex_solution_close(&many);
    }
    retex_solution_close(&one);
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* Nothing depends on the wall; of the floor nothing of one colour is left. */
static void what_is_not_seen_is_told(void **state)
{
    (void)state;
    RetexSet *set = make(0);
    for (int t = set->nterms; t-- > 0;)
        for (int k = 0; k < set->terms[t].nfactors; k++)
            if (set->footprints[set->terms[t].factors[k].index].target == 1) {
                set->terms[t] = set->terms[--set->nterms];
                break;
            }
    RetexImage picture = edited(set, "Floor=rgb(0.35,0.08,0.026)");
    RetexSolution *solution = solve(set, &picture, "Wall,Floor", 2);
    RetexEdit *edit = NULL;
    assert_false(retex_solution_unknown(solution, 0)->seen);
    expect_values(solution, 1, FLOOR, 1e-3);
    assert_int_equal(retex_edit_create(&edit, NULL), 0);
    assert_int_equal(retex_solution_edit(solution, edit, NULL), 0);
    assert_int_equal(retex_edit_count(edit), 1);
    assert_string_equal(retex_edit_texture(edit, 0)->target, "Floor");
    retex_edit_close(&edit);
    retex_solution_close(&solution);
    for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++) /* more light than any colour gives */
        picture.pixels[i] *= 10;
    solution = solve(set, &picture, "Floor", 2);
    assert_true(retex_solution_unknown(solution, 0)->limited);
    assert_float_equal(retex_solution_unknown(solution, 0)->value[0], 1, 0);
    retex_solution_close(&solution);
    retex_image_free(&picture);
    retex_set_close(&set);
}

/* ---- what is refused ---- */

static void expect_refused(const RetexSet *set, const RetexImage *picture, const RetexSolveParams *params, int code,
                           const char *message)
{
    RetexSolution *solution = NULL;
    RetexError err = {0};
    assert_int_equal(retex_solve(&solution, set, NONE, picture, params, 2, &err), code);
    assert_null(solution);
    if (!strstr(err.message, message))
        fail_msg("'%s' says nothing of '%s'", err.message, message);
}

static void mistakes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *unknowns, *message;
        int code;
    } lists[] = {{"Flor", "Floor", RETEX_ENOTFOUND},
                 {"light:Lmp", "Lamp", RETEX_ENOTFOUND},
                 {"finish:Floor", "finishes", RETEX_ENOTFOUND},
                 {"Floor,floor", "twice", RETEX_EINVAL},
                 {"light:Lamp,color:Lamp", "twice", RETEX_EINVAL},
                 {"", "TARGET", RETEX_EPARSE},
                 {"Floor,", "TARGET", RETEX_EPARSE},
                 {"light:Window", "both", RETEX_EINVAL}};
    RetexSet *set = make(2);
    RetexImage picture = edited(set, ""), small = {0};
    RetexSolveParams params = RETEX_SOLVE_INIT;
    RetexEdit *lights = NULL;
    RetexBudget *budget = NULL;
    assert_int_equal(retex_edit_create(&lights, NULL), 0);
    assert_int_equal(retex_edit_light(lights, "window=2", NULL), 0);
    params.lights = lights;
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        params.unknowns = lists[i].unknowns;
        expect_refused(set, &picture, &params, lists[i].code, lists[i].message);
    }
    params.unknowns = "Floor";
    assert_int_equal(retex_image_alloc(&small, WIDTH, HEIGHT - 1, 3, NULL), 0);
    expect_refused(set, &small, &params, RETEX_EINVAL, "70 x 129 pixels, the set 70 x 130");
    params.x0 = 60, params.x1 = 71, params.y1 = 10;
    expect_refused(set, &picture, &params, RETEX_EINVAL, "region");
    params.x1 = 61;
    for (int y = 0; y < 10; y++)
        picture.pixels[retex_image_index(&picture, 60, y)] = INFINITY;
    expect_refused(set, &picture, &params, RETEX_EINVAL, "no pixel");
    params.x0 = 0;
    assert_int_equal(retex_budget_create(&budget, NULL), 0);
    retex_budget_stop(budget);
    params.budget = budget;
    expect_refused(set, &picture, &params, RETEX_ESTOPPED, "");
    retex_budget_close(&budget);
    retex_edit_close(&lights);
    retex_image_free(&small);
    retex_image_free(&picture);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_are_those_of_differences),
        cmocka_unit_test(known_colors_are_found),
        cmocka_unit_test(one_color_is_found_with_corrections),
        cmocka_unit_test(lamps_are_found),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(what_is_not_seen_is_told),
        cmocka_unit_test(mistakes_are_refused),
    };
    return cmocka_run_group_tests_name("solving", tests, NULL, NULL);
}
