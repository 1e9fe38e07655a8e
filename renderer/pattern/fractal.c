/* mandel, julia, magnet: iterations z -> f(z, c) in the plane of x and y, coloured by when and where they leave. */
#include "pattern/fractal.h"

typedef struct Complex {
    double re, im;
} Complex;

static Complex plus(Complex a, Complex b)
{
    return (Complex){a.re + b.re, a.im + b.im};
}

static Complex times(Complex a, Complex b)
{
    return (Complex){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

static Complex scaled(Complex a, double factor)
{
    return (Complex){a.re * factor, a.im * factor};
}

static double square(Complex a)
{
    return a.re * a.re + a.im * a.im;
}

static Complex divided(Complex a, Complex b)
{
    return scaled(times(a, (Complex){b.re, -b.im}), 1 / square(b));
}

static Complex minus(Complex a, double b)
{
    return (Complex){a.re - b, a.im};
}

static Complex power(Complex z, int exponent)
{
    Complex result = z;

    for (int i = 1; i < exponent; i++)
        result = times(result, z);
    return result;
}

/* ((z² + c - 1) / (2z + c - 2))² */
static Complex magnet1(Complex z, Complex c)
{
    const Complex w = divided(plus(times(z, z), minus(c, 1)), plus(scaled(z, 2), minus(c, 2)));

    return times(w, w);
}

/* ((z³ + 3(c-1)z + (c-1)(c-2)) / (3z² + 3(c-2)z + (c-1)(c-2) + 1))² */
static Complex magnet2(Complex z, Complex c)
{
    const Complex c1 = minus(c, 1), c2 = minus(c, 2), product = times(c1, c2);
    const Complex above = plus(times(z, plus(times(z, z), scaled(c1, 3))), product);
    const Complex below = minus(plus(times(scaled(z, 3), plus(z, c2)), product), -1);
    const Complex w = divided(above, below);

    return times(w, w);
}

static Complex next(const Fractal *f, Complex z, Complex c)
{
    return f->magnet == 1 ? magnet1(z, c) : f->magnet == 2 ? magnet2(z, c) : plus(power(z, f->exponent), c);
}

static int has_left(const Fractal *f, Complex z)
{
    return f->magnet ? square(z) > 1e4 || square(minus(z, 1)) < 1e-4 : square(z) > 4;
}

static double exterior(const Fractal *f, Complex z, double iteration)
{
    const double factors[] = {1, 0, z.re, z.im, z.re * z.re, z.im * z.im, sqrt(square(z))};

    return f->exterior == 1 ? iteration / f->iterations : factors[f->exterior] * f->exterior_factor;
}

/* Type 6 is as POV-Ray computes it: the factor is of the imaginary part alone. */
static double interior(const Fractal *f, Complex z, double nearest)
{
    const double k = f->interior_factor;
    const double values[] = {
        k, sqrt(nearest) * k, z.re * k, z.im * k, z.re * z.re * k, z.im * z.im * k, z.re * z.re + z.im * z.im * k};

    return values[f->interior];
}

static double value(const Pattern *pattern, const PatternPoint *point)
{
    const Fractal *f = pattern->data;
    const Complex p = {point->p.x, point->p.y}, zero = {0, 0};
    const Complex c = f->is_julia ? (Complex){f->constant[0], f->constant[1]} : p;
    Complex z = f->magnet && !f->is_julia ? zero : p;
    double nearest = square(p);

    for (double i = 0; i < f->iterations; i++) {
        z = next(f, z, c);
        if (square(z) < nearest)
            nearest = square(z);
        if (has_left(f, z))
            return exterior(f, z, i);
    }
    return interior(f, z, nearest);
}

static const ColorMap mandel_colors = {.entries = (ColorMapEntry[]){{.value = 0.001, .color = {0, 0, 0, 0, 0}},
                                                                    {.value = 0.001, .color = {0, 1, 1, 0, 0}},
                                                                    {.value = 0.012, .color = {1, 1, 0, 0, 0}},
                                                                    {.value = 0.015, .color = {1, 0, 1, 0, 0}},
                                                                    {.value = 0.1, .color = {0, 1, 1, 0, 0}}},
                                       .count = 5};

const PatternOps pattern_mandel = {
    .keyword = "mandel", .arguments = ARGUMENTS_FRACTAL, .map = &mandel_colors, .value = value};
const PatternOps pattern_julia = {.keyword = "julia", .arguments = ARGUMENTS_FRACTAL, .value = value};
const PatternOps pattern_magnet = {.keyword = "magnet", .arguments = ARGUMENTS_FRACTAL, .value = value};
