/* Texels as bytes. The image of an 8-bit file has at most 256 values a channel, whatever its colour space makes of them:
 * a table of these and a byte for each are a quarter of the memory that point look-ups, all over the image, wait for. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "texture_pyramid.h"

#define VALUES 256
#define SLOTS 1024 /* of a table from values to their codes */

typedef struct Coder {
    float *values; /* of the texture: VALUES */
    int count;
    uint32_t keys[SLOTS];
    short codes[SLOTS]; /* -1: free */
} Coder;

/* The value's code, or -1 where there are too many. */
static int code_of(Coder *coder, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    uint32_t slot = bits * 2654435761u >> 22;
    while (coder->codes[slot] >= 0 && coder->keys[slot] != bits)
        slot = (slot + 1) % SLOTS;
    if (coder->codes[slot] < 0) {
        if (coder->count == VALUES)
            return -1;
        coder->keys[slot] = bits;
        coder->codes[slot] = (short)coder->count;
        coder->values[coder->count++] = value;
    }
    return coder->codes[slot];
}

static int encode(Coder coders[4], const float *texels, size_t count, unsigned char *codes)
{
    for (size_t i = 0; i < 4 * count; i++) {
        int code = code_of(&coders[i % 4], texels[i]);
        if (code < 0)
            return 0;
        codes[i] = (unsigned char)code;
    }
    return 1;
}

void retex_texture_compact(RetexTexture *texture)
{
    const TextureLevel *image = &texture->levels[0];
    size_t count = (size_t)image->width * (size_t)image->height;
    if (!texture->nlevels || texture->codes)
        return;
    unsigned char *codes = malloc(4 * count);
    float *values = calloc(4 * VALUES, sizeof *values);
    Coder *coders = malloc(4 * sizeof *coders);
    int fits = codes && values && coders;
    for (int c = 0; c < 4 && fits; c++) {
        coders[c].values = values + c * VALUES;
        coders[c].count = 0;
        memset(coders[c].codes, -1, sizeof coders[c].codes);
    }
    if (fits && encode(coders, image->texels, count, codes)) {
        texture->codes = codes, texture->values = values;
        codes = NULL, values = NULL;
    }
    free(codes);
    free(values);
    free(coders);
}
