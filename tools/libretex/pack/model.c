/* Lossless coding of a strip of integers: linear prediction and adaptive binary range coding. See model.h.
 *
 * Channels are coded one after the other. Each number is predicted from its neighbours that are coded already, and from
 * the same pixel of up to two earlier channels. Zeros are holes: a flag tells them apart from other numbers. Where a
 * hole is used for prediction, it has the value of the last number before it that is not a hole. */
#include "pack/model.h"

#include <stdlib.h>
#include <string.h>

#include "pack/fit.h"
#include "pack/range_coder.h"
#include "pack/zigzag.h"

#define ALWAYS_INLINE __attribute__((always_inline))

enum {
    TOKEN_BITS = 6,
    TOKENS = 1 << TOKEN_BITS,
    CLASSES = 32,          /* contexts of tokens: by the size of residuals nearby */
    RANKS_MAX = 4096,      /* most distinct numbers that are coded by rank */
    LARGEST_SIZE = 1 << 24 /* most size of a residual in contexts: larger ones are clamped */
};

/* Adaptive probabilities, updated while a strip is coded. */
typedef struct Models {
    RetexBitModel hole[16];
    RetexBitModel token[CLASSES][TOKENS];
    RetexBitModel same_gap, gap[TOKENS];
} Models;

/* The two streams of a strip, written or read: range-coded bits, and plain bits that are not modelled. */
typedef struct Stream {
    RetexRangeEncoder to;
    RetexRangeDecoder from;
    BitWriter plain_to;
    BitReader plain_from;
} Stream;

typedef struct Coding {
    const RetexPackModelStrip *strip;
    Stream stream;
    Models *models;
    RetexPackFitChannel channels[RETEX_PACK_MODEL_CHANNELS_MAX];
    int32_t *ranks; /* the distinct numbers of the channel, in ascending order */
    int nranks;     /* 0: numbers are coded directly, not by rank */
} Coding;

/* --- bits and numbers: the same functions encode and decode --- */

static inline int code_bit(Stream *s, RetexBitModel *model, int bit, int reading)
{
    if (reading)
        return range_decode(&s->from, model);
    range_encode(&s->to, model, bit);
    return bit;
}

static inline uint32_t code_plain(Stream *s, uint32_t bits, int count, int reading)
{
    if (reading)
        return bits_get(&s->plain_from, count);
    bits_put(&s->plain_to, bits, count);
    return bits;
}

/* A number below 4 is its own token. For larger ones, the token gives the number of bits and the second highest bit;
 * the other bits are plain. */
ALWAYS_INLINE static inline uint32_t code_number(Stream *s, RetexBitModel *models, uint32_t number, int reading)
{
    int token = (int)number, node = 1;
    if (!reading && number >= 4) {
        const int bits = 32 - __builtin_clz(number);
        token = 2 * (bits - 1) + (int)(number >> (bits - 2) & 1);
    }
#pragma GCC unroll 6
    for (int k = TOKEN_BITS; k-- > 0;)
        node = 2 * node + code_bit(s, &models[node], token >> k & 1, reading);
    token = node - TOKENS;
    if (token < 4)
        return (uint32_t)token;
    const int rest = token / 2 - 1;
    return (2u | (token & 1)) << rest | code_plain(s, number & ((1u << rest) - 1), rest, reading);
}

/* --- ranks --- */

static int by_value(const void *a, const void *b)
{
    const int32_t x = *(const int32_t *)a, y = *(const int32_t *)b;
    return (x > y) - (x < y);
}

/* List the distinct numbers other than 0; none if they are too many for ranks to pay. */
static void find_ranks(Coding *c, const int32_t *numbers, size_t count, int32_t *scratch)
{
    size_t sorted = 0;
    c->nranks = 0;
    for (size_t i = 0; i < count; i++)
        if (numbers[i] && (sorted == 0 || numbers[i] != scratch[sorted - 1]))
            scratch[sorted++] = numbers[i];
    qsort(scratch, sorted, sizeof *scratch, by_value);
    for (size_t i = 0; i < sorted; i++)
        if (i == 0 || scratch[i] != scratch[i - 1]) {
            if (c->nranks == RANKS_MAX || (size_t)(c->nranks + 1) * 8 > count) {
                c->nranks = 0;
                return;
            }
            c->ranks[c->nranks++] = scratch[i];
        }
}

/* Index of the first positive number. Ranks keep the sign: positive numbers have ranks 1, 2, ..., 0 has rank 0. */
static int first_positive(const Coding *c)
{
    int first = 0;
    while (first < c->nranks && c->ranks[first] < 0)
        first++;
    return first;
}

static int32_t rank_of(const Coding *c, int32_t number, int positive)
{
    int low = 0, high = c->nranks - 1;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (c->ranks[middle] < number)
            low = middle + 1;
        else
            high = middle;
    }
    return number == 0 ? 0 : low < positive ? low - positive : low - positive + 1;
}

static int code_ranks(Coding *c, int reading)
{
    uint32_t before = 1;
    c->nranks = (int)code_plain(&c->stream, (uint32_t)c->nranks, 13, reading);
    if (c->nranks > RANKS_MAX)
        return 0;
    for (int i = 0; i < c->nranks; i++) {
        const uint32_t least = i ? (uint32_t)c->ranks[i - 1] : 0;
        uint32_t gap = (uint32_t)c->ranks[i] - least;
        if (i == 0) {
            gap = code_plain(&c->stream, gap, 32, reading);
        } else if (code_bit(&c->stream, &c->models->same_gap, gap == before, reading)) {
            gap = before;
        } else {
            gap = code_number(&c->stream, c->models->gap, gap, reading);
        }
        c->ranks[i] = (int32_t)(least + gap);
        before = i ? gap : 1;
    }
    return 1;
}

/* --- one channel --- */

static int code_description(Coding *c, int index, int reading)
{
    RetexPackFitChannel *channel = &c->channels[index];
    Stream *s = &c->stream;
    channel->by_fit = (int)code_plain(s, (uint32_t)channel->by_fit, 1, reading);
    channel->has_holes = (int)code_plain(s, (uint32_t)channel->has_holes, 1, reading);
    channel->mean = (int32_t)code_plain(s, (uint32_t)channel->mean, 32, reading);
    for (int i = 0; channel->by_fit && i < channel->nweights; i++)
        channel->weights[i] = (int16_t)code_plain(s, (uint16_t)channel->weights[i], 16, reading);
    return code_ranks(c, reading);
}

/* The index of size's interval among 0, 1, 2, 3, 4 to 5, 6 to 7, 8 to 11, ...: two intervals for each octave. */
static inline int half_octave(uint32_t size)
{
    if (size < 2)
        return (int)size;
    const int bits = 31 - __builtin_clz(size);
    return 2 * bits + (int)(size >> (bits - 1) & 1);
}

/* The context of a token: the size of neighbouring residuals and of this pixel's residual in the previous channel. */
static inline int class_of(const RetexPackFitChannel *channel, ptrdiff_t at, ptrdiff_t above)
{
    const int32_t *sizes = channel->sizes;
    uint32_t nearby = (uint32_t)(2 * sizes[at - 1] + 2 * sizes[above] + sizes[above - 1] + sizes[above + 1]);
    if (channel->others[0])
        nearby = (nearby + 6 * (uint32_t)channel->others[0]->sizes[at]) / 2;
    const int class = half_octave(nearby);
    return class < CLASSES ? class : CLASSES - 1;
}

static inline int code_hole(Coding *c, const RetexPackFitChannel *channel, ptrdiff_t at, ptrdiff_t above, int reading)
{
    const unsigned char *holes = channel->holes;
    const int both = channel->others[0] && channel->others[0]->holes[at];
    const int context = holes[at - 1] + 2 * holes[above] + 4 * holes[above + 1] + 8 * both;
    return code_bit(&c->stream, &c->models->hole[context], holes[at], reading);
}

/* number / 2^shift, rounded to the nearest integer. */
static inline int32_t in_steps(int64_t number, int shift)
{
    return (int32_t)(shift ? (number + (INT64_C(1) << (shift - 1))) >> shift : number);
}

ALWAYS_INLINE static inline void code_numbers(Coding *c, int index, int nweights, int reading)
{
    RetexPackFitChannel *channel = &c->channels[index];
    const unsigned char *shifts = c->strip->shifts[index];
    int32_t last = channel->mean;
    for (int y = 0; y < channel->rows; y++) {
        retex_pack_fit_begin_row(channel, y);
        for (int x = 0; x < channel->width; x++) {
            const ptrdiff_t at = retex_pack_fit_place(channel, x, y), above = retex_pack_fit_above(channel, at, y);
            const int shift = shifts ? *shifts++ : 0;
            if (channel->has_holes && (channel->holes[at] = (unsigned char)code_hole(c, channel, at, above, reading))) {
                channel->sizes[at] = channel->sizes[at - 1];
                channel->numbers[at] = last;
                continue;
            }
            const int32_t guess = in_steps(retex_pack_fit_guess_by(channel, at, above, nweights), shift);
            uint32_t code = 0;
            if (!reading)
                code = zigzag_encode((int32_t)((uint32_t)(channel->numbers[at] >> shift) - (uint32_t)guess));
            code = code_number(&c->stream, c->models->token[class_of(channel, at, above)], code, reading);
            channel->sizes[at] = (int32_t)(code / 2 < LARGEST_SIZE ? (code + 1) / 2 : LARGEST_SIZE);
            channel->numbers[at] = last = (int32_t)(((uint32_t)guess + (uint32_t)zigzag_decode(code)) << shift);
        }
    }
}

/* Code all numbers of a channel. The number of weights is a constant in each call, so that loops are unrolled. */
static inline void code_channel(Coding *c, int index, int reading)
{
    const RetexPackFitChannel *channel = &c->channels[index];
    if (!channel->by_fit)
        code_numbers(c, index, 0, reading);
    else if (channel->nweights == RETEX_PACK_FIT_OWN)
        code_numbers(c, index, RETEX_PACK_FIT_OWN, reading);
    else if (channel->nweights == RETEX_PACK_FIT_OWN + RETEX_PACK_FIT_OTHER)
        code_numbers(c, index, RETEX_PACK_FIT_OWN + RETEX_PACK_FIT_OTHER, reading);
    else
        code_numbers(c, index, RETEX_PACK_FIT_WEIGHTS, reading);
}

/* --- a strip --- */

static void coding_free(Coding *c)
{
    for (int i = 0; i < c->strip->channels; i++) {
        free(c->channels[i].numbers);
        free(c->channels[i].sizes);
        free(c->channels[i].holes);
    }
    free(c->models);
    free(c->ranks);
}

static int coding_alloc(Coding *c, const RetexPackModelStrip *strip)
{
    const size_t capacity =
        (size_t)(strip->width + RETEX_PACK_FIT_MARGIN) * (size_t)strip->rows + RETEX_PACK_FIT_MARGIN;
    int ok = 1;
    c->strip = strip;
    for (int i = 0; i < strip->channels; i++) {
        RetexPackFitChannel *channel = &c->channels[i];
        channel->width = strip->width;
        channel->rows = strip->rows;
        channel->numbers = calloc(capacity, sizeof *channel->numbers);
        channel->sizes = calloc(capacity, sizeof *channel->sizes);
        channel->holes = calloc(capacity, 1);
        channel->nweights = RETEX_PACK_FIT_OWN;
        for (int k = 0; k < RETEX_PACK_FIT_OTHERS && k < i; k++) {
            channel->others[k] = &c->channels[i - 1 - k];
            channel->nweights += RETEX_PACK_FIT_OTHER;
        }
        ok = ok && channel->numbers && channel->sizes && channel->holes;
    }
    c->models = malloc(sizeof *c->models);
    c->ranks = malloc(RANKS_MAX * sizeof *c->ranks);
    for (size_t i = 0; c->models && i < sizeof *c->models / sizeof(RetexBitModel); i++)
        ((RetexBitModel *)c->models)[i] = BIT_MODEL_EVEN;
    return ok && c->models && c->ranks;
}

/* Prepare a channel for coding: replace numbers by ranks if there are few distinct ones, and fill holes. scratch has
 * room for all numbers of the channel. */
static void load_channel(Coding *c, int index, int32_t *scratch)
{
    RetexPackFitChannel *channel = &c->channels[index];
    const int32_t *numbers = c->strip->numbers[index];
    const size_t count = (size_t)channel->width * (size_t)channel->rows;
    c->nranks = 0;
    if (!c->strip->shifts[index])
        find_ranks(c, numbers, count, scratch);
    const int positive = first_positive(c);
    double sum = 0;
    size_t present = 0;
    for (size_t i = 0; i < count; i++) {
        scratch[i] = c->nranks ? rank_of(c, numbers[i], positive) : numbers[i];
        sum += scratch[i];
        present += scratch[i] != 0;
    }
    channel->mean = present ? (int32_t)(sum / (double)present) : 0;
    channel->has_holes = present < count;
    int32_t last = channel->mean;
    for (int y = 0; y < channel->rows; y++)
        for (int x = 0; x < channel->width; x++, scratch++) {
            const ptrdiff_t at = retex_pack_fit_place(channel, x, y);
            channel->holes[at] = *scratch == 0;
            channel->numbers[at] = last = *scratch ? *scratch : last;
        }
}

static void unload_channel(const Coding *c, int index)
{
    const RetexPackFitChannel *channel = &c->channels[index];
    int32_t *numbers = c->strip->numbers[index];
    const int positive = first_positive(c);
    for (int y = 0; y < channel->rows; y++)
        for (int x = 0; x < channel->width; x++) {
            const ptrdiff_t at = retex_pack_fit_place(channel, x, y);
            int32_t number = channel->holes[at] ? 0 : channel->numbers[at];
            if (c->nranks && number) {
                const int64_t place = (int64_t)number + positive - (number > 0);
                number = c->ranks[place < 0 ? 0 : place >= c->nranks ? c->nranks - 1 : place];
            }
            *numbers++ = number;
        }
}

int retex_pack_model_alloc(RetexPackModelStrip *strip, int width, int rows, int channels, const RetexPackMap *maps)
{
    const size_t count = (size_t)width * (size_t)rows;
    int ok = 1;
    *strip = (RetexPackModelStrip){.width = width, .rows = rows, .channels = channels};
    for (int c = 0; c < channels; c++) {
        const int lattice = maps[c].kind == RETEX_PACK_MAP_LATTICE;
        strip->numbers[c] = malloc(count * sizeof *strip->numbers[c]);
        strip->shifts[c] = lattice ? malloc(count) : NULL;
        ok = ok && strip->numbers[c] && (!lattice || strip->shifts[c]);
    }
    return ok;
}

void retex_pack_model_free(RetexPackModelStrip *strip)
{
    for (int c = 0; c < strip->channels; c++) {
        free(strip->numbers[c]);
        free(strip->shifts[c]);
    }
}

static int any_number(const RetexPackModelStrip *strip)
{
    for (int c = 0; c < strip->channels; c++)
        for (size_t i = 0; i < (size_t)strip->width * (size_t)strip->rows; i++)
            if (strip->numbers[c][i])
                return 1;
    return 0;
}

/* Upper bound on the bytes of each of the two streams. */
static size_t stream_bound(const RetexPackModelStrip *strip)
{
    const size_t numbers = ((size_t)strip->width * (size_t)strip->rows + RANKS_MAX) * (size_t)strip->channels;
    return 12 * numbers + 4096;
}

long retex_pack_model_encode(unsigned char **data, const RetexPackModelStrip *strip)
{
    const size_t count = (size_t)strip->width * (size_t)strip->rows, capacity = stream_bound(strip);
    Coding c = {0};
    *data = NULL;
    if (!any_number(strip))
        return 0;
    int ok = coding_alloc(&c, strip);
    int32_t *scratch = malloc(count * sizeof *scratch);
    unsigned char *modelled = malloc(4 + 2 * capacity), *plain = modelled ? modelled + 4 + capacity : NULL;
    long bytes = -1;
    if (ok && scratch && modelled) {
        range_encoder_begin(&c.stream.to, modelled + 4);
        c.stream.plain_to = (BitWriter){0, 0, plain, plain};
        for (int i = 0; i < strip->channels; i++) {
            load_channel(&c, i, scratch);
            retex_pack_fit(&c.channels[i], strip->shifts[i]);
            code_description(&c, i, 0);
            code_channel(&c, i, 0);
        }
        const size_t first = range_encoder_end(&c.stream.to), second = bits_end(&c.stream.plain_to);
        for (int k = 0; k < 4; k++)
            modelled[k] = (unsigned char)(first >> 8 * k);
        memmove(modelled + 4 + first, plain, second);
        bytes = (long)(4 + first + second);
        unsigned char *fitted = realloc(modelled, (size_t)bytes);
        *data = fitted ? fitted : modelled;
    } else {
        free(modelled);
    }
    free(scratch);
    coding_free(&c);
    return bytes;
}

int retex_pack_model_decode(const RetexPackModelStrip *strip, const unsigned char *data, size_t bytes)
{
    const size_t count = (size_t)strip->width * (size_t)strip->rows;
    if (bytes == 0) {
        for (int i = 0; i < strip->channels; i++)
            memset(strip->numbers[i], 0, count * sizeof *strip->numbers[i]);
        return 1;
    }
    const size_t first = bytes < 4 ? 0 : data[0] | (size_t)data[1] << 8 | (size_t)data[2] << 16 | (size_t)data[3] << 24;
    if (bytes < 4 || first > bytes - 4)
        return 0;
    Coding c = {0};
    int ok = coding_alloc(&c, strip) ? 1 : -1;
    const unsigned char *plain = data + 4 + first;
    range_decoder_begin(&c.stream.from, data + 4, plain);
    c.stream.plain_from = (BitReader){0, 0, plain, data + bytes, 0};
    for (int i = 0; ok == 1 && i < strip->channels; i++) {
        ok = code_description(&c, i, 1);
        if (ok == 1) {
            code_channel(&c, i, 1);
            unload_channel(&c, i);
        }
    }
    coding_free(&c);
    const Stream *s = &c.stream; /* both streams must be used up exactly */
    return ok == 1 ? !s->from.lacks && s->from.at == s->from.end && !s->plain_from.lacks &&
                         s->plain_from.at == s->plain_from.end
                   : ok;
}
