/* Where rows of parts are that are not in memory: an open EXR file, an open pack, a band store, or a view that computes
 * them. Private to libretex. */
#ifndef RETEX_SET_SOURCE_H
#define RETEX_SET_SOURCE_H

#include <stdatomic.h>

#include "base/row_span.h"
#include "exr/stored.h"
#include "set/set.h"

struct RetexSetSource {
    void (*close)(RetexSetSource *source); /* called when nothing holds it any more */
    /* Open a reader of rows, one for each thread. */
    int (*reader_open)(RetexSetSource *source, void **reader, RetexError *err);
    void (*reader_close)(void *reader);
    /* Read row y of a part, its channels interleaved; *row is NULL where all of it is 0. The row is 0 outside of span.
     * It belongs to the reader and stays valid until the next call for the same part. Rows are cheapest to read from
     * the top down. */
    int (*read_row)(void *reader, int part, int y, const float **row, RetexRowSpan *span, RetexError *err);
    /* The chunks of a part as they are stored; 0 where they cannot be copied into an EXR file. NULL: none can. */
    int (*stored)(RetexSetSource *source, int part, RetexPixelType type, RetexExrStored *stored);
    atomic_int holders; /* parts, and whoever made it; files are written of one set by several threads */
};

/* A source begins with one holder, and is closed when the last one releases it, which is NULL afterwards. */
void retex_source_release(RetexSetSource **source);

/* A part that is copied as a structure holds its source, too. */
static inline void retex_part_hold(RetexPart *part)
{
    if (part->source)
        part->source->holders++;
}

/* Let part number `number` of a source be where a part's rows are, in place of what it had; source NULL: none. */
void retex_part_set_source(RetexPart *part, RetexSetSource *source, int number);

/* Make a source whose parts are the images of a band store. It owns the store, whatever is returned. */
int retex_store_source_open(RetexSetSource **source, RetexBandStore *store, RetexError *err);
/* The band store where a part's rows are; NULL: they are not in one. */
RetexBandStore *retex_part_store(const RetexPart *part);

#endif
