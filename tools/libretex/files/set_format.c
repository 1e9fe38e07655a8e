/* See set_format.h. A new format is a row. */
#include "files/set_format.h"

#include <retex/pack.h>
#include <retex/set_file.h>

#include "pack/open.h"
#include "set/read.h"

static int open_pack(RetexInput **input, RetexSet **set, int open, int nthreads, RetexError *err)
{
    (void)open, (void)nthreads; /* its parts are always read on demand */
    return retex_pack_open(set, input, err);
}

static int check_pack(RetexInput **input, int nthreads, RetexError *err)
{
    RetexSet *set = NULL;
    int code = retex_pack_open(&set, input, err);
    if (!code)
        code = retex_pack_verify(set, nthreads, err);
    retex_set_close(&set);
    return code;
}

static int check_exr(RetexInput **input, int nthreads, RetexError *err)
{
    return retex_set_check_exr(*input, nthreads, err);
}

static const RetexSetFormat format_pack = {retex_pack_probe, open_pack, check_pack};
const RetexSetFormat retex_set_format_exr = {NULL, retex_set_read_exr, check_exr};

const RetexSetFormat *retex_set_format_of(const RetexInput *input)
{
    static const RetexSetFormat *const formats[] = {&format_pack, &retex_set_format_exr};
    unsigned char begin[64];
    const int64_t got = retex_input_read(input, begin, sizeof begin, 0);
    int i = 0;
    while (formats[i]->probe && !(got > 0 && formats[i]->probe(begin, (size_t)got)))
        i++;
    return formats[i];
}
