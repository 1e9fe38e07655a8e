/* The manifest: what an EXR file's parts mean, as JSON; see retex-set(5). */
#ifndef RETEX_SET_MANIFEST_H
#define RETEX_SET_MANIFEST_H

#include "base/part_name.h"
#include "set/samples.h"

enum {
    RETEX_SET_TERMS_MAX = 4096,
    RETEX_SAMPLE_NAME_MAX = 192     /* bytes of a sample part's name, with the final NUL */
};

#define RETEX_MANIFEST_ATTRIBUTE "retex" /* of an EXR file's first part: where it is */

/* What the manifest says of one of the file's samples parts. */
typedef struct RetexSamplePart {
    char name[RETEX_SAMPLE_NAME_MAX]; /* "" where the footprint's target keeps its original */
    uint32_t crc;
} RetexSamplePart;

/* Names of the samples' parts, unique among themselves and the set's (which may be NULL). parts has nimages places. */
void retex_sample_part_names(const RetexSamples *samples, const RetexSet *set, RetexSamplePart *parts);

/* What the manifest says of bands of RETEX_BAND_ROWS rows: of each the CRC-32 of its samples, as the part's is of
 * all. Of the set's parts, then of the samples' images; NULL where it is not known. */
typedef struct RetexBandSums {
    int count;
    uint32_t **of;
} RetexBandSums;

void retex_band_sums_free(RetexBandSums *sums);

/* As retex_set_manifest, with the sample parts' names and checksums, and those of bands (or NULL). */
int retex_manifest_write(const RetexSet *set, const RetexSamples *samples, const RetexSamplePart *sample_parts,
                         const RetexBandSums *sums, char **json, RetexError *err);

/* The manifest's checksum of itself. Its text begins {"retex":VERSION,"crc32":"DIGITS", and the eight hexadecimal
 * digits are the CRC-32 of all of it with 0s in their place. */
enum { RETEX_MANIFEST_FIRST_WITH_SUM = 3 }; /* version */
typedef enum RetexManifestSum { RETEX_MANIFEST_PLAIN, RETEX_MANIFEST_RIGHT, RETEX_MANIFEST_WRONG } RetexManifestSum;

RetexManifestSum retex_manifest_sum(const char *json); /* PLAIN: there is none */
void retex_manifest_seal(char *json);                  /* fill it in, where there is a place for it */

/* From JSON. *set and *samples are created, without pixels: parts know their size in image.width, height and channels,
 * and so do those images of *samples that sample_parts (allocated here, free with free()) names. What the manifest does
 * not describe comes back NULL. name: the file, for messages. sums (or NULL) is to be freed. */
int retex_manifest_read(const char *json, const char *name, RetexSet **set, RetexSamples **samples,
                        RetexSamplePart **sample_parts, RetexBandSums *sums, RetexError *err);

#endif
