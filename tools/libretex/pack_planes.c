/* Planes of whole numbers: prediction, and compression by blosc. See pack_planes.h.
 *
 * A chunk is a byte that says how its numbers are predicted and how many bytes a residual takes, then blosc's buffer of
 * the residuals, of which there are none where numbers do not matter. */
#include "pack_planes.h"

#include <string.h>

#include <blosc.h>

/* How a number is predicted where its left, upper and upper left neighbours matter. At an edge of what matters it is by
 * the left one, else the upper one, else the last one that was met in the row. */
typedef enum Predictor { BY_NOTHING, BY_LEFT, BY_UPPER, BY_GRADIENT, BY_MEDIAN, PREDICTORS } Predictor;

static int32_t add(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a + (uint32_t)b);
}

static int32_t subtract(int32_t a, int32_t b)
{
    return (int32_t)((uint32_t)a - (uint32_t)b);
}

/* The gradient, kept between the left and the upper neighbour. */
static int32_t median(int32_t left, int32_t upper, int32_t corner)
{
    const int32_t low = left < upper ? left : upper, high = left < upper ? upper : left;
    return corner >= high ? low : corner <= low ? high : add(left, subtract(upper, corner));
}

static inline int32_t predict(Predictor predictor, int32_t left, int32_t upper, int32_t corner)
{
    switch (predictor) {
    case BY_LEFT:
        return left;
    case BY_UPPER:
        return upper;
    case BY_GRADIENT:
        return add(left, subtract(upper, corner));
    case BY_MEDIAN:
        return median(left, upper, corner);
    default:
        return 0;
    }
}

static int32_t wrap_residual(int32_t value, int bits)
{
    return bits == 8 ? (int8_t)value : bits == 16 ? (int16_t)value : value;
}

/* Numbers of 8 bits are codes from 0, others have a sign. */
static int32_t wrap(int32_t value, int bits)
{
    return bits == 8 ? (uint8_t)value : bits == 16 ? (int16_t)value : value;
}

static uint32_t to_unsigned(int32_t residual)
{
    return ((uint32_t)residual << 1) ^ (uint32_t)(residual >> 31);
}

static int32_t from_unsigned(uint32_t code)
{
    return (int32_t)(code >> 1 ^ (0u - (code & 1)));
}

/* The prediction of number x of the row at `row`, which has one above it unless it is the first. */
static inline int32_t predict_at(const PackPlane *plane, Predictor predictor, size_t row, int x, int32_t last)
{
    const int32_t *n = plane->numbers + row;
    const unsigned char *present = plane->present ? plane->present + row : NULL;
    const ptrdiff_t above = -(ptrdiff_t)plane->width;
    const int left = x > 0 && (!present || present[x - 1]), upper = row > 0 && (!present || present[above + x]);
    if (left && upper && (!present || present[above + x - 1]))
        return predict(predictor, n[x - 1], n[above + x], n[above + x - 1]);
    if (predictor == BY_NOTHING)
        return 0;
    return left ? n[x - 1] : upper ? n[above + x] : last;
}

/* The multiple of 2^shift nearest to it, in those units. */
static int32_t in_steps(int32_t number, int shift)
{
    return shift ? add(number, 1 << (shift - 1)) >> shift : number;
}

static uint32_t residual_at(const PackPlane *plane, Predictor predictor, size_t row, int x, int32_t last)
{
    int32_t number = plane->numbers[row + (size_t)x], guess = predict_at(plane, predictor, row, x, last);
    if (plane->shift) {
        const int shift = plane->shift[row + (size_t)x];
        guess = in_steps(guess, shift);
        number >>= shift;
    }
    return to_unsigned(wrap_residual(subtract(number, guess), plane->bits));
}

size_t pack_plane_room(const PackPlane *plane)
{
    return (size_t)plane->width * (size_t)plane->rows * sizeof(int32_t) + BLOSC_MAX_OVERHEAD + 64;
}

static size_t count_present(const PackPlane *plane)
{
    const size_t all = (size_t)plane->width * (size_t)plane->rows;
    size_t count = plane->present ? 0 : all;
    for (size_t i = 0; plane->present && i < all; i++)
        count += plane->present[i] != 0;
    return count;
}

/* --- encoding --- */

/* Numbers as they will come back: multiples of their steps, 0 where they do not matter. 1 if one that matters is not 0.
 */
static int settle(const PackPlane *plane)
{
    int any = 0;
    for (size_t i = 0; i < (size_t)plane->width * (size_t)plane->rows; i++) {
        int32_t *number = &plane->numbers[i];
        if (plane->present && !plane->present[i])
            *number = 0;
        else if (plane->shift)
            *number = (int32_t)((uint32_t)in_steps(*number, plane->shift[i]) << plane->shift[i]);
        any = any || *number != 0;
    }
    return any;
}

/* Bits of all residuals, roughly. *largest gets the largest. */
static double cost(const PackPlane *plane, Predictor predictor, uint32_t *largest)
{
    double bits = 0;
    int32_t last = 0;
    *largest = 0;
    for (int y = 0; y < plane->rows; y++)
        for (int x = 0; x < plane->width; x++) {
            const size_t row = (size_t)y * (size_t)plane->width;
            if (plane->present && !plane->present[row + (size_t)x])
                continue;
            const uint32_t residual = residual_at(plane, predictor, row, x, last);
            last = plane->numbers[row + (size_t)x];
            *largest = residual > *largest ? residual : *largest;
            bits += 32 - __builtin_clz(residual | 1) - !residual;
        }
    return bits;
}

static void store_residuals(unsigned char *to, const PackPlane *plane, Predictor predictor, int bytes)
{
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++)
        for (int x = 0; x < plane->width; x++) {
            const size_t row = (size_t)y * (size_t)plane->width;
            if (plane->present && !plane->present[row + (size_t)x])
                continue;
            const uint32_t residual = residual_at(plane, predictor, row, x, last);
            last = plane->numbers[row + (size_t)x];
            for (int k = 0; k < bytes; k++)
                *to++ = (unsigned char)(residual >> 8 * k);
        }
}

long pack_plane_encode(unsigned char *data, const PackPlane *plane, unsigned char *scratch, int effort)
{
    const size_t room = pack_plane_room(plane);
    long best = -1;
    if (!settle(plane))
        return 0;
    double least = 0;
    Predictor chosen = BY_NOTHING;
    uint32_t largest = 0;
    for (int p = 0; p < PREDICTORS; p++) {
        uint32_t most;
        const double bits = cost(plane, (Predictor)p, &most);
        if (p == 0 || bits < least) {
            least = bits;
            chosen = (Predictor)p;
            largest = most;
        }
    }
    /* prediction makes runs and repetitions into noise: what has them may do better without */
    const Predictor tries[2] = {chosen, BY_NOTHING};
    unsigned char *other = scratch + room;
    for (int i = 0; i < (chosen == BY_NOTHING ? 1 : 2); i++) {
        uint32_t most = largest;
        if (i == 1)
            cost(plane, BY_NOTHING, &most);
        const int bytes = most < 256 ? 1 : most < 65536 ? 2 : 4;
        const size_t size = count_present(plane) * (size_t)bytes;
        unsigned char *to = i ? other : data;
        store_residuals(scratch, plane, tries[i], bytes);
        to[0] = (unsigned char)(bytes << 4 | tries[i]);
        const int got = blosc_compress_ctx(effort, bytes > 1, (size_t)bytes, size, scratch, to + 1, room - 1,
                                           BLOSC_ZSTD_COMPNAME, size, 1);
        if (got <= 0)
            return -1;
        if (best < 0 || got + 1 < best) {
            best = got + 1;
            if (i)
                memcpy(data, other, (size_t)best);
        }
    }
    return best;
}

/* --- decoding --- */

static inline uint32_t load(const unsigned char *from, int bytes)
{
    return bytes == 1   ? from[0]
           : bytes == 2 ? from[0] | (uint32_t)from[1] << 8
                        : from[0] | (uint32_t)from[1] << 8 | (uint32_t)from[2] << 16 | (uint32_t)from[3] << 24;
}

/* Where numbers are missing or have steps. */
static void restore_any(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++)
        for (int x = 0; x < plane->width; x++) {
            const size_t row = (size_t)y * (size_t)plane->width;
            int32_t *number = &plane->numbers[row + (size_t)x];
            if (plane->present && !plane->present[row + (size_t)x]) {
                *number = 0;
                continue;
            }
            const int shift = plane->shift ? plane->shift[row + (size_t)x] : 0;
            const int32_t guess = in_steps(predict_at(plane, predictor, row, x, last), shift);
            const int32_t sum = add(guess, from_unsigned(load(from, bytes)));
            *number = last = wrap((int32_t)((uint32_t)sum << shift), plane->bits);
            from += bytes;
        }
}

/* All numbers of a row but the first, by one predictor: what most of the time goes to. */
static inline void restore_row(int32_t *n, const int32_t *above, Predictor predictor, const unsigned char *from,
                               int bytes, int width, int bits)
{
    int32_t left = n[0];
    for (int x = 1; x < width; x++) {
        const int32_t guess = predict(predictor, left, above[x], above[x - 1]);
        n[x] = left = wrap(add(guess, from_unsigned(load(from + x * bytes, bytes))), bits);
    }
}

/* Where all numbers matter and have steps of 1. */
static void restore_all(PackPlane *plane, Predictor predictor, const unsigned char *from, int bytes)
{
    const int width = plane->width, bits = plane->bits;
    int32_t last = 0;
    for (int y = 0; y < plane->rows; y++) {
        const size_t row = (size_t)y * (size_t)width;
        int32_t *n = plane->numbers + row;
        for (int x = 0; x < (y == 0 ? width : 1); x++) {
            const int32_t guess = predict_at(plane, predictor, row, x, last);
            n[x] = last = wrap(add(guess, from_unsigned(load(from + x * bytes, bytes))), bits);
        }
        if (y > 0 && bytes == 1)
            restore_row(n, n - width, predictor, from, 1, width, bits);
        else if (y > 0 && bytes == 2)
            restore_row(n, n - width, predictor, from, 2, width, bits);
        else if (y > 0)
            restore_row(n, n - width, predictor, from, 4, width, bits);
        from += (size_t)width * (size_t)bytes;
    }
}

int pack_plane_decode(PackPlane *plane, const unsigned char *data, size_t bytes, unsigned char *scratch)
{
    const size_t all = (size_t)plane->width * (size_t)plane->rows;
    if (bytes == 0) {
        memset(plane->numbers, 0, all * sizeof *plane->numbers);
        return 1;
    }
    const int width = data[0] >> 4;
    const Predictor predictor = (Predictor)(data[0] & 15);
    const size_t size = count_present(plane) * (size_t)width;
    size_t unpacked;
    if ((width != 1 && width != 2 && width != 4) || predictor >= PREDICTORS || size == 0 ||
        bytes < 1 + BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(data + 1, bytes - 1, &unpacked) < 0 ||
        unpacked != size || blosc_decompress_ctx(data + 1, scratch, size, 1) != (int)size)
        return 0;
    if (plane->present || plane->shift)
        restore_any(plane, predictor, scratch, width);
    else
        restore_all(plane, predictor, scratch, width);
    return 1;
}
