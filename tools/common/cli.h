/* The command line of all tools: options, messages, exit codes. Only the tools' main files use it, never libraries. */
#ifndef RETEX_CLI_H
#define RETEX_CLI_H

#include <stddef.h>
#include <stdio.h>

#include <retex/access.h>
#include <retex/budget.h>
#include <retex/laid.h>

enum { CLI_OK = 0, CLI_NO = 1, CLI_FAIL = 2 }; /* done; the answer is 'no' or 'differs'; usage, input or I/O error */

typedef struct Cli Cli;
typedef struct CliOption CliOption;

/* Where the value of an option goes: into a member of what the command line asks for, a structure of the tool. */
typedef struct CliInto {
    enum { CLI_ELSEWHERE, CLI_TEXT, CLI_INT, CLI_LONG, CLI_FLOAT, CLI_DOUBLE, CLI_SIZE, CLI_LISTED, CLI_TAKEN } type;
    size_t at;     /* the member's offset */
    int is_number; /* from low to high; else an int becomes 1 */
    double low, high;
    size_t count;                                                  /* of CLI_LISTED: offset of the length, an int */
    int most;                                                      /* and the greatest one */
    void (*take)(Cli *cli, const CliOption *option, void *member); /* of CLI_TAKEN: parses cli->value */
} CliInto;

/* The last field of an option's row: a text, a size in bytes, or a flag, by the type of the member; a number within
 * bounds; a list of texts, `x` with its length `nx`; or what a function makes of cli->value. */
#define CLI_INTO(of, member) {.type = CLI_TYPE_OF(of, member), .at = offsetof(of, member)}
#define CLI_NUMBER(of, member, least, greatest)                                                                        \
    {                                                                                                                  \
        .type = CLI_TYPE_OF(of, member), .at = offsetof(of, member), .is_number = 1, .low = least,                     \
        .high = greatest                                                                                               \
    }
#define CLI_LIST(of, member)                                                                                           \
    {                                                                                                                  \
        .type = CLI_LISTED, .at = offsetof(of, member), .count = offsetof(of, n##member),                              \
        .most = sizeof((of *)0)->member / sizeof *((of *)0)->member                                                    \
    }
#define CLI_CALL(of, member, function) {.type = CLI_TAKEN, .at = offsetof(of, member), .take = function}
#define CLI_CALL_OF_ALL(function) {.type = CLI_TAKEN, .take = function} /* with the whole structure */
#define CLI_TYPE_OF(of, member)                                                                                        \
    _Generic(((of *)0)->member, const char *: CLI_TEXT, int: CLI_INT, long: CLI_LONG, float: CLI_FLOAT,                \
             double: CLI_DOUBLE, uint64_t: CLI_SIZE)

/* One option of a tool. A table of them ends with {0}. */
struct CliOption {
    const char *name;      /* long name without dashes */
    char letter;           /* one-letter form, or 0 */
    const char *argument;  /* the argument's name in --help; NULL: takes no argument; `=NAME`: may be left out, and is
                              given as `--name=VALUE` only. Completion goes by it: see complete.c */
    const char *help;      /* text of --help */
    int modifiers;         /* 1: `--name:modifiers` is allowed (texture, replace) */
    CliInto into;          /* missing: the tool takes it from cli_next */
};

/* State of parsing argv. Every tool has the common options (-o/--output, --threads, --safe, -q, -v, -h/--help,
 * -V/--version). --help lists them. --help and --version are answered here (stdout, exit 0); the values of the others
 * are stored in the fields below. */
struct Cli {
    const char *tool;        /* "retex-sample": the prefix of every message */
    const char *usage;       /* "SET --texture[:opts] NAME=IMAGE … [-o SAMPLES]" */
    const char *about;       /* one sentence, for --help */
    const CliOption *options;
    int argc;
    char **argv;
    int next;                /* index of the next argument; starts at 1 */
    int only_positional;     /* `--` has been read */
    const char *output;      /* -o, or NULL */
    int threads;             /* --threads, 0 = all cores */
    int quiet, verbose;      /* -q, -v */
    RetexLimits limits;      /* --max-memory, --max-time, --max-pixels and, in retex-render, --max-steps; defaults come
                                from the environment, and for --safe from retex_limits_safe */
    int is_server;           /* runs on, and limits requests itself: --safe sets no limits of the process */
    RetexBudget *budget;     /* enforces limits; passed in the params of long operations */
    RetexAccess access;      /* rules for opening files that the user names; `safe` is --safe or $RETEX_SAFE */
    int json_progress;       /* --progress json: replaces the progress bar and informational messages */
    const char *value;       /* argument of the option last returned */
    const char *modifiers;   /* the text after `--name:`, or "" */
    char frame[24];          /* "frame 3: " in all messages while that frame is made, or "" */
    const char *letters;     /* of an argument such as -qv, those that are not parsed yet */
    FILE *answer;            /* what a tool whose output is text prints to; see cli_answer */
    char *answer_text;       /* its text, where -o names a file */
    size_t answer_bytes;
};

/* Parse the command line: options go into `job`, a structure of the type that their rows name, as they are read, and
 * positional arguments where `arguments` points, up to a NULL; `surplus` is what cli_surplus says of one more. */
void cli_parse(Cli *cli, void *job, const char **const arguments[], const char *surplus);
#define CLI_ARGUMENTS(...) ((const char **const[]){__VA_ARGS__, NULL})

/* Return the next option of the tool's own table and set cli->value and cli->modifiers. Return &cli_positional for a
 * positional argument, with its text in cli->value ("-" is positional), and NULL at the end. Long options take
 * `--name VALUE` or `--name=VALUE`, letters `-oVALUE` or `-o VALUE`. A wrong option prints one line and exits with
 * CLI_FAIL. */
const CliOption *cli_next(Cli *cli);
extern const CliOption cli_positional;

/* Put the value of an option that cli_next has returned where its row says. 0: it does not say. */
int cli_take(Cli *cli, const CliOption *option, void *job);

/* Find an option by name (length bytes) or, if name is NULL, by letter. The tool's own options come first. NULL: there
 * is none. */
const CliOption *cli_find_option(const Cli *cli, const char *name, size_t length, char letter);
extern const CliOption cli_common_options[]; /* those of all tools */

/* complete.c: `retex-NAME --complete WORD…` prints what could stand in place of the last word, for completion in
 * shells, and exits. */
_Noreturn void cli_complete(Cli *cli);

/* The modifiers of --texture and --replace, for --help and completion. */
#define CLI_TEXTURE_OPTS                                                                                               \
    "scale=S[,T], rotate=DEGREES, offset=U,V, flip=u|v|uv, width=W[,H], wrap=repeat|mirror|clamp|black, "              \
    "repeat=straight|brick|half-drop|mirror|herringbone|basket|hexagon, colorspace=NAME, finish=MAP, normal=MAP, "     \
    "grout=WIDTH, groutcolor=COLOUR, vary=turn|flip|shift, tiles=IMAGE[,IMAGE], at=X,Y, "                              \
    "hue=DEGREES, saturation=S, gain=R[,G,B], "                                                                        \
    "gamma=G, contrast=C, blur=PART, invert=yes|no, tint=COLOUR, colorize=COLOUR"

/* Parse cli->value. If it is wrong, print one line with the option and the expected value, and exit with CLI_FAIL. */
long cli_integer(const Cli *cli, const CliOption *option, long low, long high);
double cli_number(const Cli *cli, const CliOption *option, double low, double high);
/* Store cli->value in cli->limits. */
void cli_limit(Cli *cli, const CliOption *option);

/* Name a frame of an animation in all further messages; -1 = none. */
void cli_set_frame(Cli *cli, int frame);

/* Print `retex-NAME: error: …`, with file, line and column if the error has them. */
void cli_error(const Cli *cli, const RetexError *err);
void cli_error_text(const RetexError *err, char *text, size_t size); /* the text after `error: ` */
void cli_warn(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);
/* What pictures are warned of, as a callback for libraries; context is a Cli. With -q, but without -v, all are one
 * line, when the program ends. */
void cli_warn_text(void *context, const char *text);
void cli_info(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);   /* unless -q */
void cli_detail(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3); /* with -v */
/* cli_info of what is important, else cli_detail, as a callback for libraries; cli is a Cli. */
void cli_note(void *cli, int important, const char *text);
void cli_message(const Cli *cli, const char *text);                       /* unchanged, also with -q */
_Noreturn void cli_die(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);    /* usage error: exit 2 */
_Noreturn void cli_fail(const Cli *cli, const RetexError *err);                     /* cli_error and exit 2 */

/* ---- cli_hints.c: what was probably meant ---- */

/* Fail because of an option that is unknown: `length` bytes of text, which follows the dashes. */
_Noreturn void cli_unknown_option(const Cli *cli, const char *dashes, const char *text, int length);
/* Fail because of one positional argument too many. The message is `problem`, such as "one set is enough", and the
 * option that may be missing before the argument. */
_Noreturn void cli_surplus(const Cli *cli, const char *problem);
/* The missing option as in "; is -o x.png meant?", or "" if none is likely. */
const char *cli_forgotten(const Cli *cli, const char *word, char *text, size_t size);

/* Replace control characters by '?', in place. Text from users' files must not send escape sequences to a terminal. */
char *cli_plain(char *text);

/* Return the output file: that of -o, or "-" if standard output is not a terminal. Otherwise exit with an error: pixels
 * are never written to a terminal, not even with `-o -` or /dev/tty. */
const char *cli_output(const Cli *cli);

/* For a tool whose output is text: check the output, announce it as with cli_writes, and open cli->answer. Without -o
 * that is standard output, which may be a terminal. With -o it is memory, and cli_close writes the file, unless the
 * status is CLI_FAIL. */
void cli_answer(Cli *cli);

/* Check a file to read. Exit with an error if it is "-" and standard input is a terminal, or if --safe is given and it
 * is neither "-" nor a regular file. `what` is the expected content, for the message. */
void cli_input(const Cli *cli, const char *path, const char *what);
/* Open the set that the samples from a file or stream name. Safe access: it lies below the current folder or theirs. */
int cli_open_referred(const Cli *cli, RetexSet **samples, const char *path, RetexError *err);

/* ---- cli_files.c: no output replaces an input, or another output ----
 *
 * A tool announces every file that it reads or writes before it writes anything, in any order, with a name for messages
 * ("the scene", "--stats"). An output that is also an input or another output is refused. Files are compared by device
 * and inode with links followed, missing files by their folder and name. A file may be read more than once. Devices and
 * pipes are accepted, but standard input and standard output ("-") can each be announced only once. path NULL: no
 * file. */
void cli_reads(const Cli *cli, const char *what, const char *path);  /* exits with CLI_FAIL if refused */
void cli_writes(const Cli *cli, const char *what, const char *path);
int cli_add_input(const char *what, const char *path, RetexError *err); /* returns the error */
int cli_add_output(const char *what, const char *path, RetexError *err);

/* Whether path ends in `ending` (".exr"), ignoring case. */
int cli_ends_with(const char *path, const char *ending);

/* Bytes of a file on disk, or 0 if unknown. */
double cli_file_size(const char *path);

/* --memory, in bytes, of tools that can process a set by rows: the part of --max-memory that a set kept in memory may
 * take. */
#define CLI_MEMORY_DEFAULT ((uint64_t)2048 << 20)
/* The same, at most half of --max-memory, because results computed from the set also need memory. */
uint64_t cli_memory(const Cli *cli, uint64_t bytes);
/* Print an error and exit if a set's picture has more than --max-pixels. */
void cli_check_pixels(const Cli *cli, const RetexSet *set, const char *path);

/* Open a set, and load it if it takes at most `memory` bytes of it. */
int cli_open_set(const Cli *cli, RetexSet **set, const char *path, uint64_t memory, RetexError *err);

/* --progress, for the tools that have it: a row of their option table. */
#define CLI_PROGRESS_OPTION                                                                                            \
    {                                                                                                                  \
        "progress", 0, "json", "print progress as lines of JSON on standard error", 0,                                 \
            CLI_CALL_OF_ALL(cli_take_progress)                                                                         \
    }
void cli_take_progress(Cli *cli, const CliOption *option, void *job);

/* Show progress on stderr. On a terminal and without -q: a bar with the elapsed and the remaining time. Elsewhere with
 * -v: a line every 30 seconds. With --progress json, or RETEX_PROGRESS=json, which leaves messages as they are: one
 * object per second, {"stage": label, "fraction": done, "seconds": …}. `done` is 0..1; `label` for instance "render".
 * Call with 1 to finish the line. The output is rate-limited; one thread may call often. */
void cli_progress(const Cli *cli, const char *label, double done);

/* Write the answer to the file of -o, flush and close stdout. Exit with CLI_FAIL if that fails, for instance on a full
 * disk. If the reader of a pipe has gone, the tool ends by SIGPIPE. Call last. */
int cli_close(const Cli *cli, int status);
/* Call now and then in long work that prints to stdout: ends as cli_close does if that has failed. */
void cli_check_text(const Cli *cli);

#endif
