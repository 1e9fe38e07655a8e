/* See deflate.h. */
#include "deflate.h"

#include <limits.h>
#include <math.h>
#include <zlib.h>

enum {
    LEVEL = 1,
    STORED = 0, /* as a level */
    BLOCK = 16384,
    BLOCKS_MAX = 64,
    STRIDE = 7,   /* of the bytes that are looked at: prime to how many samples and pixels take, and to most widths */
    REPEATS = 16, /* where one byte of so many, or more, is as the one before, there may be runs */
    STEPS = 20    /* that are tried as limits */
};
#define LIMIT_STEP 0.005

/* What of the bytes is coded, and what is stored as it is. */
typedef struct Plan {
    size_t block; /* bytes of each block; the last may have fewer */
    int count;
    double saved[BLOCKS_MAX]; /* by coding: share of the block's bytes */
    double limit;             /* blocks that save less are stored */
} Plan;

/* Of at least 1; within 1e-5, and the same on every machine. */
static double log2_of(double x)
{
    int exponent;
    const double m = frexp(x, &exponent), y = (m - M_SQRT1_2) / (m + M_SQRT1_2), y2 = y * y;
    return exponent - 0.5 + 2 * M_LOG2E * y * (1 + y2 * (1.0 / 3 + y2 * (1.0 / 5)));
}

/* What bytes take, coded each by how often it comes, as a share of what they take as they are: the entropy of some of
 * them, which is too small for so few by half a value seen over all that were looked at (Miller 1955). */
static double find_entropy(const unsigned char *bytes, size_t count, int *has_runs)
{
    unsigned seen[256] = {0}, n = 0, values = 0, repeats = 0;
    double sum = 0;

    for (size_t i = 0; i + 1 < count; i += STRIDE, n++) {
        seen[bytes[i]]++;
        repeats += bytes[i] == bytes[i + 1];
    }
    for (int k = 0; k < 256; k++)
        if (seen[k])
            sum += seen[k] * log2_of(seen[k]), values++;
    *has_runs = repeats * REPEATS >= n;
    return n ? (log2_of(n) - sum / n + M_LOG2E * 0.5 * (values - 1) / n) / 8 : 0;
}

static double lost(const Plan *plan, double limit)
{
    double sum = 0;

    for (int k = 0; k < plan->count; k++)
        sum += plan->saved[k] < limit ? plan->saved[k] : 0;
    return sum;
}

static void make_plan(Plan *plan, const unsigned char *bytes, size_t count, double give)
{
    double coded = 0;

    plan->block = count / BLOCKS_MAX + 1 < BLOCK ? BLOCK : count / BLOCKS_MAX + 1;
    plan->count = (int)((count + plan->block - 1) / plan->block);
    for (int k = 0; k < plan->count; k++) {
        const size_t at = (size_t)k * plan->block;
        int has_runs;
        const double entropy =
            find_entropy(bytes + at, count - at < plan->block ? count - at : plan->block, &has_runs);
        plan->saved[k] = has_runs ? 1 : 1 - entropy;
        coded += entropy;
    }
    plan->limit = STEPS * LIMIT_STEP;
    for (int k = STEPS - 1; k >= 0 && lost(plan, plan->limit) > give * coded; k--)
        plan->limit = k * LIMIT_STEP;
}

size_t retex_deflate_room(size_t bytes)
{
    return bytes + bytes / 8 + bytes / 64 + 64; /* as deflateBound of any parameters */
}

/* Blocks one after the other that are all coded, or all stored, go to zlib at once. */
static int deflate_blocks(z_stream *stream, const Plan *plan, size_t count, int last)
{
    int code = Z_OK;

    for (int k = 0; k < plan->count && code == Z_OK;) {
        const int is_stored = plan->saved[k] < plan->limit, first = k;
        while (k < plan->count && (plan->saved[k] < plan->limit) == is_stored)
            k++;
        const size_t from = (size_t)first * plan->block, to = k == plan->count ? count : (size_t)k * plan->block;
        code = deflateParams(stream, is_stored ? STORED : LEVEL, Z_RLE);
        stream->avail_in = (uInt)(to - from);
        if (code == Z_OK)
            code = deflate(stream, k == plan->count ? last : Z_NO_FLUSH);
    }
    return plan->count ? code : deflate(stream, last);
}

size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, double give,
                     int is_last)
{
    z_stream stream = {0};
    Plan plan;

    if (count > UINT_MAX || room > UINT_MAX ||
        deflateInit2(&stream, LEVEL, Z_DEFLATED, -MAX_WBITS, MAX_MEM_LEVEL, Z_RLE) != Z_OK)
        return 0;
    make_plan(&plan, bytes, count, give);
    stream.next_in = (unsigned char *)bytes;
    stream.next_out = packed;
    stream.avail_out = (uInt)room;
    const int code = deflate_blocks(&stream, &plan, count, is_last ? Z_FINISH : Z_SYNC_FLUSH);
    const int ok = is_last ? code == Z_STREAM_END : code == Z_OK && stream.avail_out > 0;
    const size_t packed_bytes = stream.total_out;
    deflateEnd(&stream);
    return ok ? packed_bytes : 0;
}
