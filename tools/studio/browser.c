/* See browser.h. */
#include "browser.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

extern char **environ;

/* A page that leads to the address. 0: it cannot be written. */
static int write_page(const char *path, const char *address)
{
    const int length = (int)strcspn(address, "\n");
    const int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    FILE *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (!file)
        return 0;
    fprintf(file,
            "<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
            "<title>retex studio</title><meta http-equiv=\"refresh\" content=\"0; url=%.*s\">"
            "<p><a href=\"%.*s\">Open retex studio</a></p>\n",
            length, address, length, address);
    return fclose(file) == 0;
}

static int is_set(const char *name)
{
    const char *value = getenv(name);
    return value && *value;
}

void browser_open(const char *address, char **file)
{
    const char *folder = getenv("XDG_RUNTIME_DIR");
    posix_spawnattr_t attributes;
    sigset_t none;
    pid_t child;
    *file = NULL;
    if (!is_set("DISPLAY") && !is_set("WAYLAND_DISPLAY"))
        return;
    if (asprintf(file, "%s/retex-studio-%d.html", is_set("XDG_RUNTIME_DIR") ? folder : "/tmp", (int)getpid()) < 0) {
        *file = NULL;
        return;
    }
    if (!write_page(*file, address)) {
        free(*file);
        *file = NULL;
        return;
    }
    char *const words[] = {(char *)"xdg-open", *file, NULL};
    sigemptyset(&none);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setpgroup(&attributes, 0);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETPGROUP);
    (void)posix_spawnp(&child, "xdg-open", NULL, &attributes, words, environ);
    posix_spawnattr_destroy(&attributes);
}

void browser_close(char **file)
{
    if (*file)
        unlink(*file);
    free(*file);
    *file = NULL;
}
