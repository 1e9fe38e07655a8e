/* Samples, as the rooms that read and write them need them beyond <retex/samples.h>. Private to libretex. */
#ifndef RETEX_SET_SAMPLES_H
#define RETEX_SET_SAMPLES_H

#include <retex/samples.h>

#include "set/set.h"

/* Where an image is, and what it belongs to. */
typedef struct RetexSampleFootprint {
    int target, hit;  /* of the set's footprint: checked against the set, and part of the image's name in files */
    int footprint;    /* of the set; -1: the gates of a target, see retexture/view_gates.c */
    int finish;       /* the colour times the weight of this finish; -1: the colour; of gates -1, for all finishes */
    int store_image;  /* 0, or 1 + the number of the image in the band store */
    int source_image; /* 0, or 1 + the number of the image in the source */
} RetexSampleFootprint;

/* The file of the set that samples were made for, with the checksum of its manifest, which has those of all parts. */
typedef struct RetexSetReference {
    char path[4096]; /* absolute; "": none */
    uint64_t bytes;
    uint32_t crc;
} RetexSetReference;

/* Image i belongs to footprint i of the set; further ones are of textures with a map of finishes, first those of
 * footprints, then gates. They are RGB of the size of the footprint's parts, or unallocated where the footprint's
 * target keeps its original; gates have the size of the set, red, green and blue being weights of the second finish and
 * later ones. An image with a size but without pixels is in the band store or in the source. */
struct RetexSamples {
    int width, height; /* of the set */
    int nfootprints, nimages;
    RetexImage *images;               /* nimages */
    RetexSampleFootprint *footprints; /* nimages */
    int ntargets;
    char target_names[RETEX_MAX_TARGETS][RETEX_NAME_MAX];
    char textures[RETEX_MAX_TARGETS][256]; /* by target, the texture in words, for people to read; "" = none */
    uint32_t set_id;                       /* id of the set; 0 = unknown */
    RetexSetReference refers;              /* written with samples alone */
    RetexBandStore *store;                 /* owned, or NULL */
    RetexSetSource *source;                /* owned, or NULL */
};

enum {
    RETEX_SET_FOOTPRINTS_MAX = 512, /* of a set, in files, */
    RETEX_SAMPLE_IMAGES_MAX = RETEX_SET_FOOTPRINTS_MAX * (1 + RETEX_FINISHES_MAX) + RETEX_MAX_TARGETS
};

/* Create samples with nimages images, all unallocated, one for each footprint; the rest is 0. *samples is NULL after a
 * failure. */
int retex_samples_alloc(RetexSamples **samples, int nimages, RetexError *err);

/* Add an image, unallocated, beyond those of footprints' colours. */
int retex_samples_add(RetexSamples *samples, RetexSampleFootprint of, RetexError *err);
/* The image of a footprint with a finish, or with footprint -1 the gate of a target; -1: there is none. */
int retex_samples_find(const RetexSamples *samples, int target, int footprint, int finish);

/* Check that numbers and sizes of the samples agree among themselves. */
int retex_samples_are_sound(const RetexSamples *samples, RetexError *err);

#endif
