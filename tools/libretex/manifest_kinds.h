/* Names in the manifest: of terms, in the order of RetexTermKind. */
#ifndef RETEX_LIBRETEX_MANIFEST_KINDS_H
#define RETEX_LIBRETEX_MANIFEST_KINDS_H

static const char *const retex_term_kinds[] = { "full", "indep", "dep", "cross2", "cross3" };

/* Of footprints, in the order of RetexFootprintKind. */
static const char *const retex_footprint_kinds[] = { "hit", "sharp", "broad", "later" };

enum { RETEX_TERM_KINDS = sizeof retex_term_kinds / sizeof retex_term_kinds[0],
       RETEX_FOOTPRINT_KINDS = sizeof retex_footprint_kinds / sizeof retex_footprint_kinds[0] };

#endif
