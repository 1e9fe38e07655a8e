/* See cryptomatte.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "render/cryptomatte.h"

/* ---- names as numbers ---- */

static uint32_t rotate(uint32_t x, int bits)
{
    return x << bits | x >> (32 - bits);
}

/* What four bytes, or the last of fewer, are mixed to. */
static uint32_t mixed(uint32_t block)
{
    return rotate(block * 0xcc9e2d51u, 15) * 0x1b873593u;
}

static uint32_t little_endian(const unsigned char *bytes, size_t count)
{
    uint32_t value = 0;
    for (size_t k = 0; k < count; k++)
        value |= (uint32_t)bytes[k] << (8 * k);
    return value;
}

uint32_t cryptomatte_hash(const char *name)
{
    const unsigned char *bytes = (const unsigned char *)name;
    const size_t length = strlen(name), whole = length / 4 * 4;
    uint32_t hash = 0;
    for (size_t k = 0; k < whole; k += 4)
        hash = rotate(hash ^ mixed(little_endian(bytes + k, 4)), 13) * 5 + 0xe6546b64u;
    if (length > whole)
        hash ^= mixed(little_endian(bytes + whole, length - whole));
    hash ^= (uint32_t)length;
    hash = (hash ^ hash >> 16) * 0x85ebca6bu;
    hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

float cryptomatte_number(uint32_t hash)
{
    const uint32_t exponent = hash >> 23 & 255, kept = exponent < 1 ? 1 : exponent > 254 ? 254 : exponent,
                   bits = (hash & ~(255u << 23)) | kept << 23;
    float number;
    memcpy(&number, &bits, sizeof number);
    return number;
}

void cryptomatte_key(char key[8], const char *kind)
{
    snprintf(key, 8, "%07x", (unsigned)(cryptomatte_hash(kind) >> 4));
}

/* ---- names that were seen ---- */

static CryptoName *find_bucket(const CryptoNames *names, const char *name, uint32_t hash)
{
    size_t i = hash & (size_t)(names->nbuckets - 1);
    while (names->buckets[i].name && strcmp(names->buckets[i].name, name) != 0)
        i = (i + 1) & (size_t)(names->nbuckets - 1);
    return &names->buckets[i];
}

static int grow(CryptoNames *names)
{
    CryptoNames larger = {.nbuckets = names->nbuckets ? 2 * names->nbuckets : 64, .count = names->count};
    larger.buckets = calloc((size_t)larger.nbuckets, sizeof *larger.buckets);
    if (!larger.buckets)
        return 0;
    for (int k = 0; k < names->nbuckets; k++)
        if (names->buckets[k].name)
            *find_bucket(&larger, names->buckets[k].name, cryptomatte_hash(names->buckets[k].name)) = names->buckets[k];
    free(names->buckets);
    larger.failed = names->failed;
    *names = larger;
    return 1;
}

float crypto_names_add(CryptoNames *names, const char *name)
{
    const uint32_t hash = cryptomatte_hash(name);
    const float number = cryptomatte_number(hash);
    if (2 * names->count >= names->nbuckets && !grow(names)) {
        names->failed = 1;
        return number;
    }
    CryptoName *bucket = find_bucket(names, name, hash);
    if (bucket->name)
        return number;
    *bucket = (CryptoName){strdup(name), number};
    names->failed |= !bucket->name;
    names->count += bucket->name != NULL;
    return number;
}

void crypto_names_join(CryptoNames *names, const CryptoNames *others)
{
    for (int k = 0; k < others->nbuckets; k++)
        if (others->buckets[k].name)
            crypto_names_add(names, others->buckets[k].name);
    names->failed |= others->failed;
}

void crypto_names_close(CryptoNames *names)
{
    for (int k = 0; k < names->nbuckets; k++)
        free(names->buckets[k].name);
    free(names->buckets);
    *names = (CryptoNames){0};
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const CryptoName *)a)->name, ((const CryptoName *)b)->name);
}

/* Appends `"NAME":"HHHHHHHH"`, with what JSON wants escaped, at `to`, which has room for it; returns the end. */
static char *write_entry(char *to, const CryptoName *entry)
{
    uint32_t bits;
    memcpy(&bits, &entry->number, sizeof bits);
    *to++ = '"';
    for (const char *c = entry->name; *c; c++)
        if (*c == '"' || *c == '\\')
            *to++ = '\\', *to++ = *c;
        else if ((unsigned char)*c < 0x20)
            to += sprintf(to, "\\u%04x", (unsigned)*c);
        else
            *to++ = *c;
    return to + sprintf(to, "\":\"%08x\"", (unsigned)bits);
}

char *crypto_names_manifest(const CryptoNames *names)
{
    enum { ESCAPED = 6, AROUND = 16 }; /* bytes of an escaped one; those of an entry beside its name */
    CryptoName *sorted = malloc(((size_t)names->count + 1) * sizeof *sorted);
    size_t bytes = AROUND;
    int count = 0;
    for (int k = 0; k < names->nbuckets && sorted; k++)
        if (names->buckets[k].name)
            sorted[count++] = names->buckets[k], bytes += ESCAPED * strlen(names->buckets[k].name) + AROUND;
    char *text = sorted ? malloc(bytes) : NULL, *to = text;
    if (text) {
        qsort(sorted, (size_t)count, sizeof *sorted, compare_names);
        *to++ = '{';
        for (int k = 0; k < count; k++) {
            if (k)
                *to++ = ',';
            to = write_entry(to, &sorted[k]);
        }
        *to++ = '}', *to = 0;
    }
    free(sorted);
    return text;
}

/* ---- ranks ---- */

void crypto_pixel_add(CryptoPixel *pixel, float number, double share)
{
    int k = 0;
    if (!(share > 0))
        return;
    while (k < pixel->count && pixel->shares[k].number != number)
        k++;
    if (k == CRYPTO_PIXEL_MAX)
        return;
    if (k == pixel->count)
        pixel->shares[pixel->count++] = (CryptoShare){number, 0};
    pixel->shares[k].share += share;
}

/* Names with equal shares are sorted too, so that neither threads nor the order of samples matter. */
static int compare_shares(const void *a, const void *b)
{
    const CryptoShare *x = a, *y = b;
    if (x->share != y->share)
        return x->share < y->share ? 1 : -1;
    return x->number < y->number ? -1 : x->number > y->number;
}

void crypto_pixel_ranks(CryptoPixel *pixel, int ranks, float *values)
{
    qsort(pixel->shares, (size_t)pixel->count, sizeof *pixel->shares, compare_shares);
    for (int k = 0; k < ranks; k++) {
        const int is_there = k < pixel->count;
        values[2 * k] = is_there ? pixel->shares[k].number : 0;
        values[2 * k + 1] = is_there ? (float)pixel->shares[k].share : 0;
    }
}
