/* See limits.h. */
#include <math.h>
#include "film/limits.h"

/* In nearly all images no number is replaced: this loop has no branch. */
static int any_beyond(const float *restrict numbers, size_t count)
{
    int any = 0;
    for (size_t i = 0; i < count; i++)
        any |= !(fabsf(numbers[i]) <= FILM_NUMBER_MAX);
    return any;
}

long film_limit_numbers(float *numbers, size_t count, int may_be_infinite)
{
    long replaced = 0;
    if (!any_beyond(numbers, count))
        return 0;
    for (size_t i = 0; i < count; i++) {
        const float v = numbers[i];
        if (fabsf(v) <= FILM_NUMBER_MAX || (may_be_infinite && isinf(v)))
            continue;
        numbers[i] = isnan(v) ? 0 : copysignf(FILM_NUMBER_MAX, v);
        replaced++;
    }
    return replaced;
}
