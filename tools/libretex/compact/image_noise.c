/* Estimates noise by Immerkaer's filter (1996); see image_noise.h. The filter, a second difference along x and along y,
 * is 0 on gradients and on horizontal and vertical edges. The median of its magnitudes ignores the few pixels at other
 * edges. */
#include "compact/image_noise.h"

#include <math.h>

enum { BINS = 4096 };

static const double BIN = 1.0 / 128;    /* width of a bin, in levels */
static const double DEVIATION = 0.6745; /* median magnitude of a Gaussian of standard deviation 1 */
static const double DIFFERENCES = 6;    /* standard deviation of the filter's output if the noise has 1 */

/* The median of a histogram of `all` values: the middle of its bin. */
static double median(const int counts[BINS], int all)
{
    int bin = 0, below = 0;
    while (bin < BINS - 1 && below + counts[bin] <= all / 2)
        below += counts[bin++];
    return (bin + 0.5) * BIN;
}

double retex_image_noise(const RetexImage *image, double levels)
{
    static const int weights[3] = {1, -2, 1};
    int counts[BINS] = {0}, all = 0;
    for (int y = 1; y + 1 < image->height; y++)
        for (int x = 1; x + 1 < image->width; x++)
            for (int c = 0; c < image->channels; c++) {
                double sum = 0;
                if (!(image->pixels[retex_image_index(image, x, y) + (size_t)c] > 0))
                    continue;
                for (int k = 0; k < 9; k++)
                    sum += weights[k / 3] * weights[k % 3] *
                           (double)image->pixels[retex_image_index(image, x + k % 3 - 1, y + k / 3 - 1) + (size_t)c];
                counts[(int)fmin(levels * fabs(sum) / (DIFFERENCES * DEVIATION * BIN), BINS - 1)]++;
                all++;
            }
    return all ? median(counts, all) : 0;
}
