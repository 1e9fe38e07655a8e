/* See levels.h. */
#include "picture/levels.h"

#include <stdlib.h>

#include <retex/color.h>

/* The linear value of one of the file's numbers, the same as the bridge's. */
static float linear_value(const RetexLevels *levels, int number)
{
    const int top = levels->bits == 8 ? 255 : 65535;

    return levels->is_linear ? (float)number * (1.0f / (float)top) : (float)retex_srgb_decode(number / (double)top);
}

/* The values of all numbers; for floats also those of alpha, which come after. */
static int make_values(RetexLevels *levels)
{
    const int count = levels->bits == 8 ? 256 : 65536;
    const float top = (float)(count - 1);

    levels->values = malloc((size_t)count * (levels->narrow ? sizeof(uint16_t) : 2 * sizeof(float)));
    if (!levels->values)
        return 0;
    for (int i = 0; i < count; i++)
        if (levels->narrow)
            ((uint16_t *)levels->values)[i] = (uint16_t)(linear_value(levels, i) * 65535.0f + 0.5f);
        else
            ((float *)levels->values)[i] = linear_value(levels, i),
                    ((float *)levels->values)[count + i] = (float)i * (1.0f / top);
    return 1;
}

int retex_levels_begin(RetexLevels *levels, int width, int height, int channels, int bits)
{
    levels->width = width, levels->height = height, levels->channels = channels, levels->bits = bits;
    if (width < 1 || height < 1 || width > RETEX_MAX_SIZE || height > RETEX_MAX_SIZE ||
        (levels->max_pixels > 0 && (long)width * height > levels->max_pixels))
        return RETEX_LEVELS_LEFT;
    if (levels->narrow) {
        *levels->narrow = (RetexNarrowImage){width, height, malloc(sizeof(uint16_t) * 4 * (size_t)width * height)};
        if (!levels->narrow->pixels)
            return RETEX_LEVELS_NO_MEMORY;
    } else if (retex_image_alloc(levels->image, width, height, 4, NULL)) {
        return RETEX_LEVELS_NO_MEMORY;
    }
    return make_values(levels) ? RETEX_LEVELS_READ : RETEX_LEVELS_NO_MEMORY;
}

void retex_levels_end(RetexLevels *levels, int keep)
{
    free(levels->values);
    levels->values = NULL;
    if (keep)
        return;
    if (levels->narrow) {
        free(levels->narrow->pixels);
        *levels->narrow = (RetexNarrowImage){0};
    } else {
        retex_image_free(levels->image);
    }
}

/* Loops over a row of 8- or 16-bit numbers, for constant numbers of channels. */
#define ROW(Level)                                                                                                     \
    static inline void narrow_##Level(uint16_t *restrict to, const Level *restrict from, int width, int channels,      \
                                      const uint16_t *restrict values)                                                 \
    {                                                                                                                  \
        const int green = channels > 2, blue = 2 * green;                                                              \
        for (int x = 0; x < width; x++, to += 4, from += channels) {                                                   \
            to[0] = values[from[0]], to[1] = values[from[green]], to[2] = values[from[blue]], to[3] = 65535;           \
            if (channels % 2 == 0) {                                                                                   \
                const uint32_t alpha = from[channels - 1] * (uint32_t)(65535 / (Level)-1);                             \
                for (int c = 0; c < 3; c++)                                                                            \
                    to[c] = (uint16_t)((to[c] * alpha + 32767) / 65535);                                               \
                to[3] = (uint16_t)alpha;                                                                               \
            }                                                                                                          \
        }                                                                                                              \
    }                                                                                                                  \
    static inline void wide_##Level(float *restrict to, const Level *restrict from, int width, int channels,           \
                                    const float *restrict values)                                                      \
    {                                                                                                                  \
        const int green = channels > 2, blue = 2 * green;                                                              \
        const float *alpha = values + (Level)-1 + 1;                                                                   \
        for (int x = 0; x < width; x++, to += 4, from += channels) {                                                   \
            to[0] = values[from[0]], to[1] = values[from[green]], to[2] = values[from[blue]];                          \
            to[3] = channels % 2 == 0 ? alpha[from[channels - 1]] : 1;                                                 \
        }                                                                                                              \
    }                                                                                                                  \
    static void row_##Level(const RetexLevels *levels, int y, const Level *from, int channels)                         \
    {                                                                                                                  \
        const size_t first = 4 * (size_t)levels->width * (size_t)y;                                                    \
        if (levels->narrow)                                                                                            \
            narrow_##Level(levels->narrow->pixels + first, from, levels->width, channels, levels->values);             \
        else                                                                                                           \
            wide_##Level(levels->image->pixels + first, from, levels->width, channels, levels->values);                \
    }

ROW(uint8_t)
ROW(uint16_t)

void retex_levels_row(const RetexLevels *levels, int y, const void *row)
{
    if (levels->bits == 8)
        row_uint8_t(levels, y, row, levels->channels);
    else
        row_uint16_t(levels, y, row, levels->channels);
}
