/* The numbers of a density_file: Pattern.data. */
#ifndef RENDERER_PATTERN_DENSITY_FILE_H
#define RENDERER_PATTERN_DENSITY_FILE_H

#include "pattern/pattern.h"

typedef struct DensityFile {
    int size[3];
    int bytes;                   /* of each number: 1, 2 or 4, the highest first */
    const unsigned char *values; /* x runs fastest, then y */
} DensityFile;

#endif
