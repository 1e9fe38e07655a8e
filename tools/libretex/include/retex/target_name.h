/* Names of targets, as people type them: in options, tables and URLs they mean the same. */
#ifndef RETEX_TARGET_NAME_H
#define RETEX_TARGET_NAME_H

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
/* The same of a lamp, and of a lamp's light that meets a target (or NULL) first: `lamp_LAMP` or `lamp_LAMP_TARGET`,
 * with a checksum where their names might be divided in another way or are long. word: at most 90 bytes. */
void retex_lamp_word(char word[RETEX_NAME_MAX], const char *lamp, const char *target);

/* The targets of a set, or of a scene. */
typedef struct RetexTargetNames {
    int count;                             /* at most RETEX_MAX_TARGETS */
    const char *names[RETEX_MAX_TARGETS];  /* borrowed */
    const char *idents[RETEX_MAX_TARGETS]; /* the scene's identifiers of each, divided by commas; borrowed */
    const char *of;                        /* what has them, for messages: "the set" */
    const char *advice;                    /* the end of the message about a name that is like none of them, or "" */
} RetexTargetNames;

void retex_set_target_names(RetexTargetNames *names, const RetexSet *set);
/* The target that a name means: the one of this name, else the only one whose name differs from it in the case of
 * letters alone, else the only one that has just this identifier; -1 = none. */
int retex_target_index(const RetexTargetNames *names, const char *name);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop

#endif
