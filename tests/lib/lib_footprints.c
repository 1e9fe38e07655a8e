/* See lib_footprints.h. */
#include "lib_footprints.h"
#include <cmocka.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- sets ---- */

int add_part(RetexSet *set, const char *letters, const char *what, int number)
{
    RetexError err = {0};
    char name[64];
    int part;
    snprintf(name, sizeof name, "%s-%d", what, number);
    test_must(retex_set_add_part(set, name, letters, RETEX_FLOAT, 0, 0, &part, &err), &err);
    return part;
}

int add_footprint(RetexSet *set, int target, RetexFootprintKind kind, int hit, const char *spread)
{
    RetexFootprint footprint = {.target = target, .kind = kind, .hit = hit};
    RetexError err = {0};
    int index, number = set->nfootprints;
    footprint.uv = add_part(set, "RGA", "uv", number);
    footprint.spread = add_part(set, spread, "spread", number);
    footprint.albedo = add_part(set, "RGB", "albedo", number);
    test_must(retex_set_add_footprint(set, &footprint, &index, &err), &err);
    return index;
}

int add_term(RetexSet *set, int nfactors, int first, int others)
{
    int numbers[RETEX_MAX_HITS] = {first};
    RetexError err = {0};
    for (int k = 1; k < nfactors; k++)
        numbers[k] = others;
    const RetexTerm term = test_term(set, add_part(set, "RGB", "term", set->nterms), nfactors, numbers);
    test_must(retex_set_add_term(set, &term, NULL, &err), &err);
    return term.radiance;
}

int add_mixture(RetexSet *set, int first, int count, const char *letters)
{
    RetexMixture mixture = {.nshares = count};
    RetexError err = {0};
    int index;
    for (int k = 0; k < count; k++)
        mixture.shares[k] = (struct RetexShare){first + k, add_part(set, letters, "share", first + k)};
    test_must(retex_set_add_mixture(set, &mixture, &index, &err), &err);
    return MIXTURE(index);
}

RetexSet *start_set(int width, int height, int ntargets)
{
    RetexSet *set;
    RetexError err = {0};
    test_must(retex_set_create(&set, width, height, &err), &err);
    strcpy(set->layout, "footprints");
    set->spp = 16, set->orders = 6, set->ntargets = ntargets;
    for (int t = 0; t < ntargets; t++) {
        snprintf(set->targets[t].name, sizeof set->targets[t].name, "T%d", t);
        set->targets[t].original = -1;
    }
    test_must(retex_set_add_part(set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    add_term(set, 0, 0, 0);
    return set;
}

RetexSet *cluster_set(RetexFootprintKind kind, int count)
{
    RetexSet *set = start_set(WIDTH, HEIGHT, 1);
    for (int k = 0; k < count; k++)
        add_footprint(set, 0, kind, 1 + k, "RGB");
    for (int k = 0; k < count; k++)
        add_term(set, 1, k, 0);
    return set;
}

RetexSet *again_set(RetexFootprintKind kind, int count)
{
    RetexSet *set = cluster_set(kind, count);
    for (int k = 0; k < 2; k++)
        add_footprint(set, 0, RETEX_FOOTPRINT_INTERREFLECTION, 1 + count + k, "RGB");
    int first = count > 1 ? add_mixture(set, 0, count, "R") : 0;
    int later = add_mixture(set, count, 2, "R");
    add_term(set, 3, first, later);
    return set;
}

float *pixel(const RetexSet *set, int part, int x, int y)
{
    const RetexImage *im = &set->parts[part].image;
    return im->pixels + retex_image_index(im, x, y);
}

int share_part(const RetexSet *set, int footprint)
{
    for (int m = 0; m < set->nmixtures; m++)
        for (int k = 0; k < set->mixtures[m].nshares; k++)
            if (set->mixtures[m].shares[k].footprint == footprint)
                return set->mixtures[m].shares[k].weight;
    return -1;
}

void put(RetexSet *set, int footprint, int x, int y, float u, float v, float coverage)
{
    float *uv = pixel(set, set->footprints[footprint].uv, x, y);
    uv[0] = u, uv[1] = v, uv[2] = coverage;
}

void put_spread(RetexSet *set, int footprint, int x, int y, float su, float sv, float correlation)
{
    int part = set->footprints[footprint].spread;
    float *spread = pixel(set, part, x, y);
    spread[0] = su, spread[1] = sv;
    if (set->parts[part].image.channels == 3)
        spread[2] = correlation;
}

void put_rgb(RetexSet *set, int part, int x, int y, float r, float g, float b)
{
    float *to = pixel(set, part, x, y);
    to[0] = r, to[1] = g, to[2] = b;
}

int light_part(const RetexSet *set, int cluster)
{
    return set->terms[1 + cluster].radiance;
}

void put_light(RetexSet *set, int cluster, int x, int y, float light)
{
    put_rgb(set, light_part(set, cluster), x, y, light, light, light);
}

void put_share(RetexSet *set, int footprint, int x, int y, float share)
{
    *pixel(set, share_part(set, footprint), x, y) = share;
}

void put_again(RetexSet *set, int x, int y, float light)
{
    put_rgb(set, set->terms[set->nterms - 1].radiance, x, y, light, light, light);
}

/* ---- calls ---- */

Work open_work(RetexSet *set, int footprints)
{
    Work w = {.d = {.set = set, .params = RETEX_DENOISE_INIT}};
    RetexError err = {0};
    test_add_denoise_data(set);
    w.d.params.footprints = footprints;
    w.d.roi = (RetexRoi){0, 0, set->width, set->height, 0, 3};
    test_must(retex_signals_open(&w.d.signals, set, &err), &err);
    test_must(retex_denoise_footprints_open(&w.footprints, &w.d, &err), &err);
    w.written = calloc((size_t)set->nparts, 1);
    retex_denoise_mark_written(w.footprints, &w.d, w.written);
    w.out = (RetexDenoisedRows){.rows = set->height, .parts = calloc((size_t)set->nparts, sizeof(float *))};
    for (int k = 0; k < set->nparts; k++) {
        const RetexImage *im = &set->parts[k].image;
        size_t n = (size_t)im->width * (size_t)im->height * (size_t)im->channels;
        if (!w.written[k])
            continue;
        w.out.parts[k] = malloc(n * sizeof(float));
        for (size_t i = 0; i < n; i++)
            w.out.parts[k][i] = -7;
    }
    return w;
}

void close_work(Work *w)
{
    for (int k = 0; k < w->d.set->nparts; k++)
        free(w->out.parts[k]);
    free(w->out.parts);
    free(w->written);
    retex_denoise_footprints_close(&w->footprints);
    assert_null(w->footprints);
    retex_signals_close(&w->d.signals);
    retex_set_close(&w->d.set);
}

const RetexSignal *find_signal(const Work *w, int target, RetexFootprintKind kind)
{
    for (int s = 0; s < w->d.signals.count; s++)
        if (w->d.signals.of[s].target == target && w->d.signals.of[s].kind == kind)
            return &w->d.signals.of[s];
    fail();
    return NULL;
}

void share_light(Work *w, RetexFootprintKind kind, const float *weights, int count, const float light[3])
{
    RetexNeighbour neighbours[WIDTH];
    for (int k = 0; k < count; k++)
        neighbours[k] = (RetexNeighbour){1 + k, 1, weights[k]};
    retex_denoise_share_light(w->footprints, &w->d, find_signal(w, 0, kind), 1, 1, neighbours, count, light, &w->out);
}

void share_later(Work *w, const float *weights, int count)
{
    RetexNeighbour neighbours[WIDTH];
    for (int k = 0; k < count; k++)
        neighbours[k] = (RetexNeighbour){1 + k, 1, weights[k]};
    retex_denoise_share_later(w->footprints, &w->d, 1, 1, neighbours, count, &w->out);
}

const float *result(const Work *w, int part)
{
    int channels = w->d.set->parts[part].image.channels;
    assert_non_null(w->out.parts[part]);
    return w->out.parts[part] + (w->d.set->width + 1) * channels;
}

const float *result_uv(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].uv);
}

const float *result_spread(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].spread);
}

const float *result_albedo(const Work *w, int footprint)
{
    return result(w, w->d.set->footprints[footprint].albedo);
}

void expect_values(const float *is, int count, const float *should, float tolerance)
{
    for (int k = 0; k < count; k++)
        if (!(fabsf(is[k] - should[k]) <= tolerance))
            fail_msg("value %d is %.9g, not %.9g", k, is[k], should[k]);
}

void expect_copied(const Work *w, int footprint, int x, int y)
{
    const RetexSet *set = w->d.set;
    const int parts[] = {set->footprints[footprint].uv, set->footprints[footprint].spread,
                         set->footprints[footprint].albedo, share_part(set, footprint)};
    for (int k = 0; k < 4; k++)
        if (parts[k] >= 0)
            expect_values(result(w, parts[k]), set->parts[parts[k]].image.channels, pixel(set, parts[k], x, y), 0);
}
