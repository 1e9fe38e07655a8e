/* See deflate.h. A block is as long as one that is not compressed can be. Its runs are found, its symbols counted,
 * codes made for them; then its size is known, so that nothing needs to be checked while it is written. */
#include "deflate.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum {
    BLOCK = 65535,
    END = 256,
    FIRST_LENGTH = 257,
    SYMBOLS = 286,
    LONGEST = 14,  /* bits of a code: four of them fit into 64 bits beside the rest of a byte */
    LEAST_RUN = 3, /* of a copy */
    MOST_RUN = 258,
    FEW_RUNS = 32, /* bytes for each of them */
    MOST_RUNS = BLOCK / (LEAST_RUN + 1) + 1,
    LENGTH_SYMBOLS = 19, /* of the code that code lengths are written in */
    LENGTH_LONGEST = 7,
    SLACK = 16 /* bytes that may be written beyond the end */
};

/* Bytes begin .. begin + count - 1 are as the one before them. */
typedef struct Run {
    uint16_t begin, count;
} Run;

typedef struct Code {
    uint16_t bits[SYMBOLS]; /* the first to be written is the lowest */
    uint8_t length[SYMBOLS];
} Code;

typedef struct Block {
    const unsigned char *bytes;
    size_t count, nruns;
    uint32_t frequency[SYMBOLS];
    Code code;
    Run runs[MOST_RUNS];
} Block;

/* ---- symbols ---- */

/* The symbol of a copy's length, and the extra bits that follow it. */
static inline int length_symbol(int length, int *extra, int *extra_bits)
{
    *extra = *extra_bits = 0;
    if (length == MOST_RUN)
        return SYMBOLS - 1;
    if (length < LEAST_RUN + 8)
        return FIRST_LENGTH + length - LEAST_RUN;
    const int above = length - LEAST_RUN, bits = 31 - __builtin_clz((unsigned)above) - 2;
    *extra_bits = bits;
    *extra = above & ((1 << bits) - 1);
    return FIRST_LENGTH + 4 * bits + (above >> bits);
}

static inline uint32_t load4(const unsigned char *at)
{
    uint32_t four;
    memcpy(&four, at, sizeof four);
    return four;
}

/* Every step-th place is tried; a run that is found there is followed to both sides. */
static inline void find_runs_by(Block *block, size_t step)
{
    const unsigned char *p = block->bytes;
    size_t end = 0; /* of the run before */
    block->nruns = 0;
    for (size_t at = 1; at + 4 <= block->count; at += step) {
        if (load4(p + at) != load4(p + at - 1))
            continue;
        size_t begin = at;
        while (begin > end + 1 && p[begin - 2] == p[at])
            begin--;
        for (end = at + 4; end < block->count && p[end] == p[at];)
            end++;
        block->runs[block->nruns++] = (Run){(uint16_t)begin, (uint16_t)(end - begin)};
        at += (end - 1 - at) / step * step;
    }
}

/* Long ones first; where there are many, shorter ones are worth a closer look. */
static void find_runs(Block *block)
{
    find_runs_by(block, 4);
    if (block->nruns > block->count / FEW_RUNS)
        find_runs_by(block, 1);
}

/* The copies that a run is, and what of it is too short for one. */
static inline int next_copy(int left)
{
    return left > MOST_RUN ? MOST_RUN : left;
}

static void count_symbols(Block *block)
{
    static const int places = 4; /* so that equal bytes in a row need not wait for one another */
    uint32_t counts[4][256] = {{0}};
    size_t at = 0;
    memset(block->frequency, 0, sizeof block->frequency);
    for (size_t i = 0; i <= block->nruns; i++) {
        const Run run = i < block->nruns ? block->runs[i] : (Run){(uint16_t)block->count, 0};
        for (; at + 4 <= run.begin; at += 4)
            for (int k = 0; k < places; k++)
                counts[k][block->bytes[at + (size_t)k]]++;
        for (; at < run.begin; at++)
            counts[0][block->bytes[at]]++;
        int left = run.count, extra, extra_bits;
        for (; left >= LEAST_RUN; left -= next_copy(left))
            block->frequency[length_symbol(next_copy(left), &extra, &extra_bits)]++;
        at += (size_t)(run.count - left);
    }
    for (int s = 0; s < 256; s++)
        block->frequency[s] = counts[0][s] + counts[1][s] + counts[2][s] + counts[3][s];
    block->frequency[END] = 1;
}

/* ---- codes ---- */

typedef struct Leaf {
    uint32_t frequency;
    int symbol;
} Leaf;

static int by_frequency(const void *a, const void *b)
{
    const Leaf *x = a, *y = b;
    if (x->frequency != y->frequency)
        return x->frequency < y->frequency ? -1 : 1;
    return x->symbol - y->symbol;
}

/* Huffman's code lengths of leaves that are in order: the two rarest of leaves and nodes make a node, again and again.
 * Returns the longest. */
static int find_lengths(const Leaf *leaves, int count, uint8_t *length)
{
    uint32_t weight[2 * SYMBOLS];
    int parent[2 * SYMBOLS], depth[2 * SYMBOLS], leaf = 0, node = count, most = 0;
    for (int i = 0; i < count; i++)
        weight[i] = leaves[i].frequency;
    for (int made = count; made < 2 * count - 1; made++) {
        weight[made] = 0;
        for (int k = 0; k < 2; k++) {
            const int rarest = leaf < count && (node >= made || weight[leaf] <= weight[node]) ? leaf++ : node++;
            weight[made] += weight[rarest];
            parent[rarest] = made;
        }
    }
    depth[2 * count - 2] = 0;
    for (int i = 2 * count - 3; i >= 0; i--) {
        depth[i] = depth[parent[i]] + 1;
        if (i < count) {
            length[leaves[i].symbol] = (uint8_t)depth[i];
            most = depth[i] > most ? depth[i] : most;
        }
    }
    return most;
}

/* Codes of symbols that occur, none longer than `longest`. Where one would be, rare symbols are taken for less rare. */
static void make_code(const uint32_t *frequency, int count, int longest, uint16_t *bits, uint8_t *length)
{
    Leaf leaves[SYMBOLS];
    int n = 0, next[LONGEST + 2] = {0};
    memset(length, 0, (size_t)count);
    for (int s = 0; s < count; s++)
        if (frequency[s])
            leaves[n++] = (Leaf){frequency[s], s};
    qsort(leaves, (size_t)n, sizeof *leaves, by_frequency);
    if (n == 1)
        length[leaves[0].symbol] = 1;
    while (n > 1 && find_lengths(leaves, n, length) > longest)
        for (int i = 0; i < n; i++)
            leaves[i].frequency = leaves[i].frequency / 2 + 1;
    for (int s = 0; s < count; s++)
        next[length[s] + 1] += length[s] > 0;
    for (int l = 1; l <= longest; l++) /* the first code of each length */
        next[l + 1] = (next[l] + next[l + 1]) << 1;
    for (int s = 0; s < count; s++) {
        unsigned code = length[s] ? (unsigned)next[length[s]]++ : 0, turned = 0;
        for (int k = 0; k < length[s]; k++, code >>= 1)
            turned = turned << 1 | (code & 1);
        bits[s] = (uint16_t)turned;
    }
}

/* Code lengths as they are written: themselves, or 16, 17 and 18, which repeat. */
typedef struct Lengths {
    uint8_t symbol[SYMBOLS + 1], extra[SYMBOLS + 1];
    int count;
    uint32_t frequency[LENGTH_SYMBOLS];
    uint16_t bits[LENGTH_SYMBOLS];
    uint8_t length[LENGTH_SYMBOLS];
} Lengths;

static const uint8_t length_order[LENGTH_SYMBOLS] = {16, 17, 18, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15};

static void add_length(Lengths *l, int symbol, int extra)
{
    l->symbol[l->count] = (uint8_t)symbol;
    l->extra[l->count++] = (uint8_t)extra;
    l->frequency[symbol]++;
}

static void describe_code(Lengths *l, const uint8_t *length, int count)
{
    memset(l, 0, sizeof *l);
    for (int i = 0; i < count;) {
        int same = 1;
        while (i + same < count && length[i + same] == length[i])
            same++;
        i += same;
        if (length[i - 1]) {
            add_length(l, length[i - 1], 0);
            for (same--; same >= 3; same -= same > 6 ? 6 : same)
                add_length(l, 16, (same > 6 ? 6 : same) - 3);
        } else {
            for (; same >= 11; same -= same > 138 ? 138 : same)
                add_length(l, 18, (same > 138 ? 138 : same) - 11);
            if (same >= 3) {
                add_length(l, 17, same - 3);
                same = 0;
            }
        }
        for (; same > 0; same--)
            add_length(l, length[i - 1], 0);
    }
    make_code(l->frequency, LENGTH_SYMBOLS, LENGTH_LONGEST, l->bits, l->length);
}

static int extra_bits_of(int length_symbol)
{
    return length_symbol == 16 ? 2 : length_symbol == 17 ? 3 : length_symbol == 18 ? 7 : 0;
}

/* ---- writing ---- */

typedef struct Bits {
    unsigned char *to;
    uint64_t waiting; /* the next bit is the lowest */
    int count;        /* fewer than 8 after a flush */
} Bits;

static inline void put(Bits *b, uint64_t bits, int count)
{
    b->waiting |= bits << b->count;
    b->count += count;
}

static inline void flush(Bits *b)
{
    for (int k = 0; k < 8; k++) /* one store, where bytes are in that order */
        b->to[k] = (unsigned char)(b->waiting >> 8 * k);
    b->to += b->count >> 3;
    b->waiting >>= b->count & ~7;
    b->count &= 7;
}

static void fill_byte(Bits *b)
{
    b->count = (b->count + 7) & ~7;
    flush(b);
}

static void put_stored(Bits *b, const Block *block, int is_last)
{
    const unsigned count = (unsigned)block->count;
    put(b, (uint64_t)is_last, 3);
    fill_byte(b);
    put(b, count | (~count & 0xffffu) << 16, 32);
    flush(b);
    if (count)
        memcpy(b->to, block->bytes, count);
    b->to += count;
}

/* Lengths of the codes of literals and copies, then of the one distance that there is. */
static int all_lengths(const Block *block, uint8_t *length)
{
    int count = SYMBOLS;
    while (block->code.length[count - 1] == 0)
        count--;
    memcpy(length, block->code.length, (size_t)count);
    length[count] = 1;
    return count;
}

static int used_lengths(const Lengths *l)
{
    int count = LENGTH_SYMBOLS;
    while (count > 4 && l->length[length_order[count - 1]] == 0)
        count--;
    return count;
}

static void put_header(Bits *b, const Lengths *l, int literals, int is_last)
{
    const int used = used_lengths(l);
    put(b, (uint64_t)(is_last | 2 << 1), 3);
    put(b, (uint64_t)(literals - FIRST_LENGTH), 5);
    put(b, 0, 5);
    put(b, (uint64_t)(used - 4), 4);
    flush(b);
    for (int i = 0; i < used; i++) {
        put(b, l->length[length_order[i]], 3);
        flush(b);
    }
    for (int i = 0; i < l->count; i++) {
        const int symbol = l->symbol[i];
        put(b, l->bits[symbol], l->length[symbol]);
        put(b, l->extra[i], extra_bits_of(symbol));
        flush(b);
    }
}

static void put_symbols(Bits *bits, const Block *block)
{
    const Code *code = &block->code;
    Bits b = *bits;
    size_t at = 0;
    for (size_t i = 0; i <= block->nruns; i++) {
        const Run run = i < block->nruns ? block->runs[i] : (Run){(uint16_t)block->count, 0};
        const unsigned char *p = block->bytes;
        for (; at + 4 <= run.begin; at += 4) {
            for (size_t k = 0; k < 4; k++)
                put(&b, code->bits[p[at + k]], code->length[p[at + k]]);
            flush(&b);
        }
        for (; at < run.begin; at++) {
            put(&b, code->bits[p[at]], code->length[p[at]]);
            flush(&b);
        }
        int left = run.count, extra, extra_bits;
        for (; left >= LEAST_RUN; left -= next_copy(left)) {
            const int symbol = length_symbol(next_copy(left), &extra, &extra_bits);
            put(&b, code->bits[symbol], code->length[symbol]);
            put(&b, (uint64_t)extra, extra_bits + 1); /* and distance 1, which is one bit of 0 */
            flush(&b);
        }
        at += (size_t)(run.count - left);
    }
    put(&b, code->bits[END], code->length[END]);
    flush(&b);
    *bits = b;
}

/* ---- blocks ---- */

/* Bits of the block with its codes. */
static size_t coded_size(const Block *block, const Lengths *l)
{
    size_t bits = 3 + 5 + 5 + 4 + 3 * (size_t)used_lengths(l);
    for (int i = 0; i < l->count; i++)
        bits += (size_t)(l->length[l->symbol[i]] + extra_bits_of(l->symbol[i]));
    for (int s = 0; s < SYMBOLS; s++) {
        const int copy = s - FIRST_LENGTH, extra = copy < 8 || s == SYMBOLS - 1 ? 0 : copy / 4 - 1;
        bits += block->frequency[s] * (size_t)(block->code.length[s] + (copy >= 0 ? extra + 1 : 0));
    }
    return bits;
}

/* Returns 0 where it does not fit before `end`. */
static int put_block(Bits *b, Block *block, int is_last, const unsigned char *end)
{
    const size_t stored = 3 + 7 + 32 + 8 * block->count;
    uint8_t length[SYMBOLS + 1];
    Lengths lengths;
    find_runs(block);
    count_symbols(block);
    make_code(block->frequency, SYMBOLS, LONGEST, block->code.bits, block->code.length);
    const int literals = all_lengths(block, length);
    describe_code(&lengths, length, literals + 1);
    const size_t coded = coded_size(block, &lengths), bits = coded < stored ? coded : stored;
    if ((size_t)(end - b->to) < bits / 8 + SLACK)
        return 0;
    if (coded < stored) {
        put_header(b, &lengths, literals, is_last);
        put_symbols(b, block);
    } else {
        put_stored(b, block, is_last);
    }
    return 1;
}

size_t retex_deflate_room(size_t bytes)
{
    return bytes + (bytes / BLOCK + 2) * 6 + 2 * SLACK;
}

size_t retex_deflate(unsigned char *packed, size_t room, const unsigned char *bytes, size_t count, int is_last)
{
    static const unsigned char nothing[1];
    Bits b = {.to = packed};
    Block block;
    const unsigned char *end = packed + room;
    size_t at = 0;
    do {
        block.bytes = count ? bytes + at : nothing;
        block.count = count - at < BLOCK ? count - at : BLOCK;
        at += block.count;
        if (!put_block(&b, &block, is_last && at == count, end))
            return 0;
    } while (at < count);
    if (!is_last) {
        block.count = 0;
        if (end - b.to < SLACK)
            return 0;
        put_stored(&b, &block, 0);
    }
    fill_byte(&b);
    return (size_t)(b.to - packed);
}
