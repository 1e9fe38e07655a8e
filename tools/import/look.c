/* See look.h. */
#include "import/look.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/retex.h>

#include "common/beneath.h"
#include "common/beside.h"
#include "common/output_folder.h"
#include "import/base/look_text.h"
#include "import/meter.h"

#define PICTURE ".look.exr"
#define MOST_LAMPS 8 /* times the light of a room is added for windows that are not white */
enum { MOST_STOPS = 14, WHY_SIZE = 512 };

/* ---- the folder ---- */

/* Link what is there into another folder, but for what that has by the same name. Both are closed. */
static int link_files(int from, int to)
{
    DIR *list = from < 0 ? NULL : fdopendir(from);
    int is_done = list && to >= 0;
    for (const struct dirent *entry; is_done && (entry = readdir(list));) {
        struct stat info;
        if (fstatat(from, entry->d_name, &info, AT_SYMLINK_NOFOLLOW) == 0 && S_ISREG(info.st_mode))
            is_done = linkat(from, entry->d_name, to, entry->d_name, 0) == 0 || errno == EEXIST;
    }
    if (list)
        closedir(list);
    if (to >= 0)
        close(to);
    return is_done;
}

static int open_folder(int top, const char *name)
{
    return beneath_open(top, name, O_RDONLY | O_DIRECTORY, 0);
}

/* The scene in a folder of its own, with small copies of its pictures: its text is the same file. -1: it cannot be. */
static int open_small(int folder)
{
    const int is_linked = link_files(open_folder(folder, ""), open_folder(folder, LOOK_FOLDER)) &&
                          link_files(open_folder(folder, "textures"), open_folder(folder, LOOK_FOLDER "/textures"));
    return is_linked ? open_folder(folder, LOOK_FOLDER) : -1;
}

/* ---- the picture ---- */

/* Names of files below the folder, whatever becomes of its own name. */
static void path_of(const LookParams *params, const char *name, const char *ending, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "/proc/self/fd/%d/%s%s", params->folder, name, ending);
}

_Noreturn static void become_renderer(const LookParams *params, const char *program, int errors)
{
    char scene[PATH_MAX], picture[PATH_MAX], size[32], time[32], memory[32], pixels[32];
    /* the pictures are a stranger's: they are decoded without rights */
    const char *argv[24] = {program, "--safe", "--accept-damaged",  "-q", "--size", size, "--spp",
                            "8",     "--aov",  "depth,reflectance", "-o", picture};
    int argc = 12;
    const int nothing = open("/dev/null", O_RDWR);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    dup2(nothing, STDIN_FILENO), dup2(nothing, STDOUT_FILENO), dup2(errors, STDERR_FILENO);
    fcntl(params->folder, F_SETFD, 0); /* it stays open */
    path_of(params, params->name, ".pov", scene), path_of(params, PICTURE, "", picture);
    snprintf(size, sizeof size, "%dx%d", METER_WIDTH, METER_HEIGHT);
    snprintf(time, sizeof time, "%.3f", params->seconds);
    if (params->seconds > 0)
        argv[argc++] = "--max-time", argv[argc++] = time;
    snprintf(memory, sizeof memory, "%lluM", (unsigned long long)(params->memory >> 20));
    if (params->memory)
        argv[argc++] = "--max-memory", argv[argc++] = memory;
    snprintf(pixels, sizeof pixels, "%ld", params->max_pixels);
    if (params->max_pixels)
        argv[argc++] = "--max-pixels", argv[argc++] = pixels;
    argv[argc++] = "--", argv[argc++] = scene;
    execv(program, (char *const *)argv);
    _exit(127);
}

/* What the renderer says is wrong, without the names of this folder; "" where it says nothing. */
static void read_error(const LookParams *params, int errors, char why[WHY_SIZE])
{
    char line[4096], folder[64];
    const int length = snprintf(folder, sizeof folder, "/proc/self/fd/%d/", params->folder);
    FILE *from = fdopen(errors, "r");
    *why = '\0';
    while (from && fgets(line, sizeof line, from)) {
        const char *said = strstr(line, "error: ");
        for (char *at; (at = strstr(line, folder));)
            memmove(at, at + length, strlen(at + length) + 1);
        if (said && !*why)
            snprintf(why, WHY_SIZE, ": %.*s", (int)strcspn(said + 7, "\n"), said + 7);
    }
    if (from)
        fclose(from);
    else
        close(errors);
}

static int render(const LookParams *params, RetexError *err)
{
    char program[PATH_MAX], why[WHY_SIZE];
    int ends[2], status = 0;
    pid_t ended;
    if (!beside_program(program, "retex-render"))
        return retex_fail(err, RETEX_ENOTFOUND, "there is no retex-render beside retex-import");
    if (pipe2(ends, O_CLOEXEC) != 0)
        return retex_fail(err, RETEX_EIO, "no pipe: %s", strerror(errno));
    const pid_t pid = fork();
    if (pid == 0)
        become_renderer(params, program, ends[1]);
    close(ends[1]);
    if (pid < 0) {
        close(ends[0]);
        return retex_fail(err, RETEX_EIO, "no process to render: %s", strerror(errno));
    }
    atomic_store(params->renderer, pid);
    read_error(params, ends[0], why);
    do
        ended = waitpid(pid, &status, 0);
    while (ended < 0 && errno == EINTR);
    atomic_store(params->renderer, 0);
    return ended == pid && status == 0 ? RETEX_OK
                                       : retex_fail(err, RETEX_EFORMAT, "its scene cannot be rendered%s", why);
}

static int see(const LookParams *params, Meter *seen, RetexError *err)
{
    char path[PATH_MAX];
    RetexSet *set = NULL;
    int code = render(params, err);
    path_of(params, PICTURE, "", path);
    if (!code)
        code = retex_set_read(path, &set, 1, err);
    unlinkat(params->folder, PICTURE, 0);
    if (!code)
        meter_read(seen, set);
    retex_set_close(&set);
    return code;
}

/* ---- the numbers in the scene ---- */

/* The number after a text of the scene; new digits take its place if value is no NAN. Returns NAN where there is none,
 * or it cannot be replaced. */
static double number_after(const LookParams *params, const char *key, const char *format, double value)
{
    char path[PATH_MAX], number[32], *line = NULL;
    double was = NAN;
    size_t size = 0;
    snprintf(path, sizeof path, "%s.pov", params->name);
    const int file = openat(params->folder, path, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    FILE *text = file < 0 ? NULL : fdopen(file, "r");
    off_t at = 0;
    for (ssize_t length; isnan(was) && text && (length = getline(&line, &size, text)) > 0; at += length) {
        const char *found = strstr(line, key);
        if (found)
            was = strtod(found + strlen(key), NULL), at += found - line + (off_t)strlen(key) - length;
    }
    const int digits = snprintf(number, sizeof number, format, value);
    if (!isnan(was) && !isnan(value) && pwrite(file, number, (size_t)digits, at) != digits)
        was = NAN;
    free(line);
    if (text)
        fclose(text);
    else if (file >= 0)
        close(file);
    return was;
}

static int put_number(const LookParams *params, const char *key, const char *format, double value, RetexError *err)
{
    return isnan(number_after(params, key, format, value))
               ? retex_fail(err, RETEX_EIO, "cannot write to %s.pov", params->name)
               : RETEX_OK;
}

int look_expose(const LookParams *params, double stops, RetexError *err)
{
    return put_number(params, LOOK_EXPOSURE, LOOK_EXPOSURE_FORMAT, stops, err);
}

/* Light is enough if most of what is seen can be exposed. */
static int is_enough(const Meter *seen, const LookParams *params)
{
    return seen->bright > 0 && seen->dark < 0.35 && seen->stops < MOST_STOPS && !seen->is_noisy &&
           !(params->is_framed && meter_is_bare(seen));
}

/* As bright as what there is, or much brighter than its noise; the light that is added makes about a fifth. */
static double added_to(const Meter *seen)
{
    return fmax(1, fmin((seen->is_noisy ? 4 : 1) * meter_mean(seen) / 0.2, 1e5));
}

/* Look again with a light of that strength; without that look the scene has it as it was. */
static int see_lit(const LookParams *params, const char *declared, double strength, double was, Meter *seen,
                   RetexError *err)
{
    int code = put_number(params, declared, LOOK_ADDED_FORMAT, strength, err);
    if (!code && (code = see(params, seen, err)))
        put_number(params, declared, LOOK_ADDED_FORMAT, was, NULL);
    return code;
}

/* The sky first, which lights more than one room; where it is not enough or not there, a lamp. */
static int add_light(Look *look, const LookParams *params, Meter *seen, RetexError *err)
{
    static const struct {
        const char *name, *declared;
    } lights[] = {{LOOK_ADDED_SKY, LOOK_DECLARE(LOOK_ADDED_SKY)}, {LOOK_ADDED_LAMP, LOOK_DECLARE(LOOK_ADDED_LAMP)}};
    int code = RETEX_OK;
    for (int i = 0; i < 2 && !code && !is_enough(seen, params); i++) {
        if (number_after(params, lights[i].declared, "", NAN) != 0)
            continue;
        code = see_lit(params, lights[i].declared, added_to(seen), 0, seen, err);
        look->added = lights[i].name;
    }
    return code;
}

/* Windows that are white before a room that is bright enough: the added sky is all its light. As a photographer does,
 * the lamp is lit, by as much as the windows are too bright. A second look corrects what the lamp was taken to give, if
 * that was much less or more. */
static int balance_windows(Look *look, const LookParams *params, Meter *seen, RetexError *err)
{
    static const char sky[] = LOOK_DECLARE(LOOK_ADDED_SKY), lamp[] = LOOK_DECLARE(LOOK_ADDED_LAMP);
    const double times = fmin(exp2(seen->stops) * meter_brightest(seen) / METER_BRIGHTEST, MOST_LAMPS),
                 mean = meter_mean(seen), was = number_after(params, lamp, "", NAN);
    double more = (times - 1) * mean / 0.2, off = 0;
    int code = RETEX_OK;
    if (!is_enough(seen, params) || meter_lit(seen, seen->stops) > METER_ENOUGH_LIT || times < 1.2 || isnan(was) ||
        !(number_after(params, sky, "", NAN) > 0))
        return RETEX_OK;
    for (int i = 0; i < 2 && !code && (off < 0.7 || off > 1.3); i++) {
        more *= i ? off : 1;
        code = see_lit(params, lamp, was + more, was, seen, err);
        off = fmin(fmax((times - 1) * mean / fmax(meter_mean(seen) - mean, 1e-9), 0.2), 5);
    }
    look->added = LOOK_ADDED_LAMP, look->is_balanced = 1;
    return code;
}

static int look_and_choose(Look *look, const LookParams *params, RetexError *err)
{
    Meter seen;
    int code = see(params, &seen, err);
    if (code)
        return code;
    look->is_seen = seen.count > 0, look->is_noisy = seen.is_noisy;
    look->lit = seen.stops < MOST_STOPS ? 1 - seen.dark : 0;
    look->is_bare = meter_is_bare(&seen) && params->is_framed;
    if (look->is_seen)
        code = add_light(look, params, &seen, err);
    if (!code && look->is_seen)
        code = balance_windows(look, params, &seen, err);
    look->is_black = !(seen.bright > 0) || seen.stops >= MOST_STOPS;
    if (code || look->is_black || (fabs(seen.stops) < 1.5 && seen.white < 0.1))
        return code;
    look->exposure = fmax(meter_whole_stops(&seen), -RETEX_EXPOSURE_MAX);
    return look_expose(params, look->exposure, err);
}

int look_at(Look *look, const LookParams *params, RetexError *err)
{
    LookParams small = *params;
    char path[PATH_MAX];
    const int folder = open_small(params->folder);
    small.folder = folder >= 0 ? folder : params->folder;
    memset(look, 0, sizeof *look);
    const int code = look_and_choose(look, &small, err);
    if (folder >= 0)
        close(folder);
    path_of(params, LOOK_FOLDER, "", path);
    output_remove_folder(path);
    return code;
}
