/* Manifests, their checksum put right: what is accepted must be written and accepted again. */
#include <retex/laid.h>
#include <retex/set_file.h>
#include <stdlib.h>
#include <string.h>

#include "lib_test.h"
#include "set/manifest.h"
#include "set/parts.h"
#include "lib_fuzz.h"

static void give(const RetexSet *set)
{
    RetexError err = {0};
    char *json;
    test_must(retex_set_manifest(set, &json, &err), &err);
    fuzz_seed(json, strlen(json));
    fuzz_words(json, strlen(json));
    free(json);
}

/* As retex_set_write_samples writes it: nothing but what the textures show. */
static void give_samples(const RetexSet *set)
{
    RetexSet samples = *set;
    RetexSetView view;
    RetexError err = {0};
    char in_view[RETEX_SET_PARTS_MAX] = {0};
    for (int f = 0; f < set->nfootprints; f++)
        if (set->footprints[f].sampled)
            in_view[set->footprints[f].sampled - 1] = 1;
    samples.is_samples = 1;
    samples.nterms = samples.nmixtures = samples.nparameters = 0;
    test_must(retex_set_view_make(&view, &samples, in_view, &err), &err);
    give(&view.set);
    retex_set_view_free(&view);
}

static void begin(void)
{
    RetexSet *set = test_set(12, 8, 1);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    test_must(test_texture_spec(&spec, "", "Floor=rgb(1,0.5,0.2)", &err), &err);
    give(set);
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    give(set);
    give_samples(set);
    retex_set_lift(set, -1);
    test_make_footprints(set);
    give(set);
    test_add_lamp_terms(set, 1, 1);
    give(set);
    retex_set_close(&set);
}

/* Read; 0 where it was accepted, and its manifest written anew, to be freed. */
static int read_and_write(const char *json, char **again)
{
    RetexSet *set = NULL;
    *again = NULL;
    int code = retex_manifest_read(json, "fuzz", &set, NULL, NULL);
    if (!code)
        fuzz_must(retex_manifest_write(set, NULL, again, NULL) == 0, "an accepted manifest can be written");
    retex_set_close(&set);
    return code;
}

static int run(const unsigned char *bytes, size_t size)
{
    char *again, *third, *json = strndup((const char *)bytes, size);
    fuzz_must(json != NULL, "there is memory");
    retex_manifest_seal(json); /* else hardly any would be parsed */
    const int refused = read_and_write(json, &again);
    free(json);
    if (refused)
        return 0;
    fuzz_must(read_and_write(again, &third) == 0, "a written manifest is accepted");
    fuzz_must(strcmp(again, third) == 0, "a manifest read and written stays the same");
    free(again);
    free(third);
    return 1;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"manifest", 1, begin, run};
    return fuzz_main(&driver, argc, argv);
}
