/* See rows.h. */
#include "rows.h"

#include <stdlib.h>

#include "set_source.h"

/* A band of a spooled part. */
typedef struct SpooledBand {
    float *pixels; /* or NULL, until one is wanted */
    int number;
} SpooledBand;

struct RowReader {
    const RetexSet *set;
    void *source;       /* its reader, or NULL */
    SpooledBand *bands; /* by part, or NULL where the set has no spool */
};

int row_reader_open(RowReader **result, const RetexSet *set, RetexError *err)
{
    RowReader *reader = *result = calloc(1, sizeof *reader);
    if (reader)
        reader->set = set;
    if (reader && set->spool)
        reader->bands = calloc((size_t)set->nparts + 1, sizeof *reader->bands);
    int code = !reader || (set->spool && !reader->bands)
                   ? retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows")
                   : RETEX_OK;
    if (!code && set->source)
        code = set->source->reader_open(set->source, &reader->source, err);
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
    for (int i = 0; reader->bands && i < reader->set->nparts; i++)
        free(reader->bands[i].pixels);
    free(reader->bands);
    free(reader);
    *result = NULL;
}

static int spooled_row(const float **row, RowReader *reader, int part, int y, RetexError *err)
{
    const RetexPart *p = &reader->set->parts[part];
    const size_t length = (size_t)p->image.width * (size_t)p->image.channels;
    SpooledBand *band = &reader->bands[part];
    const int number = y / RETEX_SPOOL_LINES, kept = band->pixels && band->number == number;
    int code = RETEX_OK;
    if (!band->pixels && !(band->pixels = malloc(RETEX_SPOOL_LINES * length * sizeof *band->pixels)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    if (!kept)
        code = retex_spool_load_band(reader->set->spool, p->spooled - 1, number, band->pixels, err);
    band->number = code ? -1 : number;
    *row = band->pixels + length * (size_t)(y % RETEX_SPOOL_LINES);
    return code;
}

int row_reader_get(RowReader *reader, int part, int y, const float **row, RetexError *err)
{
    const RetexPart *p = &reader->set->parts[part];
    if (p->image.pixels) {
        *row = p->image.pixels + retex_image_index(&p->image, 0, y);
        return RETEX_OK;
    }
    if (p->spooled)
        return spooled_row(row, reader, part, y, err);
    if (!reader->source)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    return reader->set->source->read_row(reader->source, part, y, row, err);
}
