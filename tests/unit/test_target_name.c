/* Names of targets, and what names of parts have of them. */
#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <string.h>
#include <cmocka.h>
#include <retex/target_name.h>
#include "base/part_name.h"

static void what_may_be_a_name(void **state)
{
    (void)state;
    const char *good[] = {"Floor",        "-",        "Wand gr\xc3\xbcn", "Wood.001",     "oak (old) +1",
                          "\xe6\x9c\xa8", "\xc2\xa0", "\xf0\x9f\x9a\xaa", "\xed\x9f\xbf", "\xf4\x8f\xbf\xbf"};
    const char *bad[] = {"",      " a",       "a ",       ".a",           "a=b",          "a,b",
                         "a:b",   "#1",       "@1",       "~a",           "a*",           "a/b",
                         "a\"b",  "a\\b",     "a\nb",     "a;b",          "a\x7f",        "\xc3",
                         "\x80",  "\xc0\x80", "\xc1\xbf", "\xc2\x85",     "\xe0\x80\xaf", "\xed\xa0\x80",
                         "\xf0\x80\x80\xaf", "\xf4\x90\x80\x80",          "\xf5\x80\x80\x80", "\xff", "a\xe6\x9c"};
    char longest[RETEX_NAME_MAX + 1];
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        assert_true(retex_target_name_is_valid(good[i]));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_false(retex_target_name_is_valid(bad[i]));
    memset(longest, 'a', sizeof longest);
    longest[RETEX_NAME_MAX] = 0;
    assert_false(retex_target_name_is_valid(longest));
    longest[RETEX_NAME_MAX - 1] = 0;
    assert_true(retex_target_name_is_valid(longest));
}

/* Checksums are FNV-1a's, computed in Python. */
static void words_of_parts(void **state)
{
    (void)state;
    const char *names[] = {"Floor", "a b", "a-b", "Wand gr\xc3\xbcn", "Wand gr__n"};
    const char *words[] = {"Floor", "a_b_10a3f9f2", "a-b", "Wand_gr__n_", "Wand_gr__n_"};
    char word[RETEX_NAME_MAX], others[5][RETEX_NAME_MAX], longest[RETEX_NAME_MAX];
    for (int i = 0; i < 5; i++) {
        retex_target_word(others[i], names[i]);
        assert_true(retex_name_is_valid(others[i]));
        assert_int_equal(strncmp(others[i], words[i], strlen(words[i])), 0);
        for (int k = 0; k < i; k++)
            assert_string_not_equal(others[i], others[k]);
    }
    memset(longest, ' ', sizeof longest);
    longest[RETEX_NAME_MAX - 1] = 0;
    retex_target_word(word, longest);
    assert_true(retex_name_is_valid(word) && strlen(word) < 80);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_may_be_a_name),
        cmocka_unit_test(words_of_parts),
    };
    cmocka_set_message_output(CM_OUTPUT_TAP);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
