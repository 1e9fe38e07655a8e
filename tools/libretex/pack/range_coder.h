/* A binary range coder with adaptive probabilities, and plain bits beside it. Private to libretex; the format is
 * described in retex-pack(5). Writers give it room enough; readers that come to the end read zeros and say so. */
#ifndef RETEX_PACK_RANGE_CODER_H
#define RETEX_PACK_RANGE_CODER_H

#include <stddef.h>
#include <stdint.h>

/* How likely a bit is 0, in 65536ths; it begins in the middle. */
typedef uint16_t RetexBitModel;

enum { BIT_MODEL_EVEN = 32768, BIT_MODEL_RATE = 5 };

static inline void bit_model_learn(RetexBitModel *model, int bit)
{
    if (bit)
        *model = (RetexBitModel)(*model - (*model >> BIT_MODEL_RATE));
    else
        *model = (RetexBitModel)(*model + ((65535 - *model) >> BIT_MODEL_RATE));
}

static inline uint64_t range_of_zero(uint64_t range, RetexBitModel model)
{
    return (range >> 16) * model;
}

/* --- writing --- */

typedef struct RetexRangeEncoder {
    uint64_t low, range;
    unsigned char *begin, *at;
} RetexRangeEncoder;

static inline void range_encoder_begin(RetexRangeEncoder *e, unsigned char *to)
{
    *e = (RetexRangeEncoder){0, UINT64_MAX, to, to};
}

static inline void range_encoder_put_word(RetexRangeEncoder *e)
{
    for (int shift = 56; shift >= 32; shift -= 8)
        *e->at++ = (unsigned char)(e->low >> shift);
    e->low <<= 32;
}

static inline void range_encode(RetexRangeEncoder *e, RetexBitModel *model, int bit)
{
    const uint64_t zero = range_of_zero(e->range, *model);
    if (bit) {
        e->low += zero;
        e->range -= zero;
        /* the sum's carry goes into what is written */
        for (unsigned char *at = e->at; e->low < zero && at > e->begin && ++*--at == 0;)
            ;
    } else {
        e->range = zero;
    }
    bit_model_learn(model, bit);
    if (e->range <= UINT32_MAX) {
        range_encoder_put_word(e);
        e->range <<= 32;
    }
}

/* Bytes written. */
static inline size_t range_encoder_end(RetexRangeEncoder *e)
{
    range_encoder_put_word(e);
    range_encoder_put_word(e);
    return (size_t)(e->at - e->begin);
}

/* --- reading --- */

typedef struct RetexRangeDecoder {
    uint64_t code, range;
    const unsigned char *at, *end;
    int lacks; /* 1: it read beyond the end */
} RetexRangeDecoder;

static inline uint64_t range_decoder_get_word(RetexRangeDecoder *d)
{
    if (d->end - d->at < 4) {
        d->lacks = 1;
        return 0;
    }
    const unsigned char *at = d->at;
    d->at += 4;
    return (uint64_t)at[0] << 24 | (uint64_t)at[1] << 16 | (uint64_t)at[2] << 8 | at[3];
}

static inline void range_decoder_begin(RetexRangeDecoder *d, const unsigned char *from, const unsigned char *end)
{
    *d = (RetexRangeDecoder){0, UINT64_MAX, from, end, 0};
    d->code = range_decoder_get_word(d) << 32;
    d->code |= range_decoder_get_word(d);
}

static inline int range_decode(RetexRangeDecoder *d, RetexBitModel *model)
{
    const uint64_t zero = range_of_zero(d->range, *model);
    const int bit = d->code >= zero;
    if (bit) {
        d->code -= zero;
        d->range -= zero;
    } else {
        d->range = zero;
    }
    bit_model_learn(model, bit);
    if (d->range <= UINT32_MAX) {
        d->code = d->code << 32 | range_decoder_get_word(d);
        d->range <<= 32;
    }
    return bit;
}

/* --- plain bits --- */

typedef struct BitWriter {
    uint64_t bits;
    int count;
    unsigned char *begin, *at;
} BitWriter;

/* The lowest `count` bits, at most 32. */
static inline void bits_put(BitWriter *w, uint32_t bits, int count)
{
    w->bits |= (bits & ((UINT64_C(1) << count) - 1)) << w->count;
    for (w->count += count; w->count >= 8; w->count -= 8, w->bits >>= 8)
        *w->at++ = (unsigned char)w->bits;
}

static inline size_t bits_end(BitWriter *w)
{
    if (w->count)
        *w->at++ = (unsigned char)w->bits;
    return (size_t)(w->at - w->begin);
}

typedef struct BitReader {
    uint64_t bits;
    int count;
    const unsigned char *at, *end;
    int lacks;
} BitReader;

static inline uint32_t bits_get(BitReader *r, int count)
{
    for (; r->count < count; r->count += 8) {
        r->lacks = r->lacks || r->at == r->end;
        r->bits |= (uint64_t)(r->lacks ? 0 : *r->at++) << r->count;
    }
    const uint32_t bits = (uint32_t)(r->bits & ((UINT64_C(1) << count) - 1));
    r->bits >>= count;
    r->count -= count;
    return bits;
}

#endif
