/* From scene-linear values to the codes that files of 8 and 16 bits hold: IEC 61966-2-1's curve as powf computes it,
 * rounded to the nearest code. */
#ifndef RETEX_PICTURE_SRGB_CODES_H
#define RETEX_PICTURE_SRGB_CODES_H

#include <stddef.h>
#include <stdint.h>

/* NaN and what is below 0 become 0, what is above 1 the highest code. By tables, made on first use; safe from any
 * thread. */
void retex_srgb_codes_8(uint8_t *restrict codes, const float *restrict values, size_t count);
void retex_srgb_codes_16(uint16_t *restrict codes, const float *restrict values, size_t count);

/* The code of one value of so many bits, from the curve itself: what the tables are made from. */
unsigned retex_srgb_code(float value, int bits);

/* Without the curve, as alpha is stored. */
unsigned retex_linear_code(float value, int bits);

#endif
