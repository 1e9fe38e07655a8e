/* Zigzag coding: signed residuals as unsigned numbers, small ones of either sign as small numbers. Private to
 * libretex. */
#ifndef RETEX_PACK_ZIGZAG_H
#define RETEX_PACK_ZIGZAG_H

#include <stdint.h>

static inline uint32_t zigzag_encode(int32_t residual)
{
    return ((uint32_t)residual << 1) ^ (uint32_t)(residual >> 31);
}

static inline int32_t zigzag_decode(uint32_t code)
{
    return (int32_t)(code >> 1 ^ (0u - (code & 1)));
}

#endif
