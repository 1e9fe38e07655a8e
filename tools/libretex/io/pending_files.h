/* Pending files: output files that have a name and are not complete. A process that a signal ends runs no code of the
 * threads that write them. So their names are in one list, the library's only global state, which
 * retex_pending_files_remove goes through. */
#ifndef RETEX_IO_PENDING_FILES_H
#define RETEX_IO_PENDING_FILES_H

typedef struct RetexPendingFile {
    const char *path;
    struct RetexPendingFile *next;
} RetexPendingFile;

/* Between lock and unlock a file may get its name, lose it, or become complete, so that the list misses none. */
void retex_pending_files_lock(void);
void retex_pending_files_unlock(void);

/* To be called locked, when the file at path exists and is not complete; file and path must stay valid until the file
 * is dropped. */
void retex_pending_files_add(RetexPendingFile *file, const char *path);
void retex_pending_files_drop(RetexPendingFile *file); /* a file that is not in the list is ignored */

/* A function that removes the pending files of another library; retex_pending_files_remove calls it. NULL = none. */
void retex_pending_files_set_hook(void (*remove)(void));

#endif
