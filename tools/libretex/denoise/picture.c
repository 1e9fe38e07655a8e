/* Denoising a picture that is no set; see <retex/denoise_picture.h>. Each layer becomes a set without terms, whose
 * noise and guides are made from the layers of the picture, and is filtered by retex_denoise. */
#include <retex/denoise_picture.h>

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/params.h"
#include "denoise/picture_guides.h"
#include "denoise/picture_layers.h"
#include "denoise/picture_noise.h"
#include "exr/rewrite.h"
#include "set/set.h"

#define SUM_TOLERANCE 2e-3 /* mean difference, over the mean, of a picture from the sum of its layers */
#define BYTES_A_PIXEL 190  /* of guides, a layer, its noise and its set */
enum { REPAIR_RADIUS = 3 };

/* An open file. */
typedef struct PictureFile {
    RetexInput *input;
    RetexExr *exr;
    RetexPictureLayers layers;
} PictureFile;

/* A layer to denoise. */
typedef struct PictureJob {
    int layer, color; /* the layer of colours that it is multiplied by in the picture, or -1 */
    RetexImage result;
} PictureJob;

typedef struct Picture {
    RetexDenoisePictureParams params;
    RetexDenoiseParams filter;
    PictureFile file, other;
    int beauty; /* layer, or -1 */
    int width, height, nthreads;
    PictureJob *jobs;
    int njobs, done;
    int halves_differ; /* 1: somewhere */
    RetexPictureGuides guides;
    RetexImage sum, denoised_sum; /* of several layers */
    uint64_t charged;
} Picture;

RETEX_PRINTF(3, 4) static void note(const Picture *p, int important, const char *format, ...)
{
    char text[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(text, sizeof text, format, list);
    va_end(list);
    if (p->params.note)
        p->params.note(p->params.note_context, important, text);
}

/* ---- files ---- */

static int open_file(PictureFile *file, const char *path, const RetexAccess *access, RetexError *err)
{
    int code = retex_input_open_allowed(&file->input, path, access, err);
    if (!code)
        code = retex_exr_open(&file->exr, file->input, err);
    if (!code)
        code = retex_exr_rewrite_check(file->exr, err);
    return code ? code : retex_picture_layers_open(&file->layers, file->exr, err);
}

static void close_file(PictureFile *file)
{
    retex_picture_layers_close(&file->layers);
    retex_exr_close(&file->exr);
    retex_input_close(&file->input);
}

int retex_is_picture(const char *path, const RetexAccess *access)
{
    PictureFile file = {0};
    const int is_exr = strcmp(path, "-") != 0 && !retex_input_open_allowed(&file.input, path, access, NULL) &&
                       retex_exr_probe(file.input) && !retex_exr_open(&file.exr, file.input, NULL);
    const int is_picture = is_exr && !retex_exr_attribute(file.exr, 0, "retex");
    close_file(&file);
    return is_picture;
}

static const char *layer_text(const Picture *p, int layer)
{
    return retex_picture_layer_text(&p->file.layers, layer);
}

/* ---- layers ---- */

/* Fails at the first value that is no number. */
static int check_values(const PictureFile *file, int layer, const RetexImage *image, RetexError *err)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                const float value = image->pixels[retex_image_index(image, x, y) + (size_t)c];
                if (!isfinite(value))
                    return retex_fail(err, RETEX_EFORMAT,
                                      "%s: layer %s holds %s at %d,%d: --accept-damaged takes the mean "
                                      "of the pixels around",
                                      retex_input_name(file->input), retex_picture_layer_text(&file->layers, layer),
                                      isnan(value) ? "NaN" : "infinity", x, y);
            }
    return RETEX_OK;
}

/* The mean of the finite values around a pixel; 0 where there are none. */
static float mean_around(const RetexImage *image, int x, int y, int c)
{
    double sum = 0;
    int count = 0;
    for (int radius = 1; radius <= REPAIR_RADIUS && !count; radius++)
        for (int v = y - radius; v <= y + radius; v++)
            for (int u = x - radius; u <= x + radius; u++) {
                if (u < 0 || u >= image->width || v < 0 || v >= image->height)
                    continue;
                const float value = image->pixels[retex_image_index(image, u, v) + (size_t)c];
                if (isfinite(value))
                    sum += value, count++;
            }
    return count ? (float)(sum / count) : 0;
}

static int repair(RetexImage *image, RetexError *err)
{
    RetexImage before = {0};
    const int code = retex_image_copy(&before, image, err);
    for (int y = 0; y < image->height && !code; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) {
                float *value = &image->pixels[retex_image_index(image, x, y) + (size_t)c];
                if (!isfinite(*value))
                    *value = mean_around(&before, x, y, c);
            }
    retex_image_free(&before);
    return code;
}

/* Reads a layer; one channel becomes three equal ones. */
static int read_layer(RetexImage *image, const PictureFile *file, int layer, int nthreads, RetexError *err)
{
    const RetexPictureLayer *l = &file->layers.of[layer];
    RetexImage own = {0};
    RetexExrRequest request = {.part = l->part, .image = &own};
    int width, height;
    retex_exr_part_size(file->exr, l->part, &width, &height);
    for (int c = 0; c < l->count; c++)
        snprintf(request.channels[c], sizeof request.channels[c], "%s",
                 retex_exr_channel_name(file->exr, l->part, l->channels[c]));
    int code = retex_image_alloc(&own, width, height, l->count, err);
    if (!code)
        code = retex_exr_read(file->exr, &request, 1, nthreads, err);
    if (!code && l->count == 3) {
        *image = own;
        return code;
    }
    if (!code)
        code = retex_image_alloc(image, width, height, 3, err);
    for (size_t i = 0; i < (size_t)width * (size_t)height && !code; i++)
        image->pixels[3 * i] = image->pixels[3 * i + 1] = image->pixels[3 * i + 2] = own.pixels[i];
    retex_image_free(&own);
    return code;
}

/* 1 if a layer has the picture's size. */
static int has_size(const Picture *p, const PictureFile *file, int layer)
{
    int width, height;
    retex_exr_part_size(file->exr, file->layers.of[layer].part, &width, &height);
    return width == p->width && height == p->height;
}

/* The layer in the other half, which must have it: with the same size. */
static int find_in_other(const Picture *p, int layer, RetexError *err)
{
    const RetexPictureLayer *l = &p->file.layers.of[layer];
    for (int k = 0; k < p->other.layers.count; k++)
        if (p->other.layers.of[k].count == l->count && strcmp(p->other.layers.of[k].name, l->name) == 0) {
            if (!has_size(p, &p->other, k))
                return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels, as in %s",
                                  retex_input_name(p->other.input), layer_text(p, layer), p->width, p->height,
                                  retex_input_name(p->file.input));
            return k;
        }
    return retex_fail(err, RETEX_ENOTFOUND, "%s has no layer %s, as %s has", retex_input_name(p->other.input),
                      layer_text(p, layer), retex_input_name(p->file.input));
}

static int read_checked(RetexImage *image, const Picture *p, const PictureFile *file, int layer, RetexError *err)
{
    int code = read_layer(image, file, layer, p->nthreads, err);
    if (code)
        return code;
    return p->params.access && p->params.access->accept_damaged ? repair(image, err)
                                                                : check_values(file, layer, image, err);
}

/* ---- guides ---- */

/* The layer of a guide: by the name that the user gave, or else a well known one; -1: none. */
static int find_guide(const Picture *p, const char *name, RetexPictureGuide guide, int *layer, RetexError *err)
{
    const char *file = retex_input_name(p->file.input);
    *layer = name ? retex_picture_layer_named(&p->file.layers, name, file, err)
                  : retex_picture_layer_known(&p->file.layers, guide, p->beauty);
    if (name && *layer < 0)
        return *layer;
    if (*layer >= 0 && !has_size(p, &p->file, *layer)) {
        if (name)
            return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", file, layer_text(p, *layer),
                              p->width, p->height);
        *layer = -1;
    }
    return RETEX_OK;
}

/* Reads a guide, of both halves their mean. */
static int load_guide(RetexImage *image, Picture *p, int layer, const char *as, char *used, size_t size,
                      RetexError *err)
{
    if (layer < 0)
        return RETEX_OK;
    const size_t length = strlen(used);
    snprintf(used + length, size - length, "%s%s %s", length ? ", " : "", as, layer_text(p, layer));
    int code = read_layer(image, &p->file, layer, p->nthreads, err);
    const int other = p->other.exr && !code ? find_in_other(p, layer, NULL) : -1;
    RetexImage second = {0};
    if (other >= 0 && !code)
        code = read_layer(&second, &p->other, other, p->nthreads, err);
    for (size_t i = 0; other >= 0 && !code && i < retex_image_index(image, 0, image->height); i++)
        image->pixels[i] = 0.5f * (image->pixels[i] + second.pixels[i]);
    retex_image_free(&second);
    for (size_t i = 0; !code && i < retex_image_index(image, 0, image->height); i++)
        if (!(fabsf(image->pixels[i]) < 1e30f))
            image->pixels[i] = 0;
    return code;
}

static int load_guides(Picture *p, RetexError *err)
{
    const RetexDenoisePictureParams *given = &p->params;
    RetexPictureGuides *g = &p->guides;
    int normal = -1, seen = -1, albedo = -1, position = -1, depth = -1;
    char used[1024] = "";
    int code = find_guide(p, given->normal, RETEX_PICTURE_NORMAL, &normal, err);
    if (!code && !given->normal)
        code = find_guide(p, NULL, RETEX_PICTURE_SEEN_NORMAL, &seen, err);
    if (!code)
        code = find_guide(p, given->albedo, RETEX_PICTURE_ALBEDO, &albedo, err);
    if (!code)
        code = find_guide(p, given->position, RETEX_PICTURE_POSITION, &position, err);
    if (!code && (given->depth || position < 0))
        code = find_guide(p, given->depth, RETEX_PICTURE_DEPTH, &depth, err);
    if (position >= 0)
        depth = given->depth && !given->position ? depth : -1;
    if (depth >= 0)
        position = -1;
    if (!code)
        code = load_guide(&g->normal, p, normal, "normal", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->seen_normal, p, seen, "normal", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->albedo, p, albedo, "albedo", used, sizeof used, err);
    if (!code)
        code = load_guide(&g->position, p, depth >= 0 ? depth : position, depth >= 0 ? "depth" : "position", used,
                          sizeof used, err);
    if (!code && depth >= 0)
        retex_picture_depth_to_position(&g->position);
    if (!code)
        note(p, 0, "guides: %s", *used ? used : "none");
    return code ? code : retex_picture_guides_finish(g, depth >= 0, err);
}

/* ---- noise ---- */

/* The mean of both halves, and half of their difference. */
static int split_halves(RetexImage *image, RetexImage *noise, Picture *p, int layer, RetexError *err)
{
    const int other = find_in_other(p, layer, err);
    int code = other < 0 ? other : read_checked(noise, p, &p->other, other, err);
    for (size_t i = 0; !code && i < retex_image_index(image, 0, image->height); i++) {
        const float a = image->pixels[i], b = noise->pixels[i];
        image->pixels[i] = 0.5f * (a + b);
        noise->pixels[i] = 0.5f * (a - b);
        p->halves_differ |= a != b;
    }
    return code;
}

static int read_variance(RetexImage *noise, const Picture *p, RetexError *err)
{
    const int layer =
        retex_picture_layer_named(&p->file.layers, p->params.variance, retex_input_name(p->file.input), err);
    if (layer < 0)
        return layer;
    if (!has_size(p, &p->file, layer))
        return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", retex_input_name(p->file.input),
                          layer_text(p, layer), p->width, p->height);
    return read_checked(noise, p, &p->file, layer, err);
}

static int find_noise(RetexImage *image, RetexImage *noise, Picture *p, const PictureJob *job, int with_albedo,
                      RetexError *err)
{
    int code;
    if (p->other.exr)
        return split_halves(image, noise, p, job->layer, err);
    if (p->params.variance)
        code = read_variance(noise, p, err);
    else
        code = retex_picture_estimate_variance(
            noise, image, p->guides.seen_normal.pixels ? &p->guides.seen_normal : NULL,
            with_albedo && p->guides.albedo.pixels ? &p->guides.albedo : NULL, p->nthreads, err);
    if (!code)
        retex_picture_draw_noise(noise, (uint32_t)job->layer, p->nthreads);
    return code;
}

/* ---- one layer ---- */

static void layer_progress(void *context, double done)
{
    const Picture *p = context;
    if (p->filter.progress)
        p->filter.progress(p->filter.progress_context, (p->done + done) / p->njobs);
}

/* The number that will be stored. */
static void round_as_stored(RetexImage *image, const Picture *p, int layer)
{
    const RetexPictureLayer *l = &p->file.layers.of[layer];
    RetexPixelType type;
    for (int c = 0; c < 3; c++) {
        const char *name = retex_exr_channel_name(p->file.exr, l->part, l->channels[c < l->count ? c : 0]);
        if (!retex_exr_channel_type(p->file.exr, l->part, name, &type) || type != RETEX_HALF)
            continue;
        for (size_t i = (size_t)c; i < retex_image_index(image, 0, image->height); i += 3) {
            uint16_t half;
            retex_half_from_float(&half, &image->pixels[i], 1);
            retex_half_to_float(&image->pixels[i], &half, 1);
        }
    }
}

/* Adds a layer to a sum, multiplied by its colours. */
static int add_to_sum(RetexImage *sum, const Picture *p, const RetexImage *image, int color, RetexError *err)
{
    RetexImage colors = {0};
    int code = sum->pixels ? RETEX_OK : retex_image_alloc(sum, p->width, p->height, 3, err);
    if (!code && color >= 0)
        code = read_layer(&colors, &p->file, color, p->nthreads, err);
    for (size_t i = 0; !code && i < retex_image_index(sum, 0, sum->height); i++)
        sum->pixels[i] += color >= 0 ? colors.pixels[i] * image->pixels[i] : image->pixels[i];
    retex_image_free(&colors);
    return code;
}

static int filter_image(RetexImage *image, const RetexImage *noise, Picture *p, int with_albedo, RetexError *err)
{
    RetexSet *set = NULL;
    RetexDenoiseParams params = p->filter;
    params.progress = layer_progress;
    params.progress_context = p;
    int code = retex_picture_set(&set, image, noise, &p->guides, with_albedo, err);
    if (!code)
        code = retex_denoise(set, &params, NULL, p->nthreads, err);
    if (!code) {
        RetexImage *result = &set->parts[0].image;
        float *pixels = image->pixels;
        image->pixels = result->pixels;
        result->pixels = pixels;
    }
    retex_set_close(&set);
    return code;
}

static int denoise_layer(Picture *p, PictureJob *job, int sums, RetexError *err)
{
    const RetexPictureLayer *l = &p->file.layers.of[job->layer];
    const int with_albedo = job->color < 0 && l->count == 3;
    RetexImage noise = {0};
    int code = read_checked(&job->result, p, &p->file, job->layer, err);
    if (!code && sums)
        code = add_to_sum(&p->sum, p, &job->result, job->color, err);
    if (!code)
        code = find_noise(&job->result, &noise, p, job, with_albedo, err);
    if (!code)
        code = filter_image(&job->result, &noise, p, with_albedo, err);
    retex_image_free(&noise);
    if (code)
        return code;
    round_as_stored(&job->result, p, job->layer);
    p->done++;
    return sums ? add_to_sum(&p->denoised_sum, p, &job->result, job->color, err) : RETEX_OK;
}

/* ---- several layers ---- */

/* 1 if the layers add up to the picture. */
static int is_sum(const Picture *p, const RetexImage *beauty)
{
    double difference = 0, mean = 0;
    for (size_t i = 0; i < retex_image_index(beauty, 0, beauty->height); i++) {
        difference += fabs((double)beauty->pixels[i] - (double)p->sum.pixels[i]);
        mean += fabs((double)beauty->pixels[i]);
    }
    return difference <= SUM_TOLERANCE * mean;
}

/* Of several layers the picture may be the sum: then it becomes that of the denoised ones, and is one more result. Else
 * it is denoised by itself if it was asked for. */
static int finish_picture(Picture *p, int asked, RetexError *err)
{
    RetexImage beauty = {0};
    PictureJob *job = &p->jobs[p->njobs - 1];
    if (p->beauty < 0 || !p->sum.pixels || p->file.layers.of[p->beauty].count != 3)
        return RETEX_OK;
    int code = read_checked(&beauty, p, &p->file, p->beauty, err);
    const int adds_up = !code && is_sum(p, &beauty);
    retex_image_free(&beauty);
    if (code)
        return code;
    if (adds_up) {
        note(p, 0, "%s is the sum of the layers, and becomes that of the denoised ones", layer_text(p, p->beauty));
        if (!asked)
            job = &p->jobs[p->njobs++];
        *job = (PictureJob){.layer = p->beauty, .color = -1, .result = p->denoised_sum};
        p->denoised_sum = (RetexImage){0};
        return RETEX_OK;
    }
    if (asked)
        return denoise_layer(p, job, 0, err);
    note(p, 1, "%s is not the sum of the layers, and stays as it is", layer_text(p, p->beauty));
    return RETEX_OK;
}

/* Fills the list of layers: the picture comes last. *asked: 1 if it is among them. */
static int list_jobs(Picture *p, int *asked, RetexError *err)
{
    const char *file = retex_input_name(p->file.input);
    RetexError none;
    const int given = p->params.nlayers;
    p->jobs = calloc((size_t)given + 2, sizeof *p->jobs);
    if (!p->jobs)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the layers of a picture");
    p->beauty = retex_picture_layer_beauty(&p->file.layers, file, given ? &none : err);
    if (p->beauty < 0 && !given)
        return p->beauty;
    *asked = !given;
    for (int k = 0; k < given; k++) {
        const int layer = retex_picture_layer_named(&p->file.layers, p->params.layers[k], file, err);
        if (layer < 0)
            return layer;
        for (int j = 0; j < p->njobs; j++)
            if (p->jobs[j].layer == layer)
                return retex_fail(err, RETEX_EINVAL, "the layer %s is given twice", p->params.layers[k]);
        if (layer == p->beauty)
            *asked = 1;
        else
            p->jobs[p->njobs++] =
                (PictureJob){.layer = layer, .color = retex_picture_layer_color(&p->file.layers, layer)};
    }
    if (*asked)
        p->jobs[p->njobs++] = (PictureJob){.layer = p->beauty, .color = -1};
    return RETEX_OK;
}

static int check_job(const Picture *p, const PictureJob *job, RetexError *err)
{
    const RetexPictureLayer *l = &p->file.layers.of[job->layer];
    RetexPixelType type;
    for (int c = 0; c < l->count; c++)
        if (!retex_exr_channel_type(p->file.exr, l->part, retex_exr_channel_name(p->file.exr, l->part, l->channels[c]),
                                    &type))
            return retex_fail(err, RETEX_EUNSUPPORTED, "%s: layer %s holds integers, which are not denoised",
                              retex_input_name(p->file.input), layer_text(p, job->layer));
    if (!has_size(p, &p->file, job->layer))
        return retex_fail(err, RETEX_EFORMAT, "%s: layer %s is not %d x %d pixels", retex_input_name(p->file.input),
                          layer_text(p, job->layer), p->width, p->height);
    return RETEX_OK;
}

static int check_size(Picture *p, RetexError *err)
{
    const long most = retex_budget_pixels(p->filter.budget);
    retex_exr_part_size(p->file.exr, p->file.layers.of[p->jobs[0].layer].part, &p->width, &p->height);
    if (most > 0 && (int64_t)p->width * p->height > most)
        return retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels, more than the %ld of --max-pixels",
                          retex_input_name(p->file.input), p->width, p->height, most);
    const uint64_t bytes = (uint64_t)p->width * (uint64_t)p->height * (BYTES_A_PIXEL + 12 * ((uint64_t)p->njobs + 3));
    RetexBudget *budget = (RetexBudget *)p->filter.budget;
    const int code = budget ? retex_budget_charge(budget, bytes, "a picture to denoise", err) : RETEX_OK;
    p->charged = code || !budget ? 0 : bytes;
    return code;
}

static int denoise_layers(Picture *p, RetexError *err)
{
    int asked = 0, code = list_jobs(p, &asked, err);
    if (!code)
        code = check_size(p, err);
    for (int k = 0; k < p->njobs && !code; k++)
        code = check_job(p, &p->jobs[k], err);
    if (!code)
        code = load_guides(p, err);
    if (!code && !p->other.exr && p->params.variance)
        note(p, 0, "the layer %s is taken as the variance of each pixel's mean", p->params.variance);
    if (!code && !p->other.exr && !p->params.variance)
        note(p, 1,
             "the noise is estimated from the picture itself: what no guide shows may be taken for noise; "
             "--other-half is better");
    const int several = p->njobs - (asked ? 1 : 0) > 1;
    const int alone = p->njobs == 1 || !asked || !several ? p->njobs : p->njobs - 1;
    for (int k = 0; k < alone && !code; k++)
        code = denoise_layer(p, &p->jobs[k], several, err);
    if (!code && several)
        code = finish_picture(p, asked, err);
    if (!code && p->other.exr && !p->halves_differ)
        code = retex_fail(err, RETEX_EINVAL, "%s is the same render as %s: the other half needs another seed",
                          retex_input_name(p->other.input), retex_input_name(p->file.input));
    return code;
}

/* ---- the output ---- */

static int write_picture(const Picture *p, const char *output, RetexError *err)
{
    RetexExrReplacement *all = calloc(3 * (size_t)p->njobs + 1, sizeof *all);
    int count = 0;
    if (!all)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write a picture");
    for (int k = 0; k < p->njobs; k++) {
        const RetexPictureLayer *l = &p->file.layers.of[p->jobs[k].layer];
        for (int c = 0; c < l->count; c++)
            all[count++] = (RetexExrReplacement){l->part, l->channels[c], p->jobs[k].result.pixels + c, 3};
    }
    const int code = retex_exr_rewrite(p->file.exr, all, count, output, p->nthreads, err);
    free(all);
    return code;
}

static void close_picture(Picture *p)
{
    for (int k = 0; k < p->njobs; k++)
        retex_image_free(&p->jobs[k].result);
    free(p->jobs);
    retex_image_free(&p->sum);
    retex_image_free(&p->denoised_sum);
    retex_picture_guides_close(&p->guides);
    close_file(&p->file);
    close_file(&p->other);
    if (p->charged)
        retex_budget_release((RetexBudget *)p->filter.budget, p->charged);
}

int retex_denoise_picture(const char *path, const char *output, const RetexDenoisePictureParams *picture,
                          const RetexDenoiseParams *params, int nthreads, RetexError *err)
{
    Picture p = {
        .params = RETEX_DENOISE_PICTURE_INIT, .filter = RETEX_DENOISE_INIT, .beauty = -1, .nthreads = nthreads};
    int code = RETEX_PARAMS_COPY(&p.params, picture, err);
    if (!code)
        code = RETEX_PARAMS_COPY(&p.filter, params, err);
    if (!code && p.params.other_half && p.params.variance)
        code = retex_fail(err, RETEX_EINVAL, "a second half tells the noise: a variance is not used with it");
    if (!code)
        code = open_file(&p.file, path, p.params.access, err);
    if (!code && p.params.other_half)
        code = open_file(&p.other, p.params.other_half, p.params.access, err);
    if (!code)
        code = denoise_layers(&p, err);
    if (!code)
        code = write_picture(&p, output, err);
    close_picture(&p);
    return code;
}
