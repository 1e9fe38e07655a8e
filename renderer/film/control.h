/* Several pictures along the same paths: of the same scene with different textures, and how the pictures vary together.
 * They are kept beside the film, which knows variant 0 only. Nothing that is chosen along a path depends on a texture,
 * so that as a sink of contributions the control film needs a throughput for each variant, and no paths. */
#ifndef RENDERER_FILM_CONTROL_H
#define RENDERER_FILM_CONTROL_H

#include <retex/image.h>
#include "film/contribution.h"
#include "scene/variant.h"

#define CONTROL_VARIANTS_MAX 3 /* of which moments can be kept */
#define CONTROL_PAIRS_MAX (CONTROL_VARIANTS_MAX * (CONTROL_VARIANTS_MAX + 1) / 2)

typedef struct ControlFilm ControlFilm;
/* One thread's sums of the current pixel. */
typedef struct ControlPixel ControlPixel;

/* Estimates from one half of the samples, or from all of them. RGB images of the film's size, by channel. */
typedef struct ControlMoments {
    RetexImage mean[CONTROL_VARIANTS_MAX];
    RetexImage covariance[CONTROL_PAIRS_MAX]; /* of the means, see control_pair; 0 where there is one sample only */
} ControlMoments;

/* Index of the pair of variants a and b. */
static inline int control_pair(int a, int b) { return a < b ? b * (b + 1) / 2 + a : a * (a + 1) / 2 + b; }

/* nhalves: 0 keeps no moments, 1 those of all samples, 2 those of each half apart. */
int control_film_create(ControlFilm **film, int width, int height, int spp, int nvariants, int nhalves,
                        RetexError *err);
void control_film_close(ControlFilm **film); /* NULL and pointers to NULL are fine */
int control_pixel_create(ControlPixel **pixel, ControlFilm *film, RetexError *err);
void control_pixel_close(ControlPixel **pixel);

void control_pixel_end(ControlPixel *pixel, int x, int y); /* store and reset */

/* What a path has in each variant. */
typedef struct ControlPath {
    Rgb betas[VARIANTS_MAX];       /* throughput; not of the first variant: that is the path's own */
    double light[VARIANTS_MAX][3]; /* sum of its contributions */
} ControlPath;

static inline void control_start(ControlPath *path, int nvariants)
{
    for (int v = 0; v < nvariants; v++) {
        path->betas[v] = rgb_grey(1);
        path->light[v][0] = path->light[v][1] = path->light[v][2] = 0;
    }
}
/* light: the contribution with all factors, of the first variant. */
void control_add(ControlPixel *pixel, ControlPath *path, const Contribution *contribution, Float4 light);
void control_end(ControlPixel *pixel, const ControlPath *path, int half);

/* Borrowed, until the film closes. Pictures are means over all samples. */
RetexImage *control_film_picture(ControlFilm *film, int variant);
ControlMoments *control_film_moments(ControlFilm *film, int half);
long control_film_dropped(const ControlFilm *film); /* not finite, in pictures after the first */

#endif
