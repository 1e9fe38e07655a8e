/* Promises of the renderer: a set recombines to the picture, and to the picture with other colours; pictures are the
 * same to the bit for any number of threads. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>
#include <string.h>
#include <retex/combine.h>
#include <retex/laid.h>
#include "lib_stage.h"
#include "set/laid.h"

static void bits_do_not_depend_on_threads(void **state)
{
    (void)state;
    RetexSet *sets[3];
    const int threads[3] = {1, 2, 7};
    Stage s;
    stage_open_targets(&s);
    s.scene->width = 70, s.scene->height = 50;
    for (int k = 0; k < 3; k++)
        sets[k] = stage_render(&s, 8, 0, threads[k]);
    for (int k = 1; k < 3; k++) {
        assert_int_equal(sets[k]->nparts, sets[0]->nparts);
        assert_true(sets[k]->folded == sets[0]->folded);
        for (int p = 0; p < sets[0]->nparts; p++) {
            const RetexImage *a = &sets[0]->parts[p].image, *b = &sets[k]->parts[p].image;
            assert_string_equal(sets[k]->parts[p].name, sets[0]->parts[p].name);
            assert_memory_equal(a->pixels, b->pixels,
                                (size_t)a->width * (size_t)a->height * (size_t)a->channels * sizeof(float));
        }
    }
    for (int k = 0; k < 3; k++)
        retex_set_close(&sets[k]);
    stage_close(&s);
}

static void compare(const RetexImage *a, const RetexImage *b, double tolerance, const char *what)
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height * 3; i++)
        if (!(fabs(a->pixels[i] - b->pixels[i]) <= tolerance * (0.01 + b->pixels[i])))
            fail_msg("%s: sample %zu is %.6f, should be %.6f", what, i, a->pixels[i], b->pixels[i]);
}

/* shiny: a floor with a smooth coat, and a ball that is half a rough metal. Some hits have a black dependent part then,
 * others have both parts. */
static void check_recombining(int paper, int shiny)
{
    /* constant originals: the polynomial is the picture; other constants: it is the other picture */
    Stage s;
    stage_open_targets(&s);
    for (int k = 0; k < 2 && shiny; k++) {
        s.finishes[k].retex.present = 1, s.finishes[k].retex.ior = 1.5, s.finishes[k].retex.specular_tint = 1;
        s.finishes[k].retex.metallic = 0.6 * k, s.finishes[k].retex.roughness = 0.4 * k;
    }
    s.paper = paper;
    s.max_depth = paper ? RETEX_MAX_ORDERS + 1 : 5; /* no path has more hits than the set keeps: nothing is folded */
    RetexSet *set = stage_render(&s, 32, 0, 2), *plain = stage_render(&s, 32, 1, 2);
    assert_int_equal(plain->nterms, 0);
    assert_string_equal(set->layout, paper ? "paper" : "footprints");
    assert_true(set->folded == 0);
    compare(&plain->parts[0].image, &set->parts[0].image, 1e-5, "plain against set");
    RetexImage again = {0};
    assert_int_equal(retex_combine(&again, set, NULL, NULL, 0, NULL), 0);
    compare(&again, &set->parts[0].image, paper ? 1e-4 : 1e-3, "unedited"); /* footprints: rounded on purpose */
    retex_image_free(&again);
    retex_set_close(&plain);

    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    RetexTexture *textures[2];
    const float colors[2][3] = {{0.9f, 0.3f, 0.05f}, {0.1f, 0.05f, 0.8f}};
    RenderVariant replaced = {{NULL}, NULL};
    for (int k = 0; k < 2; k++) {
        strcpy(specs[k].target, k ? "Ball" : "Floor");
        specs[k].constant = 1;
        memcpy(specs[k].color, colors[k], sizeof colors[k]);
        assert_int_equal(retex_texture_load(&textures[k], &specs[k], 1, NULL), 0);
        replaced.textures[k] = textures[k];
    }
    s.variant = &replaced;
    plain = stage_render(&s, 32, 1, 2);
    assert_int_equal(retex_sample(set, specs, 2, 0, NULL), 0);
    assert_int_equal(retex_combine(&again, set, NULL, NULL, 0, NULL), 0);
    compare(&again, &plain->parts[0].image, paper ? 2e-3 : 5e-3, "recoloured");
    retex_image_free(&again);
    for (int k = 0; k < 2; k++)
        retex_texture_close(&textures[k]);
    retex_set_close(&plain);
    retex_set_close(&set);
    stage_close(&s);
}

static void paper_recombines(void **state)
{
    (void)state;
    check_recombining(1, 0);
}

static void paper_recombines_shiny_targets(void **state)
{
    (void)state;
    check_recombining(1, 1);
}

static void footprints_recombine(void **state)
{
    (void)state;
    check_recombining(0, 0);
}

static void footprints_recombine_shiny_targets(void **state)
{
    (void)state;
    check_recombining(0, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits_do_not_depend_on_threads),      cmocka_unit_test(paper_recombines),
        cmocka_unit_test(paper_recombines_shiny_targets),     cmocka_unit_test(footprints_recombine),
        cmocka_unit_test(footprints_recombine_shiny_targets),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
