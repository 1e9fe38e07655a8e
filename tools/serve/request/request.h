/* What a request asks retex-serve for, once its URL is parsed. */
#ifndef RETEX_SERVE_REQUEST_H
#define RETEX_SERVE_REQUEST_H

#include <retex/edit.h>
#include <retex/set.h>

#include "serve/request/name.h"

enum {
    SERVE_URL_MAX = 4096,      /* bytes of a URL's path and query */
    SERVE_BASE_MAX = 320,      /* bytes of the beginning of the server's own URLs, with a signature */
    SERVE_THUMBNAIL_SIDE = 256 /* a thumbnail fits into a square of these pixels */
};

typedef enum ServeRoute {
    SERVE_HEALTH,
    SERVE_METRICS,
    SERVE_ROOMS,
    SERVE_ROOM,
    SERVE_PICTURE,
    SERVE_THUMBNAIL, /* a small picture, for lists; in all else as SERVE_PICTURE */
    SERVE_TEXTURE,   /* a small picture of a texture, the only one of `specs`, of no target and no room */
    SERVE_IIIF_BASE, /* redirect to its info.json */
    SERVE_IIIF_INFO,
    SERVE_IIIF_IMAGE,
    SERVE_UPLOAD /* POST /v1/uploads, which is no URL of a GET */
} ServeRoute;

typedef enum ServeFormat { SERVE_JPEG, SERVE_PNG, SERVE_WEBP, SERVE_AVIF, SERVE_JXL, SERVE_FORMATS } ServeFormat;

/* Part of the room's picture, as it was asked for. */
typedef enum ServeRegionKind {
    SERVE_REGION_FULL,
    SERVE_REGION_SQUARE,
    SERVE_REGION_PIXELS,
    SERVE_REGION_PERCENT
} ServeRegionKind;
typedef struct ServeRegion {
    ServeRegionKind kind;
    double x, y, width, height; /* pixels, whole, or percent; not of FULL and SQUARE */
} ServeRegion;

/* Size to which the region is scaled, before rotation. */
typedef enum ServeSizeKind {
    SERVE_SIZE_MAX,     /* that of the region */
    SERVE_SIZE_WIDTH,   /* height by the region's aspect */
    SERVE_SIZE_HEIGHT,  /* width by the region's aspect */
    SERVE_SIZE_PERCENT, /* of the region's */
    SERVE_SIZE_EXACT,   /* width and height, which may distort */
    SERVE_SIZE_WITHIN,  /* as large as width and height allow, by the region's aspect */
    SERVE_SIZE_FILL     /* width and height; the region loses what does not fit, evenly on both sides */
} ServeSizeKind;
typedef struct ServeSize {
    ServeSizeKind kind;
    int width, height; /* 0 = not given */
    double percent;
    int may_enlarge; /* IIIF's `^` */
} ServeSize;

typedef struct ServeRequest {
    ServeRoute route;
    int status;       /* 0, or the HTTP status of an error: 400, 404, 406, 414, 501 or 503 */
    char reason[200]; /* of the error, one line of plain text: UTF-8 without control characters */
    char room[SERVE_NAME_MAX + 1];

    /* Textures by target, each target at most once, sorted by name. `image` and `finish` are names of files without
     * folder. The names of targets are as in the URL: whether the room has them, and as what, is for
     * retex_set_find_target. */
    int nspecs;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    char edits[SERVE_URL_MAX]; /* the same as the canonical text of an edit, with all else that it says */
    char preset[SERVE_NAME_MAX + 1]; /* the name of one, or "" */

    /* pictures, thumbnails, textures and images of IIIF */
    ServeRegion region;
    ServeSize size;
    int size_by_hints; /* 1: `auto`, which hints.h makes a size; until then it is SERVE_SIZE_MAX */
    int quarter_turns; /* 0..3, clockwise, after scaling */
    int mirror;        /* 1: left-right, before turning */
    int gray;
    ServeFormat format;
    int format_by_accept; /* 1: the response needs `Vary: Accept` */
    int quality;          /* of all but PNG, 1..100; 0 = not given */
} ServeRequest;

/* Refuse a request: set its status and reason, and return the status. Text that comes from the URL must be decoded. */
int serve_refuse(ServeRequest *request, int status, const char *fmt, ...) RETEX_PRINTF(3, 4);

/* Set the format by its extension. Returns 0, or the status if it is none of `formats`. */
int serve_format_set(ServeRequest *request, const char *extension, unsigned formats);

/* "jpg", "image/jpeg" */
const char *serve_format_extension(ServeFormat format);
const char *serve_format_type(ServeFormat format);

#endif
