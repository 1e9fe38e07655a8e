/* See source.h. */
#include "set/source.h"

#include <stdlib.h>
#include <string.h>

#include <retex/host/assert.h>

#include "exr/band_store_file.h"

void retex_source_release(RetexSetSource **source)
{
    RETEX_ASSERT(!*source || (*source)->holders > 0);
    if (*source && --(*source)->holders == 0)
        (*source)->close(*source);
    *source = NULL;
}

void retex_part_set_source(RetexPart *part, RetexSetSource *source, int number)
{
    if (source)
        source->holders++; /* before the old one is released, which may be the same */
    retex_source_release(&part->source);
    part->source = source;
    part->source_part = number;
}

/* ---- band stores ---- */

typedef struct StoreSource {
    RetexSetSource methods; /* first */
    RetexBandStore *store;
} StoreSource;

/* The band of an image that was read last. */
typedef struct StoredBand {
    float *pixels; /* NULL until a band is needed */
    int number;    /* -1: none */
} StoredBand;

typedef struct StoreReader {
    const RetexBandStore *store;
    int count;
    StoredBand *bands; /* by image */
} StoreReader;

static void source_close(RetexSetSource *methods)
{
    StoreSource *source = (StoreSource *)(void *)methods;
    retex_band_store_close(&source->store);
    free(source);
}

static int reader_open(RetexSetSource *methods, void **result, RetexError *err)
{
    const RetexBandStore *store = ((StoreSource *)(void *)methods)->store;
    StoreReader *reader = *result = calloc(1, sizeof *reader);
    if (reader)
        *reader = (StoreReader){store, store->nimages, calloc((size_t)store->nimages + 1, sizeof *reader->bands)};
    if (reader && reader->bands)
        return RETEX_OK;
    free(reader);
    *result = NULL;
    return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
}

static void reader_close(void *data)
{
    StoreReader *reader = data;
    for (int i = 0; i < reader->count; i++)
        free(reader->bands[i].pixels);
    free(reader->bands);
    free(reader);
}

static int read_row(void *data, int image, int y, const float **row, RetexRowSpan *span, RetexError *err)
{
    StoreReader *reader = data;
    RETEX_ASSERT(image >= 0 && image < reader->count); /* all images are added before rows are read */
    const size_t length = (size_t)reader->store->width * strlen(reader->store->images[image]->letters);
    StoredBand *band = &reader->bands[image];
    const int number = y / RETEX_BAND_ROWS, is_loaded = band->pixels && band->number == number;
    int code = RETEX_OK;
    if (!band->pixels && !(band->pixels = malloc(RETEX_BAND_ROWS * length * sizeof *band->pixels)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    if (!is_loaded)
        code = retex_band_store_load_band(reader->store, image, number, band->pixels, err);
    band->number = code ? -1 : number;
    *row = band->pixels + length * (size_t)(y % RETEX_BAND_ROWS);
    *span = (RetexRowSpan){0, reader->store->width};
    return code;
}

int retex_store_source_open(RetexSetSource **result, RetexBandStore *store, RetexError *err)
{
    static const RetexSetSource methods = {source_close, reader_open, reader_close, read_row, NULL, 1};
    StoreSource *source = calloc(1, sizeof *source);
    *result = NULL;
    if (!source) {
        retex_band_store_close(&store);
        return retex_fail(err, RETEX_ENOMEM, "no memory to read a set's rows");
    }
    *source = (StoreSource){methods, store};
    *result = &source->methods;
    return RETEX_OK;
}

RetexBandStore *retex_part_store(const RetexPart *part)
{
    return part->source && part->source->close == source_close ? ((StoreSource *)(void *)part->source)->store : NULL;
}
