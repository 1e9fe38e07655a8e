/* Splines: linear, quadratic, cubic (slopes from the neighbouring points) and natural. A spline is called like a
 * function of one float. It returns a vector with as many components as the spline's longest point. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "sdl/lang/internal.h"

typedef enum SplineKind { SPLINE_LINEAR, SPLINE_QUADRATIC, SPLINE_CUBIC, SPLINE_NATURAL } SplineKind;

typedef struct Knot {
    double at, value[5];
    double second[5]; /* second derivative at the knot, for natural splines */
} Knot;

typedef struct Spline {
    SplineKind kind;
    int count, capacity, components;
    Knot *knots; /* sorted by parameter */
} Spline;

static int by_place(const void *a, const void *b)
{
    double x = ((const Knot *)a)->at, y = ((const Knot *)b)->at;
    return (x > y) - (x < y);
}

static void add_knot(Sdl *sdl, Spline *spline, double at, Num value)
{
    for (int i = 0; i < spline->count; i++)
        if (spline->knots[i].at == at)
            sdl_error(sdl, "a spline with two points at %g", at);
    spline->knots = sdl_grow(sdl, spline->knots, spline->count, &spline->capacity, sizeof *spline->knots);
    sdl_step(sdl, 1 + spline->count / 64);
    Knot *knot = &spline->knots[spline->count++];
    memset(knot, 0, sizeof *knot);
    knot->at = at;
    if (value.count == 1)
        num_promote(&value, 3);
    memcpy(knot->value, value.n, (size_t)value.count * sizeof *value.n);
    if (value.count > spline->components)
        spline->components = value.count;
}

/* Second derivatives of a natural spline, by a tridiagonal system. They are zero at both ends. */
static void solve_natural(Sdl *sdl, Spline *spline)
{
    int n = spline->count;
    Knot *k = spline->knots;
    double *ratio = sdl_alloc(sdl, (size_t)n * sizeof *ratio);
    for (int c = 0; c < 5; c++) {
        ratio[0] = 0;
        k[0].second[c] = 0;
        for (int i = 1; i + 1 < n; i++) {
            double h0 = k[i].at - k[i - 1].at, h1 = k[i + 1].at - k[i].at;
            double right = 6 * ((k[i + 1].value[c] - k[i].value[c]) / h1 - (k[i].value[c] - k[i - 1].value[c]) / h0);
            double pivot = 2 * (h0 + h1) - h0 * ratio[i - 1];
            ratio[i] = h1 / pivot;
            k[i].second[c] = (right - h0 * k[i - 1].second[c]) / pivot;
        }
        k[n - 1].second[c] = 0;
        for (int i = n - 2; i > 0; i--)
            k[i].second[c] -= ratio[i] * k[i + 1].second[c];
    }
}

void spline_declare(Sdl *sdl, Value *value)
{
    static const char *const names[] = {"linear_spline", "quadratic_spline", "cubic_spline", "natural_spline"};
    Spline *spline = sdl_alloc(sdl, sizeof *spline);
    sdl_expect(sdl, "{");
    const Token *token = sdl_peek(sdl);
    if (token->kind == TOKEN_IDENT && token->value->kind == VALUE_SPLINE) {
        const Spline *base = sdl_next(sdl)->value->data;
        *spline = *base;
        spline->capacity = base->count;
        spline->knots = sdl_alloc(sdl, (size_t)base->count * sizeof *spline->knots);
        memcpy(spline->knots, base->knots, (size_t)base->count * sizeof *spline->knots);
    }
    for (int i = 0; i < 4; i++)
        if (sdl_accept(sdl, names[i]))
            spline->kind = (SplineKind)i;
    sdl_optional_comma(sdl);
    while (!sdl_accept(sdl, "}")) {
        double at = sdl_float(sdl);
        sdl_optional_comma(sdl);
        add_knot(sdl, spline, at, expression_sum(sdl));
        sdl_optional_comma(sdl);
    }
    if (!spline->count)
        sdl_error(sdl, "a spline without points");
    qsort(spline->knots, (size_t)spline->count, sizeof *spline->knots, by_place);
    if (spline->kind == SPLINE_NATURAL)
        solve_natural(sdl, spline);
    *value = (Value){.kind = VALUE_SPLINE, .data = spline};
}

static double linear(const Knot *a, const Knot *b, int c, double at)
{
    double t = (at - a->at) / (b->at - a->at);
    return a->value[c] + (b->value[c] - a->value[c]) * t;
}

/* The parabola through three points, evaluated. */
static double quadratic(const Knot *a, const Knot *b, const Knot *d, int c, double at)
{
    double l0 = (at - b->at) * (at - d->at) / ((a->at - b->at) * (a->at - d->at));
    double l1 = (at - a->at) * (at - d->at) / ((b->at - a->at) * (b->at - d->at));
    double l2 = (at - a->at) * (at - b->at) / ((d->at - a->at) * (d->at - b->at));
    return l0 * a->value[c] + l1 * b->value[c] + l2 * d->value[c];
}

/* Hermite interpolation between b and d. The slopes are differences of the neighbouring points. */
static double cubic(const Knot *a, const Knot *b, const Knot *d, const Knot *e, int c, double at)
{
    double h = d->at - b->at, t = (at - b->at) / h;
    double m0 = (d->value[c] - a->value[c]) / (d->at - a->at) * h,
           m1 = (e->value[c] - b->value[c]) / (e->at - b->at) * h;
    double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * b->value[c] + (t3 - 2 * t2 + t) * m0 + (3 * t2 - 2 * t3) * d->value[c] +
           (t3 - t2) * m1;
}

static double natural(const Knot *a, const Knot *b, int c, double at)
{
    double h = b->at - a->at, p = (b->at - at) / h, q = (at - a->at) / h;
    return p * a->value[c] + q * b->value[c] +
           ((p * p * p - p) * a->second[c] + (q * q * q - q) * b->second[c]) * h * h / 6;
}

static double evaluate(const Spline *spline, int c, double at)
{
    const Knot *k = spline->knots;
    int n = spline->count;
    /* The first and last points of a cubic spline define slopes only. */
    int first = spline->kind == SPLINE_CUBIC && n > 3, last = n - 1 - first;
    if (isnan(at)) /* it is not below the first point, so a cubic would ask for one before that */
        return at;
    if (at <= k[first].at)
        return k[first].value[c];
    if (at >= k[last].at)
        return k[last].value[c];
    int low = 0, high = n - 1;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (k[middle].at <= at)
            low = middle;
        else
            high = middle;
    }
    if (spline->kind == SPLINE_QUADRATIC && n > 2) {
        int from = low > 0 ? low - 1 : 0;
        return quadratic(&k[from], &k[from + 1], &k[from + 2], c, at);
    }
    if (first)
        return cubic(&k[low - 1], &k[low], &k[low + 1], &k[low + 2], c, at);
    if (spline->kind == SPLINE_NATURAL)
        return natural(&k[low], &k[low + 1], c, at);
    return linear(&k[low], &k[low + 1], c, at);
}

static Num value_at(const Spline *spline, double at)
{
    Num num = {{0}, spline->components, 0};
    for (int c = 0; c < num.count; c++)
        num.n[c] = evaluate(spline, c, at);
    return num;
}

static void call_spline(const void *data, const double *args, double *results)
{
    const Num num = value_at(data, args[0]);
    memcpy(results, num.n, (size_t)num.count * sizeof *results);
}

FunctionForeign spline_foreign(const Value *value)
{
    return (FunctionForeign){call_spline, value->data, 1, ((const Spline *)value->data)->components};
}

Num spline_call(Sdl *sdl, const Value *value)
{
    const Spline *spline = value->data;
    sdl_expect(sdl, "(");
    double at = expression_parameter(sdl);
    if (sdl_accept(sdl, ",")) { /* another spline type for this call */
        static const char *const names[] = {"linear_spline", "quadratic_spline", "cubic_spline", "natural_spline"};
        Spline *changed = sdl_alloc(sdl, sizeof *changed);
        *changed = *spline;
        for (int i = 0; i < 4; i++)
            if (sdl_accept(sdl, names[i]))
                changed->kind = (SplineKind)i;
        if (changed->kind == SPLINE_NATURAL)
            solve_natural(sdl, changed);
        spline = changed;
    }
    sdl_expect(sdl, ")");
    return value_at(spline, at);
}
