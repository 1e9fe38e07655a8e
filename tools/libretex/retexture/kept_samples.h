/* Rows of samples that are kept from one picture to the next. Private to libretex. */
#ifndef RETEX_RETEXTURE_KEPT_SAMPLES_H
#define RETEX_RETEXTURE_KEPT_SAMPLES_H

#include <retex/combine.h>

#include "base/row_span.h"

/* A row of a footprint with a finish, or one below 0. Only `span` of it, which is black elsewhere, is in memory; of the
 * columns beyond `columns` nothing is known. */
typedef struct RetexKeptRow {
    float *colors;
    RetexRowSpan span, columns; /* no columns: the row is not kept */
} RetexKeptRow;

/* RETEX_EINVAL where these are not the set's, or another target's. */
int retex_kept_samples_check(const RetexKeptSamples *kept, const RetexSet *set, int target, RetexError *err);

/* The row of a footprint if it is kept with these columns, or NULL. */
const RetexKeptRow *retex_kept_samples_find(RetexKeptSamples *kept, int footprint, int finish, int y,
                                            RetexRowSpan columns);
/* Keep a copy of a row, of which `row` is the pixel 0, if there is memory. No other thread may do so with the same row
 * of the same footprint. */
void retex_kept_samples_add(RetexKeptSamples *kept, int footprint, int finish, int y, RetexRowSpan columns,
                            RetexRowSpan span, const float *row);

#endif
