/* The scenes' textures, as functions of (u, v). Every one is periodic in both with period 1 (the pictures excepted),
 * u to the right, v up, and depends on nothing but its arguments, so that the files come out the same each time. */
#ifndef SCENES_GENERATE_H
#define SCENES_GENERATE_H

/* Scene-linear Rec.709. */
typedef struct Color { double r, g, b; } Color;

Color color_hex(unsigned srgb);               /* 0xRRGGBB, sRGB-encoded */
Color color_mix(Color a, Color b, double t);  /* t is clamped to 0..1 */
Color color_scale(Color a, double s);

double clamp01(double x);
double step_smooth(double low, double high, double x); /* 0 below low, 1 above high; low > high falls instead */
double wrap(double x, double period);                  /* into [0, period) */

/* Uniform in [0, 1), from whole numbers. */
double hash(int x, int y, int seed);
/* Gradient noise, about -0.7..0.7, on a lattice that repeats after px, py cells. */
double noise(double x, double y, int px, int py, int seed);
/* Octaves of it, each of half the amplitude and twice the frequency; about -1..1. */
double fractal(double x, double y, int px, int py, int octaves, int seed);

/* The nearest of one jittered point a cell on a lattice of px by py cells. */
typedef struct Cell {
    double nearest, second;  /* distances, in cells */
    int x, y;                /* the nearest point's cell, within the period */
} Cell;
Cell cell_at(double x, double y, int px, int py, double jitter, int seed);

Color oak_planks(double u, double v);
Color walnut_herringbone(double u, double v);

Color marble_tiles(double u, double v);
Color encaustic_tiles(double u, double v);
Color terrazzo(double u, double v);
Color travertine(double u, double v);
Color octagon_tiles(double u, double v);

Color linen(double u, double v);
Color damask(double u, double v);
Color fans(double u, double v);
Color brick(double u, double v);
Color zellige(double u, double v);

Color rug(double u, double v);
Color painting(double u, double v);

/* For tests of fidelity, and for their scenes. */
Color checker(double u, double v);
Color grout(double u, double v);
Color text(double u, double v);
Color saturated(double u, double v);
Color constant(double u, double v);
Color dark(double u, double v);
Color globe(double u, double v); /* periodic in u only */
Color cobbles(double u, double v);

/* Fill a square image whose side is a power of two with stones and leaves on the ground, detail at every scale. */
struct RetexImage;
int photo(struct RetexImage *image); /* not 0: out of memory */

#endif
