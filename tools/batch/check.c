/* Checks of a whole table before the first picture: first the images, each once, then the outputs. This takes a few
 * system calls per row. See batch.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/output_file.h>
#include <retex/retex.h>

#include "batch/batch.h"
#include "common/beneath.h"
#include "common/output_folder.h"
#include "common/texture_args.h"

enum { COLORSPACES_MAX = 32 }; /* colour spaces that are checked; further ones are checked when their picture is made */

/* Add a mistake in a row. */
static void note(TextureTable *table, int row, const RetexError *err)
{
    char message[sizeof err->file + sizeof err->message + 32];
    cli_error_text(err, message, sizeof message);
    texture_table_mistake(table, row, "%s", message);
}

/* ---- images ---- */

typedef struct Image {
    const char *name;
    int row, column;
} Image;

static int compare_images(const void *a, const void *b)
{
    const Image *x = a, *y = b;
    int order = strcmp(x->name, y->name);
    return order ? order : x->row != y->row ? x->row - y->row : x->column - y->column;
}

/* All images of the table, sorted by name, then by row and column. */
static Image *list_images(const Batch *batch, size_t *count)
{
    const TextureTable *table = &batch->table;
    Image *images = malloc((size_t)table->nrows * (size_t)table->ncolumns * sizeof *images + 1);
    if (!images)
        cli_die(batch->cli, "not enough memory for the table");
    RetexTextureSpec spec;
    *count = 0;
    for (int row = 0; row < table->nrows; row++)
        for (int column = 0; column < table->ncolumns; column++) {
            Image image = {NULL, row, column};
            if (!texture_table_texture(table, row, column, &spec, &image.name) && !spec.constant && spec.image[0])
                images[(*count)++] = image;
        }
    qsort(images, *count, sizeof *images, compare_images);
    return images;
}

/* Colour spaces that have been checked. */
typedef struct Colorspaces {
    char names[COLORSPACES_MAX][sizeof((RetexTextureSpec *)0)->colorspace];
    int codes[COLORSPACES_MAX];
    RetexError errors[COLORSPACES_MAX];
    int count;
} Colorspaces;

/* Check the image's colour space by loading the image, unless an earlier image had the same. */
static int check_colorspace(Colorspaces *known, const RetexTextureSpec *spec, int nthreads, RetexError *err)
{
    RetexTexture *texture = NULL;
    int k = 0;
    if (!spec->colorspace[0])
        return RETEX_OK;
    while (k < known->count && strcmp(known->names[k], spec->colorspace) != 0)
        k++;
    if (k == COLORSPACES_MAX)
        return RETEX_OK;
    if (k == known->count) {
        strcpy(known->names[known->count++], spec->colorspace);
        RetexTextureSpec plain = RETEX_TEXTURE_SPEC_INIT; /* what the target is, and has, is not known here */
        strcpy(plain.image, spec->image);
        strcpy(plain.colorspace, spec->colorspace);
        plain.constant = spec->constant;
        plain.access = spec->access;
        plain.budget = spec->budget;
        known->codes[k] = retex_texture_load(&texture, &plain, nthreads, &known->errors[k]);
        retex_texture_close(&texture);
    }
    *err = known->errors[k];
    return known->codes[k];
}

/* A name that cannot be read may be a misspelt colour. */
static int check_image(const RetexTextureSpec *spec, const RetexReadParams *params, RetexError *err)
{
    char meant[RETEX_MEANT_SIZE], *file = NULL;
    int code = texture_args_add_input(spec, err);
    if (!code)
        code = retex_texture_file(&file, spec, RETEX_TEXTURE_FILE_IMAGE, err);
    if (code)
        return code;
    code = retex_image_read_check(file, params, err);
    free(file);
    const size_t used = strlen(err->message);
    if (code == RETEX_EIO)
        snprintf(err->message + used, sizeof err->message - used, "%s", retex_color_meant(spec->image, meant));
    return code;
}

/* The files of a texture but its image. */
static int check_others(const RetexTextureSpec *spec, const RetexReadParams *params, RetexError *err)
{
    int code = texture_args_add_input(spec, err);
    for (int number = RETEX_TEXTURE_FILE_IMAGE + 1; number < RETEX_TEXTURE_FILES && !code; number++) {
        char *file = NULL;
        code = retex_texture_file(&file, spec, number, err);
        if (!code && file)
            code = retex_image_read_check(file, params, err);
        free(file);
    }
    return code;
}

/* Maps of finishes, tiles and layers: rows that name one that cannot be read have its mistake. */
static void check_other_images(Batch *batch, const RetexReadParams *params)
{
    TextureTable *table = &batch->table;
    RetexTextureSpec spec, last = RETEX_TEXTURE_SPEC_INIT;
    RetexError err = {0};
    const char *name;
    for (int row = 0; row < table->nrows; row++)
        for (int column = 0; column < table->ncolumns; column++) {
            if (texture_table_texture(table, row, column, &spec, &name) ||
                (!spec.finish[0] && !spec.tiles[0][0] && !spec.nlayers))
                continue;
            if (strcmp(last.finish, spec.finish) != 0 || memcmp(last.tiles, spec.tiles, sizeof last.tiles) != 0 ||
                memcmp(last.layers, spec.layers, sizeof last.layers) != 0) {
                err = (RetexError){0};
                check_others(&spec, params, &err);
                last = spec;
            }
            if (err.code)
                note(table, row, &err);
        }
}

/* Each image is read once; all rows that name it have its mistake. */
static void check_images(Batch *batch)
{
    TextureTable *table = &batch->table;
    size_t count;
    Image *images = list_images(batch, &count);
    Colorspaces *known = calloc(1, sizeof *known);
    if (!known)
        cli_die(batch->cli, "not enough memory for the table");
    RetexTextureSpec spec;
    RetexError unread = {0};
    int unreadable = 0;
    const RetexReadParams read_params = {
        .size = sizeof read_params, .access = table->access, .budget = table->cli->budget, .pixel_bytes = 16};
    for (size_t i = 0; i < count; i++) {
        RetexError err = {0};
        const char *name = images[i].name;
        const int same = i > 0 && strcmp(images[i - 1].name, name) == 0;
        texture_table_texture(table, images[i].row, images[i].column, &spec, &name);
        if (!same)
            unreadable = check_image(&spec, &read_params, &unread);
        if (unreadable && !(same && images[i - 1].row == images[i].row))
            note(table, images[i].row, &unread);
        else if (!unreadable && check_colorspace(known, &spec, batch->cli->threads, &err))
            note(table, images[i].row, &err);
    }
    check_other_images(batch, &read_params);
    free(known);
    free(images);
}

/* ---- outputs ---- */

int batch_path(const Batch *batch, int row, char path[PATH_MAX], RetexError *err)
{
    const char *output = texture_table_output(&batch->table, row);
    const int below = batch->root_path[0] && output[0] != '/';
    if (snprintf(path, PATH_MAX, "%s%s%s", below ? batch->root_path : "", below ? "/" : "", output) >= PATH_MAX)
        return retex_fail(err, RETEX_EIO, "cannot write %s: %s", output, strerror(ENAMETOOLONG));
    return RETEX_OK;
}

int batch_check_root(const Batch *batch, const char *real, const char *output, RetexError *err)
{
    if (batch->root_path[0] && !output_is_below(real, batch->root_path))
        return retex_fail(err, RETEX_EINVAL, "%s is not below %s, as --batch-root requires", output, batch->root);
    return RETEX_OK;
}

/* Check that the missing folders of a path can be created. */
static int check_folder(const Batch *batch, const char *real, int missing, const char *output, RetexError *err)
{
    char folder[PATH_MAX];
    if (!batch->make_folders)
        return retex_fail(err, RETEX_EIO, "the folder of %s is not there; --mkdir makes it", output);
    strcpy(folder, real);
    for (int cut = 0; cut <= missing; cut++)
        *strrchr(folder, '/') = '\0';
    if (access(folder[0] ? folder : "/", W_OK | X_OK) != 0)
        return retex_fail(err, RETEX_EIO, "cannot make the folder of %s: %s", output, strerror(errno));
    return RETEX_OK;
}

/* Check the place of a row's picture: the folder, and that no other file is there. */
static int check_place(const Batch *batch, int row, char path[PATH_MAX], int *missing, RetexError *err)
{
    const char *output = texture_table_output(&batch->table, row);
    char real[PATH_MAX], what[64];
    int code = batch_path(batch, row, path, err);
    if (!code)
        code = output_resolve(real, missing, path, output, err);
    if (!code)
        code = batch_check_root(batch, real, output, err);
    snprintf(what, sizeof what, "the output of the table's line %d", batch->table.rows[row].line);
    if (!code)
        code = cli_add_output(what, path, err);
    return !code && *missing ? check_folder(batch, real, *missing, output, err) : code;
}

static void check_output(Batch *batch, int row, const RetexWriteParams *params)
{
    const char *output = texture_table_output(&batch->table, row);
    char path[PATH_MAX];
    RetexError err = {0};
    int missing = 0;
    if (!*output || strcmp(output, "-") == 0) /* a mistake that is known */
        return;
    const int misplaced = check_place(batch, row, path, &missing, &err);
    if (misplaced)
        note(&batch->table, row, &err);
    if (misplaced || missing ? retex_image_format_check(output, params, &err)
                             : retex_image_write_check(path, params, &err))
        note(&batch->table, row, &err);
}

static void check_textures(Batch *batch, int row)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    const int count = texture_table_textures(&batch->table, row, specs);
    for (int i = 0; i < count; i++) {
        RetexError err = {0};
        if (batch->tool.check(batch->tool.context, &specs[i], &err))
            note(&batch->table, row, &err);
    }
}

/* The outputs of rows with mistakes come last, so that they do not take those of other rows. */
static void check_rows(Batch *batch, const RetexWriteParams *params)
{
    TextureTable *table = &batch->table;
    char *wrong = malloc((size_t)table->nrows + 1);
    if (!wrong)
        cli_die(batch->cli, "not enough memory for the table");
    for (int row = 0; row < table->nrows; row++) {
        if (batch->tool.check)
            check_textures(batch, row);
        wrong[row] = (char)table->rows[row].wrong;
    }
    for (int pass = 0; pass < 2; pass++)
        for (int row = 0; row < table->nrows; row++)
            if (wrong[row] == pass)
                check_output(batch, row, params);
    free(wrong);
}

/* ---- the whole table ---- */

/* Resolve --batch-root; --mkdir also creates it. It may come from a stranger, with what is in it: it is no link. */
static void find_root(Batch *batch)
{
    RetexError err = {0};
    struct stat info;
    const int top = beneath_open_top(batch->root, 0);
    int missing;
    if (top < 0 && errno == ELOOP)
        cli_die(batch->cli, "--batch-root %s is a link; give the folder that it leads to", batch->root);
    if (top >= 0)
        close(top);
    char root[PATH_MAX];
    size_t length = (size_t)snprintf(root, sizeof root, "%s", batch->root);
    while (length > 1 && length < sizeof root && root[length - 1] == '/')
        root[--length] = '\0';
    if (output_resolve(batch->root_path, &missing, root, batch->root, &err))
        cli_die(batch->cli, "--batch-root: %s", err.message);
    if (stat(batch->root_path, &info) == 0 ? !S_ISDIR(info.st_mode) : !batch->make_folders)
        cli_die(batch->cli, "--batch-root %s: no such folder", batch->root);
}

void batch_check(Batch *batch, const RetexWriteParams *params)
{
    RetexError err = {0};
    if (batch->root)
        find_root(batch);
    if (!batch_only_verifies(batch)) {
        check_images(batch);
        check_rows(batch, params);
        cli_writes(batch->cli, "--manifest", batch->journal_path);
    }
    if (batch->dry_run || batch->plan || batch_only_verifies(batch))
        cli_writes(batch->cli, batch->dry_run ? "--dry-run" : batch->plan ? "--plan" : "--verify", "-");
    cli_writes(batch->cli, "--report",
               batch->report); /* last, so that a report that is one of the files above is refused */
    if (batch->report && retex_output_check(batch->report, &err))
        cli_die(batch->cli, "--report: %s", err.message);
    batch_owe_report(batch);
}
