/* Reads rows of a set's parts, from memory or from their sources. Private to libretex. */
#ifndef RETEX_SET_ROWS_H
#define RETEX_SET_ROWS_H

#include <retex/set.h>

#include "base/row_span.h"

typedef struct RetexRowReader RetexRowReader; /* one for each thread */

/* Open a reader. Each source is opened when the first of its rows is asked for. */
int retex_row_reader_open(RetexRowReader **reader, const RetexSet *set, RetexError *err);
void retex_row_reader_close(RetexRowReader **reader);

/* Read row y of a part, its channels interleaved; *row is NULL where all of it is 0. The row stays valid until the next
 * call for the same part. */
int retex_row_reader_get(RetexRowReader *reader, int part, int y, const float **row, RetexError *err);
/* The same with the span outside of which the row is known to be 0; empty if *row is NULL. */
int retex_row_reader_get_span(RetexRowReader *reader, int part, int y, const float **row, RetexRowSpan *span,
                              RetexError *err);

#endif
