/* CIEDE2000 as a vector, for the search of what lessens it. Private to libretex. */
#ifndef RETEX_BASE_DELTA_E_H
#define RETEX_BASE_DELTA_E_H

/* Differences of b from a, both L*a*b*, in lightness, chroma and hue. The sum of their squares is the square of
 * retex_delta_e: the product of chroma and hue in the formula is completed to a square. */
void retex_delta_e_parts(double parts[3], const double a[3], const double b[3]);

#endif
