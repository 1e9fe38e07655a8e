/* See images.h. */
#include "images.h"

#include <stdlib.h>
#include <string.h>

#include "kept.h"
#include "names.h"
#include "request.h"

enum { MOST_OPEN = 4096 }; /* images that nobody uses are closed from this number on */

static const char *const endings[] = {"jpg", "jpeg", "png", "exr", "tif", "tiff", "hdr", "tga", "bmp", "gif", NULL};

struct OpenImage {
    Kept kept;
    RetexTextureSpec spec; /* as the image was read, in its simplest placement */
    RetexTexture *texture;
};

struct Images {
    ImagesParams params;
    KeptList list;
};

/* What of a spec decides on the texels. */
static Kept *create(const void *key, const void *params_of_images)
{
    const RetexTextureSpec *spec = key;
    const ImagesParams *params = params_of_images;
    OpenImage *image = calloc(1, sizeof *image);
    if (!image)
        return NULL;
    image->spec = (RetexTextureSpec)RETEX_TEXTURE_SPEC_INIT;
    strcpy(image->spec.image, spec->image);
    strcpy(image->spec.colorspace, spec->colorspace);
    memcpy(image->spec.wrap, spec->wrap, sizeof spec->wrap);
    image->spec.repeat = spec->repeat;
    image->spec.access = params->access;
    image->spec.budget = params->budget;
    return &image->kept;
}

static int is_of(const Kept *kept, const void *key)
{
    const RetexTextureSpec *a = &((const OpenImage *)(const void *)kept)->spec, *b = key;
    return strcmp(a->image, b->image) == 0 && strcmp(a->colorspace, b->colorspace) == 0 && a->wrap[0] == b->wrap[0] &&
           a->wrap[1] == b->wrap[1] && a->repeat == b->repeat;
}

static void close_image(Kept *kept)
{
    retex_texture_close(&((OpenImage *)(void *)kept)->texture);
}

int images_open(Images **images, const ImagesParams *params, RetexError *err)
{
    *images = NULL;
    int code = params->folder ? names_check_folder(params->folder, err) : RETEX_OK;
    if (code)
        return code;
    if (!(*images = calloc(1, sizeof **images)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for images");
    (*images)->params = *params;
    (*images)->list = (KeptList){.most_bytes = params->memory,
                                 .most = MOST_OPEN,
                                 .is_of = is_of,
                                 .create = create,
                                 .close = close_image,
                                 .params = &(*images)->params};
    kept_begin(&(*images)->list);
    return RETEX_OK;
}

void images_close(Images *images)
{
    if (!images)
        return;
    kept_end(&images->list);
    free(images);
}

static int find_in(const Images *images, const char *folder, const char *name, char *path, size_t size, FileId *id)
{
    for (int i = -1; folder && (i < 0 || endings[i]); i++) {
        const int length = snprintf(path, size, "%s/%s%s%s", folder, name, i < 0 ? "" : ".", i < 0 ? "" : endings[i]);
        if (length > 0 && (size_t)length < size && file_id_of(id, path) == 0)
            return retex_access_check(images->params.access, "", path) == RETEX_ACCESS_ALLOWED ? 0 : -1;
    }
    return -1;
}

int images_find(const Images *images, const char *name, char *path, size_t size, FileId *id)
{
    if (!serve_name_is_valid(name)) /* which has no folder in it, and leads nowhere else */
        return -1;
    return find_in(images, images->params.folder, name, path, size, id)
               ? find_in(images, images->params.uploads, name, path, size, id)
               : 0;
}

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context)
{
    return images->params.folder ? names_list(images->params.folder, endings, 1, tell, context) : 0;
}

/* ---- images in memory ---- */

int images_take(Images *images, const RetexTextureSpec *spec, const RetexSet *set, OpenImage **result,
                RetexTexture **texture, RetexError *err)
{
    FileId id;
    int is_new;
    *result = NULL;
    *texture = NULL;
    if (file_id_of(&id, spec->image) != 0)
        return retex_fail(err, RETEX_ENOTFOUND, "the texture of target %s is gone", spec->target);
    OpenImage *image = (OpenImage *)(void *)kept_take(&images->list, spec, &id, &is_new);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    int code = is_new ? retex_texture_load(&image->texture, &image->spec, images->params.threads, err) : RETEX_OK;
    if (is_new)
        kept_opened(&images->list, &image->kept, code, code ? 0 : retex_texture_bytes(image->texture));
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
    if (image)
        kept_return(&images->list, &image->kept);
}

ImagesCount images_count(Images *images)
{
    KeptList *list = &images->list;
    pthread_mutex_lock(&list->lock);
    const ImagesCount count = {list->count, list->bytes, list->opened, list->failed};
    pthread_mutex_unlock(&list->lock);
    return count;
}
