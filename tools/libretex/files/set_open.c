/* Opens, reads and checks sets, each an EXR file or a pack, and samples. */
#include <string.h>
#include <sys/stat.h>

#include <retex/laid.h>
#include <retex/set_file.h>

#include "files/set_format.h"
#include "io/input.h"
#include "set/set.h"

enum { READ, OPEN };

static int read_any(const char *path, const RetexAccess *access, RetexSet **set, int open, int nthreads,
                    RetexError *err)
{
    RetexInput *input = NULL;

    *set = NULL;
    int code = retex_input_open_allowed(&input, path, access, err);
    const uint64_t bytes = code ? 0 : retex_input_size(input);
    if (!code)
        code = retex_set_format_of(input)->open(&input, set, open, nthreads, err);
    if (!code && open == READ && (*set)->nparts && (*set)->parts[0].source)
        code = retex_set_load(*set, nthreads, err);
    if (*set)
        (*set)->file_bytes = bytes;
    if (code)
        retex_set_close(set);
    retex_input_close(&input);
    return code;
}

static int read_set(const char *path, const RetexAccess *access, RetexSet **set, int open, int nthreads,
                    RetexError *err)
{
    int code = read_any(path, access, set, open, nthreads, err);
    if (!code && (*set)->is_samples)
        code = retex_fail(err, RETEX_EFORMAT, "%s holds samples, no set",
                          strcmp(path, "-") == 0 ? "standard input" : path);
    if (code)
        retex_set_close(set);
    return code;
}

int retex_set_read(const char *path, RetexSet **set, int nthreads, RetexError *err)
{
    return read_set(path, NULL, set, READ, nthreads, err);
}

int retex_set_open(const char *path, RetexSet **set, int nthreads, RetexError *err)
{
    return read_set(path, NULL, set, OPEN, nthreads, err);
}

int retex_set_open_any(const char *path, RetexSet **set, int nthreads, RetexError *err)
{
    return read_any(path, NULL, set, OPEN, nthreads, err);
}

int retex_set_open_referred(RetexSet **samples, const RetexAccess *access, int nthreads, RetexError *err)
{
    const RetexSetReference *refers = &(*samples)->refers;
    RetexSet *set = NULL;
    struct stat info;

    if (!refers->path[0])
        return retex_fail(err, RETEX_EINVAL, "the samples name no set");
    /* opening a pipe would wait for its writer */
    if (!access && stat(refers->path, &info) == 0 && !S_ISREG(info.st_mode))
        return retex_fail(err, RETEX_EINVAL, "%s, the set that the samples name, is no regular file", refers->path);
    int code = read_set(refers->path, access, &set, OPEN, nthreads, err);
    if (!code && (set->file_bytes != refers->bytes || set->file_sum != refers->crc))
        code = retex_fail(err, RETEX_EFORMAT, "%s is not the set that the samples were made for: it has changed",
                          refers->path);
    if (!code)
        code = retex_set_lay(set, *samples, err);
    if (code) {
        retex_set_close(&set);
        return code;
    }
    set->refers = *refers;
    retex_set_close(samples);
    *samples = set;
    return RETEX_OK;
}

int retex_set_open_size(const char *path, int width, int height, RetexSet **set, int nthreads, RetexError *err)
{
    *set = NULL;
    if (width < 1 || height < 1)
        return retex_fail(err, RETEX_EINVAL, "a picture of %d x %d pixels is none", width, height);
    int code = retex_set_open(path, set, nthreads, err);
    RetexCut own;
    const int level = code ? -1
                             : retex_set_find_level(*set,
                                                    &(RetexCut){0, 0, (*set)->width, (*set)->height, width, height},
                                                    &own);
    return level < 0 ? code : retex_set_take_level(set, level, err);
}

int retex_set_check(const char *path, int nthreads, RetexError *err)
{
    RetexInput *input = NULL;
    int code = retex_input_open(&input, path, err);

    if (!code)
        code = retex_set_format_of(input)->check(&input, nthreads, err);
    retex_input_close(&input);
    return code;
}
