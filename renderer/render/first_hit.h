/* The first hits of camera rays through pixel centres: AOVs, and the share of the picture that each target and
 * identifier covers. */
#ifndef RENDERER_RENDER_FIRST_HIT_H
#define RENDERER_RENDER_FIRST_HIT_H

#include <retex/host/aov.h>
#include "accel/accel.h"
#include "faces/shown.h"
#include "path/shading.h"

typedef struct FirstHitWindow {
    const Scene *scene;
    const Accel *accel;
    int width, height;          /* of the whole picture */
    int x0, y0, w, h;           /* the part of it */
    int nthreads;
    const RenderVariant *variants; /* whose first one replaces textures; or NULL */
} FirstHitWindow;

/* Add a part for an AOV. */
int first_hit_add_aov(RetexSet *set, RetexAov aov, int *part, RetexError *err);
/* The value of an AOV at a first hit, of one leaf of its texture: up to three channels. Not of irradiance. */
void first_hit_value(RetexAov aov, float value[3], const Hit *hit, const SeenLeaf *leaf);
/* Those that are averaged over the pixel's samples: mean_aovs.h adds them. */
#define AOVS_AVERAGED (RETEX_AOV_BIT(ALBEDO_MEAN) | RETEX_AOV_BIT(NORMAL_MEAN))
/* Add and fill a part for each of these AOVs, of the ray through the centre: all but irradiance and averaged ones. */
int first_hit_aovs(RetexSet *set, const FirstHitWindow *window, unsigned aovs, RetexError *err);
/* Fill in `share` and `periodic` of all targets. */
int first_hit_targets(RetexSet *set, const FirstHitWindow *window, RetexError *err);
/* Whether a target is periodic in u and in v: it is if all of its primitives are. */
void target_periodic(const Scene *scene, int target, int periodic[2]);
/* The ray through a pixel's centre, and what it meets; 0: nothing. */
int first_hit_ray(const FirstHitWindow *window, int x, int y, Ray *ray, Hit *hit);
/* What a pixel of the picture shows; 0: nothing. */
int first_hit_shown(const FirstHitWindow *window, int x, int y, ShownSurface *shown);
/* Which object a surface is of, and which of its textures if not all are blended on it. */
ShownSurface first_hit_of(const Scene *scene, const Surface *surface);
/* shares[t]: the share of pixels whose first hit is target t. */
int first_hit_target_shares(const FirstHitWindow *window, double *shares, RetexError *err);
/* shares[i]: the share of pixels whose first hit has identifier i. */
int first_hit_idents(const FirstHitWindow *window, double *shares, RetexError *err);

#endif
