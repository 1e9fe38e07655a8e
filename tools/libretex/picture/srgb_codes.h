/* Scene-linear values to 8- and 16-bit sRGB codes: IEC 61966-2-1's curve as powf computes it, rounded to the nearest
 * code. */
#ifndef RETEX_PICTURE_SRGB_CODES_H
#define RETEX_PICTURE_SRGB_CODES_H

#include <stddef.h>
#include <stdint.h>

/* NaN and negative values become 0, values above 1 the highest code. The tables are made on first use; safe from any
 * thread. */
void retex_srgb_codes_8(uint8_t *restrict codes, const float *restrict values, size_t count);
void retex_srgb_codes_16(uint16_t *restrict codes, const float *restrict values, size_t count);

/* The code of one value, with so many bits, by the curve itself, from which the tables are made. */
unsigned retex_srgb_code(float value, int bits);

/* The same without the curve, for alpha. */
unsigned retex_linear_code(float value, int bits);

#endif
