/* See enlarge.h. */
#include "retexture/enlarge.h"

#include <string.h>

#include <retex/set.h>

#include "base/float4.h"

/* The place of pixel i of the large image among those of the small one: between first and next, at fraction t. */
typedef struct Place {
    int first, next;
    float t;
} Place;

static Place find_place(int i, int scale, int size)
{
    int twice = 2 * i + 1 - scale, first = twice < 0 ? -1 : twice / (2 * scale); /* centres: (i + .5) / scale - .5 */
    Place place = {first, first + 1, (float)(twice - 2 * scale * first) / (float)(2 * scale)};
    if (place.first < 0)
        place.first = 0;
    if (place.first > size - 1)
        place.first = size - 1;
    if (place.next > size - 1)
        place.next = size - 1;
    return place;
}

/* Values of the small image that are interpolated at a time. */
enum { NUMBERS = 1024 };
_Static_assert(NUMBERS >= 4 * RETEX_MAX_CHANNELS, "a few pixels fit");

/* Writes the pixels between the centres of two neighbouring small pixels: scale pixels, or fewer where the row ends.
 * With three channels a fourth value is written where the next pixel will be, unless the row ends there. */
static inline float *stretch_row(float *restrict out, const float *left, int channels, int scale, int count,
                                 const float *end)
{
    const float *right = left + channels;
    const float step = 1 / (float)scale;
    float t = 0.5f * step; /* exact: scale is a power of two */
    if (channels == 3 && out + 3 * count < end) {
        const RetexFloat4 from = load4(left), by = load4(right) - from;
        for (int k = 0; k < count; k++, t += step, out += 3) {
            const RetexFloat4 pixel = from + t * by;
            memcpy(out, &pixel, sizeof pixel);
        }
        return out;
    }
    for (int k = 0; k < count; k++, t += step)
        for (int c = 0; c < channels; c++)
            *out++ = left[c] + t * (right[c] - left[c]);
    return out;
}

/* Interpolates pixels begin <= i < end between two rows of the small image; pixels beyond its ends repeat the
 * outermost. */
static inline void mix_rows(float *restrict out, const float *restrict upper, const float *restrict lower, float t,
                            int begin, int end, int size, int channels)
{
    const size_t pixel = (size_t)channels;
    const int first = begin < 0 ? 0 : begin, last = end > size ? size : end;
    float *inside = out + (size_t)(first - begin) * pixel;
    upper += (size_t)first * pixel;
    lower += (size_t)first * pixel;
    const size_t count = (size_t)(last - first) * pixel;
    for (size_t i = 0; i < count; i++)
        inside[i] = upper[i] + t * (lower[i] - upper[i]);
    if (begin < first)
        memcpy(out, inside, pixel * sizeof *out);
    if (end > last)
        memcpy(inside + count, inside + count - pixel, pixel * sizeof *out);
}

/* Interpolates between two rows of the small image, a block of pixels at a time, and enlarges the result to the
 * width. */
static inline void enlarge_row(const float *restrict upper, const float *restrict lower, float t, int size,
                               int channels, int scale, int width, float *restrict out)
{
    float mixed[NUMBERS + 1] = {0}; /* one more, for vectors of four */
    const float *end = out + (size_t)width * (size_t)channels;
    const int most = NUMBERS / channels - 1;
    for (int i = 0, x = 0; x < width; i += most) {
        const int intervals =
            size + 1 - i < most ? size + 1 - i : most; /* each up to the centre of pixel i, i + 1, ... */
        mix_rows(mixed, upper, lower, t, i - 1, i + intervals, size, channels);
        for (int k = 0; k < intervals && x < width; k++) {
            const int wanted = i + k ? scale : scale / 2, rest = width - x, count = wanted < rest ? wanted : rest;
            const float *left = mixed + (size_t)(k * channels);
            out = count == scale ? stretch_row(out, left, channels, scale, scale, end)
                                 : stretch_row(out, left, channels, scale, count, end);
            x += count;
        }
    }
}

void retex_enlarge_rows(const RetexImage *image, int scale, int width, int y0, int y1, float *restrict out)
{
    size_t row = (size_t)width * (size_t)image->channels;
    for (int y = y0; y < y1; y++, out += row) {
        if (scale == 1) {
            memcpy(out, image->pixels + retex_image_index(image, 0, y), row * sizeof *out);
            continue;
        }
        Place at = find_place(y, scale, image->height);
        const float *upper = image->pixels + retex_image_index(image, 0, at.first);
        const float *lower = image->pixels + retex_image_index(image, 0, at.next);
        if (image->channels == 3 && scale == 2)
            enlarge_row(upper, lower, at.t, image->width, 3, 2, width, out);
        else if (image->channels == 3)
            enlarge_row(upper, lower, at.t, image->width, 3, scale, width, out);
        else
            enlarge_row(upper, lower, at.t, image->width, image->channels, scale, width, out);
    }
}
