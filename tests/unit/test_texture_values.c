/* Texels that are not valid colours of a surface: their replacement, and the warnings. */
#include "lib_filter.h"
#include "lib_folder.h"
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* What a texture's warnings were, a line each. */
typedef struct Heard {
    char text[2000];
} Heard;

static void hear(void *context, const char *text)
{
    Heard *heard = context;
    strcat(strcat(heard->text, text), "\n");
}

static RetexTexture *create(const RetexImage *im, int is_light, Heard *heard)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *texture;
    RetexError err = {0};
    heard->text[0] = '\0';
    spec.warn = hear;
    spec.warn_context = heard;
    spec.is_light = is_light;
    test_must(retex_texture_create(&texture, im, &spec, 0, &err), &err);
    return texture;
}

static void set_texel(RetexImage *im, int x, int y, float r, float g, float b)
{
    memcpy(im->pixels + retex_image_index(im, x, y), (float[3]){r, g, b}, 3 * sizeof(float));
}

static void expect_texel(const RetexTexture *texture, int x, int y, float r, float g, float b)
{
    float row[3 * 16];
    retex_texture_row(texture, y, row);
    assert_memory_equal(row + 3 * x, ((float[3]){r, g, b}), 3 * sizeof(float));
}

static void test_what_becomes_of_texels(void **state)
{
    (void)state;
    RetexImage im = {0};
    Heard heard;
    test_random_image(&im, 16, 12, 3, 1, 0, 1);
    RetexTexture *texture = create(&im, 0, &heard);
    assert_string_equal(heard.text, "");
    retex_texture_close(&texture);

    set_texel(&im, 7, 3, .5f, NAN, .5f);
    set_texel(&im, 2, 9, INFINITY, 0, 0);
    set_texel(&im, 4, 4, 1e9f, .5f, -3e38f);
    set_texel(&im, 5, 4, -.25f, .5f, .5f);
    set_texel(&im, 1, 11, 5, 5, 5);
    set_texel(&im, 0, 11, 2.5f, -.3f, -.1f); /* red of a wide gamut: not brighter than white */
    set_texel(&im, 3, 0, -1e-7f, .5f, .5f);  /* a rounding */
    texture = create(&im, 0, &heard);
    assert_string_equal(heard.text,
                        "2 texels not finite, the first at 7,3: taken as black\n"
                        "1 texel beyond 65504, the first at 4,4: taken as that\n"
                        "3 texels with negative colours, the first at 4,4: kept, for colours of wide gamuts have them\n"
                        "1 texel of 192 brighter than white, up to 5, the first at 1,11: a surface gives back no more "
                        "light than it gets; perhaps the file holds light, not albedo, or is exposed too brightly\n");
    expect_texel(texture, 7, 3, 0, 0, 0);
    expect_texel(texture, 2, 9, 0, 0, 0);
    expect_texel(texture, 4, 4, 65504, .5f, -65504);
    expect_texel(texture, 5, 4, -.25f, .5f, .5f);
    expect_texel(texture, 1, 11, 5, 5, 5);
    float p[4];
    filter_gaussian(texture, .5, .5, (double[3]){1, 0, 1}, p);
    assert_true(isfinite(p[0] + p[1] + p[2] + p[3]));
    retex_texture_close(&texture);

    texture = create(&im, 1, &heard); /* light may be as bright as it likes */
    assert_null(strstr(heard.text, "brighter"));
    assert_non_null(strstr(heard.text, "not finite"));
    retex_texture_close(&texture);
    retex_image_free(&im);
}

/* Files, by retex_textures_load: in the order of the specs, whatever the threads. */
static void test_files(void **state)
{
    (void)state;
    RetexImage im = {0};
    RetexError err = {0};
    char expected[800], paths[2][80];
    RetexWriteParams params = RETEX_WRITE_INIT;
    test_random_image(&im, 300, 200, 3, 1, 0, 1);
    RetexSet *set = test_set(16, 12, 1);
    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    Heard heard;
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 60; i++)
            set_texel(&im, (i * 7 + 11) % 300, 100 + i, .5f, k ? -1 : INFINITY, .5f);
        snprintf(paths[k], sizeof paths[k], "%s", test_in_folder(k ? "b.exr" : "a.exr"));
        test_must(retex_image_write(&im, paths[k], &params, 1, &err), &err);
        snprintf(specs[k].target, sizeof specs[k].target, "%s", k ? "Wall" : "Floor");
        strcpy(specs[k].image, paths[k]);
        specs[k].warn = hear;
        specs[k].warn_context = &heard;
    }
    snprintf(expected, sizeof expected,
             "%s: 60 texels not finite, the first at 11,100: taken as black\n"
             "%s: 60 texels with negative colours, the first at 11,100: kept, for colours of wide gamuts have them\n",
             paths[0], paths[1]);
    for (int threads = 1; threads <= 7; threads += 3) {
        RetexTexture *textures[RETEX_MAX_TARGETS];
        heard.text[0] = '\0';
        test_must(retex_textures_load(textures, set, specs, 2, threads, &err), &err);
        assert_string_equal(heard.text, expected);
        retex_textures_close(textures);
    }
    retex_image_free(&im);
    retex_set_close(&set);
}

static void test_constants(void **state)
{
    (void)state;
    static const struct {
        const char *color, *says;
    } cases[] = {
        {"rgb(1,1,1)", ""},
        {"rgb(0,0.5,1)", ""},
        {"rgb(1.5,0,0)", "Floor=rgb(1.5,0,0): a surface of a colour above 1 gives back more light than it gets\n"},
        {"rgb(255,128,0)", "Floor=rgb(255,128,0): a surface of a colour above 1 gives back more light than it gets; if "
                           "numbers from 0 to 255 are meant, it is rgb(1,0.216,0)\n"},
        {"rgb(0,0,1e30)", "Floor=rgb(0,0,1e+30): a surface of a colour above 1 gives back more light than it gets; it "
                          "is taken as 65504 at most\n"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        char argument[64];
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        RetexTexture *texture;
        RetexError err = {0};
        Heard heard = {""};
        float p[4];
        snprintf(argument, sizeof argument, "Floor=%s", cases[k].color);
        test_must(test_texture_spec(&spec, NULL, argument, &err), &err);
        spec.warn = hear;
        spec.warn_context = &heard;
        test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
        assert_string_equal(heard.text, cases[k].says);
        retex_texture_point(texture, .5, .5, p);
        assert_true(p[0] <= 65504 && p[1] <= 65504 && p[2] <= 65504);
        retex_texture_close(&texture);
    }
}

static int keep(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    (void)err;
    float *to = context;
    memcpy(to + (size_t)y0 * 3 * 24, rows, (size_t)(y1 - y0) * 3 * 24 * sizeof *to);
    return 0;
}

/* The largest textures of either sign, on terms of many factors: the picture and its error are numbers, and those that
 * overflowed stay as large as can be. */
static void test_no_result_overflows(void **state)
{
    (void)state;
    RetexSet *set = test_set(24, 20, 3);
    RetexError err = {0};
    for (int i = 0; i < set->nterms; i++) /* each factor four times */
        while (set->terms[i].nfactors > 0 && set->terms[i].nfactors < 9) {
            set->terms[i].factors[set->terms[i].nfactors] = set->terms[i].factors[0];
            set->terms[i].nfactors++;
        }
    float rows[3 * 24 * 20];
    for (int sign = 0; sign < 2; sign++) {
        RetexImage im = {0};
        RetexTexture *textures[RETEX_MAX_TARGETS] = {0};
        int huge = 0;
        test_random_image(&im, 8, 8, 3, 1, 1e38, 3e38);
        for (int i = 0; i < 3 * 64 && sign; i++)
            im.pixels[i] = i / 3 % 2 ? -3e38f : 3e38f;
        test_must(retex_texture_create(&textures[0], &im, NULL, 0, &err), &err);
        test_must(retex_texture_create(&textures[1], &im, NULL, 0, &err), &err);
        test_must(retex_retexture(set, textures, NULL, keep, rows, 2, &err), &err);
        for (int i = 0; i < 3 * 24 * 20; i++) {
            assert_true(isfinite(rows[i]));
            huge += fabsf(rows[i]) > 1e30f;
        }
        assert_true(huge > 20);
        test_must(retex_estimate_error(set, textures, NULL, keep, rows, 2, &err), &err);
        for (int i = 0; i < 3 * 24 * 20; i++)
            assert_true(isfinite(rows[i]) && rows[i] >= 0);
        retex_textures_close(textures);
        retex_image_free(&im);
    }
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_becomes_of_texels),
        cmocka_unit_test(test_files),
        cmocka_unit_test(test_constants),
        cmocka_unit_test(test_no_result_overflows),
    };
    return cmocka_run_group_tests(tests, test_make_folder, test_remove_folder);
}
