/* retex-try: from a model and a picture of a floor to a web page, by the other tools. See retex-try(1).
 *
 * Each step is a command that runs in a folder of its own, work, which is removed in the end or kept by another name.
 * The page is a second folder. Both lie beside what they become. */
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/retex.h>

#include "common/cli.h"
#include "common/output_folder.h"
#include "common/texture_args.h"
#include "common/watchdog.h"
#include "try/command.h"

#define FLOOR "Floor"
#define WALL "Wall"
enum { MOST_TARGETS = 8, MOST_ENDING = 16 };

/* Seconds of processor time in which a pixel is denoised and packed, of a set with one target, and what a second one
 * adds: measured at 640x480. */
#define AFTER_RENDER 60e-6
#define AFTER_TARGET 35e-6
/* Samples of a denoised set. Fewer leave blotches; a smaller picture is better than few; more hardly change it. */
enum { LEAST_SAMPLES = 16, GOOD_SAMPLES = 32, MOST_SAMPLES = 256, QUICK_SAMPLES = 2 };

typedef struct Job {
    const char *room, *floor, *wall;
    const char *camera, *width, *keep;
    const char *targets[MOST_TARGETS];
    int ntargets;
    int size[2], samples; /* 0: by the time */
    double seconds;
    int force, in_place; /* in_place: the page goes into a folder that is there */
    int has_wall;        /* Wall is a target, too */
    char view[16];       /* another one of those that the scene declares; "": its first */
} Job;

static void take_size(Cli *cli, const CliOption *option, void *member)
{
    int *size = member;
    char rest;
    if (sscanf(cli->value, "%5dx%5d%c", &size[0], &size[1], &rest) != 2 || size[0] < 16 || size[1] < 16 ||
        size[0] > 16384 || size[1] > 16384)
        cli_die(cli, "--%s: expected WxH, 16x16 to 16384x16384, not '%s'", option->name, cli->value);
}

static void take_width(Cli *cli, const CliOption *option, void *member)
{
    double metres;
    RetexError err = {0};
    if (retex_length_parse(&metres, cli->value, &err) || !(metres > 0))
        cli_die(cli, "--%s: expected a length such as 60cm, 2ft or 1.2, which are metres, not '%s'", option->name,
                cli->value);
    *(const char **)member = cli->value;
}

static const CliOption options[] = {
    {"width", 0, "LENGTH", "how wide one picture is on the floor and the wall: 60cm, 2ft, 1.2; default 1m", 0,
     CLI_CALL(Job, width, take_width)},
    {"time", 0, "SECONDS", "about how long all of it may take; default 100", 0, CLI_NUMBER(Job, seconds, 1, 1e6)},
    {"size", 0, "WxH", "size of the picture; default 640, 960 or 1280 wide, as the time allows", 0,
     CLI_CALL(Job, size, take_size)},
    {"spp", 0, "N", "samples per pixel; default as the time allows", 0, CLI_NUMBER(Job, samples, 2, 65536)},
    {"camera", 0, "WHICH", "another view, as of retex-import", 0, CLI_INTO(Job, camera)},
    {"target", 't', "NAME=IDENT", "what is the floor, or the wall: Floor=IDENT, as of retex-render; repeatable", 0,
     CLI_LIST(Job, targets)},
    {"keep", 0, "DIR", "keep the scene, the set and the picture in a new folder", 0, CLI_INTO(Job, keep)},
    {"force", 'f', NULL, "write the page into a folder that exists", 0, CLI_INTO(Job, force)},
    {0},
};

/* ---- the folders ---- */

static Command command;
/* The folders that are being filled, absolute; read by the watchdog's thread. "": there is none. */
static char work[PATH_MAX], page[PATH_MAX];

static void clean_up(void)
{
    command_end(&command, page[0] ? SIGKILL : SIGTERM); /* in a folder of the user it has to clean up itself */
    if (page[0])
        output_remove_folder(page);
    if (work[0])
        output_remove_folder(work);
    page[0] = work[0] = '\0';
}

static void end_early(const char *why)
{
    (void)why;
    clean_up();
}

/* A new folder beside the one that it will become. */
static void make_folder(const Cli *cli, char folder[PATH_MAX], const char *name)
{
    char real[PATH_MAX];
    int missing = 0;
    RetexError err = {0};
    const mode_t mask = umask(0);
    umask(mask);
    if (output_resolve(real, &missing, name, name, &err))
        cli_fail(cli, &err);
    snprintf(folder, PATH_MAX, "%.*s.XXXXXX", PATH_MAX - MOST_ENDING, real);
    if (!mkdtemp(folder)) {
        const int why = errno;
        folder[0] = '\0';
        cli_die(cli, "cannot make the folder %s: %s", name, strerror(why));
    }
    if (chmod(folder, 0777 & ~mask))
        cli_die(cli, "cannot make the folder %s: %s", name, strerror(errno));
}

static void rename_folder(const Cli *cli, char from[PATH_MAX], const char *to)
{
    if (rename(from, to))
        cli_die(cli, "cannot make the folder %s: %s", to, strerror(errno));
    from[0] = '\0';
}

/* The name of a folder to make, without slashes at its end. */
static const char *check_folder(const Cli *cli, const char *option, const char *asked, int may_exist)
{
    char *name = strdup(asked);
    if (!name)
        cli_die(cli, "not enough memory");
    for (size_t length = strlen(name); length > 1 && name[length - 1] == '/'; length--)
        name[length - 1] = '\0';
    const char *last = strrchr(name, '/') ? strrchr(name, '/') + 1 : name;
    if (!*last || strcmp(last, "-") == 0 || strcmp(last, ".") == 0 || strcmp(last, "..") == 0 ||
        strlen(last) > NAME_MAX - MOST_ENDING)
        cli_die(cli, "%s %s: expected the name of a folder to make", option, asked);
    if (!may_exist && access(name, F_OK) == 0)
        cli_die(cli, "%s exists%s", name, option[1] == 'o' ? "; --force writes into it" : "");
    return name;
}

/* ---- words of commands ---- */

/* A file of the user: commands do not run where it is named from. key: what stands before it, as "Floor=". */
static void add_file(const char *key, const char *file)
{
    char here[PATH_MAX], *word = NULL, *printed = NULL;
    const int is_relative = file[0] != '/' && access(file, F_OK) == 0 && getcwd(here, sizeof here);
    if (asprintf(&printed, "%s%s", key, file) < 0 ||
        asprintf(&word, "%s%s%s%s", key, is_relative ? here : "", is_relative ? "/" : "", file) < 0)
        cli_die(command.cli, "not enough memory for a command");
    command_add(&command, word, printed);
    free(word);
    free(printed);
}

/* A file in the folder of work. */
static void add_made(const Job *job, const char *key, const char *name)
{
    char *word = NULL, *printed = NULL;
    if (asprintf(&word, "%s%s", key, name) < 0 ||
        asprintf(&printed, "%s%s%s%s", key, job->keep ? job->keep : "", job->keep ? "/" : "", name) < 0)
        cli_die(command.cli, "not enough memory for a command");
    command_add(&command, word, printed);
    free(word);
    free(printed);
}

static void add(const char *word)
{
    command_add(&command, word, NULL);
}

/* ---- the road ---- */

static void import(const Job *job)
{
    command_begin(&command, "retex-import");
    if (job->camera)
        command_addf(&command, "--camera=%s", job->camera);
    add("-o"), add_made(job, "", "room"), add("--"), add_file("", job->room);
    command_run(&command, "A scene of the model, with a view and light.", NULL, NULL);
}

/* What the list of targets has, in percent of the picture, and what else is seen. */
typedef struct Listed {
    double floor, wall;
    char seen[256];
    int count;
} Listed;

static void take_listed(void *to, const char *line)
{
    Listed *listed = to;
    double share = 0;
    int at = 0;
    if (sscanf(line, " %lf%% %n", &share, &at) < 1 || !at)
        return;
    const char *name = line + at;
    const int length = (int)strcspn(name, "\t\n");
    const size_t used = strlen(listed->seen);
    if (length == (int)strlen(FLOOR) && strncmp(name, FLOOR, (size_t)length) == 0)
        listed->floor = share;
    else if (length == (int)strlen(WALL) && strncmp(name, WALL, (size_t)length) == 0)
        listed->wall = share;
    else if (share > 0 && listed->count++ < 5)
        snprintf(listed->seen + used, sizeof listed->seen - used, "%s%.*s", used ? ", " : "", length, name);
}

static int is_told(const Job *job, const char *name)
{
    const size_t length = strlen(name);
    for (int i = 0; i < job->ntargets; i++)
        if (strncmp(job->targets[i], name, length) == 0 && job->targets[i][length] == '=')
            return 1;
    return 0;
}

static void add_view(const Job *job)
{
    if (job->view[0])
        command_addf(&command, "--camera=%s", job->view);
}

static Listed list_targets(const Job *job)
{
    Listed listed = {0};
    command_begin(&command, "retex-render");
    add("--list-targets"), add_view(job), add("--"), add_made(job, "", "room/room.pov");
    command_run(&command, "What can get another texture.", take_listed, &listed);
    cli_plain(listed.seen);
    return listed;
}

/* Whether the scene that was imported declares a camera of this name. */
static int has_view(const char *name)
{
    char path[PATH_MAX + 16], declared[64], line[256];
    int found = 0;
    snprintf(path, sizeof path, "%s/room/room.pov", work);
    snprintf(declared, sizeof declared, "#declare %s = camera", name);
    FILE *scene = fopen(path, "r");
    while (scene && !found && fgets(line, sizeof line, scene))
        found = strncmp(line, declared, strlen(declared)) == 0;
    if (scene)
        fclose(scene);
    return found;
}

/* If the first view has no floor, the next best one that has, unless the user has chosen it. */
static Listed look_round(Job *job)
{
    Listed listed = list_targets(job);
    for (int k = 2; !(listed.floor > 0) && !is_told(job, FLOOR) && !job->camera; k++) {
        snprintf(job->view, sizeof job->view, "View_%d", k);
        if (!has_view(job->view)) {
            job->view[0] = '\0';
            break;
        }
        command.total++;
        listed = list_targets(job);
    }
    return listed;
}

static void find_targets(const Cli *cli, Job *job)
{
    const Listed listed = look_round(job);
    const char *seen = listed.count ? listed.seen : "no surfaces";
    if (!(listed.floor > 0) && !is_told(job, FLOOR))
        cli_die(cli,
                "no floor is seen: choose another view, --camera inside or X,Y,Z:X,Y,Z, or say what the floor is, "
                "-t Floor=NAME; seen are %s", seen);
    job->has_wall = listed.wall > 0 || is_told(job, WALL);
    if (job->wall && !job->has_wall)
        cli_die(cli,
                "no wall is seen: leave out %s, choose another view, --camera inside or X,Y,Z:X,Y,Z, or say what the "
                "wall is, -t Wall=NAME; seen are %s", job->wall, seen);
}

static void begin_render(const Job *job)
{
    command_begin(&command, "retex-render");
    if (!is_told(job, FLOOR))
        add("-t"), add(FLOOR);
    if (job->has_wall && !is_told(job, WALL))
        add("-t"), add(WALL);
    for (int i = 0; i < job->ntargets; i++)
        add("-t"), add(job->targets[i]);
    add_view(job);
    if (job->size[0])
        command_addf(&command, "--size=%dx%d", job->size[0], job->size[1]);
}

static void take_seconds(void *to, const char *line)
{
    sscanf(line, " \"render_seconds\": %lf", (double *)to);
}

/* What a path takes, and the size that the scene asks for, by a picture of few samples. */
static double time_paths(const Cli *cli, const Job *job, int size[2])
{
    char path[PATH_MAX + 16];
    double seconds = 0;
    RetexSet *set = NULL;
    RetexError err = {0};
    begin_render(job);
    command_addf(&command, "--spp=%d", QUICK_SAMPLES), add("--stats=-");
    add("-o"), add_made(job, "", "quick.exr"), add("--"), add_made(job, "", "room/room.pov");
    command_run(&command, "A quick render, which tells how long a good one takes.", take_seconds, &seconds);
    snprintf(path, sizeof path, "%s/quick.exr", work);
    if (retex_set_open(path, &set, cli->threads, &err))
        cli_fail(cli, &err);
    size[0] = retex_set_info(set).width, size[1] = retex_set_info(set).height;
    retex_set_close(&set);
    return seconds / QUICK_SAMPLES / size[0] / size[1];
}

/* The largest size for which there is time for good samples. started: when all of this began. */
static void choose_quality(const Cli *cli, Job *job, double started)
{
    static const int widths[] = {1280, 960, 640};
    int size[2];
    if (job->size[0] && job->samples)
        return;
    const double path = time_paths(cli, job, size), left = job->seconds - (retex_clock_seconds() - started);
    const double after = (AFTER_RENDER + job->has_wall * AFTER_TARGET) / fmax(command.share, 0.05);
    const int is_sized = job->size[0] > 0, good = job->samples ? job->samples : GOOD_SAMPLES;
    for (int i = is_sized ? 2 : 0; i < 3; i++) {
        const int width = is_sized ? size[0] : widths[i], height = (int)lround((double)width * size[1] / size[0]);
        const double pixels = (double)width * height, samples = (left / pixels - after) / path;
        if (samples < good && i < 2)
            continue;
        job->size[0] = width, job->size[1] = height;
        job->samples = job->samples ? job->samples : (int)fmin(fmax(samples, LEAST_SAMPLES), MOST_SAMPLES);
        return;
    }
}

static void render(const Job *job)
{
    begin_render(job);
    command_addf(&command, "--spp=%d", job->samples), add("--denoise");
    add("-o"), add_made(job, "", "room.exr"), add("--"), add_made(job, "", "room/room.pov");
    command_run(&command, "A set: the light of the room, which is the same for all textures.", NULL, NULL);
}

static void combine(const Job *job)
{
    command_begin(&command, "retex-combine");
    command_addf(&command, "--texture:width=%s", job->width), add_file(FLOOR "=", job->floor);
    if (job->wall)
        command_addf(&command, "--texture:width=%s", job->width), add_file(WALL "=", job->wall);
    add_made(job, "--save-preset=", "look.json"), add("-o"), add_made(job, "", "room.jpg");
    add("--"), add_made(job, "", "room.exr");
    command_run(&command, "A picture with the new textures, and a preset, which says how they lie.", NULL, NULL);
}

static void pack(const Cli *cli, const Job *job)
{
    command_begin(&command, "retex-pack");
    add_made(job, "--preset=", "look.json"), add("--web");
    if (job->in_place)
        add_file("", cli->output);
    else
        command_add(&command, page, cli->output);
    add("--"), add_made(job, "", "room.exr");
    command_run(&command, "A web page, in which visitors choose others.", NULL, NULL);
}

/* ---- the command line ---- */

/* That a picture cannot be read is not to be told after the render. */
static void check_texture(const Cli *cli, const Job *job, const char *target, const char *picture)
{
    char *words = NULL, *value = NULL, *file = NULL;
    RetexEdit *edit = NULL;
    RetexError err = {0};
    RetexReadParams read = RETEX_READ_INIT;
    if (!picture)
        return;
    if (asprintf(&words, "width=%s", job->width) < 0 || asprintf(&value, "%s=%s", target, picture) < 0)
        cli_die(cli, "not enough memory");
    read.access = &cli->access;
    int code = retex_edit_create(&edit, &err);
    if (!code)
        code = retex_edit_option(edit, words, value, &err);
    if (!code) {
        RetexTextureSpec *spec = retex_edit_texture(edit, 0);
        texture_args_read_by(cli, spec);
        code = texture_args_add_input(spec, &err);
        if (!code)
            code = retex_texture_file(&file, spec, RETEX_TEXTURE_FILE_IMAGE, &err);
    }
    if (!code && file)
        code = retex_image_read_check(file, &read, &err);
    free(file);
    free(value);
    free(words);
    retex_edit_close(&edit);
    if (code)
        cli_fail(cli, &err);
}

static void check(Cli *cli, Job *job)
{
    if (!job->room || !job->floor)
        cli_die(cli, "no %s given; try --help", job->room ? "picture of a floor" : "model");
    if (!cli->output)
        cli_die(cli, "no output: give a folder to make, -o page");
    cli->output = check_folder(cli, "-o", cli->output, job->force);
    job->in_place = access(cli->output, F_OK) == 0;
    job->keep = job->keep ? check_folder(cli, "--keep", job->keep, 0) : NULL;
    if (cli->limits.seconds > 0) /* all must be done by then */
        job->seconds = fmin(job->seconds, 0.8 * cli->limits.seconds);
    cli_input(cli, job->room, "a model, such as room.glb");
    cli_reads(cli, "the model", job->room);
    if (access(job->room, R_OK))
        cli_die(cli, "cannot read %s: %s", job->room, strerror(errno));
    check_texture(cli, job, FLOOR, job->floor);
    check_texture(cli, job, WALL, job->wall);
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-try",
               .options = options,
               .argc = argc,
               .argv = argv,
               .usage = "ROOM.glb FLOOR.jpg [WALL.jpg] -o DIR",
               .about = "Make a web page of a model with another floor. It prints the commands that it runs."};
    Job job = {.width = "1m", .seconds = 100};
    const double started = retex_clock_seconds();
    cli_parse(&cli, &job, CLI_ARGUMENTS(&job.room, &job.floor, &job.wall), "a model, a floor and a wall are enough");
    check(&cli, &job);
    command.cli = &cli, command.folder = work;
    command.total = job.size[0] && job.samples ? 5 : 6;
    atexit(clean_up);
    watchdog_at_end(end_early);
    make_folder(&cli, work, job.keep ? job.keep : cli.output);
    if (!job.in_place)
        make_folder(&cli, page, cli.output);
    import(&job);
    find_targets(&cli, &job);
    choose_quality(&cli, &job, started);
    render(&job);
    combine(&job);
    pack(&cli, &job);
    if (!job.in_place)
        rename_folder(&cli, page, cli.output);
    if (job.keep)
        rename_folder(&cli, work, job.keep);
    cli_info(&cli, "wrote %s: %d x %d, %d samples, %.0f s; python3 -m http.server -b 127.0.0.1 -d %s shows it",
             cli.output, job.size[0], job.size[1], job.samples, retex_clock_seconds() - started, cli.output);
    clean_up();
    return cli_close(&cli, CLI_OK);
}
