/* See stage.h. */
#include "set/staging.h"

#include <stdio.h>
#include <stdlib.h>

int retex_staging_open(RetexStaging *stage, int most, RetexError *err)
{
    *stage = (RetexStaging){.small = calloc((size_t)most + 1, sizeof *stage->small),
                            .images = calloc((size_t)most + 1, sizeof *stage->images)};
    if (stage->small && stage->images)
        return RETEX_OK;
    retex_staging_close(stage);
    return retex_fail(err, RETEX_ENOMEM, "no memory to write a set");
}

void retex_staging_close(RetexStaging *stage)
{
    for (int i = 0; stage->small && i < stage->count; i++)
        retex_image_free(&stage->small[i]);
    free(stage->small);
    free(stage->images);
    retex_band_store_close(&stage->store);
    *stage = (RetexStaging){0};
}

static int add_stored(RetexStaging *stage, RetexExrPart *exr, RetexImageTransfer *g, const char *near, int compress,
                      RetexError *err)
{
    char name[RETEX_NAME_MAX];
    int code = RETEX_OK;
    if (!stage->store) {
        code = retex_band_store_create(&stage->store, exr->image->width, exr->image->height, 0, near, err);
        if (!code && !compress)
            retex_band_store_set_plain(stage->store);
    }
    snprintf(name, sizeof name, "part_%d", stage->count);
    if (!code)
        code = retex_band_store_add(stage->store, name, exr->letters, exr->type, &g->store_image, err);
    exr->store = stage->store;
    exr->store_image = g->store_image;
    return code;
}

int retex_staging_add(RetexStaging *stage, RetexExrPart *exr, int part, int footprint, int width, int height,
                      const char *near, int compress, RetexError *err)
{
    const RetexImage *shape = exr->image;
    RetexImage *image = &stage->small[stage->count];
    RetexImageTransfer *g = &stage->images[stage->count];
    int code;
    *g = (RetexImageTransfer){.part = part, .footprint = footprint, .image = image};
    if (shape->width == width && shape->height == height) {
        *image = *shape;
        code = add_stored(stage, exr, g, near, compress, err);
    } else {
        code = retex_image_alloc(image, shape->width, shape->height, shape->channels, err);
    }
    exr->image = image;
    stage->count++;
    return code;
}

int retex_staging_fill(RetexStaging *stage, const RetexSet *set, const RetexSamples *samples, int nthreads,
                       RetexError *err)
{
    return retex_transfer_images(stage->images, stage->count, set, samples, stage->store, nthreads, err);
}
