/* retex-combine: recombine a set, with its own textures or new ones, into a picture. See retex-combine(1). */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "texture_args.h"
#include "texture_table.h"

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE", "put IMAGE, a file or rgb(r,g,b), on target NAME; opts as for retex-sample", 1},
    {"display", 0, "NAME", "OCIO display the picture is for", 0},
    {"view", 0, "NAME", "OCIO view of that display", 0},
    {"colorspace", 0, "NAME", "write in this OCIO colour space instead", 0},
    {"quality", 0, "N", "of a JPEG, 1 to 100; default 95", 0},
    {"cross", 0, "0|2|3", "use cross terms of paths with up to so many hits; default 3", 0},
    {"error", 0, "FILE.exr", "write the error to be expected against rendering again, per pixel", 0},
    {"batch", 0, "FILE.csv", "one picture a row: its name, then one texture a target", 0},
    {0},
};

typedef struct Job {
    const char *set_path, *samples_path, *batch, *error;
    TextureArgs textures;
    RetexWriteParams write;
    RetexCombineParams combine;
    RetexSet *set;
    RetexSamples *samples;   /* of the whole run; NULL = all original */
    RetexSamples *variances; /* of the textures within the footprints, for --error */
} Job;

static void parse(Cli *cli, Job *job)
{
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option == &cli_positional) {
            if (job->samples_path)
                cli_die(cli, "one set and its samples are enough; what is '%s'?", cli->value);
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
        } else {
            job->batch = cli->value;
        }
    }
    if (!job->set_path)
        cli_die(cli, "no set given; - is standard input");
    if (job->samples_path && strcmp(job->set_path, "-") == 0 && strcmp(job->samples_path, "-") == 0)
        cli_die(cli, "the set and the samples cannot both be standard input");
    if (job->batch && strcmp(job->batch, "-") == 0 &&
        (strcmp(job->set_path, "-") == 0 || (job->samples_path && strcmp(job->samples_path, "-") == 0)))
        cli_die(cli, "the set or the samples and the table cannot both be standard input");
    if (job->batch && cli->output)
        cli_die(cli, "--batch names its outputs itself: no -o");
    if (job->error && job->batch)
        cli_die(cli, "--error is of one picture: no --batch");
    if (job->error && !job->textures.count)
        cli_die(cli, "--error needs the textures: name them with --texture");
    if (job->write.colorspace && (job->write.display || job->write.view))
        cli_die(cli, "--colorspace excludes --display and --view");
}

/* The picture must not replace what it is made of. */
static void check_output(const Cli *cli, const Job *job, const char *output)
{
    texture_args_check_output(cli, job->set_path, output);
    if (job->samples_path)
        texture_args_check_output(cli, job->samples_path, output);
    texture_args_check_outputs(cli, &job->textures, output);
}

/* The folder that a file is or would be in. */
static int stat_folder(const char *path, struct stat *folder)
{
    char name[4096];
    const char *slash = strrchr(path, '/');
    int length = slash == path ? 1 : slash ? (int)(slash - path) : 0;
    if (!length)
        return stat(".", folder);
    return snprintf(name, sizeof name, "%.*s", length, path) < (int)sizeof name ? stat(name, folder) : -1;
}

static const char *base_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* Whether two outputs, which need not be there yet, are one file. */
static int is_same_output(const char *a, const char *b)
{
    struct stat x, y;
    if (strcmp(a, b) == 0)
        return 1;
    if (strcmp(a, "-") == 0 || strcmp(b, "-") == 0)
        return 0;
    int there = stat(a, &x) == 0, also_there = stat(b, &y) == 0;
    if (there != also_there)
        return 0;
    if (!there && (strcmp(base_name(a), base_name(b)) != 0 || stat_folder(a, &x) || stat_folder(b, &y)))
        return 0;
    return x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* The error's file must replace nothing either, the picture included. */
static void check_error_output(const Cli *cli, const Job *job, const char *output)
{
    RetexError err = {0};
    check_output(cli, job, job->error);
    if (is_same_output(job->error, output))
        cli_die(cli, "the picture and --error are the same file");
    if (retex_image_write_check(job->error, NULL, &err))
        cli_fail(cli, &err);
}

/* The set, and the samples of the whole run: from the stream or a file, and from --texture. */
static void load(const Cli *cli, Job *job)
{
    RetexError err = {0};
    cli_input(cli, job->set_path, "a set, as from retex-render or retex-sample");
    if (retex_set_read(job->set_path, &job->set, job->samples_path ? NULL : &job->samples, cli->threads, &err))
        cli_fail(cli, &err);
    if (!job->set)
        cli_die(cli, "%s holds samples but no set", job->set_path);
    if (job->samples_path) {
        cli_input(cli, job->samples_path, "samples, as from retex-sample");
        if (retex_set_read(job->samples_path, NULL, &job->samples, cli->threads, &err))
            cli_fail(cli, &err);
        if (!job->samples)
            cli_die(cli, "%s holds no samples", job->samples_path);
        if (retex_samples_check(job->samples, job->set, &err))
            cli_fail(cli, &err);
    }
    if (!job->textures.count)
        return;
    RetexSamples *more = NULL;
    if (retex_sample_with_variances(&more, job->error ? &job->variances : NULL, job->set, job->textures.specs,
                                    job->textures.count, cli->threads, &err))
        cli_fail(cli, &err);
    if (!job->samples) {
        job->samples = more;
        return;
    }
    if (retex_samples_merge(job->samples, more, &err))
        cli_fail(cli, &err);
    retex_samples_close(&more);
}

/* Write the error to be expected; text says it in numbers. */
static int make_error(const Cli *cli, const Job *job, const RetexSamples *samples, char *text, size_t size,
                      RetexError *err)
{
    RetexImage error = {0};
    double squares = 0;
    int code = retex_estimate_error(&error, job->set, samples, job->variances, &job->combine, NULL, cli->threads, err);
    size_t count = 3 * (size_t)error.width * (size_t)error.height;
    for (size_t i = 0; !code && i < count; i++)
        squares += (double)error.pixels[i] * error.pixels[i];
    if (!code)
        snprintf(text, size, ", expected error %.3g rms", sqrt(squares / (double)count));
    if (!code)
        code = retex_image_write(&error, job->error, NULL, err);
    retex_image_free(&error);
    return code;
}

/* One picture. The error to be expected comes first, and goes again where the picture cannot be written: neither stays
 * alone. */
static int make_picture(const Cli *cli, const Job *job, const RetexSamples *samples, const char *output, double began,
                        RetexError *err)
{
    RetexImage picture = {0};
    struct stat old;
    char text[2048], expected[64] = "";
    int is_new = job->error && stat(job->error, &old) != 0;
    int code = retex_combine(&picture, job->set, samples, &job->combine, NULL, cli->threads, err);
    if (!code && job->error)
        code = make_error(cli, job, samples, expected, sizeof expected, err);
    if (!code) {
        code = retex_image_write(&picture, output, &job->write, err);
        if (code && is_new)
            unlink(job->error);
    }
    retex_image_free(&picture);
    if (code)
        return code;
    cli_info(cli, "%s: %s, %d x %d%s, %.2f s", strcmp(output, "-") ? output : "standard output",
             texture_args_describe(samples, text, sizeof text), job->set->width, job->set->height, expected,
             texture_args_now() - began);
    return RETEX_OK;
}

/* ---- --batch ---- */

/* Samples of a row and, where it says nothing, those of the whole run, whose images are only borrowed. */
static int make_row(const Cli *cli, const Job *job, RetexSamples *row, const char *output, double began,
                    RetexError *err)
{
    const RetexSamples *common = job->samples;
    char *borrowed = calloc((size_t)row->nimages + 1, 1);
    if (!borrowed)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory");
    for (int i = 0; common && i < row->nimages; i++)
        if (!row->images[i].pixels && common->images[i].pixels) {
            row->images[i] = common->images[i];
            borrowed[i] = 1;
        }
    for (int t = 0; common && t < row->ntargets; t++)
        if (!row->textures[t][0])
            memcpy(row->textures[t], common->textures[t], sizeof row->textures[t]);
    int code = make_picture(cli, job, row, output, began, err);
    for (int i = 0; i < row->nimages; i++)
        if (borrowed[i])
            row->images[i] = (RetexImage){0};
    free(borrowed);
    return code;
}

/* The set's own names for the table's columns. */
static void find_columns(const Cli *cli, TextureTable *table, const RetexSet *set)
{
    int taken[RETEX_MAX_TARGETS] = {0};
    for (int i = 0; i < table->ncolumns; i++) {
        int t = retex_set_find_target(set, table->columns[i]);
        if (t < 0 || taken[t]++) {
            char message[512];
            snprintf(message, sizeof message,
                     t < 0 ? "the set has no target '%.200s'" : "target '%.200s' has two columns", table->columns[i]);
            texture_table_fail(table, cli, t < 0 ? RETEX_ENOTFOUND : RETEX_EPARSE, message);
        }
        table->columns[i] = set->targets[t].name;
    }
}

static void run_batch(const Cli *cli, const Job *job)
{
    TextureTable table;
    texture_table_open(&table, cli, job->batch);
    find_columns(cli, &table, job->set);
    const char *output;
    RetexTextureSpec specs[RETEX_MAX_TARGETS];
    int count, pictures = 0;
    double first = texture_args_now(), began = first;
    while (texture_table_row(&table, cli, &output, specs, &count)) {
        RetexSamples *row = NULL;
        RetexError err = {0};
        check_output(cli, job, output);
        if (retex_image_write_check(output, &job->write, &err))
            texture_table_fail_picture(&table, cli, &err);
        for (int i = 0; i < count; i++)
            if (!specs[i].constant)
                texture_args_check_output(cli, specs[i].image, output);
        int code = retex_sample(&row, job->set, specs, count, cli->threads, &err);
        if (!code)
            code = make_row(cli, job, row, output, began, &err);
        if (code)
            texture_table_fail_picture(&table, cli, &err);
        retex_samples_close(&row);
        pictures++;
        began = texture_args_now();
    }
    texture_table_close(&table);
    cli_info(cli, "%d picture%s, %.2f s", pictures, pictures == 1 ? "" : "s", texture_args_now() - first);
}

int main(int argc, char **argv)
{
    static Job job = {.write = RETEX_WRITE_INIT, .combine = RETEX_COMBINE_INIT};
    Cli cli = {.tool = "retex-combine",
               .usage = "SET [SAMPLES] [--texture[:opts] NAME=IMAGE ...] -o FILE",
               .about = "Recombine a set, with its own textures or new ones, into a picture.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    double began = texture_args_now();
    parse(&cli, &job);
    const char *output = job.batch ? NULL : cli_output(&cli);
    RetexError err = {0};
    if (output) {
        check_output(&cli, &job, output);
        if (retex_image_write_check(output, &job.write, &err))
            cli_fail(&cli, &err);
        if (job.error)
            check_error_output(&cli, &job, output);
        if ((job.write.display || job.write.view) && (strcmp(output, "-") == 0 || cli_ends_with(output, ".exr")))
            cli_warn(&cli, "an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would");
    }
    load(&cli, &job);
    cli_detail(&cli, "read and sampled in %.2f s", texture_args_now() - began);
    if (job.batch)
        run_batch(&cli, &job);
    else if (make_picture(&cli, &job, job.samples, output, began, &err))
        cli_fail(&cli, &err);
    retex_samples_close(&job.samples);
    retex_samples_close(&job.variances);
    retex_set_close(&job.set);
    return cli_close(&cli, CLI_OK);
}
