/* The manifest: what an EXR file's parts mean, as JSON; see retex-set(5). */
#ifndef RETEX_SET_MANIFEST_H
#define RETEX_SET_MANIFEST_H

#include "base/part_name.h"
#include "set/set.h"

enum { RETEX_SET_TERMS_MAX = 4096 };

#define RETEX_MANIFEST_ATTRIBUTE "retex" /* name of the attribute of an EXR file's first part that holds the manifest */

/* Checksums of bands in the manifest: for each band of RETEX_BAND_ROWS rows the CRC-32 of its samples, computed as
 * RetexPart.crc is. of[i] is that of part i of the set; NULL where it is not known. */
typedef struct RetexBandSums {
    int count;
    uint32_t **of;
} RetexBandSums;

void retex_band_sums_free(RetexBandSums *sums);

/* Like retex_set_manifest, with checksums of bands (or NULL). */
int retex_manifest_write(const RetexSet *set, const RetexBandSums *sums, char **json, RetexError *err);

/* The manifest's checksum of itself. Its text begins {"retex":VERSION,"crc32":"DIGITS", and the eight hexadecimal
 * digits are the CRC-32 of all of it with 0s in their place. */
typedef enum RetexManifestSum { RETEX_MANIFEST_UNSEALED, RETEX_MANIFEST_RIGHT, RETEX_MANIFEST_WRONG } RetexManifestSum;

RetexManifestSum retex_manifest_sum(const char *json); /* RETEX_MANIFEST_UNSEALED: it has no checksum */
uint32_t retex_manifest_own_sum(const char *json);     /* of a text that has it */
void retex_manifest_seal(char *json);                  /* fill in the checksum, where the text has a place for it */

/* Parse a manifest. *set is created without pixels: its parts have width, height and channels. name: the file, for
 * messages. sums (or NULL) is filled, to be freed. */
int retex_manifest_read(const char *json, const char *name, RetexSet **set, RetexBandSums *sums, RetexError *err);

#endif
