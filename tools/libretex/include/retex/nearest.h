/* The word most like a misspelt one: messages about unknown names say what is probably meant. */
#ifndef RETEX_NEAREST_H
#define RETEX_NEAREST_H

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

enum { RETEX_NEAREST_MAX = 64 }; /* bytes of a word; longer ones are like none */

/* The distance of two words: insertions, deletions, replacements and swaps of neighbours count twice; a letter in the
 * other case counts once. */
int retex_word_distance(const char *a, const char *b);
/* The largest distance at which a word counts as a misspelling of this one; it grows with the word's length. */
int retex_word_tolerance(const char *word);

/* Begin with {word, NULL, 0}, then try all candidates. best is the one of smallest distance within the tolerance, or
 * one that begins with the word if the word has at least three letters; of several the first in the alphabet; NULL
 * where none is near. */
typedef struct RetexNearest {
    const char *word, *best; /* borrowed */
    int distance;            /* of best */
} RetexNearest;

void retex_nearest_try(RetexNearest *nearest, const char *candidate);

/* The nearest word of an array; NULL where none is near. */
const char *retex_nearest_of(const char *word, const char *const *words, int count);

/* "; is BEST meant?" for the end of a message, or "" where best is NULL. Returns text. */
enum { RETEX_MEANT_SIZE = RETEX_NEAREST_MAX + 32 };
const char *retex_meant(const char *best, char text[RETEX_MEANT_SIZE]);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop

#endif
