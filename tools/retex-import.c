/* retex-import: make a scene of a model in glTF, OBJ, FBX and other formats. See retex-import(1).
 *
 * A child process does all of it: it reads the model through Assimp and fills a new folder beside the output. It may
 * crash and run into its limits, and has no rights but to read files and to write to that folder. This process waits,
 * passes on messages, and at the end renames the folder or removes it. */
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/output_file.h>
#include <retex/retex.h>

#include "common/beneath.h"
#include "common/set_kind.h"
#include "common/cli.h"
#include "common/confine.h"
#include "common/output_folder.h"
#include "import/import.h"
#include "import/look.h"
#include "common/watchdog.h"

enum { MOST_FOLDERS = 32, MOST_FILES = 256, MOST_GIGABYTES = 8 /* of one file */ };

/* Where the user says nothing: models of 360000 triangles take 2 s and 300 MB. */
enum { READ_SECONDS = 300, READ_GIGABYTES = 8, LOOK_SECONDS = 60 /* at the scene */ };

typedef struct Request {
    ImportOptions import;
    const char *also[MOST_FOLDERS];
    const char *layer, *other_half;        /* of pictures; all else is for models */
    const char *first, *first_of_pictures; /* the first option that is for models, or for pictures; or NULL */
    double exposure; /* stops; NAN: by a look at the scene */
    int force, targets;
} Request;

static int lists_targets; /* see --targets */
static char offered[128];  /* the names of those that were told */
static int is_framed; /* of the scene that was written: see IMPORT_FRAMED */

static void take_axis(Cli *cli, const CliOption *option, void *to)
{
    if (strcmp(cli->value, "y") != 0 && strcmp(cli->value, "z") != 0)
        cli_die(cli, "--%s: expected y or z, not '%s'", option->name, cli->value);
    *(char *)to = cli->value[0];
}

static void take_scale(Cli *cli, const CliOption *option, void *to)
{
    ImportOptions *import = to;
    import->scale *= cli_number(cli, option, 1e-9, 1e9);
    import->is_scaled = 1;
}

static void take_unit(Cli *cli, const CliOption *option, void *to)
{
    ImportOptions *import = to;
    double metres;
    RetexError err = {0};
    if (retex_length_parse(&metres, cli->value, &err) || !(metres >= 1e-9 && metres <= 1e9))
        cli_die(cli, "--%s: expected a length such as cm, 2.5cm or ft, not '%s'", option->name, cli->value);
    import->scale *= metres;
    import->unit = 1;
}

static void take_include(Cli *cli, const CliOption *option, void *to)
{
    (void)option;
    Request *r = to;
    if (r->import.nalso == MOST_FOLDERS)
        cli_die(cli, "-I: more than %d folders", MOST_FOLDERS);
    r->also[r->import.nalso++] = cli->value;
}

static void take_exposure(Cli *cli, const CliOption *option, void *to)
{
    const int is_auto = strcmp(cli->value, "auto") == 0;
    *(double *)to = is_auto ? NAN : cli_number(cli, option, -RETEX_EXPOSURE_MAX, RETEX_EXPOSURE_MAX);
}

static const CliOption options[] = {
    {"camera", 0, "N",
     "the Nth camera of the model, or the one of that name; or inside, outside, or X,Y,Z:X,Y,Z[:ANGLE], where it is "
     "and what it looks at; default auto: the first, else inside of a room, else outside",
     0, CLI_INTO(Request, import.camera)},
    {"sky", 0, "FILE", "put a picture around the scene, which lights it: HDR, EXR, PNG, JPEG or TIFF", 0,
     CLI_INTO(Request, import.sky)},
    {"up", 0, "y|z", "the model's axis that is up; default what its format says", 0,
     CLI_CALL(Request, import.up, take_axis)},
    {"unit", 0, "LENGTH",
     "what a unit of the model is: cm, 2.5cm, ft; the scene has metres. Default: what its format or its room's height "
     "says",
     0, CLI_CALL(Request, import, take_unit)},
    {"scale", 0, "S", "multiply all lengths", 0, CLI_CALL(Request, import, take_scale)},
    {"lights", 0, "F", "multiply the light of all light sources", 0, CLI_NUMBER(Request, import.lights, 0, 1e9)},
    {"exposure", 0, "auto|STOPS",
     "by which pictures are brighter: what a first look at the scene asks for, the default, or 2^STOPS without a look",
     0, CLI_CALL(Request, exposure, take_exposure)},
    {"smooth", 0, "DEGREES", "smooth edges that are flatter than this, in meshes without normals", 0,
     CLI_NUMBER(Request, import.smooth, 0, 175)},
    {"include", 'I', "DIR", "also read files that the model names from DIR; repeatable", 0,
     CLI_CALL_OF_ALL(take_include)},
    {"partial", 0, NULL, "make the scene although images, objects or lights are lost", 0,
     CLI_INTO(Request, import.partial)},
    {"variant", 0, "NAME", "take the materials of this variant of a glTF file", 0, CLI_INTO(Request, import.variant)},
    {"list-variants", 0, NULL, "print the names of the variants of a glTF file, and stop", 0,
     CLI_INTO(Request, import.list_variants)},
    {"layer", 0, "NAME", "of a picture with light groups: the layer of all light; default: Combined", 0,
     CLI_INTO(Request, layer)},
    {"other-half", 0, "FILE", "of such a picture: a second render, with as many other samples", 0,
     CLI_INTO(Request, other_half)},
    {"targets", 0, NULL, "print the targets that the scene offers: name, selector, share of the view", 0,
     CLI_INTO(Request, targets)},
    {"force", 'f', NULL, "write into a folder that exists, and replace files of the same names there", 0,
     CLI_INTO(Request, force)},
    {0},
};

/* The folder that is being filled, and the same, open: whoever may write beside it may put a link in its place. The
 * name is read by the watchdog's thread. */
static char unfinished[PATH_MAX];
static int unfinished_folder = -1;
static _Atomic pid_t child;

static void remove_unfinished(const char *why)
{
    const pid_t pid = atomic_load(&child);
    (void)why;
    if (pid > 0) {
        kill(pid, SIGKILL);
        waitpid(pid, NULL, 0);
    }
    if (unfinished[0])
        output_remove_folder(unfinished);
}

_Noreturn static void give_up(const Cli *cli, const RetexError *err)
{
    remove_unfinished("");
    unfinished[0] = '\0';
    cli_fail(cli, err);
}

/* ---- the child ---- */

/* Messages go to the parent as lines: a letter and the text. */
static void send_line(void *context, char kind, const char *text)
{
    FILE *to = context;
    fputc(kind, to);
    for (const char *c = text; *c; c++)
        fputc(*c == '\n' ? ' ' : *c, to);
    fputc('\n', to);
    fflush(to);
}

_Noreturn static void run_child(const Cli *cli, ImportOptions *import, int to)
{
    RetexError err = {0};
    sigset_t none;
    const double seconds = cli->limits.seconds > 0 ? cli->limits.seconds : READ_SECONDS;
    const int nothing = open("/dev/null", O_RDWR);
    FILE *lines = fdopen(to, "w");
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(nothing, STDIN_FILENO); /* Assimp and the C++ runtime may print: only our lines count */
    dup2(nothing, STDOUT_FILENO);
    dup2(nothing, STDERR_FILENO);
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    signal(SIGINT, SIG_IGN); /* of the terminal: the parent ends this process */
    confine_limit(RLIMIT_CORE, 0);
    confine_limit(RLIMIT_CPU, (uint64_t)seconds + 1);
    confine_limit(RLIMIT_NOFILE, MOST_FILES);
    confine_limit(RLIMIT_FSIZE, (uint64_t)MOST_GIGABYTES << 30);
    if (retex_budget_memory(cli->budget))
        confine_memory(retex_budget_memory(cli->budget));
    if (import->folder)
        setenv("TMPDIR", import->folder, 1);
    confine_to_folder(unfinished_folder);
    unsetenv("OCIO"); /* images are written as sRGB */
    if (!lines)
        _exit(CLI_FAIL);
    import->context = lines;
    import->tell = send_line;
    const int code = import_model(import, &err);
    if (code)
        send_line(lines, 'e', err.message);
    fflush(lines);
    _exit(code ? CLI_FAIL : CLI_OK);
}

/* ---- the parent ---- */

static void take_target(const char *text)
{
    const size_t used = strlen(offered);
    snprintf(offered + used, sizeof offered - used, "%s%.*s", used ? ", " : "", (int)strcspn(text, "\t"), text);
    if (lists_targets)
        puts(text);
}

static void pass_on(const Cli *cli, char kind, const char *text)
{
    if (kind == IMPORT_WARNING)
        cli_warn(cli, "%s", text);
    else if (kind == IMPORT_FRAMED)
        is_framed = 1;
    else if (kind == IMPORT_TARGET)
        take_target(text);
    else if (kind == IMPORT_ANSWER)
        puts(text);
    else if (kind == IMPORT_INFO)
        cli_info(cli, "%s", text);
    else
        cli_detail(cli, "%s", text);
}

/* Why the child ended without a word. */
static int explain(const Cli *cli, const char *model, int status, RetexError *err)
{
    const int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (number == SIGXCPU)
        return retex_fail(err, RETEX_ELIMIT, "%s: not read within %g s of processor time; --max-time allows more",
                          model, cli->limits.seconds > 0 ? cli->limits.seconds : READ_SECONDS);
    if (number == SIGKILL)
        return retex_fail(err, RETEX_ELIMIT, "%s: the process that reads it was killed", model);
    return retex_fail(err, RETEX_EFORMAT,
                      "%s: the process that reads it ended (%s): it is damaged, or needs more than the %.0f MB of "
                      "--max-memory",
                      model, number ? strsignal(number) : "without a word",
                      (double)retex_budget_memory(cli->budget) / (1 << 20));
}

static int run_import(const Cli *cli, ImportOptions *import, RetexError *err)
{
    int ends[2], status;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return retex_fail(err, RETEX_EIO, "no pipe: %s", strerror(errno));
    fflush(NULL);
    const pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        run_child(cli, import, ends[1]);
    }
    close(ends[1]);
    if (pid < 0) {
        close(ends[0]);
        return retex_fail(err, RETEX_EIO, "no process to read the model: %s", strerror(errno));
    }
    atomic_store(&child, pid);
    FILE *lines = fdopen(ends[0], "r");
    char *line = NULL;
    size_t size = 0;
    int code = RETEX_OK;
    for (ssize_t length; lines && (length = getline(&line, &size, lines)) > 1;) {
        if (line[length - 1] == '\n')
            line[length - 1] = '\0';
        if (line[0] == 'e')
            code = retex_fail(err, RETEX_EFORMAT, "%s", line + 1);
        else
            pass_on(cli, line[0], line + 1);
    }
    free(line);
    if (lines)
        fclose(lines);
    pid_t ended;
    do
        ended = waitpid(pid, &status, 0);
    while (ended < 0 && errno == EINTR);
    atomic_store(&child, 0);
    if (!code && (ended != pid || status != 0))
        code = explain(cli, import->model, ended == pid ? status : 0, err);
    return code;
}

/* ---- the folder ---- */

static int fail_to_write(const char *folder, const char *name, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "cannot write %s/%s: %s", folder, name,
                      errno == ELOOP ? "there is a link on the way" : strerror(errno));
}

/* Into a folder that may hold a stranger's links: none is followed, and one in place of the file is replaced. */
static int move_file(int from, const char *name, int to, const char *path, const char *shown, RetexError *err)
{
    const char *last;
    const int parent = beneath_open_parent(to, path, 1, &last);
    const int is_done = parent >= 0 && renameat(from, name, parent, last) == 0;
    const int code = is_done ? RETEX_OK : fail_to_write(shown, path, err);
    if (parent >= 0)
        close(parent);
    return code;
}

/* Move the files of a folder, which is closed, to below another one. below: where they are moved to in it, "" or a path
 * with a slash at its end. shown: its name. */
static int move_files(int from, const char *below, int to, const char *shown, RetexError *err)
{
    DIR *list = from < 0 ? NULL : fdopendir(from);
    int code = list ? RETEX_OK : retex_fail(err, RETEX_EIO, "cannot read the new files: %s", strerror(errno));
    for (const struct dirent *entry; !code && (entry = readdir(list));) {
        char path[PATH_MAX];
        struct stat info;
        const char *name = entry->d_name;
        if (name[0] == '.')
            continue;
        const int is_folder = fstatat(from, name, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISDIR(info.st_mode);
        if (snprintf(path, sizeof path, "%s%s%s", below, name, is_folder ? "/" : "") >= (int)sizeof path)
            code = retex_fail(err, RETEX_EIO, "%s: the name is too long", shown);
        else if (is_folder)
            code = move_files(beneath_open(from, name, O_RDONLY | O_DIRECTORY, 0), path, to, shown, err);
        else
            code = move_file(from, name, to, path, shown, err);
    }
    if (list)
        closedir(list);
    return code;
}

/* The last part of the output's name, without slashes at its end. */
static void take_name(const Cli *cli, char folder[PATH_MAX], char name[NAME_MAX + 1])
{
    if (!cli->output)
        cli_die(cli, "no output: give a folder to make, -o NAME");
    size_t length = strlen(cli->output);
    while (length > 1 && cli->output[length - 1] == '/')
        length--;
    if (length >= PATH_MAX - 16)
        cli_die(cli, "-o: the name is too long");
    memcpy(folder, cli->output, length);
    folder[length] = '\0';
    const char *slash = strrchr(folder, '/'), *last = slash ? slash + 1 : folder;
    if (strcmp(cli->output, "-") == 0 || !*last || strcmp(last, ".") == 0 || strcmp(last, "..") == 0 ||
        strlen(last) > NAME_MAX - 16)
        cli_die(cli, "-o %s: expected the name of a folder to make", cli->output);
    const size_t length_of_last = strlen(last);
    if (length_of_last > 4 && strcasecmp(last + length_of_last - 4, ".pov") == 0)
        cli_die(cli, "-o %s: expected the name of a folder to make, without .pov: -o %.*s makes %.*s/%.*s.pov",
                cli->output, (int)length - 4, folder, (int)length - 4, folder, (int)length_of_last - 4, last);
    strcpy(name, last);
    for (const char *c = name; *c; c++)
        if (*c == '"' || *c == '\\' || (unsigned char)*c < 32)
            cli_die(cli, "-o: a scene's name cannot have quotes, backslashes or control characters");
}

/* The folder that is to be filled, if it is there; else -1. */
static int open_folder(const Cli *cli, const char *folder, int force)
{
    struct stat info;
    if (lstat(folder, &info) != 0)
        return -1;
    if (!force)
        cli_die(cli, "%s exists; --force writes into it", folder);
    const int there = beneath_open_top(folder, 0);
    if (there < 0)
        cli_die(cli, "cannot write into %s: %s", folder,
                errno == ELOOP ? "it is a link; name the folder that it leads to" : strerror(errno));
    return there;
}

static void begin_folder(const Cli *cli, const char *folder)
{
    snprintf(unfinished, sizeof unfinished, "%.4000s.XXXXXX", folder);
    watchdog_at_end(remove_unfinished);
    if (!mkdtemp(unfinished)) {
        const int why = errno;
        unfinished[0] = '\0';
        cli_die(cli, "cannot make the folder %s: %s", folder, strerror(why));
    }
    const mode_t mask = umask(0);
    umask(mask);
    unfinished_folder = beneath_open_top(unfinished, 0);
    if (unfinished_folder < 0 || fchmod(unfinished_folder, 0777 & ~mask) != 0) {
        RetexError err = {0};
        retex_fail(&err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
        give_up(cli, &err);
    }
}

/* ---- the first look ---- */

static void tell_look(const Cli *cli, const Look *look, const char *name)
{
    if (look->is_balanced)
        cli_info(cli, "the sky in the windows is much brighter than the room: a lamp is lit, %s in %s.pov, 0 without",
                 look->added, name);
    else if (look->added && look->is_noisy)
        cli_info(cli,
                 "the light of the model comes by few ways, as of a lamp in a housing or a sun behind glass, and is "
                 "noise in the picture: light is added, %s in %s.pov, 0 without",
                 look->added, name);
    else if (look->added && look->is_bare)
        cli_info(cli, "the model has no sky: one is added, %s in %s.pov, 0 without", look->added, name);
    else if (look->added)
        cli_info(cli,
                 "the light of the model reaches %.0f %% of what is seen: light is added, %s in %s.pov, 0 without",
                 100 * look->lit, look->added, name);
    if (!look->is_seen)
        cli_warn(cli, "nothing is seen in the picture: --camera chooses another view");
    else if (look->is_black)
        cli_warn(cli, "the picture is black: no light reaches what is seen; --sky FILE lights it, --camera another "
                      "view");
    else if (look->exposure != 0)
        cli_info(cli, "an exposure of %+.2f stops shows white things as white: retex_exposure in %s.pov",
                 look->exposure, name);
}

/* Exposure and missing light, by a small picture. Without one, the scene stays as the model has it. */
static void look(const Cli *cli, const Request *r)
{
    const LookParams params = {.folder = unfinished_folder,
                               .name = r->import.name,
                               .is_framed = is_framed,
                               .max_pixels = r->import.max_pixels,
                               .seconds = cli->limits.seconds > 0 ? cli->limits.seconds : LOOK_SECONDS,
                               .memory = retex_budget_memory(cli->budget),
                               .renderer = &child};
    Look seen = {0};
    RetexError err = {0};
    const int is_said = !isnan(r->exposure);
    if (is_said ? look_expose(&params, r->exposure, &err) : look_at(&seen, &params, &err))
        cli_warn(cli, "no look at the scene: %s", err.message);
    else if (!is_said)
        tell_look(cli, &seen, r->import.name);
}

static void import_to(const Cli *cli, Request *r)
{
    ImportOptions *import = &r->import;
    char folder[PATH_MAX], name[NAME_MAX + 1];
    RetexError err = {0};
    take_name(cli, folder, name);
    const int there = open_folder(cli, folder, r->force);
    import->looks = isnan(r->exposure);
    begin_folder(cli, folder);
    import->folder = unfinished;
    import->name = name;
    if (run_import(cli, import, &err))
        give_up(cli, &err);
    if (offered[0])
        cli_info(cli, "targets that are ready: %s; -t of retex-render takes them by name", offered);
    look(cli, r);
    watchdog_go_on();
    int code = RETEX_OK;
    if (there >= 0)
        code = move_files(unfinished_folder, "", there, folder, &err);
    else if (rename(unfinished, folder) != 0)
        code = retex_fail(&err, RETEX_EIO, "cannot make the folder %s: %s", folder, strerror(errno));
    if (code)
        give_up(cli, &err);
    if (there >= 0)
        remove_unfinished("");
    unfinished[0] = '\0';
    cli_info(cli, "wrote %s/%s.pov", folder, name);
}

/* ---- the command line ---- */

static void parse(Cli *cli, Request *r)
{
    ImportOptions *import = &r->import;
    for (const CliOption *option; (option = cli_next(cli));) {
        if (option == &cli_positional) {
            if (import->model)
                cli_surplus(cli, "one model at a time");
            import->model = cli->value;
            continue;
        }
        const int is_of_pictures = strcmp(option->name, "layer") == 0 || strcmp(option->name, "other-half") == 0;
        const char **first = is_of_pictures ? &r->first_of_pictures : &r->first;
        *first = *first ? *first : option->name;
        cli_take(cli, option, r);
    }
    if (!import->model)
        cli_die(cli, "no model given");
    if (strcmp(import->model, "-") == 0)
        cli_die(cli, "a model is read from a file, for it may name others");
}

/* ---- pictures with light groups ---- */

static int import_picture(Cli *cli, const char *path, const Request *request)
{
    RetexDenoisePictureParams params = RETEX_DENOISE_PICTURE_INIT;
    RetexSet *set = NULL;
    RetexError err = {0};
    if (request->first)
        cli_die(cli, "--%s is for models: %s is a picture", request->first, path);
    const char *output = cli_output(cli);
    if (set_kind_of_name(output) != &set_kind_exr && strcmp(output, "-") != 0)
        cli_die(cli, "-o %s: a picture with light groups becomes a set: expected a name that ends in .exr", output);
    if (request->other_half) {
        cli_input(cli, request->other_half, "the other half");
        cli_reads(cli, "--other-half", request->other_half);
    }
    cli_writes(cli, "the output", output);
    params.layers = &request->layer;
    params.nlayers = request->layer != NULL;
    params.other_half = request->other_half;
    params.access = &cli->access;
    params.note = cli_note;
    params.note_context = cli;
    if (retex_output_check(output, &err) ||
        retex_set_read_light_groups(&set, path, &params, cli->budget, cli->threads, &err) ||
        set_kind_exr.write(set, output, cli->threads, &err))
        cli_fail(cli, &err);
    const RetexSetInfo info = retex_set_info(set);
    cli_info(cli, "%s: %d x %d, %d lamps", strcmp(output, "-") == 0 ? "standard output" : output, info.width,
             info.height, info.nparameters);
    retex_set_close(&set);
    return cli_close(cli, CLI_OK);
}

static int list_variants(Cli *cli, ImportOptions *import)
{
    RetexError err = {0};
    if (run_import(cli, import, &err))
        cli_fail(cli, &err);
    return cli_close(cli, CLI_OK);
}

int main(int argc, char **argv)
{
    Cli cli = {.tool = "retex-import",
               .usage = "MODEL -o NAME [options]",
               .about = "Make a scene of a model of another program. It reads glTF, OBJ, FBX, Collada, 3DS, PLY, STL "
                        "and what else Assimp reads. The folder NAME gets NAME.pov, its meshes and its textures. Of a "
                        "picture of Cycles with light groups, make a set with lamps.",
               .options = options,
               .argc = argc,
               .argv = argv,
               .next = 1};
    Request request = {.import = {.scale = 1, .lights = 1, .also = request.also}, .exposure = NAN};
    ImportOptions *import = &request.import;

    parse(&cli, &request);
    cli_input(&cli, import->model, "a model");
    cli_reads(&cli, "the model", import->model);
    if (retex_is_picture(import->model, &cli.access))
        return import_picture(&cli, import->model, &request);
    if (request.first_of_pictures)
        cli_die(&cli, "--%s is for pictures with light groups: %s is no OpenEXR picture", request.first_of_pictures,
                import->model);
    cli_reads(&cli, "--sky", import->sky);
    import->safe = cli.access.safe ? 2 : 0; /* the process that reads the model decodes its pictures, too */
    import->accept_damaged = cli.access.accept_damaged;
    import->max_pixels = cli.limits.pixels;
    import->budget = cli.budget;
    const uint64_t most = retex_budget_memory(cli.budget), usual = (uint64_t)READ_GIGABYTES << 30;
    if (!cli.limits.memory && (!most || most > usual))
        retex_budget_set_memory(cli.budget, usual);
    if (import->list_variants)
        return list_variants(&cli, import);
    lists_targets = request.targets;
    import_to(&cli, &request);
    if (lists_targets)
        return cli_close(&cli, CLI_OK);
    watchdog_done(); /* nothing goes to standard output, which need not be closed well */
    return CLI_OK;
}
