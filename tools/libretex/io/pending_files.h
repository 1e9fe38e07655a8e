/* Files that have a name before they are whole. A process that a signal ends runs no code of those who write them, so
 * their names are kept in one list, the library's only one, and retex_pending_files_remove goes through it. */
#ifndef RETEX_IO_PENDING_FILES_H
#define RETEX_IO_PENDING_FILES_H

typedef struct RetexPendingFile {
    const char *path;
    struct RetexPendingFile *next;
} RetexPendingFile;

/* Between these a file gets its name, loses it, or becomes whole, so that no name is missed. */
void retex_pending_files_lock(void);
void retex_pending_files_unlock(void);

/* Locked: the path's file exists and is not whole; file and path stay where they are until it is dropped. */
void retex_pending_files_add(RetexPendingFile *file, const char *path);
void retex_pending_files_drop(RetexPendingFile *file); /* one that is not there is fine */

/* Who removes what a library of its own keeps a list of; called by retex_pending_files_remove too. NULL = nobody. */
void retex_pending_files_set_hook(void (*remove)(void));

#endif
