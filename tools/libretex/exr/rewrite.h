/* Copies an EXR file, with new pixels in some of its channels. Private to libretex. */
#ifndef RETEX_EXR_REWRITE_H
#define RETEX_EXR_REWRITE_H

#include "exr/io.h"

/* New pixels of one channel: of the part's data window, row by row from the top. */
typedef struct RetexExrReplacement {
    int part, channel;   /* numbers in the file */
    const float *pixels; /* borrowed */
    size_t stride;       /* floats from pixel to pixel */
} RetexExrReplacement;

/* RETEX_OK if every part of the file can be copied: all are flat, and none has levels of detail. */
int retex_exr_rewrite_check(RetexExr *exr, RetexError *err);

/* Write the file again to path ("-" = standard output). All other channels keep their bits; parts keep their names,
 * windows, pixel types and attributes, apart from these of parts with a new channel: where the compression loses
 * something it becomes one that loses nothing, ZIP or PIZ, and lines stand in increasing order. */
int retex_exr_rewrite(RetexExr *exr, const RetexExrReplacement *replacements, int count, const char *path, int nthreads,
                      RetexError *err);

#endif
