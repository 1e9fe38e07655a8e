/* Batches: many pictures from one table, for retex-combine --batch and retex-render --variants. The whole table is
 * checked first. Then the tool makes the pictures in the order of the rows. The result of each row is printed and kept
 * for the report. */
#ifndef RETEX_BATCH_H
#define RETEX_BATCH_H

#include <limits.h>
#include <retex/image_file.h>

#include "batch/journal.h"
#include "batch/sources.h"
#include "batch/texture_table.h"

enum { BATCH_DIGITS = 15 }; /* of fractions in JSON: enough for the four decimals of seconds */

/* The options of batches, as rows of the tool's option table: `batch` is a Batch, a member of the type. */
#define BATCH_OPTIONS(type, batch)                                                                                     \
    {"dry-run", 0, NULL, "check the table, print the pictures it would make, and stop", 0,                             \
     CLI_INTO(type, batch.dry_run)},                                                                                   \
        {"keep-going", 0, NULL, "continue after a picture that fails", 0, CLI_INTO(type, batch.keep_going)},           \
        {"mkdir", 0, NULL, "create missing folders of pictures", 0, CLI_INTO(type, batch.make_folders)},               \
        {"batch-root", 0, "DIR", "write pictures only below DIR", 0, CLI_INTO(type, batch.root)},                      \
    {                                                                                                                  \
        "report", 0, "FILE.json", "write the result of each picture; - is standard output", 0,                         \
            CLI_INTO(type, batch.report)                                                                               \
    }

/* The options of large batches, which share their work among processes and compare pictures with a journal. */
#define BATCH_CATALOGUE_OPTIONS(type, batch)                                                                           \
    {"rows", 0, "A-B", "with --batch: only the rows A to B of the table", 0,                                           \
     CLI_CALL(type, batch.rows_asked, batch_take_rows)},                                                               \
        {"shard", 0, "I/N", "with --batch: only the Ith of N parts of these rows", 0,                                  \
         CLI_CALL(type, batch.shard, batch_take_shard)},                                                               \
        {"manifest", 0, "FILE", "append the sources and the checksum of each picture", 0,                              \
         CLI_INTO(type, batch.journal_path)},                                                                          \
        {"resume", 0, NULL, "make only pictures that are missing or differ from the manifest", 0,                      \
         CLI_INTO(type, batch.resume)},                                                                                \
        {"verify", 0, NULL, "compare pictures and sources with the manifest; make nothing without --resume", 0,        \
         CLI_INTO(type, batch.verify)},                                                                                \
    {                                                                                                                  \
        "plan", 0, NULL, "print how many pictures it would make, their size and time, and stop", 0,                    \
            CLI_INTO(type, batch.plan)                                                                                 \
    }

/* The texture of one target in one picture, in readable form: a file name or a colour. */
typedef struct BatchTexture {
    const char *target;
    char texture[1024];
} BatchTexture;

/* Callbacks of the tool, about the textures of a row. */
typedef struct BatchTool {
    void *context;
    /* Check that a texture fits its target, without loading it; NULL = no check. */
    int (*check)(void *context, const RetexTextureSpec *spec, RetexError *err);
    /* Add the textures of the command line to those of a row; return their number. NULL = there are none. */
    int (*complete)(void *context, RetexTextureSpec specs[RETEX_MAX_TARGETS], int count);
    /* Make the text, to be freed, of the lamps of a row, "" where it changes none; NULL = no row does. */
    int (*lights)(void *context, int row, char **text, RetexError *err);
    /* List all new textures of the picture; return their number. */
    int (*describe)(void *context, const RetexTextureSpec *specs, int count, BatchTexture textures[RETEX_MAX_TARGETS]);
    /* batch_run: get ready for the rows that batch_is_wanted, of which there are some. */
    int (*begin)(void *context, RetexError *err);
    /* batch_run: make the picture of a row; if `trial` is not NULL, silently in memory, which gets its bytes. */
    int (*make)(void *context, int row, size_t *trial, RetexError *err);
} BatchTool;

/* BATCH_KEPT: the picture of an earlier run, with --resume */
typedef enum BatchStatus { BATCH_NOT_MADE, BATCH_MADE, BATCH_FAILED, BATCH_KEPT } BatchStatus;

typedef struct BatchRow {
    BatchStatus status;
    PictureState state; /* with a journal: before the batch */
    double seconds;
    char *error; /* the reason if it failed, or NULL */
} BatchRow;

typedef struct Batch {
    /* the command line */
    const char *root, *report;
    int dry_run, keep_going, make_folders;
    const char *journal_path;
    int resume, verify, plan;
    int rows_asked[2], shard[2]; /* 0, 0 = all */
    /* set by the functions below */
    const Cli *cli;
    BatchTool tool;
    TextureTable table;
    BatchRow *rows;
    int first, end; /* the rows of this process, from 0; end: after the last */
    int made, failed, kept;
    int states[PICTURE_STATES]; /* number of pictures */
    BatchJournal journal;
    BatchSources sources; /* set by the tool, except for the sums */
    double began;
    char root_path[PATH_MAX]; /* root with links resolved; "" = no root */
    char *error;              /* the error that ended the batch, if not that of a single picture; or NULL */
    int mistakes_told;        /* the mistakes of the table have been printed */
    int report_due;           /* the report can be written and has not been written */
    int inputs_known;         /* set by the tool when all inputs are announced; until then a report
                               * may only replace an older report */
} Batch;

/* Fail if options of batches are given without `option`, which names the table. */
void batch_check_options(const Batch *batch, const Cli *cli, const char *option);

/* Read the table; "-" is standard input. After batch_check, the report is written even if the program ends by exit, so
 * the batch must live until then. */
void batch_open(Batch *batch, const Cli *cli, const char *path);
/* Check the whole table before anything is written. Images must be readable. Pictures must be writable with `params`,
 * to files that are not inputs announced by cli_reads and not each other. Mistakes are added to the table, as the
 * tool's own are. */
void batch_check(Batch *batch, const RetexWriteParams *params);
/* The batch has been checked: from now on its report is written however the program ends. */
void batch_owe_report(Batch *batch);
/* If the table has mistakes: print them, write the report, and exit with CLI_FAIL. With --keep-going, unless the table
 * itself is wrong, those of other rows of this process are printed only, and these rows have failed. */
void batch_refuse_mistakes(Batch *batch);
/* After a successful check: print the pictures that would be made to standard output. */
void batch_print(const Batch *batch);

/* Find the file for a row's picture. Create its folder if --mkdir is given, and check that it is below the root. */
int batch_output(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);
/* Record and report that a row's picture was made, or failed with err. Return 0 if the batch ends here. */
int batch_done(Batch *batch, int row, double seconds, const RetexError *err /* NULL = made */);
/* Whether a row is one of this process, without a mistake, and not kept. */
int batch_is_wanted(const Batch *batch, int row);
/* End the batch, successfully or with err: print a summary, write the report, close the batch. Return the exit
 * status. */
int batch_finish(Batch *batch, const RetexError *err /* or NULL */);

/* ---- run.c ---- */

/* After batch_open: check the table, and make its pictures or do what else was asked. Return the exit status. */
int batch_run(Batch *batch, const RetexWriteParams *params);

/* ---- check.c, which also has batch_check ---- */

/* RETEX_EINVAL if the resolved output is not below the root. */
int batch_check_root(const Batch *batch, const char *real, const char *output, RetexError *err);
/* The path of a row's picture, from the table and the root. */
int batch_path(const Batch *batch, int row, char path[PATH_MAX], RetexError *err);

/* ---- catalogue.c: BATCH_CATALOGUE_OPTIONS ---- */

void batch_take_rows(Cli *cli, const CliOption *option, void *pair);
void batch_take_shard(Cli *cli, const CliOption *option, void *pair);
/* Fail if they contradict each other, or lack a table or files for their checksums. */
void batch_check_catalogue_options(const Batch *batch, const Cli *cli, int has_table, int sources_are_piped);
/* Find the rows of this process. */
void batch_select(Batch *batch);
/* --verify without --resume: nothing is made. */
int batch_only_verifies(const Batch *batch);
/* After a successful check: claim the rows of this process in the journal, and find the state of each picture.
 * --verify prints those that are not good. */
int batch_prepare(Batch *batch, RetexError *err);
/* Append a picture that was made to the journal, if there is one. */
int batch_record(Batch *batch, int row, double seconds, RetexError *err);
/* Print how many pictures are good; return the exit status. */
int batch_print_verdict(const Batch *batch);
/* Print what is to be made; with the total size and time of some trial pictures, if there are any, also how much. */
void batch_print_plan(const Batch *batch, int trials, double bytes, double seconds);

/* ---- report.c ---- */

/* Print one line of JSON to standard error, about a finished row or the whole batch. */
void batch_report_row(const Batch *batch, int row);
void batch_report_end(const Batch *batch);
/* Whether a report may be written to path: no file exists, or an older report. */
int batch_report_is_free(const char *path);
/* Write the report. */
int batch_report_write(const Batch *batch, RetexError *err);

#endif
