/* Rendering a scene into a set: the renderer's public call. */
#ifndef RENDERER_RENDER_RENDER_H
#define RENDERER_RENDER_RENDER_H

#include <stdio.h>
#include "faces/shown.h"
#include "render/control_variate.h"
#include "render/params.h"

/* Bytes that the film and the AOVs of a render of width by height pixels take at least, all together. */
double render_bytes(const Scene *scene, const RenderParams *params, int width, int height);

/* Render into a new set. With plain, or without targets, the set has the beauty and the AOVs only. The picture is the
 * same to the bit for every nthreads. */
int render_scene(RetexSet **set, const Scene *scene, const RenderParams *params, RenderStats *stats, RetexError *err);


/* Render nvariants pictures, pictures[k] (unallocated) with the textures of variants[k], all along the same paths:
 * each is to the bit what render_scene gives for that variant alone with `plain`. */
int render_variants(RetexImage *pictures, const Scene *scene, const RenderParams *params, RenderStats *stats,
                    RetexError *err);

/* The picture with the textures of params' first variant, from new samples and the beauty of a set of the same view
 * with its original textures, see control_variate.h. *distance (may be NULL): how unlike the set what was found of the
 * originals is, in standard deviations. */
int render_control(RetexImage *picture, const Scene *scene, const RenderParams *params, RetexSet *set, ControlMode mode,
                   double *distance, RenderStats *stats, RetexError *err);

/* Whether the picture has a size that can be, and its crop lies inside it. */
int render_check_window(const Scene *scene, const RenderParams *params, RetexError *err);
/* Share of the picture (0..1) that each of scene->idents covers at the centres of pixels; shares has scene->nidents. */
int render_ident_shares(const Scene *scene, const RenderParams *params, double *shares, RetexError *err);
/* The same of its targets. */
int render_target_shares(const Scene *scene, const RenderParams *params, double shares[RETEX_MAX_TARGETS],
                         RetexError *err);

/* What each of these pixels shows at its centre. x and y as in the picture. */
int render_pick(const Scene *scene, const RenderParams *params, int count, const int (*pixels)[2], ShownSurface *shown,
                RetexError *err);

/* Scene units that a unit of u and of v spans on each target; see uv_scale.h. */
int render_uv_scales(const Scene *scene, int nthreads, double scales[][2], RetexError *err);

/* Print what happens along one path, step by step with values. x, y and sample as in the picture. */
int render_trace(const Scene *scene, const RenderParams *params, int x, int y, int sample, FILE *out, RetexError *err);

#endif
