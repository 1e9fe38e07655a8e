/* What a julia_fractal is made of, as sdl/object/julia_fractal.c leaves it in Shape.data. */
#ifndef RENDERER_SHAPE_JULIA_FRACTAL_H
#define RENDERER_SHAPE_JULIA_FRACTAL_H

#include <complex.h>

/* Functions of a complex number; a hypercomplex number is two of them. POV-Ray's cube of them is the square. X(keyword,
 * value) */
#define JULIA_FUNCTIONS(X)                                                                                             \
    X(acos, cacos(z))                                                                                                  \
    X(acosh, cacosh(z))                                                                                                \
    X(asin, casin(z))                                                                                                  \
    X(asinh, casinh(z))                                                                                                \
    X(atan, catan(z))                                                                                                  \
    X(atanh, catanh(z))                                                                                                \
    X(cos, ccos(z))                                                                                                    \
    X(cosh, ccosh(z))                                                                                                  \
    X(cube, z *z)                                                                                                      \
    X(exp, cexp(z))                                                                                                    \
    X(ln, clog(z))                                                                                                     \
    X(pwr, cexp(exponent *clog(z)))                                                                                    \
    X(reciprocal, 1 / z)                                                                                               \
    X(sin, csin(z))                                                                                                    \
    X(sinh, csinh(z))                                                                                                  \
    X(sqr, z *z)                                                                                                       \
    X(tan, ctan(z))                                                                                                    \
    X(tanh, ctanh(z))

typedef enum JuliaFunction {
#define X(name, value) JULIA_##name,
    JULIA_FUNCTIONS(X)
#undef X
} JuliaFunction;

/* Points of four dimensions, a slice of which is seen, that stay small under iteration of f(z) + constant. */
typedef struct JuliaFractal {
    int hypercomplex; /* 0: quaternions, of sqr and cube only */
    JuliaFunction function;
    double exponent[2]; /* of pwr: real and imaginary part */
    double constant[4];
    double slice[4], distance; /* slice . point = distance */
    int iterations;
    double step;          /* the least along a ray */
    double radius, limit; /* of the ball that is looked at; of the square of what stays small */
} JuliaFractal;

#endif
