/* Denoising: its inner loops against plain code, and what it takes beside rendering. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench.h"
#include "render/render.h"
#include "lib_denoise_kernel.h"
#include "sdl/lang/parser.h"
#include "sdl/statements.h"

typedef struct Kernels {
    Room *room;
    Sums *sums;
    RetexDenoiseSignal signal;
    RetexDenoiseImages images;
    RetexDenoiseBatch batch;
} Kernels;

static void features(void *context)
{
    Kernels *k = context;
    retex_denoise_features_kernel(k->room->alike, &k->room->features, 3, -2, 0);
}

static void features_scalar(void *context)
{
    Kernels *k = context;
    retex_denoise_features_kernel(k->room->alike, &k->room->features, 3, -2, 1);
}

static void filter_signal(void *context)
{
    Kernels *k = context;
    retex_denoise_signal_kernel(&k->signal, &k->batch, 0);
}

static void signal_scalar(void *context)
{
    Kernels *k = context;
    retex_denoise_signal_kernel(&k->signal, &k->batch, 1);
}

static void filter_images_with(Kernels *k, int scalar)
{
    const float *weights[DENOISE_BATCH];
    for (int n = 0; n < DENOISE_BATCH; n++)
        weights[n] = k->room->alike[n].strict;
    retex_denoise_images_kernel(&k->images, k->batch.of, weights, DENOISE_BATCH, scalar);
}

static void filter_images(void *context)
{
    filter_images_with(context, 0);
}

static void images_scalar(void *context)
{
    filter_images_with(context, 1);
}

static void bench_denoise_kernels(void)
{
    Kernels k = {.room = open_room(1), .sums = calloc(1, sizeof *k.sums)};
    k.signal = signal_of(k.room, k.sums);
    k.images = images_of(k.room, k.sums);
    k.batch = (RetexDenoiseBatch){.count = DENOISE_BATCH};
    for (int n = 0; n < DENOISE_BATCH; n++) {
        k.batch.of[n] = (RetexDenoiseDisplacement){n - 1, 2};
        retex_denoise_features_kernel(k.room->alike + n, &k.room->features, n - 1, 2, 1);
        k.batch.alike[n] = k.room->alike + n;
    }
    bench_section("Denoising: times as fast as the scalar reference");
    bench_pair("features of a tile at one displacement", features, features_scalar, &k);
    bench_pair("a signal at a batch of displacements", filter_signal, signal_scalar, &k);
    bench_pair("two images at a batch of displacements", filter_images, images_scalar, &k);
    free(k.room);
    free(k.sums);
}

/* ---- a whole set ---- */

typedef struct Work {
    Scene *scene;
    RenderParams params;
} Work;

static RetexSet *render_once(const Work *w)
{
    RenderStats stats;
    RetexSet *set;
    RetexError err = {0};
    test_must(render_scene(&set, w->scene, &w->params, &stats, &err), &err);
    return set;
}

static void render(void *context)
{
    RetexSet *set = render_once(context);
    retex_set_close(&set);
}

static void render_denoised(void *context)
{
    RetexSet *set = render_once(context);
    RetexError err = {0};
    test_must(retex_denoise(set, NULL, NULL, 1, &err), &err);
    retex_set_close(&set);
}

static void bench_set(const char *scenes, const char *name, int spp)
{
    static const char *const targets[] = {"Floor"};
    Work w = {.params = RENDER_PARAMS_INIT};
    RetexError err = {0};
    char text[96], path[512];
    snprintf(path, sizeof path, "%s/%s/%s.pov", scenes, name, name);
    test_must(sdl_read(&w.scene, path, NULL, &scene_builder, &err), &err);
    test_must(scene_resolve_targets(w.scene, targets, 1, &err), &err);
    w.params.width = 128, w.params.height = 96, w.params.spp = spp;
    w.params.nthreads = w.params.denoise_data = 1;
    snprintf(text, sizeof text, "%s, 128x96, %d samples a pixel", name, spp);
    bench_pair(text, render, render_denoised, &w);
    scene_close(&w.scene);
}

void bench_denoise(const char *scenes)
{
    bench_denoise_kernels();
    bench_section("Rendering and denoising a set: times as long as rendering it");
    bench_set(scenes, "cornell-box", 16);
    bench_set(scenes, "cornell-box", 64);
    bench_set(scenes, "glass-caustics", 16);
}
