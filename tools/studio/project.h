/* The project's file. It may be a stranger's: it is data, and each member that the page makes command lines, addresses
 * or pictures of is checked before a window sees it. And no window overwrites what it has not seen, whoever has written
 * it. */
#ifndef RETEX_STUDIO_PROJECT_H
#define RETEX_STUDIO_PROJECT_H

#include <jansson.h>

#include "places.h"

enum { PROJECT_ETAG = 40, PROJECT_BYTES = 4 << 20 };

typedef struct Project {
    Changes *changes;
    pthread_mutex_t writing; /* one window after the other; of several servers, a lock of the folder */
    char etag[PROJECT_ETAG]; /* of the content that was seen last; "": no file; guarded by the lock of changes */
    const Model *model;      /* whose it is */
    uint64_t changed;
} Project;

void project_open(Project *project, Changes *changes);
void project_close(Project *project);

/* The content, which the caller frees, and its entity tag. RETEX_ENOTFOUND: there is none yet. */
int project_read(const Model *model, char **text, size_t *bytes, char etag[PROJECT_ETAG], RetexError *err);
/* Write the content if the one that is there has the entity tag `seen`; NULL: if there is none. RETEX_EACCESS: another
 * one is there. RETEX_EPARSE: this is no project of the model. etag gets the new one. */
int project_write(Project *project, const Model *model, const char *text, size_t bytes, const char *seen,
                  char etag[PROJECT_ETAG], RetexError *err);
/* The project of a text, a new reference. NULL, and RETEX_EPARSE: it is not one of this model; the message says which
 * member is wrong. Members that are not known are kept, and mean nothing. */
json_t *project_parse(const char *text, size_t bytes, const Model *model, RetexError *err);
/* Look at the file: windows are told if it has changed. */
void project_look(Project *project, const Model *model);

#endif
