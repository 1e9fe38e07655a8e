/* The sky as a light: its radiance, and a table over the sphere for sampling directions by luminance. */
#include <stdlib.h>
#include "light/lights.h"
#include "shade/pigment.h"

#define TABLE_WIDTH 1024 /* over longitude; the height is half of it, over the polar angle */
#define TABLE_HEIGHT 512

struct Environment {
    float mean;
    float conditional[TABLE_HEIGHT][TABLE_WIDTH + 1]; /* running sums of a row, from 0 to 1 */
    float marginal[TABLE_HEIGHT + 1];
    float density[TABLE_HEIGHT][TABLE_WIDTH]; /* per solid angle */
};

Rgb sky_radiance(const Scene *scene, Vec3 direction)
{
    Rgb sum = scene->background;
    if (!scene->sky)
        return sum;
    for (int k = 0; k < scene->sky->npigments; k++) {
        Rgbft c = pigment_eval(scene->sky->pigments[k], direction, (Vec2){0, 0});
        float opaque = fmaxf(0, 1 - c.filter - c.transmit);
        Rgb color = rgb(c.r, c.g, c.b), through = rgb_add(rgb_scale(color, c.filter), rgb_grey(c.transmit));
        sum = rgb_add(rgb_mul(sum, through), rgb_mul(rgb_scale(color, opaque), scene->sky->emission));
    }
    return sum;
}

static Vec3 table_direction(double x, double y)
{
    double phi = 2 * PI * x / TABLE_WIDTH, theta = PI * y / TABLE_HEIGHT;
    return vec3(sin(theta) * cos(phi), cos(theta), sin(theta) * sin(phi));
}

/* Luminance of a cell, the mean of a few points, so that a small sun between centres is not missed. */
static float cell_luminance(const Scene *scene, int x, int y)
{
    float sum = 0;
    if (!scene->sky)
        return fmaxf(0, rgb_luminance(scene->background));
    for (int k = 0; k < 4; k++)
        sum += fmaxf(0, rgb_luminance(
                            sky_radiance(scene, table_direction(x + 0.25 + 0.5 * (k & 1), y + 0.25 + 0.5 * (k >> 1)))));
    return sum / 4;
}

static void normalize_sums(float *sums, int count)
{
    float total = sums[count];
    for (int k = 1; k <= count; k++)
        sums[k] = total > 0 ? sums[k] / total : (float)k / (float)count;
    sums[count] = 1;
}

int environment_create(Environment **environment, const Scene *scene, RetexError *err)
{
    *environment = NULL;
    if (!scene->sky && rgb_is_black(scene->background))
        return RETEX_OK;
    Environment *e = malloc(sizeof *e);
    if (!e)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the table of the sky");
    double total = 0;
    for (int y = 0; y < TABLE_HEIGHT; y++) {
        double area = (cos(PI * y / TABLE_HEIGHT) - cos(PI * (y + 1) / TABLE_HEIGHT)) * 2 * PI / TABLE_WIDTH, row = 0;
        e->conditional[y][0] = 0;
        for (int x = 0; x < TABLE_WIDTH; x++) {
            float value = cell_luminance(scene, x, y);
            e->density[y][x] = value;
            row += value;
            e->conditional[y][x + 1] = (float)row;
        }
        normalize_sums(e->conditional[y], TABLE_WIDTH);
        total += row * area;
        e->marginal[y + 1] = (float)total;
    }
    e->marginal[0] = 0;
    normalize_sums(e->marginal, TABLE_HEIGHT);
    e->mean = (float)(total / (4 * PI));
    if (!(total > 0)) {
        free(e);
        return RETEX_OK;
    }
    for (int y = 0; y < TABLE_HEIGHT; y++)
        for (int x = 0; x < TABLE_WIDTH; x++)
            e->density[y][x] = (float)(e->density[y][x] / total);
    *environment = e;
    return RETEX_OK;
}

void environment_close(Environment **environment)
{
    free(*environment);
    *environment = NULL;
}

/* Largest k with sums[k] <= u. */
static int find_cell(const float *sums, int count, float u)
{
    int low = 0, high = count;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (sums[middle] <= u)
            low = middle;
        else
            high = middle;
    }
    return low;
}

Vec3 environment_sample(const Environment *e, float u1, float u2, float *pdf)
{
    int y = find_cell(e->marginal, TABLE_HEIGHT, u2), x = find_cell(e->conditional[y], TABLE_WIDTH, u1);
    float width = e->conditional[y][x + 1] - e->conditional[y][x], height = e->marginal[y + 1] - e->marginal[y];
    double fx = width > 0 ? (u1 - e->conditional[y][x]) / width : 0.5,
           fy = height > 0 ? (u2 - e->marginal[y]) / height : 0.5;
    /* uniform in solid angle within the cell: cos(theta) is linear */
    double c0 = cos(PI * y / TABLE_HEIGHT), c1 = cos(PI * (y + 1) / TABLE_HEIGHT), c = c0 + (c1 - c0) * fy;
    double phi = 2 * PI * (x + fx) / TABLE_WIDTH, s = sqrt(fmax(0, 1 - c * c));
    *pdf = e->density[y][x];
    return vec3(s * cos(phi), c, s * sin(phi));
}

float environment_pdf(const Environment *e, Vec3 direction)
{
    double phi = atan2(direction.z, direction.x);
    if (phi < 0)
        phi += 2 * PI;
    int x = (int)(phi / (2 * PI) * TABLE_WIDTH), y = (int)(acos(fmax(-1, fmin(1, direction.y))) / PI * TABLE_HEIGHT);
    if (x >= TABLE_WIDTH)
        x = TABLE_WIDTH - 1;
    if (y >= TABLE_HEIGHT)
        y = TABLE_HEIGHT - 1;
    return e->density[y][x];
}

float environment_mean(const Environment *e)
{
    return e->mean;
}
