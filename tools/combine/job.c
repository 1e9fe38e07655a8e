/* The files of retex-combine: they are announced and checked before work, and opened. See job.h. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "combine/job.h"

enum { MUCH = 3, LARGE = 1 << 20 }; /* times smaller to each side, and of at least so many pixels, is told */

/* The samples cannot be read. The message asks whether -o or --texture is missing before the name. */
static int fail_samples(const Cli *cli, const Job *job, const RetexError *why, RetexError *err)
{
    char forgotten[1024] = "";
    if (!job->table && strcmp(job->samples_path, job->set_path) != 0)
        cli_forgotten(cli, job->samples_path, forgotten, sizeof forgotten);
    return retex_fail(err, why->code, "%.900s%.100s", why->message, forgotten);
}

int job_check_samples(const Cli *cli, const Job *job, RetexError *err)
{
    RetexError why = {0};
    struct stat info;
    if (!job->samples_path || strcmp(job->samples_path, "-") == 0 || stat(job->samples_path, &info) == 0)
        return RETEX_OK;
    retex_fail(&why, RETEX_EIO, "cannot read %s: %s", job->samples_path, strerror(errno));
    return fail_samples(cli, job, &why, err);
}

void job_take_rectangle(Cli *cli, const CliOption *option, void *rectangle)
{
    int *r = rectangle, length = 0;
    if (sscanf(cli->value, "%d,%d,%d,%d%n", &r[0], &r[1], &r[2], &r[3], &length) != 4 || cli->value[length] ||
        r[0] < 0 || r[1] < 0 || r[2] < 1 || r[3] < 1 || r[0] > RETEX_MAX_SIZE || r[1] > RETEX_MAX_SIZE ||
        r[2] > RETEX_MAX_SIZE || r[3] > RETEX_MAX_SIZE)
        cli_die(cli, "--%s: expected X,Y,W,H, the left and top edge, the width and the height in pixels, not '%s'",
                option->name, cli->value);
}

void job_take_size(Cli *cli, const CliOption *option, void *to)
{
    int *size = to;
    const char *text = cli->value;
    char *end;
    for (int k = 0; k < 2; k++, text = end + 1) {
        const long number = *text >= '0' && *text <= '9' ? strtol(text, &end, 10) : (end = (char *)(uintptr_t)text, 0);
        if (number > RETEX_MAX_SIZE || (end > text && number < 1) || *end != (k ? '\0' : 'x'))
            break;
        size[k] = (int)number;
        if (k && (size[0] || size[1]))
            return;
    }
    cli_die(cli, "--%s: expected WxH in pixels, or Wx or xH to keep the aspect, not '%s'", option->name, cli->value);
}

static int lay_samples(const Cli *cli, Job *job, RetexError *err)
{
    RetexError why = {0};
    RetexSet *samples = NULL;
    cli_input(cli, job->samples_path, "samples, as from retex-sample");
    int code = retex_set_open_any(job->samples_path, &samples, cli->threads, &why);
    if (!code && !retex_set_info(samples).is_samples && !retex_set_has_laid(samples))
        code = retex_fail(&why, RETEX_EFORMAT, "%s holds a set, no samples", job->samples_path);
    code = code ? fail_samples(cli, job, &why, err) : retex_set_lay(job->set, samples, err);
    retex_set_close(&samples);
    return code;
}

/* A picture that is much smaller than the set is made of a level, if the set has one that serves. */
static int take_level(const Cli *cli, Job *job, RetexError *err)
{
    const RetexSetInfo info = retex_set_info(job->set);
    const RetexCut whole = job->cut;
    const int level = retex_set_find_level(job->set, &whole, &job->cut);
    if (level >= 0) {
        const int code = retex_set_take_level(&job->set, level, err);
        if (!code)
            cli_detail(cli, "made of the level of %d x %d pixels", retex_set_info(job->set).width,
                       retex_set_info(job->set).height);
        return code;
    }
    if ((long)info.width * info.height >= LARGE && whole.width / MUCH >= whole.scaled_width &&
        whole.height / MUCH >= whole.scaled_height)
        cli_info(cli, "%s: made of all %d x %d pixels: no level of it serves, see retex-pack --levels", job->set_path,
                 info.width, info.height);
    return RETEX_OK;
}

int job_open(const Cli *cli, Job *job, RetexError *err)
{
    cli_input(cli, job->set_path, "a set, as from retex-render or retex-sample");
    int code = retex_set_open_any(job->set_path, &job->set, cli->threads, err);
    const int is_samples = !code && retex_set_info(job->set).is_samples;
    if (is_samples && !job->samples_path && *retex_set_reference(job->set))
        code = cli_open_referred(cli, &job->set, job->set_path, err);
    else if (is_samples)
        code = retex_fail(err, RETEX_EINVAL, "%s holds samples but no set", job->set_path);
    if (code)
        return code;
    cli_check_pixels(cli, job->set, job->set_path);
    const RetexSetInfo info = retex_set_info(job->set);
    code = retex_cut_fit(&job->cut, info.width, info.height, job->crop, job->scaled[0], job->scaled[1], err);
    if (code)
        return code;
    if (!job->samples_path && !retex_set_has_laid(job->set))
        code = take_level(cli, job, err);
    if (code)
        return code;
    job->combine.x0 = job->cut.x, job->combine.x1 = job->cut.x + job->cut.width;
    job->combine.y0 = job->cut.y, job->combine.y1 = job->cut.y + job->cut.height;
    return job->samples_path ? lay_samples(cli, job, err) : RETEX_OK;
}

void job_close(Job *job)
{
    retex_set_close(&job->set);
}

void job_announce(const Cli *cli, const Job *job)
{
    cli_reads(cli, "the set", job->set_path);
    cli_reads(cli, "the samples", job->samples_path);
    cli_reads(cli, "the table", job->table);
    cli_reads(cli, "the picture of --solve", job->solve && !job_solve_is_color(job) ? job->solve : NULL);
    texture_args_reads(cli, job->textures.specs, job->textures.count);
    cli_writes(cli, "the output", job->output);
    cli_writes(cli, "--error", job->error);
}

void job_check_output(const Cli *cli, const Job *job)
{
    RetexError err = {0};
    if (retex_image_write_check(job->output, &job->write, &err))
        cli_fail(cli, &err);
    if (job->error && retex_image_write_check(job->error, NULL, &err))
        cli_fail(cli, &err);
}

int job_develop(Job *job, const RetexEdit *edit, RetexError *err)
{
    job->develop = (RetexDevelop)RETEX_DEVELOP_INIT;
    job->combine.develop = &job->develop;
    job->write.view = retex_edit_view(edit);
    return retex_edit_develop(edit, &job->develop, err);
}

int job_light(Job *job, const RetexEdit *lights, RetexError *err)
{
    job->combine.parameters = NULL;
    int code = job_develop(job, lights, err);
    if (code || !retex_edit_lights(lights))
        return code;
    code = retex_edit_parameters(lights, job->set, job->parameters, err);
    if (!code)
        job->combine.parameters = job->parameters;
    return code;
}

void job_add_corrected(const Job *job, const RetexTextureSpec *specs, int nspecs, int corrected[RETEX_MAX_TARGETS])
{
    const int ntargets = retex_set_info(job->set).ntargets;
    int edited[RETEX_MAX_TARGETS] = {0}, count = 0;
    for (int t = 0; t < ntargets; t++)
        edited[t] = *retex_set_target(job->set, t)->texture != '\0';
    for (int i = 0; i < nspecs; i++) {
        const int t = retex_set_find_target(job->set, specs[i].target);
        if (t >= 0)
            edited[t] = 1;
    }
    for (int t = 0; t < ntargets; t++)
        count += edited[t];
    for (int t = 0; t < ntargets && retex_correction_weight(ntargets, count) > 0; t++)
        corrected[t] |= edited[t];
}

int job_preload(const Cli *cli, Job *job, const int corrected[RETEX_MAX_TARGETS], RetexError *err)
{
    return retex_set_preload(job->set, corrected, cli_memory(cli, job->memory), cli->threads, err);
}
