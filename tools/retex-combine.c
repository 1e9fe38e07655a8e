/* retex-combine: make a picture from a set, with its original textures or new ones. See retex-combine(1). */
#include <errno.h>
#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch.h"
#include "json_text.h"
#include "texture_args.h"
#include "watchdog.h"

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE", "put IMAGE, a file or rgb(r,g,b), on target NAME; opts as in retex-sample", 1},
    {"display", 0, "NAME", "OCIO display for the picture", 0},
    {"view", 0, "NAME", "OCIO view of that display", 0},
    {"colorspace", 0, "NAME", "write in this OCIO colour space instead", 0},
    {"quality", 0, "N", "quality of a JPEG, 1 to 100; default 95", 0},
    {"cross", 0, "0|2|3", "use cross terms of paths with at most this many hits; default 3", 0},
    {"error", 0, "FILE.exr", "write the expected error against a new render, per pixel", 0},
    {"batch", 0, "FILE.csv", "make one picture per row of a table: its file, then one texture per target", 0},
    {"memory", 0, "SIZE", "with --batch: keep the set and samples in memory if they take at most SIZE; default 2048 MB",
     0},
    BATCH_OPTIONS,
    CLI_PROGRESS_OPTION,
    {0},
};

typedef struct Job {
    const char *set_path, *samples_path, *table, *error;
    Batch batch;
    TextureArgs textures;
    long memory; /* megabytes of the set that --batch may keep in memory */
    RetexWriteParams write;
    RetexCombineParams combine;
    RetexSet *set;         /* rows are read when they are needed */
    RetexSamples *samples; /* from the set's file or stream, or from a separate file; or NULL */
} Job;

static void parse(Cli *cli, Job *job)
{
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option == &cli_positional) {
            if (job->samples_path)
                cli_surplus(cli, "one set and its samples are enough");
            *(job->set_path ? &job->samples_path : &job->set_path) = cli->value;
        } else if (strcmp(option->name, "texture") == 0) {
            texture_args_add(cli, &job->textures);
        } else if (strcmp(option->name, "display") == 0) {
            job->write.display = cli->value;
        } else if (strcmp(option->name, "view") == 0) {
            job->write.view = cli->value;
        } else if (strcmp(option->name, "colorspace") == 0) {
            job->write.colorspace = cli->value;
        } else if (strcmp(option->name, "quality") == 0) {
            job->write.quality = (int)cli_integer(cli, option, 1, 100);
        } else if (strcmp(option->name, "cross") == 0) {
            job->combine.cross = (int)cli_integer(cli, option, 0, 3);
            if (job->combine.cross == 1)
                cli_die(cli, "--cross: expected 0, 2 or 3; one hit has no cross terms");
        } else if (strcmp(option->name, "error") == 0) {
            job->error = cli->value;
        } else if (strcmp(option->name, "memory") == 0) {
            job->memory = cli_megabytes(cli, option);
        } else if (strcmp(option->name, "batch") == 0) {
            job->table = cli->value;
        } else if (!batch_option(&job->batch, cli, option)) {
            cli_take_progress(cli);
        }
    }
    if (!job->set_path)
        cli_die(cli, "no set given; - is standard input");
    if (!job->table)
        batch_check_options(&job->batch, cli, "batch");
    if (job->table && cli->output)
        cli_die(cli, "the table of --batch names the outputs: no -o");
    if (job->error && job->table)
        cli_die(cli, "--error and --batch exclude each other");
    if (job->error && !job->textures.count)
        cli_die(cli, "--error needs the textures: name them with --texture");
    if (job->write.colorspace && (job->write.display || job->write.view))
        cli_die(cli, "--colorspace excludes --display and --view");
}

/* Announce the files of the command line. batch_check announces those of a table. */
static void announce_files(const Cli *cli, const Job *job, const char *output)
{
    cli_reads(cli, "the set", job->set_path);
    cli_reads(cli, "the samples", job->samples_path);
    cli_reads(cli, "the table", job->table);
    texture_args_reads(cli, job->textures.specs, job->textures.count);
    cli_writes(cli, "the output", output);
    cli_writes(cli, "--error", job->error);
}

/* The samples cannot be read. The message asks whether -o or --texture is missing before the name. */
static void fail_samples(const Cli *cli, const Job *job, const RetexError *err)
{
    char forgotten[1024] = "";
    if (!job->table && strcmp(job->samples_path, job->set_path) != 0)
        cli_forgotten(cli, job->samples_path, forgotten, sizeof forgotten);
    cli_die(cli, "%s%s", err->message, forgotten);
}

static void check_samples_path(const Cli *cli, const Job *job)
{
    RetexError err = {0};
    struct stat info;
    if (job->samples_path && strcmp(job->samples_path, "-") != 0 && stat(job->samples_path, &info) != 0) {
        retex_fail(&err, RETEX_EIO, "cannot read %s: %s", job->samples_path, strerror(errno));
        fail_samples(cli, job, &err);
    }
}

/* Open the set, and the samples from the same stream or from a separate file. */
static void load(const Cli *cli, Job *job)
{
    RetexError err = {0};
    cli_input(cli, job->set_path, "a set, as from retex-render or retex-sample");
    if (retex_set_open(job->set_path, &job->set, job->samples_path ? NULL : &job->samples, cli->threads, &err))
        cli_fail(cli, &err);
    if (!job->set)
        cli_die(cli, "%s holds samples but no set", job->set_path);
    cli_check_pixels(cli, job->set, job->set_path);
    if (!job->samples_path)
        return;
    cli_input(cli, job->samples_path, "samples, as from retex-sample");
    if (retex_set_open(job->samples_path, NULL, &job->samples, cli->threads, &err))
        fail_samples(cli, job, &err);
    if (!job->samples) {
        retex_fail(&err, RETEX_EINVAL, "%s holds no samples", job->samples_path);
        fail_samples(cli, job, &err);
    }
    if (retex_samples_check(job->samples, job->set, &err))
        cli_fail(cli, &err);
}

/* The textures of one picture. Targets without one use the samples that came with the set. */
typedef struct Row {
    const RetexTextureSpec *specs;
    int count;
    RetexTexture *const *textures; /* by target */
} Row;

static int describe_targets(const Job *job, const RetexTextureSpec *specs, int count,
                            BatchTexture textures[RETEX_MAX_TARGETS])
{
    int found = 0;
    for (int t = 0; t < job->set->ntargets; t++) {
        const RetexTextureSpec *spec = NULL;
        const char *sampled = job->samples ? job->samples->textures[t] : "";
        for (int i = 0; i < count; i++)
            if (retex_set_find_target(job->set, specs[i].target) == t)
                spec = &specs[i];
        if (!spec && !sampled[0])
            continue;
        BatchTexture *texture = &textures[found++];
        texture->target = job->set->targets[t].name;
        if (spec)
            texture_args_name(spec, texture->texture, sizeof texture->texture);
        else
            snprintf(texture->texture, sizeof texture->texture, "%s", sampled);
    }
    return found;
}

static const char *describe(const Job *job, const Row *row, char *text, size_t size)
{
    BatchTexture textures[RETEX_MAX_TARGETS];
    const int count = describe_targets(job, row->specs, row->count, textures);
    size_t used = 0;
    for (int i = 0; i < count && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%s <- %s", i ? ", " : "", textures[i].target,
                                 textures[i].texture);
    return used ? text : "original textures";
}

static int write_rows(void *picture, int y0, int y1, const float *rows, RetexError *err)
{
    return retex_picture_rows(picture, y0, y1, rows, err);
}

/* The picture of the expected error while it is written. */
typedef struct ErrorPicture {
    RetexPicture *picture;
    double *squares; /* sum of squares of each band */
    size_t width;
} ErrorPicture;

static int write_error_rows(void *context, int y0, int y1, const float *rows, RetexError *err)
{
    ErrorPicture *error = context;
    const size_t count = 3 * error->width * (size_t)(y1 - y0);
    double *sum = &error->squares[y0 / RETEX_PICTURE_BAND];
    for (size_t i = 0; i < count; i++)
        *sum += (double)rows[i] * rows[i];
    return retex_picture_rows(error->picture, y0, y1, rows, err);
}

/* Compute and write the expected error; text gets its root mean square. */
static int make_error(const Cli *cli, Job *job, const Row *row, char *text, size_t size, RetexError *err)
{
    const int width = job->set->width, height = job->set->height;
    const int bands = (height + RETEX_PICTURE_BAND - 1) / RETEX_PICTURE_BAND;
    ErrorPicture error = {NULL, calloc((size_t)bands, sizeof *error.squares), (size_t)width};
    double squares = 0;
    int code = error.squares ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory to estimate the error");
    if (!code)
        code = retex_picture_open(&error.picture, job->error, width, height, 3, NULL, err);
    if (!code)
        code = retex_estimate_error(job->set, job->samples, row->textures, &job->combine, write_error_rows, &error,
                                    cli->threads, err);
    int closed = retex_picture_close(&error.picture, !code, code ? NULL : err);
    for (int i = 0; i < bands && error.squares; i++)
        squares += error.squares[i];
    free(error.squares);
    snprintf(text, size, ", expected error %.3g rms", sqrt(squares / (3.0 * width * height)));
    return code ? code : closed;
}

/* Compute and write one picture. The expected error is written first, and removed if the picture cannot be written, so
 * that neither is left alone. */
static int make_picture(const Cli *cli, Job *job, const Row *row, const char *output, double began, RetexError *err)
{
    RetexPicture *picture = NULL;
    struct stat old;
    char text[2048], expected[64] = "";
    int is_new = job->error && stat(job->error, &old) != 0;
    int code = job->error ? make_error(cli, job, row, expected, sizeof expected, err) : RETEX_OK;
    if (code)
        return code;
    watchdog_remove(is_new ? job->error : NULL);
    code = retex_picture_open(&picture, output, job->set->width, job->set->height, 3, &job->write, err);
    if (!code)
        code = retex_retexture(job->set, job->samples, row->textures, &job->combine, write_rows, picture, cli->threads,
                               err);
    int closed = retex_picture_close(&picture, !code, code ? NULL : err);
    code = code ? code : closed;
    if (code && is_new)
        unlink(job->error);
    watchdog_remove(NULL);
    if (code)
        return code;
    if (!cli->json_progress)
        cli_info(cli, "%s: %s, %d x %d%s, %.2f s", strcmp(output, "-") ? output : "standard output",
                 describe(job, row, text, sizeof text), job->set->width, job->set->height, expected,
                 retex_clock_seconds() - began);
    return RETEX_OK;
}

static int make_one(const Cli *cli, Job *job, const char *output, double began, RetexError *err)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    const Row row = {job->textures.specs, job->textures.count, textures};
    int code = retex_textures_load(textures, job->set, row.specs, row.count, cli->threads, err);
    if (!code) {
        cli_detail(cli, "ready after %.2f s", retex_clock_seconds() - began);
        code = make_picture(cli, job, &row, output, began, err);
    }
    if (!code && cli->json_progress) {
        fprintf(stderr, "{\"output\": ");
        json_text(stderr, output);
        fprintf(stderr, ", \"status\": \"made\", \"seconds\": %.4f, \"done\": 1, \"total\": 1}\n",
                retex_clock_seconds() - began);
    }
    retex_textures_close(textures);
    return code;
}

/* ---- --batch ---- */

/* Textures of the previous row, which the next row may use again. */
typedef struct Kept {
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count;
    RetexTexture *textures[RETEX_MAX_TARGETS]; /* by target */
} Kept;

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

/* Load the textures that the previous row did not have. `kept` then has the row's textures. */
static int load_row(const Cli *cli, const Job *job, Kept *kept, const RetexTextureSpec *specs, int count,
                    RetexError *err)
{
    Kept next = {.count = count};
    RetexTexture *loaded[RETEX_MAX_TARGETS] = {0};
    RetexTextureSpec missing[RETEX_MAX_TARGETS];
    int nmissing = 0;
    for (int i = 0; i < count; i++) {
        int k = 0, target = retex_set_find_target(job->set, specs[i].target);
        next.specs[i] = specs[i];
        while (k < kept->count && memcmp(&kept->specs[k], &specs[i], sizeof specs[i]) != 0)
            k++;
        if (k < kept->count && target >= 0) {
            next.textures[target] = kept->textures[target];
            kept->textures[target] = NULL;
        } else {
            missing[nmissing++] = specs[i];
        }
    }
    retex_textures_close(kept->textures);
    int code = retex_textures_load(loaded, job->set, missing, nmissing, cli->threads, err);
    for (int t = 0; t < RETEX_MAX_TARGETS; t++)
        if (loaded[t])
            next.textures[t] = loaded[t];
    if (code) { /* a texture failed: keep none of the row */
        retex_textures_close(next.textures);
        next.count = 0;
    }
    *kept = next;
    return code;
}

/* Replace the table's column names by the set's target names; 0 if some match no target. */
static int find_columns(TextureTable *table, const RetexSet *set)
{
    RetexTexture *textures[RETEX_MAX_TARGETS];
    int taken[RETEX_MAX_TARGETS] = {0};
    const int before = table->nmistakes;
    for (int i = 0; i < table->ncolumns; i++) {
        RetexError err = {0};
        RetexTextureSpec unknown = RETEX_TEXTURE_SPEC_INIT;
        int t = retex_set_find_target(set, table->columns[i]);
        if (t >= 0) {
            if (taken[t]++)
                texture_table_mistake(table, 1, "target '%s' has two columns", table->columns[i]);
            table->columns[i] = set->targets[t].name;
            continue;
        }
        snprintf(unknown.target, sizeof unknown.target, "%s", table->columns[i]);
        retex_textures_load(textures, set, &unknown, 1, 1, &err); /* makes the message, which lists the targets */
        texture_table_mistake(table, 1, "%s", err.message);
    }
    return table->nmistakes == before;
}

/* Check that the set supports these textures. Colours replace the images, so that nothing is loaded. */
static int check_row(void *context, const RetexTextureSpec *specs, int count, RetexError *err)
{
    const RetexSet *set = ((const Job *)context)->set;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexTextureSpec colors[RETEX_MAX_TARGETS];
    for (int i = 0; i < count; i++) {
        const int t = retex_set_find_target(set, specs[i].target);
        if (t >= 0 && retex_texture_spec_needs_scale(&specs[i]) && !(set->targets[t].uv_scale[0] > 0))
            return retex_fail(
                err, RETEX_EINVAL,
                "the size of target %s is not known: width= cannot be used on it, only scale=", set->targets[t].name);
        colors[i] = specs[i];
        colors[i].constant = 1;
        colors[i].warn = NULL; /* warnings come when it is loaded for the picture */
    }
    int code = retex_textures_load(textures, set, colors, count, 1, err);
    retex_textures_close(textures);
    return code;
}

static int describe_row(void *context, const RetexTextureSpec *specs, int count,
                        BatchTexture textures[RETEX_MAX_TARGETS])
{
    const Job *job = context;
    RetexTextureSpec all[RETEX_MAX_TARGETS];
    memcpy(all, specs, (size_t)count * sizeof *all);
    return describe_targets(job, all, complete_row(job, all, count), textures);
}

static int make_row(const Cli *cli, Job *job, int number, Kept *kept, RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    char path[PATH_MAX];
    const double began = retex_clock_seconds();
    const int count = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
    const Row row = {kept->specs, count, kept->textures};
    int code = load_row(cli, job, kept, specs, count, err);
    if (!code)
        code = batch_output(&job->batch, number, path, err);
    return code ? code : make_picture(cli, job, &row, path, began, err);
}

/* Which targets' corrections the pictures of a table use. */
static void find_corrected(const Job *job, int corrected[RETEX_MAX_TARGETS])
{
    memset(corrected, 0, RETEX_MAX_TARGETS * sizeof *corrected);
    for (int number = 0; number < job->batch.table.nrows; number++) {
        RetexTextureSpec specs[RETEX_MAX_TARGETS];
        int edited[RETEX_MAX_TARGETS] = {0}, count = 0;
        const int nspecs = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
        for (int t = 0; t < job->set->ntargets; t++)
            edited[t] = job->samples && job->samples->textures[t][0];
        for (int i = 0; i < nspecs; i++) {
            const int t = retex_set_find_target(job->set, specs[i].target);
            if (t >= 0)
                edited[t] = 1;
        }
        for (int t = 0; t < job->set->ntargets; t++)
            count += edited[t];
        for (int t = 0; t < job->set->ntargets && retex_correction_weight(job->set->ntargets, count) > 0; t++)
            corrected[t] |= edited[t];
    }
}

static int run_batch(const Cli *cli, Job *job)
{
    int corrected[RETEX_MAX_TARGETS];
    Batch *batch = &job->batch;
    RetexError err = {0};
    Kept kept = {.count = 0};
    batch_open(batch, cli, job->table);
    batch->tool = (BatchTool){job, find_columns(&batch->table, job->set) ? check_row : NULL, describe_row};
    batch->inputs_known = 1;
    batch_check(batch, &job->write);
    batch_refuse_mistakes(batch);
    if (batch->dry_run) {
        batch_print(batch);
        return batch_finish(batch, NULL);
    }
    find_corrected(job, corrected);
    if (retex_set_preload(job->set, job->samples, corrected, cli_memory(cli, job->memory), cli->threads, &err))
        return batch_finish(batch, &err);
    for (int number = 0; number < batch->table.nrows; number++) {
        const double began = retex_clock_seconds();
        int failed = make_row(cli, job, number, &kept, &err);
        if (!batch_done(batch, number, retex_clock_seconds() - began, failed ? &err : NULL))
            break;
    }
    retex_textures_close(kept.textures);
    return batch_finish(batch, NULL);
}

/* Keep freed memory in the process. Hundreds of bands are allocated and freed; the system would clear their memory each
 * time. */
static void keep_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, INT_MAX);
    mallopt(M_MMAP_THRESHOLD, 32 << 20); /* the maximum */
#endif
}

int main(int argc, char **argv)
{
    static Job job = {.write = RETEX_WRITE_INIT, .combine = RETEX_COMBINE_INIT, .memory = CLI_MEMORY_DEFAULT};
    Cli cli = {.tool = "retex-combine",
               .usage = "SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE",
               .about = "Make a picture from a set, with its original textures or new ones.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    double began = retex_clock_seconds();
    keep_memory();
    parse(&cli, &job);
    check_samples_path(&cli, &job);
    const char *output = job.table ? NULL : cli_output(&cli);
    int status = CLI_OK;
    RetexError err = {0};
    announce_files(&cli, &job, output);
    if (output) {
        if (retex_image_write_check(output, &job.write, &err))
            cli_fail(&cli, &err);
        if (job.error && retex_image_write_check(job.error, NULL, &err))
            cli_fail(&cli, &err);
        if ((job.write.display || job.write.view) && (strcmp(output, "-") == 0 || cli_ends_with(output, ".exr")))
            cli_warn(&cli, "an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would");
    }
    load(&cli, &job);
    if (job.table)
        status = run_batch(&cli, &job);
    else if (make_one(&cli, &job, output, began, &err))
        cli_fail(&cli, &err);
    retex_samples_close(&job.samples);
    retex_set_close(&job.set);
    return cli_close(&cli, status);
}
