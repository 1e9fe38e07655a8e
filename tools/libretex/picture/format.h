/* Picture formats: the table of operations of a format, and the state of a picture that is being written; see
 * <retex/picture.h>.
 *
 * A file that is written band by band is the encoded bands one after the other. Any thread may submit any band at any
 * time. */
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
    /* Encode the lines of a band, scene-linear floats; from any thread. */
    int (*band)(RetexPicture *picture, int band, const float *rows, RetexError *err);
    /* Complete the file after all bands; picture->output may be open already. */
    int (*finish)(RetexPicture *picture, RetexError *err);
    void (*end)(RetexPicture *picture); /* free the state, after success or failure; may be NULL */
} RetexPictureFormat;

extern const RetexPictureFormat retex_picture_jpeg, retex_picture_png, retex_picture_exr, retex_picture_stored;

typedef enum RetexBandState { RETEX_BAND_ABSENT, RETEX_BAND_SUBMITTED, RETEX_BAND_ENCODED } RetexBandState;

/* The bytes of a band in the file; without data once they are written. */
typedef struct RetexEncodedBand {
    unsigned char *data;
    size_t bytes;
    RetexBandState state;
} RetexEncodedBand;

struct RetexPicture {
    char *path;
    int width, height, channels; /* of the rows that are submitted */
    RetexWriteParams params;     /* its strings are copies */
    const RetexPictureFormat *format;
    void *state; /* state of the format between its calls */

    pthread_mutex_t lock;    /* protects all members below */
    RetexError error;        /* the first error of any thread */
    RetexEncodedBand *bands; /* one a band */
    int nbands, next;        /* next: the first band that is not in the file */
    RetexOutput *output;     /* NULL until the first bytes are there */

    /* Only if OpenImageIO or OpenColorIO is used: */
    int bridged;
    pthread_t loader; /* the thread that makes plan */
    int loading;
    RetexBridgePlan *plan; /* NULL until a thread has waited for it */
    RetexBridgeStored stored;
    RetexError plan_error;
};

int retex_picture_band_lines(const RetexPicture *picture, int band);

/* Submit the encoded bytes of a band, which are freed later; they are written when all bands before them are. */
int retex_picture_submit_band(RetexPicture *picture, int band, unsigned char *data, size_t bytes, RetexError *err);
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
