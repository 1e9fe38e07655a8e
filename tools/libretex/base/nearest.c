/* See nearest.h. */
#include <retex/nearest.h>

#include <stdio.h>
#include <string.h>

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int fold(char c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

static int replacement(char a, char b)
{
    return a == b ? 0 : fold(a) == fold(b) ? 1 : 2;
}

int retex_word_distance(const char *a, const char *b)
{
    int rows[3][RETEX_NEAREST_MAX + 1], *before = rows[0], *above = rows[1], *row = rows[2];
    const size_t na = strlen(a), nb = strlen(b);
    if (na > RETEX_NEAREST_MAX || nb > RETEX_NEAREST_MAX)
        return 2 * RETEX_NEAREST_MAX;
    for (size_t j = 0; j <= nb; j++)
        row[j] = above[j] = before[j] = 2 * (int)j;
    for (size_t i = 1; i <= na; i++) {
        int *oldest = before;
        before = above, above = row, row = oldest;
        row[0] = 2 * (int)i;
        for (size_t j = 1; j <= nb; j++) {
            row[j] = least(least(above[j], row[j - 1]) + 2, above[j - 1] + replacement(a[i - 1], b[j - 1]));
            if (i > 1 && j > 1 && fold(a[i - 1]) == fold(b[j - 2]) && fold(a[i - 2]) == fold(b[j - 1]))
                row[j] = least(row[j], before[j - 2] + 2);
        }
    }
    return row[nb];
}

int retex_word_tolerance(const char *word)
{
    return 2 * (int)(strlen(word) / 3) + 1;
}

static int begins_with(const char *candidate, const char *word)
{
    size_t length = strlen(word), k = 0;
    while (k < length && fold(candidate[k]) == fold(word[k]))
        k++;
    return length >= 3 && k == length;
}

void retex_nearest_try(RetexNearest *nearest, const char *candidate)
{
    const int tolerance = retex_word_tolerance(nearest->word);
    int distance = retex_word_distance(nearest->word, candidate);
    if (begins_with(candidate, nearest->word))
        distance = least(distance, tolerance);
    if (distance > tolerance)
        return;
    if (!nearest->best || distance < nearest->distance ||
        (distance == nearest->distance && strcmp(candidate, nearest->best) < 0)) {
        nearest->best = candidate;
        nearest->distance = distance;
    }
}

const char *retex_nearest_of(const char *word, const char *const *words, int count)
{
    RetexNearest nearest = {word, NULL, 0};
    for (int k = 0; k < count; k++)
        retex_nearest_try(&nearest, words[k]);
    return nearest.best;
}

const char *retex_meant(const char *best, char text[RETEX_MEANT_SIZE])
{
    text[0] = '\0';
    if (best)
        snprintf(text, RETEX_MEANT_SIZE, "; is %s meant?", best);
    return text;
}
