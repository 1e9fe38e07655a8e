/* Floors of stone and fired clay. */
#include <math.h>
#include "generate.h"

enum { LONG = 1 << 14 };

/* Veins: the zero lines of a warped noise, thick and thin. */
static double veins(double x, double y, double scale, double width, int seed)
{
    double wx = fractal(x * scale * 0.8, y * scale * 0.8, LONG, LONG, 5, seed);
    double wy = fractal(x * scale * 0.8 + 31, y * scale * 0.8 + 17, LONG, LONG, 5, seed + 8);
    double n = fabs(fractal(x * scale + 1.1 * wx, (y * scale + 1.1 * wy) * 0.55, LONG, LONG, 4, seed + 16));
    double thick = width * (0.5 + 1.4 * clamp01(0.5 + noise(x * scale * 1.3, y * scale * 1.3, LONG, LONG, seed + 24)));
    return exp(-n * n / (thick * thick));
}

static Color white_marble(double x, double y)
{
    double cloud = fractal(x * 2.2, y * 2.2, LONG, LONG, 5, 40);
    Color color = color_mix(color_hex(0xe9e7e2), color_hex(0xc9c7c5), 0.35 + 0.75 * cloud);
    color = color_mix(color, color_hex(0x8f8f92), 0.55 * veins(x, y, 1.5, 0.035, 50));
    return color_mix(color, color_hex(0xa79c8c), 0.35 * veins(x + 9, y, 3.1, 0.03, 80));
}

static Color black_marble(double x, double y)
{
    double cloud = fractal(x * 3, y * 3, LONG, LONG, 5, 140);
    Color color = color_mix(color_hex(0x1a1a1c), color_hex(0x35353a), 0.3 + 0.7 * cloud);
    color = color_mix(color, color_hex(0xd8d4cc), 0.75 * veins(x, y, 1.6, 0.013, 150));
    return color_mix(color, color_hex(0x8d8478), 0.4 * veins(x + 5, y, 3.7, 0.02, 180));
}

/* 2 m by 2 m: four by four, black and white in turn. */
Color marble_tiles(double u, double v)
{
    enum { N = 4 };
    u = wrap(u, 1) * N;
    v = wrap(v, 1) * N;
    int i = (int)u, j = (int)v;
    double x = u - i, y = v - j, d = fmin(fmin(x, 1 - x), fmin(y, 1 - y)) * 0.5;
    double sx = x + 20 * hash(i, j, 41), sy = y + 20 * hash(i, j, 42);
    if (hash(i, j, 43) < 0.5) { /* turned by a quarter */
        double t = sx;
        sx = sy;
        sy = t;
    }
    Color color = (i + j) % 2 ? black_marble(sx, sy) : white_marble(sx, sy);
    color = color_scale(color, 0.94 + 0.12 * hash(i, j, 44));
    color = color_mix(color, color_scale(color, 0.8), step_smooth(0.0045, 0.002, d));
    return color_mix(color, color_hex(0x77726a), step_smooth(0.0024, 0.0016, d));
}

/* A petal from the origin along direction (dx, dy) of unit length: positive inside. */
static double petal(double x, double y, double dx, double dy, double length, double width)
{
    double along = x * dx + y * dy, across = fabs(x * dy - y * dx);
    if (along <= 0 || along >= length)
        return -1;
    double t = along / length;
    return width * 4 * t * (1 - t) * (0.6 + 0.4 * t) - across;
}

/* 2 m by 2 m: eight by eight tiles of one cast pattern, whose corners make rosettes with their neighbours. */
Color encaustic_tiles(double u, double v)
{
    enum { N = 8 };
    const Color cobalt = color_hex(0x23508c), cream = color_hex(0xece2cb), ochre = color_hex(0xd99a2b),
                brick_red = color_hex(0xa8452e), grout = color_hex(0x8d8577);
    double su = wrap(u, 1) * N, sv = wrap(v, 1) * N;
    int i = (int)su, j = (int)sv;
    double x = fabs(2 * (su - i) - 1), y = fabs(2 * (sv - j) - 1); /* one quadrant: 0 at the centre, 1 at the edge */
    double r = hypot(x, y), corner = hypot(1 - x, 1 - y);
    double edge = 0.006;

    Color color = cream;
    /* Ground: a cobalt lozenge with bowed sides. */
    double lozenge = 1.02 - pow(x, 1.35) - pow(y, 1.35);
    color = color_mix(color, cobalt, step_smooth(-edge, edge, lozenge));
    color = color_mix(color, cream, step_smooth(0.03 + edge, 0.03 - edge, fabs(lozenge - 0.10)) * (lozenge > 0));
    /* Eight petals about the centre, four of each colour. */
    double wide = fmax(petal(x, y, 1, 0, 0.80, 0.17), petal(x, y, 0, 1, 0.80, 0.17));
    double slant = petal(x, y, 0.7071, 0.7071, 0.60, 0.15);
    color = color_mix(color, cream, step_smooth(-edge, edge, slant));
    color = color_mix(color, ochre, step_smooth(-edge, edge, slant - 0.035));
    color = color_mix(color, cream, step_smooth(-edge, edge, wide));
    color = color_mix(color, brick_red, step_smooth(-edge, edge, wide - 0.035));
    color = color_mix(color, cream, step_smooth(0.17 + edge, 0.17 - edge, r));
    color = color_mix(color, cobalt, step_smooth(0.13 + edge, 0.13 - edge, r));
    color = color_mix(color, ochre, step_smooth(0.06 + edge, 0.06 - edge, r));
    /* Rosette in the corner, scalloped. */
    double scallop = 0.42 + 0.035 * cos(8 * atan2(1 - y, 1 - x));
    color = color_mix(color, brick_red, step_smooth(scallop + edge, scallop - edge, corner));
    color = color_mix(color, cream, step_smooth(0.33 + edge, 0.33 - edge, corner));
    double rays = step_smooth(-0.3, 0.3, cos(12 * atan2(1 - y, 1 - x)) + 0.4);
    color = color_mix(color, ochre, step_smooth(0.27 + edge, 0.27 - edge, corner) * rays);
    color = color_mix(color, cobalt, step_smooth(0.12 + edge, 0.12 - edge, corner));

    /* Wear: each tile a little other, the pigment cloudy and pitted. */
    double cloud = fractal(u * 24, v * 24, 24, 24, 4, 60);
    color = color_scale(color, (0.92 + 0.14 * hash(i, j, 61)) * (1 + 0.12 * cloud));
    color =
        color_mix(color, color_hex(0xb8ad99), 0.22 * step_smooth(0.25, 0.7, fractal(u * 90, v * 90, 90, 90, 2, 66)));
    double d = (1 - fmax(x, y)) * 0.125;
    return color_mix(color, grout, step_smooth(0.0022, 0.0012, d));
}

/* One layer of chips: cells cut apart by a straight-edged gap, some left out. */
static Color chips(Color ground, double u, double v, int cells, double share, double gap, int seed)
{
    static const unsigned colors[] = {0xc2553a, 0xe0a33a, 0x1f6f6b, 0x2b2f38, 0xd98e86, 0xf2ede2, 0x3f7f5a, 0x7b3f52};
    double wx = 0.10 * fractal(u * cells * 2, v * cells * 2, cells * 2, cells * 2, 2, seed + 5);
    Cell c = cell_at(u * cells + wx, v * cells - wx, cells, cells, 0.95, seed);
    if (hash(c.x, c.y, seed + 2) >= share)
        return ground;
    Color chip = color_hex(colors[(int)(8 * hash(c.x, c.y, seed + 3))]);
    double mottle = 0.25 * fractal(u * cells * 6, v * cells * 6, cells * 6, cells * 6, 3, seed + 9);
    chip = color_scale(chip, 0.85 + 0.3 * hash(c.x, c.y, seed + 4) + mottle);
    double size = 0.20 + 0.28 * hash(c.x, c.y, seed + 6);
    double inside = fmin((c.second - c.nearest) - gap, (size - c.nearest) * 1.5);
    return color_mix(ground, chip, step_smooth(0, 0.05, inside));
}

/* 2 m by 2 m: chips of marble in three sizes, ground flat. */
Color terrazzo(double u, double v)
{
    double cloud = fractal(u * 8, v * 8, 8, 8, 5, 70), grain = noise(u * 300, v * 300, 300, 300, 76);
    Color color = color_mix(color_hex(0xe4dccd), color_hex(0xcdc3b2), 0.4 + 0.7 * cloud);
    color = color_scale(color, 1 + 0.10 * grain);
    color = chips(color, u, v, 96, 0.55, 0.12, 200);
    color = chips(color, u, v, 44, 0.55, 0.10, 230);
    return chips(color, u, v, 20, 0.62, 0.08, 260);
}

/* 2 m by 2 m: slabs in a running bond, banded, filled pores. */
Color travertine(double u, double v)
{
    enum { ROWS = 4, COLUMNS = 2 };
    double y = wrap(v, 1) * ROWS;
    int row = (int)y;
    double x = wrap(u * COLUMNS + (row % 2 ? 0.5 : 0) + (row >= 2 ? 0.25 : 0), COLUMNS);
    int column = (int)x;
    x -= column;
    y -= row;
    double d = fmin(fmin(x, 1 - x) * 1.0, fmin(y, 1 - y) * 0.5);
    double sx = x * 2 + 30 * hash(column, row, 91), sy = y + 30 * hash(column, row, 92);
    double band = fractal(sx * 0.8, sy * 7 + 1.5 * fractal(sx, sy * 2, LONG, LONG, 3, 93), LONG, LONG, 5, 95);
    double pores = step_smooth(0.32, 0.5, fractal(sx * 12, sy * 40, LONG, LONG, 3, 98));
    Color color = color_mix(color_hex(0xdccbb0), color_hex(0xa98d69), 0.4 + 0.9 * band);
    color = color_mix(color, color_hex(0x7d6347), 0.6 * pores);
    color = color_scale(color, 0.9 + 0.2 * hash(column, row, 99));
    return color_mix(color, color_hex(0x8b7d6a), step_smooth(0.004, 0.0025, d));
}

/* 2 m by 2 m: six by six octagons of limestone, a small square of slate at every corner. */
Color octagon_tiles(double u, double v)
{
    enum { N = 6 };
    static const double side = 2.0 / N, reach = 0.19; /* of the slate's corners, in tiles */
    double x = wrap(u, 1) * N, y = wrap(v, 1) * N;
    int i = (int)x, j = (int)y, ci = (int)(x + 0.5), cj = (int)(y + 0.5);
    double corner = fabs(x - ci) + fabs(y - cj), d;
    Color color;
    if (corner < reach) {
        double grain = fractal(u * 60, v * 60, 60, 60, 4, 520);
        double tone = 0.85 + 0.3 * hash(ci % N, cj % N, 525);
        color = color_scale(color_mix(color_hex(0x3d4348), color_hex(0x565d60), 0.5 + 0.8 * grain), tone);
        d = (reach - corner) * 0.7071 * side;
    } else {
        double sx = x - i + 20 * hash(i, j, 500), sy = y - j + 20 * hash(i, j, 501);
        double cloud = fractal(sx * 1.6, sy * 1.6, LONG, LONG, 5, 502);
        double speck = step_smooth(0.22, 0.5, fractal(sx * 30, sy * 22, LONG, LONG, 3, 508));
        color = color_mix(color_hex(0xdfd5c2), color_hex(0xb9aa92), 0.4 + 0.75 * cloud);
        color = color_mix(color, color_hex(0x8d7d68), 0.40 * speck);
        color = color_mix(color, color_hex(0xa89a86), 0.5 * veins(sx, sy, 0.9, 0.02, 512));
        color = color_scale(color, 0.91 + 0.16 * hash(i, j, 515));
        d = fmin(fmin(fmin(x - i, i + 1 - x), fmin(y - j, j + 1 - y)), (corner - reach) * 0.7071) * side;
    }
    color = color_scale(color, 1 - 0.14 * step_smooth(0.007, 0.003, d));
    return color_mix(color, color_hex(0x857a6b), step_smooth(0.0028, 0.0016, d));
}
