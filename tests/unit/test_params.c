/* Structs that begin with their size: callers with shorter and longer ones than the library's, and with none. */
#include <stdint.h>
#include <string.h>

#include "lib_test.h"
#include <cmocka.h>

#include <retex/combine.h>

#include "base/params.h"

typedef struct Params {
    size_t size;
    int a, b;
    double c;
} Params;
static const Params defaults = {sizeof defaults, 1, 2, 3};

/* A struct of `size` bytes, the first of which are {size, 10, 20, 30}, and all others are ones. */
typedef union Given {
    Params params;
    unsigned char bytes[64];
} Given;

static Given given_of(size_t size)
{
    Given given;
    memset(&given, 0xff, sizeof given);
    const Params all = {size, 10, 20, 30};
    memcpy(&given, &all, size < sizeof all ? size : sizeof all);
    memcpy(&given, &size, sizeof size);
    return given;
}

static void test_copy(void **state)
{
    (void)state;
    const struct {
        size_t size;
        Params copy;
    } cases[] = {{8, {24, 1, 2, 3}},
                 {12, {24, 10, 2, 3}},
                 {16, {24, 10, 20, 3}},
                 {24, {24, 10, 20, 30}},
                 {64, {24, 10, 20, 30}},
                 {SIZE_MAX, {24, 10, 20, 30}}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const Given given = given_of(cases[i].size);
        Params own = defaults;
        assert_int_equal(RETEX_PARAMS_COPY(&own, &given.params, NULL), RETEX_OK);
        assert_int_equal(own.size, sizeof own);
        assert_int_equal(own.a, cases[i].copy.a);
        assert_int_equal(own.b, cases[i].copy.b);
        assert_true(own.c == cases[i].copy.c);
    }
    Params own = defaults;
    assert_int_equal(RETEX_PARAMS_COPY(&own, NULL, NULL), RETEX_OK);
    assert_memory_equal(&own, &defaults, sizeof own);
}

static void test_return(void **state)
{
    (void)state;
    const Params own = {sizeof own, -1, -2, -3};
    for (size_t size = 8; size <= 64; size += 4) {
        Given given = given_of(size), expected = given;
        memcpy(expected.bytes + 8, (const char *)&own + 8, (size < sizeof own ? size : sizeof own) - 8);
        assert_int_equal(RETEX_PARAMS_RETURN(&given.params, &own, NULL), RETEX_OK);
        assert_memory_equal(&given, &expected, sizeof given);
    }
}

static void test_no_size(void **state)
{
    (void)state;
    for (size_t size = 0; size < 8; size++) {
        Given given = given_of(size);
        const Given before = given;
        Params own = defaults;
        RetexError err = {0};
        assert_int_equal(RETEX_PARAMS_COPY(&own, &given.params, &err), RETEX_EINVAL);
        assert_string_equal(err.message, "parameters without their size: initialise them with the macro of their type");
        assert_memory_equal(&own, &defaults, sizeof own);
        assert_int_equal(RETEX_PARAMS_RETURN(&given.params, &own, NULL), RETEX_EINVAL);
        assert_memory_equal(&given, &before, sizeof given);
    }
}

/* Arrays go by the size of their first one, which all have. */
static void test_arrays(void **state)
{
    (void)state;
    RetexTexture *textures[RETEX_MAX_TARGETS];
    RetexTextureSpec specs[2] = {RETEX_TEXTURE_SPEC_INIT, RETEX_TEXTURE_SPEC_INIT};
    RetexError err = {0};
    RetexSet *set = NULL;
    test_must(retex_set_create(&set, 8, 8, &err), &err);
    specs[1].size -= 8;
    assert_int_equal(retex_textures_load(textures, set, specs, 2, 1, &err), RETEX_EINVAL);
    assert_string_equal(err.message, "textures whose parameters differ in size");
    specs[0].size = 0;
    assert_int_equal(retex_textures_load(textures, set, specs, 2, 1, &err), RETEX_EINVAL);
    assert_int_equal(retex_textures_load(textures, set, specs, 9, 1, &err), RETEX_EINVAL);
    assert_string_equal(err.message, "9 textures are more than a set has targets");
    retex_set_close(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_copy), cmocka_unit_test(test_return),
                                       cmocka_unit_test(test_no_size), cmocka_unit_test(test_arrays)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
