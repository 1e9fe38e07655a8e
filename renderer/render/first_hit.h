/* Pictures of what the pixel centres see first: AOVs, and which targets and identifiers cover how much. */
#ifndef RENDERER_RENDER_FIRST_HIT_H
#define RENDERER_RENDER_FIRST_HIT_H

#include "accel/accel.h"
#include "render/render.h"

typedef struct FirstHitWindow {
    const Scene *scene;
    const Accel *accel;
    int width, height;          /* of the whole picture */
    int x0, y0, w, h;           /* the part of it */
    int nthreads;
    const RenderVariant *variants; /* or NULL: the first one's colours are shown */
} FirstHitWindow;

/* Add a part for an AOV. */
int first_hit_add_aov(RetexSet *set, RetexAov aov, int *part, RetexError *err);
/* Add and fill a part for each of these AOVs, of the first hit alone: all but irradiance. */
int first_hit_aovs(RetexSet *set, const FirstHitWindow *window, unsigned aovs, RetexError *err);
/* Fill share, and periodic of all targets. */
int first_hit_targets(RetexSet *set, const FirstHitWindow *window, RetexError *err);
/* Whether a target is periodic in u, v: all of its primitives are, by their own parametrisation. */
void target_periodic(const Scene *scene, int target, int periodic[2]);
int first_hit_idents(const FirstHitWindow *window, double *shares, RetexError *err);

#endif
