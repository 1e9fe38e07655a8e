/* Sets and samples: round trips through files and pipes, names and references. */
#include "lib_folder.h"
#include "lib_sets.h"

#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>
#include <retex/denoise.h>
#include <retex/pack.h>
#include <retex/reduce.h>
#include <retex/web.h>

#include "base/half.h"

static const char *const path = test_own_file;

static void test_set_there_and_back(void **state)
{
    (void)state;
    for (int compress = 0; compress < 2; compress++) {
        RetexSet *set = test_set(70, 45, 9), *back;
        RetexStoreParams params = RETEX_STORE_INIT;
        RetexError err = {0};
        params.compress = compress;
        set->seed = 4000000000u;
        retex_set_identify(set);
        assert_int_not_equal(set->id, 0);
        set->folded = 1.0 / 3;
        strcpy(set->scene, "k\xc3\xbc"
                           "che.pov");
        test_must(retex_set_write(set, path, &params, 3, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        test_must(retex_set_read(path, &back, 2, &err), &err);
        assert_false(retex_set_info(back).is_samples || retex_set_has_laid(back));
        expect_equal_sets(set, back);
        /* what was read can be added to and written again */
        test_must(retex_set_add_part(back, "more", "A", RETEX_FLOAT, 0, 0, NULL, &err), &err);
        test_must(retex_set_add_part(back, "and-more", "A", RETEX_FLOAT, 3, 2, NULL, &err), &err);
        test_must(retex_set_write(back, path, &params, 3, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        retex_set_close(&set);
        retex_set_close(&back);
        retex_set_close(&back);
        retex_set_close(NULL);
    }
}

/* What layout footprints has and paper has not: kinds, spreads with a correlation, how large a unit of UV is,
 * mixtures. And what a term weighs in noise. */
static void test_footprints_there_and_back(void **state)
{
    (void)state;
    RetexSet *set = test_set(30, 20, 7), *back;
    RetexError err = {0};
    test_make_footprints(set);
    set->terms[set->nterms - 1].noise_weight = 0.3f;
    RetexFootprint quarter = set->footprints[0];
    test_must(retex_set_add_part(set, "axes", "RGBA", RETEX_HALF, 0, 0, &quarter.spread, &err), &err);
    for (quarter.quadrant = 1; quarter.quadrant <= RETEX_QUADRANTS; quarter.quadrant++)
        test_must(retex_set_add_footprint(set, &quarter, NULL, &err), &err);
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    test_must(retex_set_check(path, 0, &err), &err);
    test_must(retex_set_read(path, &back, 0, &err), &err);
    expect_equal_sets(set, back);
    retex_set_close(&set);
    retex_set_close(&back);
}

static void test_samples_there_and_back(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 30, 2), *none, *back, *again;
    RetexError err = {0};
    for (int every = 0; every < 3; every++) {
        const int nparts = set->nparts;
        lay_random(set, every);
        test_must(retex_set_write_samples(set, path, NULL, 0, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        test_must(retex_set_open_any(path, &back, 0, &err), &err);
        assert_true(retex_set_info(back).is_samples);
        assert_int_equal(back->nparts, set->nparts - nparts);
        test_must(retex_set_write(back, path, NULL, 0, &err), &err); /* and written again they are the same */
        test_must(retex_set_open_any(path, &again, 0, &err), &err);
        test_must(retex_set_load(back, 0, &err), &err);
        test_must(retex_set_load(again, 0, &err), &err);
        expect_equal_laid(set, back);
        expect_equal_laid(set, again);
        assert_int_equal(retex_set_read(path, &none, 0, &err), RETEX_EFORMAT);
        assert_non_null(strstr(err.message, "holds samples, no set"));
        assert_null(none);
        test_must(retex_set_lay(set, back, &err), &err);
        expect_equal_laid(set, again);
        retex_set_lift(set, -1);
        assert_int_equal(set->nparts, nparts);
        retex_set_close(&back);
        retex_set_close(&again);
    }
    retex_set_close(&set);
}

static void expect_stream(const RetexSet *set, const RetexSet *back)
{
    expect_equal_terms(set, back);
    expect_equal_mixtures(set, back);
    expect_equal_part(set, 0, back, 0);
    assert_int_equal(back->nfootprints, set->nfootprints);
    for (int i = 0; i < set->nfootprints; i++) {
        if (set->footprints[i].sampled) {
            assert_int_equal(back->footprints[i].uv, -1);
            continue;
        }
        expect_equal_part(set, set->footprints[i].albedo, back, back->footprints[i].albedo);
        expect_equal_part(set, set->footprints[i].uv, back, back->footprints[i].uv);
        expect_equal_part(set, set->footprints[i].spread, back, back->footprints[i].spread);
    }
    assert_true(back->nparts < set->nparts);
    for (int i = 0; i < back->nparts; i++)
        assert_true(strncmp(back->parts[i].name, "noise_", 6) != 0 && strncmp(back->parts[i].name, "guide_", 6) != 0);
}

static void test_stream_through_a_pipe(void **state)
{
    (void)state;
    RetexSet *set = test_set(90, 60, 4), *back;
    test_make_footprints(set);
    test_add_denoise_data(set);
    lay_random(set, 2);
    RetexError err = {0};
    int ends[2], status = 1;
    /* checksums of all parts, to compare with */
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        _exit(retex_set_write(set, "-", NULL, 0, &err) != 0);
    }
    const int kept = dup(0);
    dup2(ends[0], 0);
    close(ends[0]);
    close(ends[1]);
    const int code = retex_set_read("-", &back, 0, &err);
    dup2(kept, 0);
    close(kept);
    waitpid(child, &status, 0);
    test_must(code, &err);
    assert_int_equal(status, 0);
    expect_stream(set, back);
    expect_equal_laid(set, back);
    retex_set_close(&set);
    retex_set_close(&back);
}

/* Each with one mistake; the first has none. */
static void expect_wrong_terms(RetexSet *set)
{
    RetexError err = {0};
    const int radiance = set->terms[0].radiance, terms = set->nterms;
    RetexParameter lamp = {.name = "lamp", .kind = RETEX_PARAMETER_COLOR, .target = -1, .value = {1, 1, 1}};
    int correction;
    test_must(retex_set_add_parameter(set, &lamp, NULL, &err), &err);
    const RetexTerm corrects = {.target = 1, .radiance = radiance};
    test_must(retex_set_add_correction(set, &corrects, &correction, &err), &err);
    assert_int_equal(set->terms[correction].role, RETEX_ROLE_CORRECTION);
    const RetexFactor weight = set->terms[correction].factors[0];
    assert_int_equal(weight.kind, RETEX_FACTOR_PARAMETER);
    assert_int_equal(set->parameters[weight.index].target, 1);
    const RetexFactor one = retex_factor(RETEX_FACTOR_FOOTPRINT, 0), no_kind = {(RetexFactorKind)4, 0, 0},
                      no_quantity = {RETEX_FACTOR_FOOTPRINT, (RetexQuantity)RETEX_QUANTITIES, 0};
    const RetexTerm wrong[] = {
        {RETEX_ROLE_DEP, 0, radiance, 2, {one, retex_factor(RETEX_FACTOR_PARAMETER, 0)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_FOOTPRINT, set->nfootprints)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_FOOTPRINT, -1)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_MIXTURE, 0)}}, /* it has none */
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_PARAMETER, 2)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_IMAGE, 0)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {retex_factor(RETEX_FACTOR_IMAGE, set->nparts)}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {no_kind}},
        {RETEX_ROLE_DEP, 0, radiance, 1, {no_quantity}},
        {RETEX_ROLE_DEP, 2, radiance, 1, {one}},
        {RETEX_ROLE_DEP, -2, radiance, 1, {one}},
        {RETEX_ROLE_DEP, 0, -1, 1, {one}},
        {RETEX_ROLE_DEP, 0, radiance, RETEX_MAX_FACTORS + 1, {one}},
        {RETEX_ROLE_DEP, 0, radiance, RETEX_MAX_HITS + 1, {one}}, /* the others are footprint 0 as well */
        {RETEX_ROLE_DEP, 0, radiance, -1, {one}},
        {(RetexRole)RETEX_ROLES, 0, radiance, 1, {one}},
        {RETEX_ROLE_DEP, 1, radiance, 1, {weight}},
        {RETEX_ROLE_CORRECTION, 1, radiance, 1, {one}},
        {RETEX_ROLE_CORRECTION, 0, radiance, 1, {weight}},
        {RETEX_ROLE_CORRECTION, -1, radiance, 1, {weight}},
        {RETEX_ROLE_PICTURE, -1, radiance, 0, {one}},
        {RETEX_ROLE_PICTURE, -1, 0, 1, {one}},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++)
        if (retex_set_add_term(set, &wrong[i], NULL, &err) != (i ? RETEX_EINVAL : RETEX_OK))
            fail_msg("term %zu: %s", i, err.message);
    assert_int_equal(set->nterms, terms + 2);
    const RetexTerm picture = {.role = RETEX_ROLE_PICTURE, .target = -1};
    test_must(retex_set_add_term(set, &picture, NULL, &err), &err);
    assert_int_equal(retex_set_add_term(set, &picture, NULL, &err), RETEX_EINVAL); /* there is one */
    const RetexParameter wrong_parameters[] = {
        {"", RETEX_PARAMETER_COLOR, -1, {1, 1, 1}},         {"lamp", RETEX_PARAMETER_COLOR, -1, {1, 1, 1}},
        {"x", (RetexParameterKind)2, -1, {1, 1, 1}},        {"x", RETEX_PARAMETER_COLOR, 0, {1, 1, 1}},
        {"x", RETEX_PARAMETER_COLOR, -1, {1, -1, 1}},       {"x", RETEX_PARAMETER_COLOR, -1, {1, NAN, 1}},
        {"x", RETEX_PARAMETER_COLOR, -1, {1, 1, INFINITY}}, {"x", RETEX_PARAMETER_CORRECTION, -1, {0, 0, 0}},
        {"x", RETEX_PARAMETER_CORRECTION, 0, {1, 1, 1}},
    };
    for (size_t i = 0; i < sizeof wrong_parameters / sizeof *wrong_parameters; i++)
        if (retex_set_add_parameter(set, &wrong_parameters[i], NULL, &err) != RETEX_EINVAL)
            fail_msg("parameter %zu is taken", i);
}

/* Sets that were put together wrongly are not written. Each mixture has one mistake; the first has none. */
static void wrong_mixtures_are_not_written(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    test_make_footprints(set);
    const RetexMixture right = set->mixtures[0];
    const int last = right.nshares - 1;
    assert_true(last > 0);
    for (int i = 0; i < 7; i++) {
        RetexMixture *wrong = &set->mixtures[0];
        *wrong = right;
        if (i == 1)
            wrong->shares[last].weight = -1;
        if (i == 2)
            wrong->shares[last].weight = set->nparts;
        if (i == 3)
            wrong->shares[last].footprint = -1;
        if (i == 4)
            wrong->shares[last].footprint = set->nfootprints;
        if (i == 5)
            wrong->nshares = 0;
        if (i == 6)
            wrong->nshares = RETEX_SHARES_MAX + 1;
        if (retex_set_write(set, path, NULL, 0, &err) != (i ? RETEX_EINVAL : RETEX_OK))
            fail_msg("mixture %d: %s", i, err.message);
    }
    set->mixtures[0] = right;
    retex_set_close(&set);
}

/* Colours of a footprint, these with a finish, and gates are parts of their own, and go when the texture is lifted; one
 * target keeps its own then. Two targets have one name but for letters that names of parts do not have. */
static void textures_are_lifted_by_target(void **state)
{
    (void)state;
    static const int places[][3] = {{0, 0, -1}, {0, 0, 0}, {0, 0, 1}, {0, -1, -1}, {1, -1, -1}};
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    const int nparts = set->nparts;
    int parts[5];
    strcpy(set->targets[0].name, "a b");
    strcpy(set->targets[1].name, "a.b");
    assert_int_equal(set->footprints[0].target, 0);
    for (int i = 0; i < 5; i++)
        test_must(retex_set_add_laid(set, places[i][0], places[i][1], places[i][2], &parts[i], &err), &err);
    assert_int_equal(set->footprints[0].sampled, 1 + parts[0]);
    assert_int_equal(set->footprints[0].finished[0], 1 + parts[1]);
    assert_int_equal(set->footprints[0].finished[1], 1 + parts[2]);
    assert_int_equal(set->targets[0].gates, 1 + parts[3]);
    assert_int_equal(set->targets[1].gates, 1 + parts[4]);
    assert_string_equal(set->parts[parts[3]].name, "sample_a_b_gate_1");
    assert_string_equal(set->parts[parts[4]].name, "sample_a_b_gate_1_2");
    retex_set_lift(set, 0);
    assert_int_equal(set->nparts, nparts + 1);
    assert_int_equal(set->footprints[0].sampled, 0);
    assert_int_equal(set->footprints[0].finished[1], 0);
    assert_int_equal(set->targets[0].gates, 0);
    assert_int_equal(set->targets[1].gates, 1 + nparts);
    retex_set_lift(set, -1);
    assert_int_equal(set->nparts, nparts);
    retex_set_close(&set);
}

/* A pack, a smaller set, a page and a denoised set would lose what is laid on a set. */
static void sets_with_textures_are_not_packed(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1), *smaller = NULL;
    RetexError err = {0};
    test_make_footprints(set);
    test_add_denoise_data(set);
    lay_random(set, 1);
    assert_int_equal(retex_pack_write(set, path, NULL, NULL, 0, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "a texture is laid on"));
    assert_int_equal(retex_set_reduce(&smaller, set, 2, 1, &err), RETEX_EINVAL);
    assert_int_equal(retex_web_write(set, path, NULL, NULL, 1, &err), RETEX_EINVAL);
    assert_int_equal(retex_denoise(set, NULL, NULL, 1, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "a texture is laid on"));
    retex_set_lift(set, -1);
    test_must(retex_pack_write(set, path, NULL, NULL, 0, &err), &err);
    retex_set_close(&set);
}

/* Finishes are numbered from 1, and 0 is none, in targets as in parameters. */
static void finishes_are_numbered_from_1(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    static const int numbers[][3] = {{0, 0, 1}, {2, 1, 1}, {2, 2, 1},  {0, 1, 0},
                                     {2, 0, 0}, {2, 3, 0}, {2, -1, 0}, {RETEX_FINISHES_MAX + 1, 1, 0}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        RetexTarget target = {.nfinishes = numbers[i][0], .finish = numbers[i][1], .original = -1};
        snprintf(target.name, sizeof target.name, "finished%zu", i);
        if (retex_set_add_target(set, &target, NULL, &err) != (numbers[i][2] ? RETEX_OK : RETEX_EINVAL))
            fail_msg("finish %d of %d", numbers[i][1], numbers[i][0]);
    }
    const int last = set->ntargets - 1;
    for (int finish = -1; finish <= 3; finish++) {
        RetexParameter light = {.kind = RETEX_PARAMETER_COLOR, .target = -1};
        snprintf(light.name, sizeof light.name, "finish%d", finish);
        light.finishes[last] = (signed char)finish;
        if (retex_set_add_parameter(set, &light, NULL, &err) != (finish < 0 || finish > 2 ? RETEX_EINVAL : RETEX_OK))
            fail_msg("light of finish %d", finish);
        assert_true(finish < 0 || finish > 2 || !retex_parameter_lamp(set, set->nparameters - 1));
    }
    retex_set_close(&set);
}

static void test_names_are_checked(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    static const char *const wrong[] = {"", "a b", "a.b", "\xc3\xa4", "a/b"};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++)
        assert_int_equal(retex_set_add_part(set, wrong[i], "RGB", RETEX_HALF, 0, 0, NULL, &err), RETEX_EINVAL);
    assert_int_equal(retex_set_add_part(set, set->parts[1].name, "R", RETEX_HALF, 0, 0, NULL, &err), RETEX_EINVAL);
    assert_int_equal(retex_set_add_part(set, "x", "RR", RETEX_HALF, 0, 0, NULL, &err), RETEX_EINVAL);
    assert_int_equal(retex_set_add_part(set, "x", "r", RETEX_HALF, 0, 0, NULL, &err), RETEX_EINVAL);
    assert_int_equal(retex_set_add_part(set, "x", "R", RETEX_HALF, 70000, 1, NULL, &err), RETEX_EINVAL);
    RetexFootprint footprint = {.target = set->ntargets, .hit = 1, .uv = -1, .spread = -1, .albedo = -1};
    assert_int_equal(retex_set_add_footprint(set, &footprint, NULL, &err), RETEX_EINVAL);
    expect_wrong_terms(set);

    strcpy(set->targets[0].name, "Floor");
    strcpy(set->targets[1].name, "floor");
    assert_int_equal(retex_set_find_target(set, "floor"), 1);
    assert_int_equal(retex_set_find_target(set, "FLOOR"), -1);
    strcpy(set->targets[1].name, "Wall");
    assert_int_equal(retex_set_find_target(set, "fLOOR"), 0);
    retex_set_close(&set);
    assert_int_equal(retex_set_create(&set, 0, 5, &err), RETEX_EINVAL);
    assert_null(set);
}

/* Names of the parts that a set refers to, in the order of the references; room for all. */
static int list_references(const RetexSet *set, char names[][RETEX_NAME_MAX])
{
    int parts[512], count = 0;
    for (int i = 0; i < set->ntargets; i++)
        parts[count++] = set->targets[i].original;
    for (int i = 0; i < set->nfootprints; i++) {
        parts[count++] = set->footprints[i].uv;
        parts[count++] = set->footprints[i].spread;
        parts[count++] = set->footprints[i].albedo;
    }
    for (int i = 0; i < set->nterms; i++)
        parts[count++] = set->terms[i].radiance;
    for (int i = 0; i < set->nmixtures; i++)
        for (int k = 0; k < set->mixtures[i].nshares; k++)
            parts[count++] = set->mixtures[i].shares[k].weight;
    for (int i = 0; i < count; i++) {
        assert_in_range(parts[i] + 1, 0, set->nparts);
        strcpy(names[i], parts[i] < 0 ? "" : set->parts[parts[i]].name);
    }
    return count;
}

/* Parts go that nothing refers to, and some that nothing refers to any more: all other references stay what they were.
 */
static void test_references_follow_when_parts_go(void **state)
{
    (void)state;
    static char before[512][RETEX_NAME_MAX], after[512][RETEX_NAME_MAX];
    static const char *const unused[] = {"depth", "guide_specular", "noise_indep", "guide_cover_Wall", "guide_normal"};
    RetexSet *set = test_set(12, 10, 1);
    RetexError err = {0};
    test_make_footprints(set);
    test_add_denoise_data(set);
    test_must(retex_set_add_part(set, "last", "RGB", RETEX_HALF, 0, 0, &set->targets[1].original, &err), &err);
    const int count = list_references(set, before);
    for (size_t i = 0; i < sizeof unused / sizeof *unused; i++) {
        const int nparts = set->nparts;
        retex_set_remove_part(set, retex_set_find_part(set, unused[i]));
        assert_int_equal(set->nparts, nparts - 1);
        assert_int_equal(retex_set_find_part(set, unused[i]), -1);
        assert_int_equal(list_references(set, after), count);
        assert_memory_equal(before, after, sizeof before);
    }
    int *const references[] = {&set->footprints[0].uv, &set->footprints[2].spread, &set->footprints[4].albedo,
                               &set->targets[0].original};
    for (size_t i = 0; i < sizeof references / sizeof *references; i++) {
        const int part = *references[i];
        *references[i] = -1;
        list_references(set, before);
        retex_set_remove_part(set, part);
        assert_int_equal(*references[i], -1);
        assert_int_equal(list_references(set, after), count);
        assert_memory_equal(before, after, sizeof before);
    }
    assert_int_equal(set->targets[1].original, retex_set_find_part(set, "last"));
    test_must(retex_set_write(set, path, NULL, 0, &err), &err); /* and it is a set that can be read */
    retex_set_close(&set);
    test_must(retex_set_read(path, &set, 0, &err), &err);
    assert_int_equal(list_references(set, after), count);
    assert_memory_equal(before, after, sizeof before);
    retex_set_close(&set);
}

static void test_samples_of_another_set(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1), *from = test_set(16, 17, 1);
    RetexError err = {0};
    lay_random(from, 1);
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    retex_set_close(&from);
    from = test_set(16, 16, 1); /* the same shape, but another render */
    lay_random(from, 1);
    from->id = 7, set->id = 8;
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "another render"));
    set->id = 7;
    strcpy(from->targets[0].name, "Ceiling");
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    strcpy(from->targets[0].name, set->targets[0].name);
    from->footprints[1].hit++;
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    from->footprints[1].hit--;
    from->nfootprints--;
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    from->nfootprints++;
    from->footprints[1].finished[0] = from->footprints[1].sampled; /* of a target that has no finishes */
    assert_int_equal(retex_set_lay(set, from, &err), RETEX_EINVAL);
    from->footprints[1].finished[0] = 0;
    assert_false(retex_set_has_laid(set));
    test_must(retex_set_lay(set, from, &err), &err);
    assert_true(retex_set_has_laid(set));
    retex_set_close(&from);
    retex_set_close(&set);
}

/* What rows are as they are stored, and their checksums, tell of the same samples as a file. */
/* Each member has a value of its own, there and back. */
static void test_description_there_and_back(void **state)
{
    (void)state;
    RetexSet *set = test_set(5, 4, 1);
    char layout[] = "plain", filter[] = "gaussian", generator[] = "test 2", scene[300];
    RetexError err = {0};
    memset(scene, 's', sizeof scene - 1);
    scene[sizeof scene - 1] = '\0';
    RetexSetInfo info = retex_set_info(set);
    const RetexSetInfo before = info;
    assert_string_equal(info.layout, "paper");
    info.width = info.height = info.ntargets = info.nparts = 99; /* which it does not take over */
    info.layout = layout, info.filter = filter, info.scene = scene, info.generator = generator;
    info.orders = 1, info.spp = 2, info.max_depth = 3, info.seed = 4, info.denoised = 5, info.strict_paper = 6;
    info.folded = 0.7, info.folded_white = 0.8;
    test_must(retex_set_describe(set, &info, &err), &err);
    memset(layout, 0, sizeof layout); /* texts are copied */
    for (int again = 0; again < 2; again++) {
        info = retex_set_info(set);
        assert_int_equal(info.width, before.width);
        assert_int_equal(info.height, before.height);
        assert_int_equal(info.id, before.id);
        assert_int_equal(info.ntargets, before.ntargets);
        assert_int_equal(info.nparts, before.nparts);
        assert_string_equal(info.layout, "plain");
        assert_string_equal(info.filter, "gaussian");
        assert_string_equal(info.generator, "test 2");
        assert_int_equal(strlen(info.scene), RETEX_SCENE_MAX - 1);
        assert_int_equal(info.orders, 1);
        assert_int_equal(info.spp, 2);
        assert_int_equal(info.max_depth, 3);
        assert_int_equal(info.seed, 4);
        assert_int_equal(info.denoised, 5);
        assert_int_equal(info.strict_paper, 6);
        assert_true(info.folded == 0.7 && info.folded_white == 0.8);
        test_must(retex_set_describe(set, &info, &err), &err); /* with the set's own texts */
    }
    info.size = 3;
    assert_int_equal(retex_set_describe(set, &info, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

#define EXPECT_ELEMENTS(set, call, array, count)                                                                       \
    do {                                                                                                               \
        assert_int_not_equal(count, 0);                                                                                \
        for (int i = 0; i < (count); i++)                                                                              \
            assert_ptr_equal(call(set, i), &(set)->array[i]);                                                          \
        assert_null(call(set, -1));                                                                                    \
        assert_null(call(set, count));                                                                                 \
    } while (0)

static void test_elements_are_the_set_s(void **state)
{
    (void)state;
    RetexSet *set = test_set(5, 4, 1);
    test_make_footprints(set);
    test_add_lamp(set, "Lamp");
    const RetexSetInfo info = retex_set_info(set);
    EXPECT_ELEMENTS(set, retex_set_target, targets, info.ntargets);
    EXPECT_ELEMENTS(set, retex_set_footprint, footprints, info.nfootprints);
    EXPECT_ELEMENTS(set, retex_set_mixture, mixtures, info.nmixtures);
    EXPECT_ELEMENTS(set, retex_set_term, terms, info.nterms);
    EXPECT_ELEMENTS(set, retex_set_parameter, parameters, info.nparameters);
    EXPECT_ELEMENTS(set, retex_set_part, parts, info.nparts);
    retex_set_close(&set);
}

/* Row y of a part, as a file would have it, as floats; of at most 4 * 64 numbers. */
static void stored_row(const RetexPart *part, int y, float *floats)
{
    uint16_t halves[4 * 64];
    const size_t count = (size_t)part->image.width * (size_t)part->image.channels;
    assert_true(count <= sizeof halves / sizeof *halves);
    retex_image_stored_row(&part->image, part->type, y, part->type == RETEX_HALF ? (void *)halves : floats);
    if (part->type == RETEX_HALF)
        retex_half_to_float(floats, halves, count);
}

/* A set, and what is read of its file. */
static void write_and_read(RetexSet **set, RetexSet **read)
{
    RetexError err = {0};
    *set = test_set(37, 19, 5);
    test_must(retex_set_write(*set, path, NULL, 0, &err), &err);
    test_must(retex_set_read(path, read, 0, &err), &err);
}

/* Rows as hosts store them are those that are read from the set's own file. */
static void test_stored_rows(void **state)
{
    (void)state;
    RetexSet *set, *read;
    write_and_read(&set, &read);
    for (int i = 0; i < set->nparts; i++) {
        const RetexImage *image = &read->parts[i].image;
        for (int y = 0; y < image->height; y++) {
            float row[4 * 64];
            stored_row(&set->parts[i], y, row);
            assert_memory_equal(row, image->pixels + retex_image_index(image, 0, y),
                                sizeof *row * (size_t)image->width * (size_t)image->channels);
        }
    }
    retex_set_close(&set);
    retex_set_close(&read);
}

/* Checksums as hosts store them are those of the set's own file; parts without pixels have none. */
static void test_stored_checksums(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexSet *set, *read;
    write_and_read(&set, &read);
    for (int i = 0; i < set->nparts; i++)
        set->parts[i].crc = 0;
    test_must(retex_set_checksum(set, 2, &err), &err);
    for (int i = 0; i < set->nparts; i++)
        assert_int_equal(set->parts[i].crc, read->parts[i].crc);
    retex_image_free(&set->parts[1].image);
    assert_int_equal(retex_set_checksum(set, 1, &err), RETEX_EINVAL);
    retex_set_close(&set);
    retex_set_close(&read);
}

/* What is beyond the largest half, 65504, is stored as that. */
static void test_large_halves(void **state)
{
    (void)state;
    float large[2] = {1e9f, -1e9f}, row[4 * 64];
    const RetexPart part = {.type = RETEX_HALF, .image = {.pixels = large, .width = 2, .height = 1, .channels = 1}};
    stored_row(&part, 0, row);
    assert_true(row[0] == 65504 && row[1] == -65504);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_set_there_and_back),
        cmocka_unit_test(test_footprints_there_and_back),
        cmocka_unit_test(test_samples_there_and_back),
        cmocka_unit_test(test_stream_through_a_pipe),
        cmocka_unit_test(test_references_follow_when_parts_go),
        cmocka_unit_test(test_names_are_checked),
        cmocka_unit_test(finishes_are_numbered_from_1),
        cmocka_unit_test(wrong_mixtures_are_not_written),
        cmocka_unit_test(textures_are_lifted_by_target),
        cmocka_unit_test(sets_with_textures_are_not_packed),
        cmocka_unit_test(test_samples_of_another_set),
        cmocka_unit_test(test_stored_rows),
        cmocka_unit_test(test_stored_checksums),
        cmocka_unit_test(test_large_halves),
        cmocka_unit_test(test_description_there_and_back),
        cmocka_unit_test(test_elements_are_the_set_s),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
