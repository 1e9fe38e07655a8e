/* Distribution of tiles to threads, and the sample loop of each pixel. */
#include <retex/clock.h>
#include <retex/parallel.h>
#include "camera/camera.h"
#include "render/internal.h"

/* Offset of a sample within the pixel filter: uniform, or with the density of the Gaussian. All samples have the
 * same weight. */
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

/* State that all samples of a pixel share, for each half of the samples. Each half has its own sample sequence: the
 * halves of a single low-discrepancy sequence are not independent. */
typedef struct PixelStart {
    int x, y;
    Sampler samplers[2]; /* samplers at the first sample of each half */
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

/* Start a sample: its random numbers and its camera ray. */
static Ray start_sample(const Render *r, const PixelStart *start, int sample, Sampler *sampler)
{
    int half = r->context.halves == 2 ? sample & 1 : 0;
    double dx, dy;
    *sampler = start->samplers[half];
    sampler->sample = (uint32_t)sample >> (r->context.halves == 2);
    pixel_offset(r, &start->offsets[half], sampler->sample, &dx, &dy);
    float lens[2];
    const Camera *camera = &r->scene->camera;
    const int varies = camera_needs_sample(camera);
    if (varies)
        sampler_pair(sampler, DIMENSION_CAMERA, &lens[0], &lens[1]);
    return camera_ray(camera, r->width, r->height, start->x + dx, start->y + dy, varies ? lens : NULL);
}

/* Some pixels of a tile, by their numbers in it. */
typedef struct PixelRun {
    int x0, y0, across; /* of the tile */
    int first, count;
} PixelRun;

static int run_x(const PixelRun *run, int k)
{
    return run->x0 + (run->first + k) % run->across;
}

static int run_y(const PixelRun *run, int k)
{
    return run->y0 + (run->first + k) / run->across;
}

/* Trace some samples of each of them side by side, from the first of these on. */
static void trace_run(const Render *r, PathWorker *worker, const PixelRun *run, uint32_t seed, int first, int each,
                      PathResult results[PATHS_MAX])
{
    Ray rays[PATHS_MAX];
    Sampler samplers[PATHS_MAX];
    for (int k = 0; k < run->count; k++) {
        const PixelStart start = start_pixel(r, seed, r->x0 + run_x(run, k), r->y0 + run_y(run, k));
        for (int s = 0; s < each; s++)
            rays[k * each + s] = start_sample(r, &start, first + s, &samplers[k * each + s]);
    }
    path_trace(worker, rays, samplers, run->count * each, each, results);
}

/* Samples per pixel of a tile. */
static int tile_samples(const Render *r, int thread, int x0, int y0, int across, int down)
{
    enum { TOGETHER = PATHS_MAX / ADAPTIVE_PILOT };
    Adaptive *pilot = r->pilots ? r->pilots[thread] : NULL;
    PathResult paths[PATHS_MAX];
    if (!pilot)
        return r->params.spp;
    for (int first = 0; first < across * down && !render_is_stopped(r); first += TOGETHER) {
        const int left = across * down - first;
        const PixelRun run = {x0, y0, across, first, left < TOGETHER ? left : TOGETHER};
        trace_run(r, adaptive_worker(pilot), &run, hash_pair(r->params.seed, 3), 0, ADAPTIVE_PILOT, paths);
        for (int k = 0; k < run.count; k++)
            adaptive_pixel_end(pilot, paths + k * ADAPTIVE_PILOT);
    }
    return adaptive_tile_samples(pilot, r->params.noise, r->params.spp);
}

/* The camera rays of these samples of a pixel of the whole picture. */
static void camera_rays(const Render *r, int x, int y, int first, int count, Ray *rays)
{
    const PixelStart start = start_pixel(r, r->params.seed, x, y);
    Sampler unused;
    for (int i = 0; i < count; i++)
        rays[i] = start_sample(r, &start, first + i, &unused);
}

void render_camera_hits(const Render *r, int x, int y, int count, RenderHitVisitor *visit, void *context)
{
    Ray rays[ACCEL_PACKET];
    RayKind kinds[ACCEL_PACKET];
    Hit hits[ACCEL_PACKET];
    for (int i = 0; i < ACCEL_PACKET; i++)
        kinds[i] = RAY_CAMERA;
    for (int s = 0, n; s < count; s += n) {
        n = count - s < ACCEL_PACKET ? count - s : ACCEL_PACKET;
        camera_rays(r, x, y, s, n, rays);
        accel_intersect_packet(r->accel, rays, kinds, n, 1, hits);
        for (int i = 0; i < n; i++)
            visit(context, &rays[i], &hits[i]);
    }
}

/* Trace additional camera rays for the guides, if the guides need more sample points than the pixel has samples. */
static void end_guides(const Render *r, int thread, PixelGuides *guides, int spp, int x, int y)
{
    Ray rays[ACCEL_PACKET];
    for (int s = spp, count; (count = denoise_guides_missing(guides)) > 0; s += count) {
        count = count < ACCEL_PACKET ? count : ACCEL_PACKET;
        camera_rays(r, r->x0 + x, r->y0 + y, s, count, rays);
        denoise_guides_trace(guides, rays, count);
    }
    denoise_guides_pixel_end(guides, r->pixels[thread], x, y);
}

static void start_run(Render *r, int thread, const PixelRun *run)
{
    PathWorker *worker = &r->workers[thread];
    for (int t = 0; r->constants && t < r->scene->ntargets; t++) { /* with a control film, of one pixel */
        const float *p = r->constants[t].pixels + retex_image_index(&r->constants[t], run_x(run, 0), run_y(run, 0));
        worker->constants[t] = rgb(p[0], p[1], p[2]);
    }
    for (int k = 0; r->pixel_guides && k < run->count; k++)
        worker->first_hits[k].wanted = denoise_guides_missing(pixel_guides_at(r->pixel_guides[thread], k));
}

/* The k-th pixel of a run has all its paths. */
static void end_pixel(const Render *r, int thread, const PixelRun *run, int k, int spp)
{
    const int x = run_x(run, k), y = run_y(run, k);
    film_pixel_end(r->pixels[thread], x, y);
    if (r->control)
        control_pixel_end(r->controls[thread], x, y);
    if (r->pixel_guides)
        end_guides(r, thread, pixel_guides_at(r->pixel_guides[thread], k), spp, x, y);
}

/* How many pixels are traced side by side: those of few samples fill no packets. */
static int pixels_together(const Render *r, int spp)
{
    return !r->control && !r->context.trace && spp <= PATHS_MAX / 2 ? PATHS_MAX / spp : 1;
}

/* Pixels with all their samples, at once or in turns of PATHS_MAX; or stop early if the render is stopped. */
static void render_run(Render *r, int thread, const PixelRun *run, int spp)
{
    PathResult paths[PATHS_MAX];
    PathWorker *worker = &r->workers[thread];
    start_run(r, thread, run);
    for (int first = 0; first < spp && !render_is_stopped(r); first += PATHS_MAX) {
        const int each = spp - first < PATHS_MAX ? spp - first : PATHS_MAX;
        trace_run(r, worker, run, r->params.seed, first, each, paths);
        for (int k = 0; k < run->count; k++) {
            for (int s = 0; s < each; s++)
                path_end(worker, &paths[k * each + s]);
            if (first + each == spp)
                end_pixel(r, thread, run, k, spp);
        }
    }
}

int render_tile_pixels(const Render *r, int tile, int *x0, int *y0, int *across)
{
    *x0 = tile % r->tiles_x * TILE_WIDTH, *y0 = tile / r->tiles_x * TILE_HEIGHT;
    *across = r->w - *x0 < TILE_WIDTH ? r->w - *x0 : TILE_WIDTH;
    return *across * (r->h - *y0 < TILE_HEIGHT ? r->h - *y0 : TILE_HEIGHT);
}

int render_tile_light(const Render *r, PathWorker *worker, int tile, int from, int to, double (*sums)[3],
                      const StopAsked *stop)
{
    const int step = to - from < PATHS_MAX ? to - from : PATHS_MAX, together = PATHS_MAX / step;
    PathResult paths[PATHS_MAX];
    int x0, y0, across;
    const int count = render_tile_pixels(r, tile, &x0, &y0, &across);
    for (int first = 0; first < count; first += together) {
        const PixelRun run = {x0, y0, across, first, count - first < together ? count - first : together};
        for (int s = from; s < to; s += step) {
            const int each = to - s < step ? to - s : step;
            if (render_is_stopped(r) || stop->is_asked(stop->context))
                return 0;
            trace_run(r, worker, &run, r->params.seed, s, each, paths);
            for (int k = 0; k < run.count * each; k++)
                for (int c = 0; c < 3; c++)
                    sums[first + k / each][c] += paths[k].light[c];
        }
    }
    return 1;
}

void render_tile_halves(Render *r, int thread, int tile, double (*const halves[2])[3], const StopAsked *stop)
{
    int x0, y0, across;
    const int count = render_tile_pixels(r, tile, &x0, &y0, &across);
    FilmPixel *pixel = r->pixels[thread];
    for (int k = 0; k < count; k++) {
        const PixelRun run = {x0, y0, across, k, 1};
        if (k % across == 0 && (render_is_stopped(r) || stop->is_asked(stop->context)))
            return;
        for (int half = 0; half < 2; half++) {
            film_add_light(pixel, halves[half][k]);
            film_path_end(pixel, NULL);
        }
        end_pixel(r, thread, &run, 0, 0);
    }
    film_tile_end(pixel, tile);
}

static void render_tile(void *context, int tile, int thread)
{
    Render *r = context;
    int x0, y0, across;
    const int count = render_tile_pixels(r, tile, &x0, &y0, &across), down = count / across;
    if (film_failed(r->film) || render_is_stopped(r) || !render_is_wanted(r, tile / r->tiles_x))
        return;
    const int spp = tile_samples(r, thread, x0, y0, across, down), together = pixels_together(r, spp);
    film_tile_begin(r->pixels[thread], spp);
    for (int first = 0; first < count && !render_is_stopped(r); first += together) {
        const int left = count - first;
        const PixelRun run = {x0, y0, across, first, left < together ? left : together};
        render_run(r, thread, &run, spp);
    }
    if (render_is_stopped(r)) /* a stopped render: pixels of the tile may lack samples */
        return;
    film_tile_end(r->pixels[thread], tile);
    atomic_fetch_add(&r->paths, (long)count * (spp + (r->pilots ? ADAPTIVE_PILOT : 0)));
    int done = atomic_fetch_add(&r->done, 1) + 1;
    if (thread == 0 && done < r->wanted && r->params.progress) /* render_paths tells of the end */
        r->params.progress(r->params.progress_context, (double)done / r->wanted);
}

void render_sample(Render *r, int x, int y, int sample)
{
    const PixelStart start = start_pixel(r, r->params.seed, x, y);
    Sampler sampler;
    Ray ray = start_sample(r, &start, sample, &sampler);
    PathResult result;
    path_trace(&r->workers[0], &ray, &sampler, 1, 1, &result);
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
        if (r->scene->primitives[k].shape.mesh)
            stats->triangles += r->scene->primitives[k].shape.mesh->nfaces;
}

HalfSamples render_half_samples(const Render *r)
{
    int spp = r->params.spp;
    return r->context.halves == 2 ? (HalfSamples){{(spp + 1) / 2, spp / 2}} : (HalfSamples){{spp, 0}};
}

int render_paths(Render *r, RenderStats *stats, double started, RetexError *err)
{
    stats->build_seconds = retex_clock_seconds() - started;
    retex_parallel(r->params.nthreads, r->tiles_x * r->tiles_y, render_tile, r);
    if (r->params.progress && !render_is_stopped(r))
        r->params.progress(r->params.progress_context, 1);
    for (int k = 0; k < retex_threads(r->params.nthreads); k++) {
        film_pixel_close(&r->pixels[k]);
        control_pixel_close(&r->controls[k]);
    }
    stats->render_seconds = retex_clock_seconds() - started - stats->build_seconds;
    fill_stats(stats, r);
    return r->done < r->wanted ? retex_budget_check(r->params.budget, err) : RETEX_OK;
}
