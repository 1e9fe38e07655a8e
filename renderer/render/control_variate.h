/* Image-space control variates: a new picture from few new samples and an old picture of the same view.
 *
 * Each new path is evaluated with two variants of the scene: the new textures give F1, the textures of the set F0. The
 * set's own picture G is a far better estimate of what F0 estimates. The errors of F0 and F1 in a pixel are correlated,
 * because both come from the same paths. So the error F0 - G is subtracted from F1:
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
    CONTROL_UNBIASED, /* from the neighbours of the pixel, whose samples are independent of its own: unbiased */
    CONTROL_HALVES,   /* for one half of the samples from the other half: unbiased, the first method of the paper; of
                         the set, too, only independent halves are used */
    CONTROL_BIASED    /* from all samples: the second method of the paper */
} ControlMode;

/* Variances and covariances are averaged over a window of this radius in pixels: few samples estimate them poorly, and
 * alpha varies little between neighbours. */
#define CONTROL_RADIUS 2

/* combined: the set with the constants of variant 2, see control_constants.h, or NULL where there is no such variant.
 * With it CONTROL_UNBIASED subtracts two errors, with the two values of alpha that minimize the variance.
 *
 * dst: unallocated, RGB. Variants 0 and 1 of the moments are the replaced and the original textures; with
 * CONTROL_HALVES there are two halves with samples[h] samples each, else one. */
int control_variate(RetexImage *dst, ControlMoments *const *moments, const int *samples, const RetexSet *set,
                    const RetexImage *combined, ControlMode mode, RetexError *err);

/* The distance of F0 from G over the whole picture, in standard deviations. A large distance means that the set is of
 * another scene. */
double control_distance(ControlMoments *const *moments, const int *samples, int nhalves, const RetexSet *set);

/* Add to a set the parts that control variates read: `variance`, of the beauty; with two halves also beauty_a,
 * beauty_b, variance_a and variance_b. */
int control_data_add(RetexSet *set, ControlMoments *const *moments, const int *samples, int nhalves, RetexError *err);

#endif
