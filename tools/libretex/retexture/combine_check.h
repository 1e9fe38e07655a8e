/* Whether a set can be recombined. Private to libretex. */
#ifndef RETEX_RETEXTURE_COMBINE_CHECK_H
#define RETEX_RETEXTURE_COMBINE_CHECK_H

#include <retex/set.h>

/* Returns 1 if the set has all parts that its terms need, as far as that is known without samples; 0 if it has not; or
 * RETEX_ENOMEM. */
int retex_combine_check(const RetexSet *set, RetexError *err);

#endif
