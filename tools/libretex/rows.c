/* See rows.h. */
#include "rows.h"

#include <stdlib.h>

#include "set_source.h"

struct RowReader {
    const RetexSet *set;
    void *source; /* its reader, or NULL */
};

int row_reader_open(RowReader **result, const RetexSet *set, RetexError *err)
{
    RowReader *reader = *result = calloc(1, sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->set = set;
    int code = set->source ? set->source->reader_open(set->source, &reader->source, err) : RETEX_OK;
    if (code)
        row_reader_close(result);
    return code;
}

void row_reader_close(RowReader **result)
{
    RowReader *reader = *result;
    if (!reader)
        return;
    if (reader->source)
        reader->set->source->reader_close(reader->source);
    free(reader);
    *result = NULL;
}

int row_reader_get(RowReader *reader, int part, int y, const float **row, RetexError *err)
{
    const RetexPart *p = &reader->set->parts[part];
    if (p->image.pixels) {
        *row = p->image.pixels + retex_image_index(&p->image, 0, y);
        return RETEX_OK;
    }
    if (!reader->source)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    return reader->set->source->read_row(reader->source, part, y, row, err);
}
