/* The difference of two colours as CIEDE2000: G. Sharma, W. Wu and E. N. Dalal, 'The CIEDE2000 color-difference
 * formula: implementation notes, supplementary test data, and mathematical observations' (2005). See
 * <retex/metrics.h>. */
#include "base/delta_e.h"

#include <math.h>

#include <retex/metrics.h>

static const double DEGREE = 3.14159265358979323846 / 180;

static double lab_root(double t)
{
    return t > 216.0 / 24389 ? cbrt(t) : (24389.0 / 27 * t + 16) / 116;
}

void retex_lab(double lab[3], const double linear[3])
{
    static const double xyz[3][3] = {
        {0.4123908, 0.3575843, 0.1804808}, {0.2126390, 0.7151687, 0.0721923}, {0.0193308, 0.1191948, 0.9505322}};
    double root[3];
    for (int i = 0; i < 3; i++) {
        const double white = xyz[i][0] + xyz[i][1] + xyz[i][2];
        root[i] = lab_root((xyz[i][0] * linear[0] + xyz[i][1] * linear[1] + xyz[i][2] * linear[2]) / white);
    }
    lab[0] = 116 * root[1] - 16;
    lab[1] = 500 * (root[0] - root[1]);
    lab[2] = 200 * (root[1] - root[2]);
}

/* c^7 / (c^7 + 25^7). */
static double chroma_share(double c)
{
    return pow(c, 7) / (pow(c, 7) + pow(25, 7));
}

/* The hue in degrees, 0 to 360. */
static double hue_of(double a, double b)
{
    const double hue = a == 0 && b == 0 ? 0 : atan2(b, a) / DEGREE;
    return hue < 0 ? hue + 360 : hue;
}

void retex_delta_e_parts(double parts[3], const double a[3], const double b[3])
{
    const double grey = 1.5 - 0.5 * sqrt(chroma_share((hypot(a[1], a[2]) + hypot(b[1], b[2])) / 2));
    const double chroma1 = hypot(grey * a[1], a[2]), chroma2 = hypot(grey * b[1], b[2]);
    const double hue1 = hue_of(grey * a[1], a[2]), hue2 = hue_of(grey * b[1], b[2]);
    const int grays = chroma1 * chroma2 == 0;
    const double turn = hue2 - hue1;
    const double hue_turn = grays ? 0 : turn > 180 ? turn - 360 : turn < -180 ? turn + 360 : turn;
    const double lightness = (a[0] + b[0]) / 2, chroma = (chroma1 + chroma2) / 2;
    const double hue = grays               ? hue1 + hue2
                       : fabs(turn) <= 180 ? (hue1 + hue2) / 2
                                           : (hue1 + hue2 + (hue1 + hue2 < 360 ? 360 : -360)) / 2;
    const double t = 1 - 0.17 * cos((hue - 30) * DEGREE) + 0.24 * cos(2 * hue * DEGREE) +
                     0.32 * cos((3 * hue + 6) * DEGREE) - 0.20 * cos((4 * hue - 63) * DEGREE);
    const double middle = (lightness - 50) * (lightness - 50);
    const double dl = (b[0] - a[0]) / (1 + 0.015 * middle / sqrt(20 + middle));
    const double dc = (chroma2 - chroma1) / (1 + 0.045 * chroma);
    const double dh = 2 * sqrt(chroma1 * chroma2) * sin(hue_turn / 2 * DEGREE) / (1 + 0.015 * chroma * t);
    const double blue = exp(-(hue - 275) / 25 * ((hue - 275) / 25));
    const double turned = -sqrt(chroma_share(chroma)) * sin(60 * blue * DEGREE);
    parts[0] = dl;
    parts[1] = dc + turned * dh;
    parts[2] = sqrt(1 - turned * turned) * dh;
}

double retex_delta_e(const double a[3], const double b[3])
{
    double parts[3];
    retex_delta_e_parts(parts, a, b);
    return sqrt(parts[0] * parts[0] + parts[1] * parts[1] + parts[2] * parts[2]);
}
