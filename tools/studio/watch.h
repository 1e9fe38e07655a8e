/* Watches the model's folder for changes of the model and of its project by others, by inotify: without a change it
 * takes no time. */
#ifndef RETEX_STUDIO_WATCH_H
#define RETEX_STUDIO_WATCH_H

#include "places.h"
#include "project.h"

typedef struct Watch {
    int file;           /* inotify, or -1: the kernel has no more of them, and windows are not told */
    int folder;         /* its number of the folder that is watched, or -1 */
    const Model *model; /* that is watched */
    char id[128];       /* of the model's file; "": it is gone; guarded by the lock of changes */
    uint64_t changed;   /* number of its last change */
} Watch;

void watch_open(Watch *watch);
void watch_close(Watch *watch);
/* Look at what has happened, and at the model that is open now. For the thread that runs programs. */
void watch_go_on(Watch *watch, Places *places, Project *project);

#endif
