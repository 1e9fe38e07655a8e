/* See stage.h. */
#include "set/stage.h"

#include <stdio.h>
#include <stdlib.h>

int set_stage_open(SetStage *stage, int most, RetexError *err)
{
    *stage = (SetStage){.small = calloc((size_t)most + 1, sizeof *stage->small),
                        .images = calloc((size_t)most + 1, sizeof *stage->images)};
    if (stage->small && stage->images)
        return RETEX_OK;
    set_stage_close(stage);
    return retex_fail(err, RETEX_ENOMEM, "no memory to write a set");
}

void set_stage_close(SetStage *stage)
{
    for (int i = 0; stage->small && i < stage->count; i++)
        retex_image_free(&stage->small[i]);
    free(stage->small);
    free(stage->images);
    retex_spool_close(&stage->spool);
    *stage = (SetStage){0};
}

static int add_spooled(SetStage *stage, RetexExrPart *exr, Gathered *g, const char *near, int compress, RetexError *err)
{
    char name[RETEX_NAME_MAX];
    int code = RETEX_OK;
    if (!stage->spool) {
        code = retex_spool_create(&stage->spool, exr->image->width, exr->image->height, 0, near, err);
        if (!code && !compress)
            retex_spool_set_plain(stage->spool);
    }
    snprintf(name, sizeof name, "part_%d", stage->count);
    if (!code)
        code = retex_spool_add(stage->spool, name, exr->letters, exr->type, &g->spooled, err);
    exr->spool = stage->spool;
    exr->spooled = g->spooled;
    return code;
}

int set_stage_add(SetStage *stage, RetexExrPart *exr, int part, int footprint, int width, int height, const char *near,
                  int compress, RetexError *err)
{
    const RetexImage *shape = exr->image;
    RetexImage *image = &stage->small[stage->count];
    Gathered *g = &stage->images[stage->count];
    int code;
    *g = (Gathered){.part = part, .footprint = footprint, .image = image};
    if (shape->width == width && shape->height == height) {
        *image = *shape;
        code = add_spooled(stage, exr, g, near, compress, err);
    } else {
        code = retex_image_alloc(image, shape->width, shape->height, shape->channels, err);
    }
    exr->image = image;
    stage->count++;
    return code;
}

int set_stage_fill(SetStage *stage, const RetexSet *set, const RetexSamples *samples, int nthreads, RetexError *err)
{
    return gather(stage->images, stage->count, set, samples, stage->spool, nthreads, err);
}
