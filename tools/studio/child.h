/* Programs that the server starts. Each is the head of processes of its own, is nice to the server, ends with it, and,
 * where the kernel has Landlock, writes nothing but below one folder. Only one thread starts them, the one that lives
 * as long as the server: a program ends with the thread that has started it. */
#ifndef RETEX_STUDIO_CHILD_H
#define RETEX_STUDIO_CHILD_H

#include <stdint.h>
#include <sys/types.h>

#include <retex/error.h>

typedef struct Child {
    pid_t pid;           /* 0: none */
    int input;           /* its standard input, or -1: it reads nothing */
    int output, message; /* its standard output and error, which do not block; -1: at their end */
} Child;
#define CHILD_NONE                                                                                                     \
    {                                                                                                                  \
        0, -1, -1, -1                                                                                                  \
    }

typedef struct ChildParams {
    char *const *words; /* the first is the path of the program; end with NULL */
    const char *folder; /* that it runs in */
    const char *writes; /* that it may write below; NULL: wherever the user may */
    int writes_folder;  /* that folder, open */
    int is_fed;         /* 1: it gets a pipe as standard input */
    int nice;           /* 0 to 19 */
} ChildParams;

int child_start(Child *child, const ChildParams *params, RetexError *err);
void child_signal(const Child *child, int number);
/* 1: it has ended; its status is as of waitpid, its peak of memory in bytes. What it has said can still be read, until
 * child_close. 0: it runs. */
int child_reap(Child *child, int *status, uint64_t *memory);
void child_close(Child *child);
void child_close_file(int *file);

#endif
