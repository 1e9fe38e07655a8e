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

static OpenSource *find_source(const RetexRowReader *reader, const RetexSetSource *source)
{
    for (int i = 0; i < reader->count; i++)
        if (reader->sources[i].source == source)
            return &reader->sources[i];
    return NULL;
}

static int add_source(RetexRowReader *reader, RetexSetSource *source, RetexError *err)
{
    OpenSource *sources = realloc(reader->sources, sizeof *sources * ((size_t)reader->count + 1));
    if (!sources)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->sources = sources;
    const int code = source->reader_open(source, &sources[reader->count].reader, err);
    sources[reader->count].source = source;
    reader->count += !code;
    return code;
}

int retex_row_reader_open(RetexRowReader **result, const RetexSet *set, RetexError *err)
{
    RetexRowReader *reader = *result = calloc(1, sizeof *reader);
    int code = reader ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    if (code)
        return code;
    reader->set = set;
    for (int i = 0; i < set->nparts && !code; i++)
        if (set->parts[i].source && !find_source(reader, set->parts[i].source))
            code = add_source(reader, set->parts[i].source, err);
    if (code)
        retex_row_reader_close(result);
    return code;
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
    const OpenSource *open = find_source(reader, p->source);
    if (!open)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    const int code = open->source->read_row(open->reader, p->source_part, y, row, span, err);
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
