/* Opens, reads and checks sets, each an EXR file or a pack, and samples. */
#include <sys/stat.h>

#include <retex/samples.h>
#include <retex/set_file.h>

#include "files/set_format.h"
#include "io/input.h"
#include "set/samples.h"
#include "set/set.h"

/* Read the set, the samples, or both: those whose pointer is not NULL. open: 1 = parts of the set are read later. */
static int read_file(const char *path, const RetexAccess *access, RetexSet **set, RetexSamples **samples, int open,
                     int nthreads, RetexError *err)
{
    RetexInput *input = NULL;

    if (set)
        *set = NULL;
    if (samples)
        *samples = NULL;
    if (!set && !samples)
        return retex_fail(err, RETEX_EINVAL, "nothing is wanted from %s", path);
    int code = retex_input_open_allowed(&input, path, access, err);
    const uint64_t bytes = code ? 0 : retex_input_size(input);
    if (!code)
        code = retex_set_format_of(input)->open(&input, set, samples, open, nthreads, err);
    if (!code && !open && set && *set && (*set)->source)
        code = retex_set_load(*set, nthreads, err);
    if (set && *set)
        (*set)->file_bytes = bytes;
    if (code && set)
        retex_set_close(set);
    retex_input_close(&input);
    return code;
}

int retex_set_read(const char *path, RetexSet **set, RetexSamples **samples, int nthreads, RetexError *err)
{
    return read_file(path, NULL, set, samples, 0, nthreads, err);
}

int retex_set_open(const char *path, RetexSet **set, RetexSamples **samples, int nthreads, RetexError *err)
{
    return read_file(path, NULL, set, samples, 1, nthreads, err);
}

int retex_samples_open_set(RetexSet **set, const RetexSamples *samples, const RetexAccess *access, int nthreads,
                           RetexError *err)
{
    const RetexSetReference *refers = &samples->refers;
    struct stat info;

    *set = NULL;
    if (!refers->path[0])
        return retex_fail(err, RETEX_EINVAL, "the samples name no set");
    /* opening a pipe would wait for its writer */
    if (!access && stat(refers->path, &info) == 0 && !S_ISREG(info.st_mode))
        return retex_fail(err, RETEX_EINVAL, "%s, the set that the samples name, is no regular file", refers->path);
    const int code = read_file(refers->path, access, set, NULL, 1, nthreads, err);
    if (code || ((*set)->file_bytes == refers->bytes && (*set)->file_sum == refers->crc))
        return code;
    retex_set_close(set);
    return retex_fail(err, RETEX_EFORMAT, "%s is not the set that the samples were made for: it has changed",
                      refers->path);
}

int retex_set_open_size(const char *path, int width, int height, RetexSet **set, int nthreads, RetexError *err)
{
    *set = NULL;
    if (width < 1 || height < 1)
        return retex_fail(err, RETEX_EINVAL, "a picture of %d x %d pixels is none", width, height);
    int code = retex_set_open(path, set, NULL, nthreads, err);
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
