/* --batch: a picture for each row of a table. See job.h. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/file_sum.h>

#include "combine/job.h"
#include "combine/reuse.h"

/* Add the textures of --texture to a row, for targets that the row does not name. */
static int complete_row(const Job *job, RetexTextureSpec *specs, int count)
{
    for (int i = 0; i < job->textures.count; i++) {
        int target = retex_set_find_target(job->set, job->textures.specs[i].target), k = 0;
        while (k < count && retex_set_find_target(job->set, specs[k].target) != target)
            k++;
        if (k == count)
            specs[count++] = job->textures.specs[i];
    }
    return count;
}

/* Replace the table's column names by the set's target names. */
static void find_columns(TextureTable *table, const RetexSet *set)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    RetexTargetNames names;
    retex_set_target_names(&names, set);
    for (int i = 0; i < table->ncolumns; i++) {
        RetexError err = {0};
        int t;
        if (!texture_table_is_target(table, i))
            continue;
        if (retex_target_find(&t, &names, table->columns[i], &err)) {
            texture_table_mistake(table, TABLE_ITSELF, "%s", err.message);
            continue;
        }
        if (taken[t]++)
            texture_table_mistake(table, TABLE_ITSELF, "target '%s' has two columns", table->columns[i]);
        table->columns[i] = names.names[t];
    }
}

/* Find the columns of lamps, each by itself: all mistakes are told. */
static void find_lamps(TextureTable *table, const RetexSet *set)
{
    int taken[RETEX_PARAMETERS_MAX] = {0};
    for (int i = 0; i < table->ncolumns; i++) {
        RetexError err = {0};
        const char *name = texture_table_name(table, i, "light");
        int lamp = -1;
        if (!name || (strcmp(name, "*") == 0 && retex_set_has_lamps(set)))
            continue;
        if (retex_lamp_find(&lamp, set, name, &err))
            texture_table_mistake(table, TABLE_ITSELF, "%s", err.message);
        else if (taken[lamp]++)
            texture_table_mistake(table, TABLE_ITSELF, "lamp '%s' has two columns", name);
    }
}

/* The same of finishes. */
static void find_finishes(TextureTable *table, const RetexSet *set)
{
    int taken[RETEX_MAX_TARGETS] = {0}, t;
    RetexTargetNames names;
    retex_set_target_names(&names, set);
    for (int i = 0; i < table->ncolumns; i++) {
        RetexError err = {0};
        const char *name = texture_table_name(table, i, "finish");
        if (!name)
            continue;
        if (retex_target_find(&t, &names, name, &err))
            texture_table_mistake(table, TABLE_ITSELF, "%s", err.message);
        else if (!retex_set_target(set, t)->nfinishes)
            texture_table_mistake(table, TABLE_ITSELF, "the set has no finishes of '%s'", names.names[t]);
        else if (taken[t]++)
            texture_table_mistake(table, TABLE_ITSELF, "the finish of '%s' has two columns", names.names[t]);
    }
}

/* Keys of the picture: their cells are checked where they are read, but for the view, which the display must have. */
static void find_picture_keys(TextureTable *table, const RetexWriteParams *write)
{
    for (int i = 0; i < table->ncolumns; i++) {
        const char *name = texture_table_name(table, i, "picture");
        for (int k = 0; name && k < i; k++)
            if (strcmp(table->columns[k], table->columns[i]) == 0)
                texture_table_mistake(table, TABLE_ITSELF, "'%s' has two columns", table->columns[i]);
        if (name && strcmp(name, "view") == 0 && write->colorspace)
            texture_table_mistake(table, TABLE_ITSELF, "--colorspace excludes a column %s", table->columns[i]);
    }
}

/* Whether the pictures of the rows can be written in their views. */
static void check_views(TextureTable *table, const RetexWriteParams *write)
{
    RetexEdit *edit = NULL;
    RetexError err = {0};
    int code = retex_edit_create(&edit, &err);
    for (int row = 0; row < table->nrows && !code && !write->colorspace; row++) {
        const char *output = texture_table_output(table, row);
        RetexWriteParams params = *write;
        retex_edit_clear(edit);
        if (texture_table_lights(table, row, edit, NULL) || !(params.view = retex_edit_view(edit)) ||
            retex_image_format_check(output, write, NULL))
            continue; /* without a view, or what is wrong there is told with the row */
        if (retex_image_format_check(output, &params, &err))
            texture_table_mistake(table, row, "%s", err.message);
    }
    retex_edit_close(&edit);
}

/* The context of a batch. */
typedef struct Table {
    const Cli *cli;
    Job *job;
    KeptTextures kept;
    Reuse reuse;
} Table;

/* The lamps of a row, and how its picture is developed; what it does not name is as the command line has it. */
static int light_row(const Job *job, int row, RetexEdit **lights, RetexError *err)
{
    int code = retex_edit_create(lights, err);
    if (!code)
        code = texture_table_lights(&job->batch.table, row, *lights, err);
    if (!code)
        code = retex_edit_bind_lamps(*lights, job->set, err);
    if (!code)
        code = retex_edit_complete_lights(*lights, job->lights, err);
    return code;
}

static int lights_text(void *context, int row, char **text, RetexError *err)
{
    RetexEdit *lights = NULL;
    int code = light_row(((const Table *)context)->job, row, &lights, err);
    if (!code)
        code = retex_edit_text(lights, ';', text, err);
    retex_edit_close(&lights);
    return code;
}

/* A target that the set has not is a mistake of its column. */
static int check_texture(void *context, const RetexTextureSpec *spec, RetexError *err)
{
    const Job *job = ((const Table *)context)->job;
    return retex_set_find_target(job->set, spec->target) < 0 ? RETEX_OK : retex_textures_check(job->set, spec, 1, err);
}

static int complete(void *context, RetexTextureSpec specs[RETEX_MAX_TARGETS], int count)
{
    return complete_row(((const Table *)context)->job, specs, count);
}

static int describe_row(void *context, const RetexTextureSpec *specs, int count,
                        BatchTexture textures[RETEX_MAX_TARGETS])
{
    const Job *job = ((const Table *)context)->job;
    RetexTextureSpec all[RETEX_MAX_TARGETS];
    memcpy(all, specs, (size_t)count * sizeof *all);
    return job_describe(job, all, complete_row(job, all, count), textures);
}

/* The memory for samples that several pictures use: what the set leaves, if that is kept. */
static uint64_t memory_left(const Cli *cli, const Job *job, const int corrected[RETEX_MAX_TARGETS])
{
    const uint64_t memory = cli_memory(cli, job->memory), of_set = retex_set_preload_bytes(job->set, corrected);
    return of_set <= memory ? memory - of_set : memory;
}

/* Load what all pictures need, corrections included, and find what they have in common. */
static int begin(void *context, RetexError *err)
{
    Table *table = context;
    Job *job = table->job;
    int corrected[RETEX_MAX_TARGETS] = {0}, code = RETEX_OK;
    for (int number = 0; number < job->batch.table.nrows && !code; number++) {
        RetexTextureSpec specs[RETEX_MAX_TARGETS];
        if (!batch_is_wanted(&job->batch, number))
            continue;
        const int nspecs = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
        job_add_corrected(job, specs, nspecs, corrected);
        code = reuse_add_row(&table->reuse, job->set, number, specs, nspecs, err);
    }
    if (!code)
        code = reuse_plan(&table->reuse, memory_left(table->cli, job, corrected), err);
    return code ? code : job_preload(table->cli, job, corrected, err);
}

/* Write the picture of a row, with what other rows have of it. */
static int write_row(Table *table, int number, const Row *row, double began, RetexError *err)
{
    Job *job = table->job;
    char path[PATH_MAX];
    int code = batch_output(&job->batch, number, path, err);
    if (code)
        return code;
    reuse_begin(&table->reuse, job->set, number);
    job->combine.kept = table->reuse.kept;
    code = job_make_picture(table->cli, job, row, path, began, err);
    job->combine.kept = NULL;
    reuse_end(&table->reuse, number);
    return code;
}

static int make_row(void *context, int number, size_t *trial, RetexError *err)
{
    Table *table = context;
    Job *job = table->job;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    const double began = retex_clock_seconds();
    const int count = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
    RetexEdit *lights = NULL;
    int code = light_row(job, number, &lights, err);
    if (!code)
        code = job_light(job, lights, err);
    if (!code && !trial && job->combine.parameters)
        lamp_args_warn(table->cli, job->set, job->combine.parameters);
    if (!code)
        code = kept_textures_load(&table->kept, job->set, specs, count, table->cli->threads, err);
    const Row row = {specs, count, table->kept.textures, lights};
    if (!code)
        code = trial
                   ? job_try_picture(table->cli, job, &row, texture_table_output(&job->batch.table, number), trial, err)
                   : write_row(table, number, &row, began, err);
    retex_edit_close(&lights);
    return code;
}

/* The options that change pictures, in words, for the journal. */
static const char *describe_options(const Job *job, char *text, size_t size)
{
    const RetexWriteParams *write = &job->write;
    const char *config = getenv("OCIO");
    RetexFileSum sum = {0};
    RetexError err = {0};
    if (config && *config)
        (void)retex_file_sum(&sum, config, NULL, &err); /* one that cannot be read is an error of the pictures */
    int length = snprintf(text, size, "quality=%d cross=%d display=%s view=%s colorspace=%s ocio=%08x", write->quality,
                          job->combine.cross, write->display ? write->display : "", write->view ? write->view : "",
                          write->colorspace ? write->colorspace : "", (unsigned)sum.crc);
    if (write->depth && length >= 0 && (size_t)length < size)
        length += snprintf(text + length, size - (size_t)length, " depth=%d", write->depth);
    if (job->crop[2] && length >= 0 && (size_t)length < size)
        length += snprintf(text + length, size - (size_t)length, " crop=%d,%d,%d,%d", job->crop[0], job->crop[1],
                           job->crop[2], job->crop[3]);
    if ((job->scaled[0] || job->scaled[1]) && length >= 0 && (size_t)length < size)
        snprintf(text + length, size - (size_t)length, " size=%dx%d", job->scaled[0], job->scaled[1]);
    return text;
}

int job_run_table(const Cli *cli, Job *job)
{
    Batch *batch = &job->batch;
    Table table = {.cli = cli, .job = job, .kept.most_bytes = cli_memory(cli, job->memory) / 4};
    char options_text[1024];
    batch_open(batch, cli, job->table);
    find_columns(&batch->table, job->set);
    find_lamps(&batch->table, job->set);
    find_finishes(&batch->table, job->set);
    find_picture_keys(&batch->table, &job->write);
    check_views(&batch->table, &job->write);
    RetexError err = {0};
    if (retex_edit_bind_lamps(job->lights, job->set, &err))
        cli_fail(cli, &err);
    batch->tool = (BatchTool){.context = &table,
                              .check = check_texture,
                              .complete = complete,
                              .lights = lights_text,
                              .describe = describe_row,
                              .begin = begin,
                              .make = make_row};
    batch->sources.set = job->set_path, batch->sources.samples = job->samples_path;
    batch->sources.options = describe_options(job, options_text, sizeof options_text);
    batch->inputs_known = 1;
    const int status = batch_run(batch, &job->write);
    kept_textures_close(&table.kept);
    reuse_close(&table.reuse);
    if (table.reuse.found)
        cli_detail(cli, "textures that several pictures have: %" PRIu64 " rows of footprints filtered, %" PRIu64
                        " found again, at most %.1f MB kept",
                   table.reuse.made, table.reuse.found, (double)table.reuse.most_bytes / (1 << 20));
    return status;
}
