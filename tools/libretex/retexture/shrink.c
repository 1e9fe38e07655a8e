/* See retex/shrink.h. Rows are scaled to their width when they come, from any thread; columns at the end. A pixel i of
 * n that share a length covers i * length / n to (i + 1) * length / n; the picture's pixels at both ends count by the
 * part of them that is covered. */
#include <retex/shrink.h>

#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

struct RetexShrink {
    RetexCut cut;
    int picture_width;
    RetexImage tall; /* the cut at its width and the picture's height */
};

/* ---- where ---- */

/* length * to / from, rounded, at least 1. */
static int scaled(int length, int to, int from)
{
    const int64_t product = (2 * (int64_t)length * to + from) / (2 * (int64_t)from);
    return product < 1 ? 1 : product > INT32_MAX ? INT32_MAX : (int)product;
}

/* The part in the middle that has the aspect of its size. */
static void cut_to_aspect(RetexCut *cut)
{
    const int width = cut->scaled_width, height = cut->scaled_height;
    if ((int64_t)cut->width * height > (int64_t)cut->height * width) {
        const int kept = scaled(cut->height, width, height);
        cut->x += (cut->width - kept) / 2;
        cut->width = kept;
    } else {
        const int kept = scaled(cut->width, height, width);
        cut->y += (cut->height - kept) / 2;
        cut->height = kept;
    }
}

int retex_cut_fit(RetexCut *cut, int picture_width, int picture_height, const int crop[4], int width, int height,
                  RetexError *err)
{
    *cut = crop[2] || crop[3] ? (RetexCut){crop[0], crop[1], crop[2], crop[3], 0, 0}
                              : (RetexCut){0, 0, picture_width, picture_height, 0, 0};
    if (cut->x < 0 || cut->y < 0 || cut->width < 1 || cut->height < 1 || cut->width > picture_width - cut->x ||
        cut->height > picture_height - cut->y)
        return retex_fail(err, RETEX_EINVAL, "the crop %d,%d,%d,%d is not within the picture's %dx%d pixels", crop[0],
                          crop[1], crop[2], crop[3], picture_width, picture_height);
    if (width < 0 || height < 0)
        return retex_fail(err, RETEX_EINVAL, "a size below 0 pixels");
    cut->scaled_width = width ? width : height ? scaled(cut->width, height, cut->height) : cut->width;
    cut->scaled_height = height ? height : width ? scaled(cut->height, width, cut->width) : cut->height;
    if (cut->scaled_width > cut->width || cut->scaled_height > cut->height)
        return retex_fail(err, RETEX_EINVAL, "the picture, or this part of it, has %dx%d pixels; it is not enlarged",
                          cut->width, cut->height);
    if (width && height)
        cut_to_aspect(cut);
    return RETEX_OK;
}

int retex_cut_is_whole(const RetexCut *cut, int picture_width, int picture_height)
{
    return cut->width == picture_width && cut->height == picture_height && cut->scaled_width == picture_width &&
           cut->scaled_height == picture_height;
}

/* ---- how ---- */

/* The pixels that pixel i of n covers of a length: first to last, all in full but for these two. */
typedef struct Cover {
    int first, last;
    float first_share, last_share; /* of the mean; that of last is 0 where it is first */
    float share;                   /* of a pixel that is covered in full */
} Cover;

static Cover cover_of(int i, int n, int length)
{
    /* in units of 1/n pixel */
    const int64_t begin = (int64_t)i * length, end = begin + length;
    Cover cover = {(int)(begin / n), (int)((end - 1) / n), 0, 0, (float)n / (float)length};
    const int64_t first_end = (int64_t)(cover.first + 1) * n;
    cover.first_share = (float)((end < first_end ? end : first_end) - begin) / (float)length;
    if (cover.last > cover.first)
        cover.last_share = (float)(end - (int64_t)cover.last * n) / (float)length;
    return cover;
}

static void shrink_row(float *out, int width, const float *row, int length)
{
    if (width == length) {
        memcpy(out, row, 3 * sizeof *out * (size_t)width);
        return;
    }
    for (int i = 0; i < width; i++, out += 3) {
        const Cover cover = cover_of(i, width, length);
        const float *first = row + 3 * (size_t)cover.first, *last = row + 3 * (size_t)cover.last;
        for (int c = 0; c < 3; c++)
            out[c] = cover.first_share * first[c] + cover.last_share * last[c];
        for (const float *p = first + 3; p < last; p += 3)
            for (int c = 0; c < 3; c++)
                out[c] += cover.share * p[c];
    }
}

static void add_row(float *restrict sum, const float *restrict row, float share, size_t count)
{
    for (size_t i = 0; i < count; i++)
        sum[i] += share * row[i];
}

typedef struct Columns {
    RetexImage *dst;
    const RetexImage *src;
} Columns;

static void shrink_columns(void *context, int y, int thread)
{
    const Columns *work = context;
    const RetexImage *src = work->src;
    const size_t count = (size_t)src->width * (size_t)src->channels;
    const Cover cover = cover_of(y, work->dst->height, src->height);
    float *out = work->dst->pixels + retex_image_index(work->dst, 0, y); /* 0 */
    (void)thread;
    add_row(out, src->pixels + retex_image_index(src, 0, cover.first), cover.first_share, count);
    for (int from = cover.first + 1; from < cover.last; from++)
        add_row(out, src->pixels + retex_image_index(src, 0, from), cover.share, count);
    if (cover.last > cover.first)
        add_row(out, src->pixels + retex_image_index(src, 0, cover.last), cover.last_share, count);
}

/* ---- rows ---- */

int retex_shrink_open(RetexShrink **shrink, const RetexCut *cut, int picture_width, RetexError *err)
{
    *shrink = NULL;
    if (cut->x < 0 || cut->y < 0 || cut->width > picture_width - cut->x || cut->scaled_width < 1 ||
        cut->scaled_height < 1 || cut->scaled_width > cut->width || cut->scaled_height > cut->height)
        return retex_fail(err, RETEX_EINVAL,
                          "a cut of %dx%d pixels at %d,%d cannot have %dx%d pixels of a picture %d "
                          "wide",
                          cut->width, cut->height, cut->x, cut->y, cut->scaled_width, cut->scaled_height,
                          picture_width);
    RetexShrink *own = calloc(1, sizeof *own);
    if (!own)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a smaller picture");
    own->cut = *cut;
    own->picture_width = picture_width;
    const int code = retex_image_alloc(&own->tall, cut->scaled_width, cut->height, 3, err);
    if (code) {
        free(own);
        return code;
    }
    *shrink = own;
    return RETEX_OK;
}

int retex_shrink_rows(void *shrink, int y0, int y1, const float *rows, RetexError *err)
{
    RetexShrink *own = shrink;
    const RetexCut *cut = &own->cut;
    const size_t length = 3 * (size_t)own->picture_width;
    (void)err;
    for (int y = y0; y < y1; y++, rows += length)
        if (y >= cut->y && y - cut->y < cut->height)
            shrink_row(own->tall.pixels + retex_image_index(&own->tall, 0, y - cut->y), cut->scaled_width,
                       rows + 3 * (size_t)cut->x, cut->width);
    return RETEX_OK;
}

int retex_shrink_take(RetexShrink **shrink, RetexImage *image, int nthreads, RetexError *err)
{
    RetexShrink *own = *shrink;
    int code = RETEX_OK;
    if (own->cut.scaled_height == own->cut.height) {
        *image = own->tall;
        own->tall = (RetexImage){0};
    } else {
        code = retex_image_alloc(image, own->cut.scaled_width, own->cut.scaled_height, 3, err);
    }
    Columns work = {image, &own->tall};
    if (!code && own->tall.pixels)
        retex_parallel(nthreads, image->height, shrink_columns, &work);
    retex_shrink_close(shrink);
    return code;
}

void retex_shrink_close(RetexShrink **shrink)
{
    if (!shrink || !*shrink)
        return;
    retex_image_free(&(*shrink)->tall);
    free(*shrink);
    *shrink = NULL;
}
