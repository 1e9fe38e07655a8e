/* Spans: the part of a row outside of which all pixels are 0. Private to libretex. */
#ifndef RETEX_BASE_ROW_SPAN_H
#define RETEX_BASE_ROW_SPAN_H

/* Pixels begin <= x < end; empty unless begin < end. */
typedef struct RetexRowSpan {
    int begin, end;
} RetexRowSpan;

static inline int retex_span_is_empty(RetexRowSpan span)
{
    return span.begin >= span.end;
}

/* Whether a row of `width` pixels keeps the promise of its span. numbers: of a pixel. For assertions: it takes time. */
static inline int retex_span_holds(RetexRowSpan span, const float *row, int width, int numbers)
{
    int holds = retex_span_is_empty(span) || (span.begin >= 0 && span.end <= width);
    for (int i = 0; i < width * numbers && holds; i++)
        holds = row[i] == 0 || (i / numbers >= span.begin && i / numbers < span.end);
    return holds;
}

/* The pixels in both spans. */
static inline RetexRowSpan retex_span_intersection(RetexRowSpan a, RetexRowSpan b)
{
    return (RetexRowSpan){a.begin > b.begin ? a.begin : b.begin, a.end < b.end ? a.end : b.end};
}

/* The smallest span that contains both. */
static inline RetexRowSpan retex_span_union(RetexRowSpan a, RetexRowSpan b)
{
    if (retex_span_is_empty(a) || retex_span_is_empty(b))
        return retex_span_is_empty(a) ? b : a;
    return (RetexRowSpan){a.begin < b.begin ? a.begin : b.begin, a.end > b.end ? a.end : b.end};
}

#endif
