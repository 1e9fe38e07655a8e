/* Results of a batch for programs: lines of JSON while it runs, and the report. See batch.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/retex.h>

#include "batch/batch.h"
#include "common/json_text.h"
#include "common/texture_args.h"

static const char *status_name(const Batch *batch, const BatchRow *row)
{
    return row->status == BATCH_MADE     ? "made"
           : row->status == BATCH_FAILED ? "failed"
           : row->status == BATCH_KEPT   ? "kept"
           : batch_only_verifies(batch)  ? picture_state_names[row->state]
           : batch->dry_run              ? "checked"
                                         : "not made";
}

/* The keys of one row, without braces. */
static void print_row(FILE *file, const Batch *batch, int row)
{
    const BatchRow *r = &batch->rows[row];
    fprintf(file, "\"row\": %d, \"line\": %d, \"output\": ", row + 1, batch->table.rows[row].line);
    json_text(file, texture_table_output(&batch->table, row));
    fprintf(file, ", \"status\": \"%s\", \"seconds\": %.4f", status_name(batch, r), r->seconds);
    if (r->error) {
        fprintf(file, ", \"error\": ");
        json_text(file, r->error);
    }
}

/* A line of JSON is collected and written at once, so that output of other programs does not split it. */
typedef struct Line {
    FILE *file;
    char *text;
    size_t bytes;
} Line;

/* Returns the line's file, NULL without memory. */
static FILE *begin_line(Line *line)
{
    line->text = NULL;
    line->file = open_memstream(&line->text, &line->bytes);
    if (line->file)
        fputc('{', line->file);
    return line->file;
}

static void print_line(Line *line)
{
    fputs("}\n", line->file);
    if (fclose(line->file) == 0)
        fputs(line->text, stderr);
    free(line->text);
}

void batch_report_row(const Batch *batch, int row)
{
    Line line;
    FILE *file = begin_line(&line);
    if (!file)
        return;
    print_row(file, batch, row);
    fprintf(file, ", \"done\": %d, \"total\": %d", batch->kept + batch->made + batch->failed,
            batch->end - batch->first);
    print_line(&line);
}

/* The keys of the whole batch. */
static void print_totals(FILE *file, const Batch *batch)
{
    fprintf(file, "\"total\": %d, \"made\": %d, \"failed\": %d, ", batch->end - batch->first, batch->made,
            batch->failed);
    if (batch->resume)
        fprintf(file, "\"kept\": %d, ", batch->kept);
    fprintf(file, "\"seconds\": %.4f", retex_clock_seconds() - batch->began);
    if (batch->error) {
        fprintf(file, ", \"error\": ");
        json_text(file, batch->error);
    }
}

void batch_report_end(const Batch *batch)
{
    Line line;
    FILE *file = begin_line(&line);
    if (!file)
        return;
    print_totals(file, batch);
    print_line(&line);
}

/* ---- the report ---- */

#define REPORT_BEGIN "{\n  \"tool\": \"retex-"

int batch_report_is_free(const char *path)
{
    char begin[sizeof REPORT_BEGIN] = "";
    FILE *file = strcmp(path, "-") ? fopen(path, "rb") : NULL;
    if (!file)
        return !strcmp(path, "-") || access(path, F_OK) != 0;
    size_t got = fread(begin, 1, sizeof begin - 1, file);
    fclose(file);
    return got == sizeof begin - 1 && strcmp(begin, REPORT_BEGIN) == 0;
}

static void print_textures(FILE *file, const Batch *batch, int row)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    BatchTexture textures[RETEX_MAX_TARGETS];
    int count = texture_table_textures(&batch->table, row, specs);
    count = batch->tool.describe(batch->tool.context, specs, count, textures);
    fprintf(file, ", \"textures\": {");
    for (int i = 0; i < count; i++) {
        fprintf(file, i ? ", " : "");
        json_text(file, textures[i].target);
        fprintf(file, ": ");
        json_text(file, textures[i].texture);
    }
    fprintf(file, "}");
}

static void print_mistakes(FILE *file, const Batch *batch, int first, int end)
{
    const TextureTable *table = &batch->table;
    int printed = 0;
    fprintf(file, "  \"mistakes\": [");
    for (int i = 0; i < table->kept; i++) {
        if (!texture_table_concerns(&table->mistakes[i], first, end))
            continue;
        fprintf(file, "%s\n    {\"line\": %d, \"error\": ", printed++ ? "," : "", table->mistakes[i].line);
        json_text(file, table->mistakes[i].message ? table->mistakes[i].message : "");
        fprintf(file, "}");
    }
    fprintf(file, "%s],\n", printed ? "\n  " : "");
}

static void print_report(FILE *file, const Batch *batch)
{
    const TextureTable *table = &batch->table;
    const int good = !batch_only_verifies(batch) || batch->states[PICTURE_GOOD] == batch->end - batch->first;
    const int refused = table->wrong || (table->nmistakes && !batch->keep_going);
    const int wrong = refused || batch->error || batch->failed || !good;
    fprintf(file, REPORT_BEGIN "%s\", \"version\": \"%s\", \"table\": ", batch->cli->tool + strlen("retex-"),
            RETEX_VERSION);
    json_text(file, table->name);
    fprintf(file, ",\n  \"status\": \"%s\", ", wrong ? "failed" : batch->dry_run || batch->plan ? "checked" : "made");
    print_totals(file, batch);
    fprintf(file, ",\n");
    print_mistakes(file, batch, refused ? 0 : batch->first, refused ? table->nrows : batch->end);
    fprintf(file, "  \"rows\": [");
    for (int row = batch->first; row < batch->end; row++) {
        fprintf(file, "%s\n    {", row > batch->first ? "," : "");
        print_row(file, batch, row);
        if (!refused && !table->rows[row].wrong) /* otherwise names may be wrong */
            print_textures(file, batch, row);
        fprintf(file, "}");
    }
    fprintf(file, "%s]\n}\n", batch->end > batch->first ? "\n  " : "");
}

int batch_report_write(const Batch *batch, RetexError *err)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *file = open_memstream(&text, &bytes);
    if (file)
        print_report(file, batch);
    int failed = !file || ferror(file), closed = file ? fclose(file) : 0;
    int code = failed || closed ? retex_fail(err, RETEX_ENOMEM, "not enough memory for the report")
                                : retex_file_write(batch->report, text, bytes, err);
    free(text);
    return code;
}
