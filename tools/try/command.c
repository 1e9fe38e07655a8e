/* See command.h. */
#include "try/command.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/retex.h>

#include "common/beside.h"
#include "common/watchdog.h"

static void clear(Command *command)
{
    for (int i = 0; i < command->count; i++)
        free(command->words[i]), free(command->printed[i]);
    command->count = 0;
}

void command_add(Command *command, const char *word, const char *printed)
{
    char *own = strdup(word), *shown = strdup(printed ? printed : word);
    if (command->count == COMMAND_WORDS || !own || !shown)
        cli_die(command->cli, "not enough memory for a command");
    command->words[command->count] = own, command->printed[command->count] = shown;
    command->words[++command->count] = NULL;
}

void command_addf(Command *command, const char *fmt, ...)
{
    va_list args;
    char *word = NULL;
    va_start(args, fmt);
    if (vasprintf(&word, fmt, args) < 0)
        cli_die(command->cli, "not enough memory for a command");
    va_end(args);
    command_add(command, word, NULL);
    free(word);
}

void command_begin(Command *command, const char *tool)
{
    const Cli *cli = command->cli;
    const RetexLimits usual = RETEX_LIMITS_INIT;
    clear(command);
    command_add(command, tool, NULL);
    if (cli->quiet || cli->verbose)
        command_add(command, cli->quiet ? "-q" : "-v", NULL);
    if (cli->access.safe)
        command_add(command, "--safe", NULL);
    if (cli->access.accept_damaged)
        command_add(command, "--accept-damaged", NULL);
    if (cli->threads)
        command_addf(command, "--threads=%d", cli->threads);
    if (cli->limits.memory)
        command_addf(command, "--max-memory=%lluM", (unsigned long long)(cli->limits.memory >> 20));
    if (cli->limits.pixels != usual.pixels)
        command_addf(command, "--max-pixels=%ld", cli->limits.pixels);
}

/* ---- printing ---- */

static int is_control(char c)
{
    return (unsigned char)c < 32 || c == 127;
}

/* A text as a shell reads it. */
static void print_word(const char *text)
{
    int is_plain = text[0] != '\0', has_controls = 0;
    for (const char *c = text; *c; c++) {
        is_plain &= isalnum((unsigned char)*c) || strchr("_-./:=,@%+", *c);
        has_controls |= is_control(*c);
    }
    fputs(is_plain ? "" : has_controls ? "$'" : "'", stdout);
    for (const char *c = text; *c; c++)
        if (has_controls && (is_control(*c) || *c == '\\' || *c == '\''))
            printf("\\%03o", (unsigned char)*c);
        else if (*c == '\'')
            fputs("'\\''", stdout);
        else
            putchar(*c);
    fputs(is_plain ? "" : "'", stdout);
}

static void print(Command *command, const char *title)
{
    if (command->cli->quiet)
        return;
    printf("%s# %d of %d: %s\n", command->number ? "\n" : "", command->number + 1, command->total, title);
    command->number++;
    for (int i = 0; i < command->count; i++) {
        fputs(i ? " " : "", stdout);
        print_word(command->printed[i]);
    }
    putchar('\n');
    cli_check_text(command->cli);
}

/* ---- running ---- */

_Noreturn static void become(const Command *command, const char *program, int output, pid_t parent)
{
    sigset_t none;
    sigemptyset(&none);
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent) /* which has ended before this call */
        _exit(CLI_FAIL);
    signal(SIGINT, SIG_IGN); /* of the terminal: the parent ends this process */
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL);
    sigprocmask(SIG_SETMASK, &none, NULL);
    if (chdir(command->folder) == 0 && dup2(output, STDOUT_FILENO) >= 0)
        execv(program, command->words);
    _exit(CLI_FAIL);
}

static pid_t start(Command *command, int *output)
{
    char program[PATH_MAX];
    int ends[2];
    if (!beside_program(program, command->words[0]))
        cli_die(command->cli, "there is no %s beside %s", command->words[0], command->cli->tool);
    if (pipe2(ends, O_CLOEXEC) != 0)
        cli_die(command->cli, "no pipe: %s", strerror(errno));
    fflush(NULL);
    const pid_t parent = getpid(), pid = fork();
    if (pid == 0)
        become(command, program, ends[1], parent);
    if (pid < 0)
        cli_die(command->cli, "no process for %s: %s", command->words[0], strerror(errno));
    close(ends[1]);
    *output = ends[0];
    return pid;
}

static void read_lines(int output, void (*take)(void *to, const char *line), void *to)
{
    char *line = NULL;
    size_t size = 0;
    FILE *lines = fdopen(output, "r");
    while (lines && getline(&line, &size, lines) > 0)
        if (take)
            take(to, line);
    free(line);
    if (lines)
        fclose(lines);
}

static double seconds_of(struct timeval time)
{
    return (double)time.tv_sec + 1e-6 * (double)time.tv_usec;
}

void command_run(Command *command, const char *title, void (*take)(void *to, const char *line), void *to)
{
    const Cli *cli = command->cli;
    const double started = retex_clock_seconds();
    struct rusage used = {0};
    int output, status = 0;
    print(command, title);
    const pid_t pid = start(command, &output);
    atomic_store(&command->child, pid);
    read_lines(output, take, to);
    pid_t ended;
    do
        ended = wait4(pid, &status, 0, &used);
    while (ended < 0 && errno == EINTR);
    atomic_store(&command->child, 0);
    watchdog_go_on();
    if (WIFSIGNALED(status))
        cli_die(cli, "%s was ended by a signal: %s", command->words[0], strsignal(WTERMSIG(status)));
    if (status) /* it has said why */
        exit(cli_close(cli, WEXITSTATUS(status)));
    const double processor = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    command->share = processor / fmax(retex_clock_seconds() - started, 1e-3);
}

void command_end(Command *command, int number)
{
    const pid_t pid = atomic_load(&command->child);
    if (pid > 0) {
        kill(pid, number);
        waitpid(pid, NULL, 0);
    }
}
