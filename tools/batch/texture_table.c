/* See texture_table.h. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/texture_table.h"

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

/* Sort by line; mistakes of one line stay in the order in which they were found. */
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
                      mistake->message ? mistake->message : "wrong"); /* no memory for the message */
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
    size_t used = 0, capacity = 0, got = 1;
    while (file && got > 0) {
        if (used > TABLE_BYTES_MAX)
            cli_die(cli, "%s: more than the %d MB that a table may have", path, TABLE_BYTES_MAX >> 20);
        if (used + 1 >= capacity) {
            char *more = realloc(text, capacity = capacity ? 2 * capacity : 65536);
            if (!more)
                cli_die(cli, "not enough memory for %s", path);
            text = more;
        }
        got = fread(text + used, 1, capacity - used - 1, file);
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

/* The state of the parser. */
typedef struct Reader {
    const Cli *cli;
    TextureTable *table;
    char *at;
    int line;          /* line number of `at` */
    const char *fault; /* an error in the current row, or NULL */
    size_t rows_capacity, cells_capacity;
} Reader;

/* Grow an array for one more element. */
static void *grow(const Cli *cli, void *array, size_t used, size_t *capacity, size_t size)
{
    if (used < *capacity)
        return array;
    *capacity = *capacity ? 2 * *capacity : 256;
    array = realloc(array, *capacity * size);
    if (!array)
        cli_die(cli, "not enough memory for the table");
    return array;
}

/* Parse one cell in place. Quoted cells may hold commas, line ends and doubled quotes. */
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
    *out = '\0'; /* before `at`, because the opening quote is removed */
    return cell;
}

/* Read the next record that is not empty; return 0 at the end. A record with an error is read to its end. */
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
            table->cells =
                grow(reader->cli, table->cells, table->ncells, &reader->cells_capacity, sizeof *table->cells);
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

/* The image of a cell, after its options; NULL if it has only options. */
static char *find_image(char *cell)
{
    if (*cell != ':')
        return cell;
    char *space = strchr(cell, ' ');
    return space ? space + strspn(space, " ") : NULL;
}

/* Parse a cell: IMAGE, rgb(r,g,b), or `:opts IMAGE`. */
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

/* Add all mistakes of a row; return 1 if it is a valid picture. */
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

/* Parse the first row; return 0 if it does not name columns. */
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
        table->rows = grow(reader->cli, table->rows, (size_t)table->nrows, &reader->rows_capacity, sizeof *table->rows);
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
    int code = parse_cell(spec, table->columns[column], cell, NULL); /* cannot fail: checked when the table was read */
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
