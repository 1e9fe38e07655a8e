/* See params.h. */
#include <string.h>

#include "base/params.h"

/* The bytes after the size that both structs have; -1 where the caller's size cannot be one. */
static long common_bytes(const void *given, size_t own_size)
{
    size_t size;

    memcpy(&size, given, sizeof size);
    return size < sizeof size ? -1 : (long)((size < own_size ? size : own_size) - sizeof size);
}

static int refuse_size(RetexError *err)
{
    return retex_fail(err, RETEX_EINVAL, "parameters without their size: initialise them with the macro of their type");
}

int retex_params_copy(void *own, size_t own_size, const void *given, RetexError *err)
{
    const long bytes = given ? common_bytes(given, own_size) : 0;

    if (bytes < 0)
        return refuse_size(err);
    if (bytes > 0)
        memcpy((char *)own + sizeof(size_t), (const char *)given + sizeof(size_t), (size_t)bytes);
    return RETEX_OK;
}

int retex_params_return(void *given, const void *own, size_t own_size, RetexError *err)
{
    const long bytes = common_bytes(given, own_size);

    if (bytes < 0)
        return refuse_size(err);
    memcpy((char *)given + sizeof(size_t), (const char *)own + sizeof(size_t), (size_t)bytes);
    return RETEX_OK;
}
