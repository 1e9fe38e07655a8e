/* The command line of retex-render: its options, and which of them cannot be combined. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <retex/nearest.h>

#include "base/digest.h"
#include "retex-render.h"
#include "camera/view.h"
#include "render/mattes.h"

/* Parse `count` whole numbers between separators. Any further text is an error. */
static void numbers(Cli *cli, const CliOption *option, char separator, int count, int *out)
{
    if (!job_numbers(cli->value, separator, count, out))
        cli_die(cli, "--%s: expected %s, not `%s`", option->name, option->argument, cli->value);
}

/* The textures of a preset for targets without --replace. */
static void add_preset(Arguments *a)
{
    if (a->preset && texture_args_add_preset_textures(a->cli, a->replacements, &a->nreplacements, a->preset))
        cli_warn(a->cli, "only textures of --preset are rendered: what it says of lamps, finishes and the picture is "
                         "left out");
}

/* The index of the option's value among names; an error if it is none of them. */
static int choose(const Cli *cli, const CliOption *o, int count, const char *const *names)
{
    char known[128] = "", meant[RETEX_MEANT_SIZE];
    for (int k = 0; k < count; k++) {
        if (!strcmp(cli->value, names[k]))
            return k;
        size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", k ? (k + 1 < count ? ", " : " or ") : "", names[k]);
    }
    cli_die(cli, "--%s: expected %s, not `%s`%s", o->name, known, cli->value,
            retex_meant(retex_nearest_of(cli->value, names, count), meant));
}

/* ---- options whose values are checked at once, and those that say two things ---- */

static void take_list_targets(Cli *cli, const CliOption *o, void *arguments)
{
    Arguments *a = arguments;
    (void)o;
    a->list = 1, a->sheet = cli->value;
}

static void take_denoise(Cli *cli, const CliOption *o, void *arguments)
{
    Arguments *a = arguments;
    (void)o;
    a->denoise = 1, a->denoise_quality = cli->value;
}

static void take_lamps(Cli *cli, const CliOption *o, void *each)
{
    choose(cli, o, 1, (const char *const[]){"each"});
    *(int *)each = 1;
}

static void take_replace(Cli *cli, const CliOption *o, void *arguments)
{
    Arguments *a = arguments;
    RetexError err;
    if (a->nreplacements == RETEX_MAX_TARGETS)
        cli_die(cli, "more than %d of --%s", RETEX_MAX_TARGETS, o->name);
    if (texture_args_parse(cli, a->replacements, &a->nreplacements, &err))
        cli_die(cli, "--%s: %s", o->name, err.message);
}

static void take_control_mode(Cli *cli, const CliOption *o, void *mode)
{
    *(ControlMode *)mode = (ControlMode)choose(cli, o, 3, (const char *const[]){"unbiased", "halves", "biased"});
}

static void take_control_data(Cli *cli, const CliOption *o, void *data)
{
    *(int *)data = 1 + choose(cli, o, 2, (const char *const[]){"biased", "unbiased"});
}

static void take_matte_ranks(Cli *cli, const CliOption *o, void *ranks)
{
    numbers(cli, o, 0, 1, ranks);
    if (*(int *)ranks < 1 || *(int *)ranks > MATTE_RANKS_MAX)
        cli_die(cli, "--matte-ranks: expected 1 to %d, not `%s`", MATTE_RANKS_MAX, cli->value);
}

static void take_camera(Cli *cli, const CliOption *o, void *camera)
{
    RetexError err;
    CameraView view;
    if (camera_view_read(&view, cli->value, &err) == RETEX_EINVAL)
        cli_die(cli, "--%s: %s", o->name, err.message);
    *(const char **)camera = cli->value;
}

static void take_trace(Cli *cli, const CliOption *o, void *arguments)
{
    Arguments *a = arguments;
    numbers(cli, o, ',', 3, a->trace);
    a->tracing = 1;
}

static void take_steps(Cli *cli, const CliOption *o, void *arguments)
{
    (void)arguments;
    cli_limit(cli, o);
}

/* Of the render itself: as names that OpenImageIO opens have them. */
static void take_render_option(Cli *cli, const CliOption *o, void *arguments)
{
    Arguments *a = arguments;
    RetexError err;
    if (job_set_option(&a->render, &a->sdl, o->name, o->argument ? cli->value : NULL, &err))
        cli_die(cli, "--%s", err.message);
}

static void take_seed(Cli *cli, const CliOption *o, void *arguments)
{
    take_render_option(cli, o, arguments);
    ((Arguments *)arguments)->seeded = 1;
}

static const CliOption options[] = {
    {"target", 't', "NAME[=IDENT,…]",
     "make everything #declared as IDENT (or NAME), or with the texture that pixel @X:Y shows, the target NAME; "
     "repeatable",
     0, CLI_LIST(Arguments, targets)},
    {"list-targets", 0, "=FILE",
     "print the identifiers that can be targets, with their share of the picture, and stop; with -v also objects, "
     "materials, colours and images; FILE gets a picture with the numbers of objects",
     0, CLI_CALL_OF_ALL(take_list_targets)},
    {"lamp", 'l', "NAME[=IDENT,…]",
     "keep the light of IDENT (or NAME) apart, so that it can be changed later; IDENT may be a light source, what "
     "emits, as of --target, light_source#N or sky; repeatable",
     0, CLI_LIST(Arguments, lamps)},
    {"lamps", 0, "each", "the same of each light that has a name, each light source, and the sky", 0,
     CLI_CALL(Arguments, each_lamp, take_lamps)},
    {"list-lamps", 0, NULL,
     "print the lamps that there are, or those of -l, with their share of the picture's light, and stop", 0,
     CLI_INTO(Arguments, list_lamps)},
    {"light-share", 0, "X", "least share of the samples of direct light for lamps, all alike; 0 to 1, default 0.1", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"finish", 0, "TARGET=NAME,…",
     "keep the light of a target's finishes apart, to choose from later: those that the scene declares, matt, satin, "
     "polished, metal, original; up to 4, the first one is in the picture; repeatable",
     0, CLI_LIST(Arguments, finishes)},
    {"show", 0, "TARGET=NAME", "another finish of --finish in the picture; repeatable", 0, CLI_LIST(Arguments, shown)},
    {"list-finishes", 0, NULL, "print the finishes that --finish can name, and stop", 0,
     CLI_INTO(Arguments, list_finishes)},
    {"list-cameras", 0, NULL, "print the cameras that --camera can name, and where they are, and stop", 0,
     CLI_INTO(Arguments, list_cameras)},
    {"light", 0, "NAME=VALUE",
     "render lamp NAME in another brightness or colour: 0, 2.5, #ffd0a0, 3000K, 1.5*3000K; as --light of "
     "retex-combine; repeatable",
     0, CLI_LIST(Arguments, lights)},
    {"solo", 0, "NAME", "turn off all lamps but NAME and those of --light", 0, CLI_INTO(Arguments, solo)},
    {"replace", 0, "NAME=IMAGE",
     "put IMAGE on a target and render: the reference for a retexture; opts as in retex-sample --texture", 1,
     CLI_CALL_OF_ALL(take_replace)},
    {"preset", 0, "FILE", "the same with a preset's textures, as of retex-combine; options go first", 0,
     CLI_INTO(Arguments, preset)},
    {"variants", 0, "FILE.csv",
     "render one --replace picture per row of a table, as retex-combine --batch; up to 16 share paths", 0,
     CLI_INTO(Arguments, variants)},
    {"control", 0, "SET", "with --replace: reduce noise by control variates from SET, a set of the same view", 0,
     CLI_INTO(Arguments, control)},
    {"control-mode", 0, "unbiased|halves|biased", "kind of control variates; default unbiased", 0,
     CLI_CALL(Arguments, control_mode, take_control_mode)},
    {"control-data", 0, "biased|unbiased", "add variances, as the paper's control variates need them", 0,
     CLI_CALL(Arguments, render.control_data, take_control_data)},
    {"plain", 0, NULL, "render the picture only, no set", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"layout", 0, "footprints|paper", "layout of the set; default footprints", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"clusters", 0, "K|S+B|S+B+X",
     "clusters of footprints per pixel and target, or at most S sharp and B broad ones, and X more sharp ones in "
     "mirrors and through glass; default 4+2+8",
     0, CLI_CALL_OF_ALL(take_render_option)},
    {"orders", 0, "N", "highest number of hits on a target kept apart, 1 to 6; default 6", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"strict-paper", 0, NULL, "with --layout paper: drop mixed terms of four and more hits, as the paper does", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"denoise", 0, "=preview|final", "denoise the result, as retex-denoise does", 0, CLI_CALL_OF_ALL(take_denoise)},
    {"no-denoise-data", 0, NULL, "omit the parts of the set that retex-denoise needs", 0,
     CLI_INTO(Arguments, no_denoise_data)},
    {"full-precision", 0, NULL, "keep all bits of the set's numbers, in a larger file", 0,
     CLI_INTO(Arguments, full_precision)},
    {"caustics", 0, NULL, "light sources throw caustics, as small lamps, through all glass and by all mirrors", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"no-caustics", 0, NULL, "light sources throw no caustics; default: as the scene asks by `photons`", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"caustics-guide", 0, NULL, "guide paths by photons, for caustics of small lamps", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"spp", 0, "N", "samples per pixel; default 64", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"noise", 0, "X", "adaptive sampling: as many samples, up to --spp, as keep the noise of each tile at most X", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"size", 0, "WxH", "size of the picture; default 640 wide with the scene's aspect ratio", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"unit", 0, "LENGTH", "what a scene unit is, for lengths of textures as in width=60cm: cm, 2.5cm, ft; default 1 m",
     0, CLI_CALL_OF_ALL(take_render_option)},
    {"seed", 0, "N", "seed of the random numbers; default 0", 0, CLI_CALL_OF_ALL(take_seed)},
    {"max-depth", 0, "N", "maximum number of segments of a path; default 16", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"crop", 0, "X,Y,W,H", "render only this rectangle of the picture", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"camera", 0, "NAME|X,Y,Z:X,Y,Z[:ANGLE]",
     "another camera: one that the scene declares, or where it is, what it looks at, and the horizontal angle of view",
     0, CLI_CALL(Arguments, sdl.camera, take_camera)},
    {"filter", 0, "box|gaussian", "pixel filter; default box", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"aov", 0, "LIST", "add parts, of: " RETEX_AOV_NAMES, 0, CLI_CALL_OF_ALL(take_render_option)},
    {"aov-dir", 0, "DIR", "also write the beauty and the AOVs of --aov, or all, as DIR/NAME.exr and .png", 0,
     CLI_INTO(Arguments, aov_dir)},
    {"mattes", 0, "FILE.exr", "also write a file for compositors: the picture, masks of targets, Cryptomatte", 0,
     CLI_INTO(Arguments, mattes)},
    {"matte-ranks", 0, "N", "names that Cryptomatte has in a pixel, 1 to 32; default 6", 0,
     CLI_CALL(Arguments, matte_ranks, take_matte_ranks)},
    {"include", 'I', "DIR", "also look for included files and images in DIR; repeatable", 0,
     CLI_LIST(Arguments, includes)},
    {"declare", 'D', "NAME=VALUE",
     "before the scene is read, declare a number or a quoted string, or set clock, frame_number, initial_frame or "
     "final_frame; repeatable",
     0, CLI_LIST(Arguments, declares)},
    {"ambient", 0, NULL, "treat `ambient` of all finishes as emission", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"no-ambient", 0, NULL, "treat no `ambient` as emission; default: strong `ambient`, in scenes without radiosity", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"lenient", 0, NULL, "render scenes with unsupported shapes or cameras, without them", 0,
     CLI_CALL_OF_ALL(take_render_option)},
    {"strict", 0, NULL, "treat unsupported features of the scene as errors", 0, CLI_CALL_OF_ALL(take_render_option)},
    {"resume", 0, NULL, "keep finished rows in OUTPUT.partial, and continue from that file if it exists", 0,
     CLI_INTO(Arguments, render.resume)},
    {"stats", 0, "FILE.json", "write times, numbers of rays and paths, and memory use; - is standard output", 0,
     CLI_INTO(Arguments, stats)},
    {"trace-pixel", 0, "X,Y,S", "print the path of sample S of the pixel, step by step, and stop", 0,
     CLI_CALL_OF_ALL(take_trace)},
    {"live", 0, NULL,
     "keep the scene open and answer requests for pictures of it, lines on standard input: see the manual", 0,
     CLI_INTO(Arguments, live)},
    {"max-steps", 0, "N", "limit reading the scene to N steps; default 200000000; also RETEX_MAX_STEPS", 0,
     CLI_CALL_OF_ALL(take_steps)},
    FRAMES_OPTION(Arguments, frames),
    CLI_PROGRESS_OPTION,
    BATCH_OPTIONS(Arguments, batch),
    {0},
};

/* Whether a warning was printed for an earlier frame; the frames of an animation have the same ones. Only so many are
 * kept. */
static int was_told(const char *text)
{
    static uint64_t told[1024];
    static size_t count;
    const uint64_t digest = digest_text(DIGEST_BEGIN, text);
    for (size_t k = 0; k < count; k++)
        if (told[k] == digest)
            return 1;
    if (count < sizeof told / sizeof *told)
        told[count++] = digest;
    return 0;
}

static void check_declares(const Arguments *a)
{
    RetexError err;
    for (int k = 0; k < a->ndeclares; k++)
        if (job_check_declare(a->declares[k], &err))
            cli_die(a->cli, "--declare: %s", err.message);
}

static void scene_message(void *context, int level, const char *text)
{
    const Cli *cli = context;
    if (level > 0 && cli->frame[0] && was_told(text))
        return;
    if (level > 0) /* a warning, printed also with -q */
        cli_message(cli, text);
    else
        cli_detail(cli, "%s", text);
}

static void progress(void *context, double done)
{
    cli_progress(context, "render", done);
}

/* Add a target, unless it is in the list. */
static void add_target(Arguments *a, const char *name)
{
    for (int k = 0; k < a->ntargets; k++)
        if (!strcasecmp(a->targets[k], name))
            return;
    a->targets[a->ntargets++] = name;
}

static void check_denoise(const Arguments *a)
{
    const char *quality = a->denoise_quality;
    if (!a->denoise)
        return;
    if (quality && strcmp(quality, "preview") != 0 && strcmp(quality, "final") != 0)
        cli_die(a->cli, "--denoise: expected preview or final, not '%s'", quality);
    if (a->no_denoise_data)
        cli_die(a->cli, "--denoise needs the data that --no-denoise-data omits");
    if (answers(a) || a->variants || a->control)
        cli_die(a->cli,
                "--denoise cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, "
                "--trace-pixel, --variants or --control");
    if (a->render.control_data)
        cli_die(a->cli, "--denoise and --control-data exclude each other");
    if (a->render.spp < 2)
        cli_die(a->cli, "--denoise needs at least two samples per pixel: one does not show the noise");
}

static void check_lamps(const Arguments *a)
{
    const int lamps = a->nlamps || a->each_lamp;
    if (a->nlamps && a->each_lamp)
        cli_die(a->cli, "--lamps each and -l exclude each other");
    if (lamps && a->render.paper)
        cli_die(a->cli, "--layout paper keeps no lamps apart");
    if (lamps && (a->render.control_data || a->control))
        cli_die(a->cli, "lamps cannot be combined with --control or --control-data");
    if (a->list + a->list_lamps + a->list_finishes + a->list_cameras + a->tracing > 1)
        cli_die(a->cli,
                "--list-targets, --list-lamps, --list-finishes, --list-cameras and --trace-pixel exclude each other");
}

/* An option, and whether it was given. */
typedef struct Given {
    int is_given;
    const char *name;
} Given;

/* The name of the first that was given, or NULL. */
static const char *first_given(const Given *given, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (given[k].is_given)
            return given[k].name;
    return NULL;
}

/* The option that asks for an answer in place of a picture, but for --live; or NULL. */
static const char *question_of(const Arguments *a)
{
    const Given questions[] = {{a->list, "list-targets"},
                               {a->list_lamps, "list-lamps"},
                               {a->list_finishes, "list-finishes"},
                               {a->list_cameras, "list-cameras"},
                               {a->tracing, "trace-pixel"}};
    return first_given(questions, sizeof questions / sizeof *questions);
}

/* What is no matter of pictures alone. */
static void check_live(Arguments *a)
{
    const RenderParams *r = &a->render;
    const Given others[] = {{question_of(a) != NULL, question_of(a)},
                            {a->variants != NULL, "variants"},
                            {a->control != NULL, "control"},
                            {r->control_data, "control-data"},
                            {a->denoise, "denoise"},
                            {a->aov_dir != NULL, "aov-dir"},
                            {r->aovs != 0, "aov"},
                            {a->mattes != NULL, "mattes"},
                            {r->noise > 0, "noise"},
                            {r->crop[2] != 0, "crop"},
                            {r->resume, "resume"}};
    const char *other = first_given(others, sizeof others / sizeof *others);
    if (!a->live)
        return;
    if (other)
        cli_die(a->cli, "--live cannot be combined with --%s", other);
    a->render.plain = 1;
}

static void check_finishes(const Arguments *a)
{
    if (a->nshown && !a->nfinishes)
        cli_die(a->cli, "--show chooses among the finishes of --finish, of which there are none");
    if (a->nfinishes && a->render.paper)
        cli_die(a->cli, "--layout paper keeps no finishes apart");
    if (a->nfinishes && (a->render.control_data || a->control))
        cli_die(a->cli, "--finish cannot be combined with --control or --control-data");
}

/* Without -t, --finish names targets. */
static void name_finished(Arguments *a)
{
    static char names[LIST_MAX][RETEX_NAME_MAX];
    for (int k = 0; k < a->nfinishes && !a->named; k++) {
        const char *equals = strrchr(a->finishes[k], '=');
        const size_t length = equals ? (size_t)(equals - a->finishes[k]) : 0;
        if (length == 0 || length >= RETEX_NAME_MAX || a->ntargets == LIST_MAX)
            continue; /* it is told later what is wrong */
        snprintf(names[k], RETEX_NAME_MAX, "%.*s", (int)length, a->finishes[k]);
        add_target(a, names[k]);
    }
}

static void check_noise(const Arguments *a)
{
    if (a->render.noise > 0 && (a->control || a->variants || a->render.control_data))
        cli_die(a->cli, "--noise cannot be combined with --control, --control-data or --variants: these need equal "
                        "samples per pixel");
}

/* --resume: a picture or set in pieces of rows. */
static void check_resume(const Arguments *a)
{
    const RenderParams *r = &a->render;
    if (!r->resume)
        return;
    if (answers(a) || a->variants || a->control || r->control_data)
        cli_die(a->cli, "--resume cannot be combined with --list-targets, --list-lamps, --list-finishes, "
                        "--list-cameras, --trace-pixel, --variants, --control or --control-data");
    if (!a->cli->output || !strcmp(a->cli->output, "-"))
        cli_die(a->cli, "--resume needs an output file: -o FILE");
}

static void check_mattes(Arguments *a)
{
    if (!a->mattes) {
        if (a->matte_ranks)
            cli_die(a->cli, "--matte-ranks is of the file that --mattes writes");
        return;
    }
    if (!cli_ends_with(a->mattes, ".exr"))
        cli_die(a->cli, "--mattes writes OpenEXR: expected a name that ends in .exr, not `%s`", a->mattes);
    if (answers(a) || a->variants || a->control)
        cli_die(a->cli,
                "--mattes cannot be combined with --list-targets, --list-lamps, --list-finishes, --list-cameras, "
                "--trace-pixel, --variants or --control");
    a->matte_ranks = a->matte_ranks ? a->matte_ranks : MATTE_RANKS;
}

/* Two positional arguments. The one that does not end in .pov may be the argument of a missing option. */
static _Noreturn void surplus_scene(const Arguments *a)
{
    char forgotten[1024] = "";
    const char *word = cli_ends_with(a->cli->value, ".pov") ? a->scene : a->cli->value;
    if (!cli_ends_with(word, ".pov"))
        cli_forgotten(a->cli, word, forgotten, sizeof forgotten);
    cli_die(a->cli, "one scene at a time: `%s` and `%s`%s", a->scene, a->cli->value, forgotten);
}

/* The words of the command line. */
static void read_words(Arguments *a)
{
    const CliOption *o;
    while ((o = cli_next(a->cli))) {
        if (o != &cli_positional)
            cli_take(a->cli, o, a);
        else if (take_ini_word(a, a->cli->value))
            continue;
        else if (a->scene)
            surplus_scene(a);
        else
            a->scene = a->cli->value;
    }
    a->named = a->ntargets > 0;
}

static void choose_clusters(Arguments *a, const RenderParams *defaults)
{
    if (a->render.paper && a->render.sharp)
        cli_die(a->cli, "--layout paper has no clusters: no --clusters");
    if (!a->render.sharp)
        a->render.sharp = defaults->sharp;
}

/* The table of --variants. --keep-going is of its rows, or of frames. */
static void open_variants(Arguments *a)
{
    if (a->variants) {
        batch_open(&a->batch, a->cli, a->variants);
        return;
    }
    if (a->frames.step || a->animation.last_frame >= 0)
        a->keep_going = a->batch.keep_going, a->batch.keep_going = 0;
    batch_check_options(&a->batch, a->cli, "variants");
}

/* Without -t, --replace and --variants name the targets. Both make pictures only. */
static void name_replaced(Arguments *a)
{
    if (!a->nreplacements && !a->variants)
        return;
    a->render.plain = 1;
    if (a->ntargets)
        return;
    for (int k = 0; k < a->nreplacements; k++)
        a->targets[a->ntargets++] = a->replacements[k].target;
    for (int k = 0; k < a->batch.table.ncolumns; k++)
        add_target(a, a->batch.table.columns[k]);
}

static void check_variants(const Arguments *a)
{
    if (!a->variants)
        return;
    if (a->cli->output)
        cli_die(a->cli, "the table of --variants names the outputs: no -o");
    if (answers(a) || a->render.aovs || a->stats)
        cli_die(a->cli, "--variants makes pictures only: no --list-targets, --list-lamps, --list-finishes, "
                        "--list-cameras, --trace-pixel, --aov or --stats");
}

static void check_control(const Arguments *a)
{
    if (!a->control)
        return;
    if (!a->nreplacements || a->variants)
        cli_die(a->cli, "--control needs --replace, without --variants");
    if (a->render.aovs || a->render.control_data)
        cli_die(a->cli, "--control makes a picture only: no --aov or --control-data");
}

static void check_aov_dir(Arguments *a)
{
    if (!a->aov_dir)
        return;
    if (answers(a) || a->variants || a->control)
        cli_die(a->cli, "--aov-dir cannot be combined with --list-targets, --list-lamps, --list-finishes, "
                        "--list-cameras, --trace-pixel, --variants or --control");
    if (!a->render.aovs)
        a->render.aovs = RETEX_AOV_ALL;
}

static void check_answer(const Arguments *a)
{
    const char *question = question_of(a), *answer = question ? question : a->live ? "live" : NULL;
    if (answer && a->cli->output)
        cli_die(a->cli, "--%s goes to standard output: no -o", answer);
    if (answer && a->stats)
        cli_die(a->cli, "--%s makes no picture, so there are no --stats", answer);
}

/* What all tools have in common, to where the scene's reader and the renderer look for it. */
static void hand_on_common(Arguments *a)
{
    Cli *cli = a->cli;
    a->sdl.include_paths = a->includes, a->sdl.ninclude_paths = a->nincludes;
    a->sdl.declares = a->declares, a->sdl.ndeclares = a->ndeclares;
    a->sdl.message = scene_message, a->sdl.message_context = cli;
    a->sdl.safe = cli->access.safe;
    a->sdl.accept_damaged = cli->access.accept_damaged;
    a->render.nthreads = a->sdl.nthreads = cli->threads;
    a->render.budget = a->sdl.budget = cli->budget;
    a->sdl.max_steps = cli->limits.steps;
    a->sdl.max_memory = SIZE_MAX; /* only the budget limits memory */
    a->render.progress = progress, a->render.progress_context = cli;
}

void parse_arguments(Arguments *a)
{
    const RenderParams defaults = RENDER_PARAMS_INIT;
    a->cli->options = options;
    a->render = defaults;
    a->render.sharp = 0; /* 0 until --clusters is given */
    a->sdl = (SdlOptions)SDL_OPTIONS_INIT;
    read_words(a);
    check_declares(a);
    take_ini_options(a);
    add_preset(a);
    if (!a->scene)
        cli_die(a->cli, "no scene given; try --help");
    choose_clusters(a, &defaults);
    open_variants(a);
    name_replaced(a);
    check_variants(a);
    check_control(a);
    check_live(a);
    name_lamps(a);
    name_finished(a);
    check_denoise(a);
    check_lamps(a);
    check_finishes(a);
    check_noise(a);
    check_resume(a);
    check_mattes(a);
    check_aov_dir(a);
    check_answer(a);
    hand_on_common(a);
}
