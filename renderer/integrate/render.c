/* The picture: tiles over threads, paths over samples, everything into a set. */
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <retex/parallel.h>
#include "integrate/adaptive.h"
#include "integrate/camera.h"
#include "integrate/control_constants.h"
#include "integrate/denoise_guides.h"
#include "integrate/first_hit.h"
#include "integrate/path.h"
#include "integrate/originals.h"
#include "integrate/pieces.h"
#include "integrate/uv_scale.h"

#define TILE_WIDTH 32
#define TILE_HEIGHT BAND_LINES

/* All of one render. */
typedef struct Render {
    const Scene *scene;
    RenderParams params;
    int width, height; /* of the whole picture */
    int x0, y0, w, h;  /* the part that is rendered */
    int tiles_x, tiles_y;
    Accel *accel;
    Lights *lights;
    Caustics *caustics; /* or NULL */
    Film *film;
    FilmPixel **pixels;            /* by thread */
    ControlFilm *control;          /* of several variants, or NULL */
    ControlPixel **controls;       /* by thread */
    const RenderVariant *variants; /* or NULL: the original */
    const RetexImage *constants;   /* or NULL: by target, of the last variant */
    DenoiseGuides guides;
    PixelGuides *pixel_guides; /* by thread, or NULL: no guides */
    char *had;                 /* by band: taken over from another render */
    int wanted;                /* tiles, of all that are to be rendered */
    PathContext context;
    PathWorker *workers; /* by thread */
    Adaptive **pilots;   /* by thread, or NULL: all tiles get as many samples */
    atomic_int done;
    atomic_long paths;
} Render;

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static int check_params(const RenderParams *p, RetexError *err)
{
    if (p->spp < 1 || p->spp > 1 << 20)
        return retex_fail(err, RETEX_EINVAL, "samples per pixel must be 1 to 1048576, not %d", p->spp);
    if (!(p->noise >= 0))
        return retex_fail(err, RETEX_EINVAL, "noise must be above 0, not %g", p->noise);
    if (p->noise > 0 && (p->control_data || p->nvariants > 1))
        return retex_fail(err, RETEX_EINVAL, "noise does not go with several variants or data of control variates");
    if (p->max_depth < 1 || p->max_depth > 256)
        return retex_fail(err, RETEX_EINVAL, "max-depth must be 1 to 256, not %d", p->max_depth);
    if (p->nvariants < 0 || p->nvariants > VARIANTS_MAX)
        return retex_fail(err, RETEX_EINVAL, "variants must be 0 to %d, not %d", VARIANTS_MAX, p->nvariants);
    if (p->orders < 1 || p->orders > RETEX_MAX_ORDERS)
        return retex_fail(err, RETEX_EINVAL, "orders must be 1 to %d, not %d", RETEX_MAX_ORDERS, p->orders);
    if (p->clusters < 2 || p->clusters > FILM_CLUSTERS_MAX || p->sharp < 1 || p->sharp > p->clusters || p->broad < 1 ||
        p->broad > p->clusters)
        return retex_fail(err, RETEX_EINVAL, "clusters must be 2 to %d, of them 1 to all sharp and 1 to all broad ones",
                          FILM_CLUSTERS_MAX);
    return RETEX_OK;
}

/* Of a render beside the one that files are for. */
static void forget_files(RenderParams *p)
{
    p->spooled = p->resume = p->nshards = p->nmerged = 0;
    p->journal = NULL;
}

static int set_window(Render *r, RetexError *err)
{
    const RenderParams *p = &r->params;
    r->width = p->width > 0 ? p->width : r->scene->width;
    r->height = p->height > 0 ? p->height : r->scene->height;
    if (r->width > RETEX_MAX_SIZE || r->height > RETEX_MAX_SIZE)
        return retex_fail(err, RETEX_EINVAL, "a picture of %dx%d is larger than %d a side", r->width, r->height,
                          RETEX_MAX_SIZE);
    r->x0 = 0, r->y0 = 0, r->w = r->width, r->h = r->height;
    if (p->crop[2] > 0)
        r->x0 = p->crop[0], r->y0 = p->crop[1], r->w = p->crop[2], r->h = p->crop[3];
    if (r->x0 < 0 || r->y0 < 0 || r->w < 1 || r->h < 1 || r->x0 + r->w > r->width || r->y0 + r->h > r->height)
        return retex_fail(err, RETEX_EINVAL, "crop %d,%d,%d,%d does not lie inside the picture of %dx%d", r->x0, r->y0,
                          r->w, r->h, r->width, r->height);
    r->tiles_x = (r->w + TILE_WIDTH - 1) / TILE_WIDTH, r->tiles_y = (r->h + TILE_HEIGHT - 1) / TILE_HEIGHT;
    return RETEX_OK;
}

/* Where in the pixel a sample looks: uniform, or by the Gaussian's own density so that every sample weighs the same. */
static void pixel_offset(const Render *r, const PairKeys *keys, uint32_t sample, double *dx, double *dy)
{
    float u, v;
    pair_of_keys(keys, sample, &u, &v);
    *dx = u, *dy = v;
    if (r->context.white)
        *dx = *dy = 0.5;
    if (!r->params.gaussian || r->context.white)
        return;
    double radius = 0.5 * sqrt(-2 * log(1 - u)), phi = 2 * PI * v;
    *dx = 0.5 + radius * cos(phi), *dy = 0.5 + radius * sin(phi);
}

/* What the samples of a pixel begin with, by half: each has points of its own, for those of one would fill each other's
 * gaps. */
typedef struct PixelStart {
    int x, y;
    Sampler samplers[2]; /* of the first sample */
    PairKeys offsets[2];
} PixelStart;

static PixelStart start_pixel(const Render *r, uint32_t seed, int x, int y)
{
    PixelStart start = {.x = x, .y = y};
    for (int half = 0; half < r->context.halves; half++) {
        Sampler first = sampler_start(half ? hash_pair(seed, 1) : seed, (uint32_t)x, (uint32_t)y, 0);
        start.samplers[half] = first;
        start.offsets[half] = pair_keys(first.key, DIMENSION_PIXEL);
    }
    return start;
}

/* Of a sample: its numbers, and the ray from the camera. */
static Ray start_sample(const Render *r, const PixelStart *start, int sample, Sampler *sampler)
{
    int half = r->context.halves == 2 ? sample & 1 : 0;
    double dx, dy;
    *sampler = start->samplers[half];
    sampler->sample = (uint32_t)sample >> (r->context.halves == 2);
    pixel_offset(r, &start->offsets[half], sampler->sample, &dx, &dy);
    return camera_ray(&r->scene->camera, r->width, r->height, start->x + dx, start->y + dy);
}

static void trace_pixel(const Render *r, PathWorker *worker, int spp, int x, int y)
{
    Ray rays[PATHS_MAX];
    Sampler samplers[PATHS_MAX];
    const PixelStart start = start_pixel(r, r->params.seed, x, y);
    for (int s = 0; s < spp; s += PATHS_MAX) {
        int count = spp - s < PATHS_MAX ? spp - s : PATHS_MAX;
        for (int i = 0; i < count; i++)
            rays[i] = start_sample(r, &start, s + i, &samplers[i]);
        path_trace(worker, rays, samplers, count);
    }
}

/* Samples a pixel of a tile. */
static int tile_samples(const Render *r, int thread, int x0, int y0)
{
    Sampler sampler;
    Adaptive *pilot = r->pilots ? r->pilots[thread] : NULL;
    if (!pilot)
        return r->params.spp;
    for (int y = y0; y < y0 + TILE_HEIGHT && y < r->h; y++)
        for (int x = x0; x < x0 + TILE_WIDTH && x < r->w; x++) {
            const PixelStart start = start_pixel(r, hash_pair(r->params.seed, 3), r->x0 + x, r->y0 + y);
            for (int s = 0; s < ADAPTIVE_PILOT; s++) {
                Ray ray = start_sample(r, &start, s, &sampler);
                path_trace(adaptive_worker(pilot), &ray, &sampler, 1);
                adaptive_path_end(pilot);
            }
            adaptive_pixel_end(pilot);
        }
    return adaptive_tile_samples(pilot, r->params.noise, r->params.spp);
}

/* Guides look on where further samples would, if there were fewer than they want. */
static void end_guides(const Render *r, int thread, int spp, int x, int y)
{
    PixelGuides *guides = &r->pixel_guides[thread];
    Ray rays[ACCEL_PACKET];
    Sampler unused;
    const PixelStart start = start_pixel(r, r->params.seed, r->x0 + x, r->y0 + y);
    for (int s = spp, count; (count = denoise_guides_missing(guides)) > 0; s += count) {
        count = count < ACCEL_PACKET ? count : ACCEL_PACKET;
        for (int i = 0; i < count; i++)
            rays[i] = start_sample(r, &start, s + i, &unused);
        denoise_guides_look_along(guides, rays, count);
    }
    denoise_guides_pixel_end(guides, r->pixels[thread], x, y);
}

static void render_pixel(Render *r, int thread, int spp, int x, int y)
{
    FilmPixel *pixel = r->pixels[thread];
    PathWorker *worker = &r->workers[thread];
    for (int t = 0; r->constants && t < r->scene->ntargets; t++) {
        const float *p = r->constants[t].pixels + retex_image_index(&r->constants[t], x, y);
        worker->constants[t] = rgb(p[0], p[1], p[2]);
    }
    trace_pixel(r, worker, spp, r->x0 + x, r->y0 + y);
    film_pixel_end(pixel, x, y);
    if (r->control)
        control_pixel_end(r->controls[thread], x, y);
    if (r->pixel_guides)
        end_guides(r, thread, spp, x, y);
}

static int is_stopped(const Render *r)
{
    return r->params.stop && *r->params.stop;
}

/* Whether a band is to be rendered: of this shard, and not done by another render. */
static int is_wanted(const Render *r, int band)
{
    return (!r->params.nshards || band % r->params.nshards == r->params.shard - 1) && !r->had[band];
}

static void render_tile(void *context, int tile, int thread)
{
    Render *r = context;
    int x0 = tile % r->tiles_x * TILE_WIDTH, y0 = tile / r->tiles_x * TILE_HEIGHT;
    if (film_failed(r->film) || is_stopped(r) || !is_wanted(r, tile / r->tiles_x))
        return;
    int spp = tile_samples(r, thread, x0, y0);
    film_tile_begin(r->pixels[thread], spp);
    for (int y = y0; y < y0 + TILE_HEIGHT && y < r->h; y++)
        for (int x = x0; x < x0 + TILE_WIDTH && x < r->w; x++)
            render_pixel(r, thread, spp, x, y);
    film_tile_end(r->pixels[thread], tile);
    int across = r->w - x0 < TILE_WIDTH ? r->w - x0 : TILE_WIDTH,
        down = r->h - y0 < TILE_HEIGHT ? r->h - y0 : TILE_HEIGHT;
    atomic_fetch_add(&r->paths, (long)across * down * (spp + (r->pilots ? ADAPTIVE_PILOT : 0)));
    int done = atomic_fetch_add(&r->done, 1) + 1;
    if (thread == 0 && r->params.progress)
        r->params.progress(r->params.progress_context, (double)done / r->wanted);
}

static void close_films(Render *r)
{
    if (r->pixels)
        for (int k = 0; k < retex_threads(r->params.nthreads); k++)
            film_pixel_close(&r->pixels[k]);
    if (r->controls)
        for (int k = 0; k < retex_threads(r->params.nthreads); k++)
            control_pixel_close(&r->controls[k]);
    if (r->pilots)
        for (int k = 0; k < retex_threads(r->params.nthreads); k++)
            adaptive_close(&r->pilots[k]);
    for (int k = 0; r->workers && k < retex_threads(r->params.nthreads); k++)
        path_worker_close(&r->workers[k]);
    free(r->pilots);
    free(r->pixels);
    free(r->controls);
    free(r->pixel_guides);
    free(r->workers);
    free(r->had);
    film_close(&r->film);
    control_film_close(&r->control);
}

static void render_close(Render *r)
{
    close_films(r);
    caustics_close(&r->caustics);
    lights_close(&r->lights);
    accel_close(&r->accel);
}

/* What any use of the scene needs: the window, the ray structure and the lights. */
static int render_open(Render *r, const Scene *scene, const RenderParams *params, RetexError *err)
{
    *r = (Render){.scene = scene};
    memcpy(&r->params, params, params->size < sizeof r->params ? params->size : sizeof r->params);
    int code = check_params(&r->params, err);
    if (!code)
        code = set_window(r, err);
    if (!code)
        code = accel_create(&r->accel, scene, r->params.nthreads, err);
    if (!code)
        code = lights_create(&r->lights, scene, err);
    int split = !r->params.plain && scene->ntargets > 0;
    r->context = (PathContext){.scene = scene,
                               .accel = r->accel,
                               .lights = r->lights,
                               .max_depth = r->params.max_depth,
                               .orders = r->params.orders,
                               .most_hits = expansion_most_hits(scene->ntargets, r->params.paper),
                               .split = split,
                               .nvariants = 1,
                               .halves = 1};
    r->variants = r->params.nvariants > 0 ? r->params.variants : NULL;
    for (int k = 0; k < scene->nprimitives; k++)
        r->context.has_no_shadow |= scene->primitives[k].no_shadow;
    return code;
}

/* For whatever traces paths: a guide to caustics where there may be some, the same for any part of the picture. */
static int open_guide(Render *r, RetexError *err)
{
    if (!r->params.caustics_guide)
        return RETEX_OK;
    int code = caustics_create(&r->caustics, r->scene, r->accel, r->lights, (long)r->width * r->height * r->params.spp,
                               r->params.nthreads, err);
    r->context.caustics = r->caustics;
    return code;
}

static int open_worker(Render *r, int k, RetexError *err)
{
    PathWorker *w = &r->workers[k];
    w->context = &r->context;
    w->pixel = r->pixels[k], w->control = r->controls[k];
    w->guides = r->pixel_guides ? &r->pixel_guides[k] : NULL;
    w->variants = r->variants;
    if (r->constants) {
        memcpy(w->own, r->variants, (size_t)r->context.nvariants * sizeof *w->own);
        w->own[r->context.nvariants - 1].constants = w->constants;
        w->variants = w->own;
    }
    return path_worker_open(w, err);
}

/* A single sample does not tell how noisy it is. */
static int keeps_denoise_data(const RenderParams *p)
{
    return p->denoise_data && p->spp > 1;
}

static FirstHitWindow first_hit_window(const Render *r)
{
    return (FirstHitWindow){r->scene, r->accel, r->width, r->height,          r->x0,
                            r->y0,    r->w,     r->h,     r->params.nthreads, r->variants};
}

/* What others have rendered already, now that the film has all its images. */
static int take_over(Render *r, RetexSpool *spool, RetexError *err)
{
    r->had = calloc((size_t)r->tiles_y, 1);
    if (!r->had)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    int code = spool ? pieces_merge(spool, &r->params, r->w, r->h, err) : RETEX_OK;
    if (!code && spool)
        code = film_resume(r->film, err);
    for (int band = 0; band < r->tiles_y; band++)
        r->had[band] = (char)film_band_is_done(r->film, band);
    for (int band = 0; band < r->tiles_y; band++)
        r->wanted += is_wanted(r, band) ? r->tiles_x : 0;
    return code;
}

static int open_pilots(Render *r, int threads, RetexError *err)
{
    int code = RETEX_OK;
    if (!(r->params.noise > 0))
        return code;
    if (!(r->pilots = calloc((size_t)threads, sizeof *r->pilots)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    for (int k = 0; k < threads && !code; k++)
        code = adaptive_create(&r->pilots[k], &r->context, r->variants, err);
    return code;
}

static int open_guides(Render *r, int threads, RetexError *err)
{
    FirstHitWindow window = first_hit_window(r);
    if (!(r->pixel_guides = calloc((size_t)threads, sizeof *r->pixel_guides)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    for (int k = 0; k < threads; k++)
        r->pixel_guides[k].of = &r->guides;
    return denoise_guides_create(&r->guides, r->film, &window, r->context.split, err);
}

/* control: a film of all variants too, with moments of so many halves. */
static int render_film(Render *r, int control, int halves, RetexError *err)
{
    int threads = retex_threads(r->params.nthreads);
    FilmParams film = {.width = r->w,
                       .height = r->h,
                       .spp = r->params.spp,
                       .orders = r->params.orders,
                       .strict_paper = r->params.strict_paper,
                       .split = r->context.split,
                       .ntiles = r->tiles_x * r->tiles_y,
                       .paper = r->params.paper,
                       .clusters = r->params.clusters,
                       .sharp = r->params.sharp,
                       .broad = r->params.broad,
                       .noise = keeps_denoise_data(&r->params),
                       .spooled = r->params.spooled};
    for (int t = 0; t < r->scene->ntargets; t++)
        target_periodic(r->scene, t, film.periodic[t]);
    r->pixels = calloc((size_t)threads, sizeof *r->pixels);
    r->controls = calloc((size_t)threads, sizeof *r->controls);
    r->workers = calloc((size_t)threads, sizeof *r->workers);
    if (!r->pixels || !r->controls || !r->workers)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    int code = pieces_open(&film.spool, &r->params, r->w, r->h, err);
    if (!code)
        code = film_create(&r->film, r->scene, &film, err);
    for (int k = 0; k < threads && !code; k++)
        code = film_pixel_create(&r->pixels[k], r->film, err);
    if (!code && keeps_denoise_data(&r->params))
        code = open_guides(r, threads, err);
    if (!code)
        code = take_over(r, film.spool, err);
    if (!code && control)
        code = control_film_create(&r->control, r->w, r->h, r->params.spp, r->context.nvariants, halves, err);
    for (int k = 0; k < threads && !code && r->control; k++)
        code = control_pixel_create(&r->controls[k], r->control, err);
    for (int k = 0; k < threads && !code; k++)
        code = open_worker(r, k, err);
    r->context.matte = !r->context.white && !r->caustics && !r->context.has_no_shadow;
    return code ? code : open_pilots(r, threads, err);
}

static int start_set(RetexSet **set, const Render *r, RetexError *err)
{
    int code = retex_set_create(set, r->w, r->h, err);
    if (code)
        return code;
    RetexSet *s = *set;
    if (s->nparts == 0 && (code = retex_set_add_part(s, "beauty", "RGB", RETEX_FLOAT, 0, 0, NULL, err)))
        return code;
    const char *name = strrchr(r->scene->path, '/');
    snprintf(s->layout, sizeof s->layout, "%s", !r->context.split ? "plain" : r->params.paper ? "paper" : "footprints");
    snprintf(s->filter, sizeof s->filter, "%s", r->params.gaussian ? "gaussian" : "box");
    snprintf(s->scene, sizeof s->scene, "%.255s", name ? name + 1 : r->scene->path);
    snprintf(s->generator, sizeof s->generator, "retex-render 0.1.0");
    s->orders = r->params.orders, s->spp = r->params.spp, s->max_depth = r->params.max_depth, s->seed = r->params.seed;
    return RETEX_OK;
}

static void fill_stats(RenderStats *stats, const Render *r)
{
    stats->paths = atomic_load(&r->paths);
    for (int k = 0; k < retex_threads(r->params.nthreads); k++)
        stats->segments += r->workers[k].segments, stats->shadow_rays += r->workers[k].shadow_rays;
    stats->dropped = film_dropped(r->film) + (r->control ? control_film_dropped(r->control) : 0);
    stats->lights = lights_count(r->lights);
    stats->primitives = r->scene->nprimitives;
    for (int k = 0; k < r->scene->nprimitives; k++)
        if (r->scene->primitives[k].kind == SHAPE_MESH)
            stats->triangles += r->scene->primitives[k].mesh->nfaces;
}

typedef struct HalfSamples {
    int samples[2];
} HalfSamples;

/* How many samples fall to each half. */
static HalfSamples half_samples(const Render *r)
{
    int spp = r->params.spp;
    return r->context.halves == 2 ? (HalfSamples){{(spp + 1) / 2, spp / 2}} : (HalfSamples){{spp, 0}};
}

/* Trace all paths. */
static void render_paths(Render *r, RenderStats *stats, double started)
{
    stats->build_seconds = seconds() - started;
    retex_parallel(r->params.nthreads, r->tiles_x * r->tiles_y, render_tile, r);
    if (r->params.progress && !is_stopped(r))
        r->params.progress(r->params.progress_context, 1);
    for (int k = 0; k < retex_threads(r->params.nthreads); k++) {
        film_pixel_close(&r->pixels[k]);
        control_pixel_close(&r->controls[k]);
    }
    stats->render_seconds = seconds() - started - stats->build_seconds;
    fill_stats(stats, r);
}

/* A part `irradiance`: a pass of its own, with other samples, over the points that the pixels' centres see. */
static int add_irradiance(RetexSet *set, const Render *r, RetexError *err)
{
    Render pass = {.scene = r->scene,
                   .params = r->params,
                   .width = r->width,
                   .height = r->height,
                   .x0 = r->x0,
                   .y0 = r->y0,
                   .w = r->w,
                   .h = r->h,
                   .tiles_x = r->tiles_x,
                   .tiles_y = r->tiles_y,
                   .context = r->context};
    RetexSet *found = NULL;
    RenderStats ignored = {0};
    int part;
    pass.context.white = 1, pass.context.split = 0, pass.context.halves = 1;
    pass.params.seed = hash_pair(r->params.seed, 2), pass.params.progress = NULL;
    pass.params.denoise_data = 0, pass.params.noise = 0;
    forget_files(&pass.params);
    pass.lights = r->lights;
    int code = start_set(&found, &pass, err);
    if (!code)
        code = render_film(&pass, 0, 0, err);
    if (!code) {
        render_paths(&pass, &ignored, 0);
        code = film_finish(pass.film, found, err);
    }
    if (!code)
        code = retex_set_add_part(set, "irradiance", "RGB", RETEX_FLOAT, 0, 0, &part, err);
    for (size_t i = 0; i < (size_t)r->w * (size_t)r->h * 3 && !code; i++)
        set->parts[part].image.pixels[i] = (float)PI * found->parts[0].image.pixels[i];
    close_films(&pass);
    retex_set_close(&found);
    return code;
}

/* Render, and fill what the film leaves open. */
static int render_into(RetexSet *set, Render *r, RenderStats *stats, double started, RetexError *err)
{
    int data = r->params.control_data;
    r->context.halves = data == 2 ? 2 : 1;
    int code = render_film(r, data > 0, r->context.halves, err);
    if (code)
        return code;
    render_paths(r, stats, started);
    if (is_stopped(r) && film_bands_done(r->film) < film_bands(r->film))
        return pieces_keep(r->film, &r->params, err);
    code = film_finish(r->film, set, err);
    FirstHitWindow window = first_hit_window(r);
    if (!code && r->context.split)
        code = first_hit_targets(set, &window, err);
    double scales[RETEX_MAX_TARGETS][2];
    if (!code && r->context.split)
        code = uv_scale_measure(r->scene, r->accel, scales, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        memcpy(set->targets[t].uv_scale, scales[t], sizeof scales[t]);
    if (!code && r->context.split)
        code = originals_add(set, r->scene, r->params.nthreads, err);
    if (!code)
        code = first_hit_aovs(set, &window, r->params.aovs, err);
    if (!code && r->pixel_guides)
        code = denoise_guides_finish(&r->guides, r->film, set, err);
    if (!code && r->params.aovs & AOV_IRRADIANCE)
        code = add_irradiance(set, r, err);
    if (!code && data) {
        ControlMoments *moments[2] = {control_film_moments(r->control, 0), control_film_moments(r->control, 1)};
        code = control_data_add(set, moments, half_samples(r).samples, r->context.halves, err);
    }
    film_give_spool(r->film, set);
    stats->render_seconds = seconds() - started - stats->build_seconds;
    return code;
}

int render_scene(RetexSet **set, const Scene *scene, const RenderParams *params, RenderStats *stats, RetexError *err)
{
    const RenderParams defaults = RENDER_PARAMS_INIT;
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    *set = NULL;
    double started = seconds();
    Render r;
    int code = render_open(&r, scene, params ? params : &defaults, err);
    if (!code)
        code = open_guide(&r, err);
    if (!code)
        code = start_set(set, &r, err);
    if (!code)
        code = render_into(*set, &r, stats, started, err);
    render_close(&r);
    if (code)
        retex_set_close(set);
    return code;
}

int render_shard(const Scene *scene, const RenderParams *params, RenderStats *stats, RetexError *err)
{
    *stats = (RenderStats){0};
    double started = seconds();
    Render r;
    int code = render_open(&r, scene, params, err);
    if (!code)
        code = open_guide(&r, err);
    if (!code)
        code = render_film(&r, 0, 0, err);
    if (!code) {
        render_paths(&r, stats, started);
        code = film_failed(r.film) ? film_finish(r.film, NULL, err) : RETEX_OK;
    }
    if (!code && is_stopped(&r) && r.done < r.wanted)
        code = pieces_keep(r.film, &r.params, err);
    if (!code)
        code = film_keep(r.film, r.params.key, r.params.output, 1, err);
    render_close(&r);
    return code;
}

int render_variants(RetexImage *pictures, const Scene *scene, const RenderParams *params, RenderStats *stats,
                    RetexError *err)
{
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    double started = seconds();
    RenderParams plain = *params;
    Render r;
    plain.plain = 1, plain.denoise_data = 0;
    forget_files(&plain);
    int code = render_open(&r, scene, &plain, err);
    if (!code && r.params.nvariants < 1)
        code = retex_fail(err, RETEX_EINVAL, "no variants to render");
    r.context.nvariants = r.params.nvariants;
    if (!code)
        code = open_guide(&r, err);
    if (!code)
        code = render_film(&r, 1, 0, err);
    if (!code)
        render_paths(&r, stats, started);
    for (int v = 0; v < r.params.nvariants && !code; v++) {
        pictures[v] = *control_film_picture(r.control, v);
        *control_film_picture(r.control, v) = (RetexImage){0};
    }
    render_close(&r);
    return code;
}

/* One line where the set is of another picture. */
static int check_control(const Render *r, const RetexSet *set, RetexError *err)
{
    const char *slash = strrchr(r->scene->path, '/'), *scene = slash ? slash + 1 : r->scene->path;
    if (set->width != r->w || set->height != r->h)
        return retex_fail(err, RETEX_EINVAL, "the set is %dx%d, this picture %dx%d", set->width, set->height, r->w,
                          r->h);
    if (strncmp(set->scene, scene, sizeof set->scene - 1))
        return retex_fail(err, RETEX_EINVAL, "the set is of %s, this is %s", set->scene, scene);
    if (strcmp(set->filter, r->params.gaussian ? "gaussian" : "box"))
        return retex_fail(err, RETEX_EINVAL, "the set has the pixel filter %s, this picture another", set->filter);
    if (set->max_depth != r->params.max_depth)
        return retex_fail(err, RETEX_EINVAL, "the set has paths of up to %d segments, this picture of up to %d",
                          set->max_depth, r->params.max_depth);
    for (int t = 0; set->ntargets && t < r->scene->ntargets; t++)
        if (retex_set_find_target(set, r->scene->targets[t].name) < 0)
            return retex_fail(err, RETEX_EINVAL, "the set has no target `%s`", r->scene->targets[t].name);
    if (set->seed == r->params.seed)
        return retex_fail(err, RETEX_EINVAL, "the set has seed %u too: its noise must not be that of the new samples",
                          (unsigned)set->seed);
    return RETEX_OK;
}

/* The constants by pixel, and what the set is with them. */
static int find_constants(Render *r, const RetexSet *set, RetexImage *constants, RetexImage *combined, RetexError *err)
{
    FirstHitWindow window = first_hit_window(r);
    int code = control_constants(constants, &window, set, err);
    if (!code)
        code = control_constants_combine(combined, set, r->scene, constants, r->params.nthreads, err);
    r->constants = constants;
    return code;
}

static int trace_control(Render *r, RetexImage *picture, const RetexSet *set, const RetexImage *combined,
                         ControlMode mode, double *distance, RenderStats *stats, double started, RetexError *err)
{
    r->context.halves = mode == CONTROL_HALVES ? 2 : 1;
    int code = render_film(r, 1, r->context.halves, err);
    if (code)
        return code;
    render_paths(r, stats, started);
    ControlMoments *moments[2] = {control_film_moments(r->control, 0), control_film_moments(r->control, 1)};
    HalfSamples half = half_samples(r);
    if (distance)
        *distance = control_distance(moments, half.samples, r->context.halves, set);
    return control_variate(picture, moments, half.samples, set, combined, mode, err);
}

int render_control(RetexImage *picture, const Scene *scene, const RenderParams *params, const RetexSet *set,
                   ControlMode mode, double *distance, RenderStats *stats, RetexError *err)
{
    RenderStats ignored;
    if (!stats)
        stats = &ignored;
    *stats = (RenderStats){0};
    double started = seconds();
    RenderParams plain = *params;
    RenderVariant variants[CONTROL_VARIANTS_MAX] = {{{NULL}, NULL}};
    RetexImage constants[RETEX_MAX_TARGETS] = {{0}}, combined = {0};
    Render r;
    if (params->nvariants > 0)
        variants[0] = params->variants[0];
    plain.plain = 1, plain.variants = variants, plain.nvariants = 2, plain.denoise_data = 0;
    forget_files(&plain);
    int code = render_open(&r, scene, &plain, err);
    if (!code)
        code = check_control(&r, set, err);
    int two = !code && mode == CONTROL_UNBIASED && control_constants_fit(scene, set);
    r.context.nvariants = 2 + two;
    if (!code)
        code = open_guide(&r, err);
    if (two && !code)
        code = find_constants(&r, set, constants, &combined, err);
    if (!code)
        code = trace_control(&r, picture, set, two ? &combined : NULL, mode, distance, stats, started, err);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        retex_image_free(&constants[t]);
    retex_image_free(&combined);
    render_close(&r);
    return code;
}

int render_ident_shares(const Scene *scene, const RenderParams *params, double *shares, RetexError *err)
{
    Render r;
    int code = render_open(&r, scene, params, err);
    FirstHitWindow window = first_hit_window(&r);
    if (!code)
        code = first_hit_idents(&window, shares, err);
    render_close(&r);
    return code;
}

int render_uv_scales(const Scene *scene, int nthreads, double scales[][2], RetexError *err)
{
    Accel *accel = NULL;
    int code = accel_create(&accel, scene, nthreads, err);
    if (!code)
        code = uv_scale_measure(scene, accel, scales, err);
    accel_close(&accel);
    return code;
}

int render_trace(const Scene *scene, const RenderParams *params, int x, int y, int sample, FILE *out, RetexError *err)
{
    Render r;
    int code = render_open(&r, scene, params, err);
    if (!code && (x < 0 || y < 0 || x >= r.width || y >= r.height))
        code = retex_fail(err, RETEX_EINVAL, "pixel %d,%d does not lie inside the picture of %dx%d", x, y, r.width,
                          r.height);
    if (!code)
        code = open_guide(&r, err);
    if (!code)
        code = render_film(&r, 0, 0, err);
    if (!code) {
        r.context.trace = out, r.context.matte = 0;
        fprintf(out, "pixel %d,%d sample %d of %dx%d\n", x, y, sample, r.width, r.height);
        const PixelStart start = start_pixel(&r, r.params.seed, x, y);
        Sampler sampler;
        Ray ray = start_sample(&r, &start, sample, &sampler);
        path_trace(&r.workers[0], &ray, &sampler, 1);
    }
    render_close(&r);
    return code;
}
