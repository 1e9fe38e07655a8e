/* Presets: see retex/preset.h. */
#include <retex/preset.h>

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <jansson.h>
#include <retex/color_text.h>
#include <retex/output_file.h>

#include "base/json_write.h"
#include "edit/edit.h"
#include "io/input.h"

enum { VERSION = 1 };
static const char VERSION_KEY[] = "retex-preset", EDIT_KEY[] = "edit";

/* ---- names of files ---- */

/* The length of the folder in a path, with the slash at its end. */
static size_t folder_length(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

/* The same of an image that is named with options, `room.retex?Floor=textures/oak.jpg`. */
static size_t image_folder_length(const char *name)
{
    size_t length = 0;
    for (size_t i = 0; name[i] && name[i] != '?'; i++)
        length = name[i] == '/' ? i + 1 : length;
    return length;
}

/* The folder that a path begins with, without symbolic links. Returns 0 where there is none. */
static int real_folder(char real[PATH_MAX], const char *path, size_t length)
{
    char folder[PATH_MAX];
    if (length >= sizeof folder - 1)
        return 0;
    memcpy(folder, path, length);
    strcpy(folder + length, ".");
    return realpath(folder, real) != NULL;
}

/* A name that means something else than a file in an edit gets a folder. */
static const char *as_file(const char *name)
{
    float color[3];
    RetexError err;
    return strchr(name, '/') || (retex_color_parse(color, name, &err) == RETEX_ENOTFOUND && strcmp(name, "none") != 0)
               ? ""
               : "./";
}

/* Between names that are meant from the folder of a preset, and from the current folder. */
typedef struct Move {
    const char *preset; /* its path */
    const char *real;   /* its folder without symbolic links, if names are to be meant from there */
} Move;

static int fail_long(const char *name, RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "the name of a file is too long: %.200s…", name);
}

static int set_name(char *name, size_t size, const char *made, RetexError *err)
{
    const char *before = as_file(made);
    if (strlen(before) + strlen(made) >= size)
        return fail_long(made, err);
    memset(name, 0, size); /* specs are compared byte by byte */
    strcat(strcpy(name, before), made);
    return RETEX_OK;
}

static int name_from_preset(char *name, size_t size, const Move *move, RetexError *err)
{
    char made[PATH_MAX];
    const size_t length = folder_length(move->preset);
    if (!length)
        return RETEX_OK;
    const char *from_there = name + (strncmp(name, "./", 2) == 0 ? 2 : 0);
    if ((size_t)snprintf(made, sizeof made, "%.*s%s", (int)length, move->preset, from_there) >= sizeof made)
        return fail_long(name, err);
    return set_name(name, size, made, err);
}

/* How many bytes a folder and a file have in common, up to a slash, with it: 3 of `/a/b` and `/a/c/oak.jpg`, 5 of
 * `/a/b` and `/a/b/oak.jpg`. */
static size_t common_length(const char *folder, const char *file)
{
    size_t common = 0, at = 0;
    while (folder[at] && folder[at] == file[at])
        common = file[at++] == '/' ? at : common;
    return !folder[at] && file[at] == '/' ? at + 1 : common;
}

/* How many folders a path has: 2 of `b/c`. */
static size_t folder_count(const char *path)
{
    size_t count = *path != '\0';
    for (; *path; path++)
        count += *path == '/';
    return count;
}

/* The way from the preset's folder to the file: `../c/oak.jpg` from `/a/b` to `/a/c/oak.jpg`. */
static int name_for_preset(char *name, size_t size, const Move *move, RetexError *err)
{
    char folder[PATH_MAX], file[PATH_MAX], made[PATH_MAX] = "";
    const size_t length = image_folder_length(name);
    if (!real_folder(folder, name, length)) /* it is not there, or is to have a frame's number */
        return RETEX_OK;
    if ((size_t)snprintf(file, sizeof file, "%s%s%s", folder, folder[1] ? "/" : "", name + length) >= sizeof file)
        return fail_long(name, err);
    const char *from = move->real[1] ? move->real : ""; /* the root */
    const size_t common = common_length(from, file);
    const size_t up = folder_count(common <= strlen(from) ? from + common : "");
    if (3 * up + strlen(file + common) >= sizeof made)
        return fail_long(name, err);
    for (size_t k = 0; k < up; k++)
        strcat(made, "../");
    strcat(made, file + common);
    return set_name(name, size, made, err);
}

/* Whether a file is in the folder of the preset, or below it. */
static int is_with_preset(const char *name, const Move *move)
{
    char folder[PATH_MAX];
    const size_t length = move->real ? strlen(move->real) : 0;
    return length > 1 && real_folder(folder, name, image_folder_length(name)) &&
           strncmp(folder, move->real, length) == 0 && (!folder[length] || folder[length] == '/');
}

/* An absolute name stays one, unless the file moves with the preset: a page, where it is served from, has no other. */
static int move_name(char *name, size_t size, const Move *move, RetexError *err)
{
    if (!name[0] || (name[0] == '/' && !is_with_preset(name, move)))
        return RETEX_OK;
    return move->real ? name_for_preset(name, size, move, err) : name_from_preset(name, size, move, err);
}

static int move_names(RetexEdit *edit, const Move *move, RetexError *err)
{
    int code = RETEX_OK;
    for (int i = 0; i < edit->count && !code; i++) {
        RetexTextureSpec *spec = &edit->specs[i];
        if (!spec->constant)
            code = move_name(spec->image, sizeof spec->image, move, err);
        if (!code && strcmp(spec->finish, "none") != 0)
            code = move_name(spec->finish, sizeof spec->finish, move, err);
        for (int k = 0; k < RETEX_TILES_MAX && !code; k++)
            code = move_name(spec->tiles[k], sizeof spec->tiles[k], move, err);
        for (int k = 0; k < spec->nlayers && !code; k++)
            code = move_name(spec->layers[k].image, sizeof spec->layers[k].image, move, err);
    }
    return code;
}

/* ---- reading ---- */

static int no_preset(RetexError *err, const char *name, const char *why)
{
    return retex_fail(err, RETEX_EFORMAT, "%s is not a preset: %s", name, why);
}

/* The text of the edit of a preset that was parsed; borrowed. */
static int find_text(const char **text, const json_t *root, const char *name, RetexError *err)
{
    const json_t *version = json_object_get(root, VERSION_KEY), *edit = json_object_get(root, EDIT_KEY);
    if (!json_is_object(root) || !json_is_integer(version))
        return no_preset(err, name, "it has no number \"retex-preset\"");
    if (json_integer_value(version) != VERSION)
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s is a preset of version %lld; this program reads version %d",
                          name, (long long)json_integer_value(version), VERSION);
    if (!json_is_string(edit))
        return no_preset(err, name, "it has no text \"edit\"");
    *text = json_string_value(edit);
    return RETEX_OK;
}

static int add_text(RetexEdit *edit, const char *text, const char *name, RetexError *err)
{
    RetexError why = {0};
    const int code = retex_edit_parse(edit, text, &why);
    return code ? retex_fail(err, code, "%s: %s", name, why.message) : RETEX_OK;
}

int retex_preset_parse(RetexEdit *edit, const void *data, size_t bytes, const char *name, RetexError *err)
{
    json_error_t where;
    const char *text = NULL;
    if (bytes > RETEX_PRESET_BYTES_MAX)
        return no_preset(err, name, "it has more than 1 MB");
    json_t *root = json_loadb(data, bytes, JSON_REJECT_DUPLICATES, &where);
    if (!root && !where.text[0]) /* jansson says nothing then */
        return retex_fail(err, RETEX_ENOMEM, "no memory to read %s", name);
    if (!root)
        return retex_fail_at(err, RETEX_EFORMAT, name, where.line, where.column, "not a preset, which is JSON");
    int code = find_text(&text, root, name, err);
    if (!code)
        code = add_text(edit, text, name, err);
    json_decref(root);
    return code;
}

/* Add the statements of one edit to another; what both name is a mistake. */
static int add_edit(RetexEdit *edit, const RetexEdit *more, const char *name, RetexError *err)
{
    char *text = NULL;
    int code = retex_edit_text(more, ';', &text, err);
    if (!code)
        code = add_text(edit, text, name, err);
    free(text);
    return code;
}

int retex_preset_read(RetexEdit *edit, const char *path, RetexError *err)
{
    const Move move = {.preset = path};
    RetexInput *input = NULL;
    RetexEdit *read = NULL;
    const void *data = NULL;
    size_t bytes = 0;
    int code = retex_edit_create(&read, err);
    if (!code)
        code = retex_input_open(&input, path, err);
    if (!code && retex_input_size(input) > RETEX_PRESET_BYTES_MAX)
        code = no_preset(err, retex_input_name(input), "it has more than 1 MB");
    if (!code)
        code = retex_input_load(input, &data, &bytes, err);
    if (!code)
        code = retex_preset_parse(read, data, bytes, retex_input_name(input), err);
    if (!code && strcmp(path, "-") != 0)
        code = move_names(read, &move, err);
    if (!code)
        code = add_edit(edit, read, retex_input_name(input), err);
    retex_input_close(&input);
    retex_edit_close(&read);
    return code;
}

/* ---- writing ---- */

/* The text of an edit with names for a preset, from which it can be parsed again. */
static int make_text(char **text, const RetexEdit *edit, const char *path, RetexError *err)
{
    char real[PATH_MAX];
    const Move move = {path, real};
    RetexEdit *own = malloc(sizeof *own), *same = NULL;
    char *again = NULL;
    int code = own ? retex_edit_create(&same, err) : retex_fail(err, RETEX_ENOMEM, "not enough memory for a preset");
    if (!code && !real_folder(real, path, folder_length(path)))
        code = retex_fail(err, RETEX_EIO, "cannot write %s: %s", path, strerror(errno));
    if (!code) {
        *own = *edit;
        code = move_names(own, &move, err);
    }
    if (!code)
        code = retex_edit_text(own, ';', text, err);
    if (!code)
        code = retex_edit_parse(same, *text, err);
    if (!code)
        code = retex_edit_text(same, ';', &again, err);
    if (!code && strcmp(*text, again) != 0)
        code = retex_fail(err, RETEX_EINVAL, "a name of a file cannot be written to %s: %.400s", path, *text);
    free(again);
    free(own);
    retex_edit_close(&same);
    return code;
}

int retex_preset_write(const RetexEdit *edit, const char *path, RetexError *err)
{
    char *text = NULL, *file = NULL, *line = NULL;
    int code = make_text(&text, edit, path, err);
    if (!code) {
        json_t *root = json_pack("{s:i, s:s}", VERSION_KEY, (int)VERSION, EDIT_KEY, text);
        file = retex_json_text(root, JSON_INDENT(2) | JSON_PRESERVE_ORDER);
        line = file ? realloc(file, strlen(file) + 2) : NULL;
        if (line)
            strcat(line, "\n");
        else
            code = retex_fail(err, RETEX_EINVAL, "%s: the names of a preset must be UTF-8", path);
        json_decref(root);
    }
    if (!code)
        code = retex_file_write(path, line, strlen(line), err);
    free(line ? line : file);
    free(text);
    return code;
}
