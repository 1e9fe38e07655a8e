/* The data of the shape sor. */
#ifndef RENDERER_SHAPE_SOR_H
#define RENDERER_SHAPE_SOR_H

/* rho^2 = c[0] + c[1] v + c[2] v^2 + c[3] v^3 with v = y - low, up to high. */
typedef struct SorSegment {
    double low, high, c[4];
    double end;         /* rho^2 at high: the very number at which the next segment begins */
    double least, most; /* of rho^2 */
} SorSegment;

typedef struct Sor {
    int count;
    double low, high, radius; /* in y; the largest rho */
    SorSegment segments[];
} Sor;

void sor_set_bounds(Sor *sor); /* of segments and all */

#endif
