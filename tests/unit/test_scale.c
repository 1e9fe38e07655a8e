/* Sets whose footprints, weights and gains are smaller than the picture, compared with the formula pixel by pixel, in
 * every way in which a set is read and used. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include <retex/retex.h>

#include "lib_error.h"
#include "lib_test.h"

enum { WIDTH = 37, HEIGHT = 23, SHARP_SCALE = 1, BROAD_SCALE = 4, LATER_SCALE = 8, GAIN_SCALE = 2 };
enum { SHARP, BROAD1, BROAD2, LATER, FOOTPRINTS };

static int add_part(RetexSet *set, const char *name, const char *letters, int scale, uint32_t *seed)
{
    RetexError err = {0};
    int part;
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, (WIDTH + scale - 1) / scale,
                                 (HEIGHT + scale - 1) / scale, &part, &err),
              &err);
    RetexImage *im = &set->parts[part].image;
    for (size_t i = 0; i < retex_image_index(im, 0, im->height); i++)
        im->pixels[i] = (float)test_random(seed);
    return part;
}

static void add_footprint(RetexSet *set, const char *name, RetexFootprintKind kind, int scale, uint32_t *seed)
{
    char text[3][32];
    RetexError err = {0};
    static const char *const what[3] = {"uv", "spread", "albedo"}, *const letters[3] = {"RGA", "RGB", "RGB"};
    int parts[3];
    for (int k = 0; k < 3; k++) {
        snprintf(text[k], sizeof text[k], "%s_%s", what[k], name);
        parts[k] = add_part(set, text[k], letters[k], scale, seed);
    }
    RetexImage *spread = &set->parts[parts[1]].image;
    for (size_t i = 0; i < retex_image_index(spread, 0, spread->height); i++)
        spread->pixels[i] *= 0.1f;
    RetexFootprint footprint = {0, set->nfootprints + 1, kind, parts[0], parts[1], parts[2], 0};
    test_must(retex_set_add_footprint(set, &footprint, NULL, &err), &err);
}

static void add_term(RetexSet *set, int radiance, int gain, int nfactors, int first, int second)
{
    RetexError err = {0};
    RetexTerm term = test_term(set, radiance, nfactors, (int[]){first, second});
    if (gain)
        test_must(retex_term_add_factor(&term, retex_factor(RETEX_FACTOR_IMAGE, gain), &err), &err);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
}

/* C0 + D (S + g S L + h M + h M L + j M), of which the broad mixture M = (w1 B1 + w2 B2) / (w1 + w2) is four times
 * smaller than the picture, the later footprint L eight times and the gain g twice; h, which has three colours, and j,
 * which has one, have the full size. */
static RetexSet *make_set(void)
{
    RetexSet *set;
    RetexError err = {0};
    uint32_t seed = 5;
    test_must(retex_set_create(&set, WIDTH, HEIGHT, &err), &err);
    strcpy(set->layout, "footprints"), strcpy(set->filter, "box");
    set->spp = 16, set->orders = 6, set->ntargets = 1;
    strcpy(set->targets[0].name, "Floor");
    set->targets[0].original = -1;
    add_part(set, "beauty", "RGB", 1, &seed);
    add_footprint(set, "sharp", RETEX_FOOTPRINT_SHARP, SHARP_SCALE, &seed);
    add_footprint(set, "broad1", RETEX_FOOTPRINT_BROAD, BROAD_SCALE, &seed);
    add_footprint(set, "broad2", RETEX_FOOTPRINT_BROAD, BROAD_SCALE, &seed);
    add_footprint(set, "interreflection", RETEX_FOOTPRINT_INTERREFLECTION, LATER_SCALE, &seed);
    RetexMixture mixture = {2,
                            {{BROAD1, add_part(set, "weight1", "R", BROAD_SCALE, &seed)},
                             {BROAD2, add_part(set, "weight2", "R", BROAD_SCALE, &seed)}}};
    test_must(retex_set_add_mixture(set, &mixture, NULL, &err), &err);
    int light = add_part(set, "light", "RGB", 1, &seed), g = add_part(set, "g", "R", GAIN_SCALE, &seed);
    int h = add_part(set, "h", "RGB", 1, &seed), j = add_part(set, "j", "R", 1, &seed);
    add_term(set, add_part(set, "indep", "RGB", 1, &seed), 0, 0, 0, 0);
    add_term(set, light, 0, 1, SHARP, 0);
    add_term(set, light, g, 2, SHARP, LATER);
    add_term(set, light, h, 1, MIXTURE(0), 0);
    add_term(set, light, h, 2, MIXTURE(0), LATER);
    add_term(set, light, j, 1, MIXTURE(0), 0);
    return set;
}

/* ---- the formula ---- */

static double pixel(const RetexImage *im, int x, int y, int c)
{
    x = x < 0 ? 0 : x >= im->width ? im->width - 1 : x;
    y = y < 0 ? 0 : y >= im->height ? im->height - 1 : y;
    return (double)im->pixels[retex_image_index(im, x, y) + (im->channels == 1 ? 0 : (size_t)c)];
}

/* Weight of a small pixel's value in one of the picture's: a tent between centres. */
static double enlarged(const RetexImage *im, int scale, int x, int y, int c)
{
    double u = (x + 0.5) / scale - 0.5, v = (y + 0.5) / scale - 0.5, sum = 0;
    if (scale == 1)
        return pixel(im, x, y, c);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            int px = (int)floor(u) + i, py = (int)floor(v) + j;
            sum += (1 - fabs(u - px)) * (1 - fabs(v - py)) * pixel(im, px, py, c);
        }
    return sum;
}

static const RetexImage *part(const RetexSet *set, const char *name)
{
    int k = retex_set_find_part(set, name);
    assert_true(k >= 0);
    return &set->parts[k].image;
}

/* Image of a footprint: what was sampled, or the original albedo. */
static const RetexImage *factor(const RetexSet *set, int footprint)
{
    const RetexImage *sampled = test_laid(set, footprint);
    return sampled ? sampled : &set->parts[set->footprints[footprint].albedo].image;
}

static RetexImage mixed(const RetexSet *set)
{
    const RetexImage *b1 = factor(set, BROAD1), *b2 = factor(set, BROAD2);
    const RetexImage *w1 = part(set, "weight1"), *w2 = part(set, "weight2");
    RetexImage mix = {0};
    test_must(retex_image_alloc(&mix, b1->width, b1->height, 3, NULL), NULL);
    for (int y = 0; y < mix.height; y++)
        for (int x = 0; x < mix.width; x++)
            for (int c = 0; c < 3; c++) {
                double a = pixel(w1, x, y, c), b = pixel(w2, x, y, c);
                mix.pixels[retex_image_index(&mix, x, y) + (size_t)c] =
                    (float)((a * pixel(b1, x, y, c) + b * pixel(b2, x, y, c)) / (a + b));
            }
    return mix;
}

/* a times b, of which b is smaller, at the size of a. */
static RetexImage multiplied(const RetexImage *a, int scale_a, const RetexImage *b, int scale_b)
{
    RetexImage product = {0};
    test_must(retex_image_alloc(&product, a->width, a->height, 3, NULL), NULL);
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            for (int c = 0; c < 3; c++)
                product.pixels[retex_image_index(&product, x, y) + (size_t)c] =
                    (float)(pixel(a, x, y, c) * enlarged(b, scale_b / scale_a, x, y, c));
    return product;
}

static void expect_formula(const RetexSet *set, const RetexImage *picture)
{
    RetexImage mix = mixed(set);
    const RetexImage *sharp = factor(set, SHARP), *later = factor(set, LATER);
    RetexImage gl = multiplied(part(set, "g"), GAIN_SCALE, later, LATER_SCALE);
    RetexImage ml = multiplied(&mix, BROAD_SCALE, later, LATER_SCALE);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            for (int c = 0; c < 3; c++) {
                double s = pixel(sharp, x, y, c), d = pixel(part(set, "light"), x, y, c);
                double m = enlarged(&mix, BROAD_SCALE, x, y, c), h = pixel(part(set, "h"), x, y, c);
                double j = pixel(part(set, "j"), x, y, c), gain = enlarged(&gl, GAIN_SCALE, x, y, c);
                double want = pixel(part(set, "indep"), x, y, c) +
                              d * (s + s * gain + h * (m + enlarged(&ml, BROAD_SCALE, x, y, c)) + j * m);
                assert_float_equal(picture->pixels[retex_image_index(picture, x, y) + (size_t)c], want, 2e-5);
            }
    retex_image_free(&mix);
    retex_image_free(&gl);
    retex_image_free(&ml);
}

static RetexTextureSpec stripes(void)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RetexImage image = {0};
    RetexError err = {0};
    test_random_image(&image, 16, 16, 3, 9, 0, 1);
    strcpy(spec.target, "Floor");
    strcpy(spec.image, "scale_texture.exr");
    test_must(retex_image_write(&image, spec.image, NULL, 1, &err), &err);
    retex_image_free(&image);
    return spec;
}

/* ---- the tests ---- */

static void test_formula(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexImage picture = {0};
    RetexError err = {0};
    test_must(retex_combine(&picture, set, NULL, NULL, 0, &err), &err);
    expect_formula(set, &picture);
    retex_image_free(&picture);
    RetexTextureSpec spec = stripes();
    test_must(retex_sample(set, &spec, 1, 0, &err), &err);
    assert_int_equal(test_laid(set, BROAD1)->width, (WIDTH + BROAD_SCALE - 1) / BROAD_SCALE);
    test_must(retex_combine(&picture, set, NULL, NULL, 0, &err), &err);
    expect_formula(set, &picture);
    retex_image_free(&picture);
    retex_set_close(&set);
    unlink(spec.image);
}

static int keep_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    RetexImage *picture = context;
    (void)err;
    assert_int_equal(y0 % RETEX_PICTURE_STRIP, 0);
    memcpy(picture->pixels + retex_image_index(picture, 0, y0), rows,
           sizeof *rows * 3 * (size_t)picture->width * (size_t)(y1 - y0));
    return 0;
}

/* The set stays in its file, of one kind or another, and row by row comes the same picture; loaded it is whole. */
static void expect_open(const RetexTextureSpec *spec, const RetexImage *picture)
{
    RetexSet *set;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexImage other = {0};
    RetexError err = {0};
    test_must(retex_set_read("scale.exr", &set, 0, &err), &err);
    for (int compress = 0; compress < 2; compress++) {
        RetexStoreParams store = RETEX_STORE_INIT;
        RetexSet *open;
        store.compress = compress;
        test_must(retex_set_write(set, "open.exr", &store, 0, &err), &err);
        test_must(retex_set_open("open.exr", &open, 0, &err), &err);
        assert_null(open->parts[3].image.pixels);
        test_must(retex_textures_load(textures, open, spec, 1, 0, &err), &err);
        assert_int_equal(retex_sample(open, spec, 1, 0, &err), RETEX_EINVAL);
        assert_int_equal(open->nparts, set->nparts);
        test_must(retex_image_alloc(&other, WIDTH, HEIGHT, 3, &err), &err);
        test_must(retex_retexture(open, textures, NULL, keep_rows, &other, 0, &err), &err);
        assert_memory_equal(other.pixels, picture->pixels, sizeof(float) * 3 * WIDTH * HEIGHT);
        retex_image_free(&other);
        retex_textures_close(textures);
        test_must(retex_set_load(open, 0, &err), &err);
        for (int i = 0; i < set->nparts; i++)
            assert_memory_equal(open->parts[i].image.pixels, set->parts[i].image.pixels,
                                sizeof(float) * retex_image_index(&set->parts[i].image, 0, set->parts[i].image.height));
        retex_set_close(&open);
    }
    retex_set_close(&set);
    unlink("open.exr");
}

typedef struct Some {
    RetexImage *picture;
    int y0, y1, count; /* rows that may come, and how many came */
} Some;

static int keep_some(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    Some *some = context;
    assert_true(y0 >= some->y0 && y0 < y1 && y1 <= some->y1);
    some->count += y1 - y0;
    memcpy(some->picture->pixels + retex_image_index(some->picture, 0, y0), rows,
           sizeof *rows * 3 * WIDTH * (size_t)(y1 - y0));
    (void)err;
    return 0;
}

/* Some rows, and some columns of them, are those of the whole picture. */
static void expect_rows(const RetexSet *set, RetexTexture *const *textures, const RetexImage *picture)
{
    static const int parts[][2] = {
        {0, 1}, {0, HEIGHT}, {HEIGHT - 1, HEIGHT}, {3, HEIGHT / 2}, {HEIGHT / 2, HEIGHT - 2}};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        RetexImage other = {0};
        RetexError err = {0};
        RetexCombineParams params = RETEX_COMBINE_INIT;
        Some some = {&other, params.y0 = parts[i][0], params.y1 = parts[i][1], 0};
        const size_t first = retex_image_index(picture, 0, some.y0),
                     floats = retex_image_index(picture, 0, some.y1) - first;
        test_must(retex_image_alloc(&other, WIDTH, HEIGHT, 3, &err), &err);
        test_must(retex_retexture(set, textures, &params, keep_some, &some, 1, &err), &err);
        assert_int_equal(some.count, some.y1 - some.y0);
        assert_memory_equal(other.pixels + first, picture->pixels + first, floats * sizeof(float));
        params.x0 = (int)(3 * i);
        params.x1 = WIDTH - (int)i;
        memset(other.pixels, 1, sizeof(float) * 3 * WIDTH * HEIGHT);
        test_must(retex_retexture(set, textures, &params, keep_some, &some, 2, &err), &err);
        for (int y = params.y0; y < params.y1; y++) {
            const size_t at = retex_image_index(picture, params.x0, y);
            assert_memory_equal(other.pixels + at, picture->pixels + at,
                                sizeof(float) * 3 * (size_t)(params.x1 - params.x0));
        }
        retex_image_free(&other);
    }
}

/* In one pass, and by samples that went through a file or a stream, comes the same picture. */
static void test_doors(void **state)
{
    (void)state;
    RetexSet *set = make_set(), *back, *samples;
    RetexTextureSpec spec = stripes();
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexImage picture = {0}, other = {0};
    RetexError err = {0};
    const size_t bytes = sizeof(float) * 3 * WIDTH * HEIGHT;
    retex_set_identify(set);
    test_combine(&picture, set, &spec, 1, NULL);
    test_must(retex_image_alloc(&other, WIDTH, HEIGHT, 3, &err), &err);
    test_must(retex_textures_load(textures, set, &spec, 1, 0, &err), &err);
    for (int threads = 1; threads < 4; threads++) {
        memset(other.pixels, 0, bytes);
        test_must(retex_retexture(set, textures, NULL, keep_rows, &other, threads, &err), &err);
        assert_memory_equal(other.pixels, picture.pixels, bytes);
    }
    expect_rows(set, textures, &picture);
    retex_textures_close(textures);
    test_must(retex_sample(set, &spec, 1, 1, &err), &err);
    for (int stream = 0; stream < 2; stream++) {
        if (!stream) {
            test_must(retex_set_write_samples(set, "samples.exr", NULL, 0, &err), &err);
            retex_set_lift(set, -1);
        }
        test_must(retex_set_write(set, "scale.exr", NULL, 0, &err), &err);
        test_must(retex_set_read("scale.exr", &back, 0, &err), &err);
        if (!stream) {
            test_must(retex_set_open_any("samples.exr", &samples, 0, &err), &err);
            test_must(retex_set_lay(back, samples, &err), &err);
            retex_set_close(&samples);
            test_must(retex_sample(set, &spec, 1, 1, &err), &err);
        }
        retex_image_free(&other);
        test_must(retex_combine(&other, back, NULL, NULL, 0, &err), &err);
        assert_memory_equal(other.pixels, picture.pixels, bytes);
        assert_true(retex_term_image(&back->terms[2]) > 0 && retex_term_image(&back->terms[0]) < 0);
        retex_set_close(&back);
    }
    unlink("samples.exr");
    retex_set_lift(set, -1);
    test_must(retex_set_write(set, "scale.exr", NULL, 0, &err), &err);
    expect_open(&spec, &picture);
    retex_image_free(&other);
    retex_image_free(&picture);
    retex_set_close(&set);
    unlink("scale.exr");
    unlink(spec.image);
}

/* The error to be expected is there wherever the texture scatters, and nowhere else. */
static void test_estimate(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexTextureSpec specs[2] = {stripes(), RETEX_TEXTURE_SPEC_INIT};
    strcpy(specs[1].target, "Floor");
    specs[1].constant = 1;
    for (int k = 0; k < 2; k++) {
        RetexImage error = test_error(set, &specs[k], 1, 0);
        double sum = 0;
        for (size_t i = 0; i < 3 * WIDTH * HEIGHT; i++)
            sum += (double)error.pixels[i];
        assert_true(k ? sum == 0 : sum > 0 && isfinite(sum));
        retex_image_free(&error);
    }
    retex_set_close(&set);
    unlink(specs[0].image);
}

/* What cannot be is refused: a size that is none, a mixture of several, a gain that is the picture. */
static void test_what_cannot_be(void **state)
{
    (void)state;
    RetexSet *set = make_set();
    RetexError err = {0};
    RetexImage picture = {0};
    RetexImage *weight = &set->parts[set->mixtures[0].shares[1].weight].image;
    weight->width--;
    assert_int_equal(retex_combine(&picture, set, NULL, NULL, 0, &err), RETEX_EFORMAT);
    assert_non_null(strstr(err.message, "mixture"));
    weight->width++;
    RetexImage *gain = &set->parts[retex_term_image(&set->terms[2])].image;
    gain->height--;
    assert_int_equal(retex_combine(&picture, set, NULL, NULL, 0, &err), RETEX_EFORMAT);
    gain->height++;
    RetexTerm term = set->terms[2];
    term.factors[2].index = set->nparts;
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    term.factors[2].index = 0; /* the picture */
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    term.factors[2].index = set->footprints[0].uv;
    strcpy(set->parts[set->footprints[0].uv].letters, "RG");
    assert_int_equal(retex_set_add_term(set, &term, NULL, &err), RETEX_EINVAL);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_formula),
        cmocka_unit_test(test_doors),
        cmocka_unit_test(test_estimate),
        cmocka_unit_test(test_what_cannot_be),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
