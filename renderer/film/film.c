/* What all layouts share: the beauty, sums of light, the range of UV, and making images parts of a set. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/host/band_stats.h>
#include <retex/host/set_build.h>
#include "film/film.h"
#include "film/layout.h"
#include "film/limits.h"
#include "film/noise.h"

/* State of a band; under the film's lock. */
typedef struct BandState {
    int tiles; /* that are finished */
    atomic_int done;
    UvRange range;
    long dropped, samples;
    RetexBandStats stats; /* once it is finished */
} BandState;

struct Film {
    const Scene *scene;
    FilmParams params;
    RetexImage beauty;
    int beauty_image; /* in the band store */
    Bands *bands;
    const FilmLayout *layout; /* where there is a split, else NULL */
    void *layout_film;
    NoiseImages noise;
    LightSums *tiles;
    BandState *states; /* by band */
    pthread_mutex_t lock;
    atomic_long limited; /* numbers that a set may not hold, so far */
    atomic_int failed;
    RetexError error; /* of the first band that could not be kept; under lock */
};

struct FilmPixel {
    Film *film;
    void *layout_pixel; /* of the film's layout */
    BandRows *rows;     /* of the current tile, once it writes */
    double beauty[3];
    int spp;           /* of the tile's pixels */
    int paths;         /* so far */
    SignalTotals half; /* of the first half of the paths */
    LightSums light;   /* of the tile so far, as is: */
    UvRange range;
    long dropped, samples;
};

/* ---- life ---- */

static int alloc_states(Film *film, RetexError *err)
{
    film->tiles = calloc((size_t)film->params.ntiles, sizeof *film->tiles);
    film->states = calloc((size_t)bands_count(film->bands), sizeof *film->states);
    if (!film->tiles || !film->states)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    for (int k = 0; k < bands_count(film->bands); k++) {
        uv_range_reset(&film->states[k].range);
        retex_band_stats_reset(&film->states[k].stats);
    }
    return RETEX_OK;
}

static int film_alloc(Film *film, RetexError *err)
{
    const FilmParams *p = &film->params;
    int code = bands_create(&film->bands, p->width, p->height, p->store, !p->stored, err);
    if (!code)
        code = alloc_states(film, err);
    if (!code)
        code = retex_image_alloc(&film->beauty, p->width, p->height, 3, err);
    if (!code && p->store)
        code = retex_band_store_add(p->store, "beauty", "RGB", RETEX_FLOAT, &film->beauty_image, err);
    if (!code && film->layout)
        code = film->layout->create(&film->layout_film, film->scene, p, film->bands, err);
    return code ? code : noise_create(&film->noise, p, film->scene, film->bands, err);
}

int film_create(Film **out, const Scene *scene, const FilmParams *params, RetexError *err)
{
    Film *film = calloc(1, sizeof *film);
    *out = film;
    if (!film) {
        RetexBandStore *store = params->store;
        retex_band_store_close(&store);
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    }
    film->scene = scene;
    film->params = *params;
    film->layout = params->split ? params->layout : NULL;
    pthread_mutex_init(&film->lock, NULL);
    int code = film_alloc(film, err);
    if (code)
        film_close(out);
    return code;
}

void film_close(Film **out)
{
    Film *film = *out;
    if (!film)
        return;
    retex_image_free(&film->beauty);
    if (film->layout)
        film->layout->close(&film->layout_film);
    bands_close(&film->bands);
    free(film->tiles);
    free(film->states);
    pthread_mutex_destroy(&film->lock);
    free(film);
    *out = NULL;
}

int film_pixel_create(FilmPixel **out, Film *film, RetexError *err)
{
    FilmPixel *p = *out = calloc(1, sizeof *p);
    if (!p)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
    p->film = film;
    p->spp = film->params.spp;
    uv_range_reset(&p->range);
    int code = RETEX_OK;
    if (film->layout)
        code = film->layout->pixel_create(&p->layout_pixel, film->layout_film, &p->light, &p->range, err);
    if (code)
        film_pixel_close(out);
    return code;
}

void film_pixel_close(FilmPixel **pixel)
{
    FilmPixel *p = *pixel;
    if (!p)
        return;
    if (p->film->layout)
        p->film->layout->pixel_close(&p->layout_pixel);
    free(p);
    *pixel = NULL;
}

/* ---- light ---- */

void film_drop(FilmPixel *p)
{
    p->dropped++;
}

void film_add_light(FilmPixel *p, const double light[3])
{
    for (int c = 0; c < 3; c++)
        p->beauty[c] += light[c];
    p->light.total += rgb_luminance(rgb((float)light[0], (float)light[1], (float)light[2]));
}

void film_add_cut(FilmPixel *p, double cut)
{
    p->light.cut += cut;
}

void film_hit_limits(const FilmPixel *p, int *orders, int *most_hits)
{
    *orders = p->film->params.orders;
    *most_hits = p->film->layout->most_hits(p->film->scene->ntargets);
    /* where hits on any target are counted together, those of one are not limited besides */
    if (p->film->layout->prunes && *orders == RETEX_MAX_ORDERS && p->film->scene->ntargets > 1)
        *orders = *most_hits;
}

/* What each signal got in the pixel so far. */
static void signal_totals(const FilmPixel *p, SignalTotals *totals)
{
    if (p->film->layout)
        p->film->layout->totals(p->layout_pixel, totals);
    else
        memcpy(totals->of[0], p->beauty, sizeof p->beauty);
}

void film_path_end(FilmPixel *p, const TargetTree *hits)
{
    if (p->film->layout) {
        p->light.folded += hits->folded;
        if (p->film->layout->keeps_white)
            p->light.folded_white += hits->folded_white;
        p->film->layout->path_end(p->layout_pixel, hits);
    }
    if (++p->paths == p->spp / 2 && p->film->noise.count)
        signal_totals(p, &p->half);
}

static void fail(Film *film, const RetexError *err)
{
    pthread_mutex_lock(&film->lock);
    if (!film->failed)
        film->error = *err;
    film->failed = 1;
    pthread_mutex_unlock(&film->lock);
}

/* The rows of the current tile; NULL where there is no memory for them. */
static BandRows *rows_at(FilmPixel *p, int y)
{
    RetexError err;
    if (!p->rows && !(p->rows = bands_open(p->film->bands, y / BAND_LINES))) {
        retex_fail(&err, RETEX_ENOMEM, "out of memory for the film");
        fail(p->film, &err);
    }
    return p->rows;
}

void film_tile_begin(FilmPixel *p, int spp)
{
    p->spp = spp;
}

void film_pixel_end(FilmPixel *p, int x, int y)
{
    Film *film = p->film;
    BandRows *rows = rows_at(p, y);
    float *beauty = film->beauty.pixels + retex_image_index(&film->beauty, x, y);
    if (!rows)
        return;
    if (film->noise.count) {
        SignalTotals all;
        signal_totals(p, &all);
        noise_store(&film->noise, rows, &p->half, &all, p->spp, x, y);
    }
    p->samples += p->paths;
    p->paths = 0;
    for (int c = 0; c < 3; c++)
        beauty[c] = (float)(p->beauty[c] / p->spp), p->beauty[c] = 0;
    if (film->layout)
        film->layout->pixel_end(p->layout_pixel, rows, p->spp, x, y);
}

static float *beauty_rows(const Film *film, int band)
{
    return film->beauty.pixels + retex_image_index(&film->beauty, 0, band * BAND_LINES);
}

/* Numbers of the beauty in a band. */
static size_t beauty_size(const Film *film, int band)
{
    const int left = film->beauty.height - band * BAND_LINES;
    return 3 * (size_t)film->beauty.width * (size_t)(left < BAND_LINES ? left : BAND_LINES);
}

/* Sum over the tiles of a band in their order, and over its footprints' pixels. */
static void finish_stats(Film *film, int band, int tiles, const BandRows *rows)
{
    BandState *state = &film->states[band];
    RetexBandStats *s = &state->stats;
    for (int k = band * tiles; k < (band + 1) * tiles; k++) {
        s->total += film->tiles[k].total, s->folded += film->tiles[k].folded;
        s->cut += film->tiles[k].cut;
        s->total_white += film->tiles[k].total_white, s->folded_white += film->tiles[k].folded_white;
    }
    memcpy(s->uv_low, state->range.low, sizeof s->uv_low);
    memcpy(s->uv_high, state->range.high, sizeof s->uv_high);
    s->dropped = state->dropped;
    s->samples = state->samples;
    if (film->layout)
        film->layout->band_stats(film->layout_film, rows, s);
}

/* Put the beauty and the statistics of a finished band into the band store. */
static int commit_band(Film *film, int band, RetexError *err)
{
    RetexBandStore *store = bands_store(film->bands);
    int code = RETEX_OK;
    if (store)
        code = retex_band_store_put(store, film->beauty_image, band, beauty_rows(film, band), err);
    if (!code && store)
        code = retex_band_store_commit(store, band, &film->states[band].stats, err);
    film->states[band].done = !code;
    return code;
}

void film_tile_end(FilmPixel *p, int tile)
{
    Film *film = p->film;
    int tiles = film->params.ntiles / bands_count(film->bands), band = tile / tiles;
    BandState *state = &film->states[band];
    BandRows *rows = p->rows;
    RetexError err;
    pthread_mutex_lock(&film->lock);
    film->tiles[tile] = p->light;
    uv_range_merge(&state->range, &p->range);
    state->dropped += p->dropped;
    state->samples += p->samples;
    int last = ++state->tiles == tiles;
    pthread_mutex_unlock(&film->lock);
    p->light = (LightSums){0};
    uv_range_reset(&p->range);
    p->dropped = p->samples = 0;
    p->rows = NULL;
    if (!last || !rows)
        return;
    atomic_fetch_add(&film->limited,
                     bands_limit(rows) + film_limit_numbers(beauty_rows(film, band), beauty_size(film, band), 0));
    finish_stats(film, band, tiles, rows);
    if (bands_finish(rows, &err) || commit_band(film, band, &err))
        fail(film, &err);
}

int film_failed(const Film *film)
{
    return film->failed;
}

/* ---- bands that are finished ---- */

int film_bands(const Film *film)
{
    return bands_count(film->bands);
}

int film_band_is_done(const Film *film, int band)
{
    return film->states[band].done;
}

int film_bands_done(const Film *film)
{
    int done = 0;
    for (int k = 0; k < film_bands(film); k++)
        done += film->states[k].done;
    return done;
}

/* Make the images that only the band store has, as far as they are the layout's. */
static int resume_images(Film *film, const RetexBandStore *store, RetexError *err)
{
    const char *name;
    int code = RETEX_OK;
    if (!film->layout || !film->layout->resume_image)
        return RETEX_OK;
    for (int k = 0; !code && (name = retex_band_store_image_name(store, k)); k++)
        if (bands_find(film->bands, name) < 0)
            code = film->layout->resume_image(film->layout_film, name, err);
    return code;
}

int film_resume(Film *film, RetexError *err)
{
    RetexBandStore *store = bands_store(film->bands);
    int code = resume_images(film, store, err);
    for (int k = 0; k < film_bands(film) && !code; k++) {
        const RetexBandStats *stats = retex_band_store_committed(store, k);
        if (!stats)
            continue;
        code = retex_band_store_load_band(store, film->beauty_image, k, beauty_rows(film, k), err);
        if (!code)
            code = bands_resume(film->bands, k, err);
        film->states[k].stats = *stats;
        film->states[k].done = 1;
    }
    return code;
}

/* Whole images, of which no band store has a copy. */
static int copy_bands(const Film *film, RetexBandStore *store, RetexError *err)
{
    int beauty, code = retex_band_store_add(store, "beauty", "RGB", RETEX_FLOAT, &beauty, err);
    for (int k = 0; k < film_bands(film) && !code; k++) {
        if (!film->states[k].done)
            continue;
        code = retex_band_store_put(store, beauty, k, beauty_rows(film, k), err);
        if (!code)
            code = bands_copy(film->bands, k, store, err);
        if (!code)
            code = retex_band_store_commit(store, k, &film->states[k].stats, err);
    }
    return code;
}

int film_save(Film *film, uint64_t key, const char *path, RetexError *err)
{
    RetexBandStore *store = bands_store(film->bands), *copy = NULL;
    if (store)
        return retex_band_store_keep(store, path, err);
    int code = retex_band_store_create(&copy, film->params.width, film->params.height, key, path, err);
    if (!code)
        code = copy_bands(film, copy, err);
    if (!code)
        code = retex_band_store_keep(copy, path, err);
    retex_band_store_close(&copy);
    return code;
}

/* ---- images of others ---- */

Bands *film_images(const Film *film)
{
    return film->bands;
}

float *film_image_pixel(FilmPixel *p, int image, int x, int y)
{
    static _Thread_local float nowhere[8];
    BandRows *rows = rows_at(p, y);
    return rows ? bands_pixel(rows, image, x, y) : nowhere;
}

/* ---- memory ---- */

long film_floats(const FilmParams *params, int ntargets)
{
    long layout = params->split && (ntargets > 0 || params->nkept > 0) ? params->layout->floats(params, ntargets) : 0;
    return 3 + 3 * noise_count(params, ntargets) + layout;
}

double film_bytes(const FilmParams *params, int ntargets, int stored)
{
    double row = params->width * (double)sizeof(float);
    double floats = film_floats(params, ntargets);
    return stored ? 3 * row * params->height + floats * row * BAND_LINES : floats * row * params->height;
}

long film_dropped(const Film *film)
{
    long dropped = 0;
    for (int k = 0; k < bands_count(film->bands); k++)
        dropped += film->states[k].stats.dropped;
    return dropped;
}

long film_limited(const Film *film)
{
    return film->limited;
}

/* ---- into a set ---- */

static void add_finishes(RetexTarget *target, const Scene *scene, int t)
{
    const Target *own = &scene->targets[t];
    if (own->nfinishes < 2)
        return;
    target->nfinishes = own->nfinishes;
    target->finish = 1 + scene->finish_of[scene->shown][t];
    for (int k = 0; k < own->nfinishes; k++) {
        snprintf(target->finishes[k], sizeof target->finishes[k], "%s", own->finishes[k].name);
        target->finish_roughness[k] = target_finish_roughness(own, k);
    }
    target->normal_tilt = own->has_normals ? NORMAL_TILT : 0;
}

static int describe_split(const Film *film, RetexSet *set, RetexError *err)
{
    RetexSetInfo info = retex_set_info(set);
    info.orders = film->params.orders;
    info.strict_paper = film->params.strict_paper;
    int code = retex_set_describe(set, &info, err);
    for (int t = 0; t < film->scene->ntargets && !code; t++) {
        RetexTarget target = {.original = -1};
        snprintf(target.name, sizeof target.name, "%s", film->scene->targets[t].name);
        snprintf(target.idents, sizeof target.idents, "%s", film->scene->targets[t].idents);
        add_finishes(&target, film->scene, t);
        code = retex_set_add_target(set, &target, NULL, err);
    }
    return code;
}

static int finish_stats_of_all(const Film *film, RetexSet *set, RetexError *err)
{
    int count = bands_count(film->bands);
    RetexBandStats *all = calloc((size_t)count, sizeof *all);
    if (!all)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the set");
    for (int k = 0; k < count; k++)
        all[k] = film->states[k].stats;
    retex_band_stats_finish(set, all, count);
    free(all);
    return RETEX_OK;
}

/* Layout, then noise. */
static int finish_images(Film *film, RetexSet *set, RetexError *err)
{
    int code = film->layout ? film->layout->finish(film->layout_film, set, err) : RETEX_OK;
    return code ? code : noise_finish(&film->noise, film->bands, set, err);
}

/* Which of the film's parts no pixel has. */
static void find_empty(const Film *film, const RetexSet *set, char *empty)
{
    const RetexPart *part;
    for (int i = 0; (part = retex_set_part(set, i)); i++) {
        int image = bands_find(film->bands, part->name);
        empty[i] = image >= 0 && bands_is_empty(film->bands, image);
    }
}

int film_finish(Film *film, RetexSet *set, RetexError *err)
{
    char empty[BAND_IMAGES_MAX];
    if (film->failed)
        return retex_fail(err, film->error.code, "%s", film->error.message);
    RetexImage *beauty = retex_set_mutable_image(set, 0);
    retex_image_free(beauty);
    *beauty = film->beauty;
    film->beauty = (RetexImage){0};
    retex_set_identify(set);
    if (film->params.split) {
        int code = describe_split(film, set, err);
        if (!code)
            code = finish_stats_of_all(film, set, err);
        if (code)
            return code;
    }
    int code = finish_images(film, set, err);
    const RetexTerm picture = {.role = RETEX_ROLE_PICTURE, .target = -1};
    if (!code && film->params.split && !film->params.strict_paper)
        code = retex_set_add_term(set, &picture, NULL, err);
    if (!code && film->layout && film->layout->prunes) {
        find_empty(film, set, empty);
        retex_set_prune(set, empty);
    }
    return code;
}

int film_move_store(Film *film, RetexSet *set, RetexError *err)
{
    return retex_set_take_store(set, bands_take_store(film->bands), err);
}
