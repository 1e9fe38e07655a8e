/* See live.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/denoise.h>
#include <retex/parallel.h>
#include "light/lights.h"
#include "path/caustics.h"
#include "path/projection.h"
#include "render/live.h"
#include "render/render.h"

enum { TILE_PIXELS = TILE_WIDTH * TILE_HEIGHT };
#define FAR 4 /* times the bounds: how far away a camera may be of which the ray structure knew nothing */

/* What a tile has got so far. */
typedef struct LiveTile {
    int samples, first;                                /* first: those that `half` has */
    double sums[TILE_PIXELS][3], half[TILE_PIXELS][3]; /* of light, by pixel; of all samples, and of the first half */
} LiveTile;

struct LiveRender {
    Render render;
    Scene *scene;
    Camera own;  /* the scene's */
    Vec3 eye;    /* where the camera was when the lights were made */
    double far;  /* coordinates that the ray structure is made for */
    long guided; /* paths that the guide is made for; -1: there is none yet */
    Film *film;  /* of one pixel, which counts what is dropped */
    LiveTile *tiles;
    int ntiles;
    uint64_t charged;                  /* for the tiles */
    int spp, target;                   /* samples in all, and those of the pass */
    double (*scratch)[TILE_PIXELS][3]; /* by thread */
};

/* ---- life ---- */

static int threads_of(const LiveRender *l)
{
    return retex_threads(l->render.params.nthreads);
}

static void close_tiles(LiveRender *l)
{
    free(l->tiles);
    retex_budget_release(l->render.params.budget, l->charged);
    l->tiles = NULL, l->ntiles = 0, l->charged = 0;
}

/* What threads have: a pixel of a film that nothing is told but what is dropped. */
static int open_workers(LiveRender *l, RetexError *err)
{
    Render *r = &l->render;
    const FilmParams film = {.width = 1, .height = 1, .spp = 1, .ntiles = 1};
    const int threads = threads_of(l);
    r->pixels = calloc((size_t)threads, sizeof *r->pixels);
    r->workers = calloc((size_t)threads, sizeof *r->workers);
    if (!r->pixels || !r->workers)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    int code = film_create(&r->film, l->scene, &film, err);
    for (int k = 0; k < threads && !code; k++) {
        PathWorker *w = &r->workers[k];
        code = film_pixel_create(&r->pixels[k], r->film, err);
        w->context = &r->context, w->pixel = r->pixels[k], w->variants = r->variants;
        if (!code)
            code = path_worker_open(w, err);
    }
    return code;
}

static int open_render(LiveRender *l, const RenderParams *params, RetexError *err)
{
    const Vec3 eye = l->scene->camera.location;
    Vec3 low, high;
    int code = render_open(&l->render, l->scene, params, err);
    if (!code)
        code = open_workers(l, err);
    if (code)
        return code;
    accel_bounds(l->render.accel, eye, &low, &high);
    l->eye = eye, l->far = FAR * fmax(vec_largest(low), vec_largest(high)), l->guided = -1;
    return RETEX_OK;
}

int live_open(LiveRender **live, Scene *scene, const RenderParams *given, RetexError *err)
{
    RenderParams params = *given;
    LiveRender *l = *live = calloc(1, sizeof *l);
    if (!l)
        return retex_fail(err, RETEX_ENOMEM, "out of memory");
    params.plain = 1, params.denoise_data = 0, params.noise = 0, params.aovs = 0;
    params.progress = NULL;
    memset(params.crop, 0, sizeof params.crop);
    render_drop_files(&params);
    l->scene = scene, l->own = scene->camera;
    int code = open_render(l, &params, err);
    if (!code && !(l->scratch = malloc((size_t)threads_of(l) * sizeof *l->scratch)))
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads_of(l));
    if (code)
        live_close(live);
    return code;
}

void live_close(LiveRender **live)
{
    LiveRender *l = *live;
    if (!l)
        return;
    close_tiles(l);
    l->scene->camera = l->own;
    render_close(&l->render);
    free(l->scratch);
    free(l);
    *live = NULL;
}

/* ---- the view ---- */

FirstHitWindow live_window(const LiveRender *l)
{
    return render_window(&l->render);
}

void live_bounds(const LiveRender *l, Vec3 *low, Vec3 *high)
{
    accel_bounds(l->render.accel, l->own.location, low, high);
}

Vec3 live_middle(const LiveRender *l)
{
    const Ray ray = camera_ray(&l->own, 2, 2, 1, 1, NULL);
    Vec3 low, high;
    Hit hit;
    live_bounds(l, &low, &high);
    const double size = vec_length(vec_sub(high, low));
    const int is_hit = camera_ray_exists(&ray) && accel_intersect(l->render.accel, &ray, RAY_CAMERA, &hit);
    return vec_mad(ray.origin, ray.direction, is_hit ? hit.t : isfinite(size) && size > 0 ? size : 1);
}

/* The ray structure and the lights anew, where they would be others for a camera that is here. */
static int adapt(LiveRender *l, RetexError *err)
{
    const Vec3 eye = l->scene->camera.location;
    const RenderParams params = l->render.params;
    if (vec_largest(eye) <= l->far && !lights_differ(l->scene, l->eye, eye))
        return RETEX_OK;
    render_close(&l->render);
    return open_render(l, &params, err);
}

/* Planar projections are seen from the side on which the camera is. */
static int project(LiveRender *l, RetexError *err)
{
    int any = 0;
    for (int t = 0; t < l->scene->ntargets; t++)
        any |= l->scene->targets[t].projection.kind == UV_PLANAR;
    return any ? projection_choose(l->scene, l->render.params.unit, err) : RETEX_OK;
}

int live_look(LiveRender *l, int width, int height, const CameraView *view, RetexError *err)
{
    Render *r = &l->render;
    close_tiles(l);
    r->params.width = width, r->params.height = height;
    l->scene->camera = view ? camera_look(&l->own, view, (double)width / height) : l->own;
    int code = adapt(l, err);
    if (!code)
        code = project(l, err);
    return code ? code : render_look(r, err);
}

static int open_guide(LiveRender *l, RetexError *err)
{
    Render *r = &l->render;
    const long paths = (long)r->width * r->height * r->params.spp;
    if (paths == l->guided)
        return RETEX_OK;
    caustics_close(&r->caustics);
    r->context.caustics = NULL;
    l->guided = -1;
    const int code = render_open_guide(r, err);
    render_choose_matte(r);
    l->guided = code ? -1 : paths;
    return code;
}

int live_begin(LiveRender *l, int spp, RetexError *err)
{
    Render *r = &l->render;
    const int count = r->tiles_x * r->tiles_y;
    const uint64_t bytes = (uint64_t)count * sizeof *l->tiles;
    close_tiles(l);
    r->params.spp = spp;
    int code = open_guide(l, err);
    if (!code)
        code = retex_budget_charge(r->params.budget, bytes, "the picture", err);
    if (code)
        return code;
    l->charged = bytes;
    if (!(l->tiles = calloc((size_t)count, sizeof *l->tiles)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the picture");
    l->ntiles = count, l->spp = spp, l->target = 0;
    return RETEX_OK;
}

/* ---- its samples ---- */

int live_samples_wanted(const LiveRender *l)
{
    return l->tiles ? l->spp : 0;
}

int live_samples(const LiveRender *l)
{
    int least = l->ntiles ? l->spp : 0;
    for (int k = 0; k < l->ntiles; k++)
        least = l->tiles[k].samples < least ? l->tiles[k].samples : least;
    return least;
}

/* Twice as many; but so that the last pass doubles them, too: the halves then tell the noise. */
static int next_target(int samples, int all)
{
    return samples == 0 ? 1 : all <= 2 * samples ? all : all < 4 * samples ? (all + 1) / 2 : 2 * samples;
}

typedef struct Pass {
    LiveRender *live;
    const StopAsked *stop;
} Pass;

static void improve_tile(void *context, int index, int thread)
{
    const Pass *pass = context;
    LiveRender *l = pass->live;
    LiveTile *tile = &l->tiles[index];
    double(*sums)[3] = l->scratch[thread];
    if (tile->samples >= l->target)
        return;
    memcpy(sums, tile->sums, sizeof tile->sums);
    if (!render_tile_light(&l->render, &l->render.workers[thread], index, tile->samples, l->target, sums, pass->stop))
        return;
    memcpy(tile->half, tile->sums, sizeof tile->half);
    memcpy(tile->sums, sums, sizeof tile->sums);
    tile->first = tile->samples, tile->samples = l->target;
}

int live_improve(LiveRender *l, const StopAsked *stop, RetexError *err)
{
    Pass pass = {l, stop};
    const int samples = live_samples(l);
    if (samples >= l->target)
        l->target = next_target(samples, l->spp);
    retex_parallel(l->render.params.nthreads, l->ntiles, improve_tile, &pass);
    return retex_budget_check(l->render.params.budget, err);
}

void live_picture(const LiveRender *l, float *rgb)
{
    const Render *r = &l->render;
    for (int t = 0; t < l->ntiles; t++) {
        const LiveTile *tile = &l->tiles[t];
        int x0, y0, across;
        const int count = render_tile_pixels(r, t, &x0, &y0, &across);
        for (int k = 0; k < count; k++) {
            float *to = rgb + 3 * ((size_t)(y0 + k / across) * (size_t)r->w + (size_t)(x0 + k % across));
            for (int c = 0; c < 3; c++)
                to[c] = tile->samples ? (float)(tile->sums[k][c] / tile->samples) : 0;
        }
    }
}

/* ---- without noise ---- */

/* A pass whose film gets each pixel as two samples, the means of the halves: their difference tells the noise. */
typedef struct Denoising {
    LiveRender *live;
    Render pass;
    const StopAsked *stop;
    RetexBudget *budget; /* is stopped where `stop` is asked */
} Denoising;

static void give_halves(void *context, int index, int thread)
{
    Denoising *d = context;
    const LiveTile *tile = &d->live->tiles[index];
    double first[TILE_PIXELS][3], rest[TILE_PIXELS][3];
    for (int k = 0; k < TILE_PIXELS; k++)
        for (int c = 0; c < 3; c++) {
            first[k][c] = tile->half[k][c] / tile->first;
            rest[k][c] = (tile->sums[k][c] - tile->half[k][c]) / (tile->samples - tile->first);
        }
    render_tile_halves(&d->pass, thread, index, (double(*const[2])[3]){first, rest}, d->stop);
}

/* A set of the picture, with what denoising reads. */
static int make_set(RetexSet **set, Denoising *d, RetexError *err)
{
    Render *pass = &d->pass;
    int code = render_open_film(pass, 0, 0, err);
    if (code)
        return code;
    retex_parallel(pass->params.nthreads, d->live->ntiles, give_halves, d);
    if (d->stop->is_asked(d->stop->context))
        return retex_fail(err, RETEX_ESTOPPED, "stopped");
    code = render_start_set(set, pass, err);
    if (!code)
        code = film_finish(pass->film, *set, err);
    return code ? code : denoise_guides_finish(&pass->guides, pass->film, *set, err);
}

static void watch(void *context, double done)
{
    const Denoising *d = context;
    (void)done;
    if (d->stop->is_asked(d->stop->context))
        retex_budget_stop(d->budget);
}

static int denoise_set(RetexSet *set, Denoising *d, RetexError *err)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    int code = retex_budget_create(&d->budget, err);
    if (code)
        return code;
    params.quality = "preview", params.budget = d->budget;
    params.progress = watch, params.progress_context = d;
    code = retex_denoise(set, &params, NULL, d->pass.params.nthreads, err);
    retex_budget_close(&d->budget);
    return code;
}

int live_denoise(LiveRender *l, const StopAsked *stop, float *rgb, RetexError *err)
{
    Denoising d = {l, render_pass(&l->render), stop, NULL};
    RetexBudget *budget = l->render.params.budget;
    RetexSet *set = NULL;
    if (live_samples(l) < 2)
        return retex_fail(err, RETEX_EINVAL, "there is no picture of two samples that could be denoised");
    d.pass.params.spp = 2, d.pass.params.denoise_data = 1, d.pass.quick_guides = 1;
    const uint64_t bytes = (uint64_t)render_bytes(l->scene, &d.pass.params, l->render.w, l->render.h);
    int code = retex_budget_charge(budget, bytes, "denoising", err);
    if (code)
        return code;
    code = make_set(&set, &d, err);
    if (!code)
        code = denoise_set(set, &d, err);
    if (!code)
        memcpy(rgb, retex_set_part(set, 0)->image.pixels,
               (size_t)l->render.w * (size_t)l->render.h * 3 * sizeof *rgb);
    render_close_films(&d.pass);
    retex_set_close(&set);
    retex_budget_release(budget, bytes);
    return code;
}
