/* Places that lights shine on, at random. */
#ifndef LIB_RANDOM_LIGHT_H
#define LIB_RANDOM_LIGHT_H

#include "lib_random_scene.h"
#include "light/lights.h"

static inline Vec3 random_point(double size)
{
    double x = random_between(-size, size), y = random_between(-size, size);
    return vec3(x, y, random_between(-size, size));
}

/* On a surface where k is odd, else in the open. */
static inline LightSampleContext random_lit(int k)
{
    LightSampleContext p = {.position = random_point(6)};
    if (k % 2)
        p.normal = random_direction();
    return p;
}

#endif
