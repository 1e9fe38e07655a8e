/* Functions that are distances of a kind: solids, helices, sums of bells. */
#include "function/internal.h"

static double square(double a)
{
    return a * a;
}

static double clamp_low(double a, double least)
{
    return a < least ? least : a;
}

/* ---- distances ---- */

double internal_r(const double *p)
{
    return sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
}

double internal_th(const double *p)
{
    return atan2(p[0], p[2]);
}

double internal_ph(const double *p)
{
    return atan2(sqrt(p[0] * p[0] + p[2] * p[2]), p[1]);
}

double internal_sphere(const double *p)
{
    return internal_r(p) - p[3];
}

double internal_ellipsoid(const double *p)
{
    const double scaled[3] = {p[0] * p[3], p[1] * p[4], p[2] * p[5]};
    return internal_r(scaled);
}

double internal_torus(const double *p)
{
    const double from_ring = sqrt(p[0] * p[0] + p[2] * p[2]) - p[3];
    return sqrt(from_ring * from_ring + p[1] * p[1]) - p[4];
}

double internal_superellipsoid(const double *p)
{
    const double e = 2 / p[3], n = 1 / p[4];
    const double round = pow(pow(fabs(p[0]), e) + pow(fabs(p[1]), e), p[3] * n);
    return 1 - pow(round + pow(fabs(p[2]), 2 * n), p[4] * 0.5);
}

/* How far p is outside of the box that remains when its edges are rounded. */
double internal_rounded_box(const double *p)
{
    double outside[3];
    for (int k = 0; k < 3; k++)
        outside[k] = clamp_low(fabs(p[k]) - (p[4 + k] - p[3]), 0);
    return internal_r(outside) - p[3] - 1e-6;
}

double internal_poly4(const double *p)
{
    const double y = p[1], y2 = y * y;
    const double radius = p[3] + p[4] * y + p[5] * y2 + p[6] * y2 * y + p[7] * y2 * y2;
    return sqrt(p[0] * p[0] + p[2] * p[2]) - clamp_low(radius, -5);
}

double internal_polytubes(const double *p)
{
    const double y = p[1], y2 = y * y;
    const double ring = p[4] + p[5] * y + p[6] * y2 + p[7] * y2 * y + p[8] * y2 * y2;
    const double count = trunc(fmin(p[3], 10000));
    double nearest = 10000;
    for (int i = 0; i < count; i++) {
        const double angle = 2 * PI / p[3] * i;
        nearest = fmin(nearest, sqrt(square(p[0] - ring * sin(angle)) + square(p[2] - ring * cos(angle))));
    }
    return nearest;
}

/* ---- hexagons: the cell that (x, y) is in, turned so that its nearest corner is at most 30 degrees away ---- */

static void hexagon(const double *p, double *x, double *y)
{
    const double half = sqrt(3.0) / 2;
    *x = fabs(fmod(fabs(p[0]), 2 * half) - half);
    *y = fabs(fmod(fabs(p[1]), 3) - 1.5);
    const double other_x = half - *x, other_y = 1.5 - *y;
    if (*x * *x + *y * *y > other_x * other_x + other_y * other_y) {
        *x = other_x;
        *y = other_y;
    }
}

double internal_hex_x(const double *p)
{
    double x, y;
    hexagon(p, &x, &y);
    return atan2(y, x) < PI / 6 ? x : cos(PI / 3) * x + sin(PI / 3) * y;
}

double internal_hex_y(const double *p)
{
    double x, y;
    hexagon(p, &x, &y);
    return atan2(y, x) < PI / 6 ? y : fabs(cos(PI / 3) * y - sin(PI / 3) * x);
}

/* ---- threads ---- */

/* The remainder, from 0 up to the period. */
static double wrap(double a, double period)
{
    const double rest = fmod(a, period);
    return rest < 0 ? rest + period : rest;
}

/* Minus the distance from a thread that runs along one axis at a, waving across by y. */
static double thread(double a, double spacing, double width, double y, double thickness)
{
    return -hypot(y * thickness, fabs(wrap(a, 2 * spacing) - spacing) * width);
}

/* Distances of threads in x and in z, relative thickness, amplitude of the weave, relative thickness in y */
double internal_mesh1(const double *p)
{
    const double x = p[0], y = p[1], z = p[2], dx = p[3], dz = p[4];
    const double over_z = cos(z * PI / dz) * p[6], over_x = cos(x * PI / dx) * p[6];
    const double along_z = fmax(thread(x, dx, p[5], y - over_z, p[7]), thread(x - dx, dx, p[5], y + over_z, p[7]));
    const double along_x = fmax(thread(z, dz, p[5], y + over_x, p[7]), thread(z - dz, dz, p[5], y - over_x, p[7]));
    return -fmax(along_z, along_x);
}

/* ---- helices ---- */

/* A cross section's radius at (a, b): 1 round, 0 square, others between and beyond. */
static double section(double a, double b, double type)
{
    if (type == 1)
        return sqrt(a * a + b * b);
    if (type == 0)
        return fmax(fabs(a), fabs(b));
    return pow(pow(fabs(a), 2 / type) + pow(fabs(b), 2 / type), type * 0.5);
}

/* The angle about the y axis; on the axis itself as if x were small. */
static double angle_about(double x, double z)
{
    return x == 0 && z == 0 ? 0 : atan2(z, x);
}

/* Count of helices, period, minor and major radius, shape, section, angle of the section */
double internal_helix1(const double *p)
{
    const double count = p[3], period = p[4], minor = p[5], major = p[6], shape = p[7], type = p[8];
    const double r = sqrt(p[0] * p[0] + p[2] * p[2]);
    const double turn = wrap(angle_about(p[0], p[2]) * count + p[1] * period * count, 2 * PI);
    double a = r - major, b = (turn - PI) / shape / (period * count);
    if (type != 1 && p[9] != 0) {
        const double c = cos(p[9] * (PI / 180)), s = sin(p[9] * (PI / 180)), turned = a * c - b * s;
        b = a * s + b * c;
        a = turned;
    }
    return fmin(major + r, section(a, b, type)) - minor;
}

/* unused, period, minor and major radius, unused, section, unused */
double internal_helix2(const double *p)
{
    const double c = cos(p[1] * p[4]), s = sin(p[1] * p[4]);
    const double x = p[0] - p[6] * c, z = p[2] - p[6] * s;
    return section(x * c + z * s, z * c - x * s, p[8]) - p[5];
}

/* Distance of windings, thickness, radius of the whole, unused, unused, section */
double internal_spiral(const double *p)
{
    const double step = p[3], r = sqrt(p[0] * p[0] + p[2] * p[2]);
    const double winding = fmod(r + step * angle_about(p[0], p[2]) / (2 * PI), step) - step * 0.5;
    /* on the axis POV-Ray takes x as 1e-6 */
    const double x = p[0] == 0 && p[2] == 0 ? 1e-6 : p[0], whole = sqrt(x * x + p[1] * p[1] + p[2] * p[2]);
    return -fmin(p[5] - whole, p[4] - fmin(section(winding, p[1], p[8]), whole));
}

double internal_helical_torus(const double *p)
{
    const double major = p[3], level = p[7], minor = p[8];
    const double r = sqrt(p[0] * p[0] + p[2] * p[2]), from_ring = r - major;
    const double turn = p[0] == 0 && p[2] == 0 ? PI / 2 : atan2(p[0], p[2]);
    const double radius = sqrt(from_ring * from_ring + p[1] * p[1]);
    const double winding = wrap(turn * p[4] + atan2(from_ring, p[1]) * p[5], 2 * PI) - PI;
    const double groove = atan2(winding * p[11], radius - minor);
    const double wave = cos(groove * p[10] + turn * p[12]) * p[6] + level;
    const double tube = fmin(sqrt(square(radius - minor) + winding * winding * p[9]), radius + minor);
    return -fmax(level + minor - major - r, wave - tube);
}

double internal_comma(const double *p)
{
    const double x = p[0] == 0 && p[2] == 0 ? 0.0001 : p[0], y = p[1], z = p[2], scale = p[3];
    const double ring = hypot(x + scale * 0.25, z) - scale * 0.75;
    const double tail = cos(atan2(z, x) * 0.5) * scale * 0.5 - sqrt(ring * ring + y * y);
    const double head = scale * 0.5 - sqrt(square(x - scale * 0.5) + z * z + y * y);
    return -fmax(fmin(z, tail), head);
}

/* ---- sums of bells ---- */

/* Separation; strength and inverse radius of the two */
double internal_blob(const double *p)
{
    const double half = p[3] * 0.5, across = p[1] * p[1] + p[2] * p[2];
    const double first = fmin(1, (square(p[0] + half) + across) * p[5] * p[5]);
    const double second = fmin(1, (square(p[0] - half) + across) * p[7] * p[7]);
    return -(p[4] * square(1 - first) + p[6] * square(1 - second));
}

/* Separation, inverse size, strength, threshold */
double internal_blob2(const double *p)
{
    const double across = p[1] * p[1] + p[2] * p[2];
    const double sum = exp(-(p[0] * p[0] + across) * p[4]) + exp(-(square(p[0] - p[3]) + across) * p[4]);
    return p[6] - sum * p[5];
}

/* Bells that are stretched along one axis each. */
static void bells(const double *p, double eccentricity, double inverse_size, double out[3])
{
    const double x = p[0] * p[0], y = p[1] * p[1], z = p[2] * p[2], e = eccentricity;
    out[0] = exp(-(x * e + y * e + z) * inverse_size);
    out[1] = exp(-(x * e + y + z * e) * inverse_size);
    out[2] = exp(-(x + y * e + z * e) * inverse_size);
}

double internal_cross_ellipsoids(const double *p)
{
    double bell[3];
    bells(p, p[3], p[4], bell);
    return p[6] - fmax(fmax(bell[0], bell[1]), bell[2]) * p[5];
}

double internal_isect_ellipsoids(const double *p)
{
    double bell[3];
    bells(p, p[3], p[4], bell);
    return p[6] - fmin(fmin(bell[0], bell[1]), bell[2]) * p[5];
}

double internal_flange_cover(const double *p)
{
    double bell[3];
    bells(p, p[3], p[4], bell);
    return p[6] - (bell[0] + bell[1] + bell[2]) * p[5];
}

/* Spikiness, hollowness, size, roundness, fatness */
double internal_spikes(const double *p)
{
    double bell[3];
    bells(p, p[3], p[4], bell);
    const double round = exp(-(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]) * p[6]) * p[7];
    return -(round - bell[0] - bell[1] - bell[2]) * p[5];
}

double internal_spikes_2d(const double *p)
{
    const double fall = exp(-p[6] * (p[0] * p[0] + p[2] * p[2]));
    return p[1] - p[3] * cos(p[4] * p[0]) * cos(p[5] * p[2]) * fall;
}

/* An orbital of the hydrogen atom. */
double internal_quantum(const double *p)
{
    const double across = p[0] == 0 && p[2] == 0 ? 1e-6 : sqrt(p[0] * p[0] + p[2] * p[2]);
    const double cosine = cos(atan2(across, p[1])), r = 2 * sqrt(across * across + p[1] * p[1]);
    const double amplitude = r * r * exp(-r * 0.33333333) * (3 * cosine * cosine - 1);
    return (amplitude * amplitude - 12) * -0.1;
}
