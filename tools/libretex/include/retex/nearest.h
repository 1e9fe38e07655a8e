/* Which of some words is most like one that is none of them: for messages about slips of the pen. */
#ifndef RETEX_NEAREST_H
#define RETEX_NEAREST_H

#ifdef __cplusplus
extern "C" {
#endif

enum { RETEX_NEAREST_MAX = 64 }; /* bytes of a word; longer ones are like none */

/* Insertions, deletions, replacements and swaps of neighbours that make one word of the other, counted twice; a letter
 * in the other case counts once. */
int retex_word_distance(const char *a, const char *b);
/* The largest distance at which a word is still taken for a slip of this one: the longer it is, the more. */
int retex_word_tolerance(const char *word);

/* Begin with {word, NULL, 0}; then try all candidates. best is that of least distance within the tolerance, or one
 * that begins with the word, of which at least three letters are there; the first in the alphabet of several; NULL
 * where none is. */
typedef struct RetexNearest {
    const char *word, *best; /* borrowed */
    int distance;            /* of best */
} RetexNearest;

void retex_nearest_try(RetexNearest *nearest, const char *candidate);

/* The same for an array of words; NULL where none is near. */
const char *retex_nearest_of(const char *word, const char *const *words, int count);

/* "; is BEST meant?" for the end of a message, or "" where best is NULL. Returns text. */
enum { RETEX_MEANT_SIZE = RETEX_NEAREST_MAX + 32 };
const char *retex_meant(const char *best, char text[RETEX_MEANT_SIZE]);

#ifdef __cplusplus
}
#endif

#endif
