/* The manifest of a batch: a text file with a line of JSON for each picture that was made: what it was made from, and
 * its checksum. --resume and --verify compare it with the pictures and their sources.
 *
 * Lines are only appended, each under a lock, so that many processes can share a manifest, and several
 * manifests can be joined. The last line of an output counts. A line that is cut off counts as absent. Lines are
 * compared as text, so that they have to stay as they were written. */
#ifndef RETEX_BATCH_MANIFEST_H
#define RETEX_BATCH_MANIFEST_H

#include "cli.h"

/* What the manifest says about a picture. */
typedef enum PictureState {
    PICTURE_GOOD,    /* made from the present sources, and unchanged as far as was looked */
    PICTURE_MISSING, /* there is no such file */
    PICTURE_UNKNOWN, /* there is a file, but the manifest does not have it */
    PICTURE_STALE,   /* made from other sources */
    PICTURE_DAMAGED  /* another size or checksum than it was made with */
} PictureState;
enum { PICTURE_STATES = PICTURE_DAMAGED + 1 };
extern const char *const picture_state_names[PICTURE_STATES];

typedef struct ManifestLine {
    const char *text;
    size_t key; /* bytes of the text that name the output */
} ManifestLine;

/* Zero-initialized. */
typedef struct BatchManifest {
    const char *path;
    int descriptor; /* 1 + the file's, or 0: none */
    char *text;
    ManifestLine *lines; /* sorted by key; the last line of each output only */
    size_t nlines;
} BatchManifest;

/* Read the manifest. make = 1: it is created if it does not exist, and lines can be added. */
int batch_manifest_open(BatchManifest *manifest, const char *path, int make, RetexError *err);
void batch_manifest_close(BatchManifest *manifest);

/* Claim rows of a table, so that no other process with this manifest makes them at the same time; until the process
 * ends. table: a number that tells tables apart. RETEX_EIO if some are claimed already. */
int batch_manifest_claim(const BatchManifest *manifest, uint32_t table, int first, int count, RetexError *err);

/* The state of the picture at path. sources: the beginning of its line, up to what is known when it has been made.
 * checksum = 1: read the whole file, otherwise only its size is compared. reason: why it is stale or damaged, or "". */
PictureState batch_manifest_state(const BatchManifest *manifest, const char *sources, const char *path, int checksum,
                                  char *reason, size_t size);
/* Append the line of a picture that was made, and tell its size. Files that are not regular are left out. */
int batch_manifest_add(const BatchManifest *manifest, const char *sources, const char *path, double seconds,
                       RetexError *err);

#endif
