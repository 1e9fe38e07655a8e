/* Samples of footprints at the border of a target's range of UV. */
#include "lib_error.h"
#include "lib_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

/* A picture file of 32 x 32, its left half red, its right half blue. */
static void write_halves(char path[64])
{
    RetexImage im = {0};
    RetexError err = {0};
    strcpy(path, "/tmp/retex-halves-XXXXXX.exr");
    int fd = mkstemps(path, 4);
    assert_true(fd >= 0);
    close(fd);
    test_must(retex_image_alloc(&im, 32, 32, 3, &err), &err);
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 32; x++)
            im.pixels[retex_image_index(&im, x, y) + (x < 16 ? 0 : 2)] = 1;
    test_must(retex_image_write(&im, path, NULL, 1, &err), &err);
    retex_image_free(&im);
}

static int add_part(RetexSet *set, const char *name, int kind, const char *letters, const float *pixel)
{
    char full[64];
    RetexError err = {0};
    int part;
    snprintf(full, sizeof full, "%s_%d", name, kind);
    test_must(retex_set_add_part(set, full, letters, RETEX_FLOAT, 0, 0, &part, &err), &err);
    memcpy(set->parts[part].image.pixels, pixel, strlen(letters) * sizeof *pixel);
    return part;
}

/* One pixel that has a footprint of each kind close to u = 0, on a target that reaches from 0 to 1. */
static RetexSet *make_border(const char *filter, int closed)
{
    static const RetexFootprintKind kinds[] = {RETEX_FOOTPRINT_SHARP, RETEX_FOOTPRINT_BROAD,
                                               RETEX_FOOTPRINT_INTERREFLECTION};
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_create(&set, 1, 1, &err), &err);
    snprintf(set->filter, sizeof set->filter, "%s", filter);
    RetexTarget *target = &set->targets[set->ntargets++];
    snprintf(target->name, sizeof target->name, "Floor");
    target->periodic[0] = closed;
    target->uv_max[0] = target->uv_max[1] = 1;
    for (int k = 0; k < 3; k++) {
        RetexFootprint f = {.target = 0, .hit = k + 1, .kind = kinds[k]};
        f.uv = add_part(set, "uv", k, "RGA", (const float[3]){0.02f, 0.5f, 1});
        f.spread = add_part(set, "spread", k, "RGB", (const float[3]){0.05f, 0.05f, 0});
        f.albedo = add_part(set, "albedo", k, "RGB", (const float[3]){0.5f, 0.5f, 0.5f});
        test_must(retex_set_add_footprint(set, &f, NULL, &err), &err);
    }
    return set;
}

/* Gaussians are cut off there, unless the target closes in itself and goes on; discs are not. */
static void footprints_end_where_the_target_does(void **state)
{
    (void)state;
    char path[64];
    write_halves(path);
    for (int round = 0; round < 8; round++) {
        int gaussian = round & 1, closed = round >> 1 & 1, turned = round >> 2 & 1;
        RetexSet *set = make_border(gaussian ? "gaussian" : "box", closed);
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexError err = {0};
        strcpy(spec.target, "Floor");
        snprintf(spec.image, sizeof spec.image, "%s", path);
        spec.rotate = turned ? 30 : 0;
        spec.offset[0] = turned ? 0.25 : 0; /* v = 0.5 turned by 30 degrees is 0.25 to the left of u = 0 */
        test_must(retex_sample(set, &spec, 1, 1, &err), &err);
        float means[3][3];
        for (int k = 0; k < 3; k++)
            memcpy(means[k], test_laid(set, k)->pixels, sizeof means[k]);
        test_lay_variances(set, &spec, 1);
        for (int k = 0; k < 3; k++) {
            const float *is = means[k], *varies = test_laid(set, k)->pixels;
            int cut = !closed && !turned && (gaussian || set->footprints[k].kind != RETEX_FOOTPRINT_SHARP);
            assert_float_equal(is[0] + is[2], 1, 1e-5);
            assert_in_range((int)(1000 * is[2]), cut ? 0 : 200, cut ? 0 : 500);
            assert_in_range((int)(1000 * varies[2]), cut ? 0 : 100, cut ? 0 : 250);
        }
        retex_set_close(&set);
    }
    remove(path);
}

/* Where a texture is clear, the original shows through: a sample is the colour, and the rest of the original's albedo.
 * No two channels are alike. */
static void holes_show_the_original(void **state)
{
    (void)state;
    static const float texel[4] = {0.8f, 0.4f, 0.2f, 0.25f}, albedo[3] = {0.5f, 0.125f, 0.9f};
    char path[] = "/tmp/retex-clear-XXXXXX.exr";
    RetexImage im = {0};
    RetexError err = {0};
    RetexSet *set = make_border("gaussian", 1);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    const int fd = mkstemps(path, 4);

    assert_true(fd >= 0);
    close(fd);
    test_must(retex_image_alloc(&im, 8, 8, 4, &err), &err);
    for (int i = 0; i < 64; i++)
        memcpy(im.pixels + 4 * i, texel, sizeof texel);
    test_must(retex_image_write(&im, path, NULL, 1, &err), &err);
    retex_image_free(&im);
    for (int k = 0; k < 3; k++)
        memcpy(set->parts[set->footprints[k].albedo].image.pixels, albedo, sizeof albedo);
    strcpy(spec.target, "Floor");
    snprintf(spec.image, sizeof spec.image, "%s", path);
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < 3; c++)
            assert_float_equal(test_laid(set, k)->pixels[c], texel[c] * texel[3] + albedo[c] * (1 - texel[3]), 2e-4);
    retex_set_close(&set);
    remove(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(footprints_end_where_the_target_does),
                                       cmocka_unit_test(holes_show_the_original)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
