/* Files that have a name before they are whole. A process that a signal ends runs no code of those who write them, so
 * their names are kept in one list, the library's only one, and retex_unfinished_remove goes through it. */
#ifndef RETEX_IO_UNFINISHED_H
#define RETEX_IO_UNFINISHED_H

typedef struct Unfinished {
    const char *path;
    struct Unfinished *next;
} Unfinished;

/* Between these a file gets its name, loses it, or becomes whole, so that no name is missed. */
void unfinished_lock(void);
void unfinished_unlock(void);

/* Locked: the path's file exists and is not whole; file and path stay where they are until it is dropped. */
void unfinished_add(Unfinished *file, const char *path);
void unfinished_drop(Unfinished *file); /* one that is not there is fine */

/* Who removes what a library of its own keeps a list of; called by retex_unfinished_remove too. NULL = nobody. */
void unfinished_also(void (*remove)(void));

#endif
