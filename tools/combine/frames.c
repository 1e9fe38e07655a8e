/* --frames: the same textures in the sets of an animation. See job.h. */
#include <stdlib.h>

#include "combine/job.h"

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

void job_check_frames(Cli *cli, const Job *job)
{
    check_names(cli, job);
    FOR_FRAMES(number, job->frames)
    {
        Job *frame = open_frame(cli, job, number);
        cli_set_frame(cli, number);
        job_announce(cli, frame);
        job_check_output(cli, frame);
        close_frame(frame);
    }
    cli_set_frame(cli, -1);
}

static int make_frame(const Cli *cli, Job *job, int one_set, KeptTextures *kept, RetexError *err)
{
    const double began = retex_clock_seconds();
    int code = one_set ? RETEX_OK : job_open(cli, job, err);
    if (!code)
        code = retex_textures_check(job->set, job->textures.specs, job->textures.count, err);
    if (!code)
        code = job_make(cli, job, kept, began, err);
    if (!one_set)
        job_close(job);
    return code;
}

int job_run_frames(Cli *cli, Job *job)
{
    const double began = retex_clock_seconds();
    const int total = frames_count(&job->frames), one_set = has_one_set(job);
    KeptTextures kept = {.nimages = 0};
    RetexError err = {0};
    int corrected[RETEX_MAX_TARGETS] = {0}, made = 0, failed = 0;
    if (one_set && job_open(cli, job, &err))
        cli_fail(cli, &err);
    if (one_set)
        job_add_corrected(job, job->textures.specs, job->textures.count, corrected);
    if (one_set && job_preload(cli, job, corrected, &err))
        cli_fail(cli, &err);
    for (int number = job->frames.first; number <= job->frames.last && (!failed || job->batch.keep_going);
         number += job->frames.step) {
        const double started = retex_clock_seconds();
        Job *frame = open_frame(cli, job, number);
        cli_set_frame(cli, number);
        if (make_frame(cli, frame, one_set, &kept, &err))
            cli_error(cli, &err), failed++;
        else
            job_report(cli, frame->output, started, ++made, total);
        close_frame(frame);
    }
    cli_set_frame(cli, -1);
    kept_textures_close(&kept);
    job_close(job);
    if (failed && job->batch.keep_going)
        frames_tell_failed(cli, failed, total);
    if (!failed)
        cli_info(cli, "%d frame%s, %.2f s", total, total == 1 ? "" : "s", retex_clock_seconds() - began);
    return failed ? CLI_FAIL : CLI_OK;
}
