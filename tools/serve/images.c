/* See images.h. */
#include "images.h"

#include <errno.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"
#include "request.h"

static const char *const endings[] = {"jpg", "jpeg", "png", "exr", "tif", "tiff", "hdr", "tga", "bmp", "gif", NULL};

struct OpenImage {
    struct OpenImage *next;
    RetexTextureSpec spec; /* as the image was read, in its simplest placement */
    FileId id;
    RetexTexture *texture;
    uint64_t bytes, used;
    int users, is_ready, is_stale;
};

struct Images {
    ImagesParams params;
    pthread_mutex_t lock; /* protects all below, and images that are not ready */
    pthread_cond_t ready;
    OpenImage *first;
    uint64_t bytes, uses, read, failed;
    int count;
};

int images_open(Images **images, const ImagesParams *params, RetexError *err)
{
    struct stat info;
    *images = NULL;
    if (params->folder && stat(params->folder, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", params->folder, strerror(errno));
    if (params->folder && !S_ISDIR(info.st_mode))
        return retex_fail(err, RETEX_EIO, "%s is no folder", params->folder);
    if (!(*images = calloc(1, sizeof **images)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for images");
    (*images)->params = *params;
    pthread_mutex_init(&(*images)->lock, NULL);
    pthread_cond_init(&(*images)->ready, NULL);
    return RETEX_OK;
}

static void remove_image(Images *images, OpenImage *image)
{
    OpenImage **place = &images->first;
    while (*place != image)
        place = &(*place)->next;
    *place = image->next;
    images->bytes -= image->bytes;
    images->count--;
    retex_texture_close(&image->texture);
    free(image);
}

void images_close(Images *images)
{
    if (!images)
        return;
    while (images->first)
        remove_image(images, images->first);
    pthread_cond_destroy(&images->ready);
    pthread_mutex_destroy(&images->lock);
    free(images);
}

/* A name that has no folder in it, which leads nowhere else. */
static int is_plain(const char *name)
{
    return serve_name_is_valid(name) && !strchr(name, '/');
}

int images_find(const Images *images, const char *name, char *path, size_t size, FileId *id)
{
    const char *folder = images->params.folder;
    if (!folder || !is_plain(name))
        return -1;
    for (int i = -1; i < 0 || endings[i]; i++) {
        const int length = snprintf(path, size, "%s/%s%s%s", folder, name, i < 0 ? "" : ".", i < 0 ? "" : endings[i]);
        if (length > 0 && (size_t)length < size && file_id_of(id, path) == 0)
            return retex_access_check(images->params.access, "", path) == RETEX_ACCESS_ALLOWED ? 0 : -1;
    }
    return -1;
}

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context)
{
    return images->params.folder ? names_list(images->params.folder, endings, 1, tell, context) : 0;
}

/* ---- images in memory ---- */

/* What of a spec decides on the texels. */
static void simplify(RetexTextureSpec *simple, const RetexTextureSpec *spec, const ImagesParams *params)
{
    *simple = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    strcpy(simple->image, spec->image);
    strcpy(simple->colorspace, spec->colorspace);
    memcpy(simple->wrap, spec->wrap, sizeof simple->wrap);
    simple->repeat = spec->repeat;
    simple->access = params->access;
    simple->budget = params->budget;
}

static int has_texels_of(const RetexTextureSpec *a, const RetexTextureSpec *b)
{
    return strcmp(a->image, b->image) == 0 && strcmp(a->colorspace, b->colorspace) == 0 && a->wrap[0] == b->wrap[0] &&
           a->wrap[1] == b->wrap[1] && a->repeat == b->repeat;
}

static OpenImage *find_open(Images *images, const RetexTextureSpec *spec)
{
    for (OpenImage *image = images->first; image; image = image->next)
        if (!image->is_stale && has_texels_of(&image->spec, spec))
            return image;
    return NULL;
}

/* Free images that nobody uses, those used least recently first, until all are within the limit. */
static void make_space(Images *images)
{
    while (images->bytes > images->params.memory) {
        OpenImage *oldest = NULL;
        for (OpenImage *image = images->first; image; image = image->next)
            if (!image->users && image->is_ready && (!oldest || image->used < oldest->used))
                oldest = image;
        if (!oldest)
            return;
        remove_image(images, oldest);
    }
}

static void drop_stale(Images *images, OpenImage *image)
{
    image->is_stale = 1;
    if (!image->users)
        remove_image(images, image);
}

/* The image of this spec: *is_new: the caller has to read it. */
static OpenImage *find_or_add(Images *images, const RetexTextureSpec *spec, const FileId *id, int *is_new)
{
    OpenImage *image = find_open(images, spec);
    while (image && !image->is_ready) {
        pthread_cond_wait(&images->ready, &images->lock);
        image = find_open(images, spec);
    }
    if (image && !file_id_is_same(&image->id, id)) {
        drop_stale(images, image);
        image = NULL;
    }
    *is_new = !image;
    if (!image && !(image = calloc(1, sizeof *image)))
        return NULL;
    if (*is_new) {
        simplify(&image->spec, spec, &images->params);
        image->id = *id;
        image->next = images->first;
        images->first = image;
        images->count++;
    }
    image->users++;
    image->used = ++images->uses;
    return image;
}

static int read_image(Images *images, OpenImage *image, RetexError *err)
{
    int code = retex_texture_load(&image->texture, &image->spec, images->params.threads, err);
    pthread_mutex_lock(&images->lock);
    *(code ? &images->failed : &images->read) += 1;
    if (code) {
        remove_image(images, image);
    } else {
        image->is_ready = 1;
        image->bytes = retex_texture_bytes(image->texture);
        images->bytes += image->bytes;
        make_space(images);
    }
    pthread_cond_broadcast(&images->ready);
    pthread_mutex_unlock(&images->lock);
    return code;
}

int images_take(Images *images, const RetexTextureSpec *spec, const RetexSet *set, OpenImage **result,
                RetexTexture **texture, RetexError *err)
{
    FileId id;
    int is_new = 0;
    *result = NULL;
    *texture = NULL;
    if (file_id_of(&id, spec->image) != 0)
        return retex_fail(err, RETEX_ENOTFOUND, "the texture of target %s is gone", spec->target);
    pthread_mutex_lock(&images->lock);
    OpenImage *image = find_or_add(images, spec, &id, &is_new);
    pthread_mutex_unlock(&images->lock);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    int code = is_new ? read_image(images, image, err) : RETEX_OK;
    if (code)
        return code;
    code = retex_textures_place(texture, image->texture, set, spec, err);
    if (code)
        images_return(images, image);
    else
        *result = image;
    return code;
}

void images_return(Images *images, OpenImage *image)
{
    if (!image)
        return;
    pthread_mutex_lock(&images->lock);
    if (--image->users == 0 && image->is_stale)
        remove_image(images, image);
    make_space(images);
    pthread_mutex_unlock(&images->lock);
}

ImagesCount images_count(Images *images)
{
    pthread_mutex_lock(&images->lock);
    const ImagesCount count = {images->count, images->bytes, images->read, images->failed};
    pthread_mutex_unlock(&images->lock);
    return count;
}
