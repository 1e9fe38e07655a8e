/* Samples that are kept from one picture to the next: pictures are the same to the bit, rows are filtered once, and
 * memory is bounded. */
#include "lib_test.h"

#include <stdio.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 90, HEIGHT = 70 };

typedef struct Room {
    RetexSet *set;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexImage alone; /* the picture without kept samples */
} Room;

static void picture_of(const Room *room, const RetexCombineParams *params, RetexImage *image)
{
    RetexError err = {0};
    test_must(retex_image_alloc(image, WIDTH, HEIGHT, 3, &err), &err);
    test_must(retex_retexture(room->set, room->textures, params, retex_image_keep_rows, image, 2, &err), &err);
}

static void open_room(Room *room, uint32_t seed, int footprints)
{
    RetexImage image = {0};
    RetexError err = {0};
    *room = (Room){.set = test_set(WIDTH, HEIGHT, seed)};
    if (footprints)
        test_make_footprints(room->set);
    test_random_image(&image, 40, 24, footprints ? 4 : 3, seed, 0, 1);
    for (int t = 0; t < 2; t++)
        test_must(retex_texture_create(&room->textures[t], &image, NULL, 1, &err), &err);
    retex_image_free(&image);
    picture_of(room, NULL, &room->alone);
}

static void close_room(Room *room)
{
    retex_textures_close(room->textures);
    retex_image_free(&room->alone);
    retex_set_close(&room->set);
}

static RetexKeptSamplesInfo info_of(const RetexKeptSamples *kept)
{
    RetexKeptSamplesInfo info = {.size = sizeof info};
    retex_kept_samples_get_info(kept, &info);
    return info;
}

static void expect_alone(const Room *room, const RetexCombineParams *params)
{
    RetexImage image = {0};
    picture_of(room, params, &image);
    assert_memory_equal(image.pixels, room->alone.pixels, sizeof *image.pixels * 3 * WIDTH * HEIGHT);
    retex_image_free(&image);
}

static void test_found(void **state)
{
    (void)state;
    for (int n = 0; n < 4; n++) {
        Room room;
        RetexError err = {0};
        RetexKeptSamples *kept[RETEX_MAX_TARGETS] = {NULL};
        RetexCombineParams params = RETEX_COMBINE_INIT;
        open_room(&room, 5 + (uint32_t)n, n % 2);
        params.kept = kept;
        test_must(retex_kept_samples_create(&kept[0], room.set, 0, NULL, &err), &err);
        expect_alone(&room, &params);
        const RetexKeptSamplesInfo first = info_of(kept[0]);
        assert_true(first.made > 0 && first.found == 0 && first.lacked == 0);
        expect_alone(&room, &params);
        assert_int_equal(info_of(kept[0]).made, first.made);
        assert_int_equal(info_of(kept[0]).found, first.made);
        assert_int_equal(info_of(kept[0]).bytes, first.bytes);
        retex_kept_samples_close(&kept[0]);
        close_room(&room);
    }
}

/* Some columns are not the whole row. */
static void test_columns(void **state)
{
    (void)state;
    Room room;
    RetexError err = {0};
    RetexKeptSamples *kept[RETEX_MAX_TARGETS] = {NULL};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    RetexImage part = {0};
    open_room(&room, 3, 0);
    test_must(retex_kept_samples_create(&kept[0], room.set, 0, NULL, &err), &err);
    params.kept = kept;
    params.x0 = 20, params.x1 = 31;
    picture_of(&room, &params, &part);
    retex_image_free(&part);
    params.x0 = params.x1 = 0;
    expect_alone(&room, &params);
    retex_kept_samples_close(&kept[0]);
    close_room(&room);
}

static void test_memory(void **state)
{
    (void)state;
    Room room;
    RetexError err = {0};
    RetexBudget *budget;
    RetexKeptSamples *kept[RETEX_MAX_TARGETS] = {NULL};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    open_room(&room, 3, 0);
    params.kept = kept;
    test_must(retex_budget_create(&budget, &err), &err);
    test_must(retex_kept_samples_create(&kept[1], room.set, 1, budget, &err), &err);
    const uint64_t most = info_of(kept[1]).bytes + 10000;
    retex_budget_set_memory(budget, most);
    for (int k = 0; k < 3; k++)
        expect_alone(&room, &params);
    assert_true(info_of(kept[1]).found > 0 && info_of(kept[1]).lacked > 0);
    assert_true(info_of(kept[1]).bytes <= most);
    assert_int_equal(retex_budget_left(budget), most - info_of(kept[1]).bytes);
    retex_kept_samples_close(&kept[1]);
    assert_int_equal(retex_budget_left(budget), most);
    retex_budget_set_memory(budget, 100);
    assert_int_equal(retex_kept_samples_create(&kept[1], room.set, 1, budget, &err), RETEX_ELIMIT);
    assert_null(kept[1]);
    retex_budget_close(&budget);
    close_room(&room);
}

static void test_refused(void **state)
{
    (void)state;
    Room room;
    RetexError err = {0};
    RetexImage image = {0};
    RetexKeptSamples *kept[RETEX_MAX_TARGETS] = {NULL};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    open_room(&room, 3, 0);
    params.kept = kept;
    assert_int_equal(retex_kept_samples_create(&kept[0], room.set, room.set->ntargets, NULL, &err), RETEX_EINVAL);
    test_must(retex_kept_samples_create(&kept[1], room.set, 0, NULL, &err), &err); /* of another target */
    test_must(retex_image_alloc(&image, WIDTH, HEIGHT, 3, &err), &err);
    assert_int_equal(retex_retexture(room.set, room.textures, &params, retex_image_keep_rows, &image, 1, &err),
                     RETEX_EINVAL);
    retex_image_free(&image);
    retex_kept_samples_close(&kept[1]);
    close_room(&room);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_found),
        cmocka_unit_test(test_columns),
        cmocka_unit_test(test_memory),
        cmocka_unit_test(test_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
