/* Maps of finishes: weights of a texel by grey, colours and roughness; recombination of a random set with maps, and
 * with normal maps, against loops over its pixels that follow the definition, in one pass and from samples;
 * placement and sharing of maps. */
#include "lib_error.h"
#include "lib_test.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include <retex/color.h>
#include <retex/host/texture_lookup.h>

#include "set/laid.h"
#include "texture/filter.h"
#include "texture/finish_map.h"

enum { TEXELS = 4, FINISHES = 3, SCALE = 2, KEPT = 1 + FINISHES };

static int width = 7, height = 5;

static char folder[] = "/tmp/retex-finish-maps-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char path[128];
    (void)state;
    for (int k = 0; k < 3; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, k == 0 ? "color.exr" : k == 1 ? "map.exr" : "map.png");
        unlink(path);
    }
    return rmdir(folder);
}

static unsigned seed = 1;
static float number(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (float)(seed >> 8) / (float)(1 << 24);
}

/* ---- weights ---- */

static void check_weights(const RetexTextureSpec *spec, RetexFinishScale scale, int channel, int is_grey, float r,
                          float g, float b, const float expected[4])
{
    const float rgb[3] = {r, g, b};
    float weights[RETEX_FINISHES_MAX];
    retex_finish_map_weights(spec, scale, channel, is_grey, rgb, weights);
    for (int k = 0; k < 4; k++)
        if (!(fabsf(weights[k] - expected[k]) < 1e-5f))
            fail_msg("scale %d, %g %g %g: weight %d is %g, not %g", (int)scale, (double)r, (double)g, (double)b, k,
                     (double)weights[k], (double)expected[k]);
}
#define WEIGHTS(...) ((const float[4]){__VA_ARGS__})

static void texels_have_weights(void **state)
{
    (void)state;
    RetexTextureSpec four = RETEX_TEXTURE_SPEC_INIT, two = four;
    four.nfinishes = 4, two.nfinishes = 2;
    four.roughness[0] = 0.8f, four.roughness[1] = 0.1f, four.roughness[2] = -1, four.roughness[3] = 0.4f;
    const RetexFinishScale list = RETEX_FINISH_BY_LIST, rough = RETEX_FINISH_BY_ROUGHNESS;
    check_weights(&four, list, 0, 1, 0, 0, 0, WEIGHTS(1, 0, 0, 0));
    check_weights(&four, list, 0, 1, 1, 1, 1, WEIGHTS(0, 0, 0, 1));
    check_weights(&four, list, 0, 1, 0.5f, 0.5f, 0.5f, WEIGHTS(0, 0.5f, 0.5f, 0));
    check_weights(&four, list, 0, 1, 7, 7, 7, WEIGHTS(0, 0, 0, 1));
    check_weights(&four, list, 0, 1, NAN, NAN, NAN, WEIGHTS(1, 0, 0, 0));
    check_weights(&two, list, 0, 1, 0.25f, 0.25f, 0.25f, WEIGHTS(0.75f, 0.25f, 0, 0));
    check_weights(&four, list, 0, 0, 0, 1, 0, WEIGHTS(0, 0, 1, 0));
    check_weights(&four, list, 0, 0, 0.25f, 0, 0.5f, WEIGHTS(0.25f, 0.25f, 0, 0.5f));
    check_weights(&four, list, 0, 0, 1, 1, 0, WEIGHTS(0, 0.5f, 0.5f, 0));
    check_weights(&two, list, 0, 0, 0.5f, 1, 1, WEIGHTS(0.5f, 0.5f, 0, 0));
    check_weights(&four, rough, 0, 1, 0.25f, 0, 0, WEIGHTS(0, 0.5f, 0, 0.5f));
    check_weights(&four, rough, 1, 0, 0, 0.6f, 0, WEIGHTS(0.5f, 0, 0, 0.5f));
    check_weights(&four, rough, 0, 1, 0, 0, 0, WEIGHTS(0, 1, 0, 0));
    check_weights(&four, rough, 0, 1, 0.8f, 0, 0, WEIGHTS(1, 0, 0, 0));
    check_weights(&four, rough, 0, 1, 1, 1, 1, WEIGHTS(1, 0, 0, 0));
    check_weights(&four, RETEX_FINISH_BY_GLOSS, 0, 1, 0.75f, 0, 0, WEIGHTS(0, 0.5f, 0, 0.5f));
    assert_true(retex_finish_map_has_scale(&four));
    four.roughness[0] = four.roughness[3] = -1;
    assert_false(retex_finish_map_has_scale(&four));
}

/* ---- a set ---- */

static float color[TEXELS * TEXELS * 4], map[TEXELS * TEXELS * 3];
static int is_normal; /* 1: the map is of normals */
static float lamp[3] = {1, 1, 1}; /* of the light whose finishes are chosen */
#define TILT 20.0

static void write_texture(const char *name, const float *pixels, int channels)
{
    char path[128];
    RetexImage im = {0};
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    params.is_data = 1;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    test_must(retex_image_alloc(&im, TEXELS, TEXELS, channels, &err), &err);
    memcpy(im.pixels, pixels, sizeof *pixels * TEXELS * TEXELS * (size_t)channels);
    test_must(retex_image_write(&im, path, &params, 1, &err), &err);
    retex_image_free(&im);
}

/* Sixteenths, which halves hold; alpha is 1, or where clear a quarter of it. */
static RetexTextureSpec make_textures(int clear)
{
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        for (int c = 0; c < 3; c++)
            color[4 * i + c] = floorf(number() * 16) / 16, map[3 * i + c] = floorf(number() * 8) / 16;
        map[3 * i + 2] += is_normal ? 0.5f : 0;
        color[4 * i + 3] = clear && i % 3 == 0 ? 0.25f : 1;
    }
    write_texture("color.exr", color, 4);
    write_texture("map.exr", map, 3);
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    strcpy(spec.target, "Floor");
    snprintf(spec.image, sizeof spec.image, "%s/color.exr", folder);
    snprintf(spec.finish, sizeof spec.finish, "%s/map.exr", folder);
    spec.normal = is_normal ? RETEX_NORMAL_BY_NAME : RETEX_NORMAL_NONE;
    return spec;
}

static int add_part(RetexSet *set, const char *letters, int scale, float least)
{
    char name[64];
    RetexError err = {0};
    int part;
    snprintf(name, sizeof name, "part%d", set->nparts);
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, (width + scale - 1) / scale,
                                 (height + scale - 1) / scale, &part, &err),
              &err);
    RetexImage *image = &set->parts[part].image;
    for (int i = 0; i < image->width * image->height * image->channels; i++)
        image->pixels[i] = least + number() * (1 - least);
    return part;
}

static int add_footprint(RetexSet *set, RetexFootprintKind kind, int scale)
{
    RetexError err = {0};
    RetexFootprint f = {.target = 0, .hit = set->nfootprints + 1, .kind = kind};
    f.uv = add_part(set, "RGA", scale, 0);
    f.spread = add_part(set, "RG", scale, 0);
    f.albedo = add_part(set, "RGB", scale, 0);
    RetexImage *spread = &set->parts[f.spread].image, *uv = &set->parts[f.uv].image;
    for (int i = 0; i < 2 * spread->width * spread->height; i++)
        spread->pixels[i] *= 0.2f;
    for (int i = 0; i < uv->width * uv->height && kind == RETEX_FOOTPRINT_SHARP; i++)
        if (i % 4 == 0)
            uv->pixels[3 * i + 2] = 0; /* the broad one decides there */
    int index;
    test_must(retex_set_add_footprint(set, &f, &index, &err), &err);
    return index;
}

/* The light of every kept part: none; sharp; an image, sharp and later; a mixture; a mixture of later alone. */
enum { SHARP, BROAD, LATER, SHAPES = 5, GAIN = 1 };

static RetexSet *make_set(void)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    int index;
    test_must(retex_set_create(&set, width, height, &err), &err);
    strcpy(set->layout, "footprints");
    strcpy(set->filter, "box");
    set->spp = 16;
    RetexTarget target = {
        .name = "Floor", .original = -1, .nfinishes = FINISHES, .finish = 1, .normal_tilt = is_normal ? TILT : 0};
    for (int k = 0; k < FINISHES; k++)
        snprintf(target.finishes[k], sizeof target.finishes[k], "finish%d", k);
    test_must(retex_set_add_target(set, &target, &index, &err), &err);
    add_part(set, "RGB", 1, 0);
    add_part(set, "R", 1, 0.5f); /* GAIN */
    add_footprint(set, RETEX_FOOTPRINT_SHARP, 1);
    add_footprint(set, RETEX_FOOTPRINT_BROAD, SCALE);
    add_footprint(set, RETEX_FOOTPRINT_INTERREFLECTION, SCALE);
    for (int footprint = BROAD; footprint <= LATER; footprint++) {
        RetexMixture mixture = {.nshares = 1, .shares = {{footprint, add_part(set, "R", SCALE, 0.5f)}}};
        test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    }
    for (int k = 0; k < KEPT; k++) {
        RetexParameter p = {.kind = RETEX_PARAMETER_COLOR, .target = -1};
        snprintf(p.name, sizeof p.name, "kept%d", k);
        p.finishes[0] = (signed char)k;
        for (int c = 0; c < 3; c++)
            p.value[c] = k < 2, p.kept[c] = k ? 1.0f / FINISHES : 1;
        test_must(retex_set_add_parameter(set, &p, &index, &err), &err);
        for (int shape = 0; shape < SHAPES; shape++) {
            RetexTerm t = {
                .role = RETEX_ROLE_LAMP, .target = shape && shape < 4 ? 0 : -1, .radiance = add_part(set, "RGB", 1, 0)};
            if (shape == 2)
                t.factors[t.nfactors++] = retex_factor(RETEX_FACTOR_IMAGE, GAIN);
            if (shape == 1 || shape == 2)
                t.factors[t.nfactors++] = retex_factor(RETEX_FACTOR_FOOTPRINT, SHARP);
            if (shape == 2)
                t.factors[t.nfactors++] = retex_factor(RETEX_FACTOR_FOOTPRINT, LATER);
            if (shape == 3 || shape == 4)
                t.factors[t.nfactors++] = retex_factor(RETEX_FACTOR_MIXTURE, shape == 4);
            t.factors[t.nfactors++] = retex_factor(RETEX_FACTOR_PARAMETER, k);
            test_must(retex_set_add_term(set, &t, NULL, &err), &err);
        }
    }
    return set;
}

/* ---- the definition ---- */

/* By 1 + finish, 0 being none: the colour times the weight of the finish; the weight alone. */
static RetexTexture *colors[1 + FINISHES], *weights_of[1 + FINISHES];

/* The weight of a finish at texel i of the map, k from 1. */
static float weight_at(int i, int k)
{
    const float *p = map + 3 * i, others = p[0] + p[1];
    if (!is_normal)
        return k == 1 ? 1 - others : p[k - 2];
    const double x = 2 * (double)p[0] - 1, y = 2 * (double)p[1] - 1, z = 2 * (double)p[2] - 1,
                 length = sqrt(x * x + y * y + z * z), s = sin(TILT * M_PI / 180), c = cos(TILT * M_PI / 180);
    return (float)((k == 1 ? z - (x + y) * c / s : k == 2 ? x / s : y / s) / length);
}

static void open_products(void)
{
    RetexImage product = {0}, weight = {0};
    RetexError err = {0};
    test_must(retex_image_alloc(&product, TEXELS, TEXELS, 4, &err), &err);
    test_must(retex_image_alloc(&weight, TEXELS, TEXELS, 4, &err), &err);
    for (int k = 0; k <= FINISHES; k++) {
        for (int i = 0; i < TEXELS * TEXELS; i++) {
            const float w = k == 0 ? 1 : weight_at(i, k);
            for (int c = 0; c < 4; c++) {
                product.pixels[4 * i + c] = color[4 * i + c] * (c < 3 ? w : 1);
                weight.pixels[4 * i + c] = c < 3 ? w : color[4 * i + 3];
            }
        }
        test_must(retex_texture_create(&colors[k], &product, NULL, 1, &err), &err);
        test_must(retex_texture_create(&weights_of[k], &weight, NULL, 1, &err), &err);
    }
    retex_image_free(&product);
    retex_image_free(&weight);
}

static void close_products(void)
{
    for (int k = 0; k <= FINISHES; k++) {
        retex_texture_close(&colors[k]);
        retex_texture_close(&weights_of[k]);
    }
}

/* The mean colour with a finish, -1: none, and the mean weight, over what shows where the texture is clear. */
static void look_up(const RetexSet *set, const RetexFootprint *f, size_t i, int finish, int shown, double rgb[3],
                    double *w)
{
    const float *uv = set->parts[f->uv].image.pixels + 3 * i, *spread = set->parts[f->spread].image.pixels + 2 * i,
                *albedo = set->parts[f->albedo].image.pixels + 3 * i;
    const RetexTextureFilter filter = f->kind == RETEX_FOOTPRINT_SHARP ? RETEX_TEXTURE_DISC : RETEX_TEXTURE_BROAD;
    float c[4], own[4];
    retex_texture_filter(colors[1 + finish], filter, uv, spread, 2, 1, c, 4);
    retex_texture_filter(weights_of[1 + finish], filter, uv, spread, 2, 1, own, 4);
    const double alpha = (double)c[3], shows = finish < 0 || finish == shown ? 1 - alpha : 0;
    for (int k = 0; k < 3; k++)
        rgb[k] = alpha * (double)c[k] + shows * (double)albedo[k];
    *w = alpha * (double)own[0] + shows;
}

/* Four numbers at a pixel of a footprint: its colour with a finish and 0, or its weights times coverage and that. */
static void footprint_at(const RetexSet *set, int footprint, int x, int y, int finish, int shown, int weights,
                         double out[4])
{
    const RetexFootprint *f = &set->footprints[footprint];
    const size_t i = (size_t)y * (size_t)set->parts[f->uv].image.width + (size_t)x;
    const float *uv = set->parts[f->uv].image.pixels + 3 * i;
    double w;
    memset(out, 0, 4 * sizeof *out);
    if (!(uv[2] > 0))
        return;
    if (!weights) {
        look_up(set, f, i, finish, shown, out, &w);
        return;
    }
    static const double importance[] = {1, 1, 1e-3, 1e-6};
    const double share = importance[f->kind] * (double)uv[2];
    for (int k = 0; k < FINISHES; k++) {
        double rgb[3];
        look_up(set, f, i, k, shown, rgb, &w);
        out[k] = share * w;
    }
    out[3] = share;
}

/* The same at a pixel of the picture: reduced ones are enlarged, their values lying at the centres of their pixels. */
static void enlarged_at(const RetexSet *set, int footprint, int x, int y, int finish, int shown, int weights,
                        double out[4])
{
    const RetexImage *image = &set->parts[set->footprints[footprint].uv].image;
    const int scale = image->width == width ? 1 : SCALE;
    const double px = (x + 0.5) / scale - 0.5, py = (y + 0.5) / scale - 0.5;
    memset(out, 0, 4 * sizeof *out);
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            double own[4];
            const int cx = (int)fmin(fmax(floor(px) + i, 0), image->width - 1),
                      cy = (int)fmin(fmax(floor(py) + j, 0), image->height - 1);
            const double share = (i ? px - floor(px) : 1 - px + floor(px)) * (j ? py - floor(py) : 1 - py + floor(py));
            footprint_at(set, footprint, cx, cy, finish, shown, weights, own);
            for (int c = 0; c < 4; c++)
                out[c] += share * own[c];
        }
}

static double gate_at(const RetexSet *set, int x, int y, int finish, int shown)
{
    double sum[4] = {0}, own[4];
    for (int f = 0; f < set->nfootprints; f++) {
        enlarged_at(set, f, x, y, -1, shown, 1, own);
        for (int c = 0; c < 4; c++)
            sum[c] += own[c];
    }
    return sum[3] > 0 ? sum[finish] / sum[3] : finish == shown;
}

/* What a picture is: light that met no target, and of each finish that whose first hit has it. */
static void expected_at(const RetexSet *set, int x, int y, int shown, double rgb[3])
{
    memset(rgb, 0, 3 * sizeof *rgb);
    for (int t = 0; t < set->nterms; t++) {
        const int k = t / SHAPES - 1, shape = t % SHAPES;
        const float *light = set->parts[set->terms[t].radiance].image.pixels + 3 * (y * width + x);
        double first[4] = {1, 1, 1}, later[4] = {1, 1, 1}, gate = 1;
        if (shape == 2)
            gate = (double)set->parts[GAIN].image.pixels[y * width + x];
        if (shape == 1 || shape == 2)
            enlarged_at(set, SHARP, x, y, k, shown, 0, first);
        if (shape == 3) /* the weights of one share cancel */
            enlarged_at(set, BROAD, x, y, k, shown, 0, first);
        if (shape == 2 || shape == 4)
            enlarged_at(set, LATER, x, y, -1, shown, 0, later);
        if (is_normal && shape == 0) /* no diffuse lobe reflected it: normals do not matter */
            gate = k <= 0;
        else if (k >= 0 && (shape == 0 || shape == 4))
            gate = gate_at(set, x, y, k, shown);
        for (int c = 0; c < 3; c++)
            rgb[c] += (double)light[c] * first[c] * later[c] * gate * (k >= 0 ? (double)lamp[c] : 1);
    }
}

static void compare(const RetexSet *set, const RetexImage *picture, int shown, const char *what)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double rgb[3];
            expected_at(set, x, y, shown, rgb);
            for (int c = 0; c < 3; c++) {
                rgb[c] = is_normal ? fmax(rgb[c], 0) : rgb[c];
                const double got = (double)picture->pixels[3 * (y * width + x) + c];
                if (!(fabs(got - rgb[c]) < 2e-4 * (1 + rgb[c])))
                    fail_msg("%s, pixel %d,%d channel %d: %g, not %g", what, x, y, c, got, rgb[c]);
            }
        }
}

static void check_pictures(int clear, int shown)
{
    const RetexTextureSpec spec = make_textures(clear);
    RetexSet *set = make_set();
    open_products();
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexImage picture = {0};
    RetexError err = {0};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    float values[3 * KEPT];
    for (int i = 0; i < 3 * KEPT; i++)
        values[i] = i / 3 == 0 ? 1 : i / 3 == 1 + shown ? lamp[i % 3] : 0;
    params.parameters = values;
    test_must(retex_textures_load(textures, set, &spec, 1, 2, &err), &err);
    test_must(retex_image_alloc(&picture, width, height, 3, &err), &err);
    test_must(retex_retexture(set, textures, &params, retex_image_keep_rows, &picture, 2, &err), &err);
    compare(set, &picture, shown, "in one pass");
    if (shown == 0) { /* samples have the finish as rendered where the texture is clear */
        test_must(retex_sample(set, &spec, 1, 2, &err), &err);
        test_must(retex_combine(&picture, set, &params, NULL, 2, &err), &err);
        compare(set, &picture, shown, "from samples");
        assert_true(set->footprints[SHARP].finished[1] > 0);
        set->footprints[SHARP].finished[1] = 0; /* as a damaged file may say */
        assert_int_equal(retex_combine(&picture, set, &params, NULL, 2, &err), RETEX_EFORMAT);
    }
    retex_image_free(&picture);
    retex_textures_close(textures);
    close_products();
    retex_set_close(&set);
}

static void pictures_follow_the_definition(void **state)
{
    (void)state;
    check_pictures(0, 0);
    check_pictures(0, 2);
    check_pictures(1, 0);
    check_pictures(1, 1);
}

/* Light of one colour alone has the finish that is shown, as light of all. */
static void light_has_a_color(void **state)
{
    (void)state;
    for (int c = 0; c < 3; c++) {
        for (int k = 0; k < 3; k++)
            lamp[k] = k == c ? 0.5f : 0;
        check_pictures(1, 2);
    }
    for (int k = 0; k < 3; k++)
        lamp[k] = 1;
}

/* Rows that are filtered in several calls. */
static void rows_may_be_long(void **state)
{
    (void)state;
    width = 1030, height = 2;
    check_pictures(1, 0);
    width = 7, height = 5;
}

static void pictures_with_normals_follow_it_too(void **state)
{
    (void)state;
    is_normal = 1;
    check_pictures(0, 0);
    check_pictures(1, 0);
    is_normal = 0;
}

/* ---- one map for several placements ---- */

static void placed_maps_share_texels(void **state)
{
    (void)state;
    RetexTextureSpec spec = make_textures(0);
    RetexTexture *texture = NULL, *placed = NULL;
    RetexError err = {0};
    spec.nfinishes = FINISHES;
    test_must(retex_texture_load(&texture, &spec, 1, &err), &err);
    spec.rotate = 90, spec.scale[0] = 2;
    test_must(retex_texture_place(&placed, texture, &spec, &err), &err);
    RetexTexture *own = NULL;
    test_must(retex_texture_load(&own, &spec, 1, &err), &err);
    for (int i = 0; i < 20; i++) {
        float a[4], b[4], sum = 0;
        const double u = (double)number(), v = (double)number();
        assert_int_equal(retex_texture_finishes(placed, u, v, 0, a), FINISHES);
        assert_int_equal(retex_texture_finishes(own, u, v, 0, b), FINISHES);
        for (int k = 0; k < FINISHES; k++) {
            sum += a[k];
            assert_float_equal(a[k], b[k], 1e-6);
        }
        assert_float_equal(sum, 1, 1e-5);
    }
    assert_int_equal(retex_texture_bytes(placed), 0);
    assert_true(retex_texture_bytes(own) > 0);
    retex_texture_close(&placed);
    spec.nfinishes = 2;
    assert_int_equal(retex_texture_place(&placed, texture, &spec, &err), RETEX_EINVAL);
    spec.nfinishes = FINISHES, spec.finish[0] = '\0';
    assert_int_equal(retex_texture_place(&placed, texture, &spec, &err), RETEX_EINVAL);
    retex_texture_close(&own);
    retex_texture_close(&texture);
    spec = make_textures(0);
    assert_int_equal(retex_texture_load(&texture, &spec, 1, &err), RETEX_EINVAL); /* nothing to choose from */
    assert_null(texture);
}

/* Maps of a texture that hears of its surface later lie as those of one that was made for it. */
static void maps_hear_of_a_surface(void **state)
{
    (void)state;
    RetexTextureSpec spec = make_textures(0), surface = RETEX_TEXTURE_SPEC_INIT;
    RetexTexture *told = NULL, *made = NULL;
    RetexError err = {0};
    spec.nfinishes = FINISHES, spec.width[0] = 0.5, spec.uv_scale[0] = spec.uv_scale[1] = 1;
    test_must(retex_texture_load(&told, &spec, 1, &err), &err);
    surface.uv_scale[0] = 2, surface.uv_scale[1] = 3, surface.unit = 0.1;
    test_must(retex_texture_set_surface(told, &surface, &err), &err);
    spec.uv_scale[0] = 2, spec.uv_scale[1] = 3, spec.unit = 0.1;
    test_must(retex_texture_load(&made, &spec, 1, &err), &err);
    for (int i = 0; i < 50; i++) {
        const double u = (double)number(), v = (double)number();
        float a[4], b[4];
        assert_int_equal(retex_texture_finishes(told, u, v, 0, a), FINISHES);
        assert_int_equal(retex_texture_finishes(made, u, v, 0, b), FINISHES);
        for (int k = 0; k < FINISHES; k++)
            assert_float_equal(a[k], b[k], 1e-6);
        for (int k = 0; k < FINISHES; k++) { /* and the colours of each */
            retex_texture_point(told->finishes->colors[k], u, v, a);
            retex_texture_point(made->finishes->colors[k], u, v, b);
            assert_memory_equal(a, b, sizeof a);
        }
    }
    retex_texture_close(&told);
    retex_texture_close(&made);
}

/* A map of 8 bits chooses as one of floats does, by colours where it has some and by grey where it has none. */
static void integers_choose_as_floats(void **state)
{
    (void)state;
    for (int is_grey = 0; is_grey < 2; is_grey++) {
        RetexTextureSpec spec = make_textures(0);
        RetexTexture *textures[2] = {NULL, NULL};
        RetexError err = {0};
        int second = 0, third = 0;
        for (int i = 0; i < TEXELS * TEXELS * 3 && is_grey; i++)
            map[i] = map[i - i % 3] * 2; /* up to 7/8 */
        write_texture("map.exr", map, 3);
        for (int i = 0; i < TEXELS * TEXELS * 3; i++)
            map[i] = (float)retex_srgb_decode((double)map[i]); /* which writing a PNG encodes */
        write_texture("map.png", map, 3);
        spec.nfinishes = FINISHES;
        test_must(retex_texture_load(&textures[0], &spec, 1, &err), &err);
        memcpy(strstr(spec.finish, "map.exr"), "map.png", sizeof "map.png");
        test_must(retex_texture_load(&textures[1], &spec, 1, &err), &err);
        for (int i = 0; i < 4 * TEXELS * TEXELS; i++) {
            const double u = (i % (2 * TEXELS) + 0.5) / (2 * TEXELS), v = (i / (2 * TEXELS) + 0.5) / (2 * TEXELS);
            float of[2][4];
            for (int k = 0; k < 2; k++)
                assert_int_equal(retex_texture_finishes(textures[k], u, v, 0, of[k]), FINISHES);
            for (int k = 0; k < FINISHES; k++)
                assert_float_equal(of[0][k], of[1][k], 0.006);
            second += of[0][1] > 0.1f, third += of[0][2] > 0.1f;
        }
        assert_true(second > 4 && (third > 4 || is_grey));
        for (int k = 0; k < 2; k++)
            retex_texture_close(&textures[k]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_have_weights),
        cmocka_unit_test(pictures_follow_the_definition),
        cmocka_unit_test(light_has_a_color),
        cmocka_unit_test(rows_may_be_long),
        cmocka_unit_test(pictures_with_normals_follow_it_too),
        cmocka_unit_test(placed_maps_share_texels),
        cmocka_unit_test(maps_hear_of_a_surface),
        cmocka_unit_test(integers_choose_as_floats),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
