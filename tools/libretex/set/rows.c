/* See rows.h. */
#include "set/rows.h"

#include <stdlib.h>

#include <retex/host/assert.h>

#include "set/source.h"

/* A source of some part, with this reader's own reader of it. */
typedef struct OpenSource {
    RetexSetSource *source;
    void *reader;
} OpenSource;

struct RetexRowReader {
    const RetexSet *set;
    OpenSource *sources;
    int count;
};

/* The open source, which is opened by the first call. */
static int open_source(const OpenSource **result, RetexRowReader *reader, RetexSetSource *source, RetexError *err)
{
    for (int i = 0; i < reader->count; i++)
        if (reader->sources[i].source == source) {
            *result = &reader->sources[i];
            return RETEX_OK;
        }
    OpenSource *sources = realloc(reader->sources, sizeof *sources * ((size_t)reader->count + 1));
    if (!sources)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->sources = sources;
    OpenSource *open = &sources[reader->count];
    const int code = source->reader_open(source, &open->reader, err);
    open->source = source;
    reader->count += !code;
    *result = open;
    return code;
}

int retex_row_reader_open(RetexRowReader **result, const RetexSet *set, RetexError *err)
{
    RetexRowReader *reader = *result = calloc(1, sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->set = set;
    return RETEX_OK;
}

void retex_row_reader_close(RetexRowReader **result)
{
    RetexRowReader *reader = *result;
    if (!reader)
        return;
    for (int i = 0; i < reader->count; i++)
        reader->sources[i].source->reader_close(reader->sources[i].reader);
    free(reader->sources);
    free(reader);
    *result = NULL;
}

int retex_row_reader_get_span(RetexRowReader *reader, int part, int y, const float **row, RetexRowSpan *span,
                              RetexError *err)
{
    RETEX_ASSERT(part >= 0 && part < reader->set->nparts); /* an index of the set's parts, not of a file's */
    const RetexPart *p = &reader->set->parts[part];
    RETEX_ASSERT(y >= 0 && y < p->image.height); /* of the part, which may be smaller than the picture */
    *span = (RetexRowSpan){0, p->image.width};
    if (p->image.pixels) {
        *row = p->image.pixels + retex_image_index(&p->image, 0, y);
        return RETEX_OK;
    }
    const OpenSource *open = NULL;
    int code = p->source ? open_source(&open, reader, p->source, err)
                         : retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    if (code)
        return code;
    code = open->source->read_row(open->reader, p->source_part, y, row, span, err);
    RETEX_ASSERT(code || !*row || retex_span_holds(*span, *row, p->image.width, p->image.channels));
    if (!code && !*row)
        *span = (RetexRowSpan){0, 0};
    return code;
}

int retex_row_reader_get(RetexRowReader *reader, int part, int y, const float **row, RetexError *err)
{
    RetexRowSpan span;
    return retex_row_reader_get_span(reader, part, y, row, &span, err);
}
