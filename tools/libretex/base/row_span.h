/* Where a row of pixels is not 0. Private to libretex. */
#ifndef RETEX_BASE_ROW_SPAN_H
#define RETEX_BASE_ROW_SPAN_H

/* Pixels from `begin` on, before `end`; none unless begin < end. */
typedef struct RowSpan {
    int begin, end;
} RowSpan;

static inline int span_is_empty(RowSpan span)
{
    return span.begin >= span.end;
}

/* What lies in both. */
static inline RowSpan span_within(RowSpan a, RowSpan b)
{
    return (RowSpan){a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end};
}

/* All that lies in one of them, and between them. */
static inline RowSpan span_around(RowSpan a, RowSpan b)
{
    if (span_is_empty(a) || span_is_empty(b))
        return span_is_empty(a) ? b : a;
    return (RowSpan){a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

#endif
