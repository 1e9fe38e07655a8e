/* Variants of textures on the same paths, and what control variates need: moments, and halves. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include "path/path.h"
#include "lib_stage.h"
#include "set/laid.h"

enum { BEYOND_A_WAVE = PATHS_MAX + 7 }; /* samples: some paths go side by side, the rest after them */

static void variants_share_paths(void **state)
{
    (void)state;
    /* each variant is to the bit what it is alone; they differ; moments are those of the pictures */
    Stage s;
    stage_open_targets(&s);
    RenderVariant variants[3] = {{{NULL}, NULL}, {{NULL}, NULL}, {{NULL}, NULL}};
    RetexTexture *textures[2];
    for (int k = 0; k < 2; k++) {
        RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
        spec.constant = 1, spec.color[k] = 0.7f;
        assert_int_equal(retex_texture_load(&textures[k], &spec, 1, NULL), 0);
        variants[k].textures[0] = textures[k];
    }
    variants[1].textures[1] = textures[0];
    RenderParams p = RENDER_PARAMS_INIT;
    RetexImage pictures[3] = {{0}};
    p.spp = 16, p.variants = variants, p.nvariants = 3, p.nthreads = 2;
    assert_int_equal(render_variants(pictures, s.scene, &p, NULL, NULL), 0);
    for (int k = 0; k < 3; k++) {
        s.variant = &variants[k];
        RetexSet *alone = stage_render(&s, 16, 1, 1);
        assert_memory_equal(alone->parts[0].image.pixels, pictures[k].pixels, 16 * 12 * 3 * sizeof(float));
        assert_memory_not_equal(pictures[k].pixels, pictures[(k + 1) % 3].pixels, 16 * 12 * 3 * sizeof(float));
        retex_set_close(&alone);
    }
    p.nvariants = VARIANTS_MAX + 1;
    assert_int_equal(render_variants(pictures, s.scene, &p, NULL, NULL), RETEX_EINVAL);
    for (int k = 0; k < 3; k++)
        retex_image_free(&pictures[k]);
    for (int k = 0; k < 2; k++)
        retex_texture_close(&textures[k]);
    stage_close(&s);
}

/* Control variates need each sample by itself: its light is what a picture of one more sample has more. */
static void moments_are_of_single_paths(void **state)
{
    (void)state;
    Stage s;
    stage_open_targets(&s);
    double last[16 * 12] = {0}, squares[16 * 12] = {0};
    for (int spp = 1; spp <= BEYOND_A_WAVE; spp++) {
        RetexSet *set = stage_render(&s, spp, 1, 2);
        for (int k = 0; k < 16 * 12; k++) {
            double sum = (double)spp * stage_pixel(set, k % 16, k / 16)[0], light = sum - last[k];
            squares[k] += light * light;
            last[k] = sum;
        }
        retex_set_close(&set);
    }
    for (int plain = 0; plain < 2; plain++) {
        RenderParams p = RENDER_PARAMS_INIT;
        RetexSet *with, *without = stage_render(&s, BEYOND_A_WAVE, plain, 1);
        p.spp = BEYOND_A_WAVE, p.plain = plain, p.control_data = 1, p.nthreads = 2;
        assert_int_equal(render_scene(&with, s.scene, &p, NULL, NULL), 0);
        assert_memory_equal(stage_pixel(with, 0, 0), stage_pixel(without, 0, 0), 16 * 12 * 3 * sizeof(float));
        for (int k = 0; k < 16 * 12; k++) {
            double n = BEYOND_A_WAVE, wanted = (squares[k] - last[k] * last[k] / n) / (n * (n - 1));
            stage_expect(*stage_part(with, "variance", k % 16, k / 16), wanted, 1e-7 + 1e-3 * wanted,
                         "variance of the mean");
        }
        retex_set_close(&with);
        retex_set_close(&without);
    }
    stage_close(&s);
}

/* Samples of two halves take turns; each half is what a render has of so many samples with the half's seed. */
static void halves_are_renders_of_their_own(void **state)
{
    (void)state;
    Stage s;
    stage_open_targets(&s);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexSet *both, *alone;
    p.spp = 2 * BEYOND_A_WAVE + 1, p.control_data = 2, p.nthreads = 2;
    assert_int_equal(render_scene(&both, s.scene, &p, NULL, NULL), 0);
    p.control_data = 0, p.plain = 1;
    for (int half = 0; half < 2; half++) {
        const RetexImage *found = &both->parts[retex_set_find_part(both, half ? "beauty_b" : "beauty_a")].image;
        p.spp = BEYOND_A_WAVE + !half, p.seed = half ? hash_pair(0, 1) : 0;
        assert_int_equal(render_scene(&alone, s.scene, &p, NULL, NULL), 0);
        assert_memory_equal(found->pixels, stage_pixel(alone, 0, 0), 16 * 12 * 3 * sizeof(float));
        retex_set_close(&alone);
    }
    /* the variance of the whole is that of both, each by its share of the samples */
    const float *variance = both->parts[retex_set_find_part(both, "variance")].image.pixels,
                *a = both->parts[retex_set_find_part(both, "variance_a")].image.pixels,
                *b = both->parts[retex_set_find_part(both, "variance_b")].image.pixels;
    const double whole = 2 * BEYOND_A_WAVE + 1, more = (BEYOND_A_WAVE + 1) / whole, less = BEYOND_A_WAVE / whole;
    double sum = 0, shares = 0, swapped = 0;
    for (int i = 0; i < 16 * 12 * 3; i++) {
        stage_expect(variance[i], more * more * a[i] + less * less * b[i], 1e-9 + 1e-5 * fabs(variance[i]),
                     "variance of both halves");
        sum += variance[i], shares += more * more * a[i] + less * less * b[i];
        swapped += fabs(variance[i] - less * less * a[i] - more * more * b[i]);
    }
    assert_true(sum > 0 && swapped > 1e-4 * shares);
    retex_set_close(&both);
    stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(variants_share_paths),
        cmocka_unit_test(moments_are_of_single_paths),
        cmocka_unit_test(halves_are_renders_of_their_own),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
