/* Pictures that are written strip by strip: choice of the format, and strips from any thread. See <retex/picture.h>;
 * formats are in files of their own, see format.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/output_file.h>
#include <retex/parallel.h>

#include "base/params.h"
#include "picture/format.h"

/* --- what is to be written --- */

static const char *ending_of(const char *path)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');

    return dot ? dot + 1 : "";
}

/* 1 for an EXR that needs no OpenColorIO. */
static int is_exr(const char *path, const RetexWriteParams *params)
{
    return strcasecmp(ending_of(path), "exr") == 0 ||
           (retex_names_linear(params->colorspace) && (strcmp(path, "-") == 0 || strncmp(path, "/dev/", 5) == 0));
}

static int is_linear_exr(const char *path, const RetexWriteParams *params)
{
    return is_exr(path, params) && (params->is_data || retex_names_linear(params->colorspace));
}

/* The format by the path's ending, where it is encoded in this room. */
static const RetexPictureFormat *own_format(const char *path)
{
    static const char *const jpeg_endings[] = {"jpg", "jpe", "jpeg", "jif", "jfif", "jfi"};
    const char *ending = ending_of(path);

    if (strcasecmp(ending, "png") == 0)
        return &retex_picture_png;
    if (strcasecmp(ending, "tif") == 0 || strcasecmp(ending, "tiff") == 0)
        return &retex_picture_tiff;
    for (size_t i = 0; i < sizeof jpeg_endings / sizeof jpeg_endings[0]; i++)
        if (strcasecmp(ending, jpeg_endings[i]) == 0)
            return &retex_picture_jpeg;
    return NULL;
}

static int is_given(const char *text)
{
    return text && text[0];
}

/* The view of the built-in configuration's display by which the colours are shown; RETEX_VIEWS: none, they need
 * OpenColorIO. */
static RetexView own_view(const RetexWriteParams *params)
{
    const int is_own = !is_given(params->colorspace) && !is_given(getenv("OCIO")) &&
                       (!is_given(params->display) || strcasecmp(params->display, "sRGB") == 0);
    return is_own ? retex_view_find(params->view) : RETEX_VIEWS;
}

static int has_own_colors(const RetexWriteParams *params)
{
    return own_view(params) != RETEX_VIEWS;
}

static int check_params(const char *path, const RetexWriteParams *params, RetexError *err)
{
    if (params->quality < 1 || params->quality > 100)
        return retex_fail(err, RETEX_EINVAL, "quality is 1 to 100, not %d", params->quality);
    if (params->depth != 0 && params->depth != 8 && params->depth != 16)
        return retex_fail(err, RETEX_EINVAL, "depth is 8 or 16, not %d", params->depth);
    if (params->depth && is_exr(path, params))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: this format keeps floats: it has no depth to choose", path);
    if (params->depth == 16 && own_format(path) == &retex_picture_jpeg)
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: this format has 8 bits; try .png or .tif", path);
    if (!is_exr(path, params) && strcmp(path, "-") == 0)
        return retex_fail(err, RETEX_EUNSUPPORTED, "standard output takes scene-linear EXR only, not %s",
                          params->colorspace);
    return 0;
}

int retex_image_format_check(const char *path, const RetexWriteParams *given, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    int code = RETEX_PARAMS_COPY(&params, given, err);
    if (!code)
        code = check_params(path, &params, err);
    if (code || is_linear_exr(path, &params) || (own_format(path) && has_own_colors(&params)))
        return code;
    return retex_bridge_check(path, &params, err);
}

int retex_image_write_check(const char *path, const RetexWriteParams *given, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    int code = RETEX_PARAMS_COPY(&params, given, err);
    if (!code)
        code = check_params(path, &params, err);
    if (!code)
        code = retex_output_check(path, err);
    return code ? code : retex_image_format_check(path, &params, err);
}

/* --- beginning --- */

static void *load_plan(void *argument)
{
    RetexPicture *picture = argument;

    retex_bridge_plan(&picture->plan, &picture->stored, picture->path, picture->width, picture->height,
                      picture->channels, &picture->params, &picture->plan_error);
    return NULL;
}

static char *copy_text(const char *text, int *failed)
{
    char *copy = is_given(text) ? strdup(text) : NULL;

    *failed |= is_given(text) && !copy;
    return copy;
}

static void free_picture(RetexPicture *picture)
{
    if (picture->loading)
        pthread_join(picture->loader, NULL);
    if (picture->format && picture->format->end)
        picture->format->end(picture);
    retex_bridge_plan_free(&picture->plan);
    retex_output_abandon(&picture->output);
    for (int i = 0; picture->strips && i < picture->nstrips; i++)
        free(picture->strips[i].data);
    free(picture->strips);
    free((char *)picture->params.display);
    free((char *)picture->params.view);
    free((char *)picture->params.colorspace);
    free(picture->path);
    pthread_mutex_destroy(&picture->lock);
    free(picture);
}

static RetexPicture *new_picture(const char *path, int width, int height, int channels, const RetexWriteParams *params)
{
    RetexPicture *picture = calloc(1, sizeof *picture);
    int failed = 0;

    if (!picture)
        return NULL;
    pthread_mutex_init(&picture->lock, NULL);
    picture->width = width;
    picture->height = height;
    picture->channels = channels;
    picture->nstrips = (height + RETEX_PICTURE_STRIP - 1) / RETEX_PICTURE_STRIP;
    picture->strips = calloc((size_t)picture->nstrips, sizeof *picture->strips);
    picture->params = *params;
    picture->view = own_view(params);
    picture->params.display = copy_text(params->display, &failed);
    picture->params.view = copy_text(params->view, &failed);
    picture->params.colorspace = copy_text(params->colorspace, &failed);
    picture->path = strdup(path);
    if (picture->strips && picture->path && !failed)
        return picture;
    free_picture(picture);
    return NULL;
}

/* Starts loading the bridge in a thread; where no thread is available, loads it here. */
static void begin_loading(RetexPicture *picture)
{
    picture->bridged = 1;
    picture->loading = pthread_create(&picture->loader, NULL, load_plan, picture) == 0;
    if (!picture->loading)
        load_plan(picture);
}

/* OpenImageIO writes what TIFF of our own cannot be: of other colours, very large, or into a pipe, where nothing can be
 * filled in later. */
static int needs_other_tiff(const char *path, const RetexOutput *output, int width, int height, int channels,
                            const RetexWriteParams *params)
{
    return !has_own_colors(params) || !retex_tiff_fits(width, height, channels, params) ||
           (!output && !retex_output_is_file(path));
}

/* output: where the picture goes, which it takes over; NULL = the file at path, opened with the first bytes. */
static int open_picture(RetexPicture **result, const char *path, RetexOutput *output, int width, int height,
                        int channels, const RetexWriteParams *params, RetexError *err)
{
    int code = check_params(path, params, err);
    if (!code && (channels < 1 || channels > 4 || channels == 2))
        code = retex_fail(err, RETEX_EINVAL, "a picture has 1, 3 or 4 channels, not %d", channels);
    if (!code && (width < 1 || height < 1 || width > RETEX_MAX_SIZE || height > RETEX_MAX_SIZE))
        code = retex_fail(err, RETEX_EINVAL, "a picture of %d x %d pixels is out of bounds", width, height);
    if (!code && !output)
        code = retex_output_check(path, err);
    RetexPicture *picture = code ? NULL : new_picture(path, width, height, channels, params);
    if (!picture) {
        retex_output_abandon(&output);
        return code ? code : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", path);
    }
    picture->output = output;
    const RetexPictureFormat *own = is_exr(path, params) ? &retex_picture_exr : own_format(path);
    if (own == &retex_picture_tiff && needs_other_tiff(path, output, width, height, channels, params))
        own = NULL;
    picture->format = own ? own : &retex_picture_stored;
    if (own == &retex_picture_exr ? !is_linear_exr(path, params) : !own || !has_own_colors(params))
        begin_loading(picture);
    code = picture->format->begin(picture, err);
    if (code)
        free_picture(picture);
    else
        *result = picture;
    return code;
}

int retex_picture_open(RetexPicture **result, const char *path, int width, int height, int channels,
                       const RetexWriteParams *given, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    const int code = RETEX_PARAMS_COPY(&params, given, err);

    *result = NULL;
    return code ? code : open_picture(result, path, NULL, width, height, channels, &params, err);
}

int retex_picture_open_memory(RetexPicture **result, const char *format, int width, int height, int channels,
                              const RetexWriteParams *given, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexOutput *output = NULL;
    char name[64];

    *result = NULL;
    snprintf(name, sizeof name, "picture.%s", format);
    int code = RETEX_PARAMS_COPY(&params, given, err);
    if (!code)
        code = retex_output_open_memory(&output, err);
    return code ? code : open_picture(result, name, output, width, height, channels, &params, err);
}

/* --- strips --- */

/* Claims a strip for this thread: it must be a whole strip that no other thread has claimed. After a failure all calls
 * fail. */
static int claim_strip(RetexPicture *picture, int y0, int y1, RetexError *err)
{
    const int strip = y0 / RETEX_PICTURE_STRIP;
    int is_strip = y0 >= 0 && y0 < picture->height && y0 % RETEX_PICTURE_STRIP == 0 &&
                   y1 - y0 == retex_picture_strip_lines(picture, strip);

    pthread_mutex_lock(&picture->lock);
    *err = picture->error;
    if (is_strip && picture->strips[strip].state == RETEX_STRIP_ABSENT)
        picture->strips[strip].state = RETEX_STRIP_SUBMITTED;
    else
        is_strip = 0;
    pthread_mutex_unlock(&picture->lock);
    if (err->code)
        return err->code;
    return is_strip ? 0
                    : retex_fail(err, RETEX_EINVAL, "rows %d to %d are no strip of %s, or given twice", y0, y1,
                                 picture->path);
}

int retex_picture_rows(RetexPicture *picture, int y0, int y1, const float *rows, RetexError *err)
{
    RetexError error = {0};
    int code = claim_strip(picture, y0, y1, &error);

    if (!code)
        code = picture->format->strip(picture, y0 / RETEX_PICTURE_STRIP, rows, &error);
    if (!code)
        return 0;
    pthread_mutex_lock(&picture->lock);
    if (!picture->error.code)
        picture->error = error;
    pthread_mutex_unlock(&picture->lock);
    if (err)
        *err = error;
    return code;
}

/* Writes what follows the strips. */
static int finish_format(RetexPicture *picture, RetexError *err)
{
    if (picture->error.code) {
        if (err)
            *err = picture->error;
        return picture->error.code;
    }
    if (picture->next < picture->nstrips)
        return retex_fail(err, RETEX_EINVAL, "%s is not complete: rows from %d on are missing", picture->path,
                          picture->next * RETEX_PICTURE_STRIP);
    return picture->format->finish(picture, err);
}

static int finish(RetexPicture *picture, RetexError *err)
{
    const int code = finish_format(picture, err);
    return code || !picture->output ? code : retex_output_commit(&picture->output, err);
}

int retex_picture_take(RetexPicture **result, void **data, size_t *bytes, RetexError *err)
{
    RetexPicture *picture = *result;
    int code = finish_format(picture, err);

    *data = NULL;
    *bytes = 0;
    if (!code)
        code = retex_output_take(&picture->output, data, bytes, err);
    free_picture(picture);
    *result = NULL;
    return code;
}

int retex_picture_close(RetexPicture **result, int keep, RetexError *err)
{
    RetexPicture *picture = result ? *result : NULL;

    if (!picture)
        return 0;
    const int code = keep ? finish(picture, err) : 0;
    free_picture(picture);
    *result = NULL;
    return code;
}

/* --- a picture that is there already --- */

typedef struct WholeImage {
    RetexPicture *picture;
    const RetexImage *image;
} WholeImage;

static void write_strip(void *context, int index, int thread)
{
    const WholeImage *whole = context;
    const int y0 = index * RETEX_PICTURE_STRIP, y1 = y0 + retex_picture_strip_lines(whole->picture, index);

    (void)thread;
    (void)retex_picture_rows(whole->picture, y0, y1, whole->image->pixels + retex_image_index(whole->image, 0, y0),
                             NULL); /* the picture keeps the error */
}

int retex_picture_image(RetexPicture *picture, const RetexImage *image, int nthreads, RetexError *err)
{
    WholeImage whole = {picture, image};

    if (image->width != picture->width || image->height != picture->height || image->channels != picture->channels)
        return retex_fail(err, RETEX_EINVAL, "an image of %dx%d pixels, %d channels, is not that of the picture",
                          image->width, image->height, image->channels);
    retex_parallel(nthreads, picture->nstrips, write_strip, &whole);
    if (picture->error.code && err)
        *err = picture->error;
    return picture->error.code;
}

int retex_image_write(const RetexImage *src, const char *path, const RetexWriteParams *params, int nthreads,
                      RetexError *err)
{
    RetexPicture *picture;

    if (!src->pixels)
        return retex_fail(err, RETEX_EINVAL, "there is no picture to be written");
    const int code = retex_picture_open(&picture, path, src->width, src->height, src->channels, params, err);
    if (code)
        return code;
    (void)retex_picture_image(picture, src, nthreads, NULL); /* which the picture keeps the error of */
    return retex_picture_close(&picture, 1, err);
}
