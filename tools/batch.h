/* Batches: many pictures from one table, for retex-combine --batch and retex-render --variants. The whole table is
 * checked first. Then the tool makes the pictures in the order of the rows. The result of each row is printed and kept
 * for the report. */
#ifndef RETEX_BATCH_H
#define RETEX_BATCH_H

#include <limits.h>
#include <retex/image_file.h>

#include "texture_table.h"

/* The options of batches, as rows of the tool's option table. */
#define BATCH_OPTIONS                                                                                                  \
    {"dry-run", 0, NULL, "check the table, print the pictures it would make, and stop", 0},                            \
        {"keep-going", 0, NULL, "continue after a picture that fails", 0},                                             \
        {"mkdir", 0, NULL, "create missing folders of pictures", 0},                                                   \
        {"batch-root", 0, "DIR", "write pictures only below DIR", 0},                                                  \
    {                                                                                                                  \
        "report", 0, "FILE.json", "write the result of each picture; - is standard output", 0                          \
    }

/* The texture of one target in one picture, in readable form: a file name or rgb(r,g,b). */
typedef struct BatchTexture {
    const char *target;
    char texture[1024];
} BatchTexture;

/* Callbacks of the tool, about the textures of a row. */
typedef struct BatchTool {
    void *context;
    /* Check that the textures fit their targets, without loading them; NULL = no check. */
    int (*check)(void *context, const RetexTextureSpec *specs, int count, RetexError *err);
    /* List all new textures of the picture; return their number. */
    int (*describe)(void *context, const RetexTextureSpec *specs, int count, BatchTexture textures[RETEX_MAX_TARGETS]);
} BatchTool;

typedef enum BatchStatus { BATCH_NOT_MADE, BATCH_MADE, BATCH_FAILED } BatchStatus;

typedef struct BatchRow {
    BatchStatus status;
    double seconds;
    char *error; /* the reason if it failed, or NULL */
} BatchRow;

typedef struct Batch {
    /* the command line */
    const char *root, *report;
    int dry_run, keep_going, make_folders;
    /* set by the functions below */
    const Cli *cli;
    BatchTool tool;
    TextureTable table;
    BatchRow *rows;
    int made, failed;
    double began;
    char root_path[PATH_MAX]; /* root with links resolved; "" = no root */
    char *error;              /* the error that ended the batch, if not that of a single picture; or NULL */
    int report_due;           /* the report can be written and has not been written */
    int inputs_known;         /* set by the tool when all inputs are announced; until then a report
                               * may only replace an older report */
} Batch;

/* Handle an option of BATCH_OPTIONS. Return 0 if it is not one of these. */
int batch_option(Batch *batch, const Cli *cli, const CliOption *option);
/* Fail if options of batches are given without `option`, which names the table. */
void batch_check_options(const Batch *batch, const Cli *cli, const char *option);

/* Read the table; "-" is standard input. After a successful batch_check, the report is written even if the program ends
 * by exit, so the batch must live until then. */
void batch_open(Batch *batch, const Cli *cli, const char *path);
/* Check the whole table before anything is written. Images must be readable. Pictures must be writable with `params`,
 * to files that are not inputs announced by cli_reads and not each other. Mistakes are added to the table, as the
 * tool's own are. */
void batch_check(Batch *batch, const RetexWriteParams *params);
/* If the table has mistakes: print them, write the report, and exit with CLI_FAIL. */
void batch_refuse_mistakes(Batch *batch);
/* After a successful check: print the pictures that would be made to standard output. */
void batch_print(const Batch *batch);

/* Find the file for a row's picture. Create its folder if --mkdir is given, and check that it is below the root. */
int batch_output(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);
/* Record and report that a row's picture was made, or failed with err. Return 0 if the batch ends here. */
int batch_done(Batch *batch, int row, double seconds, const RetexError *err /* NULL = made */);
/* End the batch, successfully or with err: print a summary, write the report, close the batch. Return the exit
 * status. */
int batch_finish(Batch *batch, const RetexError *err /* or NULL */);

/* ---- batch_check.c, which also has batch_check ---- */

/* RETEX_EINVAL if the resolved output is not below the root. */
int batch_check_root(const Batch *batch, const char *real, const char *output, RetexError *err);
/* The path of a row's picture, from the table and the root. */
int batch_path(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);

/* ---- batch_report.c ---- */

/* Print one line of JSON to standard error, about a finished row or the whole batch. */
void batch_report_row(const Batch *batch, int row);
void batch_report_end(const Batch *batch);
/* Whether a report may be written to path: no file exists, or an older report. */
int batch_report_is_free(const char *path);
/* Write the report. */
int batch_report_write(const Batch *batch, RetexError *err);

#endif
