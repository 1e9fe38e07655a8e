/* Noise over space: each point of the integer lattice has a value and a gradient, blended by smooth steps between them.
 * Generators 1 and 2 take both from one list of numbers, at a place that a hash of the lattice point gives; 2 stretches
 * the result so that it fills 0 to 1. Generator 3 is Perlin's: unit gradients, no values.
 *
 * The tables are made as POV-Ray's were: by its linear congruential generator, and the list of numbers as checksums of
 * lattice points. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>
#include <retex/host/cpu.h>
#include "base/noise.h"

enum { HASHES = 4096, NUMBERS = 267, GRADIENTS = 2048, RANDOMS = HASHES + 2 };

static uint16_t hash[2 * HASHES]; /* a permutation, twice */
static double numbers[NUMBERS];
static int permutation[2 * (GRADIENTS + 1)];
static Vec3 gradients[2 * (GRADIENTS + 1)];
static uint32_t randoms[RANDOMS];

/* ---- tables ---- */

/* 15 bits of POV-Ray's generator. */
static int next_random(uint32_t *state)
{
    *state = *state * 1812433253u + 12345u;
    return (int)(*state >> 16 & 0x7fff);
}

static void make_hash(void)
{
    uint32_t state = 0;
    for (int i = 0; i < HASHES; i++)
        hash[i] = (uint16_t)i;
    for (int i = HASHES - 1; i >= 0; i--) {
        const int j = next_random(&state) % HASHES;
        const uint16_t swapped = hash[i];
        hash[i] = hash[j];
        hash[j] = swapped;
    }
    memcpy(hash + HASHES, hash, HASHES * sizeof *hash);
}

/* CRC-16 of the coordinates of a point, as big-endian doubles. */
static unsigned checksum(double coordinate)
{
    uint64_t bits;
    unsigned crc = 0;
    memcpy(&bits, &coordinate, sizeof bits);
    for (int byte = 0; byte < 24; byte++) {
        crc ^= (unsigned)(bits >> (56 - byte % 8 * 8)) & 0xff;
        for (int k = 0; k < 8; k++)
            crc = crc & 1 ? crc >> 1 ^ 0xa001 : crc >> 1;
    }
    return crc;
}

/* Checksums of points on the diagonal, as numbers of -1 to 1 with six significant digits. */
static void make_numbers(void)
{
    for (int i = 0; i < NUMBERS; i++) {
        const double value = checksum(i * 0.12345) * (2.0 / 65535) - 1;
        const double unit = pow(10, 5 - floor(log10(fabs(value))));
        numbers[i] = rint(value * unit) / unit;
    }
}

/* Random unit vectors, and a shuffle that is no permutation, for it also swaps with an entry beyond the end, of 0. */
static void make_gradients(void)
{
    uint32_t state = 1;
    for (int i = 0; i < GRADIENTS; i++) {
        double v[3], square;
        do {
            for (int k = 0; k < 3; k++)
                v[k] = (next_random(&state) % (2 * GRADIENTS) - GRADIENTS) / (double)GRADIENTS;
            square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
        } while (square > 1 || square < 1e-5);
        gradients[i] = vec_scale(vec3(v[0], v[1], v[2]), 1 / sqrt(square));
    }
    for (int i = 0; i < GRADIENTS; i++)
        permutation[i] = i;
    for (int i = GRADIENTS; i > 0; i -= 2) {
        const int j = next_random(&state) % GRADIENTS, swapped = permutation[i];
        permutation[i] = permutation[j];
        permutation[j] = swapped;
    }
    for (int i = 0; i < GRADIENTS + 2; i++) {
        permutation[GRADIENTS + i] = permutation[i];
        gradients[GRADIENTS + i] = gradients[i];
    }
}

/* The Mersenne Twister MT19937 of its usual seed. */
static void make_randoms(void)
{
    enum { STATE = 624, SHIFT = 397 };
    uint32_t state[STATE] = {5489};
    for (uint32_t i = 1; i < STATE; i++)
        state[i] = 1812433253u * (state[i - 1] ^ state[i - 1] >> 30) + i;
    for (int i = 0; i < RANDOMS; i++) {
        const int at = i % STATE;
        const uint32_t joined = (state[at] & 0x80000000u) | (state[(at + 1) % STATE] & 0x7fffffffu);
        uint32_t x = state[at] = state[(at + SHIFT) % STATE] ^ joined >> 1 ^ (joined & 1 ? 0x9908b0dfu : 0);
        x ^= x >> 11;
        x ^= x << 7 & 0x9d2c5680u;
        x ^= x << 15 & 0xefc60000u;
        randoms[i] = x ^ x >> 18;
    }
}

static atomic_int ready;
static RetexCpuLevel level; /* of vector instructions */

static void make_tables(void)
{
    make_hash();
    make_numbers();
    make_gradients();
    make_randoms();
    level = retex_cpu_level();
    atomic_store_explicit(&ready, 1, memory_order_release);
}

static inline void need_tables(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    if (!atomic_load_explicit(&ready, memory_order_acquire))
        pthread_once(&once, make_tables);
}

/* ---- generators 1 and 2, and the noise of vectors ---- */

/* A coordinate's cell, and where in it the point is. The cell of a whole negative number is that number, and so is that
 * of a number less than 1e-10 below it. Numbers beyond the range of int have the cell of the least one. */
RETEX_CPU_INLINE unsigned cell_of(double x, double *at)
{
    const double down = x >= 0 ? x : x - (1 - 1e-10);
    const int cell = fabs(down) < 2147483648.0 ? (int)down : INT32_MIN;
    *at = x - cell;
    return ((unsigned)cell + 10000u) & (HASHES - 1);
}

RETEX_CPU_INLINE double smooth_step(double t)
{
    return t * t * (3 - 2 * t);
}

/* A corner's value and gradient lie side by side in the list, and so do what they are multiplied with: a half, and the
 * way from the corner to the point. */
typedef double Four __attribute__((vector_size(32)));

typedef struct Corners {
    Four factors[8]; /* by corner: x fastest, then y; with its weight */
    const double *numbers[8];
} Corners;

RETEX_CPU_INLINE void find_corners(Vec3 p, Corners *c)
{
    double x, y, z;
    const unsigned ix = cell_of(p.x, &x), iy = cell_of(p.y, &y), iz = cell_of(p.z, &z);
    const double sx = smooth_step(x), sy = smooth_step(y), sz = smooth_step(z);
    const double wx[2] = {1 - sx, sx}, wy[2] = {1 - sy, sy}, wz[2] = {1 - sz, sz};
    const Four from = {0.5, x, y, z};
    const unsigned row[2] = {hash[ix], hash[ix + 1]};
#pragma GCC unroll 4
    for (unsigned i = 0; i < 4; i++) {
        const unsigned up_x = i & 1, up_y = i >> 1, column = hash[row[up_x] ^ (iy + up_y)];
        const double weight = wx[up_x] * wy[up_y];
        const Four below = from - (Four){0, up_x, up_y, 0}, above = from - (Four){0, up_x, up_y, 1};
        c->numbers[i] = &numbers[hash[column ^ iz] & 0xff];
        c->numbers[i + 4] = &numbers[hash[column ^ (iz + 1)] & 0xff];
        c->factors[i] = below * (weight * wz[0]);
        c->factors[i + 4] = above * (weight * wz[1]);
    }
}

/* The sum over corners, of the numbers from an offset on. */
RETEX_CPU_INLINE double sum_corners(const Corners *c, int offset)
{
    Four sum = {0, 0, 0, 0};
#pragma GCC unroll 8
    for (int i = 0; i < 8; i++) {
        Four n;
        memcpy(&n, c->numbers[i] + offset, sizeof n);
        sum += n * c->factors[i];
    }
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

RETEX_CPU_INLINE void lattice_noise_body(double x, double y, double z, double *noise)
{
    Corners corners;
    find_corners(vec3(x, y, z), &corners);
    *noise = sum_corners(&corners, 0);
}
RETEX_CPU_KERNEL(lattice_noise, (double x, double y, double z, double *noise), (x, y, z, noise))

RETEX_CPU_INLINE void lattice_vector_body(double x, double y, double z, Vec3 *noise)
{
    Corners corners;
    find_corners(vec3(x, y, z), &corners);
    *noise = vec3(sum_corners(&corners, 0), sum_corners(&corners, 4), sum_corners(&corners, 8));
}
RETEX_CPU_KERNEL(lattice_vector, (double x, double y, double z, Vec3 *noise), (x, y, z, noise))

static inline double lattice_noise(Vec3 p)
{
    double noise;
    lattice_noise_by_level[level](p.x, p.y, p.z, &noise);
    return noise;
}

/* ---- generator 3 ---- */

static inline int gradient_cell(double x, double *at)
{
    const double moved = x + 10000000.023157213, whole = floor(moved); /* away from 0, where points often lie */
    const int cell = fabs(whole) < 2147483648.0 ? (int)whole : INT32_MIN;
    *at = moved - cell;
    return cell & (GRADIENTS - 1);
}

static inline double blend(double t, double a, double b)
{
    return a + t * (b - a);
}

static double perlin_noise(Vec3 p)
{
    Vec3 at;
    const int x0 = gradient_cell(p.x, &at.x), y0 = gradient_cell(p.y, &at.y), z0 = gradient_cell(p.z, &at.z);
    const int x1 = (x0 + 1) & (GRADIENTS - 1), y1 = (y0 + 1) & (GRADIENTS - 1), z1 = (z0 + 1) & (GRADIENTS - 1);
    const double sx = smooth_step(at.x), sy = smooth_step(at.y), sz = smooth_step(at.z);
    double layer[2];
    for (int up_z = 0; up_z < 2; up_z++) {
        double row[2];
        for (int up_y = 0; up_y < 2; up_y++) {
            const int y = up_y ? y1 : y0, z = up_z ? z1 : z0;
            const Vec3 a = vec3(at.x, at.y - up_y, at.z - up_z), b = vec3(at.x - 1, a.y, a.z);
            row[up_y] = blend(sx, vec_dot(a, gradients[permutation[permutation[x0] + y] + z]),
                              vec_dot(b, gradients[permutation[permutation[x1] + y] + z]));
        }
        layer[up_z] = blend(sy, row[0], row[1]);
    }
    return blend(sz, layer[0], layer[1]);
}

/* ---- the calls ---- */

double noise_value(Vec3 p, int generator)
{
    double value;
    need_tables();
    if (generator == NOISE_PERLIN)
        value = 0.5 * (1.59 * perlin_noise(p) + 0.985);
    else if (generator == NOISE_RANGE_CORRECTED)
        value = (lattice_noise(p) + 1.05242) * 0.48985582;
    else
        value = lattice_noise(p) + 0.5;
    return value > 0 ? value < 1 ? value : 1 : 0; /* also of points that are not finite */
}

Vec3 noise_vector(Vec3 p)
{
    Vec3 noise;
    if (!vec_is_finite(p))
        return vec3(0, 0, 0);
    need_tables();
    lattice_vector_by_level[level](p.x, p.y, p.z, &noise);
    return noise;
}

int noise_octaves(double octaves)
{
    return octaves >= 10 ? 10 : octaves >= 1 ? (int)octaves : 1;
}

/* POV-Ray keeps lambda and omega as floats. */
Vec3 noise_turbulence(Vec3 p, double lambda, double omega, double octaves)
{
    const int count = noise_octaves(octaves);
    Vec3 sum = noise_vector(p);
    double frequency = (float)lambda, share = (float)omega;
    for (int i = 1; i < count; i++) {
        sum = vec_mad(sum, noise_vector(vec_scale(p, frequency)), share);
        frequency *= (float)lambda;
        share *= (float)omega;
    }
    return sum;
}

static inline unsigned lattice_index(double x)
{
    return (fabs(x) < 2147483648.0 ? (unsigned)(int)x : 0x80000000u) & (HASHES - 1);
}

Vec3 noise_cell(Vec3 cell)
{
    need_tables();
    const unsigned x = lattice_index(cell.x), y = lattice_index(cell.y), z = lattice_index(cell.z);
    const uint32_t *random = &randoms[hash[hash[hash[x] ^ y] ^ z]];
    return vec3(random[0] * 0x1p-32, random[1] * 0x1p-32, random[2] * 0x1p-32);
}
