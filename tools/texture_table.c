/* See texture_table.h. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "texture_table.h"

/* ---- mistakes ---- */

void texture_table_mistake(TextureTable *table, int line, const char *fmt, ...)
{
    char message[1600];
    va_list args;
    va_start(args, fmt);
    vsnprintf(message, sizeof message, fmt, args);
    va_end(args);
    if (table->nmistakes < TABLE_MISTAKES_MAX)
        table->mistakes[table->nmistakes] = (TableMistake){line, strdup(message)};
    table->nmistakes++;
}

/* By line; those of one line stay as they were found. */
static void sort_mistakes(TableMistake *mistakes, int count)
{
    for (int i = 1; i < count; i++) {
        TableMistake mistake = mistakes[i];
        int k = i;
        for (; k > 0 && mistakes[k - 1].line > mistake.line; k--)
            mistakes[k] = mistakes[k - 1];
        mistakes[k] = mistake;
    }
}

void texture_table_tell(TextureTable *table, const Cli *cli)
{
    RetexError err = {0};
    int told = table->nmistakes < TABLE_MISTAKES_MAX ? table->nmistakes : TABLE_MISTAKES_MAX;
    sort_mistakes(table->mistakes, told);
    for (int i = 0; i < told; i++) {
        const TableMistake *mistake = &table->mistakes[i];
        retex_fail_at(&err, RETEX_EPARSE, table->name, mistake->line, 0, "%s",
                      mistake->message ? mistake->message : "wrong"); /* where memory is short */
        cli_error(cli, &err);
    }
    if (told < table->nmistakes) {
        retex_fail_at(&err, RETEX_EPARSE, table->name, 0, 0, "%d more mistakes", table->nmistakes - told);
        cli_error(cli, &err);
    }
}

/* ---- reading ---- */

static char *read_text(const Cli *cli, const char *path)
{
    cli_input(cli, path, "a table");
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, room = 0, got = 1;
    while (file && got > 0) {
        if (used > TABLE_BYTES_MAX)
            cli_die(cli, "%s: more than the %d MB that a table may have", path, TABLE_BYTES_MAX >> 20);
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
    return text;
}

/* Where the text is being taken apart. */
typedef struct Reader {
    const Cli *cli;
    TextureTable *table;
    char *at;
    int line;          /* of `at` */
    const char *fault; /* of the row that is being read, or NULL */
    size_t rows_room, cells_room;
} Reader;

/* Room for one more element. */
static void *grow(const Cli *cli, void *array, size_t used, size_t *room, size_t size)
{
    if (used < *room)
        return array;
    *room = *room ? 2 * *room : 256;
    array = realloc(array, *room * size);
    if (!array)
        cli_die(cli, "not enough memory for the table");
    return array;
}

/* Take one cell off the text, in place; quoted ones may hold commas, line ends and doubled quotes. */
static char *next_cell(Reader *reader)
{
    char *cell = reader->at, *out = cell;
    if (*reader->at != '"') {
        reader->at += strcspn(reader->at, ",\r\n");
        return cell;
    }
    for (reader->at++;; reader->at++) {
        if (*reader->at == '\0') {
            reader->fault = "a quoted cell has no closing quote";
            return cell;
        }
        if (*reader->at == '"' && *++reader->at != '"')
            break;
        reader->line += *reader->at == '\n';
        *out++ = *reader->at;
    }
    if (*reader->at && !strchr(",\r\n", *reader->at)) {
        reader->fault = "something follows a closing quote";
        reader->at += strcspn(reader->at, "\r\n");
    }
    *out = '\0'; /* before `at`: the opening quote is gone */
    return cell;
}

/* The next record that is not an empty line; 0 at the end. One with a fault is read to its end. */
static int next_row(Reader *reader, TableRow *row)
{
    TextureTable *table = reader->table;
    while (*reader->at == '\r' || *reader->at == '\n')
        reader->line += *reader->at++ == '\n';
    if (!*reader->at)
        return 0;
    *row = (TableRow){.line = reader->line, .first = table->ncells};
    reader->fault = NULL;
    for (;;) {
        char *cell = next_cell(reader), end = *reader->at;
        if (row->ncells == 1 + RETEX_MAX_TARGETS) {
            reader->fault = reader->fault ? reader->fault : "too many cells";
        } else {
            table->cells = grow(reader->cli, table->cells, table->ncells, &reader->cells_room, sizeof *table->cells);
            table->cells[table->ncells++] = cell;
            row->ncells++;
        }
        if (end)
            *reader->at++ = '\0';
        if (end == ',')
            continue;
        if (end == '\r' && *reader->at == '\n')
            reader->at++;
        reader->line += end != '\0';
        return 1;
    }
}

/* Where the image of a cell begins, behind its options; NULL where it has options alone. */
static char *find_image(char *cell)
{
    if (*cell != ':')
        return cell;
    char *space = strchr(cell, ' ');
    return space ? space + strspn(space, " ") : NULL;
}

/* A cell: IMAGE, rgb(r,g,b), or `:opts IMAGE`. */
static int parse_cell(RetexTextureSpec *spec, const char *target, char *cell, RetexError *err)
{
    const char *image = find_image(cell);
    char opts[1024] = "", argument[sizeof spec->target + sizeof spec->image + 2];
    if (!image)
        return retex_fail(err, RETEX_EPARSE, "options without an image; expected `:scale=2 IMAGE`");
    if (image != cell) {
        int length = (int)strcspn(cell + 1, " ");
        if (length >= (int)sizeof opts)
            return retex_fail(err, RETEX_EPARSE, "the options are too long");
        snprintf(opts, sizeof opts, "%.*s", length, cell + 1);
    }
    if (snprintf(argument, sizeof argument, "%s=%s", target, image) >= (int)sizeof argument)
        return retex_fail(err, RETEX_EPARSE, "the image's name is too long");
    return retex_texture_spec_parse(spec, opts, argument, err);
}

/* Notes all that is wrong with a row; 1 where it is a picture. */
static int check_row(TextureTable *table, const TableRow *row)
{
    RetexError err = {0};
    char **cells = table->cells + row->first;
    const int before = table->nmistakes;
    if (row->ncells > 1 + table->ncolumns)
        texture_table_mistake(table, row->line, "more cells than the first row has");
    if (!*cells[0])
        texture_table_mistake(table, row->line, "no output in the first cell");
    if (strcmp(cells[0], "-") == 0)
        texture_table_mistake(table, row->line, "a table cannot write to standard output");
    for (int i = 1; i < row->ncells && i <= table->ncolumns; i++) {
        RetexTextureSpec spec;
        if (*cells[i] && parse_cell(&spec, table->columns[i - 1], cells[i], &err))
            texture_table_mistake(table, row->line, "%s", err.message);
    }
    return table->nmistakes == before;
}

/* The first row; 0 where there is none that names columns. */
static int read_columns(Reader *reader)
{
    TextureTable *table = reader->table;
    TableRow row;
    int there = next_row(reader, &row);
    if (there && reader->fault) {
        texture_table_mistake(table, row.line, "%s", reader->fault);
        return 0;
    }
    if (!there || strcmp(table->cells[0], "output") != 0) {
        texture_table_mistake(table, 1, "the first row must name the columns: output, then targets");
        return 0;
    }
    table->ncolumns = row.ncells - 1;
    for (int i = 0; i < table->ncolumns; i++)
        table->columns[i] = table->cells[1 + i];
    return 1;
}

static void read_rows(Reader *reader)
{
    TextureTable *table = reader->table;
    for (TableRow row; next_row(reader, &row);) {
        if (reader->fault)
            texture_table_mistake(table, row.line, "%s", reader->fault);
        if (reader->fault || !check_row(table, &row)) {
            table->ncells = row.first;
            continue;
        }
        table->rows = grow(reader->cli, table->rows, (size_t)table->nrows, &reader->rows_room, sizeof *table->rows);
        table->rows[table->nrows++] = row;
    }
}

void texture_table_open(TextureTable *table, const Cli *cli, const char *path)
{
    *table = (TextureTable){.name = strcmp(path, "-") ? path : "standard input", .access = &cli->access, .cli = cli};
    table->text = read_text(cli, path);
    Reader reader = {.cli = cli, .table = table, .at = table->text, .line = 1};
    reader.at += strncmp(table->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* a byte order mark */
    if (read_columns(&reader))
        read_rows(&reader);
}

const char *texture_table_output(const TextureTable *table, int row)
{
    return table->cells[table->rows[row].first];
}

int texture_table_texture(const TextureTable *table, int row, int column, RetexTextureSpec *spec, const char **image)
{
    const TableRow *r = &table->rows[row];
    char *cell = column + 1 < r->ncells ? table->cells[r->first + 1 + (size_t)column] : NULL;
    if (!cell || !*cell)
        return RETEX_ENOTFOUND;
    *image = find_image(cell);
    int code = parse_cell(spec, table->columns[column], cell, NULL); /* which was right before */
    spec->access = table->access;
    spec->budget = table->cli->budget;
    spec->warn = cli_warn_text;
    spec->warn_context = (void *)table->cli;
    return code;
}

int texture_table_textures(const TextureTable *table, int row, RetexTextureSpec specs[RETEX_MAX_TARGETS])
{
    const char *image;
    int count = 0;
    for (int i = 0; i < table->ncolumns; i++)
        count += !texture_table_texture(table, row, i, &specs[count], &image);
    return count;
}

void texture_table_close(TextureTable *table)
{
    for (int i = 0; i < TABLE_MISTAKES_MAX; i++)
        free(table->mistakes[i].message);
    free(table->text);
    free(table->cells);
    free(table->rows);
    *table = (TextureTable){0};
}
