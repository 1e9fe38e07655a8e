/* See picture.h. A whole picture is encoded strip by strip while it is made. A part, a
 * smaller picture, or one whose encoder may take long, is made first, then it is mirrored, turned and encoded. */
#include "serve/site/picture.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include <retex/clock.h>
#include <retex/color.h>

static int is_late(RetexError *err)
{
    return retex_fail(err, RETEX_ELIMIT, "the picture takes longer than a request may");
}

static int check_time(double deadline, RetexError *err)
{
    return retex_clock_seconds() < deadline ? RETEX_OK : is_late(err);
}

/* JPEG and PNG are encoded strip by strip, and time is looked at between them. Encoders of other formats go on until
 * they are done: of AVIF that is seconds a megapixel, so that larger pictures are encoded by a process that can be
 * ended. */
enum { QUICK_PIXELS = 1 << 17 };

static int is_quick(ServeFormat format, int width, int height)
{
    return format == SERVE_JPEG || format == SERVE_PNG || (int64_t)width * height <= QUICK_PIXELS;
}

static RetexWriteParams write_params(const PicturePlan *plan)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    params.quality = plan->quality;
    params.view = plan->view;
    return params;
}

static int open_picture(RetexPicture **picture, const PicturePlan *plan, int width, int height, RetexError *err)
{
    const RetexWriteParams params = write_params(plan);
    return retex_picture_open_memory(picture, serve_format_extension(plan->format), width, height, 3, &params, err);
}

/* Complete the picture, or give it up after a failure. */
static int take_picture(RetexPicture **picture, int code, void **data, size_t *bytes, RetexError *err)
{
    if (!code)
        return retex_picture_take(picture, data, bytes, err);
    retex_picture_close(picture, 0, NULL);
    return code;
}

/* ---- a whole picture ---- */

typedef struct Whole {
    const PicturePlan *plan;
    RetexPicture *picture;
} Whole;

static int write_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    const Whole *whole = context;
    int code = check_time(whole->plan->deadline, err);
    return code ? code : retex_picture_rows(whole->picture, y0, y1, rows, err);
}

static int is_whole(const PicturePlan *plan)
{
    const RetexSetInfo info = retex_set_info(plan->set);
    return is_quick(plan->format, info.width, info.height) &&
           retex_cut_is_whole(&plan->place, info.width, info.height) && !plan->quarter_turns && !plan->mirror &&
           !plan->gray;
}

static int make_whole(const PicturePlan *plan, int nthreads, void **data, size_t *bytes, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(plan->set);
    Whole whole = {plan, NULL};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    params.parameters = plan->parameters;
    params.develop = &plan->develop;
    int code = open_picture(&whole.picture, plan, info.width, info.height, err);
    if (!code)
        code = retex_retexture(plan->set, plan->textures, &params, write_rows, &whole, nthreads, err);
    return take_picture(&whole.picture, code, data, bytes, err);
}

/* ---- a part ---- */

typedef struct Part {
    const PicturePlan *plan;
    RetexShrink *shrink;
} Part;

static int keep_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    const Part *part = context;
    int code = check_time(part->plan->deadline, err);
    return code ? code : retex_shrink_rows(part->shrink, y0, y1, rows, err);
}

/* The part at its size. */
static int make_scaled(RetexImage *scaled, const PicturePlan *plan, int nthreads, RetexError *err)
{
    const RetexCut *place = &plan->place;
    Part part = {plan, NULL};
    RetexCombineParams params = RETEX_COMBINE_INIT;
    params.y0 = place->y;
    params.y1 = place->y + place->height;
    params.x0 = place->x;
    params.x1 = place->x + place->width;
    params.parameters = plan->parameters;
    params.develop = &plan->develop;
    int code = retex_shrink_open(&part.shrink, place, retex_set_info(plan->set).width, err);
    if (!code)
        code = retex_retexture(plan->set, plan->textures, &params, keep_rows, &part, nthreads, err);
    if (!code)
        code = retex_shrink_take(&part.shrink, scaled, nthreads, err);
    retex_shrink_close(&part.shrink);
    return code;
}

static void make_gray(RetexImage *image)
{
    float *p = image->pixels;
    for (size_t i = (size_t)image->width * (size_t)image->height; i > 0; i--, p += 3)
        p[0] = p[1] = p[2] = retex_luminancef(p[0], p[1], p[2]);
}

static void mirror(RetexImage *image)
{
    for (int y = 0; y < image->height; y++) {
        float *left = image->pixels + retex_image_index(image, 0, y);
        for (float *right = left + 3 * (size_t)(image->width - 1); left < right; left += 3, right -= 3)
            for (int c = 0; c < 3; c++) {
                const float value = left[c];
                left[c] = right[c];
                right[c] = value;
            }
    }
}

/* Turn clockwise. */
static int turn(RetexImage *image, int quarters, RetexError *err)
{
    RetexImage turned = {0};
    const int width = quarters % 2 ? image->height : image->width, height = quarters % 2 ? image->width : image->height;
    int code = quarters ? retex_image_alloc(&turned, width, height, 3, err) : RETEX_OK;
    if (code || !quarters)
        return code;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const int from_x = quarters == 1 ? y : quarters == 2 ? image->width - 1 - x : image->width - 1 - y;
            const int from_y = quarters == 1 ? image->height - 1 - x : quarters == 2 ? image->height - 1 - y : x;
            memcpy(turned.pixels + retex_image_index(&turned, x, y),
                   image->pixels + retex_image_index(image, from_x, from_y), 3 * sizeof(float));
        }
    retex_image_free(image);
    *image = turned;
    return RETEX_OK;
}

static int encode_quickly(const PicturePlan *plan, const RetexImage *image, int nthreads, void **data, size_t *bytes,
                          RetexError *err)
{
    RetexPicture *picture = NULL;
    int code = open_picture(&picture, plan, image->width, image->height, err);
    if (!code)
        code = retex_picture_image(picture, image, nthreads, err);
    return take_picture(&picture, code, data, bytes, err);
}

/* Until the deadline. */
static int encode_in_time(const PicturePlan *plan, const RetexImage *image, int nthreads, void **data, size_t *bytes,
                          RetexError *err)
{
    const RetexWriteParams params = write_params(plan);
    RetexBudget *budget = NULL;
    int code = check_time(plan->deadline, err);
    if (!code)
        code = retex_budget_create(&budget, err);
    if (code)
        return code;
    const double left = plan->deadline - retex_clock_seconds();
    retex_budget_set_seconds(budget, fmax(left, 1e-3)); /* 0 would be no limit */
    code = retex_picture_encode(data, bytes, image, serve_format_extension(plan->format), &params, budget, nthreads,
                                err);
    retex_budget_close(&budget);
    return code ? (retex_clock_seconds() < plan->deadline ? code : is_late(err)) : RETEX_OK;
}

static int make_part(const PicturePlan *plan, int nthreads, void **data, size_t *bytes, RetexError *err)
{
    RetexImage image = {0};
    int code = make_scaled(&image, plan, nthreads, err);
    if (!code && plan->gray)
        make_gray(&image);
    if (!code && plan->mirror)
        mirror(&image);
    if (!code)
        code = turn(&image, plan->quarter_turns, err);
    if (!code)
        code = is_quick(plan->format, image.width, image.height)
                   ? encode_quickly(plan, &image, nthreads, data, bytes, err)
                   : encode_in_time(plan, &image, nthreads, data, bytes, err);
    retex_image_free(&image);
    return code;
}

int picture_make(const PicturePlan *plan, int nthreads, void **data, size_t *bytes, RetexError *err)
{
    *data = NULL;
    *bytes = 0;
    return is_whole(plan) ? make_whole(plan, nthreads, data, bytes, err) : make_part(plan, nthreads, data, bytes, err);
}

/* ---- formats ---- */

/* Whether a file is what its ending says. */
static int has_signature(ServeFormat format, const char *data, size_t bytes)
{
    static const struct {
        size_t at;
        const char *text;
    } signatures[SERVE_FORMATS] = {{0, "\xff\xd8"}, {0, "\x89PNG"}, {8, "WEBP"}, {8, "avif"}, {0, "\xff\x0a"}};
    const size_t at = signatures[format].at, length = strlen(signatures[format].text);
    return bytes >= at + length && memcmp(data + at, signatures[format].text, length) == 0;
}

static int can_write(ServeFormat format)
{
    static const float pixels[3 * 8 * 8];
    const PicturePlan plan = {.format = format, .quality = 80, .view = ""};
    RetexPicture *picture = NULL;
    void *data = NULL;
    size_t bytes = 0;
    int code = open_picture(&picture, &plan, 8, 8, NULL);
    if (!code)
        code = retex_picture_rows(picture, 0, 8, pixels, NULL);
    code = take_picture(&picture, code, &data, &bytes, NULL);
    const int is_right = !code && has_signature(format, data, bytes);
    free(data);
    return is_right;
}

static unsigned writable;

static void try_formats(void)
{
    for (int format = 0; format < SERVE_FORMATS; format++)
        writable |= can_write((ServeFormat)format) ? 1u << format : 0;
}

unsigned picture_formats(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, try_formats);
    return writable;
}
