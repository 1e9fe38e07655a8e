/* See folder.h. */
#include "folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/picture_kind.h"
#include "reply.h"

static const struct {
    const char *ending, *kind;
} endings[] = {
    {".studio.json", "project"}, {".glb", "model"},    {".gltf", "model"},   {".obj", "model"},   {".fbx", "model"},
    {".dae", "model"},           {".ply", "model"},    {".stl", "model"},    {".3ds", "model"},   {".blend", "model"},
    {".pov", "scene"},           {".retex", "set"},
};

static int ends_with(const char *name, const char *ending)
{
    const size_t length = strlen(name), end = strlen(ending);
    return length > end && strcasecmp(name + length - end, ending) == 0;
}

/* Whether an EXR is a set: its header has the attribute `retex`, of type string; see retex-set(5). */
static int is_set(int folder, const char *name)
{
    static const char mark[] = "retex\0string";
    char head[16384];
    const int file = openat(folder, name, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
    const ssize_t got = file >= 0 ? read(file, head, sizeof head) : -1;
    if (file >= 0)
        close(file);
    return got > 0 && memmem(head, (size_t)got, mark, sizeof mark) != NULL;
}

static const char *kind_of(int folder, const char *name, int is_folder)
{
    char inside[NAME_MAX + 16];
    snprintf(inside, sizeof inside, "%s/room.json", name);
    if (is_folder)
        return faccessat(folder, inside, F_OK, 0) == 0 ? "page" : "folder";
    if (ends_with(name, ".exr"))
        return is_set(folder, name) ? "set" : "picture";
    for (size_t k = 0; k < sizeof endings / sizeof *endings; k++)
        if (ends_with(name, endings[k].ending))
            return endings[k].kind;
    return picture_kind_of_name(name) ? "picture" : "file";
}

static json_t *describe(int folder, const char *name, const char *shown)
{
    char path[2 * PATH_MAX];
    struct stat info;
    /* where a link leads is looked at when it is opened */
    if (fstatat(folder, name, &info, 0) != 0 || (!S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode)))
        return NULL;
    snprintf(path, sizeof path, "%s%s%s", shown, *shown && shown[strlen(shown) - 1] != '/' ? "/" : "", name);
    return json_pack("{s:o, s:o, s:s, s:I, s:I}", "name", json_of_text(name), "path", json_of_text(path), "kind",
                     kind_of(folder, name, S_ISDIR(info.st_mode)), "bytes", (json_int_t)info.st_size, "mtime",
                     (json_int_t)info.st_mtim.tv_sec);
}

static int not_hidden(const struct dirent *entry)
{
    return entry->d_name[0] != '.';
}

int folder_list(const char *path, const char *shown, const RetexAccess *access, json_t **list, int *is_cut,
                RetexError *err)
{
    struct dirent **names = NULL;
    int folder = -1;
    const int code = retex_access_open_folder(access, path, &folder, err);
    if (code)
        return code;
    const int count = scandirat(folder, ".", &names, not_hidden, versionsort);
    *list = json_array();
    *is_cut = count > FOLDER_ENTRIES;
    for (int i = 0; i < count; i++) {
        json_t *entry = i < FOLDER_ENTRIES ? describe(folder, names[i]->d_name, shown) : NULL;
        if (entry)
            json_array_append_new(*list, entry);
        free(names[i]);
    }
    free(names);
    close(folder);
    return count < 0 ? retex_fail(err, RETEX_EIO, "%s: the folder cannot be read", path) : RETEX_OK;
}
