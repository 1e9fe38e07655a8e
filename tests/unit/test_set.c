/* Sets and samples: there and back through files and pipes, checksums, manifests that lie, files that are damaged. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "exr_io.h"
#include "half.h"
#include "manifest.h"

static const char *const path = test_own_file;

/* Samples for some of a set's footprints: every other one, or those of the first target. */
static RetexSamples *make_samples(const RetexSet *set, int every)
{
    RetexSamples *samples = calloc(1, sizeof *samples);
    samples->width = set->width;
    samples->height = set->height;
    samples->ntargets = set->ntargets;
    samples->nimages = set->nfootprints;
    samples->images = calloc((size_t)set->nfootprints + 1, sizeof *samples->images);
    for (int i = 0; i < set->ntargets; i++) {
        snprintf(samples->target_names[i], sizeof samples->target_names[i], "%s", set->targets[i].name);
        snprintf(samples->textures[i], sizeof samples->textures[i],
                 "b\xfc"
                 "hne %d.jpg",
                 i);
    }
    for (int i = 0; i < set->nfootprints; i++) {
        samples->footprint_target[i] = set->footprints[i].target;
        samples->footprint_hit[i] = set->footprints[i].hit;
        if (every && i % every == 0)
            test_random_image(&samples->images[i], set->width, set->height, 3, (uint32_t)i + 50, 0, 1);
    }
    return samples;
}

static void expect_equal_pixels(const RetexImage *want, const RetexImage *got, RetexPixelType type)
{
    assert_true(want->width == got->width && want->height == got->height && want->channels == got->channels);
    const size_t count = retex_image_index(want, 0, want->height);
    for (size_t i = 0; i < count; i++) {
        float value = want->pixels[i];
        if (type == RETEX_HALF) {
            uint16_t half;
            retex_half_from_float(&half, &value, 1);
            retex_half_to_float(&value, &half, 1);
        }
        assert_true(value == got->pixels[i]);
    }
}

static void expect_equal_part(const RetexSet *a, int part_a, const RetexSet *b, int part_b)
{
    assert_true((part_a < 0) == (part_b < 0));
    if (part_a < 0)
        return;
    assert_string_equal(a->parts[part_a].name, b->parts[part_b].name);
    assert_string_equal(a->parts[part_a].letters, b->parts[part_b].letters);
    assert_int_equal(a->parts[part_a].type, b->parts[part_b].type);
    assert_int_equal(a->parts[part_a].crc, b->parts[part_b].crc);
    expect_equal_pixels(&a->parts[part_a].image, &b->parts[part_b].image, a->parts[part_a].type);
}

static void expect_equal_terms(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nterms, b->nterms);
    for (int i = 0; i < a->nterms; i++) {
        assert_int_equal(a->terms[i].kind, b->terms[i].kind);
        assert_int_equal(a->terms[i].nfactors, b->terms[i].nfactors);
        for (int f = 0; f < a->terms[i].nfactors; f++)
            assert_int_equal(a->terms[i].factors[f], b->terms[i].factors[f]);
        expect_equal_part(a, a->terms[i].radiance, b, b->terms[i].radiance);
    }
}

static void expect_equal_mixtures(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nmixtures, b->nmixtures);
    for (int i = 0; i < a->nmixtures; i++) {
        const RetexMixture *ma = &a->mixtures[i], *mb = &b->mixtures[i];
        assert_int_equal(ma->nshares, mb->nshares);
        for (int k = 0; k < ma->nshares; k++) {
            assert_int_equal(ma->shares[k].footprint, mb->shares[k].footprint);
            expect_equal_part(a, ma->shares[k].weight, b, mb->shares[k].weight);
        }
    }
}

static void expect_equal_sets(const RetexSet *a, const RetexSet *b)
{
    assert_true(a->width == b->width && a->height == b->height && a->orders == b->orders && a->spp == b->spp);
    assert_true(a->max_depth == b->max_depth && a->seed == b->seed && a->strict_paper == b->strict_paper);
    assert_int_equal(a->id, b->id);
    assert_true(a->folded == b->folded && a->folded_white == b->folded_white);
    assert_string_equal(a->layout, b->layout);
    assert_string_equal(a->filter, b->filter);
    assert_string_equal(a->scene, b->scene);
    assert_string_equal(a->generator, b->generator);
    assert_int_equal(a->ntargets, b->ntargets);
    for (int i = 0; i < a->ntargets; i++) {
        RetexTarget ta = a->targets[i], tb = b->targets[i];
        assert_string_equal(ta.name, tb.name);
        assert_string_equal(ta.idents, tb.idents);
        expect_equal_part(a, ta.original, b, tb.original);
        assert_memory_equal(ta.periodic, tb.periodic, sizeof ta.periodic);
        assert_memory_equal(ta.uv_min, tb.uv_min, sizeof ta.uv_min);
        assert_memory_equal(ta.uv_max, tb.uv_max, sizeof ta.uv_max);
        assert_memory_equal(ta.original_min, tb.original_min, sizeof ta.original_min);
        assert_memory_equal(ta.original_max, tb.original_max, sizeof ta.original_max);
        assert_memory_equal(ta.mean_albedo, tb.mean_albedo, sizeof ta.mean_albedo);
        assert_memory_equal(ta.uv_scale, tb.uv_scale, sizeof ta.uv_scale);
        assert_true(ta.share == tb.share);
    }
    assert_int_equal(a->nparts, b->nparts);
    for (int i = 0; i < a->nparts; i++)
        expect_equal_part(a, i, b, i);
    assert_int_equal(a->nfootprints, b->nfootprints);
    for (int i = 0; i < a->nfootprints; i++)
        assert_memory_equal(&a->footprints[i], &b->footprints[i], sizeof a->footprints[i]);
    expect_equal_mixtures(a, b);
    expect_equal_terms(a, b);
}

static void expect_equal_samples(const RetexSamples *a, const RetexSamples *b)
{
    assert_true(a->width == b->width && a->height == b->height);
    assert_int_equal(a->nimages, b->nimages);
    assert_int_equal(a->ntargets, b->ntargets);
    for (int i = 0; i < a->ntargets; i++) {
        assert_string_equal(a->target_names[i], b->target_names[i]);
        assert_string_equal(b->textures[i], i ? "b?hne 1.jpg" : "b?hne 0.jpg"); /* JSON is UTF-8 */
    }
    for (int i = 0; i < a->nimages; i++) {
        assert_int_equal(a->footprint_target[i], b->footprint_target[i]);
        assert_int_equal(a->footprint_hit[i], b->footprint_hit[i]);
        assert_true(!a->images[i].pixels == !b->images[i].pixels);
        if (a->images[i].pixels)
            expect_equal_pixels(&a->images[i], &b->images[i], RETEX_FLOAT);
    }
}

static void test_set_there_and_back(void **state)
{
    (void)state;
    for (int compress = 0; compress < 2; compress++) {
        RetexSet *set = test_set(70, 45, 9), *back;
        RetexSamples *none;
        RetexStoreParams params = RETEX_STORE_INIT;
        RetexError err = {0};
        params.compress = compress;
        params.nthreads = 3;
        set->seed = 4000000000u;
        retex_set_identify(set);
        assert_int_not_equal(set->id, 0);
        set->folded = 1.0 / 3;
        strcpy(set->scene, "k\xc3\xbc"
                           "che.pov");
        test_must(retex_set_write(set, NULL, path, &params, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        test_must(retex_set_read(path, &back, &none, 2, &err), &err);
        assert_null(none);
        expect_equal_sets(set, back);
        /* what was read can be added to and written again */
        test_must(retex_set_add_part(back, "more", "A", RETEX_FLOAT, 0, 0, NULL, &err), &err);
        test_must(retex_set_add_part(back, "and-more", "A", RETEX_FLOAT, 3, 2, NULL, &err), &err);
        test_must(retex_set_write(back, NULL, path, &params, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        assert_int_equal(retex_set_read(path, NULL, &none, 2, &err), RETEX_EFORMAT);
        retex_set_close(&set);
        retex_set_close(&back);
        retex_set_close(&back);
        retex_set_close(NULL);
    }
}

/* What layout footprints has and paper has not: kinds, spreads with a correlation, how large a unit of UV is,
 * mixtures. */
static void test_footprints_there_and_back(void **state)
{
    (void)state;
    RetexSet *set = test_set(30, 20, 7), *back;
    RetexError err = {0};
    test_make_footprints(set);
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    test_must(retex_set_check(path, 0, &err), &err);
    test_must(retex_set_read(path, &back, NULL, 0, &err), &err);
    expect_equal_sets(set, back);
    retex_set_close(&set);
    retex_set_close(&back);
}

static void test_samples_there_and_back(void **state)
{
    (void)state;
    RetexSet *set = test_set(40, 30, 2), *none;
    RetexError err = {0};
    for (int every = 0; every < 3; every++) {
        RetexSamples *samples = make_samples(set, every), *back;
        test_must(retex_samples_check(samples, set, &err), &err);
        test_must(retex_set_write(NULL, samples, path, NULL, &err), &err);
        test_must(retex_set_check(path, 0, &err), &err);
        test_must(retex_set_read(path, &none, &back, 0, &err), &err);
        assert_null(none);
        expect_equal_samples(samples, back);
        assert_int_equal(retex_set_read(path, &none, NULL, 0, &err), RETEX_EFORMAT);
        retex_samples_close(&samples);
        retex_samples_close(&back);
        retex_samples_close(&back);
    }
    retex_set_close(&set);
}

static void expect_stream(const RetexSet *set, const RetexSamples *samples, const RetexSet *back)
{
    expect_equal_terms(set, back);
    expect_equal_mixtures(set, back);
    expect_equal_part(set, 0, back, 0);
    assert_int_equal(back->nfootprints, set->nfootprints);
    for (int i = 0; i < set->nfootprints; i++) {
        if (samples->images[i].pixels) {
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
    RetexSamples *samples = make_samples(set, 2), *samples_back;
    RetexError err = {0};
    int ends[2], status = 1;
    /* checksums of all parts, to compare with */
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
        dup2(ends[1], 1);
        close(ends[0]);
        close(ends[1]);
        _exit(retex_set_write(set, samples, "-", NULL, &err) != 0);
    }
    const int kept = dup(0);
    dup2(ends[0], 0);
    close(ends[0]);
    close(ends[1]);
    const int code = retex_set_read("-", &back, &samples_back, 0, &err);
    dup2(kept, 0);
    close(kept);
    waitpid(child, &status, 0);
    test_must(code, &err);
    assert_int_equal(status, 0);
    expect_stream(set, samples, back);
    expect_equal_samples(samples, samples_back);
    test_must(retex_samples_check(samples_back, back, &err), &err);
    retex_set_close(&set);
    retex_set_close(&back);
    retex_samples_close(&samples);
    retex_samples_close(&samples_back);
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
    RetexTerm term = {.kind = RETEX_TERM_DEP, .nfactors = 1, .factors = {set->nfootprints}};
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    term.factors[0] = RETEX_MIXTURE(0); /* it has none */
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    term.factors[0] = 0, term.nfactors = RETEX_MAX_FACTORS + 1;
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    term.nfactors = -1;
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);

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
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err); /* and it is a set that can be read */
    retex_set_close(&set);
    test_must(retex_set_read(path, &set, NULL, 0, &err), &err);
    assert_int_equal(list_references(set, after), count);
    assert_memory_equal(before, after, sizeof before);
    retex_set_close(&set);
}

static void test_samples_of_another_set(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1), *other = test_set(16, 17, 1);
    RetexSamples *samples = make_samples(set, 1);
    RetexError err = {0};
    assert_int_equal(retex_samples_check(samples, other, &err), RETEX_EINVAL);
    retex_set_close(&other);
    other = test_set(16, 16, 1); /* the same shape, but another render */
    samples->set_id = 7, other->id = 8;
    assert_int_equal(retex_samples_check(samples, other, &err), RETEX_EINVAL);
    assert_non_null(strstr(err.message, "another render"));
    other->id = 7;
    test_must(retex_samples_check(samples, other, &err), &err);
    assert_int_equal(retex_samples_check(samples, set, &err), 0);
    strcpy(samples->target_names[0], "Ceiling");
    assert_int_equal(retex_samples_check(samples, set, &err), RETEX_EINVAL);
    strcpy(samples->target_names[0], set->targets[0].name);
    samples->footprint_hit[1]++;
    assert_int_equal(retex_samples_check(samples, set, &err), RETEX_EINVAL);
    retex_samples_close(&samples);
    retex_set_close(&set);
    retex_set_close(&other);
}

static int read_manifest(const char *json, char *message)
{
    RetexSet *set;
    RetexSamples *samples;
    RetexSamplePart *parts;
    RetexError err = {0};
    const int status = retex_manifest_read(json, "x.exr", &set, &samples, &parts, &err);
    strcpy(message, err.message);
    retex_set_close(&set);
    retex_samples_close(&samples);
    free(parts);
    return status;
}

/* json with the first `from` behind `after` replaced; freed by the caller. */
static char *edited(const char *json, const char *after, const char *from, const char *to)
{
    char *copy = malloc(strlen(json) + strlen(to) + 1);
    const char *start = strstr(json, after);
    assert_non_null(start);
    start = strstr(start, from);
    assert_non_null(start);
    memcpy(copy, json, (size_t)(start - json));
    sprintf(copy + (start - json), "%s%s", to, start + strlen(from));
    return copy;
}

/* In a manifest the first `from` behind `after` becomes `to`: how reading it ends, and part of the message. */
typedef struct ManifestCase {
    const char *after, *from, *to;
    int code;
    const char *says;
} ManifestCase;

static void check_manifests(const char *json, const ManifestCase *cases, size_t count)
{
    char message[1024];
    assert_int_equal(read_manifest(json, message), 0);
    for (size_t i = 0; i < count; i++) {
        char *copy = edited(json, cases[i].after, cases[i].from, cases[i].to);
        const int status = read_manifest(copy, message);
        if (status != cases[i].code || !strstr(message, cases[i].says))
            fail_msg("case %zu: %d \"%s\"", i, status, message);
        free(copy);
    }
}

/* Characters replaced at random: it may be anything, but no crash. */
static void turn_inside_out(char *json)
{
    char message[1024];
    const size_t length = strlen(json);
    uint32_t seed = 1;
    for (int i = 0; i < 3000; i++) {
        const size_t place = (size_t)(test_random(&seed) * (double)length);
        const char old = json[place];
        json[place] = i % 3 == 0 ? 0 : (char)(32 + test_random(&seed) * 90);
        read_manifest(json, message);
        json[place] = old;
    }
}

static void test_manifests_that_lie(void **state)
{
    (void)state;
    static const ManifestCase cases[] = {
        {"", "{\"retex\":1", "{\"retex\":3", RETEX_EUNSUPPORTED, "version 3"},
        {"", "{\"retex\":1", "{\"retex\":\"1\"", RETEX_EFORMAT, "no version"},
        {"", "{\"retex\":1", "{\"retex\":1,\"later\":[{}]", 0, ""},
        {"", "{\"retex\":1", "[\"retex\":1", RETEX_EFORMAT, "no JSON"},
        {"", "\"set\"", "\"sett\"", RETEX_EFORMAT, "unknown kind"},
        {"", "\"width\":", "\"width\":7", RETEX_EFORMAT, "another size"},
        {"", "\"width\":", "\"width\":-", RETEX_EFORMAT, "\"width\""},
        {"", "\"height\":", "\"height\":99999", RETEX_EFORMAT, "\"height\""},
        {"", "\"layout\":\"", "\"layout\":\"0123456789abcdef", RETEX_EFORMAT, "\"layout\""},
        {"", "\"orders\":", "\"orders\":-", RETEX_EFORMAT, "\"orders\""},
        {"", "\"seed\":", "\"seed\":99999999999", RETEX_EFORMAT, "\"seed\""},
        {"", "\"folded\":", "\"folded\":null,\"x\":", RETEX_EFORMAT, "\"folded\""},
        {"", "\"folded_white\":", "\"folded_white\":\"0\",\"x\":", RETEX_EFORMAT, "\"folded_white\""},
        {"", "\"folded_white\":", "\"x\":", 0, ""},
        {"\"targets\"", "\"periodic\":[", "\"periodic\":[7,", RETEX_EFORMAT, "\"periodic\""},
        {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1,", RETEX_EFORMAT, "\"uv_scale\""},
        {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1],\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
        {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1,\"2\"],\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
        {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":7,\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
        {"\"targets\"", "\"uv_scale\":[", "\"x\":[", 0, ""},
        {"\"footprints\"", "\"target\":", "\"target\":5", RETEX_EFORMAT, "\"target\""},
        {"\"footprints\"", "\"hit\":", "\"hit\":-", RETEX_EFORMAT, "\"hit\""},
        {"\"footprints\"", "\"uv\":\"", "\"uv\":\"no", RETEX_EFORMAT, "\"uv\""},
        {"\"footprints\"", "\"uv\":\"", "\"uv\":null,\"x\":\"", 0, ""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"hitt", RETEX_EFORMAT, "unknown kind \"hitt\""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"dep", RETEX_EFORMAT, "unknown kind \"dep\""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"", RETEX_EFORMAT, "unknown kind \"\""},
        {"\"footprints\"", "\"kind\":\"", "\"kind\":\"0123456789abcdef", RETEX_EFORMAT, "\"kind\""},
        {"\"footprints\"", "\"kind\":\"", "\"kind\":1,\"x\":\"", RETEX_EFORMAT, "\"kind\""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"sharp", 0, ""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"broad", 0, ""},
        {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"later", 0, ""},
        {"\"footprints\"", "\"kind\":\"", "\"x\":\"", 0, ""},
        {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"RGB\"", 0, ""}, /* spread with the correlation */
        {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"RGBA\"", RETEX_EFORMAT, "4 channels instead of 2"},
        {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"R\"", RETEX_EFORMAT, "1 channels instead of 2"},
        {"\"terms\"", "\"kind\":\"", "\"kind\":\"x", RETEX_EFORMAT, "unknown kind"},
        {"\"terms\"", "\"radiance\":\"", "\"radiance\":null,\"x\":\"", RETEX_EFORMAT, "\"radiance\""},
        {"\"terms\"", "\"factors\":[", "\"factors\":[600", RETEX_EFORMAT, "factor"},
        {"\"terms\"", "\"factors\":[", "\"factors\":[-1", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "\"factors\":[0", "\"factors\":[0.5", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "\"factors\":[0", "\"factors\":[null", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "\"factors\":[0", "\"factors\":[0,0,0,0,0,0,0,0,0,0,0,0", 0, ""},
        {"\"terms\"", "\"factors\":[0", "\"factors\":[0,0,0,0,0,0,0,0,0,0,0,0,0", RETEX_EFORMAT, "at most 12"},
        {"", "\"mixtures\":[]", "\"x\":[]", 0, ""}, /* may be left out */
        {"", "\"mixtures\":[]", "\"mixtures\":{}", RETEX_EFORMAT, "no list \"mixtures\""},
        {"", "\"mixtures\":[]", "\"mixtures\":null", RETEX_EFORMAT, "no list \"mixtures\""},
        {"\"parts\"", "\"name\":\"", "\"name\":\"a b", RETEX_EFORMAT, "named"},
        {"\"parts\"", "\"letters\":\"", "\"letters\":\"a", RETEX_EFORMAT, "channels"},
        {"\"parts\"", "\"type\":\"", "\"type\":\"x", RETEX_EFORMAT, "type"},
        {"\"parts\"", "\"crc32\":\"", "\"crc32\":\"0", RETEX_EFORMAT, "checksum"},
        {"\"parts\"", "\"parts\":[", "\"parts\":[],\"x\":[", RETEX_EFORMAT, "no parts"},
    };
    RetexSet *set = test_set(16, 16, 1);
    char *json;
    RetexError err = {0};
    test_must(retex_set_manifest(set, NULL, &json, &err), &err);
    check_manifests(json, cases, sizeof cases / sizeof cases[0]);
    turn_inside_out(json);
    free(json);
    set->folded = __builtin_nan("");
    assert_int_equal(retex_set_manifest(set, NULL, &json, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

static void test_mixtures_that_lie(void **state)
{
    (void)state;
    static const ManifestCase cases[] = {
        {"", "\"mixtures\":", "\"x\":", RETEX_EFORMAT, "no footprint and no mixture"},
        {"", "\"mixtures\":[", "\"mixtures\":[],\"x\":[", RETEX_EFORMAT, "no footprint and no mixture"},
        {"", "\"mixtures\":[", "\"mixtures\":[7,", RETEX_EFORMAT, "a mixture that is no list of at most 16"},
        {"", "\"mixtures\":[", "\"mixtures\":[{},", RETEX_EFORMAT, "a mixture that is no list of at most 16"},
        {"", "\"mixtures\":[", "\"mixtures\":[[],", RETEX_EINVAL, "1 to 16 shares, not 0"},
        {"", "\"mixtures\":[[", "\"mixtures\":[[7,", RETEX_EFORMAT, "\"footprint\""},
        {"", "\"mixtures\":[[", "\"mixtures\":[[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,", RETEX_EFORMAT,
         "a mixture that is no list of at most 16"},
        {"", "\"mixtures\":[",
         "\"mixtures\":[0,1,2,3,4,5,6,7,8,9,0,1,2,3,4,5,6,7,8,9,0,1,2,3,4,5,6,7,8,9,0,1,2,3,4,5,6,7,8,9,",
         RETEX_EFORMAT, "no list \"mixtures\" of at most 41"},
        {"\"mixtures\"", "\"footprint\":2", "\"footprint\":5", 0, ""},
        {"\"mixtures\"", "\"footprint\":2", "\"footprint\":6", RETEX_EFORMAT, "\"footprint\" from 0 to 5"},
        {"\"mixtures\"", "\"footprint\":2", "\"footprint\":-1", RETEX_EFORMAT, "\"footprint\""},
        {"\"mixtures\"", "\"footprint\":2", "\"footprint\":2.5", RETEX_EFORMAT, "\"footprint\""},
        {"\"mixtures\"", "\"footprint\":2", "\"x\":2", RETEX_EFORMAT, "\"footprint\""},
        {"\"mixtures\"", "\"share-0\"", "\"depth\"", 0, ""},
        {"\"mixtures\"", "\"share-0\"", "\"beauty\"", 0, ""}, /* colour by colour */
        {"\"mixtures\"", "\"share-2\"", "\"depth\"", 0, ""},
        {"\"mixtures\"", "\"share-0\"", "\"two\"", RETEX_EFORMAT, "2 channels instead of 1"},
        {"\"mixtures\"", "\"share-2\"", "\"two\"", RETEX_EFORMAT, "2 channels instead of 1"},
        {"\"mixtures\"", "\"share-0\"", "\"small\"", RETEX_EFORMAT, "\"weight\" a part that is neither"},
        {"\"mixtures\"", "\"share-2\"", "\"small-rgb\"", RETEX_EFORMAT, "\"weight\" a part that is neither"},
        {"\"mixtures\"", "\"share-0\"", "\"share-9\"", RETEX_EFORMAT, "\"weight\""},
        {"\"mixtures\"", "\"share-0\"", "null", RETEX_EFORMAT, "\"weight\""},
        {"\"mixtures\"", "\"weight\"", "\"x\"", RETEX_EFORMAT, "\"weight\""},
        {"\"terms\"", "-1", "-2", 0, ""},
        {"\"terms\"", "-1", "-3", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "-1", "-2147483648", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "-1", "-4294967297", RETEX_EFORMAT, "no footprint and no mixture"},
        {"\"terms\"", "-1", "-1.0", RETEX_EFORMAT, "no footprint and no mixture"},
    };
    RetexSet *set = test_set(16, 16, 1);
    char *json;
    RetexError err = {0};
    test_make_footprints(set);
    test_must(retex_set_add_part(set, "small", "R", RETEX_HALF, 3, 2, NULL, &err), &err);
    test_must(retex_set_add_part(set, "small-rgb", "RGB", RETEX_HALF, 3, 2, NULL, &err), &err);
    test_must(retex_set_add_part(set, "two", "RG", RETEX_HALF, 0, 0, NULL, &err), &err);
    test_must(retex_set_manifest(set, NULL, &json, &err), &err);
    check_manifests(json, cases, sizeof cases / sizeof cases[0]);
    turn_inside_out(json);
    free(json);
    retex_set_close(&set);
}

/* Nor is one written. */
static void test_mixtures_that_are_wrong(void **state)
{
    (void)state;
    static const int nshares[] = {-1, 0, RETEX_SHARES_MAX + 1}, nmixtures[] = {-1, RETEX_MIXTURES_MAX + 1};
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    test_make_footprints(set);
    RetexMixture *mixture = &set->mixtures[1];
    const RetexMixture kept = *mixture;
    const int weights[] = {-1, set->nparts}, footprints[] = {-1, set->nfootprints};
    for (int k = 0; k < 2; k++) {
        mixture->shares[2].weight = weights[k];
        assert_int_equal(retex_set_write(set, NULL, path, NULL, &err), RETEX_EINVAL);
        *mixture = kept;
        mixture->shares[2].footprint = footprints[k];
        assert_int_equal(retex_set_write(set, NULL, path, NULL, &err), RETEX_EINVAL);
        *mixture = kept;
        set->nmixtures = nmixtures[k];
        assert_int_equal(retex_set_write(set, NULL, path, NULL, &err), RETEX_EINVAL);
        set->nmixtures = 2;
    }
    for (int k = 0; k < 3; k++) {
        mixture->nshares = nshares[k];
        assert_int_equal(retex_set_write(set, NULL, path, NULL, &err), RETEX_EINVAL);
    }
    *mixture = kept;
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    set->terms[1].nfactors = RETEX_MAX_FACTORS + 1;
    assert_int_equal(retex_set_write(set, NULL, path, NULL, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

static unsigned char *load(size_t *bytes)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    *bytes = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*bytes);
    assert_int_equal(fread(data, 1, *bytes, file), *bytes);
    fclose(file);
    return data;
}

static void store(const unsigned char *data, size_t bytes)
{
    unlink(path); /* file systems flush a file that is truncated and written again */
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(data, 1, bytes, file), bytes);
    assert_int_equal(fclose(file), 0);
}

/* The pixels fill the second half of a file, and their checksums find every bit that is flipped in them; what they do
 * not find, in the heading of a chunk, has changed none. */
static void assert_pixels_survive(const RetexSet *whole)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_set_read(path, &set, NULL, 1, &err), &err);
    assert_int_equal(set->nparts, whole->nparts);
    for (int i = 0; i < set->nparts; i++) {
        const RetexImage *a = &set->parts[i].image, *b = &whole->parts[i].image;
        assert_int_equal(a->width, b->width);
        assert_int_equal(a->height, b->height);
        assert_int_equal(a->channels, b->channels);
        assert_memory_equal(a->pixels, b->pixels,
                            sizeof *a->pixels * (size_t)a->width * (size_t)a->height * (size_t)a->channels);
    }
    retex_set_close(&set);
}

static int read_anything(RetexError *err)
{
    RetexSet *set;
    RetexSamples *samples;
    const int status = retex_set_read(path, &set, &samples, 2, err);
    if (status) {
        assert_null(set);
        assert_null(samples);
        assert_true(err->message[0] != 0);
    }
    retex_set_close(&set);
    retex_samples_close(&samples);
    return status;
}

static void test_damaged_files(void **state)
{
    (void)state;
    for (int compress = 0; compress < 2; compress++) {
        RetexSet *set = test_set(20, 20, 6);
        RetexStoreParams params = RETEX_STORE_INIT;
        RetexError err = {0};
        uint32_t seed = 11;
        size_t bytes;
        params.compress = compress;
        test_must(retex_set_write(set, NULL, path, &params, &err), &err);
        unsigned char *data = load(&bytes);
        for (size_t length = 0; length < bytes; length += 1 + length / 40) {
            store(data, length);
            assert_int_equal(read_anything(&err), RETEX_EFORMAT);
            assert_int_equal(retex_set_check(path, 1, &err), RETEX_EFORMAT);
        }
        RetexSet *whole = NULL;
        store(data, bytes);
        test_must(retex_set_read(path, &whole, NULL, 1, &err), &err);
        int unnoticed = 0;
        for (int i = 0; i < 1200; i++) {
            const size_t range = i % 2 ? bytes : 8000;
            const size_t place = (size_t)(test_random(&seed) * (double)range) % bytes;
            const unsigned char old = data[place];
            data[place] ^= (unsigned char)(1 << i % 8);
            store(data, bytes);
            unnoticed += read_anything(&err) == 0;
            if (retex_set_check(path, 1, &err) == 0 && place > bytes / 2)
                assert_pixels_survive(whole);
            data[place] = old;
        }
        retex_set_close(&whole);
        assert_true(unnoticed < 1200);
        free(data);
        retex_set_close(&set);
    }
}

/* What rows are as they are stored, and their checksums, tell of the same samples as a file. */
static void test_stored_rows(void **state)
{
    (void)state;
    RetexError err = {0};
    RetexSet *set = test_set(37, 19, 5), *read;
    test_must(retex_set_write(set, NULL, path, NULL, &err), &err);
    test_must(retex_set_read(path, &read, NULL, 0, &err), &err);
    int part = 0;
    while (set->parts[part].type != RETEX_HALF)
        part++;
    set->parts[part].image.pixels[0] = 1e9f;
    for (int i = 0; i < set->nparts; i++)
        set->parts[i].crc = 0;
    test_must(retex_set_checksum(set, 2, &err), &err);
    for (int i = 0; i < set->nparts; i++) {
        const RetexPart *of = &set->parts[i];
        const int count = of->image.width * of->image.channels;
        uint16_t halves[4 * 64];
        float floats[4 * 64];
        assert_int_equal(of->crc == read->parts[i].crc, i != part);
        retex_part_stored_row(of, 0, of->type == RETEX_HALF ? (void *)halves : floats);
        if (of->type == RETEX_HALF)
            retex_half_to_float(floats, halves, (size_t)count);
        if (i == part)
            assert_true(floats[0] == 65504);
        assert_memory_equal(floats + (i == part), read->parts[i].image.pixels + (i == part),
                            (size_t)(count - (i == part)) * sizeof(float));
    }
    retex_image_free(&set->parts[part].image);
    assert_int_equal(retex_set_checksum(set, 1, &err), RETEX_EINVAL);
    retex_set_close(&set);
    retex_set_close(&read);
}

static void test_what_is_no_set(void **state)
{
    (void)state;
    RetexImage image = {0};
    RetexError err = {0};
    char exr[80];
    store((const unsigned char *)"hello", 5);
    assert_int_equal(read_anything(&err), RETEX_EFORMAT);
    store((const unsigned char *)"", 0);
    assert_int_equal(read_anything(&err), RETEX_EFORMAT);
    snprintf(exr, sizeof exr, "%s.exr", path);
    test_random_image(&image, 8, 8, 3, 1, 0, 1);
    test_must(retex_image_write(&image, exr, NULL, &err), &err);
    RetexSet *set;
    assert_int_equal(retex_set_read(exr, &set, NULL, 0, &err), RETEX_EFORMAT);
    assert_non_null(strstr(err.message, "is not a set (no `retex` attribute)"));
    unlink(exr);
    assert_int_equal(retex_set_read("/nowhere.exr", &set, NULL, 0, &err), RETEX_EIO);
    assert_int_equal(retex_set_read("/tmp", &set, NULL, 0, &err), RETEX_EIO);
    assert_int_equal(retex_set_read(path, NULL, NULL, 0, &err), RETEX_EINVAL);
    assert_int_equal(retex_set_write(NULL, NULL, path, NULL, &err), RETEX_EINVAL);
    retex_image_free(&image);
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
        cmocka_unit_test(test_samples_of_another_set),
        cmocka_unit_test(test_manifests_that_lie),
        cmocka_unit_test(test_mixtures_that_lie),
        cmocka_unit_test(test_mixtures_that_are_wrong),
        cmocka_unit_test(test_damaged_files),
        cmocka_unit_test(test_stored_rows),
        cmocka_unit_test(test_what_is_no_set),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
