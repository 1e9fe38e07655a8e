/* See batch.h: options of batches, and their start, rows and end. */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch.h"
#include "common/output_folder.h"
#include "common/texture_args.h"
#include "common/watchdog.h"

/* ---- options ---- */

void batch_check_options(const Batch *batch, const Cli *cli, const char *option)
{
    const char *given = batch->dry_run        ? "dry-run"
                        : batch->keep_going   ? "keep-going"
                        : batch->make_folders ? "mkdir"
                        : batch->root         ? "batch-root"
                        : batch->report       ? "report"
                                              : NULL;
    if (given)
        cli_die(cli, "--%s needs a table of pictures: --%s%s", given, option, batch->keep_going ? ", or --frames" : "");
}

/* ---- start and end ---- */

/* The only batch of this process. The lock guards the data of the report, because after a signal another thread writes
 * the report. */
static Batch *running;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

/* Write the report, once. The caller holds the lock. */
static int save_report(Batch *batch, RetexError *err)
{
    const int due = batch->report_due && (batch->inputs_known || batch_report_is_free(batch->report));
    batch->report_due = 0;
    return due ? batch_report_write(batch, err) : RETEX_OK;
}

void batch_owe_report(Batch *batch)
{
    pthread_mutex_lock(&lock);
    batch->report_due = batch->report != NULL;
    pthread_mutex_unlock(&lock);
}

/* Write the report, and print an error if that fails. */
static int write_report(Batch *batch)
{
    RetexError err = {0}, told = {0};
    pthread_mutex_lock(&lock);
    int code = save_report(batch, &err);
    pthread_mutex_unlock(&lock);
    if (!code)
        return CLI_OK;
    retex_fail(&told, code, "--report: %s", err.message);
    cli_error(batch->cli, &told);
    return CLI_FAIL;
}

/* Called at exit: an error that has been printed ended the program before the batch began. */
static void write_last_report(void)
{
    if (!running || !running->report_due)
        return;
    if (!running->error)
        running->error = strdup("the batch was not begun");
    write_report(running);
}

/* Called when a signal or a limit ends the tool. If the lock is not free within half a second, a thread holds it that
 * waits for a disk; the report is then not written. */
static void write_report_at_end(const char *why)
{
    const struct timespec until = retex_clock_time_after(0.5);
    RetexError err = {0};
    if (pthread_mutex_timedlock(&lock, &until) != 0)
        return;
    if (running) {
        free(running->error);
        running->error = strdup(why);
        save_report(running, &err);
    }
    pthread_mutex_unlock(&lock);
}

void batch_open(Batch *batch, const Cli *cli, const char *path)
{
    pthread_mutex_lock(&lock);
    running = batch;
    pthread_mutex_unlock(&lock);
    atexit(write_last_report);
    watchdog_at_end(write_report_at_end);
    batch->cli = cli;
    batch->began = retex_clock_seconds();
    texture_table_open(&batch->table, cli, path);
    batch->rows = calloc((size_t)batch->table.nrows + 1, sizeof *batch->rows);
    if (!batch->rows)
        cli_die(cli, "not enough memory for the table");
    batch_select(batch);
}

static void close_batch(Batch *batch)
{
    pthread_mutex_lock(&lock);
    for (int row = 0; row < batch->table.nrows; row++)
        free(batch->rows[row].error);
    free(batch->rows);
    free(batch->error);
    batch_journal_close(&batch->journal);
    batch_sources_close(&batch->sources);
    texture_table_close(&batch->table);
    batch->rows = NULL;
    batch->error = NULL;
    running = NULL;
    pthread_mutex_unlock(&lock);
}

/* Print the mistakes of the table, once. */
static void tell_mistakes(Batch *batch, int first, int end)
{
    if (!batch->table.nmistakes || batch->mistakes_told)
        return;
    batch->mistakes_told = 1;
    texture_table_tell(&batch->table, batch->cli, first, end);
}

/* Record the result of a row. */
static void note_row(Batch *batch, int row, double seconds, const char *error)
{
    BatchRow *r = &batch->rows[row];
    pthread_mutex_lock(&lock);
    r->seconds = seconds;
    r->status = error ? BATCH_FAILED : BATCH_MADE;
    r->error = error ? strdup(error) : NULL;
    *(error ? &batch->failed : &batch->made) += 1;
    pthread_mutex_unlock(&lock);
    if (batch->cli->json_progress)
        batch_report_row(batch, row);
}

void batch_refuse_mistakes(Batch *batch)
{
    if (!batch->table.nmistakes)
        return;
    if (batch->keep_going && !batch->table.wrong) {
        tell_mistakes(batch, batch->first, batch->end);
        for (int row = batch->first; row < batch->end; row++)
            if (batch->table.rows[row].wrong)
                note_row(batch, row, 0, texture_table_why(&batch->table, row));
        return;
    }
    tell_mistakes(batch, 0, batch->table.nrows);
    write_report(batch);
    close_batch(batch);
    exit(cli_close(batch->cli, CLI_FAIL));
}

void batch_print(const Batch *batch)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    BatchTexture textures[RETEX_MAX_TARGETS];
    char output[PATH_MAX];
    for (int row = batch->first; row < batch->end && !batch->cli->quiet; row++) {
        if (!batch_is_wanted(batch, row))
            continue;
        int count = texture_table_textures(&batch->table, row, specs);
        count = batch->tool.describe(batch->tool.context, specs, count, textures);
        snprintf(output, sizeof output, "%s", texture_table_output(&batch->table, row));
        printf("%s: ", cli_plain(output));
        for (int i = 0; i < count; i++)
            printf("%s%s <- %s", i ? ", " : "", textures[i].target, cli_plain(textures[i].texture));
        puts(count ? "" : "original textures");
        cli_check_text(batch->cli);
    }
}

/* ---- row by row ---- */

int batch_output(const Batch *batch, int row, char path[PATH_MAX], RetexError *err)
{
    const char *output = texture_table_output(&batch->table, row);
    char real[PATH_MAX];
    int missing, code = batch_path(batch, row, path, err);
    if (code || !(batch->make_folders || batch->root))
        return code;
    code = output_resolve(real, &missing, path, output, err);
    if (!code)
        code = batch_check_root(batch, real, output, err);
    if (code || !(missing || batch->root))
        return code;
    if (batch->make_folders)
        code = output_make_folders(real, err);
    if (!code)
        code = output_resolve(path, &missing, real, output, err); /* again: it may lead elsewhere now */
    return code ? code : batch_check_root(batch, path, output, err);
}

int batch_done(Batch *batch, int row, double seconds, const RetexError *err)
{
    RetexError told = {0}, unrecorded = {0};
    char message[sizeof err->file + sizeof err->message + 32];
    if (!err && batch_record(batch, row, seconds, &unrecorded))
        err = &unrecorded;
    if (err) {
        cli_error_text(err, message, sizeof message);
        retex_fail_at(&told, err->code, batch->table.name, batch->table.rows[row].line, 0, "%s", message);
        cli_error(batch->cli, &told);
    }
    note_row(batch, row, seconds, err ? message : NULL);
    return !err || batch->keep_going;
}

int batch_finish(Batch *batch, const RetexError *err)
{
    const int total = batch->end - batch->first;
    RetexError told = {0};
    tell_mistakes(batch, 0, batch->table.nrows); /* an error came before they were */
    if (err) {
        char message[sizeof err->file + sizeof err->message + 32];
        cli_error_text(err, message, sizeof message);
        pthread_mutex_lock(&lock);
        batch->error = strdup(message);
        pthread_mutex_unlock(&lock);
        cli_error(batch->cli, err);
    } else if (batch->failed && batch->keep_going) {
        retex_fail(&told, RETEX_EIO, "%d of %d picture%s failed", batch->failed, total, total == 1 ? "" : "s");
        cli_error(batch->cli, &told);
    } else if (batch->made + batch->kept == total && !batch->dry_run && !batch->plan) {
        const double seconds = retex_clock_seconds() - batch->began;
        if (batch->resume)
            cli_info(batch->cli, "%d picture%s, %d kept, %.2f s", batch->made, batch->made == 1 ? "" : "s", batch->kept,
                     seconds);
        else
            cli_info(batch->cli, "%d picture%s, %.2f s", total, total == 1 ? "" : "s", seconds);
    }
    if (batch->cli->json_progress)
        batch_report_end(batch);
    int status = write_report(batch) || err || batch->failed ? CLI_FAIL : CLI_OK;
    close_batch(batch);
    return status;
}
