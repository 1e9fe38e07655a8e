/* Sets and samples: checksums, inconsistent manifests, damaged files. */
#include "lib_folder.h"
#include "lib_sets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "exr/io.h"
#include "base/half.h"
#include "set/manifest.h"

static const char *const path = test_own_file;

static int read_manifest(const char *json, char *message)
{
    RetexSet *set;
    RetexError err = {0};
    const int status = retex_manifest_read(json, "x.exr", &set, NULL, &err);
    strcpy(message, err.message);
    retex_set_close(&set);
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
        retex_manifest_seal(copy);
        const int status = read_manifest(copy, message);
        if (status != cases[i].code || !strstr(message, cases[i].says))
            fail_msg("case %zu: %d \"%s\"", i, status, message);
        free(copy);
    }
}

/* Any bit of it, digits of the checksum and of the version too, and any end that is missing. */
static void test_damage_to_a_manifest_is_seen(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1);
    RetexError err = {0};
    char *json, message[1024];
    test_make_footprints(set);
    test_must(retex_set_manifest(set, &json, &err), &err);
    assert_int_equal(read_manifest(json, message), 0);
    for (size_t at = 0; json[at]; at++) {
        const char kept = json[at];
        for (int bit = 0; bit < 8; bit++) {
            json[at] = (char)(kept ^ 1 << bit);
            assert_int_equal(read_manifest(json, message), RETEX_EFORMAT);
        }
        for (int digit = 0; digit < 10; digit++) {
            json[at] = (char)('0' + digit);
            assert_true(json[at] == kept || read_manifest(json, message) == RETEX_EFORMAT);
        }
        json[at] = 0;
        assert_int_equal(read_manifest(json, message), RETEX_EFORMAT);
        json[at] = kept;
    }
    assert_int_equal(read_manifest(json, message), 0);
    free(json);
    retex_set_close(&set);
}

/* Characters replaced at random, with the right checksum: it may be anything, but no crash. */
static void turn_inside_out(const char *sealed)
{
    const size_t length = strlen(sealed);
    char message[1024], *json = malloc(length + 1);
    uint32_t seed = 1;
    memcpy(json, sealed, length + 1);
    for (int i = 0; i < 3000; i++) {
        const size_t place = (size_t)(test_random(&seed) * (double)length);
        const char old = json[place];
        json[place] = i % 3 == 0 ? 0 : (char)(32 + test_random(&seed) * 90);
        retex_manifest_seal(json);
        read_manifest(json, message);
        json[place] = old;
    }
    free(json);
}

#define FOOTPRINTS_11                                                                                                  \
    "{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},"     \
    "{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},{\"footprint\":0},"

#define FURTHER(hits, ratio) "\"further\":{\"hits\":" #hits ",\"ratio\":[" ratio "]},"
#define FINISHES(names, finish) "\"finishes\":[" names "],\"finish\":" finish ","

/* Of a set with targets, footprints and a lamp. */
static const ManifestCase lies[] = {
    {"", "{\"retex\":1", "{\"retex\":2", RETEX_EUNSUPPORTED, "version 2; this program reads version 1: render again"},
    {"", "{\"retex\":1", "{\"retex\":\"1\"", RETEX_EFORMAT, "no version"},
    {"", "{\"retex\":1", "{\"retex\":0", RETEX_EFORMAT, "no version"},
    {"", "{\"retex\":1", "{\"retex\":1,\"later\":[{}]", RETEX_EFORMAT, "its checksum is missing"},
    {"", "{\"retex\":1", "{ \"retex\":1", RETEX_EFORMAT, "its checksum is missing"},
    {"", "\"crc32\"", "\"crc33\"", RETEX_EFORMAT, "its checksum is missing"},
    {"", "\"kind\"", "\"later\":[{}],\"kind\"", 0, ""},
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
    {"", "\"strict_paper\"", FURTHER(1, "0,1,2") "\"strict_paper\"", 0, ""},
    {"", "\"strict_paper\"", FURTHER(0, "0,1,2") "\"strict_paper\"", RETEX_EFORMAT, "\"hits\" from 1 to 255"},
    {"", "\"strict_paper\"", FURTHER(256, "0,1,2") "\"strict_paper\"", RETEX_EFORMAT, "\"hits\""},
    {"", "\"strict_paper\"", FURTHER(1, "0,1") "\"strict_paper\"", RETEX_EFORMAT, "\"ratio\""},
    {"", "\"strict_paper\"", FURTHER(1, "0,1,2.5") "\"strict_paper\"", RETEX_EFORMAT, "ratio of further hits"},
    {"", "\"strict_paper\"", FURTHER(1, "0,-1,2") "\"strict_paper\"", RETEX_EFORMAT, "ratio of further hits"},
    {"", "\"strict_paper\"", FURTHER(1, "0,null,2") "\"strict_paper\"", RETEX_EFORMAT, "\"ratio\""},
    {"", "\"strict_paper\"", "\"further\":7,\"strict_paper\"", RETEX_EFORMAT, "\"ratio\""},
    {"\"targets\"", "\"periodic\":[", "\"periodic\":[7,", RETEX_EFORMAT, "\"periodic\""},
    {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1,", RETEX_EFORMAT, "\"uv_scale\""},
    {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1],\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
    {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":[1,\"2\"],\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
    {"\"targets\"", "\"uv_scale\":[", "\"uv_scale\":7,\"x\":[", RETEX_EFORMAT, "\"uv_scale\""},
    {"\"targets\"", "\"uv_scale\":[", "\"x\":[", 0, ""},
    {"\"targets\"", "\"uv_scale\":", FINISHES("\"a\",\"b\"", "1") "\"uv_scale\":", 0, ""},
    {"\"targets\"", "\"uv_scale\":", FINISHES("\"a\",\"b\"", "2") "\"uv_scale\":", 0, ""},
    {"\"targets\"", "\"uv_scale\":", FINISHES("\"a\",\"b\"", "0") "\"uv_scale\":", RETEX_EFORMAT, "\"finish\""},
    {"\"targets\"", "\"uv_scale\":", FINISHES("\"a\",\"b\"", "3") "\"uv_scale\":", RETEX_EFORMAT, "\"finish\""},
    {"\"targets\"", "\"uv_scale\":", FINISHES("\"a\",7", "1") "\"uv_scale\":", RETEX_EFORMAT, "proper name"},
    {"\"footprints\"", "\"target\":", "\"target\":5", RETEX_EFORMAT, "\"target\""},
    {"\"footprints\"", "\"hit\":", "\"hit\":-", RETEX_EFORMAT, "\"hit\""},
    {"\"footprints\"", "\"uv\":\"", "\"uv\":\"no", RETEX_EFORMAT, "\"uv\""},
    {"\"footprints\"", "\"uv\":\"", "\"uv\":null,\"x\":\"", 0, ""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"hitt", RETEX_EUNSUPPORTED,
     "kind that this program does not know: \"hitt\""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"dep", RETEX_EUNSUPPORTED, "\"dep\""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"", RETEX_EUNSUPPORTED, "\"\""},
    {"\"footprints\"", "\"kind\":\"", "\"kind\":\"0123456789abcdef0123456789abcdef", RETEX_EUNSUPPORTED, "kind"},
    {"\"footprints\"", "\"kind\":\"", "\"kind\":1,\"x\":\"", RETEX_EFORMAT, "\"kind\""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"sharp", 0, ""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"broad", 0, ""},
    {"\"footprints\"", "\"kind\":\"hit", "\"kind\":\"interreflection", 0, ""},
    {"\"footprints\"", "\"kind\":\"", "\"x\":\"", 0, ""},
    {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"RGB\"", 0, ""}, /* spread with the correlation */
    {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"RGBA\"", RETEX_EFORMAT, "4 channels instead of 2"},
    {"\"parts\"", "\"letters\":\"RG\"", "\"letters\":\"R\"", RETEX_EFORMAT, "1 channels instead of 2"},
    {"\"terms\"", "\"role\":\"", "\"role\":\"x", RETEX_EUNSUPPORTED,
     "a role that this program does not know: \"xfull\""},
    {"\"terms\"", "\"role\":\"", "\"x\":\"", RETEX_EFORMAT, "\"role\""},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"picture\"", RETEX_EINVAL, "one term may be the picture"},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"correction\"", RETEX_EINVAL, "corrections, and only they"},
    {"\"terms\"", "\"target\":0", "\"target\":2", RETEX_EFORMAT, "\"target\""},
    {"\"terms\"", "\"target\":0", "\"target\":-1", RETEX_EFORMAT, "\"target\""},
    {"\"terms\"", "\"target\":0", "\"target\":null", 0, ""},
    {"\"terms\"", "\"radiance\":\"", "\"radiance\":null,\"x\":\"", RETEX_EFORMAT, "\"radiance\""},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"dep\",\"noise_weight\":0.75", 0, ""},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"dep\",\"noise_weight\":null", RETEX_EFORMAT, "\"noise_weight\""},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"dep\",\"noise_weight\":1e300", RETEX_EINVAL, "weight in noise"},
    {"\"terms\"", "\"role\":\"dep\"", "\"role\":\"dep\",\"noise_weight\":1e-9", RETEX_EINVAL, "weight in noise"},
    {"\"terms\"", "{\"footprint\":0}", "7", RETEX_EFORMAT, "a factor that names no kind"},
    {"\"terms\"", "{\"footprint\":0}", "{}", RETEX_EFORMAT, "a factor that names no kind"},
    {"\"terms\"", "{\"footprint\":0}", "{\"normal\":0}", RETEX_EUNSUPPORTED,
     "factor that this program does not know: \"normal\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":6}", RETEX_EFORMAT, "\"footprint\" from 0 to 5"},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":-1}", RETEX_EFORMAT, "\"footprint\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":0.5}", RETEX_EFORMAT, "\"footprint\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":0,\"quantity\":\"color\"}", 0, ""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":0,\"quantity\":\"further\"}", 0, ""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":0,\"quantity\":\"normal\"}", RETEX_EUNSUPPORTED,
     "quantity that this program does not know: \"normal\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"footprint\":0,\"quantity\":1}", RETEX_EFORMAT, "\"quantity\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"mixture\":0}", RETEX_EFORMAT, "\"mixture\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"image\":\"depth\"}", 0, ""},
    {"\"terms\"", "{\"footprint\":0}", "{\"image\":\"beauty\"}", RETEX_EINVAL, "the set's picture"},
    {"\"terms\"", "{\"footprint\":0}", "{\"image\":\"no\"}", RETEX_EFORMAT, "\"image\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"image\":null}", RETEX_EFORMAT, "\"image\""},
    {"\"terms\"", "{\"footprint\":0}", "{\"image\":\"original_Floor\"}", RETEX_EFORMAT, "neither of the set's size"},
    {"\"terms\"", "{\"footprint\":0}", "{\"parameter\":\"lamp\"}", 0, ""},
    {"\"terms\"", "{\"footprint\":0}", "{\"parameter\":\"no\"}", RETEX_EFORMAT, "parameter that is not there"},
    {"\"terms\"", "{\"footprint\":0}", "{\"parameter\":0}", RETEX_EFORMAT, "\"parameter\""},
    {"\"terms\"", "{\"footprint\":0}", FOOTPRINTS_11 "{\"footprint\":0}", 0, ""},
    {"\"terms\"", "{\"footprint\":0}", FOOTPRINTS_11 "{\"footprint\":0},{\"footprint\":0}", RETEX_EINVAL,
     "12 of them hits"},
    {"\"terms\"", "{\"footprint\":0}", FOOTPRINTS_11 "{},{},{},{},{},{}", RETEX_EFORMAT, "at most 16"},
    {"", "\"parameters\":[", "\"parameters\":7,\"x\":[", RETEX_EFORMAT, "\"parameters\""},
    {"", "\"parameters\":[", "\"x\":[", RETEX_EUNSUPPORTED, "no list of parameters"},
    {"\"parameters\"", "\"kind\":\"color\"", "\"kind\":\"gloss\"", RETEX_EUNSUPPORTED,
     "parameter that this program does not know: \"gloss\""},
    {"\"parameters\"", "\"kind\":\"color\"", "\"kind\":\"correction\"", RETEX_EINVAL, "lamp"},
    {"\"parameters\"", "\"target\":null", "\"target\":0", RETEX_EINVAL, "lamp"},
    {"\"parameters\"", "\"value\":[", "\"value\":[-", RETEX_EINVAL, "lamp"},
    {"\"parameters\"", "\"value\":[", "\"value\":[1e39,", RETEX_EFORMAT, "\"value\""},
    {"\"parameters\"", "\"value\":[", "\"value\":[null],\"x\":[", RETEX_EFORMAT, "\"value\""},
    {"\"parameters\"", "\"name\":\"lamp\"", "\"name\":\"\"", RETEX_EINVAL, "no name"},
    {"\"parameters\"", "{\"name\":\"lamp\"",
     "{\"name\":\"lamp\",\"kind\":\"color\",\"target\":null,\"value\":[1,1,1]},{\"name\":\"lamp\"", RETEX_EINVAL,
     "that of another one"},
    {"", "\"mixtures\":[]", "\"x\":[]", 0, ""}, /* may be left out */
    {"", "\"mixtures\":[]", "\"mixtures\":{}", RETEX_EFORMAT, "no list \"mixtures\""},
    {"", "\"mixtures\":[]", "\"mixtures\":null", RETEX_EFORMAT, "no list \"mixtures\""},
    {"\"parts\"", "\"name\":\"", "\"name\":\"a b", RETEX_EFORMAT, "named"},
    {"\"parts\"", "\"letters\":\"", "\"letters\":\"a", RETEX_EFORMAT, "channels"},
    {"\"parts\"", "\"type\":\"", "\"type\":\"x", RETEX_EFORMAT, "type"},
    {"\"parts\"", "\"crc32\":\"", "\"crc32\":\"0", RETEX_EFORMAT, "checksum"},
    {"\"parts\"", "\"crc32\":\"", "\"crc32\":\"+1234567\",\"x\":\"", RETEX_EFORMAT, "checksum"},
    {"\"parts\"", "\"crc32\":\"", "\"crc32\":\"-1234567\",\"x\":\"", RETEX_EFORMAT, "checksum"},
    {"\"parts\"", "\"parts\":[", "\"parts\":[],\"x\":[", RETEX_EFORMAT, "no parts"},
};

static void test_manifests_that_lie(void **state)
{
    (void)state;
    RetexSet *set = test_set(16, 16, 1);
    const RetexParameter lamp = {"lamp", RETEX_PARAMETER_COLOR, -1, {1, 2, 0.5f}};
    char *json;
    RetexError err = {0};
    test_must(retex_set_add_parameter(set, &lamp, NULL, &err), &err);
    test_must(retex_set_manifest(set, &json, &err), &err);
    check_manifests(json, lies, sizeof lies / sizeof lies[0]);
    turn_inside_out(json);
    free(json);
    set->folded = __builtin_nan("");
    assert_int_equal(retex_set_manifest(set, &json, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

static void test_mixtures_that_lie(void **state)
{
    (void)state;
    static const ManifestCase cases[] = {
        {"", "\"mixtures\":", "\"x\":", RETEX_EFORMAT, "\"mixture\" from 0"},
        {"", "\"mixtures\":[", "\"mixtures\":[],\"x\":[", RETEX_EFORMAT, "\"mixture\" from 0"},
        {"", "\"mixtures\":[", "\"mixtures\":[7,", RETEX_EFORMAT, "a mixture that is no list of at most 20"},
        {"", "\"mixtures\":[", "\"mixtures\":[{},", RETEX_EFORMAT, "a mixture that is no list of at most 20"},
        {"", "\"mixtures\":[", "\"mixtures\":[[],", RETEX_EINVAL, "1 to 20 shares, not 0"},
        {"", "\"mixtures\":[[", "\"mixtures\":[[7,", RETEX_EFORMAT, "\"footprint\""},
        {"", "\"mixtures\":[[", "\"mixtures\":[[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17,18,19,", RETEX_EFORMAT,
         "a mixture that is no list of at most 20"},
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
        {"\"terms\"", "{\"mixture\":0}", "{\"mixture\":1}", 0, ""},
        {"\"terms\"", "{\"mixture\":0}", "{\"mixture\":2}", RETEX_EFORMAT, "\"mixture\" from 0 to 1"},
        {"\"terms\"", "{\"mixture\":0}", "{\"mixture\":-1}", RETEX_EFORMAT, "\"mixture\""},
    };
    RetexSet *set = test_set(16, 16, 1);
    char *json;
    RetexError err = {0};
    test_make_footprints(set);
    test_must(retex_set_add_part(set, "small", "R", RETEX_HALF, 3, 2, NULL, &err), &err);
    test_must(retex_set_add_part(set, "small-rgb", "RGB", RETEX_HALF, 3, 2, NULL, &err), &err);
    test_must(retex_set_add_part(set, "two", "RG", RETEX_HALF, 0, 0, NULL, &err), &err);
    test_must(retex_set_manifest(set, &json, &err), &err);
    check_manifests(json, cases, sizeof cases / sizeof cases[0]);
    turn_inside_out(json);
    free(json);
    retex_set_close(&set);
}

/* Parts of textures are what they say, and of one use each: they leave the set when a texture is lifted. */
static void test_textures_that_lie(void **state)
{
    (void)state;
    static const ManifestCase cases[] = {
        {"", "\"sampled\":\"one\"", "\"sampled\":\"beauty\"", RETEX_EFORMAT, "\"beauty\", which is used as another"},
        {"", "\"sampled\":\"one\"", "\"sampled\":\"second\"", RETEX_EFORMAT, "\"second\", which is used as another"},
        {"", "\"sampled\":\"one\"", "\"sampled\":\"none\"", RETEX_EFORMAT, "a part that is not there in \"sampled\""},
        {"", "\"sampled\":\"one\"", "\"sampled\":null", RETEX_EFORMAT, "\"sampled\""},
        {"", "\"sampled\":\"one\"", "\"sampled\":\"odd\"", RETEX_EFORMAT, "neither of the set's size"},
        {"", "\"sampled\":\"one\"", "\"sampled\":\"half\"", RETEX_EFORMAT, "\"half\", which is used as another"},
        {"", "\"sampled\":\"one\",", "", RETEX_EFORMAT, "whose parts differ in size"},
        {"", "\"finished\":[\"first\",\"second\"]", "\"finished\":[\"first\",\"first\"]", RETEX_EFORMAT,
         "\"first\", which is used as another"},
        {"", "\"finished\":[\"first\",\"second\"]", "\"finished\":[\"first\"]", RETEX_EFORMAT, "other finishes"},
        {"", "\"finished\":[\"first\",\"second\"]", "\"finished\":[\"first\",\"small\"]", RETEX_EFORMAT,
         "differ in size"},
        {"", "\"finished\":[\"first\",\"second\"]", "\"finished\":[\"first\",7]", RETEX_EFORMAT, "differ in size"},
        {"", "\"finished\":[\"first\",\"second\"]", "\"finished\":3", RETEX_EFORMAT, "\"finished\""},
        {"", "\"gates\":\"gate\"", "\"gates\":\"first\"", RETEX_EFORMAT, "\"first\", which is used as another"},
        {"", "\"gates\":\"gate\"", "\"gates\":\"small\"", RETEX_EFORMAT, "of another size than the set's"},
        {"", "\"kind\":\"set\"", "\"kind\":\"samples\"", RETEX_EFORMAT, "which is used as another"},
        {"", "\"kind\":\"set\"", "\"kind\":\"stream\"", RETEX_EFORMAT, "unknown kind \"stream\""},
    };
    static const char *const names[] = {"one", "first", "second", "gate"};
    RetexSet *set = test_set(16, 16, 1);
    RetexTarget *target = &set->targets[0];
    RetexError err = {0};
    int parts[4];
    char *json;
    target->nfinishes = 2, target->finish = 1;
    strcpy(target->finishes[0], "matt"), strcpy(target->finishes[1], "metal");
    for (int i = 0; i < 4; i++)
        test_must(retex_set_add_part(set, names[i], "RGB", RETEX_FLOAT, 0, 0, &parts[i], &err), &err);
    test_must(retex_set_add_part(set, "half", "RGB", RETEX_HALF, 0, 0, NULL, &err), &err);
    test_must(retex_set_add_part(set, "small", "RGB", RETEX_FLOAT, 8, 8, NULL, &err), &err);
    test_must(retex_set_add_part(set, "odd", "RGB", RETEX_FLOAT, 7, 8, NULL, &err), &err);
    assert_int_equal(set->footprints[0].target, 0);
    set->footprints[0].sampled = 1 + parts[0];
    set->footprints[0].finished[0] = 1 + parts[1], set->footprints[0].finished[1] = 1 + parts[2];
    target->gates = 1 + parts[3];
    set->parts[0].type = RETEX_FLOAT; /* the picture could be one of a texture but for what it is, */
    for (int t = 0; t < set->nterms; t++) /* as nothing else has it */
        set->terms[t].radiance += set->terms[t].radiance == 0;
    test_must(retex_set_manifest(set, &json, &err), &err);
    check_manifests(json, cases, sizeof cases / sizeof cases[0]);
    free(json);
    retex_set_close(&set);
}

static void test_parallelograms_that_lie(void **state)
{
    (void)state;
    static const ManifestCase cases[] = {
        {"", "\"quadrant\":4", "\"quadrant\":0", 0, ""},
        {"", "\"quadrant\":4", "\"quadrant\":5", RETEX_EFORMAT, "\"quadrant\" from 0 to 4"},
        {"", "\"quadrant\":4", "\"quadrant\":-1", RETEX_EFORMAT, "\"quadrant\" from 0 to 4"},
        {"", "\"quadrant\":4", "\"quadrant\":\"1\"", RETEX_EFORMAT, "\"quadrant\""},
        {"", "\"axes\":\"axes\"", "\"axes\":\"two\"", RETEX_EFORMAT, "\"axes\" a part of 2 channels instead of 4"},
        {"", "\"axes\":\"axes\"", "\"axes\":\"none\"", RETEX_EFORMAT, "a part that is not there in \"axes\""},
        {"", "\"axes\":\"axes\"", "\"spread\":\"axes\"", RETEX_EFORMAT, "\"spread\" a part of 4 channels instead of 2"},
        {"", "\"axes\":\"axes\"", "\"axes\":\"axes\",\"spread\":\"two\"", RETEX_EFORMAT,
         "both \"spread\" and \"axes\""},
        {"", "\"axes\":\"axes\"", "\"axes\":\"axes\",\"spread\":null", RETEX_EFORMAT, "both \"spread\" and \"axes\""},
        {"", "\"axes\":\"axes\"", "\"spread\":\"two\"", RETEX_EINVAL, "quadrant 4 of a pixel without axes"},
    };
    RetexSet *set = test_set(16, 16, 1), *back;
    RetexFootprint f = {.target = 0, .hit = 9, .kind = RETEX_FOOTPRINT_SHARP, .uv = -1, .albedo = -1, .quadrant = 4};
    RetexError err = {0};
    char *json;
    test_make_footprints(set);
    test_must(retex_set_add_part(set, "two", "RG", RETEX_HALF, 0, 0, &f.spread, &err), &err);
    assert_int_equal(retex_set_add_footprint(set, &f, NULL, &err), RETEX_EINVAL);
    test_must(retex_set_add_part(set, "axes", "RGBA", RETEX_HALF, 0, 0, &f.spread, &err), &err);
    f.quadrant = 5;
    assert_int_equal(retex_set_add_footprint(set, &f, NULL, &err), RETEX_EINVAL);
    f.quadrant = 4;
    test_must(retex_set_add_footprint(set, &f, NULL, &err), &err);
    test_must(retex_set_manifest(set, &json, &err), &err);
    check_manifests(json, cases, sizeof cases / sizeof cases[0]);
    test_must(retex_manifest_read(json, "set", &back, NULL, &err), &err);
    const RetexFootprint *last = &back->footprints[back->nfootprints - 1];
    assert_int_equal(last->quadrant, 4);
    assert_string_equal(back->parts[last->spread].name, "axes");
    retex_set_close(&back);
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
        assert_int_equal(retex_set_write(set, path, NULL, 0, &err), RETEX_EINVAL);
        *mixture = kept;
        mixture->shares[2].footprint = footprints[k];
        assert_int_equal(retex_set_write(set, path, NULL, 0, &err), RETEX_EINVAL);
        *mixture = kept;
        set->nmixtures = nmixtures[k];
        assert_int_equal(retex_set_write(set, path, NULL, 0, &err), RETEX_EINVAL);
        set->nmixtures = 2;
    }
    for (int k = 0; k < 3; k++) {
        mixture->nshares = nshares[k];
        assert_int_equal(retex_set_write(set, path, NULL, 0, &err), RETEX_EINVAL);
    }
    *mixture = kept;
    test_must(retex_set_write(set, path, NULL, 0, &err), &err);
    set->terms[1].nfactors = RETEX_MAX_FACTORS + 1;
    assert_int_equal(retex_set_write(set, path, NULL, 0, &err), RETEX_EINVAL);
    retex_set_close(&set);
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
    test_must(retex_set_read(path, &set, 1, &err), &err);
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
    const int status = retex_set_read(path, &set, 2, err);
    if (status) {
        assert_null(set);
        assert_true(err->message[0] != 0);
    }
    retex_set_close(&set);
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
        test_must(retex_set_write(set, path, &params, 0, &err), &err);
        unsigned char *data = test_read_file(path, &bytes);
        for (size_t length = 0; length < bytes; length += 1 + length / 40) {
            store(data, length);
            assert_int_equal(read_anything(&err), RETEX_EFORMAT);
            assert_int_equal(retex_set_check(path, 1, &err), RETEX_EFORMAT);
        }
        RetexSet *whole = NULL;
        store(data, bytes);
        test_must(retex_set_read(path, &whole, 1, &err), &err);
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
    test_must(retex_image_write(&image, exr, NULL, 1, &err), &err);
    RetexSet *set;
    assert_int_equal(retex_set_read(exr, &set, 0, &err), RETEX_EFORMAT);
    assert_non_null(strstr(err.message, "is not a set (no `retex` attribute)"));
    unlink(exr);
    assert_int_equal(retex_set_read("/nowhere.exr", &set, 0, &err), RETEX_EIO);
    assert_int_equal(retex_set_read("/tmp", &set, 0, &err), RETEX_EIO);
    retex_image_free(&image);
}

/* Each image of a footprint has its number of channels; only the target that gets a texture counts. */
static void test_footprints_without_channels(void **state)
{
    (void)state;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    spec.constant = 1;
    for (int k = 0; k < 7; k++) {
        RetexSet *set = test_set(8, 8, 1);
        assert_int_equal(set->ntargets, 2);
        const RetexFootprint *f = NULL;
        for (int i = 0; i < set->nfootprints && !f; i++)
            f = set->footprints[i].target == 0 ? &set->footprints[i] : NULL;
        assert_non_null(f);
        const int parts[] = {f->uv, f->spread, f->albedo};
        if (k < 6)
            set->parts[parts[k / 2]].image.channels += k % 2 ? -1 : 1;
        for (int target = 0; target < 2; target++) {
            const int refused = target == 0 && k < 6 && k != 2;
            snprintf(spec.target, sizeof spec.target, "%s", set->targets[target].name);
            const int code = retex_textures_load(textures, set, &spec, 1, 1, &err);
            if (code != (refused ? RETEX_EFORMAT : RETEX_OK))
                fail_msg("image %d with %d channels: %d", k / 2, set->parts[parts[k / 2 % 3]].image.channels, code);
            if (!code)
                retex_textures_close(textures);
        }
        if (k < 6)
            set->parts[parts[k / 2]].image.channels -= k % 2 ? -1 : 1;
        retex_set_close(&set);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_damage_to_a_manifest_is_seen),
        cmocka_unit_test(test_manifests_that_lie),
        cmocka_unit_test(test_mixtures_that_lie),
        cmocka_unit_test(test_textures_that_lie),
        cmocka_unit_test(test_parallelograms_that_lie),
        cmocka_unit_test(test_mixtures_that_are_wrong),
        cmocka_unit_test(test_damaged_files),
        cmocka_unit_test(test_what_is_no_set),
        cmocka_unit_test(test_footprints_without_channels),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
