/* See project.h. */
#include "project.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/output_file.h>

#include "http/hash.h"

/* How long another server's lock is waited for, and between attempts. */
enum { LOCK_SECONDS = 3, LOCK_MILLISECONDS = 5 };

void project_open(Project *project, Changes *changes)
{
    *project = (Project){.changes = changes};
    pthread_mutex_init(&project->writing, NULL);
}

void project_close(Project *project)
{
    pthread_mutex_destroy(&project->writing);
}

/* Two hashes from different beginnings: as long as one of 128 bits. */
static void make_etag(const char *text, size_t bytes, char etag[PROJECT_ETAG])
{
    const uint64_t a = hash_bytes(HASH_BEGIN, text, bytes), b = hash_bytes(~HASH_BEGIN, text, bytes);
    snprintf(etag, PROJECT_ETAG, "\"%016llx%016llx\"", (unsigned long long)a, (unsigned long long)b);
}

static int read_file(int file, char **text, size_t *bytes, RetexError *err)
{
    ssize_t got = 1;
    if (!(*text = malloc(PROJECT_BYTES + 1)))
        return retex_fail(err, RETEX_ENOMEM, "not enough memory");
    for (*bytes = 0; got > 0 && *bytes <= PROJECT_BYTES; *bytes += got > 0 ? (size_t)got : 0)
        do
            got = read(file, *text + *bytes, PROJECT_BYTES + 1 - *bytes);
        while (got < 0 && errno == EINTR);
    if (got < 0)
        return retex_fail(err, RETEX_EIO, "cannot read the project: %s", strerror(errno));
    if (*bytes > PROJECT_BYTES)
        return retex_fail(err, RETEX_ELIMIT, "the project has more than %d MB", PROJECT_BYTES >> 20);
    return RETEX_OK;
}

int project_read(const Model *model, char **text, size_t *bytes, char etag[PROJECT_ETAG], RetexError *err)
{
    struct stat info;
    *text = NULL;
    *etag = 0;
    if (!model)
        return retex_fail(err, RETEX_ENOTFOUND, "no model is open");
    const int file = open(model->project, O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY | O_NOFOLLOW);
    if (file < 0 && errno == ENOENT)
        return retex_fail(err, RETEX_ENOTFOUND, "there is no project yet");
    if (file < 0 || fstat(file, &info) != 0 || !S_ISREG(info.st_mode)) {
        const int code = retex_fail(err, RETEX_EIO, "cannot read the project %s", model->project);
        if (file >= 0)
            close(file);
        return code;
    }
    const int code = read_file(file, text, bytes, err);
    close(file);
    if (code) {
        free(*text);
        *text = NULL;
        return code;
    }
    make_etag(*text, *bytes, etag);
    return RETEX_OK;
}

/* The content of now is the one that the window has seen. */
static int check_seen(const Model *model, const char *seen, RetexError *err)
{
    char *text, now[PROJECT_ETAG];
    size_t bytes;
    RetexError why = {0};
    const int code = project_read(model, &text, &bytes, now, &why);
    free(text);
    if (code && code != RETEX_ENOTFOUND)
        return retex_fail(err, code, "%s", why.message);
    if (code ? seen != NULL : !seen || strcmp(seen, now) != 0)
        return retex_fail(err, RETEX_EACCESS, "another window has changed the project");
    return RETEX_OK;
}

/* Servers of one project write one after the other. The lock is of the folder, because each write makes another file.
 * Returns what holds it, to be closed; -1 on file systems that have no locks; *code tells what failed. */
static int lock_folder(const Model *model, int *code, RetexError *err)
{
    const double until = retex_clock_seconds() + LOCK_SECONDS;
    const int folder = open(model->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    *code = RETEX_OK;
    if (folder < 0) {
        *code = retex_fail(err, RETEX_EIO, "cannot open %s: %s", model->folder, strerror(errno));
        return -1;
    }
    while (flock(folder, LOCK_EX | LOCK_NB) != 0) {
        const int is_held = errno == EWOULDBLOCK;
        if (is_held && retex_clock_seconds() < until) {
            usleep(1000 * LOCK_MILLISECONDS);
            continue;
        }
        if (is_held)
            *code = retex_fail(err, RETEX_EIO, "another program keeps the project locked");
        close(folder);
        return -1;
    }
    return folder;
}

static void note(Project *project, const Model *model, const char *etag)
{
    changes_lock(project->changes);
    if (project->model != model || strcmp(project->etag, etag) != 0) {
        project->model = model;
        snprintf(project->etag, sizeof project->etag, "%s", etag);
        project->changed = changes_note(project->changes);
    }
    changes_unlock(project->changes);
}

int project_write(Project *project, const Model *model, const char *text, size_t bytes, const char *seen,
                  char etag[PROJECT_ETAG], RetexError *err)
{
    if (!model)
        return retex_fail(err, RETEX_EINVAL, "no model is open");
    json_t *checked = project_parse(text, bytes, model, err);
    json_decref(checked);
    if (!checked)
        return RETEX_EPARSE;
    pthread_mutex_lock(&project->writing);
    int code;
    const int lock = lock_folder(model, &code, err);
    if (!code)
        code = check_seen(model, seen, err);
    if (!code)
        code = retex_file_write(model->project, text, bytes, err);
    if (!code) {
        make_etag(text, bytes, etag);
        note(project, model, etag);
    }
    if (lock >= 0)
        close(lock);
    pthread_mutex_unlock(&project->writing);
    return code;
}

void project_look(Project *project, const Model *model)
{
    char *text, etag[PROJECT_ETAG];
    size_t bytes;
    pthread_mutex_lock(&project->writing); /* not in the middle of a window's change */
    (void)project_read(model, &text, &bytes, etag, NULL);
    free(text);
    note(project, model, etag);
    pthread_mutex_unlock(&project->writing);
}
