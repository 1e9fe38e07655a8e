/* Many pictures by one table: what retex-combine --batch and retex-render --variants share. The table is checked whole,
 * then its rows are made in order; what became of each is told, and kept for a report. The tool does the making. */
#ifndef RETEX_BATCH_H
#define RETEX_BATCH_H

#include <limits.h>
#include <retex/image_file.h>

#include "texture_table.h"

/* The options, rows of the tool's table of options. */
#define BATCH_OPTIONS                                                                                                  \
    {"dry-run", 0, NULL, "check the table, print the pictures it would make, and stop", 0},                            \
        {"keep-going", 0, NULL, "continue after a picture that fails", 0},                                             \
        {"mkdir", 0, NULL, "create missing folders of pictures", 0},                                                   \
        {"batch-root", 0, "DIR", "write pictures only below DIR", 0},                                                  \
    {                                                                                                                  \
        "report", 0, "FILE.json", "write the result of each picture; - is standard output", 0                          \
    }

/* What is on a target of a picture, for people to read: a file's name or rgb(r,g,b). */
typedef struct BatchTexture {
    const char *target;
    char texture[1024];
} BatchTexture;

/* What the tool knows of a row's textures, as the table has them. */
typedef struct BatchTool {
    void *context;
    /* Whether they can be put on their targets, as far as one can tell without loading them; NULL = yes. */
    int (*check)(void *context, const RetexTextureSpec *specs, int count, RetexError *err);
    /* All that is new on the picture's targets; returns how many. */
    int (*describe)(void *context, const RetexTextureSpec *specs, int count, BatchTexture textures[RETEX_MAX_TARGETS]);
} BatchTool;

typedef enum BatchStatus { BATCH_NOT_MADE, BATCH_MADE, BATCH_FAILED } BatchStatus;

typedef struct BatchRow {
    BatchStatus status;
    double seconds;
    char *error; /* why it failed, or NULL */
} BatchRow;

typedef struct Batch {
    /* the command line */
    const char *root, *report;
    int dry_run, keep_going, make_folders;
    /* the rest is filled in by the calls below */
    const Cli *cli;
    BatchTool tool;
    TextureTable table;
    BatchRow *rows;
    int made, failed;
    double began;
    char root_path[PATH_MAX]; /* of root, without links; "" = none */
    char *error;              /* that ended the batch, of no single picture; or NULL */
    int report_due;           /* it can be written, and has not been yet */
    int inputs_known;         /* all are announced. The tool says so; until then a report replaces
                               * nothing but a report */
} Batch;

/* Whether an option is one of BATCH_OPTIONS, which is then dealt with. */
int batch_option(Batch *batch, const Cli *cli, const CliOption *option);
/* They need the option that names the table. */
void batch_check_options(const Batch *batch, const Cli *cli, const char *option);

/* Read the table; "-" is standard input. From a good check on, the report is written even where the program is left by
 * exit: the batch must live that long. */
void batch_open(Batch *batch, const Cli *cli, const char *path);
/* Check all of it, before anything is written: that images can be read and pictures be written as params say, to files
 * that are no inputs (those that the tool has announced with cli_reads) and not each other. Mistakes are noted in the
 * table, where the tool notes its own. */
void batch_check(Batch *batch, const RetexWriteParams *params);
/* Where there are mistakes: tells them, writes the report, and ends the program with CLI_FAIL. */
void batch_refuse_mistakes(Batch *batch);
/* After a good check: print what would be made, on standard output. */
void batch_print(const Batch *batch);

/* The file that a row's picture is to be written to: its folder is made if that is asked for, and is below the root. */
int batch_output(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);
/* A row's picture is made, or not, and err says why. Tells it. 0: the batch ends here. */
int batch_done(Batch *batch, int row, double seconds, const RetexError *err /* NULL: it is made */);
/* All is done, or err ended it. Tells it, writes the report, and closes the batch; returns the exit status. */
int batch_finish(Batch *batch, const RetexError *err /* or NULL */);

/* ---- batch_check.c: and batch_check ---- */

/* RETEX_EINVAL where what the output leads to is not below the root. */
int batch_check_root(const Batch *batch, const char *real, const char *output, RetexError *err);
/* Where a row's picture is to be written, by the table and the root. */
int batch_path(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);

/* ---- batch_report.c ---- */

/* One line of JSON on standard error, of a row that is done or of the batch. */
void batch_report_row(const Batch *batch, int row);
void batch_report_end(const Batch *batch);
/* Whether nothing is there that a report of ours could not replace: no file, or an older report. */
int batch_report_is_free(const char *path);
/* The report; 0 or the error of writing it. */
int batch_report_write(const Batch *batch, RetexError *err);

#endif
