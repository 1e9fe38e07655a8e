/* The command line of all tools, see cli.h: options (parsing, lookup, --help), then values, messages, output. What was
 * probably meant by wrong ones is in cli_hints.c. */
#include "common/cli.h"
#include "common/watchdog.h"

#include <ctype.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/output_file.h>
#include <retex/retex.h>

const CliOption cli_positional = {"", 0, NULL, NULL, 0};

/* Called before the first option is parsed. Open closed standard descriptors, so that no other file gets their numbers;
 * they are opened in the wrong direction, so that using them still fails. Ignore SIGXFSZ: a file size limit is then a
 * write error like a full disk. The watchdog takes over the terminating signals. */
static void prepare_process(const Cli *cli)
{
    static int prepared;
    if (prepared)
        return;
    prepared = 1;
    for (int fd = 0; fd < 3; fd++)
        if (fcntl(fd, F_GETFD) == -1 && errno == EBADF && open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY) != fd)
            _exit(CLI_FAIL);
    signal(SIGXFSZ, SIG_IGN);
    watchdog_prepare(cli->tool);
}

/* --- --help --- */

enum { HELP_COLUMN = 30, HELP_WIDTH = 79 };

/* The length of what is printed together: a word, or of one that no line can hold as much as ends with a bar. */
static int word_length(const char *text, int indent)
{
    const int word = (int)strcspn(text, " ");
    int cut = HELP_WIDTH - indent;
    if (word <= cut)
        return word;
    while (cut > 0 && text[cut - 1] != '|')
        cut--;
    return cut ? cut : word;
}

/* Print text wrapped between words, from column `indent` on. `column` is the cursor's current column. */
static void print_wrapped(const char *text, int column, int indent)
{
    if (column > indent - 2 && indent > 0) {
        putchar('\n');
        column = 0;
    }
    printf("%*s", indent - column, "");
    column = indent;
    while (*text) {
        int word = word_length(text, indent);
        if (column > indent && column + 1 + word > HELP_WIDTH) {
            printf("\n%*s", indent, "");
            column = indent;
        } else if (column > indent) {
            putchar(' ');
            column++;
        }
        printf("%.*s", word, text);
        column += word;
        text += word;
        text += strspn(text, " ");
    }
    putchar('\n');
}

static int is_optional(const CliOption *option)
{
    return option->argument && *option->argument == '=';
}

static void print_options(const CliOption *options)
{
    for (const CliOption *o = options; o && o->name; o++) {
        char form[256];
        int n = snprintf(form, sizeof form, "  %c%c%c --%s%s%s%s%s", o->letter ? '-' : ' ', o->letter ? o->letter : ' ',
                         o->letter ? ',' : ' ', o->name, o->modifiers ? "[:opts]" : "",
                         is_optional(o) ? "["
                         : o->argument  ? " "
                                        : "",
                         o->argument ? o->argument : "", is_optional(o) ? "]" : "");
        fputs(form, stdout);
        print_wrapped(o->help ? o->help : "", n, HELP_COLUMN);
    }
}

static void print_help(Cli *cli, const CliOption *option, void *job)
{
    (void)option, (void)job;
    printf("Usage: %s %s\n\n", cli->tool, cli->usage);
    print_wrapped(cli->about, 0, 0);
    putchar('\n');
    if (cli->options && cli->options->name) {
        print_options(cli->options);
        putchar('\n');
    }
    print_options(cli_common_options);
    exit(cli_close(cli, CLI_OK));
}

static void print_version(Cli *cli, const CliOption *option, void *job)
{
    (void)option, (void)job;
    printf("%s %s\n", cli->tool, RETEX_VERSION);
    exit(cli_close(cli, CLI_OK));
}

/* --- parsing argv --- */

const CliOption *cli_find_option(const Cli *cli, const char *name, size_t length, char letter)
{
    const CliOption *tables[] = {cli->options, cli_common_options};
    for (int t = 0; t < 2; t++)
        for (const CliOption *o = tables[t]; o && o->name; o++) {
            if (name && strlen(o->name) == length && memcmp(o->name, name, length) == 0)
                return o;
            if (!name && o->letter && o->letter == letter)
                return o;
        }
    return NULL;
}

/* Fail if an option stands in place of another option's argument. A file of that name can be given as ./--name. */
static void check_value(const Cli *cli, const CliOption *option)
{
    const char *name = cli->value + 2;
    if (strncmp(cli->value, "--", 2) == 0 && cli_find_option(cli, name, strcspn(name, "=:"), 0))
        cli_die(cli, "--%s needs an argument, %s, before %s", option->name, option->argument, cli->value);
}

/* Set cli->value to the option's argument: `attached` if not NULL, else the next word. */
static void take_value(Cli *cli, const CliOption *option, const char *attached)
{
    cli->value = NULL;
    if (!option->argument) {
        if (attached)
            cli_die(cli, "--%s takes no argument", option->name);
        return;
    }
    if (attached || is_optional(option))
        cli->value = attached;
    else if (cli->next < cli->argc)
        cli->value = cli->argv[cli->next++], check_value(cli, option);
    else
        cli_die(cli, "--%s needs an argument: %s", option->name, option->argument);
}

static const CliOption *long_option(Cli *cli, const char *text)
{
    size_t length = strcspn(text, "=:");
    const CliOption *option = cli_find_option(cli, text, length, 0);
    if (!option)
        cli_unknown_option(cli, "--", text, (int)length);
    const char *attached = NULL;
    if (text[length] == ':') {
        if (!option->modifiers)
            cli_die(cli, "--%s takes no modifiers (':%s')", option->name, text + length + 1);
        cli->modifiers = text + length + 1;
    } else if (text[length] == '=') {
        attached = text + length + 1;
    }
    take_value(cli, option, attached);
    return option;
}

/* Parse the first of cli->letters. Its argument or more letters follow it. */
static const CliOption *short_option(Cli *cli)
{
    char letter = *cli->letters++;
    const CliOption *option = cli_find_option(cli, NULL, 0, letter);
    if (!option)
        cli_unknown_option(cli, "-", cli->letters - 1, 1);
    const char *rest = *cli->letters ? cli->letters : NULL;
    if (option->argument || !rest)
        cli->letters = NULL;
    take_value(cli, option, option->argument ? rest : NULL);
    return option;
}

/* --- options of all tools --- */

static void take_output(Cli *cli, const CliOption *option, void *output)
{
    if (!*cli->value)
        cli_die(cli, "--%s: the name is empty", option->name);
    *(const char **)output = cli->value;
}

static void take_limit(Cli *cli, const CliOption *option, void *limits)
{
    (void)limits;
    cli_limit(cli, option);
}

const CliOption cli_common_options[] = {
    {"output", 'o', "FILE", "write to FILE; - is standard output", 0, CLI_CALL(Cli, output, take_output)},
    {"threads", 0, "N", "use N threads; 0, the default, uses all cores", 0, CLI_NUMBER(Cli, threads, 0, 256)},
    {"safe", 0, NULL,
     "refuse devices and rare picture formats; scenes read only their own folder; limits of 2G, 60 seconds and "
     "33177600 pixels, unless others are given; also RETEX_SAFE=1",
     0, CLI_INTO(Cli, access.safe)},
    {"accept-damaged", 0, NULL, "read damaged pictures as far as possible, with a warning; also RETEX_ACCEPT_DAMAGED=1",
     0, CLI_INTO(Cli, access.accept_damaged)},
    {"max-memory", 0, "SIZE",
     "use at most SIZE of memory, such as 4G, 512M, or a number of MB; default three quarters of the machine's; also "
     "RETEX_MAX_MEMORY",
     0, CLI_CALL_OF_ALL(take_limit)},
    {"max-time", 0, "SECONDS", "stop after this time; also RETEX_MAX_TIME", 0, CLI_CALL_OF_ALL(take_limit)},
    {"max-pixels", 0, "N", "refuse pictures of more pixels; default 268435456; also RETEX_MAX_PIXELS", 0,
     CLI_CALL_OF_ALL(take_limit)},
    {"quiet", 'q', NULL, "print only warnings and errors", 0, CLI_INTO(Cli, quiet)},
    {"verbose", 'v', NULL, "print more", 0, CLI_INTO(Cli, verbose)},
    {"help", 'h', NULL, "print this help and exit", 0, CLI_CALL_OF_ALL(print_help)},
    {"version", 'V', NULL, "print the version and exit", 0, CLI_CALL_OF_ALL(print_version)},
    {0},
};

/* Handle an option that every tool has. Return 0 if it is not one of these. */
static int common_option(Cli *cli, const CliOption *option)
{
    const size_t count = sizeof cli_common_options / sizeof *cli_common_options;
    if (option < cli_common_options || option >= cli_common_options + count)
        return 0;
    cli_take(cli, option, cli);
    return 1;
}

const CliOption *cli_next(Cli *cli)
{
    prepare_process(cli);
    if (cli->next == 0)
        cli->next = 1;
    if (cli->next == 1 && cli->argc > 1 && strcmp(cli->argv[1], "--complete") == 0)
        cli_complete(cli);
    if (cli->access.size == 0) {
        cli->access = (RetexAccess)RETEX_ACCESS_INIT;
        cli->access.safe = retex_access_safe_requested();
        cli->access.accept_damaged = retex_access_damage_accepted();
    }
    if (cli->limits.size == 0) {
        RetexError err;
        cli->limits = (RetexLimits)RETEX_LIMITS_INIT;
        cli->budget = watchdog_budget();
        if (retex_limits_environment(&cli->limits, &err))
            cli_fail(cli, &err);
    }
    for (;;) {
        const CliOption *option;
        cli->modifiers = "";
        if (cli->letters) {
            option = short_option(cli);
        } else if (cli->next >= cli->argc) {
            if (cli->access.safe && !cli->is_server)
                retex_limits_safe(&cli->limits);
            retex_budget_set_limits(cli->budget, &cli->limits);
            watchdog_start();
            return NULL;
        } else {
            const char *word = cli->argv[cli->next++];
            if (cli->only_positional || word[0] != '-' || word[1] == 0) {
                cli->value = word;
                return &cli_positional;
            }
            if (strcmp(word, "--") == 0) {
                cli->only_positional = 1;
                continue;
            }
            if (word[1] == '-') {
                option = long_option(cli, word + 2);
            } else {
                cli->letters = word + 1;
                option = short_option(cli);
            }
        }
        if (!common_option(cli, option))
            return option;
    }
}

/* --- values --- */

long cli_integer(const Cli *cli, const CliOption *option, long low, long high)
{
    char *end;
    errno = 0;
    long value = strtol(cli->value, &end, 10);
    if (errno || end == cli->value || *end || isspace((unsigned char)cli->value[0]) || value < low || value > high)
        cli_die(cli, "--%s: expected a whole number from %ld to %ld, not '%s'", option->name, low, high, cli->value);
    return value;
}

double cli_number(const Cli *cli, const CliOption *option, double low, double high)
{
    char *end;
    double value = strtod(cli->value, &end);
    if (end == cli->value || *end || isspace((unsigned char)cli->value[0]) || !isfinite(value) || value < low ||
        value > high)
        cli_die(cli, "--%s: expected a number from %g to %g, not '%s'", option->name, low, high, cli->value);
    return value;
}

void cli_limit(Cli *cli, const CliOption *option)
{
    RetexError err;
    if (retex_limits_set(&cli->limits, option->name, cli->value, &err))
        cli_die(cli, "--%s", err.message);
}

/* A SIZE, in bytes. */
static uint64_t take_size(const Cli *cli, const CliOption *option)
{
    uint64_t bytes;
    if (retex_size_parse(cli->value, &bytes, NULL))
        cli_die(cli, "--%s: expected a size such as 512M, 2G or a number of MB, not '%s'", option->name, cli->value);
    return bytes;
}

static void add_to_list(const Cli *cli, const CliOption *option, const char **list, int *count)
{
    if (*count == option->into.most)
        cli_die(cli, "more than %d of --%s", option->into.most, option->name);
    list[(*count)++] = cli->value;
}

int cli_take(Cli *cli, const CliOption *option, void *job)
{
    const CliInto *into = &option->into;
    void *member = (char *)job + into->at;
    if (into->type == CLI_ELSEWHERE)
        return 0;
    if (into->type == CLI_TAKEN)
        into->take(cli, option, member);
    else if (into->type == CLI_LISTED)
        add_to_list(cli, option, member, (int *)((char *)job + into->count));
    else if (into->type == CLI_TEXT)
        *(const char **)member = cli->value;
    else if (into->type == CLI_INT)
        *(int *)member = into->is_number ? (int)cli_integer(cli, option, (long)into->low, (long)into->high) : 1;
    else if (into->type == CLI_LONG)
        *(long *)member = cli_integer(cli, option, (long)into->low, (long)into->high);
    else if (into->type == CLI_FLOAT)
        *(float *)member = (float)cli_number(cli, option, into->low, into->high);
    else if (into->type == CLI_DOUBLE)
        *(double *)member = cli_number(cli, option, into->low, into->high);
    else
        *(uint64_t *)member = take_size(cli, option);
    return 1;
}

void cli_parse(Cli *cli, void *job, const char **const arguments[], const char *surplus)
{
    for (const CliOption *option; (option = cli_next(cli));)
        if (option == &cli_positional && !*arguments)
            cli_surplus(cli, surplus);
        else if (option == &cli_positional)
            **arguments++ = cli->value;
        else if (!cli_take(cli, option, job))
            cli_die(cli, "--%s: nothing takes it", option->name); /* a mistake in the table */
}

/* --- messages --- */

char *cli_plain(char *text)
{
    for (char *c = text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
    return text;
}

void cli_set_frame(Cli *cli, int frame)
{
    cli->frame[0] = '\0';
    if (frame >= 0)
        snprintf(cli->frame, sizeof cli->frame, "frame %d: ", frame);
}

/* Print one line to stderr. Messages contain names and text from users' files, so control characters are replaced: a
 * terminal would obey them. */
static void message(const Cli *cli, const char *kind, const char *text)
{
    watchdog_go_on();
    fprintf(stderr, "%s: %s%s", cli->tool, kind, cli->frame);
    for (const char *c = text; *c; c++)
        fputc((unsigned char)*c < 32 || *c == 127 ? '?' : *c, stderr);
    fputc('\n', stderr);
}

static void vmessage(const Cli *cli, const char *kind, const char *fmt, va_list args)
{
    char text[4096];
    vsnprintf(text, sizeof text, fmt, args);
    message(cli, kind, text);
}

void cli_error_text(const RetexError *err, char *text, size_t size)
{
    if (err->file[0] && err->line > 0 && err->column > 0)
        snprintf(text, size, "%s:%d:%d: %s", err->file, err->line, err->column, err->message);
    else if (err->file[0] && err->line > 0)
        snprintf(text, size, "%s:%d: %s", err->file, err->line, err->message);
    else if (err->file[0])
        snprintf(text, size, "%s: %s", err->file, err->message);
    else
        snprintf(text, size, "%s", err->message);
}

void cli_error(const Cli *cli, const RetexError *err)
{
    char text[sizeof err->file + sizeof err->message + 32];
    if (err->code == RETEX_EPIPE)
        watchdog_end_by_pipe();
    cli_error_text(err, text, sizeof text);
    message(cli, "error: ", text);
}

void cli_warn(const Cli *cli, const char *fmt, ...)
{
    va_list args;
    va_start(args, fmt);
    vmessage(cli, "warning: ", fmt, args);
    va_end(args);
}

/* With -q, what pictures are warned of is said in one line: the first warning, and how many more there were. */
static struct {
    pthread_mutex_t lock;
    const char *tool;
    char first[4096];
    int count;
} unsaid = {.lock = PTHREAD_MUTEX_INITIALIZER};

static void say_unsaid(void)
{
    pthread_mutex_lock(&unsaid.lock);
    const Cli cli = {.tool = unsaid.tool}; /* that of main may be gone */
    const int more = unsaid.count - 1;
    if (more == 0)
        cli_warn(&cli, "%s", unsaid.first);
    else if (more > 0)
        cli_warn(&cli, "%s; and %d more warning%s, which -q hides", unsaid.first, more, more == 1 ? "" : "s");
    unsaid.count = 0;
    pthread_mutex_unlock(&unsaid.lock);
}

void cli_warn_text(void *context, const char *text)
{
    static int is_registered;
    const Cli *cli = context;
    if (!cli->quiet || cli->verbose) {
        cli_warn(cli, "%s", text);
        return;
    }
    pthread_mutex_lock(&unsaid.lock);
    if (!is_registered)
        is_registered = atexit(say_unsaid) == 0;
    const int is_said_later = is_registered;
    if (unsaid.count++ == 0)
        snprintf(unsaid.first, sizeof unsaid.first, "%s%s", cli->frame, text), unsaid.tool = cli->tool;
    pthread_mutex_unlock(&unsaid.lock);
    if (!is_said_later)
        say_unsaid();
}

void cli_note(void *cli, int important, const char *text)
{
    if (important)
        cli_info(cli, "%s", text);
    else
        cli_detail(cli, "%s", text);
}

void cli_message(const Cli *cli, const char *text)
{
    message(cli, "", text);
}

void cli_info(const Cli *cli, const char *fmt, ...)
{
    if (cli->quiet || cli->json_progress)
        return;
    va_list args;
    va_start(args, fmt);
    vmessage(cli, "", fmt, args);
    va_end(args);
}

void cli_detail(const Cli *cli, const char *fmt, ...)
{
    if (!cli->verbose)
        return;
    va_list args;
    va_start(args, fmt);
    vmessage(cli, "", fmt, args);
    va_end(args);
}

void cli_die(const Cli *cli, const char *fmt, ...)
{
    va_list args;
    watchdog_fail("");
    va_start(args, fmt);
    vmessage(cli, "error: ", fmt, args);
    va_end(args);
    exit(CLI_FAIL);
}

void cli_fail(const Cli *cli, const RetexError *err)
{
    watchdog_fail(err->message);
    cli_error(cli, err);
    exit(CLI_FAIL);
}

/* --- output --- */

/* Whether path is a terminal: /dev/tty, or /dev/stdout if that is one. */
static int names_terminal(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISCHR(info.st_mode))
        return 0;
    int fd = open(path, O_WRONLY | O_NOCTTY | O_CLOEXEC);
    int terminal = fd >= 0 && isatty(fd);
    if (fd >= 0)
        close(fd);
    return terminal;
}

const char *cli_output(const Cli *cli)
{
    const char *path = cli->output ? cli->output : "-";
    if (strcmp(path, "-") == 0 && isatty(STDOUT_FILENO))
        cli_die(cli, cli->output ? "standard output is a terminal; redirect it or name a file: -o FILE"
                                 : "no output file: give -o FILE, or redirect standard output");
    if (names_terminal(path))
        cli_die(cli, "%s is a terminal; name a file: -o FILE", path);
    return path;
}

void cli_answer(Cli *cli)
{
    RetexError err = {0};
    cli_writes(cli, "the answer", cli->output ? cli->output : "-");
    cli->answer = stdout;
    if (!cli->output || strcmp(cli->output, "-") == 0)
        return;
    if (retex_output_check(cli->output, &err))
        cli_fail(cli, &err);
    cli->answer = open_memstream(&cli->answer_text, &cli->answer_bytes);
    if (!cli->answer)
        cli_die(cli, "not enough memory for the answer");
}

/* Write the answer that is kept in memory to the file of -o. */
static void write_answer(const Cli *cli)
{
    RetexError err = {0};
    int failed = ferror(cli->answer);
    if (fclose(cli->answer) != 0 || failed || !cli->answer_text) /* glibc returns 0 where it gets no memory */
        cli_die(cli, "not enough memory for the answer");
    failed = retex_file_write(cli->output, cli->answer_text, cli->answer_bytes, &err);
    free(cli->answer_text);
    if (failed)
        cli_fail(cli, &err);
}

void cli_input(const Cli *cli, const char *path, const char *what)
{
    if (strcmp(path, "-") == 0 && isatty(STDIN_FILENO))
        cli_die(cli, "standard input is a terminal; expected %s", what);
    RetexError err = {0};
    int file = -1;
    if (cli->access.safe && strcmp(path, "-") != 0 && retex_access_open(&cli->access, path, &file, &err))
        cli_fail(cli, &err);
    if (file >= 0)
        close(file);
}

int cli_ends_with(const char *path, const char *ending)
{
    size_t length = strlen(path), tail = strlen(ending);
    return length >= tail && strcasecmp(path + length - tail, ending) == 0;
}

uint64_t cli_memory(const Cli *cli, uint64_t bytes)
{
    const uint64_t half = retex_budget_memory(cli->budget) / 2;
    return half && half < bytes ? half : bytes;
}

void cli_check_pixels(const Cli *cli, const RetexSet *set, const char *path)
{
    const RetexSetInfo info = set ? retex_set_info(set) : (RetexSetInfo){.width = 0};
    if ((int64_t)info.width * info.height > cli->limits.pixels)
        cli_die(cli, "%s is too large: %d x %d pixels, more than the %ld of --max-pixels",
                strcmp(path, "-") == 0 ? "standard input" : path, info.width, info.height, cli->limits.pixels);
}

int cli_open_set(const Cli *cli, RetexSet **set, const char *path, uint64_t memory, RetexError *err)
{
    int code = retex_set_open(path, set, cli->threads, err);
    if (!code)
        cli_check_pixels(cli, *set, path);
    if (!code && retex_set_bytes(*set) <= cli_memory(cli, memory))
        code = retex_set_load(*set, cli->threads, err);
    return code;
}

double cli_file_size(const char *path)
{
    struct stat info;
    return strcmp(path, "-") != 0 && stat(path, &info) == 0 && S_ISREG(info.st_mode) ? (double)info.st_size : 0;
}

/* 12 s, 3 min 05 s, 2 h 10 min. */
static const char *duration(double seconds, char text[32])
{
    long s = (long)(seconds + 0.5);
    if (s < 60)
        snprintf(text, 32, "%ld s", s);
    else if (s < 3600)
        snprintf(text, 32, "%ld min %02ld s", s / 60, s % 60);
    else
        snprintf(text, 32, "%ld h %02ld min", s / 3600, s / 60 % 60);
    return text;
}

/* One line of progress, for log files. */
static void progress_line(const char *label, double done, double elapsed)
{
    char so_far[32], left[32];
    if (done > 0 && done < 1)
        fprintf(stderr, "%s: %.0f%%, %s, %s left\n", label, 100 * done, duration(elapsed, so_far),
                duration(elapsed * (1 - done) / done, left));
}

static void progress_bar(const char *label, double done, double elapsed)
{
    enum { BAR = 30 };
    char bar[BAR + 1] = {0}, so_far[32], left[32];
    for (int i = 0; i < BAR; i++)
        bar[i] = i < (int)(done * BAR) ? '#' : '.';
    if (done >= 1)
        fprintf(stderr, "\r%s [%s] 100%%  %.1f s\033[K\n", label, bar, elapsed);
    else if (done > 0.02 || (done > 0 && elapsed > 10))
        fprintf(stderr, "\r%s [%s] %3.0f%%  %s, %s left\033[K", label, bar, 100 * done, duration(elapsed, so_far),
                duration(elapsed * (1 - done) / done, left));
    else
        fprintf(stderr, "\r%s [%s] %3.0f%%\033[K", label, bar, 100 * done);
}

void cli_take_progress(Cli *cli, const CliOption *option, void *job)
{
    (void)option, (void)job;
    if (strcmp(cli->value, "json") != 0)
        cli_die(cli, "--progress: expected json, not '%s'", cli->value);
    cli->json_progress = 1;
}

void cli_progress(const Cli *cli, const char *label, double done)
{
    static double started = -1, drawn;
    const char *form = getenv("RETEX_PROGRESS");
    const int json = cli->json_progress || (form && strcmp(form, "json") == 0);
    const int terminal = !json && isatty(STDERR_FILENO);
    if (!json && (cli->quiet || (!terminal && !cli->verbose)))
        return;
    double now = retex_clock_seconds();
    if (started < 0)
        started = now, drawn = terminal ? 0 : now;
    done = fmin(fmax(done, 0), 1);
    double elapsed = now - started;
    if (done >= 1)
        started = -1; /* the next call starts a new bar */
    if (now - drawn < (terminal ? 0.1 : json ? 1 : 30) && !(done >= 1 && (terminal || json)))
        return;
    drawn = now;
    if (json)
        fprintf(stderr, "{\"stage\": \"%s\", \"fraction\": %.4f, \"seconds\": %.2f}\n", label, done, elapsed);
    else if (terminal)
        progress_bar(label, done, elapsed);
    else
        progress_line(label, done, elapsed);
    fflush(stderr);
    watchdog_note_bar(terminal && done < 1);
}

/* Whether standard output is a pipe or socket that nobody reads any more. */
static int has_lost_reader(void)
{
    struct pollfd out = {.fd = STDOUT_FILENO, .events = POLLOUT};
    return poll(&out, 1, 0) > 0 && (out.revents & POLLERR);
}

void cli_check_text(const Cli *cli)
{
    if (ferror(stdout))
        exit(cli_close(cli, CLI_FAIL));
}

int cli_close(const Cli *cli, int status)
{
    if (cli->answer && cli->answer != stdout && status != CLI_FAIL)
        write_answer(cli);
    int failed = ferror(stdout);
    errno = 0;
    if (fflush(stdout) != 0)
        failed = 1;
    if (failed && has_lost_reader())
        watchdog_end_by_pipe();
    if (fclose(stdout) != 0)
        failed = 1;
    if (!failed) {
        watchdog_done();
        return status;
    }
    cli_die(cli, "standard output: %s", errno ? strerror(errno) : "write error");
}
