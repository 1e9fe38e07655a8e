/* retex-render: renders a scene to a set, a plain picture, or a picture with replaced textures. See retex-render(1). */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <retex/denoise.h>
#include <retex/output_file.h>
#include <retex/host/denoise_data.h>
#include <retex/host/set_build.h>
#include "retex-render.h"
#include "camera/view.h"
#include "common/set_kind.h"
#include "common/watchdog.h"
#include "render/mattes.h"

/* Announce all files of the command line. Files that the scene names are not among them. */
static void announce_files(Arguments *a)
{
    const char *output = answers(a) ? "-" : a->output;
    char path[4096];
    cli_reads(a->cli, "the scene", a->scene);
    for (int k = 0; k < a->ini.files.count; k++)
        cli_reads(a->cli, "the .ini file", a->ini.files.items[k]);
    cli_reads(a->cli, "the table", a->variants);
    cli_reads(a->cli, "the set of --control", a->control);
    texture_args_reads(a->cli, a->replacements, a->nreplacements);
    cli_writes(a->cli, answers(a) ? "the answer" : "the output", output);
    cli_writes(a->cli, "--stats", a->stats);
    cli_writes(a->cli, "the file of --list-targets", a->sheet);
    cli_writes(a->cli, "the file of --mattes", a->mattes);
    for (int k = 0; a->aov_dir && aov_files_path(path, sizeof path, a->aov_dir, k); k++)
        cli_writes(a->cli, "the file of --aov-dir", path);
}

static int announce_files_of_scene(Arguments *a, const Scene *scene, RetexError *err)
{
    int code = RETEX_OK;
    for (const SceneFile *file = scene->files; file && !code; file = file->next)
        code =
            cli_add_input(strcmp(file->path, a->scene) ? "a file that the scene reads" : "the scene", file->path, err);
    a->batch.inputs_known = !code;
    return code;
}

/* The kind of output by its name: a pack, a set if it is EXR and a set is rendered, otherwise NULL: a picture. */
static const SetKind *output_kind(const Arguments *a, const char *output)
{
    const int has_set = !a->render.plain || a->render.aovs || a->render.control_data;
    const SetKind *kind = set_kind_of_name(output);
    if (!kind && (!strcmp(output, "-") || !strncmp(output, "/dev/", 5)))
        kind = &set_kind_exr;
    return kind == &set_kind_exr && !has_set ? NULL : kind;
}

/* Finished rows are kept in a file beside the output. */
static void name_checkpoint(Arguments *a)
{
    struct stat old;
    RenderParams *r = &a->render;
    const char *output = a->output;
    if (!output || !strcmp(output, "-") || !strncmp(output, "/dev/", 5) ||
        (!stat(output, &old) && !S_ISREG(old.st_mode)) || r->control_data) {
        if (r->resume)
            cli_die(a->cli, "--resume needs an output file, which %s is not", output);
        return;
    }
    if (snprintf(a->checkpoint, sizeof a->checkpoint, "%s.partial", output) >= (int)sizeof a->checkpoint)
        cli_die(a->cli, "the output's name is too long");
    r->checkpoint = a->checkpoint, r->output = output;
}

static void announce_checkpoint(const Arguments *a)
{
    int there = access(a->checkpoint, F_OK) == 0;
    if (!a->render.checkpoint)
        return;
    if (a->render.resume || !there)
        cli_writes(a->cli, "the file of finished rows", a->checkpoint);
    if (!a->render.resume && there)
        cli_warn(a->cli, "%s is unchanged: --resume continues from it", a->checkpoint);
}

static int render(Arguments *a, const Scene *scene, RetexSet **set, RenderStats *stats, RetexError *err)
{
    if (a->render.checkpoint)
        a->render.key = render_fingerprint(a, scene);
    watchdog_let_keep(a->render.checkpoint != NULL);
    int code = render_scene(set, scene, &a->render, stats, err);
    watchdog_let_keep(0);
    return code;
}

/* 1 if the render has the data for retex-denoise, which rounding reads too, and goes through a file. Sets in OpenEXR
 * keep the data. Packs omit it, and pictures without targets are only filtered here. */
static int keeps_data(const Arguments *a, const char *output)
{
    if (!output || !a->ntargets || a->render.plain)
        return 0;
    return output_kind(a, output) == &set_kind_exr;
}

/* Before the render: check that the output can be written and holds all that is asked for. */
static void check_output(const Arguments *a, const char *output)
{
    RetexError err;
    const SetKind *kind = output_kind(a, output);
    if (!kind ? retex_image_write_check(output, NULL, &err) : retex_output_check(output, &err))
        cli_fail(a->cli, &err);
    if (!kind && a->render.aovs && !a->aov_dir)
        cli_warn(a->cli, "%s holds the picture only: --aov needs .exr or .retex", output);
    if (!kind && !a->render.plain && a->ntargets)
        cli_warn(a->cli, "%s holds the picture only: a set needs .exr or .retex", output);
}

static void denoise_progress(void *context, double done)
{
    cli_progress(context, "denoise", done);
}

static int denoise(Arguments *a, RetexSet *set, RetexError *err)
{
    RetexDenoiseParams params = RETEX_DENOISE_INIT;
    params.quality = a->denoise_quality;
    params.progress = denoise_progress, params.progress_context = a->cli;
    params.budget = a->cli->budget;
    params.full_precision = a->full_precision;
    return retex_denoise(set, &params, NULL, a->cli->threads, err);
}

/* What is written has the numbers that it will be read with, whether it is denoised here or later. */
static int round_set(const Arguments *a, RetexSet *set, const char *output, RetexError *err)
{
    return a->full_precision ? RETEX_OK : retex_set_round(set, output, a->cli->threads, err);
}

static int write_result(Arguments *a, RetexSet *set, const char *output, RetexError *err)
{
    const SetKind *kind = output_kind(a, output);
    const int threads = a->cli->threads;
    return kind ? kind->write(set, output, threads, err)
                : retex_image_write(&retex_set_part(set, 0)->image, output, NULL, threads, err);
}

static void report(const Arguments *a, const RetexSet *set, const RenderStats *s)
{
    const RetexSetInfo info = retex_set_info(set);
    double seconds = s->render_seconds > 0 ? s->render_seconds : 1e-9;
    cli_info(a->cli, "%dx%d, %d samples: %.2f s, %.2f Mpaths/s, %.2f Mrays/s", info.width, info.height, info.spp,
             s->render_seconds, (double)s->paths / seconds * 1e-6,
             (double)(s->segments + s->shadow_rays) / seconds * 1e-6);
    warn_numbers(a->cli, s);
    if (info.nterms)
        cli_info(a->cli, "%d target%s, energy beyond order %d: %.4f%%", info.ntargets, info.ntargets == 1 ? "" : "s",
                 info.orders, 100 * info.folded);
}

/* Where UV are not those of the model. */
static void tell_projection(const Arguments *a, const Target *target)
{
    static const char *const names[] = {[UV_PLANAR] = "planar", "box", "cylinder"};
    if (target->projection.kind > UV_MODEL && !target->uv)
        cli_info(a->cli, "target `%s` %s: a %s projection gives it UV; `:uv=` after it chooses another one",
                 target->name, target->nselections ? "is faces" : "has no UV", names[target->projection.kind]);
}

static void check_targets(const Arguments *a, const Scene *scene)
{
    for (int t = 0; t < scene->ntargets; t++)
        tell_projection(a, &scene->targets[t]);
    for (int t = 0; t < scene->ntargets; t++)
        if (job_target_is_empty(scene, t))
            cli_warn(a->cli, "target `%s` has no surface%s", scene->targets[t].name,
                     t ? ": its surfaces belong to targets named before it" : "");
}

/* End with an error, or go on with the next frame. A batch also writes the error to its report. */
static int fail(Arguments *a, const RetexError *err)
{
    if (a->variants)
        return batch_finish(&a->batch, err);
    if (!a->keep_going || retex_budget_is_stopped(a->cli->budget))
        cli_fail(a->cli, err);
    cli_error(a->cli, err);
    return CLI_FAIL;
}

/* Before anything is rendered: check a frame's files. */
static int check_files(Arguments *a)
{
    announce_files(a);
    name_checkpoint(a);
    announce_checkpoint(a);
    if (a->variants)
        check_table(a);
    if (a->output)
        check_output(a, a->output), check_stats(a);
    if (a->sheet)
        check_sheet(a);
    return CLI_OK;
}

/* What rendering leaves: a set, or a picture as one. */
static int finish_set(Arguments *a, const Scene *scene, RetexSet *set, const RenderStats *stats, double parse_seconds,
                      RetexError *err)
{
    int code = round_set(a, set, a->output, err);
    if (!code && a->denoise)
        code = denoise(a, set, err);
    else if (a->no_denoise_data)
        retex_denoise_drop_data(set);
    if (!code && a->aov_dir)
        code = aov_files_write(set, a->aov_dir, a->cli->threads, err);
    if (!code && a->mattes)
        code = mattes_write(scene, &a->render, &retex_set_part(set, 0)->image, a->matte_ranks, a->mattes, err);
    if (!code && a->output)
        code = write_result(a, set, a->output, err);
    if (code)
        return code;
    if (a->render.resume)
        unlink(a->checkpoint);
    report(a, set, stats);
    return a->stats ? write_stats(a, stats, set, parse_seconds, err) : RETEX_OK;
}

static int open_scene(Arguments *a, Scene **scene, RetexError *err)
{
    RetexError why;
    const JobNames names = {.targets = a->targets,
                            .ntargets = a->ntargets,
                            .lamps = a->lamps,
                            .nlamps = a->nlamps,
                            .finishes = a->finishes,
                            .nfinishes = a->nfinishes,
                            .shown = a->shown,
                            .nshown = a->nshown,
                            .each_lamp = a->each_lamp};
    int code = job_open_scene(scene, a->scene, &a->sdl, &a->render, &names, err);
    if (!code && (code = light_lamps(a, *scene, err)))
        scene_close(scene);
    if (code && a->variants && !a->named)
        refuse_columns(a);
    if (!code)
        code = announce_files_of_scene(a, *scene, err);
    if (!code && a->mattes)
        code = mattes_check(*scene, a->mattes, err);
    if (!code && a->aov_dir && aov_files_check(a->aov_dir, &why))
        code = retex_fail(err, RETEX_EINVAL, "--aov-dir: %s", why.message);
    if (code)
        return code;
    if (!a->list && !a->list_lamps && !a->list_finishes && !a->list_cameras)
        job_warn_dark(*scene, &a->sdl);
    check_targets(a, *scene);
    return !a->list || lists_pixels(a) ? job_check_size(*scene, &a->render, err) : RETEX_OK;
}

static void list_finishes(const Scene *scene)
{
    const char *name;
    for (int k = 0; k < scene->nnamed_finishes; k++)
        printf("%s\n", scene->named_finishes[k].name);
    for (int k = 0; (name = scene_built_in_finish(k)); k++)
        printf("%s\tbuilt in\n", name);
    printf("original\tas the scene has it\n");
}

/* As --camera takes them: with a point that the middle of the picture shows. */
static void list_cameras(const Scene *scene)
{
    for (int k = 0; k < scene->ncameras; k++) {
        const Camera *camera = &scene->cameras[k].camera;
        const Vec3 eye = camera->location, at = vec_add(eye, vec_normalize(camera->direction));
        printf("%s\t%.7g,%.7g,%.7g:%.7g,%.7g,%.7g:%.7g\n", scene->cameras[k].name, eye.x, eye.y, eye.z, at.x, at.y,
               at.z, camera_angle(camera));
    }
}

/* What is asked for of a scene. *status: the answer, where there is no error. */
static int make_picture(Arguments *a, Scene *scene, double parse_seconds, int *status, RetexError *err)
{
    RetexSet *set = NULL;
    RenderStats stats;
    int code = RETEX_OK;
    if (a->list)
        list_targets(a, scene);
    else if (a->list_lamps)
        list_lamps(a, scene);
    else if (a->list_finishes)
        list_finishes(scene);
    else if (a->list_cameras)
        list_cameras(scene);
    else if (a->live)
        code = live(a, scene, err);
    else if (a->variants)
        *status = make_variants(a, scene);
    else if (a->control)
        code = render_controlled(a, scene, a->output, err);
    else if (a->tracing)
        code = render_trace(scene, &a->render, a->trace[0], a->trace[1], a->trace[2], stdout, err);
    else
        code = render(a, scene, &set, &stats, err);
    if (!code && set)
        code = finish_set(a, scene, set, &stats, parse_seconds, err);
    retex_set_close(&set);
    return code;
}

/* Render a frame, or the only picture. Return the exit status. */
static int make_frame(Arguments *a)
{
    RetexError err = {0};
    RetexTexture *loaded[RETEX_MAX_TARGETS] = {0};
    Scene *scene = NULL;
    int status = CLI_OK;
    name_checkpoint(a);
    if (frame_is_there(a)) {
        cli_info(a->cli, "%s is there", a->output);
        return CLI_OK;
    }
    int code = a->control ? read_control(a, &err) : RETEX_OK;
    const int keeps = keeps_data(a, a->output);
    a->render.denoise_data = a->denoise || keeps;
    a->render.stored = keeps && !a->denoise;
    a->render.rounded = !a->full_precision;
    const double started = retex_clock_seconds();
    if (!code)
        code = open_scene(a, &scene, &err);
    if (!code)
        code = replace_textures(a, scene, loaded, &err);
    if (!code)
        code = make_picture(a, scene, retex_clock_seconds() - started, &status, &err);
    if (code)
        status = fail(a, &err);
    retex_set_close(&a->control_set);
    scene_close(&scene);
    for (int k = 0; k < a->nreplacements; k++)
        retex_texture_close(&loaded[k]);
    return status;
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-render",
               .usage = "[options] SCENE.pov|FILE.ini",
               .argc = argc,
               .argv = argv,
               .next = 1,
               .about = "Render a scene in POV-Ray's language into a set for retexturing."};
    Arguments a = {.cli = &cli};
    parse_arguments(&a);
    int needless =
        a.list || a.tracing || a.variants || ((a.aov_dir || a.mattes) && !cli.output && isatty(STDOUT_FILENO));
    a.output = needless || a.live ? NULL : cli_output(&cli);
    if (a.live)
        cli_output(&cli); /* no terminal, either */
    plan_frames(&a);
    int status = for_each_frame(&a, check_files);
    if (status == CLI_OK)
        status = for_each_frame(&a, make_frame);
    ini_close(&a.ini);
    return cli_close(&cli, status);
}
