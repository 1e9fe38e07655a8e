/* Source files: the search for a file, the check that it may be read, and its tokens. Files that the scene has
 * written are read from memory and never touch the disk. Parse_String of strings.inc thus works on a read-only file
 * system. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include "base/digest.h"
#include "sdl/lang/internal.h"

/* Sources with fewer tokens are kept after their #include ends, because a loop may include them again. */
enum { SMALL_SOURCE = 20000 };

static const char *const system_folders[] = {
    "/usr/share/povray-3.7/include", "/usr/local/share/povray-3.7/include", "/usr/share/povray/include",
    "/usr/share/povray-3.7",         "/usr/share/fonts/truetype/povray",
};

static const char *join(Sdl *sdl, const char *folder, const char *name)
{
    size_t a = strlen(folder), b = strlen(name);
    char *path = sdl_alloc(sdl, a + b + 2);
    memcpy(path, folder, a);
    if (a && folder[a - 1] != '/')
        path[a++] = '/';
    memcpy(path + a, name, b + 1);
    return path;
}

static void add_folder(Sdl *sdl, const char **roots, const char *folder)
{
    char resolved[PATH_MAX];
    if (!realpath(*folder ? folder : ".", resolved))
        return;
    sdl->folders[sdl->nfolders] = folder;
    roots[sdl->nfolders++] = arena_string(sdl->arena, resolved, strlen(resolved));
    sdl->access.nroots = sdl->nfolders;
}

void folders_begin(Sdl *sdl, const char *scene_path)
{
    size_t nsystem = sizeof system_folders / sizeof *system_folders;
    size_t count = nsystem + 2 + (size_t)sdl->options.ninclude_paths;
    sdl->folders = sdl_alloc(sdl, count * sizeof *sdl->folders);
    const char **roots = sdl_alloc(sdl, count * sizeof *roots);
    sdl->access = (RetexAccess)RETEX_ACCESS_INIT;
    sdl->access.safe = sdl->options.safe;
    sdl->access.accept_damaged = sdl->options.accept_damaged;
    sdl->access.roots = roots;
    const char *slash = strrchr(scene_path, '/');
    if (!sdl->options.safe || !slash)
        add_folder(sdl, roots, "");
    if (slash)
        add_folder(sdl, roots, arena_string(sdl->arena, scene_path, (size_t)(slash - scene_path + 1)));
    for (int i = 0; i < sdl->options.ninclude_paths; i++)
        add_folder(sdl, roots, sdl->options.include_paths[i]);
    for (size_t i = 0; i < nsystem; i++)
        add_folder(sdl, roots, system_folders[i]);
}

/* Path of a readable file, or NULL. On failure *answer is the most specific reason that a folder gave. */
static const char *find_file(Sdl *sdl, const char *name, RetexAccessResult *answer)
{
    *answer = RETEX_ACCESS_ABSENT;
    if (!*name || strlen(name) >= PATH_MAX / 2)
        return NULL;
    for (int i = 0; i < (*name == '/' ? 1 : sdl->nfolders); i++) {
        const char *folder = *name == '/' ? "" : sdl->folders[i];
        RetexAccessResult found = retex_access_check(&sdl->access, folder, name);
        if (found == RETEX_ACCESS_ALLOWED)
            return join(sdl, folder, name);
        if (*answer == RETEX_ACCESS_ABSENT)
            *answer = found;
    }
    return NULL;
}

const char *sdl_find_file(Sdl *sdl, const char *name)
{
    RetexAccessResult answer;
    return find_file(sdl, name, &answer);
}

const char *sdl_need_file(Sdl *sdl, const char *what, const char *name)
{
    RetexAccessResult answer;
    const char *path = find_file(sdl, name, &answer);
    if (path)
        return path;
    if (answer == RETEX_ACCESS_OUTSIDE && sdl->access.safe)
        sdl_error(sdl,
                  "the %s `%s` is outside the folders that may be read (--safe): the scene's, those of -I, POV-Ray's",
                  what, name);
    if (answer == RETEX_ACCESS_OUTSIDE)
        sdl_error(sdl,
                  "the %s `%s` is outside the folders that may be read: the current one, the scene's, those of -I, "
                  "POV-Ray's; name its folder with -I",
                  what, name);
    if (answer == RETEX_ACCESS_IRREGULAR)
        sdl_error(sdl, "the %s `%s` is no file, but a folder, a device or a pipe", what, name);
    sdl_error(sdl, "cannot find the %s `%s` in the scene's folder or the include path", what, name);
}

MemoryFile *memory_file_find(Sdl *sdl, const char *name)
{
    for (MemoryFile *file = sdl->memory_files; file; file = file->next)
        if (strcmp(file->name, name) == 0)
            return file;
    return NULL;
}

MemoryFile *memory_file_create(Sdl *sdl, const char *name)
{
    MemoryFile *file = memory_file_find(sdl, name);
    if (!file) {
        file = sdl_alloc(sdl, sizeof *file);
        file->name = arena_string(sdl->arena, name, strlen(name));
        file->next = sdl->memory_files;
        sdl->memory_files = file;
    }
    return file;
}

void memory_file_write(Sdl *sdl, MemoryFile *file, const void *bytes, size_t size)
{
    file->bytes = sdl_reserve(sdl, file->bytes, file->size, file->size + size, &file->capacity);
    if (size)
        memcpy(file->bytes + file->size, bytes, size);
    file->size += size;
}

/* Read a whole file into memory of its own, within the scene's memory limit. */
static char *read_all(Sdl *sdl, const char *path, size_t *size)
{
    RetexError why = {0};
    int descriptor, code = retex_access_open(&sdl->access, path, &descriptor, &why);
    if (code)
        sdl_fail(sdl, code, "%s", why.message);
    FILE *file = fdopen(descriptor, "rb");
    if (!file) {
        const int reason = errno;
        close(descriptor);
        sdl_fail(sdl, RETEX_EIO, "cannot read `%s`: %s", path, strerror(reason));
    }
    struct stat info;
    char *bytes = NULL;
    if (fstat(fileno(file), &info) == 0 && !S_ISREG(info.st_mode)) { /* its size would be 0 */
        fclose(file);
        sdl_fail(sdl, RETEX_EIO, "cannot read `%s`: %s", path,
                 S_ISDIR(info.st_mode) ? strerror(EISDIR) : "it is a device or a pipe");
    }
    const uint64_t left = retex_budget_left(sdl->options.budget);
    int too_big = fstat(fileno(file), &info) != 0 || info.st_size < 0 ||
                  (sdl->options.max_memory && (uint64_t)info.st_size > sdl->options.max_memory) ||
                  (uint64_t)info.st_size > left || info.st_size > (off_t)1 << 31;
    if (!too_big)
        bytes = malloc((size_t)info.st_size + 1);
    *size = bytes ? fread(bytes, 1, (size_t)info.st_size, file) : 0;
    int failed = ferror(file) ? errno : 0;
    fclose(file);
    if (bytes && !failed)
        return bytes;
    free(bytes);
    if (too_big)
        sdl_fail(sdl, RETEX_ELIMIT, "`%s` is larger than the memory allowed (--max-memory)", path);
    if (failed)
        sdl_fail(sdl, RETEX_EIO, "cannot read `%s`: %s", path, strerror(failed));
    sdl_fail(sdl, RETEX_ENOMEM, "no memory to read `%s`", path);
}

const char *sdl_read_file(Sdl *sdl, const char *path, size_t *size)
{
    sdl_add_file(sdl, path);
    char *bytes = read_all(sdl, path, size);
    const char *kept = arena_string(sdl->arena, bytes, *size);
    sdl_scene(sdl)->digest = digest_bytes(sdl_scene(sdl)->digest, bytes, *size);
    free(bytes);
    if (!kept)
        sdl_fail_memory(sdl);
    return kept;
}

/* The file's bytes must be freed if the arena has no memory for the tokens. This function catches that error and
 * returns NULL, and the caller reports it. */
static Source *tokenize(Sdl *sdl, const char *path, const char *bytes, size_t size)
{
    jmp_buf outer;
    Source *volatile source = NULL;
    memcpy(&outer, &sdl->jump, sizeof outer);
    if (setjmp(sdl->jump) == 0) {
        char *name = sdl_alloc(sdl, strlen(path) + 1);
        strcpy(name, path);
        source = source_from_text(sdl, name, bytes, size);
    }
    memcpy(&sdl->jump, &outer, sizeof outer);
    return source;
}

static Source *load(Sdl *sdl, const char *path)
{
    size_t size;
    sdl_add_file(sdl, path);
    char *bytes = read_all(sdl, path, &size);
    Scene *scene = sdl_scene(sdl);
    scene->digest = digest_bytes(scene->digest, bytes, size);
    Source *source = tokenize(sdl, path, bytes, size);
    free(bytes);
    if (!source)
        longjmp(sdl->jump, 1);
    source->on_disk = 1;
    return source;
}

Source *source_open_scene(Sdl *sdl, const char *path)
{
    return load(sdl, path);
}

Source *source_open(Sdl *sdl, const char *name)
{
    MemoryFile *memory = memory_file_find(sdl, name);
    if (memory)
        return source_from_text(sdl, memory->name, memory->bytes ? memory->bytes : "", memory->size);
    const char *path = sdl_need_file(sdl, "file", name);
    for (Source *source = sdl->sources; source; source = source->next)
        if (source->on_disk && source->count <= SMALL_SOURCE && strcmp(source->name, path) == 0)
            return source;
    return load(sdl, path);
}

static void source_free(Sdl *sdl, Source *source)
{
    retex_budget_release(sdl->options.budget, source->charged);
    free(source->tokens);
    free(source);
}

void source_release(Sdl *sdl, Source *source)
{
    if (--source->users > 0 || source->keep || (source->on_disk && source->count <= SMALL_SOURCE))
        return;
    if (source->previous)
        source->previous->next = source->next;
    else
        sdl->sources = source->next;
    if (source->next)
        source->next->previous = source->previous;
    source_free(sdl, source);
}

void sources_close(Sdl *sdl)
{
    for (Source *source = sdl->sources, *next; source; source = next) {
        next = source->next;
        source_free(sdl, source);
    }
    sdl->sources = NULL;
}
