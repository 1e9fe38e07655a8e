/* Images of textures: the files of a folder, by name, and maps of finishes that lie on them. An image is read once,
 * with its map, and stays in memory as long as all together keep within a limit, see kept.h; pictures place it on their
 * targets without copying it. The map of a colour is read for each picture. Any thread may call. */
#ifndef RETEX_SERVE_IMAGES_H
#define RETEX_SERVE_IMAGES_H

#include <limits.h>
#include <retex/combine.h>

#include "serve/files/content.h"

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

/* Make names paths: those of images, tiles and layers become files, named with or without their ending, or folders that
 * are textures; spec->finish a file. ids: of its files, by number; all 0 where it has none. 0, or 1 + the number of the
 * file that is not there; spec is then as it was. */
int images_find(const Images *images, RetexTextureSpec *spec, FileId ids[RETEX_TEXTURE_FILES]);

/* Whether its option finish names a map. */
int images_has_map(const RetexTextureSpec *spec);

/* What follows takes a spec whose names are paths, and which has the finishes of its target. */

/* Whether it has files: an image, or a map of finishes. */
int images_has_files(const RetexTextureSpec *spec);
/* The image of a texture that has files, read within a time: deadline is one of retex_clock_seconds. */
int images_take(Images *images, const RetexTextureSpec *spec, double deadline, OpenImage **image, RetexError *err);
/* The texture as spec says, of a target of the set. To be closed before the image is returned. */
int images_place(const Images *images, OpenImage *image, const RetexSet *set, const RetexTextureSpec *spec,
                 RetexTexture **texture, RetexError *err);
/* The contents of its files by number, once it was placed. Of a file that is not read there is no digest. */
const Content *images_contents(const OpenImage *image);
/* The same, if they are known without reading: 1, or 0. */
int images_find_contents(const Images *images, const RetexTextureSpec *spec, Content contents[RETEX_TEXTURE_FILES]);
/* The colours of its image alone, as they are in the file, and the file's content: R,G,B,A of an unallocated image. */
int images_read(const Images *images, const RetexTextureSpec *spec, double deadline, RetexImage *image,
                Content *content, RetexError *err);
/* Whether its image is an upload. */
int images_is_upload(const Images *images, const RetexTextureSpec *spec);
/* Whether an upload may have to be decoded for it. The finishes are not needed. */
int images_is_new_upload(Images *images, const RetexTextureSpec *spec);
void images_return(Images *images, OpenImage *image); /* NULL is fine */

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context);

typedef struct ImagesCount {
    int open;
    uint64_t bytes, read, failed; /* read and failed: since the start */
} ImagesCount;
ImagesCount images_count(Images *images);

#endif
