/* density_file: numbers of a grid over the unit cube. Pattern.number is the kind of interpolation: 0 none, 1 linear,
 * 2 cubic. */
#include <stdint.h>
#include "base/polynomial.h"
#include "pattern/density_file.h"

static double at(const DensityFile *file, int x, int y, int z)
{
    const size_t cell = ((size_t)z * (size_t)file->size[1] + (size_t)y) * (size_t)file->size[0] + (size_t)x;
    const unsigned char *p = file->values + cell * (size_t)file->bytes;
    double value = 0, largest = 0;

    for (int i = 0; i < file->bytes; i++)
        value = value * 256 + p[i], largest = largest * 256 + 255;
    return value / largest;
}

/* Beyond the upper end the grid goes on from its start; before the lower end POV-Ray's number has no sign, so that
 * 2^32 - 1 comes before 0. */
static int index_of(const DensityFile *file, int axis, int i)
{
    return (int)((uint32_t)i % (uint32_t)file->size[axis]);
}

/* Weights of up to four numbers, and the first one's place from the cell. */
static int weights_of(int kind, double t, double weights[4], int *first)
{
    *first = kind == 2 ? -1 : 0;
    if (kind == 0) {
        weights[0] = 1;
        return 1;
    }
    if (kind == 1) {
        weights[0] = 1 - t, weights[1] = t;
        return 2;
    }
    cubic_weights(t, weights);
    return 4;
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const DensityFile *file = pattern->data;
    const double p[3] = {point->p.x, point->p.y, point->p.z};
    double weights[3][4], sum = 0;
    int cells[3][4], n = 0;

    for (int axis = 0; axis < 3; axis++) {
        if (!(p[axis] >= 0 && p[axis] < 1))
            return 0;
        const double x = p[axis] * file->size[axis];
        int first;
        n = weights_of((int)pattern->number, x - floor(x), weights[axis], &first);
        for (int i = 0; i < n; i++)
            cells[axis][i] = index_of(file, axis, (int)floor(x) + first + i);
    }
    for (int k = 0; k < n; k++)
        for (int j = 0; j < n; j++)
            for (int i = 0; i < n; i++)
                sum += weights[0][i] * weights[1][j] * weights[2][k] * at(file, cells[0][i], cells[1][j], cells[2][k]);
    return sum;
}

const PatternOps pattern_density_file = {
    .keyword = "density_file", .arguments = ARGUMENTS_DENSITY_FILE, .value = value};
