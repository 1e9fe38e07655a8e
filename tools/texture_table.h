/* A table of pictures to make: comma-separated values as RFC 4180 has them. The first row names the columns: output,
 * then targets; each row that follows is a picture: its file, then for each target IMAGE, rgb(r,g,b), `:opts IMAGE`, or
 * nothing. It is read whole; mistakes are collected, so that all of them can be told at once. */
#ifndef RETEX_TEXTURE_TABLE_H
#define RETEX_TEXTURE_TABLE_H

#include <retex/set.h>
#include <retex/texture.h>

#include "cli.h"

/* Bytes of a table, and how many mistakes of it are told; the others are counted. */
enum { TABLE_BYTES_MAX = 64 << 20, TABLE_MISTAKES_MAX = 20 };

/* A row that is a picture. */
typedef struct TableRow {
    int line;     /* where it begins, from 1 */
    int ncells;   /* 1 for the output, and those that follow; those at the end may be missing */
    size_t first; /* of them, in the table's cells */
} TableRow;

typedef struct TableMistake {
    int line; /* 0: none */
    char *message;
} TableMistake;

typedef struct TextureTable {
    const char *name;          /* for messages */
    const RetexAccess *access; /* which images may be read */
    const Cli *cli;            /* who is told what is odd about textures */
    char *text;
    char **cells;
    TableRow *rows;
    size_t ncells;
    int nrows;
    int ncolumns;                           /* of targets */
    const char *columns[RETEX_MAX_TARGETS]; /* as they are written; the caller may put others there */
    TableMistake mistakes[TABLE_MISTAKES_MAX];
    int nmistakes; /* all of them */
} TextureTable;

/* Read the file, or standard input where path is "-". What cannot be read at all ends the program, what is wrong in it
 * becomes a mistake, and the row is left out. */
void texture_table_open(TextureTable *table, const Cli *cli, const char *path);
void texture_table_close(TextureTable *table);

/* A row's picture, as it is written. */
const char *texture_table_output(const TextureTable *table, int row);
/* What a row puts on a column's target; RETEX_ENOTFOUND where that is nothing. *image, its name, stays until the table
 * is closed. */
int texture_table_texture(const TextureTable *table, int row, int column, RetexTextureSpec *spec, const char **image);
/* All of a row's; returns how many. */
int texture_table_textures(const TextureTable *table, int row, RetexTextureSpec specs[RETEX_MAX_TARGETS]);

/* Note a mistake. */
void texture_table_mistake(TextureTable *table, int line, const char *fmt, ...) RETEX_PRINTF(3, 4);
/* Print the mistakes, each a line, in the order of the table. */
void texture_table_tell(TextureTable *table, const Cli *cli);

#endif
