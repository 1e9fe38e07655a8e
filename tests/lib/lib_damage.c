/* See lib_damage.h. */
#include "lib_damage.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/checksum.h"
#include "set/manifest.h"

const char *const damage_road_names[ROADS] = {"rows",  "read", "estimate", "sample", "stream",
                                              "write", "pack", "strips",   "denoise"};
const char *const damage_file_names[DAMAGE_FILES] = {"set", "plain", "stream", "pack", "lossless"};

static char texture_path[96], output_path[96];

void damage_begin(const char *folder)
{
    RetexImage image = {0};
    RetexError err = {0};
    snprintf(texture_path, sizeof texture_path, "%s/damage-texture.exr", folder);
    snprintf(output_path, sizeof output_path, "%s/damage-output", folder);
    test_random_image(&image, 32, 32, 3, 5, 0, 1);
    test_must(retex_image_write(&image, texture_path, NULL, 1, &err), &err);
    retex_image_free(&image);
}

void damage_end(void)
{
    unlink(texture_path);
}

/* ---- files ---- */

/* Random bits as halves, without infinities. Deflate would make them larger, so that they are stored uncompressed. */
static void add_noise(RetexSet *set, uint32_t seed)
{
    RetexError err = {0};
    int part;
    test_must(retex_set_add_part(set, "incompressible", "RGB", RETEX_HALF, 0, 0, &part, &err), &err);
    RetexImage *image = &set->parts[part].image;
    for (size_t i = 0; i < retex_image_index(image, 0, image->height); i++)
        image->pixels[i] =
            (float)ldexp((test_random(&seed) < 0.5 ? -1 : 1) * (1 + floor(1024 * test_random(&seed)) / 1024),
                         (int)floor(30 * test_random(&seed)) - 14);
    set->terms[0].radiance = part;
}

RetexSet *damage_set(const char *layout, uint32_t seed)
{
    RetexSet *set = test_set(24, 72, seed);
    if (strcmp(layout, "footprints") == 0) {
        test_make_footprints(set);
        add_noise(set, seed);
    }
    test_add_denoise_data(set);
    return set;
}

static RetexTextureSpec make_spec(const RetexSet *set, int target)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, set->targets[target].name);
    strcpy(spec.image, texture_path);
    return spec;
}

void damage_write(RetexSet *set, DamageFile kind, const char *path)
{
    RetexStoreParams store = RETEX_STORE_INIT;
    RetexPackParams packing = RETEX_PACK_INIT;
    const RetexTextureSpec spec = make_spec(set, 1);
    RetexError err = {0};
    store.compress = kind == FILE_SET;
    packing.lossless = kind == FILE_LOSSLESS;
    if (kind == FILE_STREAM)
        test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    if (kind == FILE_PACK || kind == FILE_LOSSLESS)
        test_must(retex_pack_write(set, path, &packing, NULL, 0, &err), &err);
    else
        test_must(retex_set_write(set, path, &store, 0, &err), &err);
    retex_set_lift(set, -1);
}

/* Replace a word by another of the same length. */
static void exchange(unsigned char *bytes, size_t size, const char *from, const char *to)
{
    const size_t length = strlen(from);
    for (unsigned char *at = bytes; (at = memmem(at, size - (size_t)(at - bytes), from, length)); at += length)
        memcpy(at, to, length);
}

/* The manifest of an EXR file: the value of its attribute, with the length before it. */
static unsigned char *find_manifest(unsigned char *bytes, size_t size, size_t *length)
{
    static const char begin[] = "{\"retex\":";
    unsigned char *at = memmem(bytes, size, begin, sizeof begin - 1);
    if (!at || at - bytes < 4)
        return NULL;
    *length = at[-4] | (size_t)at[-3] << 8 | (size_t)at[-2] << 16 | (size_t)at[-1] << 24;
    return *length <= size - (size_t)(at - bytes) ? at : NULL;
}

void damage_drop_bands(unsigned char *bytes, size_t size)
{
    size_t length;
    unsigned char *manifest = find_manifest(bytes, size, &length);
    if (!manifest)
        return;
    exchange(manifest, length, "\"bands\":", "\"other\":");
    char *text = malloc(length + 1);
    memcpy(text, manifest, length);
    text[length] = 0;
    retex_manifest_seal(text);
    memcpy(manifest, text, length);
    free(text);
}

void damage_drop_bands_of_file(const char *path)
{
    unsigned char *bytes = malloc(1 << 24);
    FILE *file = fopen(path, "r+b");
    const size_t size = file && bytes ? fread(bytes, 1, 1 << 24, file) : 0;
    damage_drop_bands(bytes, size);
    if (!size || fseek(file, 0, SEEK_SET) || fwrite(bytes, 1, size, file) != size)
        abort();
    fclose(file);
    free(bytes);
}

/* ---- roads ---- */

static uint32_t sum_of(const RetexImage *image)
{
    return retex_crc32(CRC32_OF_NONE, image->pixels, retex_image_index(image, 0, image->height) * sizeof(float));
}

/* Returns the checksum of a file, and removes the file; 0 if there is no file. */
static uint32_t sum_of_output(void)
{
    unsigned char bytes[65536];
    FILE *file = fopen(output_path, "rb");
    uint32_t sum = CRC32_OF_NONE;
    size_t got;
    while (file && (got = fread(bytes, 1, sizeof bytes, file)) > 0)
        sum = retex_crc32(sum, bytes, got);
    if (file)
        fclose(file);
    unlink(output_path);
    return sum;
}

static int keep_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    RetexImage *image = context;
    (void)err;
    memcpy(image->pixels + retex_image_index(image, 0, y0), rows, sizeof *rows * retex_image_index(image, 0, y1 - y0));
    return 0;
}

/* The first target's texture, row by row. */
static int go_rows(const RetexSet *set, int estimate, uint32_t *sum, RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS] = {NULL};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage picture = {0};
    int code = set->ntargets ? 0 : retex_fail(err, RETEX_EINVAL, "no target");
    if (!code) {
        spec = make_spec(set, 0);
        code = retex_textures_load(textures, set, &spec, 1, 1, err);
    }
    if (!code)
        code = retex_image_alloc(&picture, set->width, set->height, 3, err);
    if (!code)
        code = estimate ? retex_estimate_error(set, textures, NULL, keep_rows, &picture, 1, err)
                        : retex_retexture(set, textures, NULL, keep_rows, &picture, 1, err);
    if (!code)
        *sum = sum_of(&picture);
    retex_textures_close(textures);
    retex_image_free(&picture);
    return code;
}

static int go_combine(const RetexSet *set, uint32_t *sum, RetexError *err)
{
    RetexImage picture = {0};
    const int code = retex_combine(&picture, set, NULL, NULL, 1, err);
    if (!code)
        *sum = sum_of(&picture);
    retex_image_free(&picture);
    return code;
}

/* A texture on the first target, beside what is laid on the file's set. */
static int go_sample(RetexSet *set, int stream, uint32_t *sum, RetexError *err)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    int code = set->ntargets ? 0 : retex_fail(err, RETEX_EINVAL, "no target");
    if (!code) {
        spec = make_spec(set, 0);
        code = test_sample_to_store(set, &spec, 1, output_path, 1, err);
    }
    if (!code)
        code = stream ? retex_set_write(set, output_path, NULL, 0, err) : go_combine(set, sum, err);
    if (!code && stream)
        *sum = sum_of_output();
    return code;
}

static int go_write(RetexSet *set, uint32_t *sum, RetexError *err)
{
    const int code = retex_set_write(set, output_path, NULL, 0, err);
    if (!code)
        *sum = sum_of_output();
    return code;
}

static int go_pack(RetexSet *set, uint32_t *sum, RetexError *err)
{
    RetexPackParams params = RETEX_PACK_INIT;
    params.lossless = 1;
    retex_set_lift(set, -1);
    int code = retex_set_load(set, 1, err);
    if (!code)
        code = retex_pack_write(set, output_path, &params, NULL, 0, err);
    if (!code)
        *sum = sum_of_output();
    return code;
}

static int go_denoise(RetexSet *set, uint32_t *sum, RetexError *err)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.radius = 1;
    params.near = output_path;
    retex_set_lift(set, -1);
    const int code = retex_denoise(set, &params, NULL, 1, err);
    return code ? code : go_combine(set, sum, err);
}

int damage_go(DamageRoad road, const char *path, uint32_t *sum, RetexError *err)
{
    const int whole = road == ROAD_READ || road == ROAD_DENOISE;
    RetexSet *set = NULL;
    int code = whole ? retex_set_read(path, &set, 1, err) : retex_set_open(path, &set, 1, err);
    if (code)
        goto done;
    switch (road) {
    case ROAD_ROWS:
    case ROAD_READ:
    case ROAD_ESTIMATE:
        code = go_rows(set, road == ROAD_ESTIMATE, sum, err);
        break;
    case ROAD_SAMPLE:
    case ROAD_STREAM:
        code = go_sample(set, road == ROAD_STREAM, sum, err);
        break;
    case ROAD_WRITE:
        code = go_write(set, sum, err);
        break;
    case ROAD_PACK:
        code = go_pack(set, sum, err);
        break;
    default:
        code = go_denoise(set, sum, err);
    }
done:
    unlink(output_path);
    retex_set_close(&set);
    return code;
}
