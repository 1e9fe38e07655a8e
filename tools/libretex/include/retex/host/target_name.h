/* Names of targets: what people type. Renderers need both calls, others neither. */
#ifndef RETEX_HOST_TARGET_NAME_H
#define RETEX_HOST_TARGET_NAME_H

#include <retex/set.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Whether a target can be named so on command lines: 1 to 127 bytes, of letters, digits, spaces, `_-.+()` and
 * characters beyond ASCII in UTF-8, neither with a space at an end nor with a point first. Sets of other programs may
 * have other names. */
int retex_target_name_is_valid(const char *name);
/* The target's name as names of parts have it: the name itself, if it has letters, digits, `_` and `-` only; else
 * these, with others replaced by `_`, and a checksum of the name. word: at most 79 bytes if it is not the name. */
void retex_target_word(char word[RETEX_NAME_MAX], const char *name);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop

#endif
