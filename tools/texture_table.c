/* See texture_table.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "texture_args.h"
#include "texture_table.h"

_Noreturn void texture_table_fail(const TextureTable *table, const Cli *cli, int code, const char *message)
{
    RetexError err = {0};
    retex_fail_at(&err, code, table->name, table->row_line, 0, "%s", message);
    cli_fail(cli, &err);
}

static char *read_text(const Cli *cli, const char *path, size_t *bytes)
{
    cli_input(cli, path, "a table");
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, room = 0, got = 1;
    while (file && got > 0) {
        if (used + 1 >= room) {
            char *more = realloc(text, room = room ? 2 * room : 65536);
            if (!more)
                cli_die(cli, "not enough memory for %s", path);
            text = more;
        }
        got = fread(text + used, 1, room - used - 1, file);
        used += got;
    }
    if (!file || ferror(file))
        cli_die(cli, "%s: cannot read: %s", path, strerror(errno));
    if (file != stdin)
        fclose(file);
    text[used] = '\0';
    if (strlen(text) != used)
        cli_die(cli, "%s: not a table: it holds NUL bytes", path);
    *bytes = used + 1;
    return text;
}

/* Take one cell off the text, in place; quoted ones may hold commas, line ends and doubled quotes. */
static char *next_cell(const Cli *cli, TextureTable *table)
{
    char *cell = table->at, *out = cell;
    if (*table->at != '"') {
        table->at += strcspn(table->at, ",\r\n");
        return cell;
    }
    for (table->at++;; table->at++) {
        if (*table->at == '\0')
            texture_table_fail(table, cli, RETEX_EPARSE, "a quoted cell has no closing quote");
        if (*table->at == '"' && *++table->at != '"')
            break;
        table->line += *table->at == '\n';
        *out++ = *table->at;
    }
    if (*table->at && !strchr(",\r\n", *table->at))
        texture_table_fail(table, cli, RETEX_EPARSE, "something follows a closing quote");
    if (out < table->at)
        *out = '\0';
    return cell;
}

/* The next record that is not an empty line; 0 at the end. */
static int next_row(const Cli *cli, TextureTable *table)
{
    while (*table->at == '\r' || *table->at == '\n')
        table->line += *table->at++ == '\n';
    if (!*table->at)
        return 0;
    table->row_line = table->line;
    table->ncells = 0;
    for (;;) {
        if (table->ncells == 1 + RETEX_MAX_TARGETS)
            texture_table_fail(table, cli, RETEX_EPARSE, "too many cells");
        table->cells[table->ncells++] = next_cell(cli, table);
        char end = *table->at;
        if (end)
            *table->at++ = '\0';
        if (end == ',')
            continue;
        if (end == '\r' && *table->at == '\n')
            table->at++;
        table->line += end != '\0';
        return 1;
    }
}

/* A cell: IMAGE, rgb(r,g,b), or `:opts IMAGE`. */
static void parse_cell(const Cli *cli, const TextureTable *table, RetexTextureSpec *spec, const char *target,
                       char *cell)
{
    RetexError err = {0};
    const char *opts = "";
    char argument[sizeof spec->target + sizeof spec->image + 2];
    if (*cell == ':') {
        char *space = strchr(cell, ' ');
        if (!space)
            texture_table_fail(table, cli, RETEX_EPARSE, "options without an image; expected `:scale=2 IMAGE`");
        *space = '\0';
        opts = cell + 1;
        cell = space + 1 + strspn(space + 1, " ");
    }
    if (snprintf(argument, sizeof argument, "%s=%s", target, cell) >= (int)sizeof argument)
        texture_table_fail(table, cli, RETEX_EPARSE, "the image's name is too long");
    if (retex_texture_spec_parse(spec, opts, argument, &err))
        texture_table_fail(table, cli, err.code, err.message);
    spec->access = &cli->access;
}

/* To the first picture. */
static void read_columns(TextureTable *table, const Cli *cli)
{
    memcpy(table->text, table->original, table->bytes);
    table->line = table->row_line = 1;
    table->at = table->text + (strncmp(table->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0); /* a byte order mark */
    if (!next_row(cli, table) || strcmp(table->cells[0], "output") != 0) {
        table->row_line = 1;
        texture_table_fail(table, cli, RETEX_EPARSE, "the first row must name the columns: output, then targets");
    }
    table->ncolumns = table->ncells - 1;
    for (int i = 0; i < table->ncolumns; i++)
        table->columns[i] = table->cells[1 + i];
}

void texture_table_open(TextureTable *table, const Cli *cli, const char *path)
{
    *table = (TextureTable){.name = strcmp(path, "-") ? path : "standard input", .line = 1, .row_line = 1};
    table->original = read_text(cli, path, &table->bytes);
    table->text = malloc(table->bytes);
    if (!table->text)
        cli_die(cli, "not enough memory for %s", path);
    read_columns(table, cli);
}

void texture_table_announce(TextureTable *table, const Cli *cli)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    RetexError err = {0};
    const char *output;
    char what[64];
    int count;
    while (texture_table_row(table, cli, &output, specs, &count)) {
        snprintf(what, sizeof what, "the output of the table's line %d", table->row_line);
        int code = cli_add_output(what, output, &err);
        for (int i = 0; i < count && !code; i++)
            code = texture_args_add_input(&specs[i], &err);
        if (code)
            texture_table_fail_picture(table, cli, &err);
    }
    read_columns(table, cli);
}

int texture_table_row(TextureTable *table, const Cli *cli, const char **output,
                      RetexTextureSpec specs[RETEX_MAX_TARGETS], int *nspecs)
{
    if (!next_row(cli, table))
        return 0;
    if (table->ncells > 1 + table->ncolumns)
        texture_table_fail(table, cli, RETEX_EPARSE, "more cells than the first row has");
    if (!*table->cells[0])
        texture_table_fail(table, cli, RETEX_EPARSE, "no output in the first cell");
    if (strcmp(table->cells[0], "-") == 0)
        texture_table_fail(table, cli, RETEX_EPARSE, "a table cannot write to standard output");
    *output = table->cells[0];
    *nspecs = 0;
    for (int i = 1; i < table->ncells; i++)
        if (*table->cells[i])
            parse_cell(cli, table, &specs[(*nspecs)++], table->columns[i - 1], table->cells[i]);
    return 1;
}

void texture_table_fail_picture(const TextureTable *table, const Cli *cli, const RetexError *err)
{
    char message[1600];
    snprintf(message, sizeof message, "%s%s%s", err->file, err->file[0] ? ": " : "", err->message);
    texture_table_fail(table, cli, err->code, message);
}

void texture_table_close(TextureTable *table)
{
    free(table->text);
    free(table->original);
    table->text = table->original = NULL;
}
