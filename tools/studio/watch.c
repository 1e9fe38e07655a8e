/* See watch.h. */
#include "watch.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>

enum { EVENTS = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE };

void watch_open(Watch *watch)
{
    *watch = (Watch){.file = inotify_init1(IN_CLOEXEC | IN_NONBLOCK), .folder = -1};
}

void watch_close(Watch *watch)
{
    if (watch->file >= 0)
        close(watch->file);
}

/* Notes another content of the model's file. */
static void look_at_model(Watch *watch, Changes *changes, int is_new)
{
    struct stat info;
    char id[sizeof watch->id] = "";
    if (watch->model && stat(watch->model->path, &info) == 0)
        snprintf(id, sizeof id, "%llx.%llx.%llx.%lx", (unsigned long long)info.st_ino, (unsigned long long)info.st_size,
                 (unsigned long long)info.st_mtim.tv_sec, info.st_mtim.tv_nsec);
    changes_lock(changes);
    const int differs = strcmp(watch->id, id) != 0;
    memcpy(watch->id, id, sizeof id);
    if (differs || is_new)
        watch->changed = changes_note(changes);
    changes_unlock(changes);
}

/* 1: something has happened to the model; 2: to the project; 3: both. */
static int read_events(const Watch *watch)
{
    char bytes[16 * (sizeof(struct inotify_event) + NAME_MAX + 1)]
        __attribute__((aligned(__alignof__(struct inotify_event))));
    int happened = 0;
    for (ssize_t got; watch->model && (got = read(watch->file, bytes, sizeof bytes)) > 0;)
        for (const char *at = bytes; at < bytes + got;) {
            const struct inotify_event *event = (const void *)at;
            const char *name = event->len ? event->name : "";
            at += sizeof *event + event->len;
            if (event->mask & IN_Q_OVERFLOW)
                happened = 3;
            if (strcmp(name, watch->model->name) == 0)
                happened |= 1;
            if (strcmp(name, strrchr(watch->model->project, '/') + 1) == 0)
                happened |= 2;
        }
    return happened;
}

void watch_go_on(Watch *watch, Places *places, Project *project)
{
    const Model *model = places_model(places);
    const int is_new = model != watch->model;
    int happened = watch->file >= 0 ? read_events(watch) : 0;
    if (is_new) {
        if (watch->folder >= 0)
            inotify_rm_watch(watch->file, watch->folder);
        watch->model = model;
        watch->folder = inotify_add_watch(watch->file, model->folder, EVENTS);
        happened = 3;
    }
    if (happened & 1)
        look_at_model(watch, places->changes, is_new);
    if (happened & 2)
        project_look(project, model);
}
