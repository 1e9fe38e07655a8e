/* What all tools share on the command line: options, messages, exit codes. Used by the mains, never by libraries. */
#ifndef RETEX_CLI_H
#define RETEX_CLI_H

#include <retex/access.h>
#include <retex/budget.h>
#include <retex/set.h>

enum { CLI_OK = 0, CLI_NO = 1, CLI_FAIL = 2 }; /* done; the answer is 'no' or 'differs'; usage, input or I/O error */

/* One option of a tool. A table of them ends with {0}. */
typedef struct CliOption {
    const char *name;      /* long name without dashes */
    char letter;           /* one-letter form, or 0 */
    const char *argument;  /* its name in --help, or NULL where the option takes none */
    const char *help;      /* for --help */
    int modifiers;         /* 1: `--name:modifiers` is allowed (texture, replace) */
} CliOption;

/* Walks argv. Common options (-o/--output, --threads, --safe, -q, -v, -h/--help, -V/--version) are known to every tool:
 * they are listed in --help, --help and --version are answered here (stdout, exit 0), the rest is kept in the fields
 * below. */
typedef struct Cli {
    const char *tool;        /* "retex-sample": begins every message */
    const char *usage;       /* "SET --texture[:opts] NAME=IMAGE … [-o SAMPLES]" */
    const char *about;       /* one sentence, for --help */
    const CliOption *options;
    int no_output;           /* 1: the answer goes to standard output, -o is refused */
    int argc;
    char **argv;
    int next;                /* next argument to look at; starts at 1 */
    int only_positional;     /* `--` was seen */
    const char *output;      /* -o, or NULL */
    int threads;             /* --threads, 0 = all cores */
    int quiet, verbose;      /* -q, -v */
    RetexLimits limits;      /* --max-memory, --max-time, --max-pixels and, of retex-render, --max-steps; else as the
                                environment says */
    RetexBudget *budget;     /* of these: for the params of long work */
    RetexAccess access;      /* of files whose names the user said: its `safe` is --safe, or $RETEX_SAFE's */
    int json_progress;       /* --progress json: in place of a bar, and of messages that all is well */
    const char *value;       /* argument of the option last returned */
    const char *modifiers;   /* what stood behind `--name:`, or "" */
    const char *group;       /* of a cluster -qv: what is left of it */
} Cli;

/* The next option of the tool's own table, with cli->value and cli->modifiers set; a positional argument comes back as
 * &cli_positional with its text in cli->value ("-" is positional); NULL at the end. Long options take `--name VALUE` or
 * `--name=VALUE`, letters `-oVALUE` or `-o VALUE`. A wrong option prints one line and exits with CLI_FAIL. */
const CliOption *cli_next(Cli *cli);
extern const CliOption cli_positional;

/* Values: print one line naming the option and what was expected, and exit with CLI_FAIL, where the text is wrong. */
long cli_integer(const Cli *cli, const CliOption *option, long low, long high);
double cli_number(const Cli *cli, const CliOption *option, double low, double high);
/* Of cli->limits. */
void cli_limit(Cli *cli, const CliOption *option);

/* `retex-NAME: error: …`, with file, line and column where the error has them. */
void cli_error(const Cli *cli, const RetexError *err);
void cli_error_text(const RetexError *err, char *text, size_t size); /* what follows `error: ` */
void cli_warn(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);
/* The same as a function that a library calls; cli is a Cli. */
void cli_warn_text(void *cli, const char *text);
void cli_info(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);   /* unless -q */
void cli_detail(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3); /* with -v */
void cli_message(const Cli *cli, const char *text);                       /* as it is, -q or not */
_Noreturn void cli_die(const Cli *cli, const char *fmt, ...) RETEX_PRINTF(2, 3);    /* usage error: exit 2 */
_Noreturn void cli_fail(const Cli *cli, const RetexError *err);                     /* cli_error and exit 2 */

/* A second positional argument, or a third, where there is room for fewer. problem: "one set is enough". Says which
 * option may have been forgotten before it. */
_Noreturn void cli_surplus(const Cli *cli, const char *problem);
/* That option, as in "; is -o x.png meant?", or "". */
const char *cli_forgotten(const Cli *cli, const char *word, char *text, size_t size);

/* Text out of somebody's file, to be printed: its control characters, which a terminal would obey, become '?', in
 * place. */
char *cli_plain(char *text);

/* The output file: -o if given; else "-" when standard output is not a terminal; else an error that says so (pixels are
 * never written to a terminal, `-o -` and /dev/tty included). */
const char *cli_output(const Cli *cli);

/* A file to read: an error where it is "-" and standard input a terminal, at which nobody types a set, and with --safe
 * where it is neither "-" nor a regular file. `what` is what was expected. */
void cli_input(const Cli *cli, const char *path, const char *what);

/* ---- cli_files.c: no output replaces an input, or another output ----
 *
 * Every file that a command reads or writes is announced before anything is written, in any order, with what it is in
 * messages ("the scene", "--stats"). An output that is also an input or another output is refused: by device and inode,
 * links followed; what is not there yet by its folder and name. Files read more than once are fine, as are devices and
 * pipes, but standard input and output ("-") can each be announced once only. path NULL: no file. */
void cli_reads(const Cli *cli, const char *what, const char *path);  /* exits with CLI_FAIL where it is refused */
void cli_writes(const Cli *cli, const char *what, const char *path);
int cli_add_input(const char *what, const char *path, RetexError *err); /* the same, for those who add to the message */
int cli_add_output(const char *what, const char *path, RetexError *err);

/* Whether path ends in ending (".exr"), in whatever case. */
int cli_ends_with(const char *path, const char *ending);

/* Bytes of a file on disk, or 0 where that is not known. */
double cli_file_size(const char *path);

/* --memory of tools that go through a set some rows after the other, in megabytes: how much of --max-memory a set that
 * is kept may take. */
enum { CLI_MEMORY_DEFAULT = 2048 };
long cli_megabytes(const Cli *cli, const CliOption *option);
/* That in bytes, half of --max-memory at the most: what is made of a set takes room too. */
uint64_t cli_memory(const Cli *cli, long megabytes);
/* One line and exit where a set's picture is larger than --max-pixels. */
void cli_check_pixels(const Cli *cli, const RetexSet *set, const char *path);

/* Open a set, and bring it into memory if it takes no more than so many megabytes there. */
int cli_open_set(const Cli *cli, RetexSet **set, const char *path, long megabytes, RetexError *err);

/* --progress, of the tools that have it: a row of their options, and what to do when it comes. */
#define CLI_PROGRESS_OPTION {"progress", 0, "json", "print progress as lines of JSON on standard error", 0}
void cli_take_progress(Cli *cli);

/* A progress bar on stderr, on a terminal and without -q, with the time so far and the time left; elsewhere with -v a
 * line every half a minute. With --progress json, wherever that goes, an object a second: {"stage": label, "fraction":
 * done, "seconds": …}. done is 0..1; label e.g. "render". Call with 1 to finish the line. Rate-limited inside;
 * safe to call often from one thread. */
void cli_progress(const Cli *cli, const char *label, double done);

/* Flush and close stdout, so that a full disk is seen: exits with CLI_FAIL if it was. Call last. */
int cli_close(const Cli *cli, int status);

#endif
