/* What the server has: rooms, images, finished pictures; and the answers that are made of them. */
#ifndef RETEX_SERVE_SITE_H
#define RETEX_SERVE_SITE_H

#include "serve/answer/cache.h"
#include "serve/files/images.h"
#include "serve/files/presets.h"
#include "serve/files/rooms.h"
#include "serve/files/uploads.h"
#include "serve/site/work.h"

typedef struct Site {
    Rooms *rooms;
    Images *images;
    Presets presets;
    Uploads *uploads; /* NULL: there are none */
    Cache *pictures;
    int quality; /* of pictures that ask for none */
} Site;

enum { SITE_KEY_MAX = 2 * SERVE_URL_MAX + RETEX_MAX_TARGETS * RETEX_TEXTURE_FILES * FILE_ID_TEXT + 1024 };

/* Which queue a request is for. */
typedef enum SiteWork {
    SITE_TEXT,    /* needs no pixels */
    SITE_PICTURE, /* takes long */
    SITE_UPLOAD   /* needs an image of a stranger to be decoded, which may take as long as it is let */
} SiteWork;
SiteWork site_work_of(const Site *site, const ServeRequest *request);

/* What a request is of, by the files as they are now: two requests with the same key have the same answer. The names
 * of files in request->specs become paths, and what a preset says is added. Reads no other file. NULL, or an error: a
 * room, texture or preset that is not there. */
Answer *site_key(const Site *site, ServeRequest *request, const char *base, char key[SITE_KEY_MAX]);

/* The entity tag of a picture, if its room is open, so that it is known without waiting: 1, or 0. */
int site_known_etag(const Site *site, const ServeRequest *request, char etag[ETAG_SIZE]);

/* Make the answer: a WorkMake whose context is a Site. */
Answer *site_make(void *site, const WorkItem *item, int nthreads);

#endif
