/* See images.h. */
#include "serve/files/images.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <retex/image_file.h>

#include "common/picture_kind.h"
#include "serve/files/decoding.h"
#include "serve/files/kept.h"
#include "serve/files/names.h"
#include "serve/request/name.h"

enum { MOST_OPEN = 4096 }; /* images that nobody uses are closed from this number on */

/* What decides on the texels. */
typedef struct ImageKey {
    RetexTextureSpec spec; /* in its simplest placement */
    FileId others[RETEX_TEXTURE_FILES]; /* files but the image, by number; all 0: there is none */
} ImageKey;

struct OpenImage {
    Kept kept;
    ImageKey key;
    RetexTexture *texture; /* NULL for a colour with a map, which each picture reads: it is not in the list */
    Content contents[RETEX_TEXTURE_FILES];
    RetexBudget *shared; /* of all images: the memory of this one is charged to it */
    RetexBudget *budget; /* while it is decoded; the texture keeps it */
    uint64_t charged;
};

struct Images {
    ImagesParams params;
    Contents *contents;
    KeptList list;
};

static const FileId no_file;

int images_has_map(const RetexTextureSpec *spec)
{
    return spec->finish[0] && strcmp(spec->finish, "none") != 0;
}

int images_has_files(const RetexTextureSpec *spec)
{
    return !spec->constant || images_has_map(spec) || spec->nlayers;
}

/* The file of the map that the target may have, if the texture has one. */
static int map_number(const RetexTextureSpec *spec)
{
    return spec->normal_tilt > 0 && !spec->finish[0] ? RETEX_TEXTURE_FILE_NORMAL : RETEX_TEXTURE_FILE_FINISH;
}

static void make_key(ImageKey *key, const RetexTextureSpec *spec, const FileId ids[RETEX_TEXTURE_FILES])
{
    key->spec = *spec;
    memcpy(key->others, ids, sizeof key->others);
    key->others[RETEX_TEXTURE_FILE_IMAGE] = no_file;
    if (!spec->finish[0] && file_id_is_same(&ids[map_number(spec)], &no_file)) { /* finishes do not matter */
        key->spec.nfinishes = 0;
        key->spec.normal_tilt = 0;
        memset(key->spec.roughness, 0, sizeof key->spec.roughness);
    }
    retex_texture_spec_unplace(&key->spec);
}

static Kept *create(const void *key, const void *params_of_images)
{
    const ImagesParams *params = params_of_images;
    OpenImage *image = calloc(1, sizeof *image);
    if (!image)
        return NULL;
    image->key = *(const ImageKey *)key;
    image->shared = params->budget;
    return &image->kept;
}

static int is_of(const Kept *kept, const void *key)
{
    const ImageKey *own = &((const OpenImage *)(const void *)kept)->key, *other = key;
    const RetexTextureSpec *a = &own->spec, *b = &other->spec;
    int are_same = 1;
    for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
        are_same &= file_id_is_same(&own->others[number], &other->others[number]);
    return are_same && retex_texture_specs_alike(a, b) && a->normal_tilt == b->normal_tilt &&
           a->rotate == b->rotate && memcmp(a->scale, b->scale, sizeof a->scale) == 0 &&
           memcmp(a->flip, b->flip, sizeof a->flip) == 0 && a->nfinishes == b->nfinishes &&
           memcmp(a->roughness, b->roughness, sizeof a->roughness) == 0;
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

/* ---- files ---- */

/* The file of a name, which has no folder in it, and leads nowhere else. */
static int find_in(const Images *images, const char *folder, const char *name, char *path, size_t size)
{
    FileId id;
    for (int i = -1; folder && (i < 0 || picture_endings[i]); i++) {
        const int length =
            snprintf(path, size, "%s/%s%s%s", folder, name, i < 0 ? "" : ".", i < 0 ? "" : picture_endings[i]);
        if (length > 0 && (size_t)length < size && file_id_of(&id, path) == 0)
            return retex_access_check(images->params.access, "", path) == RETEX_ACCESS_ALLOWED ? 0 : -1;
    }
    return -1;
}

static int find_file(const Images *images, const char *name, char *path, size_t size)
{
    if (!serve_name_is_valid(name))
        return -1;
    return find_in(images, images->params.folder, name, path, size) == 0
               ? 0
               : find_in(images, images->params.uploads, name, path, size);
}

/* A folder in that of the textures. Whether it is one that is a texture is seen by its files. */
static int find_folder(const Images *images, const char *name, char *path, size_t size)
{
    const char *folder = images->params.folder;
    return folder && serve_name_is_valid(name) && (size_t)snprintf(path, size, "%s/%s", folder, name) < size ? 0 : -1;
}

/* The path of an image: a file, named with or without its ending, or a folder that is a texture. */
static int find_image(const Images *images, const char *name, char *path, size_t size)
{
    return find_file(images, name, path, size) ? find_folder(images, name, path, size) : 0;
}

/* The identities of the files that are there now: 0, or 1 + the number of one that is not. */
static int identify(const Images *images, const RetexTextureSpec *spec, FileId ids[RETEX_TEXTURE_FILES])
{
    RetexTextureSpec own = *spec;
    own.access = images->params.access;
    for (int number = 0; number < RETEX_TEXTURE_FILES; number++) {
        char *file;
        ids[number] = no_file;
        if (retex_texture_file(&file, &own, number, NULL))
            return 1 + number;
        const int is_there = !file || (file_id_of(&ids[number], file) == 0 &&
                                       retex_access_check(own.access, "", file) == RETEX_ACCESS_ALLOWED);
        free(file);
        if (!is_there)
            return 1 + number;
    }
    return 0;
}

int images_find(const Images *images, RetexTextureSpec *spec, FileId ids[RETEX_TEXTURE_FILES])
{
    RetexTextureSpec found = *spec;
    found.image[0] = 0; /* a constant has none, whatever stands there */
    if (!spec->constant && spec->image[0] && find_image(images, spec->image, found.image, sizeof found.image))
        return 1 + RETEX_TEXTURE_FILE_IMAGE;
    if (images_has_map(spec) && find_file(images, spec->finish, found.finish, sizeof found.finish))
        return 1 + RETEX_TEXTURE_FILE_FINISH;
    for (int k = 0; k < RETEX_TILES_MAX && spec->tiles[k][0]; k++)
        if (find_image(images, spec->tiles[k], found.tiles[k], sizeof found.tiles[k]))
            return 1 + RETEX_TEXTURE_FILE_TILES + k;
    for (int k = 0; k < spec->nlayers; k++)
        if (find_image(images, spec->layers[k].image, found.layers[k].image, sizeof found.layers[k].image))
            return 1 + RETEX_TEXTURE_FILE_LAYERS + k;
    const int missing = identify(images, &found, ids);
    if (!missing)
        *spec = found;
    return missing;
}

typedef struct FolderList {
    const Images *images;
    void (*tell)(void *context, const char *name);
    void *context;
} FolderList;

static void tell_folder(void *context, const char *name)
{
    const FolderList *list = context;
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    FileId ids[RETEX_TEXTURE_FILES];
    if (find_folder(list->images, name, spec.image, sizeof spec.image) == 0 &&
        identify(list->images, &spec, ids) == 0)
        list->tell(list->context, name);
}

int images_list(const Images *images, void (*tell)(void *context, const char *name), void *context)
{
    const char *folder = images->params.folder;
    FolderList list = {images, tell, context};
    return folder ? names_list(folder, picture_endings, 1, tell, context) |
                        names_list(folder, NULL, 1, tell_folder, &list)
                  : 0;
}

/* ---- images in memory ---- */

static int is_upload(const Images *images, const char *path)
{
    const char *folder = images->params.uploads;
    const size_t length = folder ? strlen(folder) : 0;
    return length && strncmp(path, folder, length) == 0 && path[length] == '/';
}

static int is_of_stranger(const Images *images, const RetexTextureSpec *spec)
{
    int is_tile = 0;
    for (int k = 0; k < RETEX_TILES_MAX; k++)
        is_tile |= is_upload(images, spec->tiles[k]);
    for (int k = 0; k < spec->nlayers; k++)
        is_tile |= is_upload(images, spec->layers[k].image);
    return is_tile || (!spec->constant && is_upload(images, spec->image)) ||
           (images_has_map(spec) && is_upload(images, spec->finish));
}

int images_is_upload(const Images *images, const RetexTextureSpec *spec)
{
    return is_upload(images, spec->image);
}

int images_is_new_upload(Images *images, const RetexTextureSpec *spec)
{
    FileId ids[RETEX_TEXTURE_FILES];
    ImageKey key;
    if (!is_of_stranger(images, spec) || identify(images, spec, ids))
        return 0;
    if (images_has_map(spec)) /* which is read for each set of finishes, and for each picture of a colour */
        return 1;
    make_key(&key, spec, ids);
    Kept *kept = kept_peek(&images->list, &key, &ids[RETEX_TEXTURE_FILE_IMAGE]);
    kept_return(&images->list, kept);
    return !kept;
}

/* Whether a file that is there is read: the roughness of a folder only if it can choose a finish, its normal map
 * only where the target takes one, both only without tiles and layers, which have none. */
static int is_read(const RetexTextureSpec *spec, int number, const FileId *id)
{
    int count = 0;
    for (int k = 0; k < spec->nfinishes; k++)
        count += spec->roughness[k] >= 0;
    if (file_id_is_same(id, &no_file))
        return 0;
    if (number == RETEX_TEXTURE_FILE_IMAGE || number >= RETEX_TEXTURE_FILE_TILES)
        return 1;
    return number == map_number(spec) &&
           (images_has_map(spec) ||
            (!spec->tiles[0][0] && !spec->nlayers && (count > 1 || number == RETEX_TEXTURE_FILE_NORMAL)));
}

/* A file that is not read: no change of it matters. */
static Content content_unread(const FileId *id)
{
    return (Content){.id = *id, .is_settled = 1};
}

/* Which of the files that were read a file is. One that was replaced before it was read is the next one. */
static int find_read(const ContentReading *reading, const FileId *id, int *next)
{
    for (int i = 0; i < reading->count; i++)
        if (file_id_is_same(&reading->read[i].id, id))
            return i;
    return *next < reading->count ? (*next)++ : reading->count - 1;
}

/* A call that loads a texture with an access that tells which files it reads: the names may be those of others by then.
 * set: of a colour, which needs it. */
static int load(const Images *images, OpenImage *image, const RetexSet *set, RetexTextureSpec *spec, int threads,
                RetexTexture **texture, RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexAccess access = *images->params.access;
    ContentReading reading = {.contents = images->contents};
    for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
        reading.most += is_read(spec, number, &image->contents[number].id);
    access.opened = content_read;
    access.context = &reading;
    spec->access = &access;
    spec->budget = image->budget;
    int code = set ? retex_textures_load(textures, set, spec, 1, threads, err)
                   : retex_texture_load(texture, spec, threads, err);
    if (code && set)
        retex_textures_close(textures);
    else if (set)
        *texture = textures[retex_set_find_target(set, spec->target)];
    if (!code)
        code = content_end(&reading, err);
    else
        content_end(&reading, NULL);
    for (int number = 0, next = 0; number < RETEX_TEXTURE_FILES && !code; number++)
        if (is_read(spec, number, &image->contents[number].id))
            image->contents[number] = reading.read[find_read(&reading, &image->contents[number].id, &next)];
    return code;
}

/* Those of strangers get one thread, and less time. */
static int open_texture(const Images *images, OpenImage *image, const RetexSet *set, RetexTextureSpec *spec,
                        RetexTexture **texture, RetexError *err)
{
    int code = load(images, image, set, spec, is_of_stranger(images, spec) ? 1 : images->params.threads, texture, err);
    if (code)
        return code;
    retex_budget_set_seconds(image->budget, 0);
    code = retex_budget_charge(image->shared, retex_texture_bytes(*texture), "an image", err);
    image->charged = code ? 0 : retex_texture_bytes(*texture);
    return code;
}

static int give_budget(const Images *images, OpenImage *image, const RetexTextureSpec *spec, double deadline,
                       RetexError *err)
{
    return decoding_budget(&image->budget, image->shared, deadline,
                           is_of_stranger(images, spec) ? images->params.decoding : INFINITY, err);
}

static int open_image(const Images *images, OpenImage *image, double deadline, RetexError *err)
{
    RetexTextureSpec spec = image->key.spec;
    const int code = give_budget(images, image, &spec, deadline, err);
    return code ? code : open_texture(images, image, NULL, &spec, &image->texture, err);
}

/* What images_place reads. */
static int take_color(const Images *images, const ImageKey *key, const RetexTextureSpec *spec, double deadline,
                      OpenImage **result, RetexError *err)
{
    OpenImage *image = (OpenImage *)(void *)create(key, &images->params);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    for (int number = 0; number < RETEX_TEXTURE_FILES; number++)
        image->contents[number] = content_unread(&key->others[number]);
    const int code = give_budget(images, image, spec, deadline, err);
    if (!code)
        *result = image;
    else
        free(image);
    return code;
}

/* What nobody else may get is not of the key: a file that was replaced, or one that changes just now. */
static Content content_of(const OpenImage *image)
{
    Content content = image->contents[RETEX_TEXTURE_FILE_IMAGE];
    for (int number = RETEX_TEXTURE_FILE_IMAGE + 1; number < RETEX_TEXTURE_FILES; number++)
        content.is_settled &= image->contents[number].is_settled &&
                              file_id_is_same(&image->contents[number].id, &image->key.others[number]);
    return content;
}

int images_take(Images *images, const RetexTextureSpec *spec, double deadline, OpenImage **result, RetexError *err)
{
    FileId ids[RETEX_TEXTURE_FILES];
    ImageKey key;
    int is_new;
    *result = NULL;
    if (identify(images, spec, ids))
        return retex_fail(err, RETEX_ENOTFOUND, "the texture of target %s is gone", spec->target);
    make_key(&key, spec, ids);
    if (spec->constant)
        return take_color(images, &key, spec, deadline, result, err);
    OpenImage *image = (OpenImage *)(void *)kept_take(&images->list, &key, &ids[RETEX_TEXTURE_FILE_IMAGE], &is_new);
    if (!image)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory for a texture");
    for (int number = 0; number < RETEX_TEXTURE_FILES && is_new; number++)
        image->contents[number] = content_unread(&ids[number]);
    int code = is_new ? open_image(images, image, deadline, err) : RETEX_OK;
    if (is_new) {
        const Content content = content_of(image);
        kept_opened(&images->list, &image->kept, code, &content, code ? 0 : retex_texture_bytes(image->texture));
    }
    if (!code)
        *result = image;
    return code;
}

const Content *images_contents(const OpenImage *image)
{
    return image->contents;
}

int images_find_contents(const Images *images, const RetexTextureSpec *spec, Content contents[RETEX_TEXTURE_FILES])
{
    FileId ids[RETEX_TEXTURE_FILES];
    if (identify(images, spec, ids))
        return 0;
    for (int number = 0; number < RETEX_TEXTURE_FILES; number++) {
        contents[number] = content_unread(&ids[number]);
        if (is_read(spec, number, &ids[number]) && !contents_find(images->contents, &ids[number], &contents[number]))
            return 0;
    }
    return 1;
}

int images_read(const Images *images, const RetexTextureSpec *spec, double deadline, RetexImage *image,
                Content *content, RetexError *err)
{
    const int is_strange = is_of_stranger(images, spec);
    RetexAccess access = *images->params.access;
    ContentReading reading = {.contents = images->contents, .most = 1};
    RetexReadParams params = RETEX_READ_INIT;
    RetexBudget *budget = NULL;
    RetexTextureSpec own = *spec;
    char *file = NULL;
    access.opened = content_read;
    access.context = &reading;
    own.access = images->params.access;
    params.access = &access;
    int code = retex_texture_file(&file, &own, RETEX_TEXTURE_FILE_IMAGE, err);
    if (!code)
        code = decoding_budget(&budget, images->params.budget, deadline,
                               is_strange ? images->params.decoding : INFINITY, err);
    params.budget = budget;
    if (!code)
        code = retex_image_read(image, file, &params, is_strange ? 1 : images->params.threads, err);
    const int changed = reading.count ? content_end(&reading, code ? NULL : err) : 0;
    if (!code && changed)
        retex_image_free(image);
    *content = reading.read[0];
    retex_budget_close(&budget);
    free(file);
    return code ? code : changed;
}

int images_place(const Images *images, OpenImage *image, const RetexSet *set, const RetexTextureSpec *spec,
                 RetexTexture **texture, RetexError *err)
{
    RetexTextureSpec own = *spec;
    *texture = NULL;
    return spec->constant ? open_texture(images, image, set, &own, texture, err)
                          : retex_textures_place(texture, image->texture, set, spec, err);
}

void images_return(Images *images, OpenImage *image)
{
    if (image && image->texture) {
        kept_return(&images->list, &image->kept);
    } else if (image) {
        close_image(&image->kept);
        free(image);
    }
}

ImagesCount images_count(Images *images)
{
    KeptList *list = &images->list;
    pthread_mutex_lock(&list->lock);
    const ImagesCount count = {list->count, list->bytes, list->opened, list->failed};
    pthread_mutex_unlock(&list->lock);
    return count;
}
