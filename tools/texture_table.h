/* A table of pictures to make: comma-separated values as RFC 4180 has them. The first row names the columns: output,
 * then targets; each row that follows is a picture: its file, then for each target IMAGE, rgb(r,g,b), `:opts IMAGE`, or
 * nothing. Every mistake prints one line with the table's name and line and exits with CLI_FAIL. */
#ifndef RETEX_TEXTURE_TABLE_H
#define RETEX_TEXTURE_TABLE_H

#include <retex/set.h>
#include <retex/texture.h>

#include "cli.h"

typedef struct TextureTable {
    const char *name;
    char *text, *at;
    char *original; /* the text as it was read: cells are taken off `text` in place */
    size_t bytes;
    int line;     /* of `at` */
    int row_line; /* where the record last read begins */
    char *cells[1 + RETEX_MAX_TARGETS];
    int ncells;
    int ncolumns; /* of targets */
    const char *columns[RETEX_MAX_TARGETS]; /* as they are written; the caller may put others there */
} TextureTable;

/* Read the file, or standard input where path is "-", and its first row. */
void texture_table_open(TextureTable *table, const Cli *cli, const char *path);
/* The next picture, of which nothing is written or loaded yet; 0 at the end. Texts stay until the table is closed. */
int texture_table_row(TextureTable *table, const Cli *cli, const char **output,
                      RetexTextureSpec specs[RETEX_MAX_TARGETS], int *nspecs);
/* All rows, before the first picture is made: their outputs and textures are announced (cli_reads and cli_writes), then
 * the table is at its first picture again. The columns are as they are written then. */
void texture_table_announce(TextureTable *table, const Cli *cli);
/* The row last read is wrong. */
_Noreturn void texture_table_fail(const TextureTable *table, const Cli *cli, int code, const char *message);
/* An error of its picture: the table's line, then the file it was in. */
_Noreturn void texture_table_fail_picture(const TextureTable *table, const Cli *cli, const RetexError *err);
void texture_table_close(TextureTable *table);

#endif
