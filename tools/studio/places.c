/* See places.h. */
#include "places.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/beneath.h"
#include "received.h"

#define PROJECT_END ".studio.json"

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory");
}

/* What servers that were killed have left of files that were sent. */
static void tidy(int folder)
{
    if (folder < 0)
        return;
    received_tidy(folder);
    close(folder);
}

int places_open(Places *places, Changes *changes, RetexError *err)
{
    *places = (Places){.changes = changes};
    const char *home = getenv("HOME");
    places->home = home && *home ? realpath(home, NULL) : NULL;
    if (places->home && strcmp(places->home, "/") == 0) {
        free(places->home);
        places->home = NULL;
    }
    char *current = places->home ? NULL : realpath(".", NULL);
    const char *base = places->home ? places->home : current ? current : ".";
    const int failed = asprintf(&places->dropped, "%s/retex-studio", base) < 0;
    free(current);
    if (failed)
        return no_memory(err);
    tidy(open(places->dropped, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    return RETEX_OK;
}

static void free_model(Model *model)
{
    free(model->path);
    free(model->name);
    free(model->folder);
    free(model->written);
    free(model->project);
    if (model->top >= 0)
        close(model->top);
    free(model);
}

void places_close(Places *places)
{
    for (Model *model = places->model, *older; model; model = older) {
        older = model->older;
        free_model(model);
    }
    for (int i = 0; i < places->ntextures; i++)
        free(places->textures[i]);
    free(places->home);
    free(places->dropped);
}

const Model *places_model(Places *places)
{
    changes_lock(places->changes);
    const Model *model = places->model;
    changes_unlock(places->changes);
    return model;
}

/* ---- folders that are the user's ---- */

/* Which folders the user's studio has made, or was told to go on with, stands in a list in the user's own folder of
 * data, where no archive of a stranger reaches. A folder is known by its path, its number and when it was made, so one
 * of the same name that comes later is another. Where the list cannot be read or written, none is known. */

/* The list's path, by the rule for data of programs. 0: there is none. */
static int find_list(char list[PATH_MAX])
{
    const char *data = getenv("XDG_DATA_HOME"), *home = getenv("HOME");
    const int has_data = data && *data == '/';
    if (!has_data && (!home || *home != '/'))
        return 0;
    return snprintf(list, PATH_MAX, "%s%s/retex/studio-folders", has_data ? data : home,
                    has_data ? "" : "/.local/share") < PATH_MAX;
}

/* The folder's line of the list, which the caller frees; NULL: it can have none. */
static char *line_of(int folder, const char *path)
{
    struct statx info;
    char *line;
    if (strchr(path, '\n') || statx(folder, "", AT_EMPTY_PATH, STATX_INO | STATX_BTIME, &info) != 0)
        return NULL;
    if (!(info.stx_mask & STATX_BTIME))
        info.stx_btime = (struct statx_timestamp){0};
    return asprintf(&line, "%llx %llx.%x %s\n", (unsigned long long)info.stx_ino,
                    (unsigned long long)info.stx_btime.tv_sec, info.stx_btime.tv_nsec, path) < 0
               ? NULL
               : line;
}

static int is_known_folder(int folder, const char *path)
{
    char list[PATH_MAX], *line = NULL, *wanted = line_of(folder, path);
    size_t space = 0;
    int has = 0;
    FILE *file = wanted && find_list(list) ? fopen(list, "re") : NULL;
    while (file && !has && getline(&line, &space, file) > 0)
        has = strcmp(line, wanted) == 0;
    if (file)
        fclose(file);
    free(line);
    free(wanted);
    return has;
}

static void know_folder(int folder, const char *path)
{
    char list[PATH_MAX], *line = line_of(folder, path);
    if (!line || !find_list(list)) {
        free(line);
        return;
    }
    for (char *slash = strchr(list + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        *slash = 0;
        (void)mkdir(list, 0700);
        *slash = '/';
    }
    const int file = open(list, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
    if (file >= 0) {
        (void)!write(file, line, strlen(line)); /* in one piece: others may add at the same time */
        close(file);
    }
    free(line);
}

/* ---- opening ---- */

/* Cut `.studio.json` off the path of a project: what is left is its model, beside it. */
static int cut_project_end(char *path)
{
    const size_t length = strlen(path), end = strlen(PROJECT_END);
    const int is_project =
        length > end && strcmp(path + length - end, PROJECT_END) == 0 && path[length - end - 1] != '/';
    if (is_project)
        path[length - end] = 0;
    return is_project;
}

/* The file of a path, by its real name. */
static char *find_file(const char *path, RetexError *err)
{
    struct stat info;
    char *real = realpath(path, NULL);
    if (!real || stat(real, &info) != 0) {
        retex_fail(err, RETEX_ENOTFOUND, "%s: %s", path, strerror(errno));
    } else if (!S_ISREG(info.st_mode)) {
        retex_fail(err, RETEX_EINVAL, "%s: this is no file", path);
    } else if (cut_project_end(real)) {
        char *model = realpath(real, NULL);
        if (!model)
            retex_fail(err, RETEX_ENOTFOUND, "%s: its model %s is not there", path, strrchr(real, '/') + 1);
        free(real);
        return model;
    } else {
        return real;
    }
    free(real);
    return NULL;
}

/* Open the folder that is written to, and see whose it is. */
static int open_written(Model *model, RetexError *err)
{
    struct stat info;
    const int is_new = lstat(model->written, &info) != 0, has_project = lstat(model->project, &info) == 0;
    model->top = beneath_open_top(model->written, 1);
    if (model->top < 0 && errno == ELOOP)
        return retex_fail(err, RETEX_EACCESS,
                          "%s is a link: retex-studio writes into a folder of its own; remove the link",
                          model->written);
    if (model->top < 0 || fstat(model->top, &info) != 0)
        return retex_fail(err, RETEX_EIO, "cannot open the folder %s: %s", model->written, strerror(errno));
    tidy(beneath_open(model->top, PLACES_FILES, O_RDONLY | O_DIRECTORY, 0));
    if (is_new && !has_project)
        know_folder(model->top, model->written);
    else if (info.st_uid != geteuid())
        model->foreign = "its folder is another user's";
    else if (!is_known_folder(model->top, model->written))
        model->foreign = "your retex-studio has not made its folder";
    return RETEX_OK;
}

static Model *new_model(char *path, RetexError *err)
{
    Model *model = calloc(1, sizeof *model);
    const char *slash = strrchr(path, '/') + 1;
    if (!model) {
        free(path);
        no_memory(err);
        return NULL;
    }
    model->path = path;
    model->name = strdup(slash);
    model->folder = strndup(path, slash - path > 1 ? (size_t)(slash - path - 1) : 1);
    model->top = -1;
    if (asprintf(&model->written, "%s.studio", path) < 0)
        model->written = NULL;
    if (asprintf(&model->project, "%s" PROJECT_END, path) < 0)
        model->project = NULL;
    const int has_all = model->name && model->folder && model->written && model->project;
    if (has_all ? open_written(model, err) : no_memory(err)) {
        free_model(model);
        return NULL;
    }
    return model;
}

int places_open_model(Places *places, const char *path, RetexError *err)
{
    const Model *open = places_model(places);
    char absolute[PATH_MAX] = "";
    if (*path != '/' && open)
        snprintf(absolute, sizeof absolute, "%s/%s", open->folder, path);
    char *file = find_file(*absolute ? absolute : path, err);
    Model *model = file ? new_model(file, err) : NULL;
    if (!model)
        return err ? err->code : RETEX_EINVAL;
    changes_lock(places->changes);
    model->older = places->model;
    places->model = model;
    changes_unlock(places->changes);
    return RETEX_OK;
}

int places_trust(Places *places, const char *path, RetexError *err)
{
    changes_lock(places->changes);
    Model *model = places->model;
    const int is_open = model && strcmp(model->path, path) == 0;
    if (is_open)
        model->foreign = NULL;
    changes_unlock(places->changes);
    if (!is_open)
        return retex_fail(err, RETEX_ENOTFOUND, "%s is not open", path);
    know_folder(model->top, model->written);
    return RETEX_OK;
}

int places_check_trust(Places *places, const Model *model, RetexError *err)
{
    changes_lock(places->changes);
    const char *why = model ? model->foreign : NULL;
    changes_unlock(places->changes);
    if (!model)
        return retex_fail(err, RETEX_EINVAL, "no model is open");
    return !why ? RETEX_OK
                : retex_fail(err, RETEX_EACCESS, "%s may come from a stranger, for %s: agree first to go on with it",
                             model->name, why);
}

int places_add_textures(Places *places, const char *path, RetexError *err)
{
    struct stat info;
    char *real = realpath(path, NULL);
    if (!real || stat(real, &info) != 0 || !S_ISDIR(info.st_mode)) {
        free(real);
        return retex_fail(err, RETEX_ENOTFOUND, "there is no folder %s", path);
    }
    int known = 0, code = RETEX_OK;
    changes_lock(places->changes);
    for (int i = 0; i < places->ntextures; i++)
        known |= strcmp(places->textures[i], real) == 0;
    if (!known && places->ntextures == PLACES_TEXTURES)
        code = retex_fail(err, RETEX_ELIMIT, "there can be at most %d folders of textures", PLACES_TEXTURES);
    else if (!known)
        places->textures[places->ntextures++] = real, real = NULL;
    changes_unlock(places->changes);
    free(real);
    return code;
}

/* ---- what may be read ---- */

static void add_root(ReachAccess *access, const char *root)
{
    if (root)
        access->roots[access->access.nroots++] = root;
}

void places_access(Places *places, Reach reach, ReachAccess *access)
{
    access->access = (RetexAccess)RETEX_ACCESS_INIT;
    access->access.safe = 1;
    access->access.roots = access->roots;
    changes_lock(places->changes);
    const Model *model = places->model;
    for (int i = 0; i < places->ntextures; i++)
        add_root(access, places->textures[i]);
    changes_unlock(places->changes);
    if (model && reach != REACH_LISTED)
        add_root(access, model->written);
    if (reach == REACH_LISTED) {
        add_root(access, model ? model->folder : NULL);
        add_root(access, places->home);
        add_root(access, realpath(places->dropped, access->resolved));
    }
}

/* Whether a part of a path is hidden, or leads upwards. */
static int has_hidden_part(const char *path)
{
    for (const char *part = path; part; part = strchr(part, '/'), part = part ? part + 1 : NULL)
        if (*part == '.')
            return 1;
    return 0;
}

int places_resolve(Places *places, const char *path, char absolute[PATH_MAX], RetexError *err)
{
    const Model *model = places_model(places);
    const char *folder = model ? model->folder : places->home ? places->home : places->dropped;
    const int length = *path == '/' ? snprintf(absolute, PATH_MAX, "%s", path)
                       : *path      ? snprintf(absolute, PATH_MAX, "%s/%s", folder, path)
                                    : snprintf(absolute, PATH_MAX, "%s", folder);
    /* only what the request says is looked at: a model may lie in a hidden folder */
    const size_t own = strncmp(path, folder, strlen(folder)) == 0 ? strlen(folder) : 0;
    if (length >= PATH_MAX)
        return retex_fail(err, RETEX_EINVAL, "this path is too long");
    if (has_hidden_part(path + own))
        return retex_fail(err, RETEX_EACCESS, "hidden files and paths that lead upwards are not shown");
    return RETEX_OK;
}
