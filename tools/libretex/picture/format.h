/* Picture formats: the table of operations of a format, and the state of a picture that is being written; see
 * <retex/picture.h>.
 *
 * A file that is written strip by strip is the encoded strips one after the other. Any thread may submit any strip at
 * any time. */
#ifndef RETEX_PICTURE_FORMAT_H
#define RETEX_PICTURE_FORMAT_H

#include <pthread.h>
#include <stdint.h>
#include <retex/image_file.h>
#include <retex/picture.h>

#include "picture/bridge_load.h"
#include "picture/view.h"
#include "io/output.h"

typedef struct RetexPictureFormat {
    int (*begin)(RetexPicture *picture, RetexError *err);
    /* Encode the lines of a strip, scene-linear floats; from any thread. */
    int (*strip)(RetexPicture *picture, int strip, const float *rows, RetexError *err);
    /* Complete the file after all strips; picture->output may be open already. */
    int (*finish)(RetexPicture *picture, RetexError *err);
    void (*end)(RetexPicture *picture); /* free the state, after success or failure; may be NULL */
} RetexPictureFormat;

extern const RetexPictureFormat retex_picture_jpeg, retex_picture_png, retex_picture_exr, retex_picture_tiff,
    retex_picture_stored;

/* Whether a TIFF, whose places are of 32 bits, can hold the picture. */
int retex_tiff_fits(int width, int height, int channels, const RetexWriteParams *params);

typedef enum RetexStripState { RETEX_STRIP_ABSENT, RETEX_STRIP_SUBMITTED, RETEX_STRIP_ENCODED } RetexStripState;

/* The bytes of a strip in the file; without data once they are written. */
typedef struct RetexEncodedStrip {
    unsigned char *data;
    size_t bytes;
    RetexStripState state;
} RetexEncodedStrip;

struct RetexPicture {
    char *path;
    int width, height, channels; /* of the rows that are submitted */
    RetexWriteParams params;     /* its strings are copies */
    RetexView view;              /* RETEX_VIEWS: the bridge converts to the colours that params name, or to an sRGB
                                    that nothing precedes */
    const RetexPictureFormat *format;
    void *state; /* state of the format between its calls */

    pthread_mutex_t lock;      /* protects all members below */
    RetexError error;          /* the first error of any thread */
    RetexEncodedStrip *strips; /* one a strip */
    int nstrips, next;         /* next: the first strip that is not in the file */
    RetexOutput *output;       /* NULL until the first bytes are there */

    /* Only if OpenImageIO or OpenColorIO is used: */
    int bridged;
    pthread_t loader; /* the thread that makes plan */
    int loading;
    RetexBridgePlan *plan; /* NULL until a thread has waited for it */
    RetexBridgeStored stored;
    RetexError plan_error;
};

int retex_picture_strip_lines(const RetexPicture *picture, int strip);

/* Submit the encoded bytes of a strip, which are freed later; they are written when all strips before them are. */
int retex_picture_submit_strip(RetexPicture *picture, int strip, unsigned char *data, size_t bytes, RetexError *err);
/* Append to the file; only while no other thread uses it. */
int retex_picture_append(RetexPicture *picture, const void *data, size_t bytes, RetexError *err);

/* Wait for the bridge's plan. */
int retex_picture_plan(RetexPicture *picture, RetexError *err);
/* Convert rows to codes of 8 or 16 bits, those in the machine's byte order, for the display, or the space that params
 * name; channels are those of the file. A picture with more channels than the file loses its alpha and is shown over
 * black. */
int retex_picture_codes(RetexPicture *picture, void *codes, int bits, int channels, const float *rows, int nrows,
                        RetexError *err);

#endif
