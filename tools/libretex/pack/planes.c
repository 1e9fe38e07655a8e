/* Planes of integers: prediction, then compression by blosc. See planes.h.
 *
 * A slice begins with a byte: the predictor in the low 4 bits, the bytes of a residual in the high 4 bits. Then follow
 * the residuals of the present pixels, compressed by blosc. */
#include "pack/planes.h"

#include <string.h>

#include <blosc.h>

#include "pack/restore.h"

static const int TRIAL_EFFORT = 1; /* blosc's effort when predictors are compared */

static int32_t wrap_residual(int32_t value, int bits)
{
    return bits == 8 ? (int8_t)value : bits == 16 ? (int16_t)value : value;
}

static uint32_t residual_at(const RetexPackPlane *plane, RetexPackPredictor predictor, size_t row, int x, int32_t last)
{
    int32_t number = plane->numbers[row + (size_t)x], guess = predict_at(plane, predictor, row, x, last);
    if (plane->shift) {
        const int shift = plane->shift[row + (size_t)x];
        guess = in_steps(guess, shift);
        number >>= shift;
    }
    return zigzag_encode(wrap_residual(subtract(number, guess), plane->bits));
}

size_t retex_pack_plane_bound(const RetexPackPlane *plane)
{
    return (size_t)plane->width * (size_t)plane->rows * sizeof(int32_t) + BLOSC_MAX_OVERHEAD + 64;
}

/* --- encoding --- */

/* Round numbers to multiples of 2^shift, as the decoder will return them; absent ones become 0. Returns 1 if any number
 * is not 0. */
static int quantize(const RetexPackPlane *plane)
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

/* Estimate the bits of all residuals. *largest: the largest residual. */
static double cost(const RetexPackPlane *plane, RetexPackPredictor predictor, uint32_t *largest)
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

/* Store the residuals, `bytes` bytes each, little-endian. Returns their size in bytes. */
static size_t store_residuals(unsigned char *to, const RetexPackPlane *plane, RetexPackPredictor predictor, int bytes)
{
    const unsigned char *const begin = to;
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
    return (size_t)(to - begin);
}

static int residual_bytes(uint32_t largest)
{
    return largest < 256 ? 1 : largest < 65536 ? 2 : 4;
}

/* Write a slice: header byte and compressed residuals. Returns its bytes, or -1. */
static long compress_residuals(unsigned char *to, const RetexPackPlane *plane, RetexPackPredictor predictor,
                               uint32_t largest, unsigned char *scratch, int effort)
{
    const int bytes = residual_bytes(largest);
    const size_t size = store_residuals(scratch, plane, predictor, bytes);
    to[0] = (unsigned char)(bytes << 4 | predictor);
    const int got = blosc_compress_ctx(effort, bytes > 1, (size_t)bytes, size, scratch, to + 1,
                                       retex_pack_plane_bound(plane) - 1, BLOSC_ZSTD_COMPNAME, size, 1);
    return got > 0 ? got + 1 : -1;
}

/* The predictor whose residuals take the fewest bits. largest: by predictor. */
static RetexPackPredictor choose_predictor(const RetexPackPlane *plane, uint32_t largest[PREDICTORS])
{
    double least = 0;
    RetexPackPredictor chosen = BY_NOTHING;
    for (int p = 0; p < PREDICTORS; p++) {
        const double bits = cost(plane, (RetexPackPredictor)p, &largest[p]);
        if (p == 0 || bits < least) {
            least = bits;
            chosen = (RetexPackPredictor)p;
        }
    }
    return chosen;
}

size_t retex_pack_plane_residuals(unsigned char *to, const RetexPackPlane *plane, int *predictor, int *bytes)
{
    uint32_t largest[PREDICTORS];
    *predictor = *bytes = 0;
    if (!quantize(plane))
        return 0;
    const RetexPackPredictor chosen = choose_predictor(plane, largest);
    *predictor = chosen;
    *bytes = residual_bytes(largest[chosen]);
    return store_residuals(to, plane, chosen, *bytes);
}

long retex_pack_plane_encode(unsigned char *data, const RetexPackPlane *plane, unsigned char *scratch, int effort)
{
    if (!quantize(plane))
        return 0;
    uint32_t largest[PREDICTORS];
    RetexPackPredictor chosen = choose_predictor(plane, largest);
    /* prediction destroys repeated sequences, so planes with repetitions may compress better without it */
    if (chosen != BY_NOTHING) {
        const long with = compress_residuals(data, plane, chosen, largest[chosen], scratch, TRIAL_EFFORT);
        const long without = compress_residuals(data, plane, BY_NOTHING, largest[BY_NOTHING], scratch, TRIAL_EFFORT);
        if (with < 0 || without < 0)
            return -1;
        chosen = without < with ? BY_NOTHING : chosen;
    }
    return compress_residuals(data, plane, chosen, largest[chosen], scratch, effort);
}

/* --- decoding --- */

/* Set all present numbers to 0. */
static void clear(const RetexPackPlane *plane)
{
    const size_t width = (size_t)plane->width, size = plane->bits == 8 ? 1 : sizeof *plane->numbers;
    char *const to = plane->bits == 8 ? (char *)plane->codes : (char *)plane->numbers;
    if (!plane->present)
        memset(to, 0, width * (size_t)plane->rows * size);
    for (size_t y = 0; plane->present && y < (size_t)plane->rows; y++)
        for (int k = plane->runs->first[y]; k < plane->runs->first[y + 1]; k++) {
            const RetexRowSpan run = plane->runs->run[k];
            memset(to + (y * width + (size_t)run.begin) * size, 0, (size_t)(run.end - run.begin) * size);
        }
}

int retex_pack_plane_decode(const RetexPackPlane *plane, const unsigned char *data, size_t bytes,
                            unsigned char *scratch)
{
    if (bytes == 0) {
        clear(plane);
        return 1;
    }
    const size_t pixels = plane->present ? plane->runs->pixels : (size_t)plane->width * (size_t)plane->rows;
    const int width = data[0] >> 4;
    const RetexPackPredictor predictor = (RetexPackPredictor)(data[0] & 15);
    const size_t size = pixels * (size_t)width;
    size_t unpacked;
    if ((width != 1 && width != 2 && width != 4) || 8 * width > plane->bits || predictor >= PREDICTORS || size == 0 ||
        bytes < 1 + BLOSC_MIN_HEADER_LENGTH || blosc_cbuffer_validate(data + 1, bytes - 1, &unpacked) < 0 ||
        unpacked != size || blosc_decompress_ctx(data + 1, scratch, size, 1) != (int)size)
        return 0;
    retex_pack_restore(plane, predictor, scratch, width);
    return 1;
}
