/* See places.h. */
#include "places.h"

#include <errno.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PROJECT_END ".studio.json"

static int no_memory(RetexError *err)
{
    return retex_fail(err, RETEX_ENOMEM, "not enough memory");
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
    return failed ? no_memory(err) : RETEX_OK;
}

static void free_model(Model *model)
{
    free(model->path);
    free(model->name);
    free(model->folder);
    free(model->written);
    free(model->project);
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

/* ---- opening ---- */

static int is_project(const char *path)
{
    const size_t length = strlen(path), end = strlen(PROJECT_END);
    return length > end && strcmp(path + length - end, PROJECT_END) == 0;
}

/* The model of a project: its path relative to that of the project. */
static char *model_of_project(const char *project, RetexError *err)
{
    json_error_t fault;
    json_t *root = json_load_file(project, JSON_REJECT_DUPLICATES, &fault);
    const char *model = json_string_value(json_object_get(root, "model"));
    char *path = NULL;
    if (!model)
        retex_fail(err, RETEX_EPARSE, "%s: this is no project: it names no model", project);
    else if (asprintf(&path, "%.*s%s", *model == '/' ? 0 : (int)(strrchr(project, '/') + 1 - project), project, model) <
             0)
        path = NULL, no_memory(err);
    json_decref(root);
    return path;
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
    } else if (is_project(real)) {
        char *named = model_of_project(real, err), *model = named ? realpath(named, NULL) : NULL;
        if (named && !model)
            retex_fail(err, RETEX_ENOTFOUND, "%s: its model %s is not there", path, named);
        free(named);
        free(real);
        return model;
    } else {
        return real;
    }
    free(real);
    return NULL;
}

/* Name project and folder after so many bytes of the model's path. 0: no memory. */
static int name_project(Model *model, size_t length)
{
    free(model->written);
    free(model->project);
    model->written = model->project = NULL;
    if (asprintf(&model->written, "%.*s.studio", (int)length, model->path) < 0)
        model->written = NULL;
    if (asprintf(&model->project, "%.*s" PROJECT_END, (int)length, model->path) < 0)
        model->project = NULL;
    return model->written && model->project;
}

static int is_file(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0 && S_ISREG(info.st_mode);
}

/* Whether the project that the model has by its name is there, and is of this model. */
static int has_project(const Model *model)
{
    char *named = is_file(model->project) ? model_of_project(model->project, NULL) : NULL;
    char *real = named ? realpath(named, NULL) : NULL;
    const int is_own = real && strcmp(real, model->path) == 0;
    free(named);
    free(real);
    return is_own;
}

/* `room.glb.studio.json`; but `room.studio.json`, as it was called once, where that alone is there, and of this
 * model. */
static int find_project(Model *model)
{
    const size_t whole = strlen(model->path), stem = whole - strlen(model->name);
    const char *dot = strrchr(model->name, '.');
    if (!name_project(model, whole))
        return 0;
    if (!dot || dot == model->name || access(model->project, F_OK) == 0)
        return 1;
    return name_project(model, stem + (size_t)(dot - model->name)) &&
           (has_project(model) || name_project(model, whole));
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
    if (!model->name || !model->folder || !find_project(model)) {
        free_model(model);
        no_memory(err);
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
        add_root(access, realpath(model->written, access->resolved[0]));
    if (reach == REACH_LISTED) {
        add_root(access, model ? model->folder : NULL);
        add_root(access, places->home);
        add_root(access, realpath(places->dropped, access->resolved[1]));
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

int places_make_written(const Model *model, RetexError *err)
{
    if (!model)
        return retex_fail(err, RETEX_EINVAL, "no model is open");
    if (mkdir(model->written, 0777) != 0 && errno != EEXIST)
        return retex_fail(err, RETEX_EIO, "cannot make the folder %s: %s", model->written, strerror(errno));
    return RETEX_OK;
}
