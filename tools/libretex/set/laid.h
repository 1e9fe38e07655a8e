/* Textures laid on a set, as the rooms that make, read and write them need them beyond <retex/laid.h>. Private to
 * libretex. */
#ifndef RETEX_SET_LAID_H
#define RETEX_SET_LAID_H

#include <retex/laid.h>

#include "set/set.h"

/* Add a part "RGB", float, without pixels, for what a texture shows at a footprint: with finish -1 its colour, else
 * that times the weight of the finish. With footprint -1 the gates of a target. The footprint or the target refers to
 * it from then on. */
int retex_set_add_laid(RetexSet *set, int target, int footprint, int finish, int *part, RetexError *err);

/* Whether a texture is laid on a target. */
int retex_target_has_laid(const RetexSet *set, int target);

/* RETEX_EINVAL where a texture is laid on the set: it would be lost in what is to be made, such as "a pack". */
int retex_set_check_bare(const RetexSet *set, const char *what, RetexError *err);

#endif
