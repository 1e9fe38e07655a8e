/* See lib_test.h. */
#include "lib_test.h"

#include <math.h>

#include <stdio.h>
#include <stdlib.h>

double test_random(uint32_t *state)
{
    *state = *state * 747796405u + 2891336453u;
    uint32_t word = ((*state >> ((*state >> 28) + 4)) ^ *state) * 277803737u;
    return (double)((word >> 22) ^ word) / 4294967296.0;
}

int test_sample_to_store(RetexSet *set, const RetexTextureSpec *specs, int nspecs, const char *near, int nthreads,
                         RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    int code = retex_textures_load(textures, set, specs, nspecs, nthreads, err);
    if (!code)
        code = retex_sample_textures(set, textures, specs, nspecs, near, nthreads, err);
    retex_textures_close(textures);
    return code;
}

void test_combine(RetexImage *picture, const RetexSet *set, const RetexTextureSpec *specs, int nspecs,
                  const RetexCombineParams *params)
{
    RetexSet *laid = (RetexSet *)set;
    RetexError err = {0};
    if (nspecs)
        test_must(retex_sample(laid, specs, nspecs, 2, &err), &err);
    test_must(retex_combine(picture, laid, params, NULL, 2, &err), &err);
    retex_set_lift(laid, -1);
}

const RetexImage *test_laid(const RetexSet *set, int footprint)
{
    const int part = set->footprints[footprint].sampled - 1;
    return part < 0 ? NULL : &set->parts[part].image;
}

void test_must(int code, const RetexError *err)
{
    if (!code)
        return;
    fprintf(stderr, "lib_test: %s: %s\n", err->file, err->message);
    abort();
}

int test_texture_spec(RetexTextureSpec *spec, const char *opts, const char *arg, RetexError *err)
{
    RetexEdit *edit = NULL;
    int code = retex_edit_create(&edit, err);
    if (!code)
        code = retex_edit_option(edit, opts, arg, err);
    if (!code)
        *spec = *retex_edit_texture(edit, 0);
    retex_edit_close(&edit);
    return code;
}

void test_random_image(RetexImage *im, int width, int height, int channels, uint32_t seed, double low, double high)
{
    RetexError err = {0};
    test_must(retex_image_alloc(im, width, height, channels, &err), &err);
    for (size_t i = 0; i < (size_t)width * (size_t)height * (size_t)channels; i++)
        im->pixels[i] = (float)(low + (high - low) * test_random(&seed));
}

void test_turned_covariance(double covariance[3], double longer, double shorter, double angle)
{
    double c = cos(angle), s = sin(angle);
    covariance[0] = c * c * longer * longer + s * s * shorter * shorter;
    covariance[1] = c * s * (longer * longer - shorter * shorter);
    covariance[2] = s * s * longer * longer + c * c * shorter * shorter;
}
