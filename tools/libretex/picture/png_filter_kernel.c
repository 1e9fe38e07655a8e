/* See png_filter.h. The pixel to the left of a line's first counts as 0. */
#include <stdint.h>
#include <string.h>

#include "picture/png_filter.h"

enum { FILTER_NONE, FILTER_LEFT, FILTER_UP, FILTER_MEAN, FILTER_PAETH, FILTERS };

static void filter_left(unsigned char *restrict out, const unsigned char *restrict line, size_t bytes, size_t pixel)
{
    memcpy(out, line, pixel);
    for (size_t i = pixel; i < bytes; i++)
        out[i] = (unsigned char)(line[i] - line[i - pixel]);
}

static void filter_up(unsigned char *restrict out, const unsigned char *restrict line,
                      const unsigned char *restrict above, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++)
        out[i] = (unsigned char)(line[i] - above[i]);
}

static void filter_mean(unsigned char *restrict out, const unsigned char *restrict line,
                        const unsigned char *restrict above, size_t bytes, size_t pixel)
{
    for (size_t i = 0; i < pixel; i++)
        out[i] = (unsigned char)(line[i] - above[i] / 2);
    for (size_t i = pixel; i < bytes; i++)
        out[i] = (unsigned char)(line[i] - (line[i - pixel] + above[i]) / 2);
}

static inline int16_t magnitude(int16_t value)
{
    return value < 0 ? (int16_t)-value : value;
}

/* The Paeth predictor: of left, above and above left the one nearest to left + above - above left; the first of
 * equals. */
static void filter_paeth(unsigned char *restrict out, const unsigned char *restrict line,
                         const unsigned char *restrict above, size_t bytes, size_t pixel)
{
    filter_up(out, line, above, pixel);
    for (size_t i = pixel; i < bytes; i++) {
        const int16_t a = line[i - pixel], b = above[i], c = above[i - pixel];
        const int16_t to_a = magnitude((int16_t)(b - c)), to_b = magnitude((int16_t)(a - c)),
                      to_c = magnitude((int16_t)(a + b - 2 * c));
        const int16_t of_others = to_b <= to_c ? b : c, least = to_b <= to_c ? to_b : to_c;
        out[i] = (unsigned char)(line[i] - (to_a <= least ? a : of_others));
    }
}

static uint32_t sum_of_magnitudes(const unsigned char *data, size_t bytes)
{
    uint32_t sum = 0;

    for (size_t i = 0; i < bytes; i++) {
        const unsigned char other = (unsigned char)-data[i];
        sum += data[i] < other ? data[i] : other;
    }
    return sum;
}

void retex_png_filter(unsigned char *restrict out, unsigned char *restrict trial, const unsigned char *restrict line,
                      const unsigned char *restrict above, size_t bytes, size_t pixel)
{
    uint32_t least = sum_of_magnitudes(line, bytes);

    out[0] = FILTER_NONE;
    memcpy(out + 1, line, bytes);
    for (int filter = FILTER_LEFT; filter < (above ? FILTERS : FILTER_UP); filter++) {
        if (filter == FILTER_LEFT)
            filter_left(trial, line, bytes, pixel);
        else if (filter == FILTER_UP)
            filter_up(trial, line, above, bytes);
        else if (filter == FILTER_MEAN)
            filter_mean(trial, line, above, bytes, pixel);
        else
            filter_paeth(trial, line, above, bytes, pixel);
        const uint32_t sum = sum_of_magnitudes(trial, bytes);
        if (sum < least) {
            least = sum;
            out[0] = (unsigned char)filter;
            memcpy(out + 1, trial, bytes);
        }
    }
}
