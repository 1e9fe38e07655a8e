/* See enlarge.h. */
#include "enlarge.h"

#include <string.h>

#include <retex/set.h>

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

/* Two of the small image's rows, mixed on the fly, drawn out to the width. */
static void enlarge_row(const float *restrict upper, const float *restrict lower, float t, int size, int channels,
                        int scale, int width, float *restrict out)
{
    for (int x = 0; x < width; x++) {
        Place at = find_place(x, scale, size);
        for (int c = 0; c < channels; c++) {
            int a = at.first * channels + c, b = at.next * channels + c;
            float left = upper[a] + t * (lower[a] - upper[a]), right = upper[b] + t * (lower[b] - upper[b]);
            *out++ = left + at.t * (right - left);
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
        enlarge_row(image->pixels + retex_image_index(image, 0, at.first),
                    image->pixels + retex_image_index(image, 0, at.next), at.t, image->width, image->channels, scale,
                    width, out);
    }
}
