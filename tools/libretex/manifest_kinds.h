/* Names of term kinds in the manifest, in the order of RetexTermKind. */
#ifndef RETEX_LIBRETEX_MANIFEST_KINDS_H
#define RETEX_LIBRETEX_MANIFEST_KINDS_H

static const char *const retex_term_kinds[] = { "full", "indep", "dep", "cross2", "cross3" };

enum { RETEX_TERM_KINDS = sizeof retex_term_kinds / sizeof retex_term_kinds[0] };

#endif
