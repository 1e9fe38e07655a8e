/* Files of a folder that were not there before, to be removed where it cannot be completed. */
#ifndef RETEX_PAGE_ADDED_H
#define RETEX_PAGE_ADDED_H

enum { ADDED_MOST = 256 };

typedef struct Added {
    char *paths[ADDED_MOST]; /* folders too, before what is in them */
    int count;
} Added;

/* Before it is written: remember a path that is not there. 0: no memory. */
int added_note(Added *added, const char *path);
/* Remove them, unless keep. */
void added_end(Added *added, int keep);

#endif
