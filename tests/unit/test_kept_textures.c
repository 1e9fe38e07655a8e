/* Textures that stay in memory from one picture to the next. Whether an image is read again shows when its file is
 * gone. */
#include "lib_filter.h"
#include "common/kept_textures.h"
#include "lib_folder.h"
#include "lib_test.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 40, HEIGHT = 24 };

typedef struct Images {
    RetexSet *set;
    RetexTextureSpec specs[3]; /* of files a, b and c, on the floor */
} Images;

static int write_images(void **state)
{
    static Images images;
    RetexImage im = {0};
    RetexError err = {0};
    RetexWriteParams params = RETEX_WRITE_INIT;
    images.set = test_set(16, 12, 1);
    for (int t = 0; t < images.set->ntargets; t++) {
        images.set->targets[t].uv_scale[0] = 2 + t;
        images.set->targets[t].uv_scale[1] = 3;
    }
    for (int k = 0; k < 3; k++) {
        const char *names[] = {"a.exr", "b.exr", "c.exr"};
        RetexTextureSpec *spec = &images.specs[k];
        *spec = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
        strcpy(spec->target, "Floor");
        snprintf(spec->image, sizeof spec->image, "%s", test_in_folder(names[k]));
        test_random_image(&im, WIDTH, HEIGHT, 3, (uint32_t)k + 1, 0, 1);
        test_must(retex_image_write(&im, spec->image, &params, 1, &err), &err);
        retex_image_free(&im);
    }
    *state = &images;
    return 0;
}

static int close_images(void **state)
{
    retex_set_close(&((Images *)*state)->set);
    return 0;
}

static void have(KeptTextures *kept, const Images *images, const RetexTextureSpec *specs, int count)
{
    RetexError err = {0};
    test_must(kept_textures_load(kept, images->set, specs, count, 2, &err), &err);
}

static int fails(KeptTextures *kept, const Images *images, const RetexTextureSpec *specs, int count)
{
    RetexError err = {0};
    return kept_textures_load(kept, images->set, specs, count, 2, &err);
}

/* The textures of the picture are those that are loaded alone. */
static void expect_same(RetexTexture *const a[RETEX_MAX_TARGETS], RetexTexture *const b[RETEX_MAX_TARGETS])
{
    uint32_t seed = 3;
    for (int t = 0; t < RETEX_MAX_TARGETS; t++) {
        assert_int_equal(!a[t], !b[t]);
        for (int k = 0; k < 50 && a[t]; k++) {
            const double u = 4 * test_random(&seed) - 2, v = 4 * test_random(&seed) - 2;
            const double cov[3] = {1e-5, 0, 2e-5}; /* some texels: the mean of all would be that of any placement */
            float x[4], y[4];
            filter_gaussian(a[t], u, v, cov, x);
            filter_gaussian(b[t], u, v, cov, y);
            assert_memory_equal(x, y, sizeof x);
        }
    }
}

/* Another placement, and another target, of an image that is in memory. */
static void test_placements(void **state)
{
    const Images *images = *state;
    RetexTextureSpec specs[2] = {images->specs[0], images->specs[0]}, other;
    RetexTexture *alone[RETEX_MAX_TARGETS];
    RetexError err = {0};
    KeptTextures kept = {.nimages = 0};
    have(&kept, images, specs, 1);
    specs[0].scale[0] = 1.7;
    specs[0].rotate = 31;
    specs[0].flip[1] = 1;
    strcpy(specs[1].target, "Wall");
    specs[1].width[0] = .3; /* by the size of the target */
    test_must(retex_textures_load(alone, images->set, specs, 2, 1, &err), &err);
    unlink(specs[0].image);
    have(&kept, images, specs, 2);
    expect_same(kept.textures, alone);
    assert_int_equal(kept.nimages, 1);
    have(&kept, images, &specs[1], 1);
    assert_null(kept.textures[retex_set_find_target(images->set, "Floor")]);

    other = specs[0]; /* other texels */
    other.wrap[0] = RETEX_WRAP_CLAMP;
    assert_int_equal(fails(&kept, images, &other, 1), RETEX_EIO);
    assert_int_equal(kept.nimages, 0);
    assert_int_equal(fails(&kept, images, specs, 2), RETEX_EIO); /* nothing is left of it */
    retex_textures_close(alone);
    kept_textures_close(&kept);
}

/* A texture that was loaded for another target. */
static void test_moved(void **state)
{
    const Images *images = *state;
    RetexTextureSpec spec = images->specs[0];
    RetexTexture *moved[RETEX_MAX_TARGETS], *alone[RETEX_MAX_TARGETS];
    RetexError err = {0};
    const int floor = retex_set_find_target(images->set, "Floor"), wall = retex_set_find_target(images->set, "Wall");
    spec.width[0] = .3;
    test_must(retex_textures_load(moved, images->set, &spec, 1, 1, &err), &err);
    strcpy(spec.target, "Wall");
    test_must(retex_textures_load(alone, images->set, &spec, 1, 1, &err), &err);
    test_must(retex_textures_move(moved[floor], images->set, wall, &err), &err);
    moved[wall] = moved[floor];
    moved[floor] = NULL;
    expect_same(moved, alone);
    retex_textures_close(moved);
    retex_textures_close(alone);
}

/* Both targets have one image, and only one of them changes, to a colour and to another image. */
static void test_targets(void **state)
{
    const Images *images = *state;
    RetexTextureSpec specs[2] = {images->specs[0], images->specs[0]};
    RetexTexture *alone[RETEX_MAX_TARGETS];
    RetexError err = {0};
    KeptTextures kept = {.nimages = 0};
    strcpy(specs[1].target, "Wall");
    specs[1].rotate = 20;
    have(&kept, images, specs, 2);
    assert_int_equal(kept.nimages, 1);
    for (int k = 0; k < 3; k++) {
        if (k == 1) {
            specs[0].constant = 1;
            specs[0].color[1] = .5f;
        } else if (k == 2) {
            specs[0] = images->specs[1];
            specs[1].wrap[0] = specs[1].wrap[1] = RETEX_WRAP_CLAMP;
        }
        have(&kept, images, specs, 2);
        test_must(retex_textures_load(alone, images->set, specs, 2, 1, &err), &err);
        expect_same(kept.textures, alone);
        retex_textures_close(alone);
    }
    assert_int_equal(kept.nimages, 2);
    specs[0] = specs[1]; /* two textures on one target */
    assert_int_equal(fails(&kept, images, specs, 2), RETEX_EINVAL);
    kept_textures_close(&kept);
}

/* As many images as memory is allowed to hold stay, the last used ones. */
static void test_memory(void **state)
{
    const Images *images = *state;
    KeptTextures kept = {.nimages = 0};
    have(&kept, images, &images->specs[0], 1);
    kept.most_bytes = 2 * retex_texture_bytes(kept.images[0]);
    have(&kept, images, &images->specs[1], 1);
    have(&kept, images, &images->specs[0], 1);
    have(&kept, images, &images->specs[2], 1);
    assert_int_equal(kept.nimages, 2);
    for (int k = 0; k < 3; k++)
        unlink(images->specs[k].image);
    have(&kept, images, &images->specs[0], 1);
    have(&kept, images, &images->specs[2], 1);
    assert_int_equal(fails(&kept, images, &images->specs[1], 1), RETEX_EIO);
    kept_textures_close(&kept);
}

/* Images that no picture needs now make room for one that it needs. */
static void test_budget(void **state)
{
    const Images *images = *state;
    RetexTextureSpec specs[3];
    RetexBudget *budget;
    RetexError err = {0};
    KeptTextures kept = {.most_bytes = 1 << 30};
    test_must(retex_budget_create(&budget, &err), &err);
    memcpy(specs, images->specs, sizeof specs);
    for (int k = 0; k < 3; k++)
        specs[k].budget = budget;
    have(&kept, images, &specs[0], 1);
    retex_budget_set_memory(budget, retex_texture_bytes(kept.images[0]) + (WIDTH + 1) * HEIGHT * 24);
    have(&kept, images, &specs[1], 1);
    have(&kept, images, &specs[2], 1);
    assert_int_equal(kept.nimages, 1);
    retex_budget_set_memory(budget, WIDTH * HEIGHT);
    assert_int_equal(fails(&kept, images, &specs[0], 1), RETEX_ELIMIT);
    kept_textures_close(&kept);
    retex_budget_close(&budget);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_placements, write_images, close_images),
        cmocka_unit_test_setup_teardown(test_moved, write_images, close_images),
        cmocka_unit_test_setup_teardown(test_targets, write_images, close_images),
        cmocka_unit_test_setup_teardown(test_memory, write_images, close_images),
        cmocka_unit_test_setup_teardown(test_budget, write_images, close_images),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
