/* Similar words: the edit distance is compared with a simple recursion, and the suggested word is checked. */
#include "lib_test.h"
#include <cmocka.h>
#include <ctype.h>
#include <string.h>

#include <retex/nearest.h>

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int equal(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

/* Every way to edit the first letters, tried out. */
static int edits(const char *a, const char *b)
{
    if (!*a || !*b)
        return 2 * (int)(strlen(a) + strlen(b));
    int best = edits(a + 1, b + 1) + (*a == *b ? 0 : equal(*a, *b) ? 1 : 2);
    best = least(best, edits(a + 1, b) + 2);
    best = least(best, edits(a, b + 1) + 2);
    if (a[1] && b[1] && equal(a[0], b[1]) && equal(a[1], b[0]))
        best = least(best, edits(a + 2, b + 2) + 2);
    return best;
}

static void random_word(uint32_t *random, char *word)
{
    static const char letters[] = "abAB";
    int length = (int)(test_random(random) * 6);
    for (int k = 0; k < length; k++)
        word[k] = letters[(int)(test_random(random) * 4)];
    word[length] = 0;
}

static void test_distance(void **state)
{
    (void)state;
    uint32_t random = 1;
    char a[8], b[8];
    for (int k = 0; k < 3000; k++) {
        random_word(&random, a);
        random_word(&random, b);
        assert_int_equal(retex_word_distance(a, b), edits(a, b));
        assert_int_equal(retex_word_distance(b, a), edits(a, b));
    }
}

static void test_nearest(void **state)
{
    (void)state;
    static const char *const names[] = {"texture", "threads", "target", "replace", "spp",
                                        "seed",    "size",    "Floor",  "floor"};
    const struct {
        const char *word, *best;
    } cases[] = {{"textur", "texture"}, {"tagret", "target"}, {"TARGET", "target"}, {"rep", "replace"},
                 {"repl", "replace"},   {"zzzzzz", NULL},     {"", NULL},           {"sp", NULL},
                 {"sps", "spp"},        {"saed", "seed"},     {"Flor", "Floor"},    {"flor", "floor"},
                 {"FLOOR", "Floor"},    {"x", NULL}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *best = retex_nearest_of(cases[k].word, names, 9);
        if (cases[k].best)
            assert_string_equal(best, cases[k].best);
        else
            assert_null(best);
    }
}

static void test_long_words(void **state)
{
    (void)state;
    char word[4 * RETEX_NEAREST_MAX], other[4 * RETEX_NEAREST_MAX];
    const char *const names[] = {other};
    for (int length = RETEX_NEAREST_MAX - 1; length <= RETEX_NEAREST_MAX + 1; length++) {
        memset(word, 'a', (size_t)length);
        word[length] = 0;
        strcpy(other, word);
        other[3] = 'b';
        if (length <= RETEX_NEAREST_MAX)
            assert_string_equal(retex_nearest_of(word, names, 1), other);
        else
            assert_null(retex_nearest_of(word, names, 1));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_distance),
        cmocka_unit_test(test_nearest),
        cmocka_unit_test(test_long_words),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
