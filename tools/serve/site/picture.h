/* From a request to the bytes of its picture. */
#ifndef RETEX_SERVE_PICTURE_H
#define RETEX_SERVE_PICTURE_H

#include <retex/combine.h>

#include "serve/request/iiif.h"

/* A picture: part of a room, with textures, scaled, mirrored and turned as a request says. */
typedef struct PicturePlan {
    const RetexSet *set;
    RetexTexture *const *textures; /* by target */
    const float *parameters;       /* of the set, as of RetexCombineParams */
    RetexDevelop develop;
    char view[RETEX_NAME_MAX]; /* of the display; "": its default */
    RetexCut place;
    int quarter_turns, mirror, gray;
    ServeFormat format;
    int quality;     /* 1..100 */
    double deadline; /* of retex_clock_seconds: beyond it the picture is given up, RETEX_ELIMIT */
} PicturePlan;

/* The file in memory; the caller frees *data. A whole picture is, to the byte, what retex-combine writes. */
int picture_make(const PicturePlan *plan, int nthreads, void **data, size_t *bytes, RetexError *err);

/* The formats that this machine can write, as bits 1 << ServeFormat. The first call tries them, which loads OpenImageIO
 * and takes a quarter of a second; any thread may call. */
unsigned picture_formats(void);

#endif
