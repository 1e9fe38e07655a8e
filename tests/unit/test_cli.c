/* Parsing of a command line: cli_next. tests/cli tests what ends the process (wrong options, --help). */
#include "lib_test.h"
#include <cmocka.h>

#include "common/cli.h"

static const CliOption options[] = {
    {"target", 't', "NAME", "", 0},
    {"texture", 0, "NAME=IMAGE", "", 1},
    {"plain", 'p', NULL, "", 0},
    {"list", 'l', NULL, "", 0},
    {0},
};

/* Walk `words` and check that the options and values come in this order; "" stands for a positional argument. */
typedef struct Expected {
    const char *name, *value, *modifiers;
} Expected;

static Cli walk(const char *const *words, int nwords, const Expected *expected, int nexpected)
{
    Cli cli = {.tool = "retex-test",
               .usage = "",
               .about = "",
               .options = options,
               .argc = nwords,
               .argv = (char **)(uintptr_t)words};
    for (int i = 0; i < nexpected; i++) {
        const CliOption *option = cli_next(&cli);
        assert_non_null(option);
        assert_string_equal(option->name, expected[i].name);
        if (expected[i].value)
            assert_string_equal(cli.value, expected[i].value);
        assert_string_equal(cli.modifiers, expected[i].modifiers ? expected[i].modifiers : "");
    }
    assert_null(cli_next(&cli));
    assert_null(cli_next(&cli));
    return cli;
}

#define COUNT(a) (int)(sizeof(a) / sizeof *(a))

static void test_values_attached_and_not(void **state)
{
    (void)state;
    const char *words[] = {"retex-test", "--target", "a", "--target=b", "-t", "c", "-td", "--target=", "-t", "-x"};
    const Expected expected[] = {{"target", "a", 0}, {"target", "b", 0}, {"target", "c", 0},
                                 {"target", "d", 0}, {"target", "", 0},  {"target", "-x", 0}};
    walk(words, COUNT(words), expected, COUNT(expected));
}

static void test_modifiers_end_where_the_word_does(void **state)
{
    (void)state;
    const char *words[] = {"retex-test",      "--texture:scale=2,2:rotate=30",
                           "floor=oak.jpg",   "--texture",
                           "wall=rgb(1,0,0)", "--texture=x=y:z",
                           "--texture:",      "q=r"};
    const Expected expected[] = {{"texture", "floor=oak.jpg", "scale=2,2:rotate=30"},
                                 {"texture", "wall=rgb(1,0,0)", ""},
                                 {"texture", "x=y:z", ""},
                                 {"texture", "q=r", ""}};
    walk(words, COUNT(words), expected, COUNT(expected));
}

static void test_clusters_of_letters(void **state)
{
    (void)state;
    const char *words[] = {"retex-test", "-plq", "-vptname", "-lpoout", "file"};
    const Expected expected[] = {{"plain", 0, 0}, {"list", 0, 0},  {"plain", 0, 0}, {"target", "name", 0},
                                 {"list", 0, 0},  {"plain", 0, 0}, {"", "file", 0}};
    Cli cli = walk(words, COUNT(words), expected, COUNT(expected));
    assert_true(cli.quiet && cli.verbose);
    assert_string_equal(cli.output, "out");
}

static void test_positional_arguments(void **state)
{
    (void)state;
    const char *words[] = {"retex-test", "a", "-", "-p", "b", "--", "--plain", "-", "--"};
    const Expected expected[] = {{"", "a", 0},       {"", "-", 0}, {"plain", 0, 0}, {"", "b", 0},
                                 {"", "--plain", 0}, {"", "-", 0}, {"", "--", 0}};
    walk(words, COUNT(words), expected, COUNT(expected));
}

static void test_common_options_are_kept(void **state)
{
    (void)state;
    const char *words[] = {"retex-test", "--threads", "7", "-o", "x", "--output=y", "-q"};
    Cli cli = walk(words, COUNT(words), NULL, 0);
    assert_int_equal(cli.threads, 7);
    assert_string_equal(cli.output, "y");
    assert_true(cli.quiet && !cli.verbose);
    const char *none[] = {"retex-test"};
    cli = walk(none, 1, NULL, 0);
    assert_int_equal(cli.threads, 0);
    assert_null(cli.output);
}

static void test_numbers_to_their_bounds(void **state)
{
    (void)state;
    Cli cli = {.tool = "retex-test", .value = "-12"};
    assert_int_equal(cli_integer(&cli, &options[0], -12, 5), -12);
    cli.value = "5";
    assert_int_equal(cli_integer(&cli, &options[0], -12, 5), 5);
    cli.value = "2.5e-1";
    assert_true(cli_number(&cli, &options[0], 0, 1) == 0.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_values_attached_and_not), cmocka_unit_test(test_modifiers_end_where_the_word_does),
        cmocka_unit_test(test_clusters_of_letters),     cmocka_unit_test(test_positional_arguments),
        cmocka_unit_test(test_common_options_are_kept), cmocka_unit_test(test_numbers_to_their_bounds),
    };
    return cmocka_run_group_tests_name("cli", tests, NULL, NULL);
}
