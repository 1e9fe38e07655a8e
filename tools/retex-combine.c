/* retex-combine: recombine a set, with its own textures or new ones, into a picture. See retex-combine(1). */
#include <errno.h>
#include <stdlib.h>

#include "texture_args.h"

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE", "put IMAGE, a file or rgb(r,g,b), on target NAME; opts as for retex-sample", 1},
    {"display", 0, "NAME", "OCIO display the picture is for", 0},
    {"view", 0, "NAME", "OCIO view of that display", 0},
    {"colorspace", 0, "NAME", "write in this OCIO colour space instead", 0},
    {"quality", 0, "N", "of a JPEG, 1 to 100; default 95", 0},
    {"cross", 0, "0|2|3", "use cross terms of paths with up to so many hits; default 3", 0},
    {"batch", 0, "FILE.csv", "one picture a row: its name, then one texture a target", 0},
    {0},
};

typedef struct Job {
    const char *set_path, *samples_path, *batch;
    TextureArgs textures;
    RetexWriteParams write;
    RetexCombineParams combine;
    RetexSet *set;
    RetexSamples *samples; /* of the whole run; NULL = all original */
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
    if (retex_sample(&more, job->set, job->textures.specs, job->textures.count, cli->threads, &err))
        cli_fail(cli, &err);
    if (!job->samples) {
        job->samples = more;
        return;
    }
    if (retex_samples_merge(job->samples, more, &err))
        cli_fail(cli, &err);
    retex_samples_close(&more);
}

/* One picture. */
static int make_picture(const Cli *cli, const Job *job, const RetexSamples *samples, const char *output, double began,
                        RetexError *err)
{
    RetexImage picture = {0};
    int code = retex_combine(&picture, job->set, samples, &job->combine, NULL, cli->threads, err);
    if (!code)
        code = retex_image_write(&picture, output, &job->write, err);
    retex_image_free(&picture);
    if (code)
        return code;
    char text[2048];
    cli_info(cli, "%s: %s, %d x %d, %.2f s", strcmp(output, "-") ? output : "standard output",
             texture_args_describe(samples, text, sizeof text), job->set->width, job->set->height,
             texture_args_now() - began);
    return RETEX_OK;
}

/* ---- --batch ---- */

/* A table of comma-separated values as RFC 4180 has it, read a record at a time from memory. */
typedef struct Table {
    const char *name;
    char *text, *at;
    int line;     /* of `at` */
    int row_line; /* where the record last read begins */
    char *cells[1 + RETEX_MAX_TARGETS];
    int ncells;
} Table;

static _Noreturn void fail_row(const Cli *cli, const Table *table, int code, const char *message)
{
    RetexError err = {0};
    retex_fail_at(&err, code, table->name, table->row_line, 0, "%s", message);
    cli_fail(cli, &err);
}

static char *read_text(const Cli *cli, const char *path)
{
    cli_input(cli, path, "a table");
    FILE *file = strcmp(path, "-") == 0 ? stdin : fopen(path, "rb");
    char *text = NULL;
    size_t used = 0, room = 0, got = 1;
    while (file && got > 0) {
        if (used + 1 >= room) {
            char *more = realloc(text, room = room ? 2 * room : 65536);
            if (!more)
                cli_die(cli, "not enough memory for %s", path);
            text = more;
        }
        got = fread(text + used, 1, room - used - 1, file);
        used += got;
    }
    if (!file || ferror(file))
        cli_die(cli, "%s: cannot read: %s", path, strerror(errno));
    if (file != stdin)
        fclose(file);
    text[used] = '\0';
    if (strlen(text) != used)
        cli_die(cli, "%s: not a table: it holds NUL bytes", path);
    return text;
}

/* Take one cell off the text, in place; quoted ones may hold commas, line ends and doubled quotes. */
static char *next_cell(const Cli *cli, Table *table)
{
    char *cell = table->at, *out = cell;
    if (*table->at != '"') {
        table->at += strcspn(table->at, ",\r\n");
        return cell;
    }
    for (table->at++;; table->at++) {
        if (*table->at == '\0')
            fail_row(cli, table, RETEX_EPARSE, "a quoted cell has no closing quote");
        if (*table->at == '"' && *++table->at != '"')
            break;
        table->line += *table->at == '\n';
        *out++ = *table->at;
    }
    if (*table->at && !strchr(",\r\n", *table->at))
        fail_row(cli, table, RETEX_EPARSE, "something follows a closing quote");
    if (out < table->at)
        *out = '\0';
    return cell;
}

/* The next record that is not an empty line; 0 at the end. */
static int next_row(const Cli *cli, Table *table)
{
    while (*table->at == '\r' || *table->at == '\n')
        table->line += *table->at++ == '\n';
    if (!*table->at)
        return 0;
    table->row_line = table->line;
    table->ncells = 0;
    for (;;) {
        if (table->ncells == 1 + RETEX_MAX_TARGETS)
            fail_row(cli, table, RETEX_EPARSE, "too many cells");
        table->cells[table->ncells++] = next_cell(cli, table);
        char end = *table->at;
        if (end)
            *table->at++ = '\0';
        if (end == ',')
            continue;
        if (end == '\r' && *table->at == '\n')
            table->at++;
        table->line += end != '\0';
        return 1;
    }
}

/* A cell: IMAGE, rgb(r,g,b), or `:opts IMAGE`. */
static void parse_cell(const Cli *cli, const Table *table, RetexTextureSpec *spec, const char *target, char *cell)
{
    RetexError err = {0};
    const char *opts = "";
    char argument[sizeof spec->target + sizeof spec->image + 2];
    if (*cell == ':') {
        char *space = strchr(cell, ' ');
        if (!space)
            fail_row(cli, table, RETEX_EPARSE, "options without an image; expected `:scale=2 IMAGE`");
        *space = '\0';
        opts = cell + 1;
        cell = space + 1 + strspn(space + 1, " ");
    }
    if (snprintf(argument, sizeof argument, "%s=%s", target, cell) >= (int)sizeof argument)
        fail_row(cli, table, RETEX_EPARSE, "the image's name is too long");
    if (retex_texture_spec_parse(spec, opts, argument, &err))
        fail_row(cli, table, err.code, err.message);
}

/* The header: `output`, then targets. */
static int read_header(const Cli *cli, Table *table, const RetexSet *set, const char *targets[RETEX_MAX_TARGETS])
{
    table->row_line = 1;
    if (!next_row(cli, table) || strcmp(table->cells[0], "output") != 0)
        fail_row(cli, table, RETEX_EPARSE, "the first row must name the columns: output, then targets");
    int columns = table->ncells - 1, taken[RETEX_MAX_TARGETS] = {0};
    for (int i = 0; i < columns; i++) {
        int t = retex_set_find_target(set, table->cells[1 + i]);
        if (t < 0 || taken[t]++) {
            char message[512];
            snprintf(message, sizeof message,
                     t < 0 ? "the set has no target '%.200s'" : "target '%.200s' has two columns", table->cells[1 + i]);
            fail_row(cli, table, t < 0 ? RETEX_ENOTFOUND : RETEX_EPARSE, message);
        }
        targets[i] = set->targets[t].name;
    }
    return columns;
}

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

/* An error of a row's picture: the table's line, then the file it was in. */
static _Noreturn void fail_picture(const Cli *cli, const Table *table, const RetexError *err)
{
    char message[1600];
    snprintf(message, sizeof message, "%s%s%s", err->file, err->file[0] ? ": " : "", err->message);
    fail_row(cli, table, err->code, message);
}

static void run_batch(const Cli *cli, const Job *job)
{
    Table table = {.name = strcmp(job->batch, "-") ? job->batch : "standard input", .line = 1};
    const char *targets[RETEX_MAX_TARGETS];
    table.text = read_text(cli, job->batch);
    table.at = table.text + (strncmp(table.text, "\xef\xbb\xbf", 3) == 0 ? 3 : 0); /* a byte order mark */
    int columns = read_header(cli, &table, job->set, targets), pictures = 0;
    double first = texture_args_now();
    while (next_row(cli, &table)) {
        RetexTextureSpec specs[RETEX_MAX_TARGETS];
        RetexSamples *row = NULL;
        RetexError err = {0};
        int count = 0;
        double began = texture_args_now();
        if (table.ncells > 1 + columns)
            fail_row(cli, &table, RETEX_EPARSE, "more cells than the first row has");
        if (!*table.cells[0])
            fail_row(cli, &table, RETEX_EPARSE, "no output in the first cell");
        if (strcmp(table.cells[0], "-") == 0)
            fail_row(cli, &table, RETEX_EPARSE, "a table cannot write to standard output");
        check_output(cli, job, table.cells[0]);
        if (retex_image_write_check(table.cells[0], &job->write, &err))
            fail_picture(cli, &table, &err);
        for (int i = 1; i < table.ncells; i++)
            if (*table.cells[i])
                parse_cell(cli, &table, &specs[count++], targets[i - 1], table.cells[i]);
        for (int i = 0; i < count; i++)
            if (!specs[i].constant)
                texture_args_check_output(cli, specs[i].image, table.cells[0]);
        int code = retex_sample(&row, job->set, specs, count, cli->threads, &err);
        if (!code)
            code = make_row(cli, job, row, table.cells[0], began, &err);
        if (code)
            fail_picture(cli, &table, &err);
        retex_samples_close(&row);
        pictures++;
    }
    free(table.text);
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
    retex_set_close(&job.set);
    return cli_close(&cli, CLI_OK);
}
