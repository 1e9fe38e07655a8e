/* See lib_film.h. */
#include "lib_film.h"
#include "film/footprints/footprints.h"

#include <math.h>
#include <stdio.h>

#include <cmocka.h>

void begin_film(Fixture *f, int ntargets, int spp, int orders, int sharp, int broad)
{
    static const char *const names[] = {"Floor", "Wall", "Lid", "Box", "Ball", "Rug", "Door", "Lamp"};
    *f = (Fixture){.scene = {.ntargets = ntargets}};
    for (int t = 0; t < ntargets; t++)
        snprintf(f->scene.targets[t].name, sizeof f->scene.targets[t].name, "%s", names[t]);
    f->params = (FilmParams){
        .width = 2, .height = 1, .spp = spp, .orders = orders, .split = 1, .ntiles = 1, .layout = &footprints_layout};
    f->params.clusters = sharp + broad, f->params.sharp = sharp, f->params.broad = broad;
}

void create_film(Fixture *f)
{
    RetexError err = {0};
    test_must(film_create(&f->film, &f->scene, &f->params, &err), &err);
    test_must(film_pixel_create(&f->pixel, f->film, &err), &err);
}

void begin_path(Fixture *f)
{
    f->hits = (TargetTree){.last = NULL};
    f->value = rgb_grey(1);
}

void end_path(Fixture *f)
{
    film_path_end(f->pixel, &f->hits);
}

void split_hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp, Split split)
{
    const TargetVertex hit = {
        .uv = {u, v}, .albedo = albedo, .target = (unsigned char)target, .sharp = (unsigned char)sharp};
    target_tree_add(&f->hits, &f->room[f->hits.count], &hit, f->hits.last, color4(f->split.d), color4(f->split.i));
    f->split = split;
    f->value = rgb_mul(f->value, split_apply(split, albedo));
}

void hit(Fixture *f, int target, double u, double v, Rgb albedo, int sharp)
{
    split_hit(f, target, u, v, albedo, sharp, (Split){rgb_grey(1), rgb_grey(0)});
}

void connect_light(Fixture *f, Rgb light)
{
    Rgb beauty = rgb_mul(light, f->value);
    const double sum[3] = {(double)beauty.r, (double)beauty.g, (double)beauty.b};
    film_add_light(f->pixel, sum);
    if (f->hits.last)
        target_node_add_light(f->hits.last, color4(f->split.d) * color4(light), color4(f->split.i) * color4(light));
    else
        f->hits.without_hit += color4(light), f->hits.nwithout_hit++;
    f->light = rgb_add(f->light, beauty);
}

void one_hit(Fixture *f, double u, double v, Rgb albedo, int sharp, Rgb light)
{
    begin_path(f);
    hit(f, 0, u, v, albedo, sharp);
    connect_light(f, light);
    end_path(f);
}

void make_set(Fixture *f)
{
    RetexError err = {0};
    film_tile_end(f->pixel, 0);
    film_pixel_close(&f->pixel);
    test_must(retex_set_create(&f->set, 2, 1, &err), &err);
    test_must(retex_set_add_part(f->set, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, &err), &err);
    test_must(film_finish(f->film, f->set, &err), &err);
}

void finish_film(Fixture *f)
{
    film_pixel_end(f->pixel, 0, 0);
    film_pixel_end(f->pixel, 1, 0); /* without light */
    make_set(f);
}

void end_film(Fixture *f)
{
    film_close(&f->film);
    retex_set_close(&f->set);
}

const float *part(const Fixture *f, const char *name)
{
    int k = retex_set_find_part(f->set, name);
    if (k < 0)
        fail_msg("there is no part %s", name);
    return f->set->parts[k].image.pixels;
}

const RetexFootprint *footprint(const Fixture *f, const char *uv)
{
    int k = retex_set_find_part(f->set, uv);
    for (int i = 0; i < f->set->nfootprints; i++)
        if (f->set->footprints[i].uv == k)
            return &f->set->footprints[i];
    fail_msg("there is no footprint %s", uv);
    return NULL;
}

void expect_rgb(const float *got, float r, float g, float b, double tolerance)
{
    assert_float_equal(got[0], r, tolerance);
    assert_float_equal(got[1], g, tolerance);
    assert_float_equal(got[2], b, tolerance);
}

void assert_absent(const Fixture *f, const char *name)
{
    if (retex_set_find_part(f->set, name) >= 0)
        fail_msg("there is a part %s", name);
}

/* A factor with the original albedos of the footprints. */
static double factor(const RetexSet *set, int number, size_t pixel, size_t channel)
{
    double sum = 0, weights = 0;
    if (number >= 0)
        return (double)set->parts[set->footprints[number].albedo].image.pixels[3 * pixel + channel];
    const RetexMixture *mixture = &set->mixtures[MIXTURE(number)];
    for (int k = 0; k < mixture->nshares; k++) {
        double weight = (double)set->parts[mixture->shares[k].weight].image.pixels[pixel];
        weights += weight;
        sum += weight * factor(set, mixture->shares[k].footprint, pixel, channel);
    }
    return weights > 0 ? sum / weights : 0;
}

double expect_beauty(const Fixture *f, size_t pixel)
{
    const RetexSet *set = f->set;
    double sum[3] = {0, 0, 0}, white[3] = {0, 0, 0}, largest = 0;
    for (int t = 0; t < set->nterms; t++)
        for (size_t c = 0; c < 3 && retex_term_is_light(&set->terms[t]); c++) {
            double value = set->parts[set->terms[t].radiance].image.pixels[3 * pixel + c];
            assert_true(value >= 0);
            white[c] += value;
            for (int k = 0; k < set->terms[t].nfactors; k++)
                if (retex_factor_is_hit(set->terms[t].factors[k])) /* further hits: 1, with original textures */
                    value *= factor(set, test_factor_number(set->terms[t].factors[k]), pixel, c);
            sum[c] += value;
        }
    for (size_t c = 0; c < 3; c++)
        largest = fmax(largest, white[c]);
    for (size_t c = 0; c < 3; c++) {
        double want = set->parts[0].image.pixels[3 * pixel + c];
        if (fabs(sum[c] - want) > (set->nterms * 0.5 / 8192 + 1e-5) * largest)
            fail_msg("pixel %zu, channel %zu: the terms give %g, not %g", pixel, c, sum[c], want);
    }
    return largest;
}

void begin_shared(Fixture *f, int ntargets, int spp, int orders, int clusters)
{
    begin_film(f, ntargets, spp, orders, clusters, clusters);
    f->params.clusters = clusters;
}

static int has_cluster(const Fixture *f, const char *kind, int number)
{
    char name[RETEX_NAME_MAX];
    snprintf(name, sizeof name, "uv_Floor_%s%d", kind, number);
    int k = retex_set_find_part(f->set, name);
    return k >= 0 && f->set->parts[k].image.pixels[2] > 0;
}

int count_clusters(const Fixture *f, const char *kind)
{
    int count = 0;
    while (has_cluster(f, kind, count + 1))
        count++;
    for (int k = count + 1; k <= FILM_CLUSTERS_MAX; k++)
        assert_false(has_cluster(f, kind, k));
    return count;
}

void expect_place(const Fixture *f, const char *name, double u, double sd)
{
    char uv[RETEX_NAME_MAX], spread[RETEX_NAME_MAX];
    snprintf(uv, sizeof uv, "uv_%s", name);
    snprintf(spread, sizeof spread, "spread_%s", name);
    assert_float_equal(part(f, uv)[0], u, sd / 64 + FINEST + 1e-6 * fabs(u));
    assert_float_equal(part(f, spread)[0], sd, fmax(sd / 128, 1e-5));
}
