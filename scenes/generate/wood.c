/* Floors of wood. Boards are cut from one grain function, each at a place of its own. */
#include <math.h>
#include "generate.h"

enum { LONG = 1 << 14 }; /* a period that no board reaches the end of */

typedef struct Wood {
    Color light, dark, pore;
    double rings; /* a metre across the board */
    double tone;  /* how much boards differ, 0..1 */
    double knots; /* chance a board has one */
} Wood;

/* x across, y along the board, both in metres; length is the board's. */
static Color wood_at(const Wood *wood, double x, double y, double length, int board)
{
    double shift = 40 * hash(board, 1, 7);
    double px = x + shift, py = y + 3 * shift;

    /* Cathedrals: growth rings cut at a slant, bent slowly along the board. */
    double bend = 0.020 * fractal(px * 7, py * 1.1, LONG, LONG, 3, 11) + 0.003 * noise(px * 60, py * 3, LONG, LONG, 15);
    double across = px + bend + (hash(board, 2, 7) - 0.5) * 0.12 * (y / length - 0.5);

    double knot_shade = 0;
    if (hash(board, 3, 7) < wood->knots) {
        double kx = 0.03 + 0.1 * hash(board, 4, 7), ky = length * (0.15 + 0.7 * hash(board, 5, 7));
        double dx = (x - kx) / 0.012, dy = (y - ky) / 0.03;
        double near = exp(-0.22 * (dx * dx + dy * dy));
        across += 0.022 * near * (dx > 0 ? 1 : -1) * (1 - exp(-dx * dx));
        knot_shade = exp(-1.1 * (dx * dx * 1.6 + dy * dy * 2.2));
    }

    double phase = across * wood->rings * (0.7 + 0.6 * hash(board, 6, 7));
    double ring = wrap(phase, 1);
    double late = step_smooth(0.25, 0.92, ring) * step_smooth(1.0, 0.93, ring); /* slow to darken, quick to lighten */
    double figure = fractal(px * 24, py * 1.6, LONG, LONG, 4, 21);
    double pores = step_smooth(0.18, 0.5, noise(px * 420, py * 9, LONG, LONG, 31) + 0.25 * late);
    double fine = fractal(px * 260, py * 14, LONG, LONG, 2, 35);

    double tone = wood->tone * (hash(board, 8, 7) - 0.5);
    Color color = color_mix(wood->light, wood->dark, 0.32 + 0.42 * late + 0.35 * figure + 0.16 * fine + 0.75 * tone);
    color = color_mix(color, wood->pore, 0.38 * pores + 0.85 * knot_shade);
    double warm = 1 + 0.10 * (hash(board, 9, 7) - 0.5);
    return (Color){color.r * warm, color.g, color.b / warm};
}

/* How near the edge of a board (distance d, metres): the dark joint and the bevel beside it. */
static Color joint(Color color, double d)
{
    color = color_scale(color, 1 - 0.25 * step_smooth(0.004, 0.001, d));
    return color_mix(color, color_hex(0x1c120b), 0.88 * step_smooth(0.0016, 0.0006, d));
}

/* 2 m by 2 m: twelve rows of boards along v, two boards a row. */
Color oak_planks(double u, double v)
{
    enum { ROWS = 12 };
    static const double side = 2, width = 2.0 / ROWS;
    const Wood oak = {color_hex(0xd9b88a), color_hex(0x9c6f42), color_hex(0x6b4727), 95, 0.75, 0.22};
    u = wrap(u, 1);
    int row = (int)(u * ROWS);
    double x = u * side - row * width;
    double first = side * hash(row, 0, 3),
           length = 0.75 + 0.5 * hash(row, 1, 3); /* where the row's first board starts */
    double y = wrap(v * side - first, side);
    int second = y >= length;
    if (second) {
        y -= length;
        length = side - length;
    }
    double d = fmin(fmin(x, width - x), fmin(y, length - y));
    return joint(wood_at(&oak, x, y, length, 2 * row + second), d);
}

/* 2 m by 2 m: blocks of one by four, laid at 45 degrees. */
Color walnut_herringbone(double u, double v)
{
    enum { N = 12, RATIO = 4 };
    static const double unit = 2 / (N * 1.4142135623730951); /* width of a block in metres */
    const Wood walnut = {color_hex(0x8a6044), color_hex(0x3f2718), color_hex(0x22140c), 70, 0.95, 0.05};
    double a = (u + v) * N, b = (u - v) * N;
    int ia = (int)floor(a), ib = (int)floor(b);
    int k = (int)wrap(ia - ib, 2 * RATIO);
    int lying = k < RATIO;
    int start_a = lying ? ia - k : ia, start_b = lying ? ib : ib - (2 * RATIO - 1 - k);
    double x = (lying ? b - start_b : a - start_a) * unit, y = (lying ? a - start_a : b - start_b) * unit;
    int board = (int)wrap(start_a + start_b, 2 * N) * 64 + (int)wrap(start_a - start_b, 2 * N) + 9000 * lying;
    double d = fmin(fmin(x, unit - x), fmin(y, RATIO * unit - y));
    return joint(wood_at(&walnut, x, y, RATIO * unit, board), d * 1.4);
}
