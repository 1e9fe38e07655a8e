/* How different two pictures are. Both must have the same size and 3 channels, scene-linear Rec.709. */
#ifndef RETEX_METRICS_H
#define RETEX_METRICS_H

#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexMetrics {
    double psnr;       /* dB, of sRGB-encoded values clipped to [0,1], not quantised; at most 120 */
    double relmse;     /* mean of (a-b)^2 / (b^2 + 0.01), linear; b is the reference */
    double mae;        /* mean |a-b|, linear */
    double flip_mean;  /* FLIP (Andersson et al. 2020), 67 pixels a degree; 0..1 */
    double flip_p99;
    double max_abs;    /* largest |a-b| */
    double max_rel;    /* largest |a-b| / max(|b|, 1e-3) */
    struct { int x, y; char channel; } worst; /* where max_abs is: 'R', 'G', 'B' */
    long nonfinite;    /* samples that are NaN or infinite in either picture; they count in no other figure */
} RetexMetrics;

int retex_metrics(RetexMetrics *metrics, const RetexImage *image, const RetexImage *reference, int nthreads,
                  RetexError *err);

/* The CIE 1976 L*a*b* of a scene-linear Rec. 709 colour, of which 1, 1, 1 is white, D65: L* from 0 to 100. */
void retex_lab(double lab[3], const double linear[3]);
/* The difference of two colours in L*a*b* as CIEDE2000, with all factors k of viewing conditions 1; about 1 is just
 * seen. */
double retex_delta_e(const double a[3], const double b[3]);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
