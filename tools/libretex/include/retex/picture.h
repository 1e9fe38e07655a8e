/* Pictures that are written while they are computed: rows are submitted as strips from any thread, in any order, and
 * are converted and compressed in the calling thread. The whole picture is never in memory as floats. */
#ifndef RETEX_PICTURE_H
#define RETEX_PICTURE_H

#include <retex/budget.h>
#include <retex/image_file.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Rows of a strip; the last strip of a picture may have fewer. */
#define RETEX_PICTURE_STRIP 64

typedef struct RetexPicture RetexPicture;

/* Begin a picture of 1 (grey), 3 (RGB) or 4 (RGBA, unassociated) channels; path and params are as for
 * retex_image_write, which does the same for a whole image. Formats that need OpenImageIO begin loading it in a thread
 * of its own; JPEG, PNG and EXR do not need it, unless params or $OCIO ask for colours other than the built-in ones. An
 * unknown format or colour space fails here or at the first rows; retex_image_write_check tells at once. */
int retex_picture_open(RetexPicture **picture, const char *path, int width, int height, int channels,
                       const RetexWriteParams *params /* NULL = defaults; not needed afterwards */, RetexError *err);

/* Submit rows y0 <= y < y1: y0 is a multiple of RETEX_PICTURE_STRIP, y1 the next one or the height. Rows are
 * scene-linear, interleaved, and not needed afterwards. From any thread, each strip once; after a failure every call
 * fails with the same error. The file is the same to the byte whatever the order and the threads. */
int retex_picture_rows(RetexPicture *picture, int y0, int y1, const float *rows, RetexError *err);

/* Submit all rows of an image of the picture's size and channels. */
int retex_picture_image(RetexPicture *picture, const RetexImage *image, int nthreads /* 0 = all cores */,
                        RetexError *err);

/* Complete the file and put it at its path; fails if any call before did, or rows are missing. keep = 0: give up.
 * Unless it succeeds no new file is left and an old file is complete. Nulls *picture; NULL in it is fine. To be called
 * before the process exits, while no other thread uses the picture. */
int retex_picture_close(RetexPicture **picture, int keep, RetexError *err);

/* The same in memory: `format` is the ending of a file's name without the dot, such as "jpg". retex_picture_take
 * completes the picture and gives its bytes, those of the file; the caller frees them with free(). It fails as
 * retex_picture_close does, and nulls *picture in every case. */
int retex_picture_open_memory(RetexPicture **picture, const char *format, int width, int height, int channels,
                              const RetexWriteParams *params /* NULL = defaults */, RetexError *err);
int retex_picture_take(RetexPicture **picture, void **data, size_t *bytes, RetexError *err);

/* The same bytes of an image of 3 channels, made by a process of its own, which is ended when the budget's time is up
 * or it is stopped: RETEX_ELIMIT, as of retex_budget_check. Encoders of other libraries, of AVIF, JPEG XL and WebP,
 * cannot be ended otherwise. Of params, quality and view count; others are RETEX_EUNSUPPORTED. It takes .1 to .3 s to
 * start. */
int retex_picture_encode(void **data, size_t *bytes, const RetexImage *image, const char *format,
                         const RetexWriteParams *params /* NULL = defaults */, const RetexBudget *budget /* or NULL */,
                         int nthreads /* 0 = all cores */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
