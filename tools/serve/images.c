/* See images.h. */
#include "images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "decoding.h"
#include "kept.h"
#include "names.h"
#include "request.h"

enum { MOST_OPEN = 4096 }; /* images that nobody uses are closed from this number on */

static const char *const endings[] = {"jpg", "jpeg", "png", "exr", "tif", "tiff", "hdr", "tga", "bmp", "gif", NULL};

struct OpenImage {
    Kept kept;
    RetexTextureSpec spec; /* as the image was read, in its simplest placement */
    RetexTexture *texture;
    Content content;     /* of its file */
    RetexBudget *shared; /* of all images: the memory of this one is charged to it */
    RetexBudget *budget; /* while it is decoded; the texture keeps it */
    uint64_t charged;
};

struct Images {
    ImagesParams params;
    Contents *contents;
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
    image->shared = params->budget;
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
    OpenImage *image = (OpenImage *)(void *)kept;
    retex_texture_close(&image->texture);
    retex_budget_close(&image->budget);
    retex_budget_release(image->shared, image->charged);
}

int images_open(Images **images, const ImagesParams *params, RetexError *err)
{
    *images = NULL;
    int code = params->folder ? names_check_folder(params->folder, err) : RETEX_OK;
    if (code)
        return code;
    if (!(*images = calloc(1, sizeof **images)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for images");
    code = contents_open(&(*images)->contents, err);
    if (code) {
        free(*images);
        *images = NULL;
        return code;
    }
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
    contents_close(images->contents);
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

/* The base colour of a folder in that of the textures. */
static int find_in_folder(const Images *images, const char *name, char *path, size_t size, FileId *id)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    char *file;
    const char *folder = images->params.folder;
    spec.access = images->params.access;
    if (!folder || (size_t)snprintf(spec.image, sizeof spec.image, "%s/%s", folder, name) >= sizeof spec.image ||
        retex_texture_file(&file, &spec, RETEX_TEXTURE_FILE_IMAGE, NULL))
        return -1;
    const int found = strlen(file) < size && file_id_of(id, file) == 0 &&
                      retex_access_check(images->params.access, "", file) == RETEX_ACCESS_ALLOWED;
    if (found)
        strcpy(path, file);
    free(file);
    return found ? 0 : -1;
}

int images_find(const Images *images, const char *name, char *path, size_t size, FileId *id)
{
    if (!serve_name_is_valid(name)) /* which has no folder in it, and leads nowhere else */
        return -1;
    if (find_in(images, images->params.folder, name, path, size, id) == 0 ||
        find_in(images, images->params.uploads, name, path, size, id) == 0)
        return 0;
    return find_in_folder(images, name, path, size, id);
}

typedef struct FolderList {
    const Images *images;
    void (*tell)(void *context, const char *name);
    void *context;
} FolderList;

static void tell_folder(void *context, const char *name)
{
    const FolderList *list = context;
    char path[PATH_MAX];
    FileId id;
    if (find_in_folder(list->images, name, path, sizeof path, &id) == 0)
        list->tell(list->context, name);
}

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context)
{
    const char *folder = images->params.folder;
    FolderList list = {images, tell, context};
    return folder ? names_list(folder, endings, 1, tell, context) | names_list(folder, NULL, 1, tell_folder, &list) : 0;
}

/* ---- images in memory ---- */

static int is_upload(const Images *images, const char *path)
{
    const char *folder = images->params.uploads;
    const size_t length = folder ? strlen(folder) : 0;
    return length && strncmp(path, folder, length) == 0 && path[length] == '/';
}

int images_is_new_upload(Images *images, const RetexTextureSpec *spec)
{
    FileId id;
    if (spec->constant || !is_upload(images, spec->image) || file_id_of(&id, spec->image) != 0)
        return 0;
    Kept *kept = kept_peek(&images->list, spec, &id);
    kept_return(&images->list, kept);
    return !kept;
}

/* Decode the file that is read for the digest: the name may be another file's by then. */
static int load(const Images *images, OpenImage *image, int threads, RetexError *err)
{
    ContentReading reading = {.contents = images->contents, .file = -1};
    RetexAccess access = *image->spec.access;
    RetexTextureSpec spec = image->spec;
    access.opened = content_read;
    access.context = &reading;
    spec.access = &access;
    int code = retex_texture_load(&image->texture, &spec, threads, err);
    if (!code)
        code = content_end(&reading, err);
    else
        content_end(&reading, NULL);
    image->content = reading.content;
    return code;
}

/* Those of strangers get one thread, and less time. */
static int open_image(const Images *images, OpenImage *image, double deadline, RetexError *err)
{
    const int of_stranger = is_upload(images, image->spec.image);
    int code =
        decoding_budget(&image->budget, image->shared, deadline, of_stranger ? images->params.decoding : INFINITY, err);
    image->spec.budget = image->budget;
    if (!code)
        code = load(images, image, of_stranger ? 1 : images->params.threads, err);
    if (!code) {
        retex_budget_set_seconds(image->budget, 0);
        code = retex_budget_charge(image->shared, retex_texture_bytes(image->texture), "an image", err);
    }
    image->charged = code ? 0 : retex_texture_bytes(image->texture);
    return code;
}

int images_take(Images *images, const RetexTextureSpec *spec, double deadline, OpenImage **result, RetexError *err)
{
    FileId id;
    int is_new;
    *result = NULL;
    if (file_id_of(&id, spec->image) != 0)
        return retex_fail(err, RETEX_ENOTFOUND, "the texture of target %s is gone", spec->target);
    OpenImage *image = (OpenImage *)(void *)kept_take(&images->list, spec, &id, &is_new);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    int code = is_new ? open_image(images, image, deadline, err) : RETEX_OK;
    if (is_new)
        kept_opened(&images->list, &image->kept, code, &image->content, code ? 0 : retex_texture_bytes(image->texture));
    if (!code)
        *result = image;
    return code;
}

const Content *images_content(const OpenImage *image)
{
    return &image->content;
}

int images_find_content(const Images *images, const RetexTextureSpec *spec, Content *content)
{
    FileId id;
    return file_id_of(&id, spec->image) == 0 && contents_find(images->contents, &id, content);
}

int images_place(const OpenImage *image, const RetexSet *set, const RetexTextureSpec *spec, RetexTexture **texture,
                 RetexError *err)
{
    *texture = NULL;
    return retex_textures_place(texture, image->texture, set, spec, err);
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
