/* `internal(N)`: the built-in functions that functions.inc declares. This file has those that other standard include
 * files use. A call of any other function is reported as unsupported. */
#include <math.h>
#include <stdio.h>
#include "base/noise.h"
#include "sdl/lang/internal.h"

enum { F_PH = 47, F_R = 57, F_SPHERE = 61, F_TH = 69, F_TORUS = 70, F_NOISE3D = 76, F_NOISE_GENERATOR = 78 };

int internal_arguments(int number)
{
    switch (number) {
    case F_PH:
    case F_R:
    case F_TH:
    case F_NOISE3D:
        return 3;
    case F_SPHERE:
    case F_NOISE_GENERATOR:
        return 4;
    case F_TORUS:
        return 5;
    default:
        return 0;
    }
}

double internal_call(Sdl *sdl, int number, const double *args, int count)
{
    (void)count;
    double x = args[0], y = args[1], z = args[2];
    char name[32];
    switch (number) {
    case F_PH:
        return atan2(sqrt(x * x + z * z), y);
    case F_R:
        return sqrt(x * x + y * y + z * z);
    case F_TH:
        return atan2(x, z);
    case F_SPHERE:
        return sqrt(x * x + y * y + z * z) - args[3];
    case F_TORUS: {
        double ring = sqrt(x * x + z * z) - args[3];
        return sqrt(ring * ring + y * y) - args[4];
    }
    case F_NOISE3D:
    case F_NOISE_GENERATOR:
        sdl_unsupported(sdl, "POV-Ray's own noise", "noise of the same kind gives other values");
        return noise_scalar(vec3(x, y, z));
    default:
        snprintf(name, sizeof name, "internal(%d)", number);
        sdl_unsupported(sdl, name, "it gives 0");
        return 0;
    }
}
