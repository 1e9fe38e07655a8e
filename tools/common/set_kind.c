/* See set_kind.h. */
#include "common/set_kind.h"

#include <retex/pack.h>
#include <retex/set_file.h>

#include "common/cli.h"

static int write_exr(RetexSet *set, const char *path, int nthreads, RetexError *err)
{
    return retex_set_write(set, path, NULL, nthreads, err);
}

static int write_pack(RetexSet *set, const char *path, int nthreads, RetexError *err)
{
    return retex_pack_write(set, path, NULL, NULL, nthreads, err);
}

const SetKind set_kind_exr = {".exr", write_exr}, set_kind_pack = {".retex", write_pack};

const SetKind *set_kind_of_name(const char *name)
{
    return cli_ends_with(name, set_kind_exr.ending)    ? &set_kind_exr
           : cli_ends_with(name, set_kind_pack.ending) ? &set_kind_pack
                                                       : NULL;
}
