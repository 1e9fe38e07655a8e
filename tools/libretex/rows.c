/* See rows.h. */
#include "rows.h"

#include <stdlib.h>

struct RowReader {
    const RetexSet *set;
};

int row_reader_open(RowReader **result, const RetexSet *set, RetexError *err)
{
    RowReader *reader = *result = calloc(1, sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->set = set;
    return RETEX_OK;
}

void row_reader_close(RowReader **reader)
{
    free(*reader);
    *reader = NULL;
}

int row_reader_get(RowReader *reader, int part, int y, const float **row, RetexError *err)
{
    const RetexPart *p = &reader->set->parts[part];
    if (!p->image.pixels)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    *row = p->image.pixels + retex_image_index(&p->image, 0, y);
    return RETEX_OK;
}
