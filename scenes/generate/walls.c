/* Wall coverings. */
#include <math.h>
#include "generate.h"

/* 1 m by 1 m: a painted weave, pale. */
Color linen(double u, double v)
{
    double slub_u = fractal(u * 160, v * 6, 160, 6, 2, 300), slub_v = fractal(u * 6, v * 160, 6, 160, 2, 310);
    double cloud = fractal(u * 3, v * 3, 3, 3, 4, 320);
    double t = 0.45 + 0.30 * slub_u + 0.30 * slub_v + 0.25 * cloud;
    return color_mix(color_hex(0xb9c4b4), color_hex(0x92a592), t);
}

/* A leaf from (x0, y0), its spine bowed; positive inside. */
static double leaf(double x, double y, double x0, double y0, double degrees, double length, double width, double bow)
{
    double a = degrees * 0.017453292519943295, dx = x - x0, dy = y - y0;
    double along = (dx * sin(a) + dy * cos(a)) / length, across = dx * cos(a) - dy * sin(a);
    if (along <= 0 || along >= 1)
        return -1;
    across -= bow * along * along * length;
    return width * pow(sin(3.141592653589793 * pow(along, 0.75)), 0.8) - fabs(across);
}

static double join(double a, double b)
{
    return a > b ? a : b;
}

/* One damask motif, x from its axis to the right (0..1), y -1..1: positive on the figure. */
static double damask_motif(double across, double y)
{
    double figure = -1, x = across * 0.68;
    /* The palmette: a fan of leaves with gaps, over a bud. */
    for (int k = 0; k < 5; k++)
        figure = join(figure, leaf(x, y, 0.02 * k, -0.12 + 0.015 * k, 24.0 * k, 0.55 - 0.055 * k, 0.068, 0.05 * k));
    figure = join(figure, 0.055 - hypot(x, (y + 0.17) * 1.1));
    figure = join(figure, leaf(x, y, 0, 0.50, 0, 0.30, 0.055, 0));
    figure = join(figure, leaf(x, y, 0, 0.52, 38, 0.22, 0.04, 0.25));
    /* The stem, and two pairs of acanthus leaves. */
    figure = join(figure, y < -0.18 && y > -0.98 ? 0.018 - fabs(x - 0.015 * sin(9 * y)) : -1);
    figure = join(figure, leaf(x, y, 0.0, -0.72, 60, 0.52, 0.062, -0.55));
    figure = join(figure, leaf(x, y, 0.0, -0.48, 74, 0.40, 0.052, -0.60));
    figure = join(figure, leaf(x, y, 0.0, -0.95, 66, 0.34, 0.045, -0.50));
    /* Veins let the ground show. */
    double vein = fabs(leaf(x, y, 0.0, -0.72, 60, 0.52, 0.062, -0.55) - 0.062);
    if (vein < 0.006)
        figure = fmin(figure, vein - 0.006);
    /* The ogee that frames it, with a string of beads beside. */
    double side = 0.5 + 0.46 * cos(3.141592653589793 * y) * (0.9 + 0.1 * cos(3.141592653589793 * y));
    double from = (across - side) * 0.55;
    figure = join(figure, 0.022 - fabs(from));
    double bead = hypot(fabs(from) - 0.062, (wrap(y * 16, 1) - 0.5) / 16);
    return join(figure, 0.017 - bead);
}

/* 1 m by 1 m: two by two ogees, every second column dropped by half. */
Color damask(double u, double v)
{
    enum { N = 2 };
    double x = wrap(u, 1) * 2 * N, y = wrap(v, 1) * N;
    int column = (int)x;
    double sx = fabs(2 * (x - column) - 1);
    double best = damask_motif(sx, 2 * wrap(y + (column % 2 ? 0.5 : 0), 1) - 1);
    double silk = 0.5 * noise(u * 256, v * 24, 256, 24, 330) + 0.25 * noise(u * 512, v * 48, 512, 48, 331);
    double cloud = fractal(u * 4, v * 4, 4, 4, 3, 335);
    Color ground = color_scale(color_hex(0x1d4a4d), 1 + 0.22 * silk + 0.12 * cloud);
    Color figure = color_scale(color_hex(0xc9a961), 1 + 0.16 * silk + 0.18 * cloud);
    return color_mix(ground, figure, step_smooth(-0.006, 0.006, best));
}

/* 1 m by 1 m: overlapping fans of concentric arcs. */
Color fans(double u, double v)
{
    enum { N = 5 };
    const Color navy = color_hex(0x1c2b4f), gold = color_hex(0xd3a550), blush = color_hex(0xe2a79b),
                teal = color_hex(0x2d7d83);
    double x = wrap(u, 1) * N, y = wrap(v, 1) * 4 * N;
    /* Rows lie half a radius apart, every second shifted by half; a lower row covers the one above. */
    for (int row = (int)floor(y) - 1; row <= (int)floor(y); row++) {
        double shift = (row & 1) ? 0.5 : 0;
        double dx = x - shift - floor(x - shift + 0.5), dy = (y - row) * 0.25;
        double r = hypot(dx, dy) / 0.5;
        if (r > 1.0)
            continue;
        double lot = hash((int)wrap(floor(x - shift + 0.5), N), (int)wrap(row, 4 * N), 340);
        Color fill = lot < 0.28 ? teal : lot < 0.45 ? blush : navy;
        double band = fabs(wrap(r * 5 + 0.5, 1) - 0.5); /* 0 on a line */
        Color color = color_mix(gold, fill, step_smooth(0.13, 0.17, band));
        color = color_mix(color, gold, step_smooth(0.955, 0.965, r));
        double spokes = fabs(wrap(atan2(dx, dy) / 0.314159 + 0.5, 1) - 0.5) * r;
        if (r > 0.6 && r < 0.8)
            color = color_mix(gold, fill, step_smooth(0.06, 0.085, spokes));
        return color_scale(color, 1 + 0.08 * fractal(u * 64, v * 64, 64, 64, 3, 345));
    }
    return navy;
}

/* 1 m by 1 m: four bricks by fourteen courses. */
Color brick(double u, double v)
{
    enum { COURSES = 14, COUNT = 4 };
    double warp_u = 0.0022 * fractal(u * 20, v * 20, 20, 20, 3, 350),
           warp_v = 0.0022 * fractal(u * 20, v * 20, 20, 20, 3, 355);
    double y = wrap(v + warp_v, 1) * COURSES;
    int course = (int)y;
    double x = wrap((u + warp_u) * COUNT + (course % 2 ? 0.5 : 0), COUNT);
    int index = (int)x;
    x -= index;
    y -= course;
    double dx = fmin(x, 1 - x) / COUNT, dy = fmin(y, 1 - y) / COURSES, radius = 0.008;
    double d =
        dx < radius && dy < radius ? radius - hypot(radius - dx, radius - dy) : fmin(dx, dy); /* rounded corners */

    static const unsigned fired[] = {0x9c4a33, 0xa8553a, 0x8a3d2c, 0xb5694b, 0x7a3a30, 0xa04f3e};
    Color color = color_hex(fired[(int)(6 * hash(index, course, 360))]);
    double rough = fractal(u * 48, v * 48, 48, 48, 4, 362);
    color = color_scale(color, (0.85 + 0.3 * hash(index, course, 361)) * (1 + 0.35 * rough));
    color =
        color_mix(color, color_hex(0x4a2a24), 0.6 * step_smooth(0.15, 0.6, fractal(u * 90, v * 90, 90, 90, 3, 367)));
    Color mortar = color_scale(color_hex(0xb3aca0), 1 + 0.25 * fractal(u * 120, v * 120, 120, 120, 3, 372));
    mortar = color_scale(mortar,
                         0.72 + 0.28 * step_smooth(0.006, 0.001, d)); /* the joint lies back, in shade near the brick */
    return color_mix(mortar, color, step_smooth(0.0052, 0.0068, d + 0.0012 * rough));
}

/* 1 m by 1 m: ten by ten squares cut and glazed by hand, no two of one green. */
Color zellige(double u, double v)
{
    enum { N = 10 };
    static const unsigned glazes[] = {0x2e6f68, 0x3f877c, 0x5aa093, 0x276058, 0x4b8f8b, 0x6fae9d};
    double warp_u = 0.0016 * fractal(u * 26, v * 26, 26, 26, 3, 530),
           warp_v = 0.0016 * fractal(u * 26, v * 26, 26, 26, 3, 535);
    double x = wrap(u + warp_u, 1) * N, y = wrap(v + warp_v, 1) * N;
    int i = (int)x, j = (int)y;
    x -= i;
    y -= j;
    Color glaze = color_mix(color_hex(glazes[(int)(6 * hash(i, j, 540))]),
                            color_hex(glazes[(int)(6 * hash(i, j, 541))]), hash(i, j, 542));
    /* The glaze ran while it was soft: a slope over the tile, clouds, and thin where it pooled away from the edge. */
    double slope = (hash(i, j, 543) - 0.5) * (x - 0.5) + (hash(i, j, 544) - 0.5) * (y - 0.5);
    double cloud = fractal(u * 30 + 0.7 * hash(i, j, 545), v * 30, 30, 30, 4, 546);
    glaze = color_scale(glaze, (0.86 + 0.34 * hash(i, j, 547)) * (1 + 0.55 * slope + 0.20 * cloud));
    double d = fmin(fmin(x, 1 - x), fmin(y, 1 - y));
    glaze = color_mix(glaze, color_scale(glaze, 1.35), 0.7 * step_smooth(0.09, 0.03, d + 0.02 * cloud));
    double chip = fractal(u * 90, v * 90, 90, 90, 3, 550);
    glaze = color_mix(glaze, color_hex(0xb08a6a), step_smooth(0.042, 0.034, d - 0.028 * fmax(chip, 0)) * 0.9);
    Color grout = color_scale(color_hex(0xcfc8ba), 1 + 0.2 * chip);
    return color_mix(grout, glaze, step_smooth(0.014, 0.024, d));
}
