/* The numbers that images of a render may hold. Scenes may have colours, places and lights of any size, but tools
 * refuse sets whose numbers are not finite, and sums and squares of numbers must stay finite in all tools. */
#ifndef RENDERER_FILM_LIMITS_H
#define RENDERER_FILM_LIMITS_H

#include <stddef.h>

#define FILM_NUMBER_MAX 1e18f /* as the renderer's coordinates; images of halves end at 65504 */

/* Replace NaN by 0 and numbers beyond FILM_NUMBER_MAX by that, with their sign; infinities too, unless may_be_infinite.
 * Returns how many were replaced. */
long film_limit_numbers(float *numbers, size_t count, int may_be_infinite);

#endif
