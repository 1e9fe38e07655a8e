/* See enlarge.h. */
#include "enlarge.h"

#include <string.h>

#include <retex/set.h>

#include "float4.h"

/* Where pixel i of the large image lies among those of the small one: between first and next, t of the way. */
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

/* Pixels from the centre of one of the small image's to that of the next: scale of them, or fewer where the row ends.
 * Of three channels, a fourth is written where the next pixel will be, unless the row ends there. */
static inline float *draw_out(float *restrict out, const float *left, const float *right, int channels, int scale,
                              int count, const float *end)
{
    const float step = 1 / (float)scale;
    float t = 0.5f * step; /* exact: scale is a power of two */
    if (channels == 3 && out + 3 * count < end) {
        const Float4 from = load4(left), by = load4(right) - from;
        for (int k = 0; k < count; k++, t += step, out += 3) {
            const Float4 pixel = from + t * by;
            memcpy(out, &pixel, sizeof pixel);
        }
        return out;
    }
    for (int k = 0; k < count; k++, t += step)
        for (int c = 0; c < channels; c++)
            *out++ = left[c] + t * (right[c] - left[c]);
    return out;
}

/* Two of the small image's rows, mixed on the fly, drawn out to the width. */
static void enlarge_row(const float *restrict upper, const float *restrict lower, float t, int size, int channels,
                        int scale, int width, float *restrict out)
{
    float ends[2][RETEX_MAX_CHANNELS] = {{0}};
    float *left = ends[0], *right = ends[1];
    const float *end = out + (size_t)width * (size_t)channels;
    int x = 0;
    for (int c = 0; c < channels; c++)
        left[c] = right[c] = upper[c] + t * (lower[c] - upper[c]);
    for (int i = 0; x < width; i++) { /* to the centre of pixel i, and beyond the last */
        const int rest = width - x, most = i ? scale : scale / 2;
        if (i > 0 && i < size)
            for (int c = 0; c < channels; c++) {
                const float *a = upper + i * channels, *b = lower + i * channels;
                right[c] = a[c] + t * (b[c] - a[c]);
            }
        else if (i > 0)
            memcpy(right, left, sizeof *left * (size_t)channels);
        out = draw_out(out, left, right, channels, scale, most < rest ? most : rest, end);
        x += most;
        float *reached = right;
        right = left;
        left = reached;
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
        enlarge_row(image->pixels + retex_image_index(image, 0, at.first),
                    image->pixels + retex_image_index(image, 0, at.next), at.t, image->width, image->channels, scale,
                    width, out);
    }
}
