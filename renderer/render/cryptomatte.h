/* Cryptomatte: mattes of all names at once, by the specification of its authors, version 1.1. A pixel has the names
 * that cover it most, each as a number that is made of the name, and its share of the pixel. */
#ifndef RENDERER_RENDER_CRYPTOMATTE_H
#define RENDERER_RENDER_CRYPTOMATTE_H

#include <stdint.h>
#include <retex/error.h>

/* MurmurHash3 of 32 bits, seed 0, of a name in UTF-8. */
uint32_t cryptomatte_hash(const char *name);
/* The number that stands for a hash in pixels: its bits, with an exponent that no infinity, NaN or denormal has. */
float cryptomatte_number(uint32_t hash);

/* ---- names that were seen, of one thread or of all ---- */

typedef struct CryptoName {
    char *name; /* NULL: none */
    float number;
} CryptoName;

/* Begins with zeros. */
typedef struct CryptoNames {
    CryptoName *buckets; /* by hash */
    int nbuckets, count, failed; /* failed: memory was short, some are missing */
} CryptoNames;

/* Its number; the name is added where it is new. */
float crypto_names_add(CryptoNames *names, const char *name);
void crypto_names_join(CryptoNames *names, const CryptoNames *others);
/* The manifest: {"NAME":"HHHHHHHH",…} sorted by name, to be freed; NULL where memory is short. */
char *crypto_names_manifest(const CryptoNames *names);
void crypto_names_close(CryptoNames *names);

/* ---- ranks of a pixel ---- */

enum { CRYPTO_PIXEL_MAX = 256 }; /* different names of a pixel that are told apart */

typedef struct CryptoShare {
    float number;
    double share;
} CryptoShare;

/* Begins with zeros. */
typedef struct CryptoPixel {
    int count;
    CryptoShare shares[CRYPTO_PIXEL_MAX];
} CryptoPixel;

/* What does not fit is lost. */
void crypto_pixel_add(CryptoPixel *pixel, float number, double share);
/* Numbers and shares by turns, the largest share first; what is beyond `ranks` is lost, what is missing is 0. */
void crypto_pixel_ranks(CryptoPixel *pixel, int ranks, float *values);

/* The key under which metadata of a kind of names, such as CryptoObject, stand: 7 digits and a NUL. */
void cryptomatte_key(char key[8], const char *kind);

#endif
