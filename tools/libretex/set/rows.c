/* See rows.h. */
#include "set/rows.h"

#include <stdlib.h>

#include <retex/host/assert.h>
#include <retex/host/band_store.h>

#include "set/samples.h"
#include "set/source.h"

/* The last decoded band of an image in a band store. */
typedef struct StoredBand {
    float *pixels; /* NULL until a band is needed */
    int number;
} StoredBand;

/* The band store and the source of a set, or of samples. */
typedef struct Backing {
    const RetexBandStore *store;
    RetexSetSource *source;
    void *reader;      /* reader of the source, or NULL */
    StoredBand *bands; /* by part or image, or NULL where there is no band store */
    int count;
} Backing;

struct RetexRowReader {
    const RetexSet *set;
    const RetexSamples *samples;
    Backing of_set, of_samples;
};

static int backing_open(Backing *backing, const RetexBandStore *store, RetexSetSource *source, int count,
                        RetexError *err)
{
    *backing = (Backing){.store = store, .source = source, .count = count};
    if (store && !(backing->bands = calloc((size_t)count + 1, sizeof *backing->bands)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    return source ? source->reader_open(source, &backing->reader, err) : RETEX_OK;
}

static void backing_close(Backing *backing)
{
    if (backing->reader)
        backing->source->reader_close(backing->reader);
    for (int i = 0; backing->bands && i < backing->count; i++)
        free(backing->bands[i].pixels);
    free(backing->bands);
}

int retex_row_reader_open(RetexRowReader **result, const RetexSet *set, const RetexSamples *samples, RetexError *err)
{
    RetexRowReader *reader = *result = calloc(1, sizeof *reader);
    if (!reader)
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    reader->set = set;
    reader->samples = samples;
    int code = set ? backing_open(&reader->of_set, set->store, set->source, set->nparts, err) : RETEX_OK;
    if (!code && samples)
        code = backing_open(&reader->of_samples, samples->store, samples->source, samples->nimages, err);
    if (code)
        retex_row_reader_close(result);
    return code;
}

void retex_row_reader_close(RetexRowReader **result)
{
    RetexRowReader *reader = *result;
    if (!reader)
        return;
    backing_close(&reader->of_set);
    backing_close(&reader->of_samples);
    free(reader);
    *result = NULL;
}

static int stored_row(const float **row, Backing *backing, int index, int image, const RetexImage *shape, int y,
                      RetexError *err)
{
    const size_t length = (size_t)shape->width * (size_t)shape->channels;
    StoredBand *band = &backing->bands[index];
    const int number = y / RETEX_BAND_ROWS, is_loaded = band->pixels && band->number == number;
    int code = RETEX_OK;
    if (!band->pixels && !(band->pixels = malloc(RETEX_BAND_ROWS * length * sizeof *band->pixels)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    if (!is_loaded)
        code = retex_band_store_load_band(backing->store, image, number, band->pixels, err);
    band->number = code ? -1 : number;
    *row = band->pixels + length * (size_t)(y % RETEX_BAND_ROWS);
    return code;
}

int retex_row_reader_get_span(RetexRowReader *reader, int part, int y, const float **row, RetexRowSpan *span,
                              RetexError *err)
{
    RETEX_ASSERT(part >= 0 && part < reader->set->nparts); /* an index of the set's parts, not of a file's */
    const RetexPart *p = &reader->set->parts[part];
    Backing *backing = &reader->of_set;
    RETEX_ASSERT(y >= 0 && y < p->image.height); /* of the part, which may be smaller than the picture */
    RETEX_ASSERT(!p->store_image || reader->set->store);
    *span = (RetexRowSpan){0, p->image.width};
    if (p->image.pixels) {
        *row = p->image.pixels + retex_image_index(&p->image, 0, y);
        return RETEX_OK;
    }
    if (p->store_image)
        return stored_row(row, backing, part, p->store_image - 1, &p->image, y, err);
    if (!backing->reader)
        return retex_fail(err, RETEX_EINVAL, "part %s of the set is not in memory", p->name);
    const int code = backing->source->read_row(backing->reader, part, y, row, span, err);
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

int retex_row_reader_sample(RetexRowReader *reader, int footprint, int y, const float **row, RetexError *err)
{
    const RetexSamples *samples = reader->samples;
    RETEX_ASSERT(footprint >= 0 && footprint < samples->nimages); /* of the samples, which have more than footprints */
    RETEX_ASSERT(retex_samples_have(samples, footprint));
    const RetexImage *image = &samples->images[footprint];
    Backing *backing = &reader->of_samples;
    if (image->pixels) {
        *row = image->pixels + retex_image_index(image, 0, y);
        return RETEX_OK;
    }
    if (samples->footprints[footprint].store_image)
        return stored_row(row, backing, footprint, samples->footprints[footprint].store_image - 1, image, y, err);
    RetexRowSpan span;
    return backing->source->read_row(backing->reader, samples->footprints[footprint].source_image - 1, y, row, &span,
                                     err);
}
