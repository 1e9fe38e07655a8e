/* Rows of a set's parts and of its samples, wherever these are kept. Private to libretex. */
#ifndef RETEX_SET_ROWS_H
#define RETEX_SET_ROWS_H

#include <retex/samples.h>

#include "base/row_span.h"

typedef struct RetexRowReader RetexRowReader; /* one a thread */

/* Either may be NULL. */
int retex_row_reader_open(RetexRowReader **reader, const RetexSet *set, const RetexSamples *samples, RetexError *err);
void retex_row_reader_close(RetexRowReader **reader);

/* Row y of a part, its channels interleaved; NULL in *row where all of it is 0. It stays as it is until the next call
 * for the same part. */
int retex_row_reader_get(RetexRowReader *reader, int part, int y, const float **row, RetexError *err);
/* And beside what span it is known to be 0, if there is a row. */
int retex_row_reader_get_span(RetexRowReader *reader, int part, int y, const float **row, RetexRowSpan *span,
                              RetexError *err);
/* The same of the samples' image of a footprint. */
int retex_row_reader_sample(RetexRowReader *reader, int footprint, int y, const float **row, RetexError *err);

#endif
