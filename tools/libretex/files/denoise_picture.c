/* Denoising a picture that is no set; see <retex/denoise_picture.h>. Each layer becomes a set without terms, whose
 * noise and guides are made from the layers of the picture, and is filtered by retex_denoise. */
#include <retex/denoise_picture.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "base/params.h"
#include "files/picture_input.h"
#include "exr/rewrite.h"
#include "set/set.h"

#define SUM_TOLERANCE 2e-3 /* mean difference, over the mean, of a picture from the sum of its layers */
#define BYTES_A_PIXEL 190  /* of guides, a layer, its noise and its set */

/* A layer to denoise. */
typedef struct PictureJob {
    int layer, color; /* the layer of colours that it is multiplied by in the picture, or -1 */
    RetexImage result;
} PictureJob;

typedef struct Picture {
    RetexPictureInput in;
    RetexDenoiseParams filter;
    PictureJob *jobs;
    int njobs, done;
    RetexImage sum, denoised_sum; /* of several layers */
    uint64_t charged;
} Picture;

int retex_is_picture(const char *path, const RetexAccess *access)
{
    RetexInput *input = NULL;
    RetexExr *exr = NULL;
    const int is_exr = strcmp(path, "-") != 0 && !retex_input_open_allowed(&input, path, access, NULL) &&
                       retex_exr_probe(input) && !retex_exr_open(&exr, input, NULL);
    const int is_picture = is_exr && !retex_exr_attribute(exr, 0, "retex");
    retex_exr_close(&exr);
    retex_input_close(&input);
    return is_picture;
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
    const RetexPictureLayer *l = &p->in.file.layers.of[layer];
    RetexPixelType type;
    for (int c = 0; c < 3; c++) {
        const char *name = retex_exr_channel_name(p->in.file.exr, l->part, l->channels[c < l->count ? c : 0]);
        if (!retex_exr_channel_type(p->in.file.exr, l->part, name, &type) || type != RETEX_HALF)
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
    int code = sum->pixels ? RETEX_OK : retex_image_alloc(sum, p->in.width, p->in.height, 3, err);
    if (!code && color >= 0)
        code = retex_picture_read_layer(&colors, &p->in.file, color, p->in.nthreads, err);
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
    int code = retex_picture_set(&set, image, noise, &p->in.guides, with_albedo, err);
    if (!code)
        code = retex_denoise(set, &params, NULL, p->in.nthreads, err);
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
    const RetexPictureLayer *l = &p->in.file.layers.of[job->layer];
    const int with_albedo = job->color < 0 && l->count == 3;
    RetexImage noise = {0};
    int code = retex_picture_read_checked(&job->result, &p->in, &p->in.file, job->layer, err);
    if (!code && sums)
        code = add_to_sum(&p->sum, p, &job->result, job->color, err);
    if (!code)
        code = retex_picture_find_noise(&job->result, &noise, &p->in, job->layer, with_albedo, err);
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
    if (p->in.beauty < 0 || !p->sum.pixels || p->in.file.layers.of[p->in.beauty].count != 3)
        return RETEX_OK;
    int code = retex_picture_read_checked(&beauty, &p->in, &p->in.file, p->in.beauty, err);
    const int adds_up = !code && is_sum(p, &beauty);
    retex_image_free(&beauty);
    if (code)
        return code;
    if (adds_up) {
        retex_picture_note(&p->in, 0, "%s is the sum of the layers, and becomes that of the denoised ones",
                           retex_picture_input_text(&p->in, p->in.beauty));
        if (!asked)
            job = &p->jobs[p->njobs++];
        *job = (PictureJob){.layer = p->in.beauty, .color = -1, .result = p->denoised_sum};
        p->denoised_sum = (RetexImage){0};
        return RETEX_OK;
    }
    if (asked)
        return denoise_layer(p, job, 0, err);
    retex_picture_note(&p->in, 1, "%s is not the sum of the layers, and stays as it is",
                       retex_picture_input_text(&p->in, p->in.beauty));
    return RETEX_OK;
}

/* Fills the list of layers: the picture comes last. *asked: 1 if it is among them. */
static int list_jobs(Picture *p, int *asked, RetexError *err)
{
    const char *file = retex_input_name(p->in.file.input);
    RetexError none;
    const int given = p->in.params.nlayers;
    p->jobs = calloc((size_t)given + 2, sizeof *p->jobs);
    if (!p->jobs)
        return retex_fail(err, RETEX_ENOMEM, "no memory for the layers of a picture");
    p->in.beauty = retex_picture_layer_beauty(&p->in.file.layers, file, given ? &none : err);
    if (p->in.beauty < 0 && !given)
        return p->in.beauty;
    *asked = !given;
    for (int k = 0; k < given; k++) {
        const int layer = retex_picture_layer_named(&p->in.file.layers, p->in.params.layers[k], file, err);
        if (layer < 0)
            return layer;
        for (int j = 0; j < p->njobs; j++)
            if (p->jobs[j].layer == layer)
                return retex_fail(err, RETEX_EINVAL, "the layer %s is given twice", p->in.params.layers[k]);
        if (layer == p->in.beauty)
            *asked = 1;
        else
            p->jobs[p->njobs++] =
                (PictureJob){.layer = layer, .color = retex_picture_layer_color(&p->in.file.layers, layer)};
    }
    if (*asked)
        p->jobs[p->njobs++] = (PictureJob){.layer = p->in.beauty, .color = -1};
    return RETEX_OK;
}

static int check_size(Picture *p, RetexError *err)
{
    const long most = retex_budget_pixels(p->filter.budget);
    retex_exr_part_size(p->in.file.exr, p->in.file.layers.of[p->jobs[0].layer].part, &p->in.width, &p->in.height);
    if (most > 0 && (int64_t)p->in.width * p->in.height > most)
        return retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels, more than the %ld of --max-pixels",
                          retex_input_name(p->in.file.input), p->in.width, p->in.height, most);
    const uint64_t bytes =
        (uint64_t)p->in.width * (uint64_t)p->in.height * (BYTES_A_PIXEL + 12 * ((uint64_t)p->njobs + 3));
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
        code = retex_picture_check_layer(&p->in, p->jobs[k].layer, err);
    if (!code)
        code = retex_picture_load_guides(&p->in, err);
    if (!code)
        retex_picture_note_noise(&p->in);
    const int several = p->njobs - (asked ? 1 : 0) > 1;
    const int alone = p->njobs == 1 || !asked || !several ? p->njobs : p->njobs - 1;
    for (int k = 0; k < alone && !code; k++)
        code = denoise_layer(p, &p->jobs[k], several, err);
    if (!code && several)
        code = finish_picture(p, asked, err);
    return code ? code : retex_picture_check_halves(&p->in, err);
}

/* ---- the output ---- */

static int write_picture(const Picture *p, const char *output, RetexError *err)
{
    RetexExrReplacement *all = calloc(3 * (size_t)p->njobs + 1, sizeof *all);
    int count = 0;
    if (!all)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write a picture");
    for (int k = 0; k < p->njobs; k++) {
        const RetexPictureLayer *l = &p->in.file.layers.of[p->jobs[k].layer];
        for (int c = 0; c < l->count; c++)
            all[count++] = (RetexExrReplacement){l->part, l->channels[c], p->jobs[k].result.pixels + c, 3};
    }
    const int code = retex_exr_rewrite(p->in.file.exr, all, count, output, p->in.nthreads, err);
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
    retex_picture_input_close(&p->in);
    if (p->charged)
        retex_budget_release((RetexBudget *)p->filter.budget, p->charged);
}

int retex_denoise_picture(const char *path, const char *output, const RetexDenoisePictureParams *picture,
                          const RetexDenoiseParams *params, int nthreads, RetexError *err)
{
    Picture p = {.in = {.params = RETEX_DENOISE_PICTURE_INIT, .beauty = -1, .nthreads = nthreads},
                 .filter = RETEX_DENOISE_INIT};
    int code = RETEX_PARAMS_COPY(&p.in.params, picture, err);
    if (!code)
        code = RETEX_PARAMS_COPY(&p.filter, params, err);
    if (!code)
        code = retex_picture_input_open(&p.in, path, err);
    if (!code)
        code = denoise_layers(&p, err);
    if (!code)
        code = write_picture(&p, output, err);
    close_picture(&p);
    return code;
}
