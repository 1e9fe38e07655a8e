/* What all textures are made of: colours, hashes, noise and cells. */
#include <math.h>
#include <retex/color.h>
#include "generate.h"

Color color_hex(unsigned srgb)
{
    return (Color){retex_srgb_decode((srgb >> 16 & 255) / 255.0), retex_srgb_decode((srgb >> 8 & 255) / 255.0),
                   retex_srgb_decode((srgb & 255) / 255.0)};
}

double clamp01(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

Color color_mix(Color a, Color b, double t)
{
    t = clamp01(t);
    return (Color){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

Color color_scale(Color a, double s)
{
    return (Color){a.r * s, a.g * s, a.b * s};
}

double step_smooth(double low, double high, double x)
{
    double t = clamp01((x - low) / (high - low));
    return t * t * (3 - 2 * t);
}

double wrap(double x, double period)
{
    return x - period * floor(x / period);
}

static int wrap_int(int x, int period)
{
    int r = x % period;
    return r < 0 ? r + period : r;
}

static unsigned mix(unsigned h)
{
    h ^= h >> 16;
    h *= 0x7feb352dU;
    h ^= h >> 15;
    h *= 0x846ca68bU;
    return h ^ h >> 16;
}

double hash(int x, int y, int seed)
{
    unsigned h = mix((unsigned)x + 0x9e3779b9U);
    h = mix(h ^ ((unsigned)y * 0x85ebca6bU + 0x165667b1U));
    h = mix(h ^ ((unsigned)seed * 0xc2b2ae35U + 0x27d4eb2fU));
    return h / 4294967296.0;
}

static double corner(int ix, int iy, double dx, double dy, int px, int py, int seed)
{
    double angle = 6.283185307179586 * hash(wrap_int(ix, px), wrap_int(iy, py), seed);
    return cos(angle) * dx + sin(angle) * dy;
}

double noise(double x, double y, int px, int py, int seed)
{
    int ix = (int)floor(x), iy = (int)floor(y);
    double fx = x - ix, fy = y - iy;
    double sx = fx * fx * fx * (fx * (fx * 6 - 15) + 10), sy = fy * fy * fy * (fy * (fy * 6 - 15) + 10);
    double low = corner(ix, iy, fx, fy, px, py, seed) * (1 - sx) + corner(ix + 1, iy, fx - 1, fy, px, py, seed) * sx;
    double high = corner(ix, iy + 1, fx, fy - 1, px, py, seed) * (1 - sx) +
                  corner(ix + 1, iy + 1, fx - 1, fy - 1, px, py, seed) * sx;
    return low * (1 - sy) + high * sy;
}

double fractal(double x, double y, int px, int py, int octaves, int seed)
{
    double sum = 0, amplitude = 1;
    for (int i = 0; i < octaves; i++) {
        sum += amplitude * noise(x, y, px, py, seed + i);
        x *= 2;
        y *= 2;
        px *= 2;
        py *= 2;
        amplitude *= 0.5;
    }
    return sum;
}

Cell cell_at(double x, double y, int px, int py, double jitter, int seed)
{
    Cell cell = {9, 9, 0, 0};
    int ix = (int)floor(x), iy = (int)floor(y);
    for (int j = iy - 2; j <= iy + 2; j++)
        for (int i = ix - 2; i <= ix + 2; i++) {
            int wx = wrap_int(i, px), wy = wrap_int(j, py);
            double dx = i + 0.5 + jitter * (hash(wx, wy, seed) - 0.5) - x;
            double dy = j + 0.5 + jitter * (hash(wx, wy, seed + 1) - 0.5) - y;
            double d = sqrt(dx * dx + dy * dy);
            if (d < cell.nearest) {
                cell.second = cell.nearest;
                cell.nearest = d;
                cell.x = wx;
                cell.y = wy;
            } else if (d < cell.second) {
                cell.second = d;
            }
        }
    return cell;
}
