/* See presets.h. */
#include "serve/files/presets.h"

#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "serve/files/names.h"
#include "serve/request/name.h"

static const char *const endings[] = {"json", NULL};

/* The bytes of an open file, at most `most`; or -1. */
static ssize_t read_all(int descriptor, char *data, size_t most)
{
    size_t used = 0;
    ssize_t got = 1;
    while (got > 0 && used < most) {
        got = read(descriptor, data + used, most - used);
        used += got > 0 ? (size_t)got : 0;
    }
    return got < 0 ? -1 : (ssize_t)used;
}

int presets_read(const Presets *presets, const char *name, RetexEdit *edit, RetexError *err)
{
    char path[PATH_MAX];
    struct stat info;
    RetexError why = {0};
    int descriptor = -1;
    if (!presets->folder || !serve_name_is_valid(name) ||
        (size_t)snprintf(path, sizeof path, "%s/%s.json", presets->folder, name) >= sizeof path ||
        stat(path, &info) != 0 || !S_ISREG(info.st_mode) || retex_access_open(presets->access, path, &descriptor, NULL))
        return retex_fail(err, RETEX_ENOTFOUND, "there is no preset '%s'", name);
    char *data = malloc(RETEX_PRESET_BYTES_MAX + 1);
    const ssize_t bytes = data ? read_all(descriptor, data, RETEX_PRESET_BYTES_MAX + 1) : 0;
    close(descriptor);
    int code = !data       ? retex_fail(err, RETEX_ENOMEM, "not enough memory for a preset")
               : bytes < 0 ? retex_fail(err, RETEX_EIO, "the preset '%s' cannot be read", name)
                           : RETEX_OK;
    if (!code && (code = retex_preset_parse(edit, data, (size_t)bytes, name, &why)))
        retex_fail(err, code, "the preset '%s' cannot be used: %s", name, why.message);
    free(data);
    return code;
}

int presets_list(const Presets *presets, void (*tell)(void *context, const char *name), void *context)
{
    return presets->folder ? names_list(presets->folder, endings, 0, tell, context) : 0;
}
