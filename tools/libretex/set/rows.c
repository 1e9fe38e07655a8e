/* See rows.h. */
#include "set/rows.h"

#include <stdlib.h>

#include "set/source.h"

/* A band of a spooled image. */
typedef struct SpooledBand {
    float *pixels; /* or NULL, until one is wanted */
    int number;
} SpooledBand;

/* What is not in memory, of a set or of samples. */
typedef struct Store {
    const RetexSpool *spool;
    RetexSetSource *source;
    void *reader;       /* of the source, or NULL */
    SpooledBand *bands; /* by part or image, or NULL where there is no spool */
    int count;
} Store;

struct RetexRowReader {
    const RetexSet *set;
    const RetexSamples *samples;
    Store of_set, of_samples;
};

static int store_open(Store *store, const RetexSpool *spool, RetexSetSource *source, int count, RetexError *err)
{
    *store = (Store){.spool = spool, .source = source, .count = count};
    if (spool && !(store->bands = calloc((size_t)count + 1, sizeof *store->bands)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    return source ? source->reader_open(source, &store->reader, err) : RETEX_OK;
}

static void store_close(Store *store)
{
    if (store->reader)
        store->source->reader_close(store->reader);
    for (int i = 0; store->bands && i < store->count; i++)
        free(store->bands[i].pixels);
    free(store->bands);
}

int retex_row_reader_open(RetexRowReader **result, const RetexSet *set, const RetexSamples *samples, RetexError *err)
{
    RetexRowReader *reader = *result = calloc(1, sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->set = set;
    reader->samples = samples;
    int code = set ? store_open(&reader->of_set, set->spool, set->source, set->nparts, err) : RETEX_OK;
    if (!code && samples)
        code = store_open(&reader->of_samples, samples->spool, samples->source, samples->nimages, err);
    if (code)
        retex_row_reader_close(result);
    return code;
}

void retex_row_reader_close(RetexRowReader **result)
{
    RetexRowReader *reader = *result;
    if (!reader)
        return;
    store_close(&reader->of_set);
    store_close(&reader->of_samples);
    free(reader);
    *result = NULL;
}

static int spooled_row(const float **row, Store *store, int index, int image, const RetexImage *shape, int y,
                       RetexError *err)
{
    const size_t length = (size_t)shape->width * (size_t)shape->channels;
    SpooledBand *band = &store->bands[index];
    const int number = y / RETEX_SPOOL_LINES, kept = band->pixels && band->number == number;
    int code = RETEX_OK;
    if (!band->pixels && !(band->pixels = malloc(RETEX_SPOOL_LINES * length * sizeof *band->pixels)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    if (!kept)
        code = retex_spool_load_band(store->spool, image, number, band->pixels, err);
    band->number = code ? -1 : number;
    *row = band->pixels + length * (size_t)(y % RETEX_SPOOL_LINES);
    return code;
}

int retex_row_reader_get_span(RetexRowReader *reader, int part, int y, const float **row, RetexRowSpan *span,
                              RetexError *err)
{
    const RetexPart *p = &reader->set->parts[part];
    Store *store = &reader->of_set;
    *span = (RetexRowSpan){0, p->image.width};
    if (p->image.pixels) {
        *row = p->image.pixels + retex_image_index(&p->image, 0, y);
        return RETEX_OK;
    }
    if (p->spooled)
        return spooled_row(row, store, part, p->spooled - 1, &p->image, y, err);
    if (!store->reader)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    return store->source->read_row(store->reader, part, y, row, span, err);
}

int retex_row_reader_get(RetexRowReader *reader, int part, int y, const float **row, RetexError *err)
{
    RetexRowSpan span;
    return retex_row_reader_get_span(reader, part, y, row, &span, err);
}

int retex_row_reader_sample(RetexRowReader *reader, int footprint, int y, const float **row, RetexError *err)
{
    const RetexSamples *samples = reader->samples;
    const RetexImage *image = &samples->images[footprint];
    Store *store = &reader->of_samples;
    if (image->pixels) {
        *row = image->pixels + retex_image_index(image, 0, y);
        return RETEX_OK;
    }
    if (samples->spooled[footprint])
        return spooled_row(row, store, footprint, samples->spooled[footprint] - 1, image, y, err);
    RetexRowSpan span;
    return store->source->read_row(store->reader, samples->stored[footprint] - 1, y, row, &span, err);
}
