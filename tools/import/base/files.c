/* See files.h. */
#include "import/base/files.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

int files_begin(Import *import, RetexError *err)
{
    const ImportOptions *options = import->options;
    char folder[PATH_MAX];
    const char *slash = strrchr(options->model, '/');
    const size_t length = slash ? (size_t)(slash - options->model) + 1 : 0;
    if (length >= sizeof folder)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", options->model, strerror(ENAMETOOLONG));
    memcpy(folder, options->model, length);
    strcpy(folder + length, length ? "" : ".");
    if (access(options->model, R_OK) != 0)
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", options->model, strerror(errno));
    if (!realpath(folder, import->root))
        return retex_fail(err, RETEX_EIO, "cannot read %s: %s", options->model, strerror(errno));
    import->access = (RetexAccess)RETEX_ACCESS_INIT;
    import->access.safe = 1; /* names in a model are a stranger's */
    import->access.roots = import->roots;
    import->roots[import->access.nroots++] = import->root;
    for (int i = 0; i < options->nalso; i++) {
        char *resolved = realpath(options->also[i], NULL);
        if (!resolved)
            return retex_fail(err, RETEX_EIO, "-I %s: %s", options->also[i], strerror(errno));
        import->roots[import->access.nroots++] = resolved;
    }
    return RETEX_OK;
}

static RetexAccessResult try_file(Import *import, const char *folder, const char *below, const char *name,
                                  char path[PATH_MAX])
{
    if (snprintf(path, PATH_MAX, "%s%s", below, name) >= PATH_MAX)
        return RETEX_ACCESS_ABSENT;
    const RetexAccessResult result = retex_access_check(&import->access, folder, path);
    if (result == RETEX_ACCESS_ALLOWED && path[0] != '/') {
        char whole[PATH_MAX];
        if (snprintf(whole, sizeof whole, "%s/%s", folder, path) >= PATH_MAX)
            return RETEX_ACCESS_ABSENT;
        strcpy(path, whole);
    }
    return result;
}

/* Names come from other machines: "C:\wood.png", "file:///textures/my%20wood.png". */
static void clean_name(const char *name, char clean[PATH_MAX])
{
    size_t n = 0;
    if (strncmp(name, "file://", 7) == 0)
        name += 7;
    for (const char *c = name; *c && n + 1 < PATH_MAX; c++) {
        unsigned code;
        if (*c == '%' && sscanf(c + 1, "%2x", &code) == 1 && code >= 32 && strlen(c) > 2) {
            clean[n++] = (char)code;
            c += 2;
        } else
            clean[n++] = *c == '\\' ? '/' : *c;
    }
    clean[n] = '\0';
}

/* The first name in a folder that differs in the case of letters only, as names from DOS and Windows do. */
static int find_any_case(const char *root, const char *below, const char *name, char found[NAME_MAX + 1])
{
    char folder[PATH_MAX];
    DIR *entries = snprintf(folder, sizeof folder, "%s/%s", root, below) < (int)sizeof folder ? opendir(folder) : NULL;
    found[0] = '\0';
    for (const struct dirent *entry; entries && (entry = readdir(entries));)
        if (strcasecmp(entry->d_name, name) == 0 && (!found[0] || strcmp(entry->d_name, found) < 0))
            snprintf(found, NAME_MAX + 1, "%s", entry->d_name);
    if (entries)
        closedir(entries);
    return found[0] != '\0';
}

/* As it is named; else its last part in each folder, and in folders below that often have textures; else the same
 * whatever the case of its letters. */
int files_find(Import *import, const char *name, char path[PATH_MAX], int *found, RetexError *err)
{
    static const char *const below[] = {"", "textures/", "Textures/", "images/", "maps/"};
    char clean[PATH_MAX], other[NAME_MAX + 1];
    int outside = 0;
    clean_name(name, clean);
    *found = 1;
    for (int i = 0; i < import->access.nroots; i++) {
        const RetexAccessResult result = try_file(import, import->roots[i], "", clean, path);
        if (result == RETEX_ACCESS_ALLOWED)
            return RETEX_OK;
        outside |= result == RETEX_ACCESS_OUTSIDE;
    }
    const char *slash = strrchr(clean, '/'), *last = slash ? slash + 1 : clean;
    for (int i = 0; i < import->access.nroots && *last; i++)
        for (size_t k = 0; k < sizeof below / sizeof *below; k++)
            if (try_file(import, import->roots[i], below[k], last, path) == RETEX_ACCESS_ALLOWED)
                return RETEX_OK;
    for (int i = 0; i < import->access.nroots && *last; i++)
        for (size_t k = 0; k < sizeof below / sizeof *below; k++)
            if (find_any_case(import->roots[i], below[k], last, other) &&
                try_file(import, import->roots[i], below[k], other, path) == RETEX_ACCESS_ALLOWED)
                return RETEX_OK;
    *found = 0;
    if (outside && !import->options->partial)
        return retex_fail(err, RETEX_EACCESS,
                          "%s: the model names the file `%s`, which is outside of its folder; "
                          "-I DIR adds folders that may be read",
                          import->options->model, clean);
    return RETEX_OK;
}
