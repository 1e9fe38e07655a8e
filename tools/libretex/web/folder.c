/* See folder.h. */
#include "web/folder.h"

#include <jansson.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <retex/output_file.h>

#include "io/checksum.h"

#define MANIFEST "room.json"

typedef struct Folder {
    const char *path;
    RetexWebFile *const *files;
    int count;
} Folder;

void retex_web_file_name(RetexWebFile *file, const char *stem, const char *ending)
{
    file->crc = retex_crc32(CRC32_OF_NONE, file->data, file->bytes);
    snprintf(file->name, sizeof file->name, "%s-%08x.%s", stem, file->crc, ending);
}

static int path_of(char path[PATH_MAX], const char *folder, const char *name)
{
    return snprintf(path, PATH_MAX, "%s/%s", folder, name) < PATH_MAX;
}

static int write_file(const char *folder, RetexWebFile *file, RetexError *err)
{
    char path[PATH_MAX];
    if (!path_of(path, folder, file->name))
        return retex_fail(err, RETEX_EINVAL, "the name of the folder is too long");
    file->is_old = access(path, F_OK) == 0;
    return retex_file_write(path, file->data, file->bytes, err);
}

static void remove_file(const char *folder, const char *name)
{
    char path[PATH_MAX];
    if (path_of(path, folder, name))
        unlink(path);
}

/* The name that an entry of an older manifest has, if it is one of a file that belongs to it. */
static const char *old_name(const json_t *entry)
{
    const char *name = json_string_value(json_object_get(entry, "file"));
    return name && !strchr(name, '/') && strchr(name, '-') ? name : NULL;
}

/* Remove a file that an older manifest names, unless it is one of the new ones. */
static void remove_old(const Folder *folder, const json_t *entry)
{
    const char *name = old_name(entry);
    for (int i = 0; name && i < folder->count; i++)
        if (strcmp(name, folder->files[i]->name) == 0)
            return;
    if (name)
        remove_file(folder->path, name);
}

static void remove_all_old(const Folder *folder, const json_t *old)
{
    static const char *const lists[] = {"lights", "classes"};
    remove_old(folder, json_object_get(old, "picture"));
    remove_old(folder, json_object_get(old, "reduced"));
    remove_old(folder, json_object_get(old, "lamps"));
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < json_array_size(json_object_get(old, lists[k])); i++)
            remove_old(folder, json_array_get(json_object_get(old, lists[k]), i));
}

/* Those of smaller rooms, too. */
static void remove_old_rooms(const Folder *folder, const json_t *old)
{
    const json_t *smaller = json_object_get(old, "smaller");
    char path[PATH_MAX];
    for (size_t i = 0; i < json_array_size(smaller); i++) {
        const json_t *entry = json_array_get(smaller, i);
        const char *name = old_name(entry);
        json_t *room = name && path_of(path, folder->path, name) ? json_load_file(path, 0, NULL) : NULL;
        remove_all_old(folder, room);
        remove_old(folder, entry);
        json_decref(room);
    }
    remove_all_old(folder, old);
}

int retex_web_folder_write(const char *path, RetexWebFile *const *files, int count, RetexWebFile *manifest,
                           RetexError *err)
{
    const Folder folder = {path, files, count};
    char name[PATH_MAX];
    json_t *old = path_of(name, path, MANIFEST) ? json_load_file(name, 0, NULL) : NULL;
    int code = 0, written = 0;
    snprintf(manifest->name, sizeof manifest->name, "%s", MANIFEST);
    for (; written < count && !code; written += !code)
        code = write_file(path, files[written], err);
    if (!code)
        code = write_file(path, manifest, err);
    for (int i = 0; code && i < written; i++)
        if (!files[i]->is_old)
            remove_file(path, files[i]->name);
    if (!code)
        remove_old_rooms(&folder, old);
    json_decref(old);
    return code;
}
