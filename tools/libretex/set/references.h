/* Which parts a set refers to, and as what: in one place, for all that copies, counts, removes or stores parts. Private
 * to libretex. */
#ifndef RETEX_SET_REFERENCES_H
#define RETEX_SET_REFERENCES_H

#include <retex/set.h>

/* What a part is used as. */
typedef enum RetexPartUse {
    RETEX_PART_RADIANCE,
    RETEX_PART_IMAGE, /* a factor of a term */
    RETEX_PART_UV,
    RETEX_PART_SPREAD,
    RETEX_PART_ALBEDO,
    RETEX_PART_WEIGHT, /* of a mixture */
    RETEX_PART_ORIGINAL,
    RETEX_PART_LAID, /* what the texture that is laid on the set shows at a footprint */
    RETEX_PART_GATES /* of a target, by such a texture */
} RetexPartUse;

/* user: the index of the term, footprint, mixture or target. *part may be changed. */
typedef void RetexPartVisit(void *context, RetexPartUse use, int user, int *part);

/* Visit all references to parts that are present: those of terms, footprints, mixtures and targets, in this order. The
 * term of role PICTURE is left out: part 0 is in every set. */
void retex_set_visit_parts(RetexSet *set, RetexPartVisit *visit, void *context);
/* The same of a set that is not changed: visit must not change *part. */
static inline void retex_set_visit_const_parts(const RetexSet *set, RetexPartVisit *visit, void *context)
{
    retex_set_visit_parts((RetexSet *)set, visit, context);
}

#endif
