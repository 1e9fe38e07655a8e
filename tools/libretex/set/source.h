/* Where the parts of a set are that are not in memory: in a file that is open. Private to libretex. */
#ifndef RETEX_SET_SOURCE_H
#define RETEX_SET_SOURCE_H

#include <retex/set.h>

#include "base/row_span.h"

struct RetexSetSource {
    void (*close)(RetexSetSource *source);
    /* Readers of rows, one a thread. */
    int (*reader_open)(RetexSetSource *source, void **reader, RetexError *err);
    void (*reader_close)(void *reader);
    /* Row y of the set's part of that number, its channels interleaved; NULL where all of it is 0. Beside the span it
     * is 0. It is the reader's, and stays until the next call for the same part. Cheapest from the top, row after row.
     */
    int (*read_row)(void *reader, int part, int y, const float **row, RetexRowSpan *span, RetexError *err);
};

#endif
