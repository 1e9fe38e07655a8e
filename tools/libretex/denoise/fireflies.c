/* See fireflies.h. */
#include "denoise/fireflies.h"

enum { RADIUS = 5, SUPPORT = 3 /* so many halves must reach a half's brightness, divided by FACTOR */ };
#define FACTOR 2.0f

typedef struct Brightness {
    float of[2][DENOISE_PLANE]; /* by half */
} Brightness;

/* Adds a value to the largest ones, in falling order. */
static void add_largest(float largest[SUPPORT], float value)
{
    for (int k = 0; k < SUPPORT; k++)
        if (value > largest[k]) {
            const float smaller = largest[k];
            largest[k] = value, value = smaller;
        }
}

/* Twice the third largest half around one that is a firefly; else 0. */
static float find_limit(const Brightness *b, int half, const float *kind, const float *valid, int x, int y)
{
    const int x0 = x < RADIUS ? 0 : x - RADIUS, x1 = x + RADIUS < DENOISE_PITCH ? x + RADIUS : DENOISE_PITCH - 1,
              y0 = y < RADIUS ? 0 : y - RADIUS, y1 = y + RADIUS < DENOISE_ROWS ? y + RADIUS : DENOISE_ROWS - 1,
              p = y * DENOISE_PITCH + x;
    const float value = b->of[half][p];
    float largest[SUPPORT] = {0};
    if (!(value > FACTOR * b->of[!half][p]))
        return 0;
    for (int v = y0; v <= y1; v++)
        for (int u = x0; u <= x1; u++) {
            const int q = v * DENOISE_PITCH + u;
            if (q == p || !(valid[q] > 0) || kind[q] != kind[p])
                continue;
            add_largest(largest, b->of[0][q]);
            add_largest(largest, b->of[1][q]);
            if (FACTOR * largest[SUPPORT - 1] >= value)
                return 0;
        }
    return FACTOR * largest[SUPPORT - 1];
}

void retex_denoise_lower_fireflies(float *half[2][3], float *stays[2], const float *kind, const float *valid,
                                   float unknown)
{
    Brightness b;
    for (int h = 0; h < 2; h++)
        for (int i = 0; i < DENOISE_PLANE; i++) {
            b.of[h][i] = half[h][0][i] + half[h][1][i] + half[h][2][i];
            stays[h][i] = 1;
        }
    for (int h = 0; h < 2; h++)
        for (int y = 0; y < DENOISE_ROWS; y++)
            for (int x = 0; x < DENOISE_PITCH; x++) {
                const int p = y * DENOISE_PITCH + x;
                const float limit = valid[p] > 0 ? find_limit(&b, h, kind, valid, x, y) : 0, other = b.of[!h][p];
                if (limit > 0 && (limit > other || other < unknown * b.of[h][p])) {
                    stays[h][p] = limit / b.of[h][p];
                    stays[!h][p] = other > limit ? limit / other : 1;
                }
            }
    for (int h = 0; h < 2; h++)
        for (int c = 0; c < 3; c++)
            for (int i = 0; i < DENOISE_PLANE; i++)
                half[h][c][i] *= stays[h][i];
}
