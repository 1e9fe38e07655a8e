/* What hangs and lies in the living room: pictures of their own, not tiling. */
#include <math.h>
#include "generate.h"

/* A woven rug, 3 wide to 2 high: a border, a field, three medallions; in knots. */
Color rug(double u, double v)
{
    const Color ground = color_hex(0x8e2f2a), cream = color_hex(0xe0d3b8), indigo = color_hex(0x26395c),
                gold = color_hex(0xc08a3c);
    enum { KNOTS_U = 300, KNOTS_V = 200 };
    int i = (int)(u * KNOTS_U), j = (int)(v * KNOTS_V);
    double x = fabs((i + 0.5) / KNOTS_U * 3 - 1.5), y = fabs((j + 0.5) / KNOTS_V * 2 - 1); /* mirrored quarters */
    double edge = fmin(1.5 - x, 1 - y);

    Color color = ground;
    for (int k = 0; k < 2; k++) { /* stepped medallions: distances in the taxicab metric */
        double d = fabs(x - 0.82 * k) * 1.1 + y * 0.85;
        double size = k ? 0.40 : 0.55;
        if (d < size)
            color = d > size - 0.05   ? cream
                    : d > size - 0.14 ? indigo
                    : d > size - 0.19 ? gold
                    : d > size - 0.30 ? ground
                    : d > size - 0.36 ? cream
                                      : indigo;
    }
    double sprig = fabs(wrap(x * 8, 1) - 0.5) + fabs(wrap(y * 8, 1) - 0.5); /* the field's scatter */
    if (color.r == ground.r && edge > 0.34 && sprig < 0.17)
        color = hash((int)(x * 8), (int)(y * 8), 400) < 0.5 ? gold : cream;
    if (edge < 0.30) {
        double along = 1.5 - x < 1 - y ? y : x;
        double tooth = fabs(wrap(along * 7.5, 1) - 0.5) * 2;
        color = edge < 0.03                            ? indigo
                : edge < 0.05                          ? cream
                : edge > 0.28                          ? cream
                : edge > 0.25                          ? gold
                : fabs(edge - 0.15) * 9 + tooth < 0.85 ? gold
                : fabs(edge - 0.15) * 9 + tooth < 1.02 ? cream
                                                       : indigo;
    }
    double knot = 0.90 + 0.20 * hash(i, j, 410), abrash = 1 + 0.10 * noise(1.5, j * 0.06, 64, 64, 411);
    double lx = u * KNOTS_U - i - 0.5, ly = v * KNOTS_V - j - 0.5;
    return color_scale(color, knot * abrash * (1 - 0.5 * (lx * lx + ly * ly)));
}

/* A painting, 4 wide to 3 high: hills behind one another in evening light. */
Color painting(double u, double v)
{
    Color color = color_mix(color_hex(0xf0b96e), color_hex(0x41607f), step_smooth(0.45, 1.0, v));
    double sun = hypot((u - 0.66) * 4 / 3, v - 0.66);
    color = color_mix(color, color_hex(0xf8e6b8), step_smooth(0.095, 0.09, sun));
    color = color_mix(color, color_hex(0xf6d08e), 0.5 * exp(-sun * 7));
    static const unsigned hills[] = {0x8e8a99, 0x6d7086, 0x4b6470, 0x39574f, 0x2b3f33};
    for (int k = 0; k < 5; k++) {
        double top = 0.60 - 0.115 * k +
                     (0.16 - 0.02 * k) * fractal(u * (2.0 + k * 0.8) + 7 * k, 0.5, 4096, 4096, 4, 420 + 9 * k);
        Color hill = color_mix(color_hex(hills[k]), color_hex(0xd99f6f),
                               0.35 * step_smooth(0.06, 0.0, top - v) * (1 - k * 0.18));
        color = color_mix(color, hill, step_smooth(top + 0.002, top - 0.002, v));
    }
    double stroke = fractal(u * 24 + 4 * v, v * 90, 4096, 4096, 3, 470);
    return color_scale(color, 1 + 0.22 * stroke);
}
