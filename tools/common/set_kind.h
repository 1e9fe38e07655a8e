/* Kinds of files that sets are written to, by their names. */
#ifndef RETEX_SET_KIND_H
#define RETEX_SET_KIND_H

#include <retex/set.h>

typedef struct SetKind {
    const char *ending; /* of names, with the dot */
    /* Write a set, with the defaults of the kind. */
    int (*write)(RetexSet *set, const char *path, int nthreads, RetexError *err);
} SetKind;

extern const SetKind set_kind_exr, set_kind_pack;

/* NULL: by its name it is none. */
const SetKind *set_kind_of_name(const char *name);

#endif
