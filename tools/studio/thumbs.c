/* See thumbs.h. */
#include "thumbs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/picture.h>

#include "http/hash.h"
#include "http/thumbnail.h"

enum { QUALITY = 85, SECONDS = 20 };

void thumbs_open(Thumbs *thumbs, const RetexBudget *budget)
{
    *thumbs = (Thumbs){.budget = budget};
    pthread_mutex_init(&thumbs->lock, NULL);
    pthread_mutex_init(&thumbs->decoding, NULL);
}

void thumbs_close(Thumbs *thumbs)
{
    for (int i = 0; i < THUMBS_KEPT; i++)
        free(thumbs->kept[i].data);
    pthread_mutex_destroy(&thumbs->lock);
    pthread_mutex_destroy(&thumbs->decoding);
}

/* ---- what is kept ---- */

static int find(Thumbs *thumbs, const char *key, void **data, size_t *bytes)
{
    int found = 0;
    pthread_mutex_lock(&thumbs->lock);
    for (int i = 0; i < THUMBS_KEPT && !found; i++) {
        Thumb *thumb = &thumbs->kept[i];
        if (!thumb->data || strcmp(thumb->key, key) != 0 || !(*data = malloc(thumb->bytes)))
            continue;
        memcpy(*data, thumb->data, thumb->bytes);
        *bytes = thumb->bytes;
        thumb->used = ++thumbs->uses;
        found = 1;
    }
    pthread_mutex_unlock(&thumbs->lock);
    return found;
}

/* A free place, or that of what was used least recently. */
static Thumb *oldest(Thumbs *thumbs)
{
    Thumb *thumb = thumbs->kept;
    for (int i = 1; i < THUMBS_KEPT; i++)
        if (thumbs->kept[i].data && (!thumb->data || thumbs->kept[i].used < thumb->used))
            thumb = &thumbs->kept[i];
    return thumb;
}

static Thumb *free_place(Thumbs *thumbs, size_t bytes)
{
    for (;;) {
        for (int i = 0; i < THUMBS_KEPT && thumbs->bytes + bytes <= THUMBS_BYTES; i++)
            if (!thumbs->kept[i].data)
                return &thumbs->kept[i];
        Thumb *thumb = oldest(thumbs);
        thumbs->bytes -= thumb->bytes;
        free(thumb->data);
        *thumb = (Thumb){0};
    }
}

static void keep(Thumbs *thumbs, const char *key, const void *data, size_t bytes)
{
    void *copy = bytes <= THUMBS_BYTES / 4 ? malloc(bytes) : NULL;
    if (!copy)
        return;
    memcpy(copy, data, bytes);
    pthread_mutex_lock(&thumbs->lock);
    Thumb *thumb = free_place(thumbs, bytes);
    *thumb = (Thumb){.data = copy, .bytes = bytes, .used = ++thumbs->uses};
    snprintf(thumb->key, sizeof thumb->key, "%s", key);
    thumbs->bytes += bytes;
    pthread_mutex_unlock(&thumbs->lock);
}

/* ---- making one ---- */

/* The whole of it, within `size`; never enlarged. */
static RetexCut cut_of(const RetexImage *image, int size)
{
    const int larger = image->width > image->height ? image->width : image->height;
    const double scale = larger > size ? (double)size / larger : 1;
    return (RetexCut){0,
                      0,
                      image->width,
                      image->height,
                      (int)fmax(1, floor(image->width * scale + 0.5)),
                      (int)fmax(1, floor(image->height * scale + 0.5))};
}

static int decode(RetexImage *image, const char *path, const RetexAccess *access, const RetexBudget *of,
                  RetexError *err)
{
    RetexReadParams params = RETEX_READ_INIT;
    RetexBudget *budget = NULL;
    int code = retex_budget_create(&budget, err);
    if (code)
        return code;
    retex_budget_set_memory(budget, retex_budget_memory(of));
    retex_budget_set_pixels(budget, retex_budget_pixels(of));
    retex_budget_set_seconds(budget, SECONDS);
    params.access = access;
    params.budget = budget;
    code = retex_image_read(image, path, &params, 1, err);
    retex_budget_close(&budget);
    return code;
}

static int make(const char *path, const RetexAccess *access, const RetexBudget *budget, int size, void **data,
                size_t *bytes, RetexError *err)
{
    RetexImage image = {0};
    int code = decode(&image, path, access, budget, err);
    if (!code) {
        const RetexCut cut = cut_of(&image, size);
        code = thumbnail_make(&image, &cut, "jpg", QUALITY, 1, data, bytes, err);
    }
    retex_image_free(&image);
    return code;
}

int thumbs_get(Thumbs *thumbs, const char *path, const RetexAccess *access, int size, void **data, size_t *bytes,
               char etag[THUMBS_KEY + 2], RetexError *err)
{
    char key[THUMBS_KEY];
    struct stat info;
    int file = -1, code = retex_access_open(access, path, &file, err);
    if (code)
        return code;
    code = fstat(file, &info) == 0 ? RETEX_OK : retex_fail(err, RETEX_EIO, "%s: it cannot be read", path);
    close(file);
    if (code)
        return code;
    const long long parts[] = {
        (long long)info.st_dev, (long long)info.st_ino, info.st_size,         info.st_mtim.tv_sec,
        info.st_mtim.tv_nsec,   info.st_ctim.tv_sec,    info.st_ctim.tv_nsec, size};
    snprintf(key, sizeof key, "%016llx%016llx", (unsigned long long)hash_bytes(HASH_BEGIN, parts, sizeof parts),
             (unsigned long long)hash_bytes(~HASH_BEGIN, parts, sizeof parts));
    snprintf(etag, THUMBS_KEY + 2, "\"%s\"", key);
    if (find(thumbs, key, data, bytes))
        return RETEX_OK;
    pthread_mutex_lock(&thumbs->decoding);
    code = make(path, access, thumbs->budget, size, data, bytes, err);
    pthread_mutex_unlock(&thumbs->decoding);
    if (!code)
        keep(thumbs, key, *data, *bytes);
    return code;
}
