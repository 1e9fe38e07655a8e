/* retex-combine: make a picture from a set, with its original textures or new ones. See retex-combine(1). */
#include <limits.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <string.h>

#include <retex/output_file.h>
#include "combine/job.h"

static void check(const Cli *cli, int code, const RetexError *err)
{
    if (code)
        cli_fail(cli, err);
}

static void take_light(Cli *cli, const CliOption *option, void *edit)
{
    (void)option;
    RetexError err = {0};
    check(cli, retex_edit_light(*(RetexEdit **)edit, cli->value, &err), &err);
}

static void take_finish(Cli *cli, const CliOption *option, void *edit)
{
    (void)option;
    RetexError err = {0};
    check(cli, retex_edit_finish(*(RetexEdit **)edit, cli->value, &err), &err);
}

static void take_solo(Cli *cli, const CliOption *option, void *edit)
{
    (void)option;
    RetexError err = {0};
    check(cli, retex_edit_solo(*(RetexEdit **)edit, cli->value, &err), &err);
}

static void take_depth(Cli *cli, const CliOption *option, void *to)
{
    const int depth = (int)cli_integer(cli, option, 8, 16);
    if (depth != 8 && depth != 16)
        cli_die(cli, "--depth: expected 8 or 16, not '%s'", cli->value);
    *(int *)to = depth;
}

static void take_cross(Cli *cli, const CliOption *option, void *to)
{
    const int cross = (int)cli_integer(cli, option, 0, 3);
    if (cross == 1)
        cli_die(cli, "--cross: expected 0, 2 or 3; one hit has no cross terms");
    *(int *)to = cross;
}

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE", "put IMAGE, a file or a colour, on target NAME; opts as in retex-sample", 1,
     CLI_CALL(Job, textures, texture_args_add)},
    {"light", 0, "NAME=VALUE", "give lamp NAME another brightness or colour: 0, 2.5, #ffd0a0, 3000K, 1.5*3000K", 0,
     CLI_CALL(Job, lights, take_light)},
    {"finish", 0, "TARGET=NAME", "give TARGET another of the finishes that the set has for it", 0,
     CLI_CALL(Job, lights, take_finish)},
    {"solo", 0, "NAME", "turn off all lamps but NAME, and those of --light", 0, CLI_CALL(Job, solo, take_solo)},
    {"size", 0, "WxH", "a smaller picture: of WxH pixels, or Wx or xH to keep the aspect", 0,
     CLI_CALL(Job, scaled, job_take_size)},
    {"crop", 0, "X,Y,W,H", "only this rectangle of the picture", 0, CLI_CALL(Job, crop, job_take_rectangle)},
    {"preset", 0, "FILE", "what --save-preset wrote: textures, lamps, finishes, exposure, view; options go first", 0,
     CLI_INTO(Job, preset)},
    {"save-preset", 0, "FILE", "write these options to a file, for --preset", 0, CLI_INTO(Job, save_preset)},
    {"exposure", 0, "STOPS", "make the picture brighter, by 2^STOPS; -30 to 30", 0, CLI_INTO(Job, exposure)},
    {"auto-exposure", 0, NULL, "bring the picture's mean brightness to a middle grey, before --exposure", 0,
     CLI_INTO(Job, auto_exposure)},
    {"white-balance", 0, "KELVINS", "make light of so many kelvins white, 1000 to 25000", 0,
     CLI_INTO(Job, white_balance)},
    {"display", 0, "NAME", "OCIO display for the picture", 0, CLI_INTO(Job, write.display)},
    {"view", 0, "NAME", "view of that display: Standard, Filmic, Neutral, Raw, or one of $OCIO", 0,
     CLI_INTO(Job, view)},
    {"colorspace", 0, "NAME", "write in this OCIO colour space instead", 0, CLI_INTO(Job, write.colorspace)},
    {"quality", 0, "N", "quality of a JPEG, 1 to 100; default 95", 0, CLI_NUMBER(Job, write.quality, 1, 100)},
    {"depth", 0, "8|16", "bits of a PNG, TIFF or other file of integers; default 8, of TIFF and DPX 16", 0,
     CLI_CALL(Job, write.depth, take_depth)},
    {"cross", 0, "0|2|3", "use cross terms of paths with at most this many hits; default 3", 0,
     CLI_CALL(Job, combine.cross, take_cross)},
    {"error", 0, "FILE.exr", "write the expected error against a new render, per pixel", 0, CLI_INTO(Job, error)},
    {"solve", 0, "FILE", "print which colours, lamps and finishes come nearest to a picture, or to a colour", 0,
     CLI_INTO(Job, solve)},
    {"free", 0, "LIST", "with --solve: what is sought, as TARGET,light:LAMP,color:LAMP,finish:TARGET", 0,
     CLI_INTO(Job, unknowns)},
    {"region", 0, "X,Y,W,H", "with --solve: only this part of the picture counts", 0,
     CLI_CALL(Job, region, job_take_rectangle)},
    {"batch", 0, "FILE.csv", "make one picture per row of a table: its file, then one texture per target", 0,
     CLI_INTO(Job, table)},
    {"memory", 0, "SIZE", "with --batch: keep the set and samples in memory if they take at most SIZE; default 2048 MB",
     0, CLI_INTO(Job, memory)},
    FRAMES_OPTION(Job, frames),
    BATCH_OPTIONS(Job, batch),
    BATCH_CATALOGUE_OPTIONS(Job, batch),
    CLI_PROGRESS_OPTION,
    {0},
};

/* How the picture is developed, as picture:NAME=VALUE; the last of a name holds. */
static void set_picture_keys(const Cli *cli, const Job *job)
{
    const struct {
        const char *key, *value;
    } keys[] = {{"picture:exposure", job->exposure},
                {"picture:white-balance", job->white_balance},
                {"picture:auto-exposure", job->auto_exposure ? "yes" : NULL},
                {"picture:view", job->view}};
    RetexError err = {0};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (keys[i].value)
            check(cli, retex_edit_set(job->lights, keys[i].key, keys[i].value, &err), &err);
}

static void parse(Cli *cli, Job *job)
{
    RetexError err = {0};
    check(cli, retex_edit_create(&job->lights, &err) || retex_edit_create(&job->solo, &err), &err);
    cli_parse(cli, job, CLI_ARGUMENTS(&job->set_path, &job->samples_path), "one set and its samples are enough");
    check(cli, retex_edit_complete_lights(job->lights, job->solo, &err), &err);
    retex_edit_close(&job->solo);
    set_picture_keys(cli, job);
    cli_writes(cli, "--save-preset", job->save_preset);
    if (job->save_preset)
        check(cli, retex_output_check(job->save_preset, &err), &err);
    if (job->preset)
        texture_args_add_preset(cli, job->textures.specs, &job->textures.count, job->lights, job->preset);
    check(cli, job_develop(job, job->lights, &err), &err);
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
    if (!job->solve && (job->unknowns || job->region[2]))
        cli_die(cli, "--free and --region belong to --solve");
    if (job->solve && (job->crop[2] || job->scaled[0] || job->scaled[1]))
        cli_die(cli, "--solve excludes --size and --crop; --region says which part counts");
    if (job->solve && (job->table || job->frames.step || job->error || job->save_preset))
        cli_die(cli, "--solve excludes --batch, --frames, --error and --save-preset");
    if (job->solve && (job->develop.exposure != 0 || job->develop.white_balance != 0 || job->develop.auto_exposure))
        cli_die(cli, "--solve excludes --exposure, --auto-exposure and --white-balance");
    if (job->solve && cli->output && strcmp(cli->output, "-") == 0)
        cli_die(cli, "with --solve, standard output has what is found: name a file with -o");
    if (job->write.colorspace && (job->write.display || job->write.view))
        cli_die(cli, "--colorspace excludes --display and --view");
}

static void warn_display(const Cli *cli, const Job *job)
{
    if (job->output && (job->write.display || job->write.view) &&
        (strcmp(job->output, "-") == 0 || cli_ends_with(job->output, ".exr")))
        cli_warn(cli, "an OpenEXR file stays scene-linear: --display and --view do nothing; --colorspace would");
}

static int make_single(const Cli *cli, Job *job, double began)
{
    RetexError err = {0};
    KeptTextures kept = {.nimages = 0};
    if (job_make(cli, job, &kept, began, &err))
        cli_fail(cli, &err);
    job_report(cli, job->output, began, 1, 1);
    kept_textures_close(&kept);
    return CLI_OK;
}

static void save_preset(const Cli *cli, const Job *job)
{
    RetexError err = {0};
    if (job->save_preset && texture_args_save_preset(&job->textures, job->lights, job->save_preset, &err))
        cli_fail(cli, &err);
}

/* Keep freed memory in the process. Hundreds of strips are allocated and freed; the system would clear their memory
 * each time. */
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
    if (!job.frames.step && job_check_samples(&cli, &job, &err))
        cli_fail(&cli, &err);
    job.output = job.table ? NULL : job.solve ? cli.output : cli_output(&cli);
    warn_display(&cli, &job);
    if (job.frames.step) {
        job_check_frames(&cli, &job);
        const int failed = job_run_frames(&cli, &job);
        if (!failed)
            save_preset(&cli, &job);
        return cli_close(&cli, failed);
    }
    job_announce(&cli, &job);
    if (job.output)
        job_check_output(&cli, &job);
    if (job_open(&cli, &job, &err))
        cli_fail(&cli, &err);
    int status = job.table   ? job_run_table(&cli, &job)
                 : job.solve ? job_solve(&cli, &job, began)
                             : make_single(&cli, &job, began);
    job_close(&job);
    if (status == CLI_OK)
        save_preset(&cli, &job);
    retex_edit_close(&job.lights);
    return cli_close(&cli, status);
}
