/* Packs of parallelograms: axes are the steps of means, which take no bytes. */
#include "lib_footprints.h"
#include "lib_pack.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "pack/plan.h"
#include "pack/open.h"
#include "pack/strips.h"
#include "set/steps.h"

enum { WIDE = 50, HIGH = 100 };

static const RetexFootprint *whole_of(const RetexSet *set)
{
    for (int i = 0; i < set->nfootprints; i++)
        if (set->parts[set->footprints[i].spread].image.channels == RETEX_AXES)
            return &set->footprints[i];
    fail_msg("%s", "no footprint has axes");
    return NULL;
}

/* Means come back within a 128th of the pixel's size, axes as the steps of those; other pixels have neither. */
static void axes_are_steps_of_means(void **state)
{
    size_t bytes;
    RetexSet *set = set_of_axes(WIDE, HIGH);
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    const RetexFootprint *was = &set->footprints[0], *is = whole_of(back);
    int whole = 0, all = 0;
    (void)state;
    for (int y = 0; y < HIGH; y++)
        for (int x = 0; x < WIDE; x++) {
            const float *uv = pixel(back, is->uv, x, y), *from = pixel(set, was->uv, x, y);
            const float *axes = pixel(back, is->spread, x, y), *axes_from = pixel(set, was->spread, x, y);
            double steps[RETEX_AXES];
            all += from[2] > 0;
            if (!(uv[2] > 0)) {
                for (int k = 0; k < RETEX_AXES; k++)
                    assert_true(axes[k] == 0);
                continue;
            }
            whole++;
            retex_steps_at(steps, &back->parts[is->uv].image, x, y, set->targets[0].periodic);
            for (int k = 0; k < 2; k++) {
                const double size = hypot((double)axes_from[k], (double)axes_from[2 + k]);
                const double off = (double)uv[k] - (double)from[k];
                assert_true(fabs(k ? off : off - rint(off)) <= size / 128 + 1e-7);
                for (int i = k; i < RETEX_AXES; i += 2) {
                    assert_float_equal(axes[i], steps[i], 1e-6);
                    assert_true(fabs((double)axes[i] - (double)axes_from[i]) < 0.07 * size);
                }
            }
        }
    if (whole < all * 95 / 100)
        fail_msg("%d of %d pixels are whole", whole, all);
    free(data);
    retex_set_close(&set);
    retex_set_close(&back);
}

/* Any rows of axes can be read alone, in any order. */
static void rows_of_axes_are_those_of_the_whole(void **state)
{
    static const int rows[] = {63, 64, 0, 99, 62, 65, 64, 30};
    size_t bytes;
    RetexSet *set = set_of_axes(WIDE, HIGH), *open = NULL;
    RetexPackScratch *scratch = NULL;
    RetexInput *input = NULL;
    RetexError err = {0};
    unsigned char *data = pack(set, NULL, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    const int axes = whole_of(back)->spread;
    (void)state;
    test_must(retex_input_borrow(&input, data, bytes, "memory", &err), &err);
    test_must(retex_pack_open(&open, &input, &err), &err);
    test_must(retex_pack_scratch_create(&scratch, retex_pack_of(open), &err), &err);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const float *row, *should = pixel(back, axes, 0, rows[k]);
        RetexRowSpan span;
        test_must(retex_pack_row(scratch, axes, rows[k], &row, &span, &err), &err);
        for (int i = RETEX_AXES * span.begin; i < RETEX_AXES * span.end; i++)
            assert_true(row[i] == should[i]);
        assert_true(span.end - span.begin > WIDE / 2);
    }
    retex_pack_scratch_close(&scratch);
    free(data);
    retex_set_close(&open);
    retex_set_close(&set);
    retex_set_close(&back);
}

/* Without loss every bit is kept. */
static void axes_without_loss(void **state)
{
    size_t bytes;
    RetexPackParams params = lossless();
    RetexSet *set = set_of_axes(WIDE, HIGH);
    unsigned char *data = pack(set, &params, &bytes, 0);
    RetexSet *back = unpack(data, bytes);
    const int axes = set->footprints[0].spread;
    (void)state;
    assert_memory_equal(back->parts[axes].image.pixels, set->parts[axes].image.pixels,
                        sizeof(float) * WIDE * HIGH * RETEX_AXES);
    free(data);
    retex_set_close(&set);
    retex_set_close(&back);
}

/* Axes that are no steps are stored as they are. */
static void other_axes_keep_their_bits(void **state)
{
    const RetexPackQuantizer quantizer = retex_pack_quantizer(56);
    RetexSet *set = set_of_axes(WIDE, HIGH);
    RetexPackPart *plan = calloc((size_t)set->nparts, sizeof *plan);
    RetexError err = {0};
    const RetexFootprint *f = &set->footprints[0];
    (void)state;
    for (int other = 0; other < 2; other++) {
        test_must(retex_pack_plan(plan, set, &quantizer, 1, &err), &err);
        for (int c = 0; c < RETEX_AXES; c++)
            assert_true((plan[f->spread].maps[c].kind == RETEX_PACK_MAP_STEP) == !other);
        assert_true((plan[f->uv].maps[0].kind == RETEX_PACK_MAP_LATTICE) == !other);
        pixel(set, f->spread, 3, 70)[3] *= 1.2f;
    }
    free(plan);
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(axes_are_steps_of_means),
        cmocka_unit_test(rows_of_axes_are_those_of_the_whole),
        cmocka_unit_test(axes_without_loss),
        cmocka_unit_test(other_axes_keep_their_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
