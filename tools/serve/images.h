/* Images of textures: the files of a folder, by name. An image is read once, and stays in memory as long as all
 * together keep within a limit, see kept.h; pictures place it on their targets without copying it. Any thread may
 * call. */
#ifndef RETEX_SERVE_IMAGES_H
#define RETEX_SERVE_IMAGES_H

#include <limits.h>
#include <retex/combine.h>

#include "content.h"

typedef struct Images Images;
typedef struct OpenImage OpenImage;

typedef struct ImagesParams {
    const char *folder;        /* NULL: there are only colours, and uploads */
    const char *uploads;       /* a second folder, whose images are not listed; or NULL */
    uint64_t memory;           /* bytes of images that are kept */
    const RetexAccess *access; /* must allow these folders alone */
    RetexBudget *budget;
    int threads;     /* that decode an image of the folder */
    double decoding; /* seconds that decoding an upload may take */
} ImagesParams;

int images_open(Images **images, const ImagesParams *params, RetexError *err);
void images_close(Images *images); /* when no image is in use */

/* The file of a name, with or without its ending, or of a folder that is a texture, and its identity: 0, or -1 if there
 * is no such file. */
int images_find(const Images *images, const char *name, char *path, size_t size, FileId *id);

/* The image of a texture, by the path that images_find gave, read within a time: deadline is one of
 * retex_clock_seconds. */
int images_take(Images *images, const RetexTextureSpec *spec, double deadline, OpenImage **image, RetexError *err);
const Content *images_content(const OpenImage *image);
/* The content of a texture's file, if it is known without reading: 1, or 0. */
int images_find_content(const Images *images, const RetexTextureSpec *spec, Content *content);
/* The texture as spec says, of a target of the set. To be closed before the image is returned. */
int images_place(const OpenImage *image, const RetexSet *set, const RetexTextureSpec *spec, RetexTexture **texture,
                 RetexError *err);
/* Whether the image is an upload that has to be decoded. */
int images_is_new_upload(Images *images, const RetexTextureSpec *spec);
void images_return(Images *images, OpenImage *image); /* NULL is fine */

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context);

typedef struct ImagesCount {
    int open;
    uint64_t bytes, read, failed; /* read and failed: since the start */
} ImagesCount;
ImagesCount images_count(Images *images);

#endif
