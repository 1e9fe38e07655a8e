/* See lib_sets.h. */
#include "lib_sets.h"

#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "base/half.h"

void lay_random(RetexSet *set, int every)
{
    RetexError err = {0};
    for (int f = 0; f < set->nfootprints; f++) {
        RetexTarget *target = &set->targets[set->footprints[f].target];
        int part;
        if (!every || f % every)
            continue;
        snprintf(target->texture, sizeof target->texture, "b\xfchne %d.jpg", set->footprints[f].target);
        test_must(retex_set_add_laid(set, set->footprints[f].target, f, -1, &part, &err), &err);
        test_random_image(&set->parts[part].image, set->parts[part].image.width, set->parts[part].image.height, 3,
                          (uint32_t)f + 50, 0, 1);
    }
}

static void expect_equal_pixels(const RetexImage *want, const RetexImage *got, RetexPixelType type)
{
    assert_true(want->width == got->width && want->height == got->height && want->channels == got->channels);
    const size_t count = retex_image_index(want, 0, want->height);
    for (size_t i = 0; i < count; i++) {
        float value = want->pixels[i];
        if (type == RETEX_HALF) {
            uint16_t half;
            retex_half_from_float(&half, &value, 1);
            retex_half_to_float(&value, &half, 1);
        }
        assert_true(value == got->pixels[i]);
    }
}

void expect_equal_part(const RetexSet *a, int part_a, const RetexSet *b, int part_b)
{
    assert_true((part_a < 0) == (part_b < 0));
    if (part_a < 0)
        return;
    assert_string_equal(a->parts[part_a].name, b->parts[part_b].name);
    assert_string_equal(a->parts[part_a].letters, b->parts[part_b].letters);
    assert_int_equal(a->parts[part_a].type, b->parts[part_b].type);
    assert_int_equal(a->parts[part_a].crc, b->parts[part_b].crc);
    expect_equal_pixels(&a->parts[part_a].image, &b->parts[part_b].image, a->parts[part_a].type);
}

/* Parts may be numbered differently. */
static void expect_equal_factor(const RetexSet *a, RetexFactor of_a, const RetexSet *b, RetexFactor of_b)
{
    assert_int_equal(of_a.kind, of_b.kind);
    assert_int_equal(of_a.quantity, of_b.quantity);
    if (of_a.kind == RETEX_FACTOR_IMAGE)
        expect_equal_part(a, of_a.index, b, of_b.index);
    else
        assert_int_equal(of_a.index, of_b.index);
}

void expect_equal_terms(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nterms, b->nterms);
    for (int i = 0; i < a->nterms; i++) {
        assert_int_equal(a->terms[i].role, b->terms[i].role);
        assert_int_equal(a->terms[i].target, b->terms[i].target);
        assert_int_equal(a->terms[i].nfactors, b->terms[i].nfactors);
        assert_true(a->terms[i].noise_weight == b->terms[i].noise_weight);
        for (int f = 0; f < a->terms[i].nfactors; f++)
            expect_equal_factor(a, a->terms[i].factors[f], b, b->terms[i].factors[f]);
        expect_equal_part(a, a->terms[i].radiance, b, b->terms[i].radiance);
    }
}

void expect_equal_mixtures(const RetexSet *a, const RetexSet *b)
{
    assert_int_equal(a->nmixtures, b->nmixtures);
    for (int i = 0; i < a->nmixtures; i++) {
        const RetexMixture *ma = &a->mixtures[i], *mb = &b->mixtures[i];
        assert_int_equal(ma->nshares, mb->nshares);
        for (int k = 0; k < ma->nshares; k++) {
            assert_int_equal(ma->shares[k].footprint, mb->shares[k].footprint);
            expect_equal_part(a, ma->shares[k].weight, b, mb->shares[k].weight);
        }
    }
}

void expect_equal_sets(const RetexSet *a, const RetexSet *b)
{
    assert_true(a->width == b->width && a->height == b->height && a->orders == b->orders && a->spp == b->spp);
    assert_true(a->max_depth == b->max_depth && a->seed == b->seed && a->strict_paper == b->strict_paper);
    assert_int_equal(a->id, b->id);
    assert_true(a->folded == b->folded && a->folded_white == b->folded_white && a->depth_cut == b->depth_cut);
    assert_string_equal(a->layout, b->layout);
    assert_string_equal(a->filter, b->filter);
    assert_string_equal(a->scene, b->scene);
    assert_string_equal(a->generator, b->generator);
    assert_int_equal(a->ntargets, b->ntargets);
    for (int i = 0; i < a->ntargets; i++) {
        RetexTarget ta = a->targets[i], tb = b->targets[i];
        assert_string_equal(ta.name, tb.name);
        assert_string_equal(ta.idents, tb.idents);
        expect_equal_part(a, ta.original, b, tb.original);
        assert_memory_equal(ta.periodic, tb.periodic, sizeof ta.periodic);
        assert_memory_equal(ta.uv_min, tb.uv_min, sizeof ta.uv_min);
        assert_memory_equal(ta.uv_max, tb.uv_max, sizeof ta.uv_max);
        assert_memory_equal(ta.original_min, tb.original_min, sizeof ta.original_min);
        assert_memory_equal(ta.original_max, tb.original_max, sizeof ta.original_max);
        assert_memory_equal(ta.mean_albedo, tb.mean_albedo, sizeof ta.mean_albedo);
        assert_memory_equal(ta.uv_scale, tb.uv_scale, sizeof ta.uv_scale);
        assert_true(ta.share == tb.share);
    }
    assert_int_equal(a->nparts, b->nparts);
    for (int i = 0; i < a->nparts; i++)
        expect_equal_part(a, i, b, i);
    assert_int_equal(a->nfootprints, b->nfootprints);
    for (int i = 0; i < a->nfootprints; i++)
        assert_memory_equal(&a->footprints[i], &b->footprints[i], sizeof a->footprints[i]);
    expect_equal_mixtures(a, b);
    expect_equal_terms(a, b);
}

void expect_equal_laid(const RetexSet *a, const RetexSet *b)
{
    assert_true(a->width == b->width && a->height == b->height);
    assert_int_equal(a->id, b->id);
    assert_int_equal(a->ntargets, b->ntargets);
    for (int i = 0; i < a->ntargets; i++) {
        assert_string_equal(a->targets[i].name, b->targets[i].name);
        if (a->targets[i].texture[0]) /* JSON is UTF-8 */
            assert_string_equal(b->targets[i].texture, i ? "b?hne 1.jpg" : "b?hne 0.jpg");
        assert_int_equal(!a->targets[i].texture[0], !b->targets[i].texture[0]);
    }
    assert_int_equal(a->nfootprints, b->nfootprints);
    for (int f = 0; f < a->nfootprints; f++) {
        assert_int_equal(a->footprints[f].target, b->footprints[f].target);
        assert_int_equal(a->footprints[f].hit, b->footprints[f].hit);
        expect_equal_part(a, a->footprints[f].sampled - 1, b, b->footprints[f].sampled - 1);
    }
}
