/* A large picture with detail at every scale, as of a camera: fallen leaves on stones and moss. Made from whole fields
 * rather than point by point, for it has many points. */
#include <math.h>
#include <stdlib.h>
#include <retex/image.h>
#include "generate.h"

/* Twice the side: each point from its four old neighbours, weights 9 3 3 1, then half the old roughness added. */
static void refine(const float *old, float *out, int side, float roughness, int seed)
{
    int twice = 2 * side;
    for (int y = 0; y < twice; y++) {
        int y0 = y / 2, y1 = (y0 + (y % 2 ? 1 : side - 1)) % side;
        for (int x = 0; x < twice; x++) {
            int x0 = x / 2, x1 = (x0 + (x % 2 ? 1 : side - 1)) % side;
            float mean =
                (9 * old[y0 * side + x0] + 3 * (old[y0 * side + x1] + old[y1 * side + x0]) + old[y1 * side + x1]) / 16;
            out[(size_t)y * (size_t)twice + (size_t)x] = mean + roughness * (float)(hash(x, y, seed) - 0.5);
        }
    }
}

/* A periodic field of the given side, about -1..1, whose amplitudes fall with frequency as in photographs: by 0.5 an
 * octave for keep = 0.5. */
static float *field(int side, float keep, int seed)
{
    float *a = malloc(sizeof(float) * (size_t)side * (size_t)side);
    float *b = malloc(sizeof(float) * (size_t)side * (size_t)side);
    if (!a || !b) {
        free(a);
        free(b);
        return NULL;
    }
    float roughness = 1.6f;
    for (int k = 0; k < 16; k++)
        a[k] = roughness * (float)(hash(k % 4, k / 4, seed) - 0.5);
    for (int size = 4; size < side; size *= 2) {
        roughness *= keep;
        refine(a, b, size, roughness, seed + size);
        float *t = a;
        a = b;
        b = t;
    }
    free(b);
    return a;
}

/* The two nearest of one jittered point a cell; only the nine cells about are looked at. */
typedef struct Stones {
    int count;
    float *points; /* x, y of count * count cells */
} Stones;

static void nearest_stone(const Stones *stones, float x, float y, float *nearest, float *second, int *which)
{
    int n = stones->count, ix = (int)floorf(x), iy = (int)floorf(y);
    *nearest = *second = 99;
    *which = 0;
    for (int j = iy - 1; j <= iy + 1; j++)
        for (int i = ix - 1; i <= ix + 1; i++) {
            int cell = (j + n) % n * n + (i + n) % n;
            float dx = (float)i + stones->points[2 * cell] - x, dy = (float)j + stones->points[2 * cell + 1] - y;
            float d = dx * dx + dy * dy;
            if (d < *nearest) {
                *second = *nearest;
                *nearest = d;
                *which = cell;
            } else if (d < *second) {
                *second = d;
            }
        }
    *nearest = sqrtf(*nearest);
    *second = sqrtf(*second);
}

static void put(RetexImage *image, int x, int y, Color color, float cover)
{
    float *out = image->pixels + retex_image_index(image, x & (image->width - 1), y & (image->height - 1));
    out[0] += (fminf(fmaxf((float)color.r, 0), 1) - out[0]) * cover;
    out[1] += (fminf(fmaxf((float)color.g, 0), 1) - out[1]) * cover;
    out[2] += (fminf(fmaxf((float)color.b, 0), 1) - out[2]) * cover;
}

static void lay_ground(RetexImage *image, const Stones *stones, const float *rough, const float *fine)
{
    static const unsigned shades[] = {0xa9a49a, 0x8b857c, 0xb59c7f, 0x77777b, 0x9c6f55, 0xc9c2b4, 0x5f6468};
    Color colors[7], moss = color_hex(0x4f6b2a), soil = color_hex(0x2e2318), pale = color_hex(0xd9d2bd);
    for (int k = 0; k < 7; k++)
        colors[k] = color_hex(shades[k]);
    int side = image->width;
    float unit = (float)stones->count / (float)side;
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++) {
            size_t at = (size_t)y * (size_t)side + (size_t)x;
            float r = rough[at], f = fine[at], nearest, second;
            int cell;
            nearest_stone(stones, (float)x * unit + 0.35f * r, (float)y * unit + 0.35f * f, &nearest, &second, &cell);
            Color stone = colors[(int)(7 * hash(cell, 1, 800))];
            double light = (0.7 + 0.5 * hash(cell, 2, 800)) * (1.08 - 0.55 * nearest) * (1 + 0.55 * f);
            /* Lit from the upper left: the field's slope stands for the surface's. */
            size_t before = (size_t)((y + side - 1) % side) * (size_t)side + (size_t)((x + side - 1) % side);
            light *= 1 + 2.2 * (rough[at] - rough[before]) + 1.2 * (fine[at] - fine[before]);
            stone = color_mix(color_scale(stone, light), pale, 0.5 * step_smooth(0.35, 0.6, f * 0.8 + r * 0.3));
            double gap = step_smooth(0.16, 0.04, second - nearest + 0.10 * f);
            Color between =
                color_mix(color_scale(soil, 1 + 0.8 * f), color_scale(moss, 1 + 1.1 * f), step_smooth(-0.1, 0.3, r));
            Color color = color_mix(stone, between, gap);
            color = color_mix(color, color_scale(moss, 0.9 + 1.2 * f), 0.8 * step_smooth(0.30, 0.5, r + 0.25 * f));
            put(image, x, y, color, 1);
        }
}

/* One leaf: a pointed oval with ribs, and its shadow first. */
static void lay_leaf(RetexImage *image, const float *fine, int number)
{
    static const unsigned shades[] = {0xc8862b, 0xa8452a, 0xd9b04a, 0x7a4a26, 0x8f9a3c, 0xb5672e};
    int side = image->width;
    double length = side * (0.018 + 0.030 * hash(number, 1, 810)),
           width = length * (0.40 + 0.25 * hash(number, 2, 810));
    double turn = 6.283185307179586 * hash(number, 3, 810), c = cos(turn), s = sin(turn);
    int cx = (int)(side * hash(number, 4, 810)), cy = (int)(side * hash(number, 5, 810)),
        reach = (int)(length * 0.62) + 8;
    Color color = color_mix(color_hex(shades[(int)(6 * hash(number, 6, 810))]),
                            color_hex(shades[(int)(6 * hash(number, 7, 810))]), hash(number, 8, 810));
    int drop = 3 + side / 512;
    for (int pass = 0; pass < 2; pass++)
        for (int j = -reach; j <= reach; j++)
            for (int i = -reach; i <= reach; i++) {
                double along = (i * c + j * s) / length + 0.5, across = -i * s + j * c;
                across += length * 0.06 * sin(along * 5 + number);
                if (along <= 0 || along >= 1)
                    continue;
                double half = width / 2 * pow(sin(3.141592653589793 * pow(along, 0.8)), 0.85);
                double teeth = half * (1 - 0.07 * wrap(along * 14, 1));
                double edge = teeth - fabs(across);
                if (edge < -1)
                    continue;
                if (!pass) {
                    put(image, cx + i + drop, cy + j + drop, (Color){0.012, 0.010, 0.008}, 0.55f);
                    continue;
                }
                int x = (cx + i) & (side - 1), y = (cy + j) & (side - 1);
                double f = fine[(size_t)y * (size_t)side + (size_t)x];
                double rib = fabs(wrap(along * 9 - fabs(across) / width * 3, 1) - 0.5);
                double vein = fmax(step_smooth(2.2, 0.8, fabs(across)), 0.6 * step_smooth(0.06, 0.02, rib));
                Color here = color_scale(color, (1 + 0.7 * f) * (1.1 - 0.25 * across / width) * (0.85 + 0.3 * along));
                here = color_mix(here, color_scale(color, 1.6), 0.6 * vein);
                here = color_mix(here, color_hex(0x3a2413), 0.7 * step_smooth(0.35, 0.55, f + 0.3 * along));
                put(image, x, y, here, (float)clamp01(edge + 0.5));
            }
}

int photo(RetexImage *image)
{
    enum { STONES = 36, LEAVES = 700 };
    float *rough = field(image->width, 0.60f, 780), *fine = field(image->width, 0.72f, 790);
    Stones stones = {STONES, malloc(sizeof(float) * 2 * STONES * STONES)};
    int failed = !rough || !fine || !stones.points;
    if (!failed) {
        for (int k = 0; k < STONES * STONES; k++) {
            stones.points[2 * k] = (float)(0.15 + 0.7 * hash(k, 3, 800));
            stones.points[2 * k + 1] = (float)(0.15 + 0.7 * hash(k, 4, 800));
        }
        lay_ground(image, &stones, rough, fine);
        for (int k = 0; k < LEAVES; k++)
            lay_leaf(image, fine, k);
    }
    free(rough);
    free(fine);
    free(stones.points);
    return failed;
}
