/* The data of the shape poly. */
#ifndef RENDERER_SHAPE_POLY_H
#define RENDERER_SHAPE_POLY_H

/* The coefficients of x^i y^j z^k, i + j + k <= degree: i, j and k go down, k fastest, which is POV-Ray's order. */
typedef struct Poly {
    int degree; /* 2..POLYNOMIAL_DEGREE */
    double c[];
} Poly;

static inline int poly_terms(int degree)
{
    return (degree + 1) * (degree + 2) * (degree + 3) / 6;
}

#endif
