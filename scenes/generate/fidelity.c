/* Textures for tests of fidelity: each is hard, or easy, for one reason. */
#include <math.h>
#include <string.h>
#include "generate.h"

/* 32 by 32 squares. */
Color checker(double u, double v)
{
    double s = ((int)(wrap(u, 1) * 32) + (int)(wrap(v, 1) * 32)) % 2 ? 0.9 : 0.05;
    return (Color){s, s, s};
}

/* Eight by eight pale tiles between dark joints of 1/400 of the picture: 2.5 pixels of 1024. */
Color grout(double u, double v)
{
    enum { N = 8 };
    double x = wrap(u, 1) * N, y = wrap(v, 1) * N;
    int i = (int)x, j = (int)y;
    double d = fmin(fmin(x - i, i + 1 - x), fmin(y - j, j + 1 - y)) / N;
    if (d < 0.5 / 400)
        return color_hex(0x2a2825);
    return color_scale(color_hex(0xe6e1d6), 0.94 + 0.06 * hash(i, j, 700));
}

/* Letters of five by seven, a byte a row from the top, the lowest bit to the right. */
static const unsigned char letters[26][7] = {
    {0x0e, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11}, {0x1e, 0x11, 0x11, 0x1e, 0x11, 0x11, 0x1e},
    {0x0e, 0x11, 0x10, 0x10, 0x10, 0x11, 0x0e}, {0x1e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x1e},
    {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x1f}, {0x1f, 0x10, 0x10, 0x1e, 0x10, 0x10, 0x10},
    {0x0e, 0x11, 0x10, 0x17, 0x11, 0x11, 0x0f}, {0x11, 0x11, 0x11, 0x1f, 0x11, 0x11, 0x11},
    {0x0e, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}, {0x07, 0x02, 0x02, 0x02, 0x02, 0x12, 0x0c},
    {0x11, 0x12, 0x14, 0x18, 0x14, 0x12, 0x11}, {0x10, 0x10, 0x10, 0x10, 0x10, 0x10, 0x1f},
    {0x11, 0x1b, 0x15, 0x15, 0x11, 0x11, 0x11}, {0x11, 0x19, 0x15, 0x13, 0x11, 0x11, 0x11},
    {0x0e, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}, {0x1e, 0x11, 0x11, 0x1e, 0x10, 0x10, 0x10},
    {0x0e, 0x11, 0x11, 0x11, 0x15, 0x12, 0x0d}, {0x1e, 0x11, 0x11, 0x1e, 0x14, 0x12, 0x11},
    {0x0f, 0x10, 0x10, 0x0e, 0x01, 0x01, 0x1e}, {0x1f, 0x04, 0x04, 0x04, 0x04, 0x04, 0x04},
    {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x0e}, {0x11, 0x11, 0x11, 0x11, 0x11, 0x0a, 0x04},
    {0x11, 0x11, 0x11, 0x15, 0x15, 0x1b, 0x11}, {0x11, 0x11, 0x0a, 0x04, 0x0a, 0x11, 0x11},
    {0x11, 0x11, 0x0a, 0x04, 0x04, 0x04, 0x04}, {0x1f, 0x01, 0x02, 0x04, 0x08, 0x10, 0x1f},
};
static const unsigned char point[7] = {0, 0, 0, 0, 0, 0x0c, 0x0c}, comma[7] = {0, 0, 0, 0, 0x0c, 0x04, 0x08};

#define TEXT_COLUMNS 38 /* of which the first is the margin */
#define TEXT_ROWS 26
static const char *const page[TEXT_ROWS] = {
    "A LAMP IS LIT AND ITS LIGHT GOES",
    "OUT. SOME OF IT MEETS THE FLOOR,",
    "TAKES THE COLOUR OF A BOARD, AND",
    "LEAVES FOR THE WALL, WHERE IT WILL",
    "BE SEEN AS A SHADE OF BROWN THAT",
    "NOBODY PAINTED. SOME OF IT PASSES",
    "A GLASS AND DRAWS A BRIGHT LINE ON",
    "THE TABLE. SOME OF IT IS LOST.",
    "",
    "WHOEVER LOOKS INTO THE ROOM SEES",
    "ALL OF THIS AT ONCE, AND THINKS OF",
    "A ROOM, NOT OF THE LIGHT.",
    "",
    "NOW LAY ANOTHER FLOOR. EVERY WAY",
    "THAT THE LIGHT WENT, IT GOES AGAIN.",
    "THE BOARD IS A TILE, THE BROWN IS",
    "A GREY, AND THE LINE ON THE TABLE",
    "IS WHERE IT WAS. IF YOU KNOW WHERE",
    "EACH RAY TOUCHED THE FLOOR, AND HOW",
    "MUCH IT CARRIED, YOU CAN SAY WHAT",
    "THE NEW ROOM LOOKS LIKE. YOU NEED",
    "NOT LIGHT THE LAMP A SECOND TIME.",
    "",
    "QUICK WAXY JUDGES VEX A BLOKE WHO",
    "PAINTS FJORDS, GLYPHS AND MAZES.",
    "",
};

/* A printed page, black on white. */
Color text(double u, double v)
{
    double x = wrap(u, 1) * TEXT_COLUMNS, y = (1 - wrap(v, 1)) * TEXT_ROWS;
    int column = (int)x - 1, row = y < TEXT_ROWS ? (int)y : TEXT_ROWS - 1, ink = 0;
    int dot_x = (int)((x - 1 - column) * 6.5), dot_y = (int)((y - row) * 10 - 1.5);
    if (column >= 0 && column < (int)strlen(page[row]) && dot_x < 5 && dot_y >= 0 && dot_y < 7) {
        char c = page[row][column];
        const unsigned char *glyph = c >= 'A' && c <= 'Z' ? letters[c - 'A']
                                     : c == '.'           ? point
                                     : c == ','           ? comma
                                                          : NULL;
        ink = glyph && glyph[dot_y] >> (4 - dot_x) & 1;
    }
    double s = ink ? 0.02 : 0.85;
    return (Color){s, s, s};
}

/* Red and blue halves, as strong as the colour space allows, each with four lighter bands. */
Color saturated(double u, double v)
{
    double s = wrap(v * 4, 1) < 0.5 ? 0.9 : 0.55;
    return wrap(u, 1) < 0.5 ? (Color){s, 0, 0} : (Color){0, 0, s};
}

Color constant(double u, double v)
{
    (void)u;
    (void)v;
    return (Color){0.35, 0.42, 0.28};
}

/* Slate, nearly black: reflects three hundredths. */
Color dark(double u, double v)
{
    enum { N = 6 };
    double x = wrap(u, 1) * N, y = wrap(v, 1) * N;
    int i = (int)x, j = (int)y;
    double d = fmin(fmin(x - i, i + 1 - x), fmin(y - j, j + 1 - y));
    double layers = fractal(u * 12, v * 40, 12, 40, 5, 720);
    Color color = color_mix((Color){0.022, 0.024, 0.028}, (Color){0.050, 0.048, 0.046}, 0.4 + 0.8 * layers);
    color = color_scale(color, 0.65 + 0.7 * hash(i, j, 730));
    return color_mix(color, (Color){0.008, 0.008, 0.009}, step_smooth(0.024, 0.014, d));
}

/* Twice as wide as high: land and sea, ice at the poles, a line every fifteen degrees. */
Color globe(double u, double v)
{
    double latitude = fabs(v - 0.5) * 2;
    double height = fractal(u * 6, v * 3 + 40, 6, 4096, 6, 740) + 0.04;
    double moist = fractal(u * 8, v * 4 + 20, 8, 4096, 4, 750);
    Color sea = color_mix(color_hex(0x0f3f78), color_hex(0x4d9fc4), step_smooth(-0.25, 0.02, height));
    Color land =
        color_mix(color_hex(0xd8b56a), color_hex(0x3f7d3a), step_smooth(-0.25, 0.2, moist + latitude * 0.5 - 0.2));
    land = color_mix(land, color_hex(0x8a5b3c), step_smooth(0.18, 0.45, height));
    Color color = color_mix(sea, land, step_smooth(0.018, 0.026, height));
    color = color_mix(color, color_hex(0x5c4326), 0.7 * step_smooth(0.014, 0.006, fabs(height - 0.022)));
    color = color_mix(color, color_hex(0xeef2f4), step_smooth(0.80, 0.84, latitude + 0.12 * height));
    double meridian = fabs(wrap(u * 24 + 0.5, 1) - 0.5) / 24, parallel = fabs(wrap(v * 12 + 0.5, 1) - 0.5) / 24;
    double thin = fmin(meridian * sin(3.141592653589793 * clamp01(v)), parallel);
    return color_mix(color, color_hex(0x3a2f28), 0.6 * step_smooth(0.0011, 0.0004, thin));
}

/* 4 m by 4 m: cobbles of all shades with sand between. */
Color cobbles(double u, double v)
{
    enum { N = 20 };
    static const unsigned stones[] = {0xb9a58b, 0x8d8b88, 0x6d6a68, 0xa56d4f, 0xc8c0b2, 0x7c7f88};
    double warp = 0.12 * fractal(u * 40, v * 40, 40, 40, 3, 760);
    Cell cell = cell_at(u * N + warp, v * N - warp, N, N, 0.55, 765);
    Color stone = color_hex(stones[(int)(6 * hash(cell.x, cell.y, 770))]);
    double rough = fractal(u * 120, v * 120, 120, 120, 4, 775);
    stone = color_scale(stone, (0.75 + 0.5 * hash(cell.x, cell.y, 771)) * (1 + 0.25 * rough));
    double d = cell.second - cell.nearest;
    stone = color_scale(stone, 0.75 + 0.25 * step_smooth(0.10, 0.3, d));
    return color_mix(color_scale(color_hex(0x6b5a42), 1 + 0.4 * rough), stone, step_smooth(0.06, 0.11, d));
}
