/* Where a row of pixels is not 0. Private to libretex. */
#ifndef RETEX_BASE_ROW_SPAN_H
#define RETEX_BASE_ROW_SPAN_H

/* Pixels from `begin` on, before `end`; none unless begin < end. */
typedef struct RetexRowSpan {
    int begin, end;
} RetexRowSpan;

static inline int retex_span_is_empty(RetexRowSpan span)
{
    return span.begin >= span.end;
}

/* What lies in both. */
static inline RetexRowSpan retex_span_intersection(RetexRowSpan a, RetexRowSpan b)
{
    return (RetexRowSpan){a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end};
}

/* All that lies in one of them, and between them. */
static inline RetexRowSpan retex_span_union(RetexRowSpan a, RetexRowSpan b)
{
    if (retex_span_is_empty(a) || retex_span_is_empty(b))
        return retex_span_is_empty(a) ? b : a;
    return (RetexRowSpan){a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

#endif
