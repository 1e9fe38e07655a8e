/* julia_fractal: its constant, and what stands after it in any order. */
#include "sdl/object/shape.h"
#include "shape/julia_fractal.h"

enum { MAX_ITERATIONS = 10000 };

#define LARGEST 1e9      /* of the numbers: the iterates of smaller ones are finite until they escape */
#define MOST_STEPS 500e3 /* from the ball's middle to its end */

static void four(Sdl *sdl, double out[4])
{
    const Value value = sdl_expression(sdl);
    if (value.kind != VALUE_VECTOR && value.kind != VALUE_FLOAT)
        sdl_error(sdl, "julia_fractal: four numbers are needed");
    for (int i = 0; i < 4; i++)
        out[i] = value.kind == VALUE_FLOAT ? value.number[0] : i < value.count ? value.number[i] : 0;
}

static int accept_function(Sdl *sdl, JuliaFractal *f)
{
    static const char *const words[] = {
#define X(name, value) #name,
        JULIA_FUNCTIONS(X)
#undef X
    };
    for (int i = 0; i < (int)(sizeof words / sizeof *words); i++)
        if (sdl_accept(sdl, words[i])) {
            f->function = (JuliaFunction)i;
            if (f->function != JULIA_pwr)
                return 1;
            sdl_expect(sdl, "(");
            f->exponent[0] = sdl_float(sdl);
            sdl_expect(sdl, ",");
            f->exponent[1] = sdl_float(sdl);
            sdl_expect(sdl, ")");
            return 1;
        }
    return 0;
}

static int accept_option(Sdl *sdl, JuliaFractal *f)
{
    if (sdl_accept(sdl, "max_iteration")) {
        const double count = sdl_float(sdl);
        if (!(count >= 1 && count <= MAX_ITERATIONS))
            sdl_error(sdl, "max_iteration %g: there are 1 to %d", count, MAX_ITERATIONS);
        f->iterations = (int)count;
    } else if (sdl_accept(sdl, "precision")) {
        const double precision = sdl_float(sdl);
        if (!(precision > 0))
            sdl_error(sdl, "a precision of %g is not above 0", precision);
        f->step = 1 / fmin(fmax(precision, 1), 1e5);
    } else if (sdl_accept(sdl, "slice")) {
        four(sdl, f->slice);
        sdl_optional_comma(sdl);
        f->distance = sdl_float(sdl);
        if (fabs(f->slice[3]) < 1e-12)
            sdl_error(sdl, "the fourth number of slice must not be 0");
    } else if (sdl_accept(sdl, "quaternion"))
        f->hypercomplex = 0;
    else if (sdl_accept(sdl, "hypercomplex"))
        f->hypercomplex = 1;
    else
        return accept_function(sdl, f);
    return 1;
}

void parse_julia_fractal(Sdl *sdl, Object *object)
{
    JuliaFractal *f = sdl_alloc(sdl, sizeof *f);
    *f = (JuliaFractal){.function = JULIA_sqr, .slice = {0, 0, 0, 1}, .iterations = 20, .step = 0.05, .radius = 4};
    four(sdl, f->constant);
    while (accept_option(sdl, f))
        ;
    if (!f->hypercomplex) {
        const double *c = f->constant;
        if (f->function != JULIA_sqr && f->function != JULIA_cube)
            sdl_error(sdl, "julia_fractal: quaternions have sqr and cube only; the others are for hypercomplex");
        f->radius = 1 + sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2] + c[3] * c[3]);
        if (!(f->radius <= LARGEST))
            sdl_error(sdl, "julia_fractal: its numbers must be below %g", LARGEST);
        f->step = fmax(f->step, f->radius / MOST_STEPS);
    }
    f->limit = f->radius * f->radius;
    object->shape.ops = &shape_julia_fractal;
    object->shape.data = f;
}
