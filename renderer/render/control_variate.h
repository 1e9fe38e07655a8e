/* Image-space control variates: a new picture from few new samples and an old picture of the same view.
 *
 * Along each new path the scene is evaluated as it is wanted, F1, and as it was in the set, F0. Of F0 the set knows a
 * far better estimate G, and the error of F0 in a pixel tells most of the error of F1 there:
 *
 *     I = F1 - alpha (F0 - G),    alpha = cov(F1, F0) / (var(F0) + var(G))
 *
 * Source: Rousselle, Jarosz, Novak, 'Image-space control variates for rendering', SIGGRAPH Asia 2016. */
#ifndef RENDERER_RENDER_CONTROL_VARIATE_H
#define RENDERER_RENDER_CONTROL_VARIATE_H

#include <retex/set.h>
#include "film/control.h"

/* How alpha is found. */
typedef enum ControlMode {
    CONTROL_UNBIASED, /* from the pixels around: their samples are independent of its own, and so are the set's, so that
                         it is right on average */
    CONTROL_HALVES,   /* of one half of the samples from the other, which is independent: right on average, as the paper
                         has it; of what the set stores only independent halves are used */
    CONTROL_BIASED    /* from all samples, the paper's other way */
} ControlMode;

/* Variances and covariances are means over a window of so many pixels to each side: alpha varies little from pixel to
 * pixel, and a few samples say little of it. */
#define CONTROL_RADIUS 2

/* combined: the set with the constants of variant 2, see control_constants.h, or NULL where there is no such variant.
 * With it CONTROL_UNBIASED takes off both differences: the two alphas together leave the least variance.
 *
 * dst: unallocated, RGB. Variants 0 and 1 of the moments are the replaced and the original textures; with
 * CONTROL_HALVES there are two halves with samples[h] samples each, else one. */
int control_variate(RetexImage *dst, ControlMoments *const *moments, const int *samples, const RetexSet *set,
                    const RetexImage *combined, ControlMode mode, RetexError *err);

/* How far F0 as a whole lies from G, in standard deviations: what differs much is not the same scene. */
double control_distance(ControlMoments *const *moments, const int *samples, int nhalves, const RetexSet *set);

/* Add to a set what control variates read: `variance`, of the beauty; and with two halves also beauty_a, beauty_b,
 * variance_a and variance_b. */
int control_data_add(RetexSet *set, ControlMoments *const *moments, const int *samples, int nhalves, RetexError *err);

#endif
