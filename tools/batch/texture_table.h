/* A table of pictures: comma-separated values (RFC 4180), or values between semicolons or tabs, as spreadsheets write
 * them in other countries. The first row names the columns: output, then targets, `light:LAMP`, `finish:TARGET` and
 * `picture:KEY`. Each further row is a picture: its file, then for each target a texture as retex_edit_cell reads it,
 * for each other key a value, or nothing.
 * The whole table is read at once. Mistakes are collected, so that all of them can be reported together. */
#ifndef RETEX_TEXTURE_TABLE_H
#define RETEX_TEXTURE_TABLE_H

#include <retex/edit.h>

#include "common/cli.h"

/* Maximum bytes of a table; maximum numbers of mistakes that are kept and that are printed. The others are only
 * counted. */
enum { TABLE_BYTES_MAX = 64 << 20, TABLE_MISTAKES_MAX = 10000, TABLE_MISTAKES_TOLD = 20 };
enum { TABLE_COLUMNS_MAX = RETEX_MAX_TARGETS + 32 };
enum { TABLE_ITSELF = -1 }; /* in place of a row: the mistake concerns the whole table */

/* One picture. */
typedef struct TableRow {
    int line;     /* line in the file where the row begins, from 1 */
    int ncells;   /* the output and the textures; textures at the end may be missing */
    int wrong;    /* it has a mistake */
    size_t first; /* index of the row's first cell in the table's cells */
} TableRow;

typedef struct TableMistake {
    int line; /* in the file */
    int row;  /* or TABLE_ITSELF */
    int order;
    char *message;
} TableMistake;

typedef struct TextureTable {
    const char *name;          /* for messages */
    const RetexAccess *access; /* rules for reading images */
    const Cli *cli;            /* prints warnings about textures */
    RetexEdit *edit;           /* of the cell that is parsed */
    char *text;
    char **cells;
    TableRow *rows;
    size_t ncells;
    int nrows;
    int ncolumns;                           /* number of columns with targets and lamps */
    const char *columns[TABLE_COLUMNS_MAX]; /* names as in the file; the caller may replace those of targets */
    TableMistake *mistakes;                 /* sorted by texture_table_tell */
    size_t mistakes_capacity;
    int nmistakes; /* number of all mistakes */
    int nlisted;   /* number of those in mistakes */
    int wrong;     /* the table itself has a mistake */
} TextureTable;

/* Read the file, or standard input if path is "-". Exit if it cannot be read. An error in a row becomes a mistake. */
void texture_table_open(TextureTable *table, const Cli *cli, const char *path);
void texture_table_close(TextureTable *table);

/* The output of a row, as in the file. */
const char *texture_table_output(const TextureTable *table, int row);
/* The texture of a row for a column's target; RETEX_ENOTFOUND if the cell is empty or a lamp's,
 * RETEX_EPARSE if it is wrong.
 * *image, its name, is valid until the table is closed. */
int texture_table_texture(const TextureTable *table, int row, int column, RetexTextureSpec *spec, const char **image);
/* All textures of a row that are not wrong; returns their number. */
int texture_table_textures(const TextureTable *table, int row, RetexTextureSpec specs[RETEX_MAX_TARGETS]);
/* What a column of keys with a prefix names: of "light" the lamp, of "finish" the target, of "picture" the key; or
 * NULL. */
const char *texture_table_name(const TextureTable *table, int column, const char *prefix);
/* Whether it has textures for a target. */
int texture_table_is_target(const TextureTable *table, int column);
/* Add the lamps and finishes of a row, and what it says of the picture, to an edit. */
int texture_table_lights(const TextureTable *table, int row, RetexEdit *edit, RetexError *err);

/* Add a mistake of a row, or of the table itself, which line 1 stands for. */
void texture_table_mistake(TextureTable *table, int row, const char *fmt, ...) RETEX_PRINTF(3, 4);
/* Whether a mistake concerns the rows first to end - 1: it is one of them, or of the table itself. */
int texture_table_concerns(const TableMistake *mistake, int first, int end);
/* Print the mistakes that concern these rows in the order of the table, one line each. */
void texture_table_tell(TextureTable *table, const Cli *cli, int first, int end);
/* The first mistake of a row, after texture_table_tell. */
const char *texture_table_why(const TextureTable *table, int row);

#endif
