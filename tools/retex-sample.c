/* retex-sample: filter new textures at a set's footprints. See retex-sample(1). */
#include <retex/output_file.h>
#include "common/kept_textures.h"
#include "common/picture_kind.h"
#include "common/set_kind.h"
#include "common/texture_args.h"

typedef struct Job {
    const char *set, *preset, *output;
    TextureArgs textures;
    FrameRange frames;
    int keep_going, refer;
} Job;

static const CliOption options[] = {
    {"texture", 0, "NAME=IMAGE", "put IMAGE, a file or a colour, on target NAME; opts: " CLI_TEXTURE_OPTS, 1,
     CLI_CALL(Job, textures, texture_args_add)},
    {"preset", 0, "FILE", "the textures of a preset, as of retex-combine; options go first", 0, CLI_INTO(Job, preset)},
    {"refer", 0, NULL, "name the set, by its path, size and checksum, instead of carrying it along", 0,
     CLI_INTO(Job, refer)},
    FRAMES_OPTION(Job, frames),
    {"keep-going", 0, NULL, "continue after a frame that fails", 0, CLI_INTO(Job, keep_going)},
    {0},
};

static void parse(Cli *cli, Job *job)
{
    cli_parse(cli, job, CLI_ARGUMENTS(&job->set), "one set is enough");
    if (!job->set)
        cli_die(cli, "no set given; - is standard input");
    if (job->preset) /* what it says of lamps and the picture is for retex-combine */
        texture_args_add_preset_textures(cli, job->textures.specs, &job->textures.count, job->preset);
    if (!job->textures.count)
        cli_die(cli, "no texture given; expected --texture NAME=IMAGE");
    if (job->keep_going && !job->frames.step)
        cli_die(cli, "--keep-going needs --frames");
}

/* Samples are always OpenEXR. Refuse names of other formats, which suggest that retex-combine is meant. */
static void check_ending(const Cli *cli, const char *output)
{
    const PictureKind *kind = picture_kind_of_name(output);
    if ((kind && strcmp(kind->ending, "exr") != 0) || set_kind_of_name(output) == &set_kind_pack)
        cli_die(cli, "%s: samples are an OpenEXR file, .exr; pictures are made by retex-combine", output);
}

/* Before anything is read: check the files of a frame, or the only ones. */
static void check_files(const Cli *cli, const Job *job)
{
    RetexError err = {0};
    cli_input(cli, job->set, "a set, as from retex-render");
    cli_reads(cli, "the set", job->set);
    texture_args_reads(cli, job->textures.specs, job->textures.count);
    cli_writes(cli, "the output", job->output);
    check_ending(cli, job->output);
    if (retex_output_check(job->output, &err))
        cli_fail(cli, &err);
}

/* Open the set, also one that an earlier retex-sample names. *named: the file that --refer names. */
static int open_set(const Cli *cli, const Job *job, RetexSet **set, const char **named, RetexError *err)
{
    int code = retex_set_open_any(job->set, set, cli->threads, err);
    *named = job->set;
    if (!code && retex_set_info(*set).is_samples && *retex_set_reference(*set)) {
        code = cli_open_referred(cli, set, job->set, err);
        *named = retex_set_reference(*set);
    } else if (!code && retex_set_info(*set).is_samples) {
        code = retex_fail(err, RETEX_EINVAL, "%s holds samples but no set", job->set);
    } else if (!code && job->refer && retex_set_has_laid(*set)) {
        code = retex_fail(err, RETEX_EINVAL, "%s is a stream that carries its set: --refer needs the set's file",
                          strcmp(job->set, "-") == 0 ? "standard input" : job->set);
    }
    return code;
}

/* *set is the caller's to close. */
static int make_samples(const Cli *cli, const Job *job, KeptTextures *kept, RetexSet **set, RetexError *err)
{
    const RetexTextureSpec *specs = job->textures.specs;
    const int count = job->textures.count;
    double began = retex_clock_seconds();
    const char *named = NULL;
    int code = open_set(cli, job, set, &named, err);
    if (!code) /* before any work */
        code = retex_set_refer(*set, job->refer ? named : NULL, err);
    if (!code)
        cli_check_pixels(cli, *set, job->set);
    double read = retex_clock_seconds();
    if (!code)
        code = kept_textures_load(kept, *set, specs, count, cli->threads, err);
    if (!code)
        code = retex_sample_textures(*set, kept->textures, specs, count, job->output, cli->threads, err);
    double sampled = retex_clock_seconds();
    RetexStoreParams store = RETEX_STORE_INIT;
    const int to_pipe = strcmp(job->output, "-") == 0 && !job->refer;
    if (!code)
        code = to_pipe ? retex_set_write(*set, job->output, &store, cli->threads, err)
                       : retex_set_write_samples(*set, job->output, &store, cli->threads, err);
    if (code)
        return code;
    double written = retex_clock_seconds();

    const RetexSetInfo info = retex_set_info(*set);
    char text[2048];
    cli_info(cli, "%s: %d x %d, %.2f s", texture_args_describe(*set, text, sizeof text), info.width, info.height,
             written - began);
    cli_detail(cli, "read %.2f s, sampled %.2f s, written %.2f s", read - began, sampled - read, written - sampled);
    return RETEX_OK;
}

/* Returns 0 where it failed and the next frame is to be made. */
static int make_file(const Cli *cli, const Job *job, KeptTextures *kept)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    const int code = make_samples(cli, job, kept, &set, &err);
    retex_set_close(&set);
    if (code && (!job->keep_going || retex_budget_is_stopped(cli->budget)))
        cli_fail(cli, &err);
    if (code)
        cli_error(cli, &err);
    return !code;
}

static void check_frame_names(const Cli *cli, const Job *job)
{
    frames_check_count(cli, &job->frames);
    frames_check_name(cli, &job->frames, "the set", job->set, 0);
    frames_check_name(cli, &job->frames, "the output", job->output, 1);
    texture_args_check_frames(cli, &job->frames, "--texture", job->textures.specs, job->textures.count);
}

/* Check all frames, or make them. Returns how many failed. */
static int each_frame(Cli *cli, const Job *all, KeptTextures *kept /* NULL = check */)
{
    int failed = 0;
    FOR_FRAMES(number, all->frames)
    {
        char *set = frames_name(cli, all->set, number), *output = frames_name(cli, all->output, number);
        Job job = *all;
        job.set = set, job.output = output;
        texture_args_set_frame(cli, number, job.textures.specs, job.textures.count);
        cli_set_frame(cli, number);
        if (kept)
            failed += !make_file(cli, &job, kept);
        else
            check_files(cli, &job);
        free(set);
        free(output);
    }
    cli_set_frame(cli, -1);
    if (failed)
        frames_tell_failed(cli, failed, frames_count(&all->frames));
    return failed;
}

int main(int argc, char **argv)
{
    static Job job;
    static KeptTextures kept;
    Cli cli = {.tool = "retex-sample",
               .usage = "SET --texture[:opts] NAME=IMAGE ... [-o SAMPLES]",
               .about = "Filter new textures at a set's footprints, for retex-combine.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    int failed = 0;
    parse(&cli, &job);
    job.output = cli_output(&cli);
    if (job.frames.step) {
        check_frame_names(&cli, &job);
        each_frame(&cli, &job, NULL);
        failed = each_frame(&cli, &job, &kept);
    } else {
        check_files(&cli, &job);
        make_file(&cli, &job, &kept);
    }
    kept_textures_close(&kept);
    return cli_close(&cli, failed ? CLI_FAIL : CLI_OK);
}
