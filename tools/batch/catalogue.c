/* Large batches: a part of the table for each of several processes, pictures that are there already, and the comparison
 * of all pictures with the journal. See batch.h. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/file_sum.h>

#include "batch/batch.h"

/* ---- options ---- */

static void take_pair(const Cli *cli, const CliOption *option, const char *format, int pair[2])
{
    int length = -1;
    if (sscanf(cli->value, format, &pair[0], &pair[1], &length) != 2 || length < 0 || cli->value[length])
        cli_die(cli, "--%s: expected %s, not '%s'", option->name, option->argument, cli->value);
}

void batch_take_rows(Cli *cli, const CliOption *option, void *pair)
{
    const int *rows = pair;
    take_pair(cli, option, "%9d-%9d%n", pair);
    if (rows[0] < 1 || rows[1] < rows[0])
        cli_die(cli, "--rows: expected A-B, A from 1 to B, not '%s'", cli->value);
}

void batch_take_shard(Cli *cli, const CliOption *option, void *pair)
{
    const int *shard = pair;
    take_pair(cli, option, "%9d/%9d%n", pair);
    if (shard[0] < 1 || shard[1] < shard[0])
        cli_die(cli, "--shard: expected I/N, I from 1 to N, not '%s'", cli->value);
}

void batch_check_catalogue_options(const Batch *batch, const Cli *cli, int has_table, int sources_are_piped)
{
    const char *given = batch->journal_path    ? "manifest"
                        : batch->resume        ? "resume"
                        : batch->verify        ? "verify"
                        : batch->plan          ? "plan"
                        : batch->rows_asked[0] ? "rows"
                        : batch->shard[0]      ? "shard"
                                               : NULL;
    if (given && !has_table)
        cli_die(cli, "--%s needs a table of pictures: --batch", given);
    if (batch->journal_path && sources_are_piped)
        cli_die(cli, "--manifest needs the set and the samples in files, not in standard input");
    if ((batch->resume || batch->verify) && !batch->journal_path)
        cli_die(cli, "--%s needs the pictures' checksums: --manifest", batch->resume ? "resume" : "verify");
    if (batch->plan + batch->dry_run + (batch->verify && !batch->resume) > 1)
        cli_die(cli, "--plan, --dry-run and --verify without --resume exclude each other");
}

void batch_select(Batch *batch)
{
    const TextureTable *table = &batch->table;
    const int64_t rows = table->nrows;
    batch->first = 0, batch->end = table->nrows;
    if (batch->rows_asked[0]) {
        if (batch->rows_asked[1] > rows)
            cli_die(batch->cli, "--rows: the table has %d row%s", table->nrows, table->nrows == 1 ? "" : "s");
        batch->first = batch->rows_asked[0] - 1, batch->end = batch->rows_asked[1];
    }
    if (batch->shard[0]) {
        const int64_t count = batch->end - batch->first, first = batch->first;
        batch->first = (int)(first + count * (batch->shard[0] - 1) / batch->shard[1]);
        batch->end = (int)(first + count * batch->shard[0] / batch->shard[1]);
    }
}

/* ---- states ---- */

static int sources_of(Batch *batch, int row, char **text, RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count = texture_table_textures(&batch->table, row, specs);
    if (batch->tool.complete)
        count = batch->tool.complete(batch->tool.context, specs, count);
    char *lights = NULL;
    int code = batch->tool.lights ? batch->tool.lights(batch->tool.context, row, &lights, err) : RETEX_OK;
    if (!code)
        code = batch_sources_text(text, &batch->sources, texture_table_output(&batch->table, row), specs, count,
                                  lights ? lights : "", err);
    free(lights);
    return code;
}

/* The state of a row's picture. In --verify, a source that cannot be read makes it stale; lack of memory says nothing
 * about it. */
static int find_state(Batch *batch, int row, char *reason, size_t size, RetexError *err)
{
    char path[PATH_MAX], *sources = NULL;
    int code = sources_of(batch, row, &sources, err);
    if (!code)
        code = batch_path(batch, row, path, err);
    if (!code)
        batch->rows[row].state = batch_journal_state(&batch->journal, sources, path, batch->verify, reason, size);
    free(sources);
    if (!code || code == RETEX_ENOMEM || !batch_only_verifies(batch))
        return code;
    batch->rows[row].state = PICTURE_STALE;
    snprintf(reason, size, "%.500s", err->message);
    return RETEX_OK;
}

/* A number that tells tables apart, of their outputs. */
static uint32_t sum_outputs(const Batch *batch)
{
    uint32_t sum = 0;
    for (int row = 0; row < batch->table.nrows; row++) {
        const char *output = texture_table_output(&batch->table, row);
        sum = retex_bytes_sum(sum, output, strlen(output) + 1);
    }
    return sum;
}

static int find_states(Batch *batch, RetexError *err)
{
    const int makes = !batch->plan && !batch->dry_run && !batch_only_verifies(batch);
    int code = RETEX_OK, exists = makes || batch_only_verifies(batch) || access(batch->journal_path, F_OK) == 0;
    if (exists)
        code = batch_journal_open(&batch->journal, batch->journal_path, makes, err);
    if (!code && makes)
        code = batch_journal_claim(&batch->journal, sum_outputs(batch), batch->first, batch->end - batch->first, err);
    for (int row = batch->first; row < batch->end && !code; row++) {
        char reason[512], output[PATH_MAX];
        if (batch->table.rows[row].wrong)
            continue;
        code = find_state(batch, row, reason, sizeof reason, err);
        const PictureState state = batch->rows[row].state;
        if (code)
            break;
        batch->states[state]++;
        if (batch->resume && state == PICTURE_GOOD)
            batch->rows[row].status = BATCH_KEPT, batch->kept++;
        snprintf(output, sizeof output, "%s", texture_table_output(&batch->table, row));
        if (batch_only_verifies(batch) && state != PICTURE_GOOD && !batch->cli->quiet)
            printf("%s: %s%s%s\n", cli_plain(output), picture_state_names[state], reason[0] ? ": " : "",
                   cli_plain(reason));
        cli_check_text(batch->cli);
    }
    return code;
}

int batch_only_verifies(const Batch *batch)
{
    return batch->verify && !batch->resume;
}

int batch_prepare(Batch *batch, RetexError *err)
{
    return batch->journal_path ? find_states(batch, err) : RETEX_OK;
}

int batch_is_wanted(const Batch *batch, int row)
{
    return row >= batch->first && row < batch->end && batch->rows[row].status != BATCH_KEPT &&
           !batch->table.rows[row].wrong;
}

int batch_record(Batch *batch, int row, double seconds, RetexError *err)
{
    char path[PATH_MAX], *sources = NULL;
    if (!batch->journal_path)
        return RETEX_OK;
    int code = sources_of(batch, row, &sources, err);
    if (!code)
        code = batch_path(batch, row, path, err);
    if (!code)
        code = batch_journal_add(&batch->journal, sources, path, seconds, err);
    free(sources);
    return code;
}

/* ---- --verify and --plan ---- */

static const char *plural(int count)
{
    return count == 1 ? "" : "s";
}

/* "3 missing, 1 stale", or "" */
static const char *count_states(const Batch *batch, char text[160])
{
    size_t used = 0;
    text[0] = '\0';
    for (int state = PICTURE_GOOD + 1; state < PICTURE_STATES; state++)
        if (batch->states[state])
            used += (size_t)snprintf(text + used, 160 - used, "%s%d %s", used ? ", " : "", batch->states[state],
                                     picture_state_names[state]);
    return text;
}

int batch_print_verdict(const Batch *batch)
{
    const int total = batch->end - batch->first, good = batch->states[PICTURE_GOOD];
    char others[160];
    if (!batch->cli->quiet)
        printf("%d of %d picture%s good%s%s\n", good, total, plural(total), good < total ? "; " : "",
               count_states(batch, others));
    return good < total ? CLI_NO : CLI_OK;
}

/* A size in the unit that suits. */
static const char *size_text(double bytes, char text[32])
{
    static const char *const units[] = {"bytes", "kB", "MB", "GB", "TB"};
    int unit = 0;
    for (; bytes >= 1000 && unit < 4; unit++)
        bytes /= 1000;
    snprintf(text, 32, "%.3g %s", bytes, units[unit]);
    return text;
}

void batch_print_plan(const Batch *batch, int trials, double bytes, double seconds)
{
    const int total = batch->end - batch->first, wanted = total - batch->kept - batch->failed;
    char others[160], size[32];
    if (total)
        printf("rows %d to %d of %d: ", batch->first + 1, batch->end, batch->table.nrows);
    printf("%d to make, %d kept", wanted, batch->kept);
    if (batch->resume && wanted)
        printf(" (%s)", count_states(batch, others));
    puts("");
    if (trials)
        printf("to make: about %s, %.3g s, by %d trial picture%s of %s and %.3g s\n",
               size_text(bytes / trials * wanted, size), seconds / trials * wanted, trials, plural(trials),
               size_text(bytes / trials, (char[32]){0}), seconds / trials);
}
