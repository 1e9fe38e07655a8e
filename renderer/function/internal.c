/* The table of functions that functions.inc declares by `internal(N)`. */
#include <stddef.h>
#include "base/noise.h"
#include "function/internal.h"

static const struct {
    InternalFunction *value;
    int count; /* of arguments */
} table[INTERNAL_COUNT] = {
#define X(number, name, arguments) [number] = {internal_##name, arguments},
    INTERNAL_SURFACES(X) INTERNAL_SOLIDS(X) INTERNAL_NOISES(X)
#undef X
        [INTERNAL_NOISE3D] = {NULL, 3},
};

int function_internal_arguments(int number)
{
    return number >= 0 && number < INTERNAL_COUNT ? table[number].count : 0;
}

double function_internal(int number, const double *args, int noise_generator)
{
    return number == INTERNAL_NOISE3D ? noise_value(vec3(args[0], args[1], args[2]), noise_generator)
                                      : table[number].value(args);
}
