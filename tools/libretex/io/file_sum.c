/* See <retex/file_sum.h>. */
#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/file_sum.h>
#include "io/checksum.h"

uint32_t retex_bytes_sum(uint32_t so_far, const void *bytes, size_t count)
{
    return retex_crc32(so_far, bytes, count);
}

static int sum_descriptor(RetexFileSum *sum, int descriptor, const char *path, RetexError *err)
{
    unsigned char buffer[1 << 16];
    struct stat info;

    if (fstat(descriptor, &info) == 0 && !S_ISREG(info.st_mode))
        return retex_fail(err, RETEX_EINVAL, "%s is no regular file: it has no checksum", path);
    for (;;) {
        const ssize_t got = read(descriptor, buffer, sizeof buffer);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return retex_fail(err, RETEX_EIO, "cannot read %s: %s", path, strerror(errno));
        if (got == 0)
            return RETEX_OK;
        sum->crc = retex_crc32(sum->crc, buffer, (size_t)got);
        sum->bytes += (uint64_t)got;
    }
}

int retex_file_sum(RetexFileSum *sum, const char *path, const RetexAccess *access, RetexError *err)
{
    struct stat info;
    int descriptor;

    *sum = (RetexFileSum){0, CRC32_OF_NONE};
    if (stat(path, &info) == 0 && !S_ISREG(info.st_mode)) /* opening a pipe would wait for its writer */
        return retex_fail(err, RETEX_EINVAL, "%s is no regular file: it has no checksum", path);
    const int code = retex_access_open(access, path, &descriptor, err);
    if (code)
        return code;
    const int status = sum_descriptor(sum, descriptor, path, err);
    close(descriptor);
    return status;
}
