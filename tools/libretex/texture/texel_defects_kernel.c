/* Checks whether many values are all from 0 to 1: most texels are, and need no other check. */
#include "texture/texel_defects.h"

int retex_texels_are_in_range(const float *restrict values, size_t count)
{
    int odd = 0;

    for (size_t i = 0; i < count; i++)
        odd |= !(values[i] >= 0 && values[i] <= 1); /* NaN too */
    return !odd;
}
