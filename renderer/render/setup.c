/* Setup of a render: window, acceleration structure, lights, films and data of each thread. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <retex/parallel.h>
#include "film/footprints/footprints.h"
#include "camera/camera.h"
#include "film/paper/paper.h"
#include "render/checkpoints.h"
#include "path/caustics.h"
#include "render/internal.h"
#include "render/originals.h"
#include "render/render.h"

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
    if (p->extra < 0 || p->extra > FILM_CLUSTERS_MAX - p->clusters)
        return retex_fail(err, RETEX_EINVAL, "extra clusters must be 0 to %d, not %d", FILM_CLUSTERS_MAX - p->clusters,
                          p->extra);
    return RETEX_OK;
}

const FilmLayout *render_layout(const RenderParams *p)
{
    return p->paper ? &paper_layout : &footprints_layout;
}

double render_bytes(const Scene *scene, const RenderParams *p, int width, int height)
{
    const FilmParams film = {.width = width,
                             .height = height,
                             .orders = p->orders,
                             .split = !p->plain,
                             .layout = render_layout(p),
                             .sharp = p->sharp,
                             .broad = p->broad,
                             .spp = p->spp,
                             .nkept = scene->nkept,
                             .noise = p->denoise_data};
    const double guides = p->denoise_data && !p->stored ? 19 + scene->ntargets : 0;
    return film_bytes(&film, scene->ntargets, p->stored) +
           (double)width * height * sizeof(float) * (guides + retex_aov_channels(p->aovs));
}

void render_drop_files(RenderParams *p)
{
    p->stored = p->resume = 0;
    p->checkpoint = NULL;
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

int render_check_window(const Scene *scene, const RenderParams *params, RetexError *err)
{
    Render r = {.scene = scene, .params = *params};
    return set_window(&r, err);
}

void render_close_films(Render *r)
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
    for (int k = 0; r->pixel_guides && k < retex_threads(r->params.nthreads); k++)
        pixel_guides_close(&r->pixel_guides[k]);
    for (int k = 0; r->workers && k < retex_threads(r->params.nthreads); k++)
        path_worker_close(&r->workers[k]);
    free(r->pilots);
    free(r->pixels);
    free(r->controls);
    free(r->pixel_guides);
    free(r->workers);
    free(r->resumed);
    film_close(&r->film);
    control_film_close(&r->control);
}

void render_close(Render *r)
{
    render_close_films(r);
    retex_band_store_close(&r->store);
    caustics_close(&r->caustics);
    lights_close(&r->lights);
    accel_close(&r->accel);
}

/* Some way beyond all that is bounded. */
static double media_reach(const Render *r)
{
    Vec3 low, high;
    accel_bounds(r->accel, r->scene->camera.location, &low, &high);
    const double size = vec_length(vec_sub(high, low));
    return isfinite(size) ? fmax(1000, 32 * size) : 1000;
}

/* Of pixels in the middle of the picture. */
static void set_pixel_size(const Render *r)
{
    PixelSize *pixels = r->scene->pixels;
    const double x = r->width / 2.0, y = r->height / 2.0;
    if (!pixels)
        return;
    const Ray ray = camera_ray(&r->scene->camera, r->width, r->height, x, y, NULL),
              next = camera_ray(&r->scene->camera, r->width, r->height, x + 1, y, NULL);
    const int any = camera_ray_exists(&ray) && camera_ray_exists(&next);
    *pixels = (PixelSize){.eye = ray.origin,
                          .angle = any ? vec_length(vec_sub(next.direction, ray.direction)) : 0,
                          .apart = any ? vec_length(vec_sub(next.origin, ray.origin)) : 0};
}

static void set_media(Render *r)
{
    r->context.camera = media_at(r->scene, r->scene->camera.location);
    r->context.reach = media_reach(r);
}

int render_look(Render *r, RetexError *err)
{
    const int code = set_window(r, err);
    if (code)
        return code;
    set_pixel_size(r);
    set_media(r);
    return RETEX_OK;
}

int render_open(Render *r, const Scene *scene, const RenderParams *params, RetexError *err)
{
    *r = (Render){.scene = scene};
    memcpy(&r->params, params, params->size < sizeof r->params ? params->size : sizeof r->params);
    int code = check_params(&r->params, err);
    if (!code)
        code = set_window(r, err);
    if (!code)
        set_pixel_size(r);
    if (!code)
        code = checkpoint_open(&r->store, &r->params, r->w, r->h, err);
    if (!code)
        code = accel_create_within(&r->accel, scene, r->params.nthreads, r->params.budget, err);
    if (!code)
        code = lights_create(&r->lights, scene, r->params.light_share, err);
    int split = !r->params.plain && (scene->ntargets > 0 || scene->nkept > 0);
    r->context = (PathContext){.scene = scene,
                               .accel = r->accel,
                               .lights = r->lights,
                               .max_depth = r->params.max_depth,
                               .split = split,
                               .places = split && !r->params.gaussian,
                               .nvariants = 1,
                               .exposure = (float)exp2(scene->exposure),
                               .has_air = scene->fogs || scene->rainbows,
                               .halves = 1};
    if (!code)
        set_media(r);
    r->variants = r->params.nvariants > 0 ? r->params.variants : NULL;
    for (int k = 0; k < scene->nprimitives; k++)
        r->context.has_no_shadow |= scene->primitives[k].no_shadow;
    return code;
}

int render_open_guide(Render *r, RetexError *err)
{
    r->context.caustic_sources = scene_caustic_sources(r->scene);
    const int guide = r->params.caustics_guide;
    const int small = guide == 0 && photons_small_emitters(r->scene, r->lights);
    if (guide < 0 || (!guide && !small && !r->context.caustic_sources))
        return RETEX_OK;
    const CausticsOf of = guide > 0                    ? CAUSTICS_OF_EMITTERS
                          : r->context.caustic_sources ? CAUSTICS_OF_SOURCES
                                                       : CAUSTICS_OF_SMALL_EMITTERS;
    const PhotonSources sources = {.scene = r->scene, .accel = r->accel, .lights = r->lights,
                                   .paths = (long)r->width * r->height * r->params.spp, .budget = r->params.budget};
    int code = caustics_create(&r->caustics, &sources, of, r->params.nthreads, err);
    r->context.caustics = r->caustics;
    return code;
}

void render_choose_matte(Render *r)
{
    r->context.matte = !r->context.white && !r->caustics && !r->context.caustic_sources && !r->context.has_no_shadow;
}

static int open_worker(Render *r, int k, RetexError *err)
{
    PathWorker *w = &r->workers[k];
    w->context = &r->context;
    w->pixel = r->pixels[k], w->control = r->controls[k];
    w->observe = denoise_guides_observe;
    for (int i = 0; r->pixel_guides && i < PATHS_MAX; i++)
        w->first_hits[i].pixel = pixel_guides_at(r->pixel_guides[k], i);
    w->variants = r->variants;
    if (r->constants) {
        memcpy(w->own, r->variants, (size_t)r->context.nvariants * sizeof *w->own);
        w->own[r->context.nvariants - 1].constants = w->constants;
        w->variants = w->own;
    }
    return path_worker_open(w, err);
}

/* Data for denoising need at least two samples, because the noise of a single sample is unknown. */
static int keeps_denoise_data(const RenderParams *p)
{
    return p->denoise_data && p->spp > 1;
}

FirstHitWindow render_window(const Render *r)
{
    return (FirstHitWindow){r->scene, r->accel, r->width, r->height,          r->x0,
                            r->y0,    r->w,     r->h,     r->params.nthreads, r->variants};
}

Render render_pass(const Render *r)
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
                   .accel = r->accel,
                   .lights = r->lights,
                   .context = r->context};
    pass.params.progress = NULL, pass.params.noise = 0;
    render_drop_files(&pass.params);
    return pass;
}

int render_is_stopped(const Render *r)
{
    return retex_budget_is_stopped(r->params.budget);
}

int render_is_wanted(const Render *r, int band)
{
    return !r->resumed[band];
}

/* Read the bands that earlier renders have finished. The film must have all its images by then. */
static int resume_bands(Render *r, RetexBandStore *store, RetexError *err)
{
    r->resumed = calloc((size_t)r->tiles_y, 1);
    if (!r->resumed)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    int code = store ? film_resume(r->film, err) : RETEX_OK;
    for (int band = 0; band < r->tiles_y; band++)
        r->resumed[band] = (char)film_band_is_done(r->film, band);
    for (int band = 0; band < r->tiles_y; band++)
        r->wanted += render_is_wanted(r, band) ? r->tiles_x : 0;
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
    FirstHitWindow window = render_window(r);
    if (!(r->pixel_guides = calloc((size_t)threads, sizeof *r->pixel_guides)))
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    int code = denoise_guides_create(&r->guides, r->film, &window, r->context.split,
                                     r->quick_guides ? GUIDE_SAMPLES_QUICK : GUIDE_SAMPLES, err);
    for (int k = 0; k < threads && !code; k++)
        code = pixel_guides_create(&r->pixel_guides[k], PATHS_MAX, &r->guides, err);
    return code;
}

int render_open_film(Render *r, int control, int halves, RetexError *err)
{
    int threads = retex_threads(r->params.nthreads);
    FilmParams film = {.width = r->w,
                       .height = r->h,
                       .spp = r->params.spp,
                       .orders = r->params.orders,
                       .strict_paper = r->params.strict_paper,
                       .split = r->context.split,
                       .ntiles = r->tiles_x * r->tiles_y,
                       .layout = render_layout(&r->params),
                       .clusters = r->params.clusters,
                       .sharp = r->params.sharp,
                       .extra = r->params.extra,
                       .broad = r->params.broad,
                       .quadrants = r->context.places && !r->params.no_quadrants,
                       .noise = keeps_denoise_data(&r->params),
                       .nkept = r->context.split ? r->scene->nkept : 0,
                       .stored = r->params.stored};
    for (int t = 0; t < r->scene->ntargets; t++)
        target_periodic(r->scene, t, film.periodic[t]), film.brightness[t] = original_brightness(r->scene, t);
    r->pixels = calloc((size_t)threads, sizeof *r->pixels);
    r->controls = calloc((size_t)threads, sizeof *r->controls);
    r->workers = calloc((size_t)threads, sizeof *r->workers);
    if (!r->pixels || !r->controls || !r->workers)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for %d threads", threads);
    film.store = r->store;
    r->store = NULL;
    int code = film_create(&r->film, r->scene, &film, err);
    for (int k = 0; k < threads && !code; k++)
        code = film_pixel_create(&r->pixels[k], r->film, err);
    if (!code && keeps_denoise_data(&r->params))
        code = open_guides(r, threads, err);
    if (!code)
        code = resume_bands(r, film.store, err);
    if (!code && control)
        code = control_film_create(&r->control, r->w, r->h, r->params.spp, r->context.nvariants, halves, err);
    for (int k = 0; k < threads && !code && r->control; k++)
        code = control_pixel_create(&r->controls[k], r->control, err);
    for (int k = 0; k < threads && !code; k++)
        code = open_worker(r, k, err);
    render_choose_matte(r);
    return code ? code : open_pilots(r, threads, err);
}
