/* One picture, and the picture of its expected error. See job.h. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "combine/job.h"
#include "common/json.h"
#include "common/watchdog.h"

int job_describe(const Job *job, const RetexTextureSpec *specs, int count, BatchTexture textures[RETEX_MAX_TARGETS])
{
    const RetexTarget *target;
    int found = 0;
    for (int t = 0; (target = retex_set_target(job->set, t)); t++) {
        const RetexTextureSpec *spec = NULL;
        for (int i = 0; i < count; i++)
            if (retex_set_find_target(job->set, specs[i].target) == t)
                spec = &specs[i];
        if (!spec && !target->texture[0])
            continue;
        BatchTexture *texture = &textures[found++];
        texture->target = target->name;
        if (spec)
            retex_edit_image_text(spec, texture->texture, sizeof texture->texture);
        else
            snprintf(texture->texture, sizeof texture->texture, "%s", target->texture);
    }
    return found;
}

static const char *describe(const Job *job, const Row *row, char *text, size_t size)
{
    BatchTexture textures[RETEX_MAX_TARGETS];
    char *lights = NULL;
    const int count = job_describe(job, row->specs, row->count, textures);
    size_t used = 0;
    for (int i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s <- %s", i ? ", " : "", textures[i].target,
                                 textures[i].texture);
    if (!used)
        used += (size_t)snprintf(text, size, "original textures");
    if (used < size && !retex_edit_text(row->lights, ';', &lights, NULL) && *lights)
        snprintf(text + used, size - used, ", %s", lights);
    free(lights);
    return text;
}

static int write_rows(void *picture, int y0, int y1, const float *rows, RetexError *err)
{
    return retex_picture_rows(picture, y0, y1, rows, err);
}

/* retex_retexture, or retex_estimate_error. */
typedef int Maker(const RetexSet *set, RetexTexture *const textures[RETEX_MAX_TARGETS],
                  const RetexCombineParams *params, RetexRowSink *sink, void *context, int nthreads, RetexError *err);

typedef struct CutRows {
    const RetexImage *image;
    RetexRowSink *sink;
    void *context;
} CutRows;

static void give_strip(void *context, int index, int thread)
{
    const CutRows *cut = context;
    const int y0 = index * RETEX_PICTURE_STRIP, end = y0 + RETEX_PICTURE_STRIP;
    (void)thread;
    (void)cut->sink(cut->context, y0, end < cut->image->height ? end : cut->image->height,
                    cut->image->pixels + retex_image_index(cut->image, 0, y0), NULL); /* the picture keeps the error */
}

/* Make the picture, or the cut of it that is wanted. */
static int make_cut(const Job *job, const Row *row, Maker *make, RetexRowSink *sink, void *context, int nthreads,
                    RetexError *err)
{
    const RetexSetInfo info = retex_set_info(job->set);
    RetexShrink *shrink = NULL;
    RetexImage image = {0};
    if (retex_cut_is_whole(&job->cut, info.width, info.height))
        return make(job->set, row->textures, &job->combine, sink, context, nthreads, err);
    int code = retex_shrink_open(&shrink, &job->cut, info.width, err);
    if (!code)
        code = make(job->set, row->textures, &job->combine, retex_shrink_rows, shrink, nthreads, err);
    if (!code)
        code = retex_shrink_take(&shrink, &image, nthreads, err);
    CutRows rows = {&image, sink, context};
    if (!code)
        retex_parallel(nthreads, (image.height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP, give_strip, &rows);
    retex_shrink_close(&shrink);
    retex_image_free(&image);
    return code;
}

/* The picture of the expected error while it is written. */
typedef struct ErrorPicture {
    RetexPicture *picture;
    double *squares; /* sum of squares of each strip */
    size_t width;
} ErrorPicture;

static int write_error_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    ErrorPicture *error = context;
    const size_t count = 3 * error->width * (size_t)(y1 - y0);
    double *sum = &error->squares[y0 / RETEX_PICTURE_STRIP];
    for (size_t i = 0; i < count; i++)
        *sum += (double)rows[i] * rows[i];
    return retex_picture_rows(error->picture, y0, y1, rows, err);
}

/* Compute and write the expected error; text gets its root mean square. */
static int make_error(const Cli *cli, Job *job, const Row *row, char *text, size_t size, RetexError *err)
{
    const int width = job->cut.scaled_width, height = job->cut.scaled_height;
    const int strips = (height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP;
    ErrorPicture error = {NULL, calloc((size_t)strips, sizeof *error.squares), (size_t)width};
    double squares = 0;
    int code = error.squares ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    if (!code)
        code = retex_picture_open(&error.picture, job->error, width, height, 3, NULL, err);
    if (!code)
        code = make_cut(job, row, retex_estimate_error, write_error_rows, &error, cli->threads, err);
    int closed = retex_picture_close(&error.picture, !code, code ? NULL : err);
    for (int i = 0; i < strips && error.squares; i++)
        squares += error.squares[i];
    free(error.squares);
    snprintf(text, size, ", expected error %.3g rms", sqrt(squares / (3.0 * width * height)));
    return code ? code : closed;
}

/* Find the exposure that the picture's own brightness asks for; text gets it. */
static int find_exposure(const Cli *cli, Job *job, const Row *row, char *text, size_t size, RetexError *err)
{
    double stops = 0;
    int code = RETEX_OK;
    if (job->develop.auto_exposure) {
        code = retex_auto_exposure(&stops, job->set, row->textures, &job->combine, cli->threads, err);
        snprintf(text, size, ", auto-exposure %+.2f", stops);
        stops += job->develop.exposure;
        job->develop.exposure = fmin(fmax(stops, -RETEX_EXPOSURE_MAX), RETEX_EXPOSURE_MAX);
        job->develop.auto_exposure = 0;
    }
    return code;
}

int job_make_picture(const Cli *cli, Job *job, const Row *row, const char *output, double began, RetexError *err)
{
    const RetexCut *cut = &job->cut;
    RetexPicture *picture = NULL;
    struct stat old;
    char text[2048], expected[64] = "", exposed[64] = "";
    int is_new = job->error && stat(job->error, &old) != 0;
    int code = job->error ? make_error(cli, job, row, expected, sizeof expected, err) : RETEX_OK;
    if (!code)
        code = find_exposure(cli, job, row, exposed, sizeof exposed, err);
    if (code)
        return code;
    watchdog_remove(is_new ? job->error : NULL);
    code = retex_picture_open(&picture, output, cut->scaled_width, cut->scaled_height, 3, &job->write, err);
    if (!code)
        code = make_cut(job, row, retex_retexture, write_rows, picture, cli->threads, err);
    int closed = retex_picture_close(&picture, !code, code ? NULL : err);
    code = code ? code : closed;
    if (code && is_new)
        unlink(job->error);
    watchdog_remove(NULL);
    if (code)
        return code;
    cli_info(cli, "%s: %s, %d x %d%s%s, %.2f s", strcmp(output, "-") ? output : "standard output",
             describe(job, row, text, sizeof text), cut->scaled_width, cut->scaled_height, exposed, expected,
             retex_clock_seconds() - began);
    return RETEX_OK;
}

int job_try_picture(const Cli *cli, Job *job, const Row *row, const char *output, size_t *bytes, RetexError *err)
{
    const RetexCut *cut = &job->cut;
    RetexPicture *picture = NULL;
    const char *ending = strrchr(output, '.');
    void *data = NULL;
    int code = retex_picture_open_memory(&picture, ending ? ending + 1 : "exr", cut->scaled_width, cut->scaled_height,
                                         3, &job->write, err);
    if (!code)
        code = make_cut(job, row, retex_retexture, write_rows, picture, cli->threads, err);
    if (code)
        retex_picture_close(&picture, 0, NULL);
    else
        code = retex_picture_take(&picture, &data, bytes, err);
    free(data);
    return code;
}

void job_report(const Cli *cli, const char *output, double began, int done, int total)
{
    if (!cli->json_progress)
        return;
    (void)json_print_line(stderr,
                    json_pack("{s:o, s:s, s:o, s:i, s:i}", "output", json_of_text(output), "status", "made", "seconds",
                              json_of_rounded(retex_clock_seconds() - began, 4), "done", done, "total", total),
                    BATCH_DIGITS);
}

int job_make(const Cli *cli, Job *job, KeptTextures *kept, double began, RetexError *err)
{
    const Row row = {job->textures.specs, job->textures.count, kept->textures, job->lights};
    int code = job_light(job, job->lights, err);
    if (!code && job->combine.parameters)
        lamp_args_warn(cli, job->set, job->combine.parameters);
    if (!code)
        code = kept_textures_load(kept, job->set, row.specs, row.count, cli->threads, err);
    if (!code) {
        cli_detail(cli, "ready after %.2f s", retex_clock_seconds() - began);
        code = job_make_picture(cli, job, &row, job->output, began, err);
    }
    return code;
}
