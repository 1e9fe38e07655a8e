/* See staging.h. */
#include "set/staging.h"

#include <stdio.h>
#include <stdlib.h>

#include "exr/band_store_chunks.h"

int retex_staging_open(RetexStaging *staging, int most, RetexError *err)
{
    *staging = (RetexStaging){.reduced = calloc((size_t)most + 1, sizeof *staging->reduced),
                              .images = calloc((size_t)most + 1, sizeof *staging->images)};
    if (staging->reduced && staging->images)
        return RETEX_OK;
    retex_staging_close(staging);
    return retex_fail(err, RETEX_ENOMEM, "no memory to write a set");
}

void retex_staging_close(RetexStaging *staging)
{
    for (int i = 0; staging->reduced && i < staging->count; i++)
        retex_image_free(&staging->reduced[i]);
    free(staging->reduced);
    free(staging->images);
    retex_band_store_close(&staging->store);
    *staging = (RetexStaging){0};
}

static int add_stored(RetexStaging *staging, RetexExrPart *exr, RetexImageTransfer *g, const char *near,
                      RetexExrCompression compress, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    int code = RETEX_OK;
    if (!staging->store) {
        code = retex_band_store_create(&staging->store, exr->image->width, exr->image->height, 0, near, err);
        if (!code && !compress)
            retex_band_store_set_plain(staging->store);
        if (!code && compress == RETEX_EXR_QUICKLY)
            retex_band_store_set_fast(staging->store);
    }
    snprintf(name, sizeof name, "part_%d", staging->count);
    if (!code)
        code = retex_band_store_add(staging->store, name, exr->letters, exr->type, &g->store_image, err);
    exr->store = staging->store;
    exr->store_image = g->store_image;
    return code;
}

int retex_staging_add(RetexStaging *staging, RetexExrPart *exr, int part, int footprint, int width, int height,
                      const char *near, RetexExrCompression compress, RetexError *err)
{
    const RetexImage *shape = exr->image;
    RetexImage *image = &staging->reduced[staging->count];
    RetexImageTransfer *g = &staging->images[staging->count];
    int code;
    *g = (RetexImageTransfer){.part = part, .footprint = footprint, .image = image};
    if (shape->width == width && shape->height == height) {
        *image = *shape;
        code = add_stored(staging, exr, g, near, compress, err);
    } else {
        code = retex_image_alloc(image, shape->width, shape->height, shape->channels, err);
    }
    exr->image = image;
    staging->count++;
    return code;
}

int retex_staging_fill(RetexStaging *staging, const RetexSet *set, const RetexSamples *samples, int nthreads,
                       RetexError *err)
{
    return retex_transfer_images(staging->images, staging->count, set, samples, staging->store, nthreads, err);
}
