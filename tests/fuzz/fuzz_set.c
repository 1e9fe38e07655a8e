/* Sets, samples and streams of both as OpenEXR files, read from a file and through a pipe: both must say the same. What
 * is accepted is checked, recombined, retextured and denoised. Of half of them checksums are put right before, else
 * little would be accepted. */
#include <fcntl.h>
#include <math.h>
#include <retex/combine.h>
#include <retex/denoise.h>
#include <retex/samples.h>
#include <retex/set_file.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "exr/io.h"
#include "files/layers.h"
#include "lib_fuzz.h"
#include "lib_test.h"
#include "set/manifest.h"

static int file; /* in memory, known by name */
static char path[64];

static void give(RetexSet *set, const RetexSamples *samples, int compress)
{
    RetexStoreParams params = RETEX_STORE_INIT;
    RetexError err = {0};
    char name[64];
    snprintf(name, sizeof name, "fuzz_set-%d.tmp.exr", (int)getpid());
    params.compress = compress;
    test_must(retex_set_write(set, samples, name, &params, 1, &err), &err);
    FILE *in = fopen(name, "rb");
    unsigned char *bytes = malloc(FUZZ_LARGEST);
    if (in && bytes)
        fuzz_seed(bytes, fread(bytes, 1, FUZZ_LARGEST, in));
    free(bytes);
    if (in)
        fclose(in);
    unlink(name);
}

static void begin(void)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    RetexSamples *samples;
    RetexSet *set = test_set(12, 8, 1), *tall = test_set(3, 40, 2);
    test_make_footprints(tall);
    test_must(test_texture_spec(&spec, "", "Floor=rgb(1,0.5,0.2)", &err), &err);
    test_must(retex_sample(&samples, set, &spec, 1, 1, &err), &err);
    for (int compress = 0; compress < 2; compress++) {
        give(set, NULL, compress);
        give(tall, NULL, compress);
        give(NULL, samples, compress);
        give(set, samples, compress);
    }
    retex_samples_close(&samples);
    test_must(retex_sample(&samples, tall, &spec, 1, 1, &err), &err);
    give(tall, samples, 0);
    retex_samples_close(&samples);
    test_add_denoise_data(set);
    test_add_denoise_data(tall);
    give(set, NULL, 0);
    give(tall, NULL, 0);
    retex_set_close(&set);
    retex_set_close(&tall);
    file = memfd_create("fuzz_set", 0);
    snprintf(path, sizeof path, "/proc/self/fd/%d", file);
}

/* ---- checksums put right ---- */

/* The digits of a part's checksum in the manifest, where it has one. */
static void put_part_right(char *json, RetexExr *exr, const char *name, const char *letters)
{
    RetexExrRequest request = {.part = retex_exr_find_part(exr, name), .with_crc = 1};
    char key[RETEX_SAMPLE_NAME_MAX + 16], digits[9];
    snprintf(key, sizeof key, "\"name\":\"%s\"", name);
    char *place = strstr(json, key);
    place = place ? strstr(place, "\"crc32\":\"") : NULL;
    for (int c = 0; letters[c]; c++)
        snprintf(request.channels[c], RETEX_EXR_NAME_MAX, request.part ? "%.180s.%c" : "%.0s%c", name, letters[c]);
    if (request.part < 0 || !place || strlen(place) < 20 || retex_exr_read(exr, &request, 1, 1, NULL))
        return;
    snprintf(digits, sizeof digits, "%08x", (unsigned)request.crc);
    memcpy(place + strlen("\"crc32\":\""), digits, 8);
}

/* Those of all parts, without those of bands, as far as the manifest can be read. */
static void put_parts_right(char *json, const unsigned char *bytes, size_t size)
{
    RetexSet *set = NULL;
    RetexSamples *samples = NULL;
    RetexSamplePart *names = NULL;
    RetexInput *input = NULL;
    RetexExr *exr = NULL;
    int code = retex_manifest_read(json, "fuzz", &set, &samples, &names, NULL, NULL);
    if (!code)
        code = retex_input_borrow(&input, bytes, size, "fuzz", NULL);
    if (!code)
        code = retex_exr_open(&exr, input, NULL);
    for (int i = 0; !code && set && i < set->nparts; i++)
        put_part_right(json, exr, set->parts[i].name, set->parts[i].letters);
    for (int i = 0; !code && samples && i < samples->nimages; i++)
        if (names[i].name[0])
            put_part_right(json, exr, names[i].name, "RGB");
    retex_exr_close(&exr);
    retex_input_close(&input);
    free(names);
    retex_samples_close(&samples);
    retex_set_close(&set);
}

static void put_right(unsigned char *bytes, size_t size)
{
    unsigned char *text = memmem(bytes, size, "{\"retex\":", 9);
    uint32_t length;
    if (!text || text - bytes < 4)
        return;
    memcpy(&length, text - 4, sizeof length); /* of the attribute */
    if (length > size - (size_t)(text - bytes))
        return;
    char *json = strndup((char *)text, length);
    for (char *at = json; at && (at = strstr(at, "\"bands\":"));)
        memcpy(at, "\"older\":", 8);
    if (json) {
        retex_manifest_seal(json);
        put_parts_right(json, bytes, size);
        retex_manifest_seal(json);
        memcpy(text, json, strlen(json));
    }
    free(json);
}

/* Fill a pipe and make it standard input; bytes are fewer than it holds. */
static void pipe_in(const unsigned char *bytes, size_t size)
{
    int ends[2];
    if (pipe(ends) || fcntl(ends[1], F_SETPIPE_SZ, 2 * (int)FUZZ_LARGEST) < 0 ||
        write(ends[1], bytes, size) != (ssize_t)size || dup2(ends[0], 0) != 0)
        fuzz_must(0, "a pipe can be had");
    close(ends[0]);
    close(ends[1]);
}

static int drop_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    (void)context, (void)y0, (void)y1, (void)rows, (void)err;
    return 0;
}

/* What is accepted gives a picture of numbers. */
static void combine(const RetexSet *set, const RetexSamples *samples)
{
    RetexImage picture = {0};
    if (retex_combine(&picture, set, samples, NULL, NULL, 1, NULL) == 0)
        for (size_t i = 0; i < retex_image_index(&picture, 0, picture.height); i++)
            fuzz_must(isfinite(picture.pixels[i]), "a picture is finite");
    retex_image_free(&picture);
}

static void use_set(const RetexSet *set, const RetexSamples *samples)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexSamples *own = NULL;
    combine(set, NULL);
    if (samples && retex_samples_check(samples, set, NULL) == 0)
        combine(set, samples);
    if (set->ntargets) {
        spec.constant = 1;
        spec.color[0] = 0.5f, spec.color[1] = 1e9f;
        memcpy(spec.target, set->targets[0].name, sizeof spec.target);
        if (retex_sample(&own, set, &spec, 1, 1, NULL) == 0)
            combine(set, own);
        if (retex_textures_load(textures, set, &spec, 1, 1, NULL) == 0)
            retex_estimate_error(set, NULL, textures, NULL, drop_rows, NULL, 1, NULL);
        retex_textures_close(textures);
    }
    retex_samples_close(&own);
}

/* Denoising changes a set: the last thing done to it. */
static void denoise(RetexSet *set)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.radius = 2;
    if (set->width > 64 || set->height > 64 || retex_denoise(set, &params, NULL, 1, NULL))
        return;
    combine(set, NULL);
}

/* The file stays open: samples join those that it has, and all goes on, as down a pipe. */
static void use_open(void)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage picture = {0};
    RetexSet *set;
    RetexSamples *samples = NULL, *more = NULL;
    if (retex_set_open(path, &set, &samples, 1, NULL))
        return;
    if (set && samples)
        retex_combine(&picture, set, samples, NULL, NULL, 1, NULL);
    spec.constant = 1;
    if (set && set->ntargets)
        memcpy(spec.target, set->targets[0].name, sizeof spec.target);
    if (set && test_sample_to_store(&more, set, &spec, 1, "-", 1, NULL) == 0)
        if (!samples || retex_samples_merge(samples, more, 0, NULL) == 0)
            retex_set_write(set, samples ? samples : more, "/dev/null", NULL, 0, NULL);
    if (samples)
        retex_samples_load(samples, 1, NULL);
    retex_samples_close(&samples);
    retex_samples_close(&more);
    retex_set_close(&set);
    retex_image_free(&picture);
}

static void use_layers(void)
{
    RetexLayers *layers;
    if (retex_layers_open(&layers, path, &(RetexReadParams)RETEX_READ_INIT, 1, NULL))
        return;
    for (int i = 0; i < retex_layers_count(layers); i++) {
        RetexLayer layer = {0};
        if (retex_layers_read(&layer, layers, i, NULL) == 0)
            retex_layer_free(&layer);
    }
    retex_layers_close(&layers);
}

static int run(const unsigned char *input, size_t size)
{
    unsigned char *bytes = malloc(size + 1);
    RetexSet *set = NULL, *piped = NULL;
    RetexSamples *samples = NULL, *piped_samples = NULL;
    if (!bytes || size < 4 || memcmp(input, "v/1\1", 4) != 0) {
        free(bytes);
        return 0; /* the bridge and OpenImageIO are asked about others */
    }
    memcpy(bytes, input, size);
    if (input[size / 2] & 1)
        put_right(bytes, size);
    fuzz_must(ftruncate(file, 0) == 0 && pwrite(file, bytes, size, 0) == (ssize_t)size, "a file can be written");
    int code = retex_set_read(path, &set, &samples, 1, NULL);
    pipe_in(bytes, size);
    fuzz_must(retex_set_read("-", &piped, &piped_samples, 1, NULL) == code, "a pipe reads as a file does");
    fuzz_must(!set == !piped && !samples == !piped_samples, "a pipe gives what a file gives");
    fuzz_must(code || retex_set_check(path, 1, NULL) <= 0, "a check answers");
    if (set)
        use_set(set, samples);
    if (set)
        denoise(set);
    use_open();
    use_layers();
    retex_set_close(&set);
    retex_set_close(&piped);
    retex_samples_close(&samples);
    retex_samples_close(&piped_samples);
    free(bytes);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"set", 0, begin, run};
    return fuzz_main(&driver, argc, argv);
}
