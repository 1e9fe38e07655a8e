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
#include "frames.h"
#include "json_text.h"
#include "kept_textures.h"
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
    FRAMES_OPTION,
    BATCH_OPTIONS,
    BATCH_CATALOGUE_OPTIONS,
    CLI_PROGRESS_OPTION,
    {0},
};

typedef struct Job {
    const char *set_path, *samples_path, *table, *error;
    const char *output;
    FrameRange frames;
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
        } else if (strcmp(option->name, "frames") == 0) {
            frames_take(cli, option, &job->frames);
        } else if (!batch_option(&job->batch, cli, option) && !batch_catalogue_option(&job->batch, cli, option)) {
            cli_take_progress(cli);
        }
    }
    if (!job->set_path)
        cli_die(cli, "no set given; - is standard input");
    const int keep_going = job->batch.keep_going;
    if (job->frames.step && job->table)
        cli_die(cli, "--frames and --batch exclude each other");
    job->batch.keep_going &= !job->frames.step; /* which frames have as well */
    if (!job->table)
        batch_check_options(&job->batch, cli, "batch");
    job->batch.keep_going = keep_going;
    batch_check_catalogue_options(&job->batch, cli, job->table != NULL,
                                  !strcmp(job->set_path, "-") ||
                                      (job->samples_path && !strcmp(job->samples_path, "-")));
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
static void announce_files(const Cli *cli, const Job *job)
{
    cli_reads(cli, "the set", job->set_path);
    cli_reads(cli, "the samples", job->samples_path);
    cli_reads(cli, "the table", job->table);
    texture_args_reads(cli, job->textures.specs, job->textures.count);
    cli_writes(cli, "the output", job->output);
    cli_writes(cli, "--error", job->error);
}

/* The samples cannot be read. The message asks whether -o or --texture is missing before the name. */
static int fail_samples(const Cli *cli, const Job *job, const RetexError *why, RetexError *err)
{
    char forgotten[1024] = "";
    if (!job->table && strcmp(job->samples_path, job->set_path) != 0)
        cli_forgotten(cli, job->samples_path, forgotten, sizeof forgotten);
    return retex_fail(err, why->code, "%.900s%.100s", why->message, forgotten);
}

static int check_samples_path(const Cli *cli, const Job *job, RetexError *err)
{
    RetexError why = {0};
    struct stat info;
    if (!job->samples_path || strcmp(job->samples_path, "-") == 0 || stat(job->samples_path, &info) == 0)
        return RETEX_OK;
    retex_fail(&why, RETEX_EIO, "cannot read %s: %s", job->samples_path, strerror(errno));
    return fail_samples(cli, job, &why, err);
}

static int load_samples(const Cli *cli, Job *job, RetexError *err)
{
    RetexError why = {0};
    cli_input(cli, job->samples_path, "samples, as from retex-sample");
    int code = retex_set_open(job->samples_path, NULL, &job->samples, cli->threads, &why);
    if (!code && !job->samples)
        code = retex_fail(&why, RETEX_EINVAL, "%s holds no samples", job->samples_path);
    return code ? fail_samples(cli, job, &why, err) : retex_samples_check(job->samples, job->set, err);
}

/* Open the set, and the samples from the same stream or from a separate file. */
static int load(const Cli *cli, Job *job, RetexError *err)
{
    cli_input(cli, job->set_path, "a set, as from retex-render or retex-sample");
    int code = retex_set_open(job->set_path, &job->set, job->samples_path ? NULL : &job->samples, cli->threads, err);
    if (!code && !job->set)
        code = retex_fail(err, RETEX_EINVAL, "%s holds samples but no set", job->set_path);
    if (code)
        return code;
    cli_check_pixels(cli, job->set, job->set_path);
    return job->samples_path ? load_samples(cli, job, err) : RETEX_OK;
}

static void unload(Job *job)
{
    retex_samples_close(&job->samples);
    retex_set_close(&job->set);
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

/* One line of JSON about a picture that was made. */
static void report_progress(const Cli *cli, const char *output, double began, int done, int total)
{
    if (!cli->json_progress)
        return;
    fprintf(stderr, "{\"output\": ");
    json_text(stderr, output);
    fprintf(stderr, ", \"status\": \"made\", \"seconds\": %.4f, \"done\": %d, \"total\": %d}\n",
            retex_clock_seconds() - began, done, total);
}

/* Make the picture of a job whose set is open. */
static int make_one(const Cli *cli, Job *job, KeptTextures *kept, double began, RetexError *err)
{
    const Row row = {job->textures.specs, job->textures.count, kept->textures};
    int code = kept_textures_load(kept, job->set, row.specs, row.count, cli->threads, err);
    if (!code) {
        cli_detail(cli, "ready after %.2f s", retex_clock_seconds() - began);
        code = make_picture(cli, job, &row, job->output, began, err);
    }
    return code;
}

static void warn_display(const Cli *cli, const Job *job)
{
    if (job->output && (job->write.display || job->write.view) &&
        (strcmp(job->output, "-") == 0 || cli_ends_with(job->output, ".exr")))
        cli_warn(cli, "an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would");
}

/* Check that a picture can be written. */
static void check_output(const Cli *cli, const Job *job)
{
    RetexError err = {0};
    if (retex_image_write_check(job->output, &job->write, &err))
        cli_fail(cli, &err);
    if (job->error && retex_image_write_check(job->error, NULL, &err))
        cli_fail(cli, &err);
}

static int make_single(const Cli *cli, Job *job, double began)
{
    RetexError err = {0};
    KeptTextures kept = {.count = 0};
    if (make_one(cli, job, &kept, began, &err))
        cli_fail(cli, &err);
    report_progress(cli, job->output, began, 1, 1);
    kept_textures_close(&kept);
    return CLI_OK;
}

/* ---- --batch ---- */

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

static int complete(void *job, RetexTextureSpec specs[RETEX_MAX_TARGETS], int count)
{
    return complete_row(job, specs, count);
}

/* trial: a file to write instead of the row's output, or NULL. */
static int make_row(const Cli *cli, Job *job, int number, KeptTextures *kept, const char *trial, RetexError *err)
{
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    char path[PATH_MAX];
    const double began = retex_clock_seconds();
    const int count = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
    const Row row = {kept->specs, count, kept->textures};
    int code = kept_textures_load(kept, job->set, specs, count, cli->threads, err);
    if (!code && !trial)
        code = batch_output(&job->batch, number, path, err);
    return code ? code : make_picture(cli, job, &row, trial ? trial : path, began, err);
}

/* Make the picture of a row, look at its size and time, and remove it. */
static int try_row(const Cli *cli, Job *job, int number, KeptTextures *kept, double *bytes, double *seconds,
                   RetexError *err)
{
    Cli silent = *cli;
    char path[PATH_MAX];
    const char *folder = getenv("TMPDIR"), *ending = strrchr(texture_table_output(&job->batch.table, number), '.');
    const double began = retex_clock_seconds();
    silent.quiet = 1;
    snprintf(path, sizeof path, "%s/retex-plan-%ld%s", folder && *folder ? folder : "/tmp", (long)getpid(),
             ending ? ending : "");
    int code = make_row(&silent, job, number, kept, path, err);
    *seconds += retex_clock_seconds() - began;
    *bytes += cli_file_size(path);
    if (!code)
        unlink(path);
    return code;
}

/* --plan: make trial pictures from all over the table. The first one is made twice, because it also takes the time to
 * load libraries. */
static int plan(const Cli *cli, Job *job, KeptTextures *kept)
{
    enum { TRIALS = 4 };
    Batch *batch = &job->batch;
    RetexError err = {0};
    double bytes = 0, seconds = 0, ignored = 0;
    const int wanted = batch->end - batch->first - batch->kept, trials = wanted < TRIALS ? wanted : TRIALS;
    int code = RETEX_OK, made = 0, at = 0;
    for (int row = batch->first; row < batch->end && made < trials && !code; row++) {
        if (!batch_is_wanted(batch, row) || at++ < (int)((long)made * wanted / trials))
            continue;
        code = made ? RETEX_OK : try_row(cli, job, row, kept, &ignored, &ignored, &err);
        if (!code)
            code = try_row(cli, job, row, kept, &bytes, &seconds, &err);
        made++;
    }
    if (!code)
        batch_print_plan(batch, made, bytes, seconds);
    return batch_finish(batch, code ? &err : NULL);
}

/* The options that change pictures, in words, for the manifest. */
static const char *describe_options(const Job *job, char *text, size_t size)
{
    const RetexWriteParams *write = &job->write;
    const char *config = getenv("OCIO");
    RetexFileSum sum = {0};
    RetexError err = {0};
    if (config && *config)
        (void)retex_file_sum(&sum, config, NULL, &err); /* one that cannot be read is an error of the pictures */
    snprintf(text, size, "quality=%d cross=%d display=%s view=%s colorspace=%s ocio=%08x", write->quality,
             job->combine.cross, write->display ? write->display : "", write->view ? write->view : "",
             write->colorspace ? write->colorspace : "", (unsigned)sum.crc);
    return text;
}

/* Add the targets whose corrections a picture with these textures uses. */
static void add_corrected(const Job *job, const RetexTextureSpec *specs, int nspecs, int corrected[RETEX_MAX_TARGETS])
{
    int edited[RETEX_MAX_TARGETS] = {0}, count = 0;
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

/* Which targets' corrections the pictures of a table use. */
static void find_corrected(const Job *job, int corrected[RETEX_MAX_TARGETS])
{
    for (int number = 0; number < job->batch.table.nrows; number++) {
        RetexTextureSpec specs[RETEX_MAX_TARGETS];
        if (!batch_is_wanted(&job->batch, number))
            continue;
        const int nspecs = complete_row(job, specs, texture_table_textures(&job->batch.table, number, specs));
        add_corrected(job, specs, nspecs, corrected);
    }
}

static int run_batch(const Cli *cli, Job *job)
{
    int corrected[RETEX_MAX_TARGETS] = {0};
    Batch *batch = &job->batch;
    RetexError err = {0};
    KeptTextures kept = {.count = 0};
    char options_text[1024];
    batch_open(batch, cli, job->table);
    batch->tool = (BatchTool){job, find_columns(&batch->table, job->set) ? check_row : NULL, complete, describe_row};
    batch->sources.set = job->set_path, batch->sources.samples = job->samples_path;
    batch->sources.options = describe_options(job, options_text, sizeof options_text);
    batch->inputs_known = 1;
    batch_check(batch, &job->write);
    batch_refuse_mistakes(batch);
    if (batch_prepare(batch, &err))
        return batch_finish(batch, &err);
    if (batch_only_verifies(batch)) {
        const int status = batch_print_verdict(batch), failed = batch_finish(batch, NULL);
        return failed ? failed : status;
    }
    if (batch->dry_run) {
        batch_print(batch);
        return batch_finish(batch, NULL);
    }
    find_corrected(job, corrected);
    if (batch->kept < batch->end - batch->first &&
        retex_set_preload(job->set, job->samples, corrected, cli_memory(cli, job->memory), cli->threads, &err))
        return batch_finish(batch, &err);
    if (batch->plan) {
        const int status = plan(cli, job, &kept);
        kept_textures_close(&kept);
        return status;
    }
    for (int number = batch->first; number < batch->end; number++) {
        const double began = retex_clock_seconds();
        if (!batch_is_wanted(batch, number))
            continue;
        int failed = make_row(cli, job, number, &kept, NULL, &err);
        if (!batch_done(batch, number, retex_clock_seconds() - began, failed ? &err : NULL))
            break;
    }
    kept_textures_close(&kept);
    return batch_finish(batch, NULL);
}

/* ---- --frames ---- */

/* Whether all frames have the same set and samples, which then stay open. */
static int has_one_set(const Job *job)
{
    return !frames_has_number(job->set_path) && !(job->samples_path && frames_has_number(job->samples_path));
}

static void check_names(const Cli *cli, const Job *job)
{
    frames_check_count(cli, &job->frames);
    frames_check_name(cli, &job->frames, "the set", job->set_path, 0);
    frames_check_name(cli, &job->frames, "the samples", job->samples_path, 0);
    frames_check_name(cli, &job->frames, "the output", job->output, 1);
    frames_check_name(cli, &job->frames, "--error", job->error, 1);
    texture_args_check_frames(cli, &job->frames, "--texture", job->textures.specs, job->textures.count);
}

/* The job of one frame. */
static Job *open_frame(const Cli *cli, const Job *all, int frame)
{
    Job *job = malloc(sizeof *job);
    if (!job)
        cli_die(cli, "not enough memory for a frame");
    *job = *all;
    job->set_path = frames_name(cli, all->set_path, frame);
    job->samples_path = frames_name(cli, all->samples_path, frame);
    job->output = frames_name(cli, all->output, frame);
    job->error = frames_name(cli, all->error, frame);
    texture_args_set_frame(cli, frame, job->textures.specs, job->textures.count);
    return job;
}

static void close_frame(Job *job)
{
    free((char *)job->set_path), free((char *)job->samples_path);
    free((char *)job->output), free((char *)job->error);
    free(job);
}

/* Before the first frame: check the files of all. */
static void check_frames(Cli *cli, const Job *job)
{
    check_names(cli, job);
    FOR_FRAMES(number, job->frames)
    {
        Job *frame = open_frame(cli, job, number);
        cli_set_frame(cli, number);
        announce_files(cli, frame);
        check_output(cli, frame);
        close_frame(frame);
    }
    cli_set_frame(cli, -1);
}

static int make_frame(const Cli *cli, Job *job, int one_set, KeptTextures *kept, RetexError *err)
{
    const double began = retex_clock_seconds();
    int code = one_set ? RETEX_OK : load(cli, job, err);
    if (!code)
        code = check_row(job, job->textures.specs, job->textures.count, err);
    if (!code)
        code = make_one(cli, job, kept, began, err);
    if (!one_set)
        unload(job);
    return code;
}

/* As a batch, stop at a frame that fails, unless --keep-going. */
static int run_frames(Cli *cli, Job *job)
{
    const double began = retex_clock_seconds();
    const int total = frames_count(&job->frames), one_set = has_one_set(job);
    KeptTextures kept = {.count = 0};
    RetexError err = {0};
    int corrected[RETEX_MAX_TARGETS] = {0}, made = 0, failed = 0;
    if (one_set && load(cli, job, &err))
        cli_fail(cli, &err);
    if (one_set)
        add_corrected(job, job->textures.specs, job->textures.count, corrected);
    if (one_set &&
        retex_set_preload(job->set, job->samples, corrected, cli_memory(cli, job->memory), cli->threads, &err))
        cli_fail(cli, &err);
    for (int number = job->frames.first; number <= job->frames.last && (!failed || job->batch.keep_going);
         number += job->frames.step) {
        const double started = retex_clock_seconds();
        Job *frame = open_frame(cli, job, number);
        cli_set_frame(cli, number);
        if (make_frame(cli, frame, one_set, &kept, &err))
            cli_error(cli, &err), failed++;
        else
            report_progress(cli, frame->output, started, ++made, total);
        close_frame(frame);
    }
    cli_set_frame(cli, -1);
    kept_textures_close(&kept);
    unload(job);
    if (failed && job->batch.keep_going)
        frames_tell_failed(cli, failed, total);
    if (!failed && !cli->json_progress)
        cli_info(cli, "%d frame%s, %.2f s", total, total == 1 ? "" : "s", retex_clock_seconds() - began);
    return failed ? CLI_FAIL : CLI_OK;
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
    RetexError err = {0};
    parse(&cli, &job);
    if (!job.frames.step && check_samples_path(&cli, &job, &err))
        cli_fail(&cli, &err);
    job.output = job.table ? NULL : cli_output(&cli);
    warn_display(&cli, &job);
    if (job.frames.step) {
        check_frames(&cli, &job);
        return cli_close(&cli, run_frames(&cli, &job));
    }
    announce_files(&cli, &job);
    if (job.output)
        check_output(&cli, &job);
    if (load(&cli, &job, &err))
        cli_fail(&cli, &err);
    int status = job.table ? run_batch(&cli, &job) : make_single(&cli, &job, began);
    unload(&job);
    return cli_close(&cli, status);
}
