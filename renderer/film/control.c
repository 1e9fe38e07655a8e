/* See control.h. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include "film/control.h"

struct ControlFilm {
    int width, height, spp, nvariants, nhalves;
    RetexImage pictures[VARIANTS_MAX];
    ControlMoments moments[2];
    atomic_long dropped;
};

struct ControlPixel {
    ControlFilm *film;
    double picture[VARIANTS_MAX][3];
    /* by half */
    double sum[2][CONTROL_VARIANTS_MAX][3], product[2][CONTROL_PAIRS_MAX][3];
    int samples[2];
    long dropped;
};

int control_film_create(ControlFilm **out, int width, int height, int spp, int nvariants, int nhalves, RetexError *err)
{
    ControlFilm *film = calloc(1, sizeof *film);
    *out = film;
    if (!film)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    film->width = width, film->height = height, film->spp = spp, film->nvariants = nvariants, film->nhalves = nhalves;
    int code = RETEX_OK;
    for (int v = 0; v < nvariants && !code; v++)
        code = retex_image_alloc(&film->pictures[v], width, height, 3, err);
    for (int half = 0; half < nhalves; half++) {
        for (int v = 0; v < nvariants && !code; v++)
            code = retex_image_alloc(&film->moments[half].mean[v], width, height, 3, err);
        for (int k = 0; k < control_pair(0, nvariants) && !code; k++)
            code = retex_image_alloc(&film->moments[half].covariance[k], width, height, 3, err);
    }
    if (code)
        control_film_close(out);
    return code;
}

void control_film_close(ControlFilm **film)
{
    if (!film || !*film)
        return;
    for (int v = 0; v < VARIANTS_MAX; v++)
        retex_image_free(&(*film)->pictures[v]);
    for (int half = 0; half < 2; half++) {
        for (int v = 0; v < CONTROL_VARIANTS_MAX; v++)
            retex_image_free(&(*film)->moments[half].mean[v]);
        for (int k = 0; k < CONTROL_PAIRS_MAX; k++)
            retex_image_free(&(*film)->moments[half].covariance[k]);
    }
    free(*film);
    *film = NULL;
}

int control_pixel_create(ControlPixel **pixel, ControlFilm *film, RetexError *err)
{
    *pixel = calloc(1, sizeof **pixel);
    if (!*pixel)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for a thread's pixel");
    (*pixel)->film = film;
    return RETEX_OK;
}

void control_pixel_close(ControlPixel **pixel)
{
    if (!*pixel)
        return;
    atomic_fetch_add(&(*pixel)->film->dropped, (*pixel)->dropped);
    free(*pixel);
    *pixel = NULL;
}

void control_add(ControlPixel *p, ControlPath *path, const Contribution *c, Float4 light)
{
    for (int v = 0; v < p->film->nvariants; v++) {
        Rgb l = rgb_of4(light);
        if (v > 0) {
            l = rgb_mul(path->betas[v], c->variants ? c->variants[v] : c->light);
            for (int k = 0; k < c->nfactors; k++)
                l = rgb_of4(color4(l) * factor_of_variant(&c->factors[k], v));
        }
        if (!isfinite(l.r + l.g + l.b)) {
            p->dropped += v > 0;
            continue;
        }
        path->light[v][0] += l.r, path->light[v][1] += l.g, path->light[v][2] += l.b;
    }
}

/* The contributions of a path are summed before they are added to pictures, as in the film: the same rounding. */
void control_end(ControlPixel *p, const ControlPath *path, int half)
{
    const int n = p->film->nvariants;
    p->samples[half]++;
    for (int c = 0; c < 3; c++)
        for (int b = 0; b < n; b++) {
            p->picture[b][c] += path->light[b][c];
            if (!p->film->nhalves)
                continue;
            p->sum[half][b][c] += path->light[b][c];
            for (int a = 0; a <= b; a++)
                p->product[half][control_pair(a, b)][c] += path->light[a][c] * path->light[b][c];
        }
}

static void store_moments(ControlPixel *p, int half, size_t at)
{
    ControlMoments *m = &p->film->moments[half];
    double samples = p->samples[half] > 0 ? p->samples[half] : 1;
    for (int c = 0; c < 3; c++)
        for (int b = 0; b < p->film->nvariants; b++) {
            const double *sum = &p->sum[half][0][0];
            m->mean[b].pixels[at + (size_t)c] = (float)(sum[3 * b + c] / samples);
            for (int a = 0; a <= b; a++) {
                int k = control_pair(a, b);
                double centred = p->product[half][k][c] - sum[3 * a + c] * sum[3 * b + c] / samples;
                m->covariance[k].pixels[at + (size_t)c] =
                    samples > 1 ? (float)(centred / (samples * (samples - 1))) : 0;
            }
        }
}

void control_pixel_end(ControlPixel *p, int x, int y)
{
    ControlFilm *film = p->film;
    size_t at = retex_image_index(&film->pictures[0], x, y);
    for (int v = 0; v < film->nvariants; v++)
        for (size_t c = 0; c < 3; c++)
            film->pictures[v].pixels[at + c] = (float)(p->picture[v][c] / film->spp);
    for (int half = 0; half < film->nhalves; half++)
        store_moments(p, half, at);
    long dropped = p->dropped;
    *p = (ControlPixel){.film = film, .dropped = dropped};
}

RetexImage *control_film_picture(ControlFilm *film, int variant)
{
    return &film->pictures[variant];
}

ControlMoments *control_film_moments(ControlFilm *film, int half)
{
    return &film->moments[half];
}

long control_film_dropped(const ControlFilm *film)
{
    return film->dropped;
}
