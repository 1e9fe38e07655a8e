/* See texture_table.h. */
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/texture_table.h"
#include "common/texture_args.h"

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

/* ---- mistakes ---- */

void texture_table_mistake(TextureTable *table, int row, const char *fmt, ...)
{
    char message[1600];
    va_list args;
    va_start(args, fmt);
    vsnprintf(message, sizeof message, fmt, args);
    va_end(args);
    if (row == TABLE_ITSELF)
        table->wrong = 1;
    else
        table->rows[row].wrong = 1;
    table->nmistakes++;
    if (table->nlisted == TABLE_MISTAKES_MAX)
        return;
    table->mistakes =
        grow(table->cli, table->mistakes, (size_t)table->nlisted, &table->mistakes_capacity, sizeof *table->mistakes);
    table->mistakes[table->nlisted] =
        (TableMistake){row == TABLE_ITSELF ? 1 : table->rows[row].line, row, table->nlisted, strdup(message)};
    table->nlisted++;
}

/* By line; mistakes of one line stay in the order in which they were found. */
static int compare_mistakes(const void *a, const void *b)
{
    const TableMistake *x = a, *y = b;
    return x->line != y->line ? x->line - y->line : x->order - y->order;
}

int texture_table_concerns(const TableMistake *mistake, int first, int end)
{
    return mistake->row == TABLE_ITSELF || (mistake->row >= first && mistake->row < end);
}

void texture_table_tell(TextureTable *table, const Cli *cli, int first, int end)
{
    RetexError err = {0};
    int told = 0, others = table->nmistakes - table->nlisted;
    if (table->nlisted)
        qsort(table->mistakes, (size_t)table->nlisted, sizeof *table->mistakes, compare_mistakes);
    for (int i = 0; i < table->nlisted; i++) {
        const TableMistake *mistake = &table->mistakes[i];
        if (!texture_table_concerns(mistake, first, end))
            continue;
        if (told == TABLE_MISTAKES_TOLD) {
            others++;
            continue;
        }
        retex_fail_at(&err, RETEX_EPARSE, table->name, mistake->line, 0, "%s",
                      mistake->message ? mistake->message : "wrong"); /* no memory for the message */
        cli_error(cli, &err);
        told++;
    }
    if (others) {
        retex_fail_at(&err, RETEX_EPARSE, table->name, 0, 0, "%d more mistake%s", others, others == 1 ? "" : "s");
        cli_error(cli, &err);
    }
}

const char *texture_table_why(const TextureTable *table, int row)
{
    const int line = table->rows[row].line;
    int low = 0, high = table->nlisted;
    while (low < high) { /* the first mistake of this line or a later one */
        const int middle = low + (high - low) / 2;
        if (table->mistakes[middle].line < line)
            low = middle + 1;
        else
            high = middle;
    }
    for (; low < table->nlisted && table->mistakes[low].line == line; low++)
        if (table->mistakes[low].row == row && table->mistakes[low].message)
            return table->mistakes[low].message;
    return "wrong";
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
    if (strncmp(text, "\xff\xfe", 2) == 0 || strncmp(text, "\xfe\xff", 2) == 0)
        cli_die(cli, "%s: the table is UTF-16 text; save it as UTF-8", path);
    if (strncmp(text, "PK\3\4", 4) == 0)
        cli_die(cli, "%s: not a table of text but a spreadsheet's own file; save it as CSV", path);
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
    char ends[4];      /* the characters that end a cell: the separator, CR, LF */
    const char *fault; /* an error in the current row, or NULL */
    size_t rows_capacity, cells_capacity;
} Reader;

/* The separator of cells: what follows the first cell of the first row, `output`, if that is a semicolon or a tab. */
static char find_separator(const char *text)
{
    static const char name[] = "output";
    text += strspn(text, "\r\n");
    const size_t quoted = *text == '"';
    text += quoted;
    if (strncmp(text, name, sizeof name - 1) != 0)
        return ',';
    const char end = text[sizeof name - 1 + (quoted && text[sizeof name - 1] == '"')];
    return end == ';' || end == '\t' ? end : ',';
}

/* Parse one cell in place. Quoted cells may hold separators, line ends and doubled quotes. */
static char *next_cell(Reader *reader)
{
    char *cell = reader->at, *out = cell;
    if (*reader->at != '"') {
        reader->at += strcspn(reader->at, reader->ends);
        return cell;
    }
    for (reader->at++;; reader->at++) {
        if (*reader->at == '\0') {
            reader->fault = "a quoted cell has no closing quote";
            *cell = '\0'; /* it has the rest of the file */
            return cell;
        }
        if (*reader->at == '"' && *++reader->at != '"')
            break;
        reader->line += *reader->at == '\n';
        *out++ = *reader->at;
    }
    if (*reader->at && !strchr(reader->ends, *reader->at)) {
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
        if (row->ncells == 1 + TABLE_COLUMNS_MAX) {
            reader->fault = reader->fault ? reader->fault : "too many cells";
        } else {
            table->cells =
                grow(reader->cli, table->cells, table->ncells, &reader->cells_capacity, sizeof *table->cells);
            table->cells[table->ncells++] = cell;
            row->ncells++;
        }
        if (end)
            *reader->at++ = '\0';
        if (end && end == reader->ends[0])
            continue;
        if (end == '\r' && *reader->at == '\n')
            reader->at++;
        reader->line += end != '\0';
        return 1;
    }
}

const char *texture_table_name(const TextureTable *table, int column, const char *prefix)
{
    const char *key = table->columns[column];
    const size_t length = strlen(prefix);
    return strncmp(key, prefix, length) == 0 && key[length] == ':' ? key + length + 1 : NULL;
}

int texture_table_is_target(const TextureTable *table, int column)
{
    return !retex_edit_key_name(table->columns[column]);
}

/* Parse a cell that is not empty. */
static int parse_cell(const TextureTable *table, RetexTextureSpec *spec, int column, const char *cell, RetexError *err)
{
    const char *name = table->columns[column];
    const int is_target = texture_table_is_target(table, column);
    retex_edit_clear(table->edit);
    const int code =
        is_target ? retex_edit_cell(table->edit, name, cell, err) : retex_edit_set(table->edit, name, cell, err);
    if (!code && is_target)
        *spec = *retex_edit_texture(table->edit, 0);
    return code;
}

/* A folder is the same image with slashes behind its name and without. */
static void cut_slashes(char *cell)
{
    size_t length = strlen(cell);
    while (length > 1 && cell[length - 1] == '/' && cell[length - 2] != ' ')
        cell[--length] = '\0';
}

/* Add all mistakes of a row that was read. */
static void check_row(TextureTable *table, int number)
{
    RetexError err = {0};
    const TableRow *row = &table->rows[number];
    char **cells = table->cells + row->first;
    if (row->ncells > 1 + table->ncolumns)
        texture_table_mistake(table, number, "more cells than the first row has");
    if (!*cells[0])
        texture_table_mistake(table, number, "no output in the first cell");
    if (strcmp(cells[0], "-") == 0)
        texture_table_mistake(table, number, "a table cannot write to standard output");
    for (int i = 1; i < row->ncells && i <= table->ncolumns; i++) {
        RetexTextureSpec spec;
        if (texture_table_is_target(table, i - 1))
            cut_slashes(cells[i]);
        if (*cells[i] && parse_cell(table, &spec, i - 1, cells[i], &err))
            texture_table_mistake(table, number, "%s", err.message);
    }
}

/* Parse the first row; return 0 if it does not name columns. */
static int read_columns(Reader *reader)
{
    TextureTable *table = reader->table;
    TableRow row;
    int there = next_row(reader, &row);
    if (there && reader->fault) {
        texture_table_mistake(table, TABLE_ITSELF, "%s", reader->fault);
        return 0;
    }
    if (!there || strcmp(table->cells[0], "output") != 0) {
        texture_table_mistake(table, TABLE_ITSELF, "the first row must name the columns: output, then targets");
        return 0;
    }
    int targets = 0;
    for (int i = 0; i < row.ncells - 1; i++) {
        table->columns[i] = table->cells[1 + i];
        targets += texture_table_is_target(table, i);
    }
    if (targets > RETEX_MAX_TARGETS) {
        texture_table_mistake(table, TABLE_ITSELF, "too many cells");
        return 0;
    }
    table->ncolumns = row.ncells - 1;
    return 1;
}

static void read_rows(Reader *reader)
{
    TextureTable *table = reader->table;
    for (TableRow row; next_row(reader, &row);) {
        const int number = table->nrows;
        table->rows = grow(reader->cli, table->rows, (size_t)number, &reader->rows_capacity, sizeof *table->rows);
        table->rows[table->nrows++] = row;
        if (!reader->fault) {
            check_row(table, number);
            continue;
        }
        texture_table_mistake(table, number, "%s", reader->fault);
        table->rows[number].ncells = 1; /* where the others end is not known */
        table->ncells = row.first + 1;
    }
}

void texture_table_open(TextureTable *table, const Cli *cli, const char *path)
{
    RetexError err = {0};
    *table = (TextureTable){.name = strcmp(path, "-") ? path : "standard input", .access = &cli->access, .cli = cli};
    if (retex_edit_create(&table->edit, &err))
        cli_fail(cli, &err);
    table->text = read_text(cli, path);
    Reader reader = {.cli = cli, .table = table, .at = table->text, .line = 1};
    reader.at += strncmp(table->text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0; /* a byte order mark */
    snprintf(reader.ends, sizeof reader.ends, "%c\r\n", find_separator(reader.at));
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
    if (!cell || !*cell || !texture_table_is_target(table, column))
        return RETEX_ENOTFOUND;
    const int code = parse_cell(table, spec, column, cell, NULL);
    if (code)
        return code;
    texture_args_read_by(table->cli, spec);
    *image = cell + strlen(cell) - strlen(spec->image); /* it ends the cell */
    return RETEX_OK;
}

int texture_table_textures(const TextureTable *table, int row, RetexTextureSpec specs[RETEX_MAX_TARGETS])
{
    const char *image;
    int count = 0;
    for (int i = 0; i < table->ncolumns; i++)
        count += !texture_table_texture(table, row, i, &specs[count], &image);
    return count;
}

int texture_table_lights(const TextureTable *table, int row, RetexEdit *edit, RetexError *err)
{
    const TableRow *r = &table->rows[row];
    int code = RETEX_OK;
    for (int i = 0; i < table->ncolumns && i + 1 < r->ncells && !code; i++) {
        const char *cell = table->cells[r->first + 1 + (size_t)i];
        if (*cell && !texture_table_is_target(table, i))
            code = retex_edit_set(edit, table->columns[i], cell, err);
    }
    return code;
}

void texture_table_close(TextureTable *table)
{
    for (int i = 0; i < table->nlisted; i++)
        free(table->mistakes[i].message);
    free(table->mistakes);
    free(table->text);
    free(table->cells);
    free(table->rows);
    retex_edit_close(&table->edit);
    *table = (TextureTable){0};
}
