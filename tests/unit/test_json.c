/* Values of JSON as tools print them: any text, any number. */
#include "lib_test.h"
#include <cmocka.h>

#include <math.h>

#include "common/json.h"

static void assert_line(json_t *value, const char *expected)
{
    char *line = json_line_text(value, 6);
    assert_non_null(line);
    assert_string_equal(line, expected);
    free(line);
}

static void test_text(void **state)
{
    (void)state;
    assert_line(json_pack("[o]", json_of_text("a \"b\" \\ \xc3\xa4")), "[\"a \\\"b\\\" \\\\ \xc3\xa4\"]\n");
    assert_line(json_pack("[o]", json_of_text("\xff\xc3")), "[\"\xef\xbf\xbd\xef\xbf\xbd\"]\n"); /* no UTF-8 */
    assert_line(json_pack("[o]", json_of_text("\x1b[31m")), "[\"\\u001B[31m\"]\n");
}

static void test_numbers(void **state)
{
    (void)state;
    assert_line(json_pack("[o, o, o]", json_of_number(120), json_of_number(1.5), json_of_number(1. / 3)),
                "[120, 1.5, 0.333333]\n");
    assert_line(json_pack("[o, o, o]", json_of_number(NAN), json_of_number(INFINITY), json_of_number(-INFINITY)),
                "[null, null, null]\n");
    assert_line(json_pack("[o, o]", json_of_rounded(0.12345, 4), json_of_rounded(7, 4)), "[0.1235, 7]\n");
}

static void test_no_memory(void **state)
{
    json_t *list = json_array();
    (void)state;
    json_add(&list, NULL); /* what a call gives that had no memory */
    assert_null(list);
    assert_null(json_line_text(list, 6));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_text), cmocka_unit_test(test_numbers),
                                       cmocka_unit_test(test_no_memory)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
