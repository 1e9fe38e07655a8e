/* What the makers of JPEG, PNG, EXR and all other files share of a picture that is being written; see retex/picture.h.
 *
 * A file that is laid down band by band consists of pieces, one a band, which any thread may hand in at any time. */
#ifndef RETEX_PICTURE_FORMAT_H
#define RETEX_PICTURE_FORMAT_H

#include <pthread.h>
#include <stdint.h>
#include <retex/image_file.h>
#include <retex/picture.h>

#include "picture/bridge_load.h"
#include "io/output.h"

typedef struct RetexPictureFormat {
    int (*begin)(RetexPicture *picture, RetexError *err);
    /* From any thread: lines of a band, as scene-linear floats. */
    int (*band)(RetexPicture *picture, int band, const float *rows, RetexError *err);
    /* After all bands; picture->output may be open already. */
    int (*finish)(RetexPicture *picture, RetexError *err);
    void (*end)(RetexPicture *picture); /* whatever happened; may be NULL */
} RetexPictureFormat;

extern const RetexPictureFormat retex_picture_jpeg, retex_picture_png, retex_picture_exr, retex_picture_stored;

typedef struct RetexPicturePiece {
    unsigned char *data;
    size_t bytes;
    int state; /* 0: nobody has begun it; 1: in the making; 2: in data, or already in the file */
} RetexPicturePiece;

struct RetexPicture {
    char *path;
    int width, height, channels; /* of the rows that come in */
    RetexWriteParams params;     /* its strings are copies */
    const RetexPictureFormat *format;
    void *state; /* what format keeps between its calls */

    pthread_mutex_t lock;      /* of all below */
    RetexError error;          /* the first one, whichever thread met it */
    RetexPicturePiece *pieces; /* one a band */
    int nbands, next;          /* next: the first piece that is not in the file */
    RetexOutput *output;       /* NULL until the first bytes are there */

    /* Only where OpenImageIO or OpenColorIO take part: */
    int bridged;
    pthread_t loader; /* makes plan */
    int loading;
    RetexBridgePlan *plan; /* NULL until somebody has waited for it */
    RetexBridgeStored stored;
    RetexError plan_error;
};

int retex_picture_band_lines(const RetexPicture *picture, int band);

/* Hand in a band's bytes, which are freed sooner or later; they are in the file as soon as all before them are. */
int retex_picture_submit_band(RetexPicture *picture, int band, unsigned char *data, size_t bytes, RetexError *err);
/* Append to the file; only while no other thread works on it. */
int retex_picture_append(RetexPicture *picture, const void *data, size_t bytes, RetexError *err);

/* Wait for the bridge's plan. */
int retex_picture_plan(RetexPicture *picture, RetexError *err);
/* Turn rows into codes of 8 bits as the display, or whatever params name, wants them; channels are those of the file.
 * Where there are fewer than the picture has, its alpha is lost and it is shown over black. */
int retex_picture_codes_8(RetexPicture *picture, uint8_t *codes, int channels, const float *rows, int nrows,
                          RetexError *err);

#endif
