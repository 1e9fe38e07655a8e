/* See bands.h. Memory is taken where a pixel is first asked for: most images have nothing in most bands. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "film/bands.h"
#include <retex/host/assert.h>
#include <retex/host/set_build.h>

#include "film/limits.h"

typedef struct BandImage {
    char name[RETEX_NAME_MAX], letters[8];
    RetexPixelType type;
    size_t channels;
    int store_image;   /* its number in the band store */
    atomic_int filled; /* where it is kept whole: a pixel is not 0 */
    RetexImage whole;  /* then, once a pixel was asked for; under the lock */
} BandImage;

struct BandRows {
    Bands *of;
    int band, lines;
    BandRows *next;                         /* of those that no band needs now */
    _Atomic(float *) rows[BAND_IMAGES_MAX]; /* NULL: no pixel was asked for */
    float *cleared[BAND_IMAGES_MAX];        /* of zeros, from earlier bands; under the lock */
    float *nowhere;                         /* where pixels go that there is no memory for */
};

struct Bands {
    int width, height, count, whole;
    RetexBandStore *store;
    pthread_mutex_t lock;
    atomic_int starved; /* memory was short */
    BandRows **open;    /* by band; under the lock, as is: */
    BandRows *free;
    int nimages;
    BandImage *images[BAND_IMAGES_MAX];
};

int bands_create(Bands **result, int width, int height, RetexBandStore *store, int whole, RetexError *err)
{
    Bands *bands = *result = calloc(1, sizeof *bands);
    if (!bands) {
        retex_band_store_close(&store);
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    }
    bands->width = width, bands->height = height;
    bands->count = (height + BAND_LINES - 1) / BAND_LINES;
    bands->store = store, bands->whole = whole;
    pthread_mutex_init(&bands->lock, NULL);
    bands->open = calloc((size_t)bands->count, sizeof *bands->open);
    return bands->open ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
}

static void rows_close(Bands *bands, BandRows *rows)
{
    for (int k = 0; k < bands->nimages; k++) {
        free(rows->cleared[k]);
        if (!bands->whole)
            free(rows->rows[k]);
    }
    free(rows->nowhere);
    free(rows);
}

/* Memory that bands were worked on in. */
static void close_rows(Bands *bands)
{
    for (int k = 0; bands->open && k < bands->count; k++)
        if (bands->open[k])
            rows_close(bands, bands->open[k]);
    for (BandRows *rows = bands->free, *next; rows; rows = next) {
        next = rows->next;
        rows_close(bands, rows);
    }
    free(bands->open);
    bands->open = NULL, bands->free = NULL;
}

void bands_close(Bands **result)
{
    Bands *bands = result ? *result : NULL;
    if (!bands)
        return;
    close_rows(bands);
    for (int k = 0; k < bands->nimages; k++) {
        retex_image_free(&bands->images[k]->whole);
        free(bands->images[k]);
    }
    retex_band_store_close(&bands->store);
    pthread_mutex_destroy(&bands->lock);
    free(bands);
    *result = NULL;
}

int bands_count(const Bands *bands)
{
    return bands->count;
}

int bands_add(Bands *bands, const char *name, const char *letters, RetexPixelType type, int *number, RetexError *err)
{
    BandImage *image = calloc(1, sizeof *image);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    snprintf(image->name, sizeof image->name, "%s", name);
    snprintf(image->letters, sizeof image->letters, "%s", letters);
    image->type = type, image->channels = strlen(letters);
    int code = RETEX_OK;
    if (bands->store)
        code = retex_band_store_add(bands->store, name, letters, bands->whole ? RETEX_FLOAT : type, &image->store_image,
                                    err);
    pthread_mutex_lock(&bands->lock);
    if (!code && bands->nimages == BAND_IMAGES_MAX)
        code = retex_fail(err, RETEX_ELIMIT, "the film has at most %d images", BAND_IMAGES_MAX);
    if (!code) {
        *number = bands->nimages;
        bands->images[bands->nimages++] = image;
    }
    pthread_mutex_unlock(&bands->lock);
    if (code)
        free(image);
    return code;
}

/* ---- a band that is worked on ---- */

/* Memory to work on a band in; the lock is held. */
static BandRows *rows_create(Bands *bands)
{
    BandRows *rows = calloc(1, sizeof *rows);
    if (!rows)
        return NULL;
    rows->of = bands;
    rows->nowhere = calloc((size_t)bands->width * BAND_LINES * sizeof bands->images[0]->letters, sizeof(float));
    if (rows->nowhere)
        return rows;
    free(rows);
    return NULL;
}

/* Open a band that no thread has opened; the lock is held. Threads read its fields without the lock later. */
static BandRows *open_rows(Bands *bands, int band)
{
    int left = bands->height - band * BAND_LINES;
    BandRows *rows = bands->free;
    if (rows)
        bands->free = rows->next;
    else
        rows = rows_create(bands);
    if (rows)
        rows->band = band, rows->lines = left < BAND_LINES ? left : BAND_LINES;
    return bands->open[band] = rows;
}

BandRows *bands_open(Bands *bands, int band)
{
    pthread_mutex_lock(&bands->lock);
    BandRows *rows = bands->open[band] ? bands->open[band] : open_rows(bands, band);
    pthread_mutex_unlock(&bands->lock);
    return rows;
}

/* Where a band of an image that is kept whole is, or NULL; the lock is held. */
static float *whole_rows(Bands *bands, int k, int band)
{
    BandImage *image = bands->images[k];
    if (!image->whole.pixels &&
        retex_image_alloc(&image->whole, bands->width, bands->height, (int)image->channels, NULL))
        return NULL;
    return image->whole.pixels + retex_image_index(&image->whole, 0, band * BAND_LINES);
}

/* Rows of zeros for an image that has none yet; the lock is held. */
static float *cleared_rows(BandRows *rows, int k)
{
    Bands *bands = rows->of;
    if (bands->whole)
        return whole_rows(bands, k, rows->band);
    float *cleared = rows->cleared[k];
    rows->cleared[k] = NULL;
    return cleared ? cleared : calloc((size_t)bands->width * BAND_LINES * bands->images[k]->channels, sizeof(float));
}

static float *acquire_rows(BandRows *rows, int image)
{
    pthread_mutex_lock(&rows->of->lock);
    float *given = rows->rows[image];
    if (!given && (given = cleared_rows(rows, image)))
        atomic_store_explicit(&rows->rows[image], given, memory_order_release);
    pthread_mutex_unlock(&rows->of->lock);
    if (given)
        return given;
    rows->of->starved = 1; /* bands_finish says so */
    return rows->nowhere;
}

float *bands_pixel(BandRows *rows, int image, int x, int y)
{
    RETEX_ASSERT(image >= 0 && x >= 0 && x < rows->of->width);
    RETEX_ASSERT(y >= rows->band * BAND_LINES && y < rows->band * BAND_LINES + rows->lines); /* y of the picture */
    float *at = atomic_load_explicit(&rows->rows[image], memory_order_acquire);
    if (!at)
        at = acquire_rows(rows, image);
    size_t pixel = (size_t)(y - rows->band * BAND_LINES) * (size_t)rows->of->width + (size_t)x;
    return at + pixel * rows->of->images[image]->channels;
}

void bands_add_albedo(const BandRows *rows, int uv_image, int albedo_image, RetexBandStats *stats, int target)
{
    RETEX_ASSERT(rows->of->images[uv_image]->channels == 3 && rows->of->images[albedo_image]->channels == 3);
    const float *uv = rows->rows[uv_image], *albedo = rows->rows[albedo_image];
    size_t count = (size_t)rows->of->width * (size_t)rows->lines;
    for (size_t i = 0; uv && albedo && i < count; i++) {
        double weight = uv[3 * i + 2];
        stats->coverage[target] += weight;
        for (size_t c = 0; c < 3; c++)
            stats->albedo[target][c] += weight * albedo[3 * i + c];
    }
}

static void mark_filled(BandImage *image, const float *pixels, size_t count)
{
    for (size_t i = 0; i < count && !image->filled; i++)
        if (pixels[i] != 0)
            image->filled = 1;
}

/* Numbers of a band of an image. */
static size_t band_size(const Bands *bands, int k, int band)
{
    int left = bands->height - band * BAND_LINES;
    return (size_t)bands->width * (size_t)(left < BAND_LINES ? left : BAND_LINES) * bands->images[k]->channels;
}

long bands_limit(BandRows *rows)
{
    long replaced = 0;
    for (int k = 0; k < BAND_IMAGES_MAX; k++)
        if (rows->rows[k])
            replaced += film_limit_numbers(rows->rows[k], band_size(rows->of, k, rows->band), 0);
    return replaced;
}

/* Keep an image's rows of a finished band. */
static int store_rows(BandRows *rows, int k, RetexError *err)
{
    Bands *bands = rows->of;
    BandImage *image = bands->images[k];
    size_t count = band_size(bands, k, rows->band);
    float *pixels = rows->rows[k];
    int code = RETEX_OK;
    rows->rows[k] = NULL;
    if (bands->store)
        code = retex_band_store_put(bands->store, image->store_image, rows->band, pixels, err);
    if (bands->whole) {
        mark_filled(image, pixels, count);
        return code;
    }
    memset(pixels, 0, count * sizeof *pixels);
    rows->cleared[k] = pixels;
    return code;
}

int bands_finish(BandRows *rows, RetexError *err)
{
    Bands *bands = rows->of;
    int code = RETEX_OK;
    pthread_mutex_lock(&bands->lock);
    int nimages = bands->nimages; /* images that are added from here on are not in this band */
    pthread_mutex_unlock(&bands->lock);
    if (bands->starved)
        code = retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
    for (int k = 0; k < nimages && !code; k++)
        if (rows->rows[k])
            code = store_rows(rows, k, err);
    pthread_mutex_lock(&bands->lock);
    if (!code) { /* else they stay where they are, to be freed */
        bands->open[rows->band] = NULL;
        rows->next = bands->free;
        bands->free = rows;
    }
    pthread_mutex_unlock(&bands->lock);
    return code;
}

/* ---- bands that are finished ---- */

int bands_resume(Bands *bands, int band, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < bands->nimages && bands->whole && !code; k++) {
        float *rows = whole_rows(bands, k, band);
        if (!rows)
            return retex_fail(err, RETEX_ENOMEM, "out of memory for the film");
        code = retex_band_store_load_band(bands->store, bands->images[k]->store_image, band, rows, err);
        if (!code)
            mark_filled(bands->images[k], rows, band_size(bands, k, band));
    }
    return code;
}

int bands_copy(const Bands *bands, int band, RetexBandStore *store, RetexError *err)
{
    int code = RETEX_OK;
    for (int k = 0; k < bands->nimages && !code; k++) {
        const BandImage *image = bands->images[k];
        int number;
        if (!image->whole.pixels)
            continue;
        code = retex_band_store_add(store, image->name, image->letters, RETEX_FLOAT, &number, err);
        if (!code)
            code = retex_band_store_put(
                store, number, band, image->whole.pixels + retex_image_index(&image->whole, 0, band * BAND_LINES), err);
    }
    return code;
}

RetexBandStore *bands_store(const Bands *bands)
{
    return bands->store;
}

/* ---- into a set ---- */

int bands_find(const Bands *bands, const char *name)
{
    for (int k = 0; k < bands->nimages; k++)
        if (strcmp(bands->images[k]->name, name) == 0)
            return k;
    return -1;
}

int bands_is_empty(const Bands *bands, int image)
{
    const BandImage *im = bands->images[image];
    return bands->whole ? !im->filled : retex_band_store_is_empty(bands->store, im->store_image);
}

int bands_move_part(Bands *bands, int number, RetexSet *set, int *part, RetexError *err)
{
    BandImage *image = bands->images[number];
    RETEX_ASSERT(bands->whole || bands->store); /* whole images may have a store too, which gets a copy */
    if (!bands->whole)
        return retex_set_add_stored(set, image->name, image->letters, image->type, image->store_image, part, err);
    if (!image->whole.pixels) {
        int code = retex_image_alloc(&image->whole, bands->width, bands->height, (int)image->channels, err);
        if (code)
            return code;
    }
    int index, code = retex_set_add_part(set, image->name, image->letters, image->type, 1, 1, &index, err);
    if (code)
        return code;
    RetexImage *moved = retex_set_mutable_image(set, index);
    retex_image_free(moved);
    *moved = image->whole;
    image->whole = (RetexImage){0};
    if (part)
        *part = index;
    return RETEX_OK;
}

RetexBandStore *bands_take_store(Bands *bands)
{
    RetexBandStore *store = bands->store;
    if (bands->whole)
        return NULL;
    close_rows(bands);
    bands->store = NULL;
    return store;
}
