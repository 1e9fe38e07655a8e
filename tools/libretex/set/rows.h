/* Rows of a set's parts and of its samples, wherever these are kept. Private to libretex. */
#ifndef RETEX_SET_ROWS_H
#define RETEX_SET_ROWS_H

#include <retex/set.h>

#include "base/row_span.h"

typedef struct RowReader RowReader; /* one a thread */

/* Either may be NULL. */
int row_reader_open(RowReader **reader, const RetexSet *set, const RetexSamples *samples, RetexError *err);
void row_reader_close(RowReader **reader);

/* Row y of a part, its channels interleaved; NULL in *row where all of it is 0. It stays as it is until the next call
 * for the same part. */
int row_reader_get(RowReader *reader, int part, int y, const float **row, RetexError *err);
/* And beside what span it is known to be 0, if there is a row. */
int row_reader_get_span(RowReader *reader, int part, int y, const float **row, RowSpan *span, RetexError *err);
/* The same of the samples' image of a footprint. */
int row_reader_sample(RowReader *reader, int footprint, int y, const float **row, RetexError *err);

#endif
