/* All other formats, which OpenImageIO writes: the samples of the file, 1 to 4 bytes each, are kept in memory until all
 * are there. */
#include <stdlib.h>
#include <string.h>

#include "picture/format.h"

static size_t row_samples(const RetexPicture *picture)
{
    return (size_t)picture->width * (size_t)picture->stored.channels;
}

/* Writing HEIC, OpenImageIO 2.4 reads rows as long as those of libheif, which are padded: beyond the last row
 * of a narrow picture too. */
enum { BYTES_READ_BEYOND = 1024 };

/* Allocates the samples, when the bridge has told how many there are. */
static int need_samples(RetexPicture *picture, RetexError *err)
{
    int code = retex_picture_plan(picture, err);

    if (code)
        return code;
    const size_t bytes = row_samples(picture) * (size_t)picture->height * (size_t)(picture->stored.bits / 8);
    pthread_mutex_lock(&picture->lock);
    if (!picture->state && (picture->state = malloc(bytes + BYTES_READ_BEYOND)))
        memset((char *)picture->state + bytes, 0, BYTES_READ_BEYOND);
    if (!picture->state)
        code = retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    pthread_mutex_unlock(&picture->lock);
    return code;
}

static int stored_begin(RetexPicture *picture, RetexError *err)
{
    (void)picture, (void)err;
    return 0;
}

static int stored_strip(RetexPicture *picture, int strip, const float *rows, RetexError *err)
{
    const int lines = retex_picture_strip_lines(picture, strip);
    int code = need_samples(picture, err);

    if (code)
        return code;
    const size_t row = row_samples(picture), first = row * (size_t)strip * RETEX_PICTURE_STRIP;
    unsigned char *samples = (unsigned char *)picture->state + first * (size_t)(picture->stored.bits / 8);
    if (picture->stored.bits <= 16)
        code =
            retex_picture_codes(picture, samples, picture->stored.bits, picture->stored.channels, rows, lines, err);
    else
        code = retex_bridge_convert(picture->plan, rows, (long)picture->width * lines, samples, err);
    return code ? code : retex_picture_submit_strip(picture, strip, NULL, 0, err);
}

static int append(void *picture, const void *data, size_t bytes, RetexError *err)
{
    return retex_picture_append(picture, data, bytes, err);
}

static int stored_finish(RetexPicture *picture, RetexError *err)
{
    return retex_bridge_write(picture->plan, picture->state, append, picture, err);
}

static void stored_end(RetexPicture *picture)
{
    free(picture->state);
}

const RetexPictureFormat retex_picture_stored = {stored_begin, stored_strip, stored_finish, stored_end};
