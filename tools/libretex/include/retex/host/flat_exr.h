/* A flat OpenEXR file: one part, whatever its channels, with text attributes. Every program that reads OpenEXR reads
 * such a file; not every one reads several parts. Rows are computed by the caller, 16 at a time and on all threads, and
 * are compressed at once, so that the picture is never in memory as a whole. */
#ifndef RETEX_HOST_FLAT_EXR_H
#define RETEX_HOST_FLAT_EXR_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexFlatChannel {
    char name[RETEX_NAME_MAX + 8]; /* LAYER.R */
    RetexPixelType type;
} RetexFlatChannel;

/* An attribute of type string. */
typedef struct RetexFlatText {
    const char *name, *value;
} RetexFlatText;

/* Where rows come from. `begin` (NULL = nothing to do) is called before each 16 rows, or those that are left, are asked
 * for: `lines` rows from y on, by the same thread. It returns 0, or a RetexCode, which ends the work. `row` fills one
 * row of a channel. `texts` (NULL = none) gives the attributes, and is called once when all rows are there; it returns
 * NULL where memory is short. */
typedef struct RetexFlatRows {
    void *context;
    int (*begin)(void *context, int y, int lines, int thread);
    void (*row)(void *context, int channel, int y, int thread, float *values);
    const RetexFlatText *(*texts)(void *context, int *count);
} RetexFlatRows;

/* Write a picture of width by height pixels, with ZIP compression, to path ("-": standard output). The channels are in
 * the order of strcmp, as OpenEXR has them, and differ. */
int retex_flat_exr_write(const char *path, int width, int height, const RetexFlatChannel *channels, int nchannels,
                         const RetexFlatRows *rows, int nthreads /* 0 = all cores */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
