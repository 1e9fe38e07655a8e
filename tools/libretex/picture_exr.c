/* EXR of halves, scene-linear. The table of where chunks are comes before them, so the file is laid down at the end;
 * what is held until then is compressed, unless it goes to a pipe. */
#include <stdlib.h>
#include <string.h>

#include "exr_io.h"
#include "picture_format.h"

typedef struct ExrMaker {
    RetexImage shape; /* no pixels */
    RetexExrEncoding *encoding;
} ExrMaker;

static int exr_begin(RetexPicture *picture, RetexError *err)
{
    ExrMaker *maker = calloc(1, sizeof *maker);
    RetexExrPart part = {.name = "beauty", .type = RETEX_HALF};

    if (!maker)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    picture->maker = maker;
    maker->shape = (RetexImage){picture->width, picture->height, picture->channels, NULL};
    part.image = &maker->shape;
    strcpy(part.letters, picture->channels == 1 ? "Y" : picture->channels == 3 ? "RGB" : "RGBA");
    return retex_exr_encoding_open(&maker->encoding, &part, strcmp(picture->path, "-") != 0, err);
}

/* Colours in an EXR are multiplied by alpha. */
static float *associate(const float *rows, size_t pixels)
{
    float *associated = malloc(pixels * 4 * sizeof *associated);

    for (size_t i = 0; associated && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            associated[4 * i + c] = rows[4 * i + c] * rows[4 * i + 3];
        associated[4 * i + 3] = rows[4 * i + 3];
    }
    return associated;
}

static int exr_band(RetexPicture *picture, int band, const float *rows, RetexError *err)
{
    ExrMaker *maker = picture->maker;
    const int y0 = band * RETEX_PICTURE_BAND, lines = retex_picture_band_lines(picture, band);
    float *associated = NULL;

    if (picture->channels == 4 && !(associated = associate(rows, (size_t)picture->width * (size_t)lines)))
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    const int status = retex_exr_encode_rows(maker->encoding, y0, y0 + lines, associated ? associated : rows, err);
    free(associated);
    return status ? status : retex_picture_lay(picture, band, NULL, 0, err);
}

static int exr_finish(RetexPicture *picture, RetexError *err)
{
    ExrMaker *maker = picture->maker;

    return retex_exr_write(maker->encoding, picture->width, picture->height, NULL, NULL, picture->path, err);
}

static void exr_end(RetexPicture *picture)
{
    ExrMaker *maker = picture->maker;

    if (maker)
        retex_exr_encoding_free(&maker->encoding);
    free(maker);
}

const RetexPictureFormat retex_picture_exr = {exr_begin, exr_band, exr_finish, exr_end};
