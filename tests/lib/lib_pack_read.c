#include "lib_pack_read.h"

#include <retex/set_file.h>

#include "pack/open.h"

static int open_pack(const void *data, size_t bytes, RetexSet **set, RetexError *err)
{
    RetexInput *input = NULL;
    *set = NULL;
    const int code = retex_input_borrow(&input, data, bytes, "the pack", err);
    return code ? code : retex_pack_open(set, &input, err);
}

int pack_read(const void *data, size_t bytes, RetexSet **set, int nthreads, RetexError *err)
{
    int code = open_pack(data, bytes, set, err);
    if (!code)
        code = retex_set_load(*set, nthreads, err);
    if (code)
        retex_set_close(set);
    return code;
}

int pack_check(const void *data, size_t bytes, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    int code = open_pack(data, bytes, &set, err);
    if (!code)
        code = retex_pack_verify(set, nthreads, err);
    retex_set_close(&set);
    return code;
}
