/* The interface of an open file from which parts of a set are read. Private to libretex. */
#ifndef RETEX_SET_SOURCE_H
#define RETEX_SET_SOURCE_H

#include "base/row_span.h"
#include "exr/stored.h"
#include "set/set.h"

struct RetexSetSource {
    void (*close)(RetexSetSource *source);
    /* Open a reader of rows, one for each thread. */
    int (*reader_open)(RetexSetSource *source, void **reader, RetexError *err);
    void (*reader_close)(void *reader);
    /* Read row y of a part, its channels interleaved; *row is NULL where all of it is 0. The row is 0 outside of span.
     * It belongs to the reader and stays valid until the next call for the same part. Rows are cheapest to read from
     * the top down. */
    int (*read_row)(void *reader, int part, int y, const float **row, RetexRowSpan *span, RetexError *err);
    /* The chunks of a part as they are stored; 0 where they cannot be copied into an EXR file. NULL: none can. */
    int (*stored)(RetexSetSource *source, int part, RetexPixelType type, RetexExrStored *stored);
};

#endif
