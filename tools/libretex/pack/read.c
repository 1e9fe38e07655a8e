/* Packs read whole, and checked. */
#include <retex/pack.h>
#include <retex/set_file.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "pack/open.h"

int retex_pack_read(const void *data, size_t bytes, RetexSet **set, int nthreads, RetexError *err)
{
    RetexInput *input = NULL;
    *set = NULL;
    int code = retex_input_borrow(&input, data, bytes, "the pack", err);
    if (!code)
        code = retex_pack_open(set, &input, err);
    if (!code)
        code = retex_set_load(*set, nthreads, err);
    if (code)
        retex_set_close(set);
    return code;
}

int retex_pack_check(const void *data, size_t bytes, int nthreads, RetexError *err)
{
    RetexInput *input = NULL;
    RetexSet *set = NULL;
    int code = retex_input_borrow(&input, data, bytes, "the pack", err);
    if (!code)
        code = retex_pack_open(&set, &input, err);
    if (!code)
        code = retex_pack_verify(set, nthreads, err);
    retex_set_close(&set);
    return code;
}

int retex_pack_probe(const void *data, size_t bytes)
{
    return bytes >= 4 && memcmp(data, "PK\3\4", 4) == 0;
}
