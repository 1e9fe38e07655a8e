/* Results of a batch for programs: lines of JSON while it runs, and the report. See batch.h. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <retex/retex.h>

#include "batch/batch.h"
#include "common/json.h"
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

static json_t *describe_row(const Batch *batch, int row)
{
    const BatchRow *r = &batch->rows[row];
    return json_pack("{s:i, s:i, s:o, s:s, s:o, s:o*}", "row", row + 1, "line", batch->table.rows[row].line, "output",
                     json_of_text(texture_table_output(&batch->table, row)), "status", status_name(batch, r),
                     "seconds", json_of_rounded(r->seconds, 4), "error", r->error ? json_of_text(r->error) : NULL);
}

void batch_report_row(const Batch *batch, int row)
{
    json_t *line = describe_row(batch, row);
    json_object_set_new(line, "done", json_integer(batch->kept + batch->made + batch->failed));
    json_object_set_new(line, "total", json_integer(batch->end - batch->first));
    (void)json_print_line(stderr, line, BATCH_DIGITS);
}

/* Of the whole batch. */
static json_t *describe_totals(const Batch *batch)
{
    return json_pack("{s:i, s:i, s:i, s:o*, s:o, s:o*}", "total", batch->end - batch->first, "made", batch->made,
                     "failed", batch->failed, "kept", batch->resume ? json_integer(batch->kept) : NULL, "seconds",
                     json_of_rounded(retex_clock_seconds() - batch->began, 4), "error",
                     batch->error ? json_of_text(batch->error) : NULL);
}

void batch_report_end(const Batch *batch)
{
    (void)json_print_line(stderr, describe_totals(batch), BATCH_DIGITS);
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

static json_t *describe_textures(const Batch *batch, int row)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    BatchTexture textures[RETEX_MAX_TARGETS];
    int count = texture_table_textures(&batch->table, row, specs);
    count = batch->tool.describe(batch->tool.context, specs, count, textures);
    json_t *all = json_object();
    for (int i = 0; i < count; i++) {
        json_t *target = json_of_text(textures[i].target);
        json_object_set_new(all, json_string_value(target), json_of_text(textures[i].texture));
        json_decref(target);
    }
    return all;
}

/* An item of a list, in a line of its own. Rows are written one by one: there may be a million. */
static void print_item(FILE *file, int is_first, json_t *item)
{
    char *text = json_dumps(item, JSON_REAL_PRECISION(BATCH_DIGITS));
    fprintf(file, "%s\n    %s", is_first ? "" : ",", text ? text : "null");
    free(text);
    json_decref(item);
}

static void print_mistakes(FILE *file, const Batch *batch, int first, int end)
{
    const TextureTable *table = &batch->table;
    int printed = 0;
    fprintf(file, "  \"mistakes\": [");
    for (int i = 0; i < table->nlisted; i++)
        if (texture_table_concerns(&table->mistakes[i], first, end))
            print_item(file, !printed++,
                       json_pack("{s:i, s:o}", "line", table->mistakes[i].line, "error",
                                 json_of_text(table->mistakes[i].message ? table->mistakes[i].message : "")));
    fprintf(file, "%s],\n", printed ? "\n  " : "");
}

static void print_report(FILE *file, const Batch *batch)
{
    const TextureTable *table = &batch->table;
    const int good = !batch_only_verifies(batch) || batch->states[PICTURE_GOOD] == batch->end - batch->first;
    const int refused = table->wrong || (table->nmistakes && !batch->keep_going);
    const int wrong = refused || batch->error || batch->failed || !good;
    json_t *totals = describe_totals(batch);
    char *text = json_dumps(totals, JSON_REAL_PRECISION(BATCH_DIGITS));
    json_decref(totals);
    fprintf(file, REPORT_BEGIN "%s\", \"version\": \"%s\", \"table\": ", batch->cli->tool + strlen("retex-"),
            RETEX_VERSION);
    json_text(file, table->name);
    fprintf(file, ",\n  \"status\": \"%s\", ", wrong ? "failed" : batch->dry_run || batch->plan ? "checked" : "made");
    fprintf(file, "%.*s,\n", text ? (int)strlen(text) - 2 : 0, text ? text + 1 : ""); /* without braces */
    free(text);
    print_mistakes(file, batch, refused ? 0 : batch->first, refused ? table->nrows : batch->end);
    fprintf(file, "  \"rows\": [");
    for (int row = batch->first; row < batch->end; row++) {
        json_t *item = describe_row(batch, row);
        if (!refused && !table->rows[row].wrong) /* otherwise names may be wrong */
            json_object_set_new(item, "textures", describe_textures(batch, row));
        print_item(file, row == batch->first, item);
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
