/* Sampling: new textures are filtered at every footprint of their targets. A footprint is a Gaussian, an ellipse or a
 * parallelogram (retex_footprint_filter) with the stored mean and spread of the surface UV, which the texture's
 * transform maps exactly. Where the texture is transparent the original albedo of the footprint shows. */
#include <retex/combine.h>
#include <retex/edit.h>
#include <retex/host/band_store.h>
#include <retex/laid.h>

#include <stdlib.h>
#include <string.h>

#include "retexture/term_finishes.h"
#include "retexture/textures.h"
#include "retexture/view_images.h"
#include "set/laid.h"
#include "set/parts.h"
#include "set/source.h"
#include "set/transfer.h"

typedef struct SampleWork {
    RetexSet *set;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int nspecs;
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target */
    RetexView view;                            /* of set and textures alone */
    RetexImageTransfer *laid;                  /* the parts that are added */
    int *images;                               /* of each of these the image of the view */
    int count, room;
} SampleWork;

/* Computes rows y0 <= y < y1 of a part. */
static int sample_rows(void *context, RetexRowReader *unused, const RetexImageTransfer *laid, int y0, int y1, float *to,
                       RetexError *err)
{
    const SampleWork *work = context;
    const size_t numbers = 3 * (size_t)laid->image->width;
    RetexViewReader reader;
    int code = retex_view_reader_open(&reader, &work->view, err);
    (void)unused;
    for (int y = y0; y < y1 && !code; y++, to += numbers) {
        const float *row;
        code = retex_view_row(&reader, work->images[laid - work->laid], y, &row, NULL, err);
        if (!code && row)
            memcpy(to, row, numbers * sizeof *to); /* which is 0 before */
    }
    if (reader.view)
        retex_view_reader_close(&reader);
    return code;
}

/* Adds the part for a footprint with a finish, or -1, or with footprint -1 for the gates; and the image of the view
 * that it will have. */
static int add_laid(SampleWork *work, int target, int footprint, int finish, RetexError *err)
{
    const RetexSet *set = work->set;
    int part = 0;
    if (work->count == work->room) {
        const int room = work->room ? 2 * work->room : 64;
        RetexImageTransfer *laid = realloc(work->laid, sizeof *laid * (size_t)room);
        work->laid = laid ? laid : work->laid;
        int *images = realloc(work->images, sizeof *images * (size_t)room);
        work->images = images ? images : work->images;
        if (!laid || !images)
            return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
        work->room = room;
    }
    const int code = retex_set_add_laid(work->set, target, footprint, finish, &part, err);
    if (code)
        return code;
    const int image = footprint < 0 ? retex_view_gates(&work->view, target)
                                    : retex_view_footprint(&work->view, footprint, finish,
                                                           &set->parts[set->footprints[footprint].uv].image);
    if (image < 0)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for samples");
    work->laid[work->count] = (RetexImageTransfer){.part = part};
    work->images[work->count++] = image;
    return RETEX_OK;
}

/* Adds the parts for the texture of a target. */
static int add_target(SampleWork *work, int target, RetexError *err)
{
    const int mapped = work->view.mapped[target];
    int code = RETEX_OK;
    for (int f = 0; f < work->set->nfootprints; f++)
        for (int k = -1; k < mapped && work->set->footprints[f].target == target && !code; k++)
            code = add_laid(work, target, f, k, err);
    return code || !mapped ? code : add_laid(work, target, -1, -1, err);
}

static int add_targets(SampleWork *work, int nthreads, RetexError *err)
{
    RetexSet *set = work->set;
    work->view = (RetexView){.set = set, .textures = work->textures, .columns = {0, set->width}};
    int code = retex_view_find_maps(&work->view, NULL, err);
    for (int t = 0; t < set->ntargets && !code; t++)
        if (work->textures[t])
            retex_set_lift(set, t); /* before any part is added, as later ones move up */
    for (int t = 0; t < set->ntargets && !code; t++)
        code = work->textures[t] ? add_target(work, t, err) : RETEX_OK;
    for (int i = 0; i < work->count && !code; i++) /* no part is added any more, so they stay where they are */
        work->laid[i].image = &set->parts[work->laid[i].part].image;
    for (int i = 0; i < work->nspecs && !code; i++) {
        RetexTarget *target = &set->targets[retex_set_find_target(set, work->specs[i].target)];
        retex_edit_image_text(&work->specs[i], target->texture, sizeof target->texture);
    }
    return code ? code : retex_view_make(&work->view, nthreads, err);
}

static int alloc_pixels(RetexImage *image, RetexError *err)
{
    const RetexImage shape = *image;
    return retex_image_alloc(image, shape.width, shape.height, shape.channels, err);
}

/* Creates a band store for parts as large as the picture; smaller ones are kept in memory. near NULL: all are. */
static int alloc_parts(SampleWork *work, RetexBandStore **store, const char *near, RetexError *err)
{
    const RetexSet *set = work->set;
    int code = near ? retex_band_store_create(store, set->width, set->height, set->id, near, err) : RETEX_OK;
    if (!code && near && strcmp(near, "-") == 0)
        retex_band_store_set_fast(*store);
    for (int i = 0; i < work->count && !code; i++) {
        RetexImageTransfer *laid = &work->laid[i];
        const RetexPart *part = &set->parts[laid->part];
        code = near && retex_set_scale(set, laid->image) == 1
                   ? retex_band_store_add(*store, part->name, part->letters, part->type, &laid->store_image, err)
                   : alloc_pixels(laid->image, err);
    }
    return code;
}

/* Lets the parts without pixels be in the band store, which the set owns from then on. */
static int take_store(SampleWork *work, RetexBandStore *store, RetexError *err)
{
    RetexSetSource *source;
    const int code = retex_store_source_open(&source, store, err);
    for (int i = 0; i < work->count && !code; i++)
        if (!work->laid[i].image->pixels)
            retex_part_set_source(&work->set->parts[work->laid[i].part], source, work->laid[i].store_image);
    retex_source_release(&source);
    return code;
}

static int sample_all(SampleWork *work, const char *near, int nthreads, RetexError *err)
{
    RetexBandStore *store = NULL;
    int code = alloc_parts(work, &store, near, err);
    if (!code)
        code = retex_compute_images(work->laid, work->count, sample_rows, work, work->set, store, nthreads, err);
    if (!code && store)
        return take_store(work, store, err);
    retex_band_store_close(&store);
    return code;
}

static int is_loaded(const RetexSet *set, const RetexFootprint *f)
{
    return set->parts[f->uv].image.pixels && set->parts[f->spread].image.pixels && set->parts[f->albedo].image.pixels;
}

static int check_loaded(const SampleWork *work, RetexError *err)
{
    const RetexSet *set = work->set;
    for (int f = 0; f < set->nfootprints; f++)
        if (work->textures[set->footprints[f].target] && !is_loaded(set, &set->footprints[f]))
            return retex_fail(err, RETEX_EINVAL, "the set is not in memory");
    return RETEX_OK;
}

static int lay(SampleWork *work, const char *near, int nthreads, RetexError *err)
{
    int code = add_targets(work, nthreads, err);
    if (!code)
        code = sample_all(work, near, nthreads, err);
    for (int t = 0; t < work->set->ntargets && code; t++)
        if (work->textures[t])
            retex_set_lift(work->set, t);
    retex_view_close(&work->view);
    free(work->laid);
    free(work->images);
    return code;
}

int retex_sample(RetexSet *set, const RetexTextureSpec *specs, int nspecs, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs};
    int code = retex_texture_specs_copy(work.specs, specs, nspecs, err);
    if (!code)
        code = retex_textures_load(work.textures, set, work.specs, nspecs, nthreads, err);
    if (!code)
        code = check_loaded(&work, err);
    if (!code)
        code = lay(&work, NULL, nthreads, err);
    retex_textures_close(work.textures);
    return code;
}

int retex_sample_textures(RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS], const RetexTextureSpec *specs,
                          int nspecs, const char *near, int nthreads, RetexError *err)
{
    SampleWork work = {.set = set, .nspecs = nspecs};
    memcpy(work.textures, textures, sizeof work.textures);
    const int code = retex_texture_specs_copy(work.specs, specs, nspecs, err);
    return code ? code : lay(&work, near, nthreads, err);
}
