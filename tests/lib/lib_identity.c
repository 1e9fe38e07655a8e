/* See lib_identity.h. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <math.h>
#include "lib_identity.h"
#include <retex/combine.h>
#include <retex/laid.h>

enum { WIDTH = 16, HEIGHT = 12 };

static RetexSet *render(Scene *scene, const RenderParams *params)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    if (render_scene(&set, scene, params, NULL, &err))
        fail_msg("render: %s", err.message);
    return set;
}

RetexSet *render_text(const char *text, int width, int height, int spp, int plain, int max_depth)
{
    Scene *scene = test_scene(text);
    RenderParams p = RENDER_PARAMS_INIT;
    scene->width = width, scene->height = height;
    p.spp = spp, p.plain = plain, p.nthreads = 2, p.max_depth = max_depth;
    RetexSet *set = render(scene, &p);
    scene_close(&scene);
    return set;
}

void mean_color(const RetexSet *set, double mean[3])
{
    const RetexImage *image = &set->parts[0].image;
    mean[0] = mean[1] = mean[2] = 0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++)
                mean[c] +=
                    (double)image->pixels[retex_image_index(image, x, y) + (size_t)c] / image->width / image->height;
}

static void assert_pictures(const RetexImage *a, const RetexImage *b, double tolerance, const char *what)
{
    for (size_t i = 0; i < (size_t)a->width * (size_t)a->height * 3; i++)
        if (!(fabs((double)a->pixels[i] - (double)b->pixels[i]) <= tolerance * (0.01 + (double)b->pixels[i])))
            fail_msg("%s: sample %zu is %.6f, should be %.6f", what, i, (double)a->pixels[i], (double)b->pixels[i]);
}

void assert_identity(const char *text, const char *target, int spp, int max_depth)
{
    Scene *scene = test_scene(text);
    RenderParams p = RENDER_PARAMS_INIT;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    RenderVariant replaced = {{NULL}, NULL};
    RetexImage again = {0};
    assert_int_equal(scene_resolve_targets(scene, &target, 1, NULL), 0);
    scene->width = WIDTH, scene->height = HEIGHT;
    p.spp = spp, p.nthreads = 2, p.max_depth = max_depth;
    RetexSet *set = render(scene, &p);
    p.plain = 1;
    RetexSet *plain = render(scene, &p);
    assert_true(set->folded == 0);
    assert_pictures(&set->parts[0].image, &plain->parts[0].image, 1e-5, "plain against set");
    assert_int_equal(retex_combine(&again, set, NULL, NULL, 0, NULL), 0);
    assert_pictures(&again, &plain->parts[0].image, 1e-3, "unedited"); /* footprints are rounded on purpose */
    retex_image_free(&again);
    retex_set_close(&plain);

    strcpy(spec.target, target);
    spec.constant = 1, spec.color[0] = 0.9f, spec.color[1] = 0.3f, spec.color[2] = 0.05f;
    RetexTexture *texture = NULL;
    assert_int_equal(retex_texture_load(&texture, &spec, 1, NULL), 0);
    replaced.textures[0] = texture;
    p.variants = &replaced, p.nvariants = 1;
    plain = render(scene, &p);
    assert_int_equal(retex_sample(set, &spec, 1, 0, NULL), 0);
    assert_int_equal(retex_combine(&again, set, NULL, NULL, 0, NULL), 0);
    assert_pictures(&again, &plain->parts[0].image, 5e-3, "recoloured");
    retex_image_free(&again);
    retex_texture_close(&texture);
    retex_set_close(&plain);
    retex_set_close(&set);
    scene_close(&scene);
}
