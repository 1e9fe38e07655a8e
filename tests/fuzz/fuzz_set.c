/* Sets, with textures laid on them or not, and samples as OpenEXR files, read from a file and through a pipe: both must
 * say the same. What is accepted is checked, recombined, retextured and denoised. Of half of them checksums are put
 * right before, else little would be accepted. */
#include <fcntl.h>
#include <math.h>
#include <retex/combine.h>
#include <retex/denoise.h>
#include <retex/laid.h>
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

static void give(RetexSet *set, int as_samples, int compress)
{
    RetexStoreParams params = RETEX_STORE_INIT;
    RetexError err = {0};
    char name[64];
    snprintf(name, sizeof name, "fuzz_set-%d.tmp.exr", (int)getpid());
    params.compress = compress;
    test_must(as_samples ? retex_set_write_samples(set, name, &params, 1, &err)
                         : retex_set_write(set, name, &params, 1, &err),
              &err);
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
    RetexSet *set = test_set(12, 8, 1), *tall = test_set(3, 40, 2);
    test_make_footprints(tall);
    test_must(test_texture_spec(&spec, "", "Floor=rgb(1,0.5,0.2)", &err), &err);
    for (int compress = 0; compress < 2; compress++) {
        give(set, 0, compress);
        give(tall, 0, compress);
        test_must(retex_sample(set, &spec, 1, 1, &err), &err);
        give(set, 1, compress);
        give(set, 0, compress);
        retex_set_lift(set, -1);
    }
    test_must(retex_sample(tall, &spec, 1, 1, &err), &err);
    give(tall, 0, 0);
    retex_set_lift(tall, -1);
    test_add_denoise_data(set);
    test_add_denoise_data(tall);
    give(set, 0, 0);
    give(tall, 0, 0);
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
    char key[RETEX_NAME_MAX + 16], digits[9];
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
    RetexInput *input = NULL;
    RetexExr *exr = NULL;
    int code = retex_manifest_read(json, "fuzz", &set, NULL, NULL);
    if (!code)
        code = retex_input_borrow(&input, bytes, size, "fuzz", NULL);
    if (!code)
        code = retex_exr_open(&exr, input, NULL);
    for (int i = 0; !code && set && i < set->nparts; i++)
        put_part_right(json, exr, set->parts[i].name, set->parts[i].letters);
    retex_exr_close(&exr);
    retex_input_close(&input);
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
static void combine(const RetexSet *set)
{
    RetexImage picture = {0};
    if (retex_combine(&picture, set, NULL, NULL, 1, NULL) == 0)
        for (size_t i = 0; i < retex_image_index(&picture, 0, picture.height); i++)
            fuzz_must(isfinite(picture.pixels[i]), "a picture is finite");
    retex_image_free(&picture);
}

static void use_set(RetexSet *set)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    combine(set);
    if (set->ntargets) {
        spec.constant = 1;
        spec.color[0] = 0.5f, spec.color[1] = 1e9f;
        memcpy(spec.target, set->targets[0].name, sizeof spec.target);
        if (retex_textures_load(textures, set, &spec, 1, 1, NULL) == 0)
            retex_estimate_error(set, textures, NULL, drop_rows, NULL, 1, NULL);
        retex_textures_close(textures);
        if (retex_sample(set, &spec, 1, 1, NULL) == 0)
            combine(set);
    }
    retex_set_lift(set, -1);
    combine(set);
}

/* Denoising changes a set: the last thing done to it. */
static void denoise(RetexSet *set)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.radius = 2;
    if (set->width > 64 || set->height > 64 || retex_denoise(set, &params, NULL, 1, NULL))
        return;
    combine(set);
}

/* The file stays open: a texture joins those that are laid on it, and all goes on, as down a pipe. */
static void use_open(void)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexSet *set, *samples;
    if (retex_set_open_any(path, &set, 1, NULL))
        return;
    if (retex_set_open_any(path, &samples, 1, NULL) == 0)
        (void)retex_set_lay(set, samples, NULL);
    combine(set);
    spec.constant = 1;
    if (set->ntargets)
        memcpy(spec.target, set->targets[0].name, sizeof spec.target);
    if (set->ntargets && test_sample_to_store(set, &spec, 1, "-", 1, NULL) == 0) {
        retex_set_write(set, "/dev/null", NULL, 0, NULL);
        retex_set_write_samples(set, "/dev/null", NULL, 0, NULL);
    }
    retex_set_load(set, 1, NULL);
    retex_set_close(&samples);
    retex_set_close(&set);
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
    if (!bytes || size < 4 || memcmp(input, "v/1\1", 4) != 0) {
        free(bytes);
        return 0; /* the bridge and OpenImageIO are asked about others */
    }
    memcpy(bytes, input, size);
    if (input[size / 2] & 1)
        put_right(bytes, size);
    fuzz_must(ftruncate(file, 0) == 0 && pwrite(file, bytes, size, 0) == (ssize_t)size, "a file can be written");
    int code = retex_set_read(path, &set, 1, NULL);
    pipe_in(bytes, size);
    fuzz_must(retex_set_read("-", &piped, 1, NULL) == code, "a pipe reads as a file does");
    fuzz_must(code || retex_set_check(path, 1, NULL) <= 0, "a check answers");
    if (set)
        use_set(set);
    if (set)
        denoise(set);
    use_open();
    use_layers();
    retex_set_close(&set);
    retex_set_close(&piped);
    free(bytes);
    return !code;
}

int main(int argc, char **argv)
{
    static const FuzzDriver driver = {"set", 0, begin, run};
    return fuzz_main(&driver, argc, argv);
}
