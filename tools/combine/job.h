/* What retex-combine was asked to do: one picture, the rows of a table, or the frames of an animation. */
#ifndef RETEX_COMBINE_JOB_H
#define RETEX_COMBINE_JOB_H

#include <retex/retex.h>

#include "batch/batch.h"
#include "common/frames.h"
#include "common/kept_textures.h"
#include "common/texture_args.h"

typedef struct Job {
    const char *set_path, *samples_path, *table, *error;
    const char *output;
    const char *preset, *save_preset;
    const char *solve, *unknowns; /* --solve, --free */
    int region[4];                /* x, y, width, height; all 0: the picture */
    int crop[4], scaled[2];       /* --crop, as region, and --size: width, height, 0 where it follows from the other */
    RetexCut cut;                 /* what these are of the open set */
    FrameRange frames;
    Batch batch;
    TextureArgs textures;
    uint64_t memory; /* bytes of the set that --batch may keep in memory */
    RetexWriteParams write;
    RetexCombineParams combine;
    RetexDevelop develop;
    const char *exposure, *white_balance, *view; /* as the command line has them; job_develop reads them from lights */
    int auto_exposure;
    RetexEdit *lights; /* of the command line: lamps, finishes, and how the picture is developed */
    RetexEdit *solo;   /* --solo, while the command line is read */
    float parameters[3 * RETEX_PARAMETERS_MAX];
    RetexSet *set; /* with the samples; rows are read when they are needed */
} Job;

/* ---- job.c: files ---- */

/* Announce the files of the command line. batch_check announces those of a table. */
void job_announce(const Cli *cli, const Job *job);
/* Exit if the picture cannot be written. */
void job_check_output(const Cli *cli, const Job *job);
/* Whether the samples can be read, if they are a file. */
int job_check_samples(const Cli *cli, const Job *job, RetexError *err);
/* Open the set, and the samples from the same stream or from a separate file. */
int job_open(const Cli *cli, Job *job, RetexError *err);
void job_close(Job *job);
/* Parse --crop or --region: x, y, width, height; and --size: width, height. */
void job_take_rectangle(Cli *cli, const CliOption *option, void *rectangle);
void job_take_size(Cli *cli, const CliOption *option, void *size);
/* Develop the picture as an edit says, and show it in its view, which is borrowed from the edit. */
int job_develop(Job *job, const RetexEdit *edit, RetexError *err);
/* The same, and give the parameters of the set the values that the edit has for its lamps. */
int job_light(Job *job, const RetexEdit *lights, RetexError *err);
/* Add the targets whose corrections a picture with these textures uses. */
void job_add_corrected(const Job *job, const RetexTextureSpec *specs, int nspecs, int corrected[RETEX_MAX_TARGETS]);
/* Keep the open set in memory if it fits. */
int job_preload(const Cli *cli, Job *job, const int corrected[RETEX_MAX_TARGETS], RetexError *err);

/* ---- picture.c ---- */

/* The textures of one picture. Targets without one use the samples that came with the set. */
typedef struct Row {
    const RetexTextureSpec *specs;
    int count;
    RetexTexture *const *textures; /* by target */
    const RetexEdit *lights;
} Row;

/* List the new textures of a picture; return their number. */
int job_describe(const Job *job, const RetexTextureSpec *specs, int count, BatchTexture textures[RETEX_MAX_TARGETS]);
/* Compute and write one picture. The expected error is written first, and removed if the picture cannot be written, so
 * that neither is left alone. */
int job_make_picture(const Cli *cli, Job *job, const Row *row, const char *output, double began, RetexError *err);
/* Compute a picture in memory, as it would be written to output, and tell how many bytes it has. */
int job_try_picture(const Cli *cli, Job *job, const Row *row, const char *output, size_t *bytes, RetexError *err);
/* Make the picture of a job whose set is open. */
int job_make(const Cli *cli, Job *job, KeptTextures *kept, double began, RetexError *err);
/* Print one line of JSON about a picture that was made. */
void job_report(const Cli *cli, const char *output, double began, int done, int total);

/* ---- solve.c ---- */

/* 1: the picture of --solve is a colour. */
int job_solve_is_color(const Job *job);
/* --solve: find what is free, print it, and write the picture if there is an output; return the exit status. */
int job_solve(const Cli *cli, Job *job, double began);

/* ---- table.c, frames.c ---- */

/* --batch; return the exit status. */
int job_run_table(const Cli *cli, Job *job);
/* Before the first frame: check the files of all. */
void job_check_frames(Cli *cli, const Job *job);
/* --frames; return the exit status. As a batch, stop at a frame that fails, unless --keep-going. */
int job_run_frames(Cli *cli, Job *job);

#endif
