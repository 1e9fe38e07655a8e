/* The commands of retex-try: each is a tool beside this one that runs in a folder of its own. It is printed as somebody
 * would type it, with other names of files. */
#ifndef RETEX_TRY_COMMAND_H
#define RETEX_TRY_COMMAND_H

#include <stdatomic.h>
#include <sys/types.h>

#include "common/cli.h"

enum { COMMAND_WORDS = 64 };

typedef struct Command {
    const Cli *cli;
    const char *folder;                                          /* that it runs in */
    char *words[COMMAND_WORDS + 1], *printed[COMMAND_WORDS + 1]; /* the first is the tool's name; ends with NULL */
    int count;                                                   /* of them */
    int number, total; /* of commands: how many were printed, how many there will be */
    double share; /* of a core that the last one had, in the mean: processor time by time */
    _Atomic pid_t child; /* while it runs, else 0 */
} Command;

/* Begin another one, with the options of all tools as this one has them. */
void command_begin(Command *command, const char *tool);
/* Add a word. printed: how it is shown; NULL: as it is. */
void command_add(Command *command, const char *word, const char *printed);
void command_addf(Command *command, const char *fmt, ...) RETEX_PRINTF(2, 3);

/* Print it, after what it is for, and run it. What it prints goes to `take`, by lines; NULL: nowhere. If it fails this
 * process ends, with its status. */
void command_run(Command *command, const char *title, void (*take)(void *to, const char *line), void *to);
/* End what runs, by a signal. */
void command_end(Command *command, int number);

#endif
