/* Axes of parallelograms as steps of mean UV from pixel to pixel, which is how packs and rooms for browsers store them.
 * Private to libretex; described in retex-pack(5). */
#ifndef RETEX_SET_STEPS_H
#define RETEX_SET_STEPS_H

#include <math.h>
#include <retex/image.h>

/* Steps are taken within strips of so many rows. */
#define RETEX_STEPS_ROWS 64
/* How far the axes of a pixel may be from the steps, of its size along u or v, to be chosen to be stored as steps; and
 * to be stored so: axes may have been rounded in between. */
#define RETEX_STEPS_TOLERANCE 0.05
#define RETEX_STEPS_TOLERANCE_STORED 0.06

/* A row or a column: UV of the two pixels before, of the pixel, and of two after, where these have them. */
typedef struct RetexStep {
    double uv[5];
    int has[5];
} RetexStep;

/* The derivative at the pixel, of second order where there are pixels enough: half the difference of what is before and
 * after or, with one of them only, by the two on its side. 0 without any. Differences on a periodic axis are taken the
 * shorter way round. */
static inline double retex_step(const RetexStep *s, int periodic)
{
    double d[4];
    for (int k = 0; k < 4; k++) {
        d[k] = s->has[k] && s->has[k + 1] ? s->uv[k + 1] - s->uv[k] : 0;
        d[k] -= periodic ? rint(d[k]) : 0;
    }
    if (s->has[1] && s->has[3])
        return 0.5 * (d[1] + d[2]);
    return s->has[1] ? (s->has[0] ? 1.5 * d[1] - 0.5 * d[0] : d[1]) : s->has[4] ? 1.5 * d[2] - 0.5 * d[3] : d[2];
}

/* The steps at a pixel that has the footprint: those of u and v to the right, those down. uv: u, v and coverage. */
static inline void retex_steps_at(double steps[4], const RetexImage *uv, int x, int y, const int periodic[2])
{
    const int first = y - y % RETEX_STEPS_ROWS;
    const int end = first + RETEX_STEPS_ROWS < uv->height ? first + RETEX_STEPS_ROWS : uv->height;
    for (int k = 0; k < 4; k++) {
        RetexStep step = {{0}, {0}};
        for (int i = 0; i < 5; i++) {
            const int px = k < 2 ? x + i - 2 : x, py = k < 2 ? y : y + i - 2;
            const float *pixel = px >= 0 && px < uv->width && py >= first && py < end
                                     ? uv->pixels + retex_image_index(uv, px, py)
                                     : NULL;
            step.has[i] = pixel && pixel[2] > 0;
            step.uv[i] = step.has[i] ? (double)pixel[k % 2] : 0;
        }
        steps[k] = retex_step(&step, periodic[k % 2]);
    }
}

/* Whether the steps of a pixel stand for its axes. */
static inline int retex_steps_fit(const double steps[4], const float axes[4], double tolerance)
{
    int fit = 1;
    for (int a = 0; a < 2; a++) {
        const double right = (double)axes[a], down = (double)axes[2 + a];
        fit = fit && hypot(steps[a] - right, steps[2 + a] - down) <= tolerance * hypot(right, down);
    }
    return fit;
}

#endif
