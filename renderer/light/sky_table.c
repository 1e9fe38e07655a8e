/* Sampling by inversion: the running sums of luminance are searched, of rows and then of the cells of a row. A guide
 * says in which cell each of its equal steps of the sums begins, which leaves few cells to search (Chen and Asau 1974),
 * and what is read of a row lies close together: the table is larger than a processor's nearer caches. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include "light/sky_table.h"

#define WIDTH SKY_TABLE_WIDTH
#define HEIGHT SKY_TABLE_HEIGHT
#define STEPS 128 /* of a row's guide; a power of two, so that (float)STEPS * u is exact */
#define LINE 64   /* bytes that come from memory together */
#define LINES 2   /* so many of a long part of a row are asked for, besides its last */

/* What paths find of the sky as well need not be sampled by lights: an even part of its luminance is left out (Karlik
 * et al. 2019, MIS Compensation). By the power heuristic half of the mean is best; a sun's share of the mean does not
 * count, as where it does not shine the rest is all the light there is. A tenth is kept of every cell, because paths do
 * not find all: objects without shadow hide sky from them. */
#define LEFT_OUT 0.5f
#define KEPT 0.1f

typedef struct Cell {
    float sum;     /* of the cells before it, as a share of the row's */
    float density; /* per solid angle */
} Cell;

struct SkyTable {
    float mean;
    float marginal[HEIGHT + 1]; /* running sums of the rows, from 0 to 1 */
    uint16_t row_guide[HEIGHT + 1];
    double cosines[HEIGHT + 1]; /* of the polar angles of the rows' edges */
    uint16_t guides[HEIGHT][STEPS + 1];
    Cell cells[HEIGHT][WIDTH + 1];
};

/* ---- searching ---- */

/* Largest k from low on, and below high, with a sum of at most u; low where there is none. */
static inline int find_row(const float *sums, int low, int high, float u)
{
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (sums[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static inline int find_cell(const Cell *cells, int low, int high, float u)
{
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (cells[middle].sum <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void set_guides(SkyTable *t)
{
    for (int k = 0; k <= HEIGHT; k++)
        t->row_guide[k] = (uint16_t)find_row(t->marginal, 0, HEIGHT, (float)k / HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int k = 0; k <= STEPS; k++)
            t->guides[y][k] = (uint16_t)find_cell(t->cells[y], 0, WIDTH, (float)k / STEPS);
}

/* ---- making ---- */

static float share(float sum, float total, int k, int count)
{
    return k == count ? 1 : total > 0 ? sum / total : (float)k / (float)count;
}

static double cell_area(const SkyTable *t, int y)
{
    return (t->cosines[y] - t->cosines[y + 1]) * 2 * PI / WIDTH;
}

/* Over the sphere, of luminances that count as no more than `most`. */
static float mean_luminance(const SkyTable *t, const float *luminances, float most)
{
    double sum = 0;
    for (int y = 0; y < HEIGHT; y++) {
        double row = 0;
        for (int x = 0; x < WIDTH; x++)
            row += fminf(luminances[y * WIDTH + x], most);
        sum += row * cell_area(t, y);
    }
    return (float)(sum / (4 * PI));
}

/* Of luminances, of which some is left out. Returns the sum of the rest. */
static double sum_row(Cell *cells, const float *luminances, float left_out)
{
    double sum = 0;
    for (int x = 0; x < WIDTH; x++) {
        const float rest = fmaxf(luminances[x] - left_out, KEPT * luminances[x]);
        cells[x].sum = (float)sum;
        cells[x].density = rest;
        sum += rest;
    }
    for (int x = 0; x <= WIDTH; x++)
        cells[x].sum = share(cells[x].sum, (float)sum, x, WIDTH);
    return sum;
}

SkyTable *sky_table_create(const float *luminances, int for_mis)
{
    SkyTable *t = malloc(sizeof *t);
    double total = 0;
    if (!t)
        return NULL;
    for (int y = 0; y <= HEIGHT; y++)
        t->cosines[y] = cos(PI * y / HEIGHT);
    t->mean = mean_luminance(t, luminances, INFINITY);
    const float left_out = for_mis ? LEFT_OUT * mean_luminance(t, luminances, t->mean) : 0;
    for (int y = 0; y < HEIGHT; y++) {
        t->marginal[y] = (float)total;
        total += sum_row(t->cells[y], luminances + (size_t)y * WIDTH, left_out) * cell_area(t, y);
    }
    for (int y = 0; y <= HEIGHT; y++)
        t->marginal[y] = share(t->marginal[y], (float)total, y, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            t->cells[y][x].density = (float)(t->cells[y][x].density / total);
    set_guides(t);
    return t;
}

void sky_table_close(SkyTable **table)
{
    free(*table);
    *table = NULL;
}

float sky_table_mean(const SkyTable *t)
{
    return t->mean;
}

/* ---- sampling ---- */

static inline int row_of(const SkyTable *t, float u2)
{
    const uint16_t *guide = t->row_guide + (int)(u2 * HEIGHT);
    return find_row(t->marginal, guide[0], guide[1] + 1, u2);
}

void sky_table_prefetch(const SkyTable *t, const float *u1, const float *u2, int count)
{
    const uint16_t *columns[SKY_TABLE_PREFETCH];
    for (int i = 0; i < count; i++) {
        const int y = row_of(t, u2[i]);
        columns[i] = t->guides[y] + (int)(u1[i] * STEPS);
        __builtin_prefetch(columns[i]);
    }
    for (int i = 0; i < count; i++) {
        const Cell *row = t->cells[(columns[i] - t->guides[0]) / (STEPS + 1)];
        const char *first = (const char *)&row[columns[i][0]], *last = (const char *)&row[columns[i][1] + 1];
        for (int k = 0; k < LINES && first < last; k++, first += LINE)
            __builtin_prefetch(first);
        __builtin_prefetch(last);
    }
}

Vec3 sky_table_sample(const SkyTable *t, float u1, float u2, float *pdf)
{
    const int y = row_of(t, u2);
    const uint16_t *columns = t->guides[y] + (int)(u1 * STEPS);
    const int x = find_cell(t->cells[y], columns[0], columns[1] + 1, u1);
    const Cell *cell = &t->cells[y][x];
    const float width = cell[1].sum - cell->sum, height = t->marginal[y + 1] - t->marginal[y];
    const double fx = width > 0 ? (u1 - cell->sum) / width : 0.5,
                 fy = height > 0 ? (u2 - t->marginal[y]) / height : 0.5;
    /* uniform in solid angle within the cell: cos(theta) is linear */
    const double c = t->cosines[y] + (t->cosines[y + 1] - t->cosines[y]) * fy;
    const double phi = 2 * PI * (x + fx) / WIDTH, s = sqrt(fmax(0, 1 - c * c));
    *pdf = cell->density;
    return vec3(s * cos(phi), c, s * sin(phi));
}

float sky_table_pdf(const SkyTable *t, Vec3 direction)
{
    double phi = atan2(direction.z, direction.x);
    if (phi < 0)
        phi += 2 * PI;
    int x = (int)(phi / (2 * PI) * WIDTH), y = (int)(acos(fmax(-1, fmin(1, direction.y))) / PI * HEIGHT);
    if (x >= WIDTH)
        x = WIDTH - 1;
    if (y >= HEIGHT)
        y = HEIGHT - 1;
    return t->cells[y][x].density;
}
