/* Cryptomatte: the hash against values of MurmurHash3 that others published, numbers by the specification, ranks,
 * manifests. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "lib_test.h"
#include <cmocka.h>
#include "render/cryptomatte.h"

static uint32_t bits_of(float number)
{
    uint32_t bits;
    memcpy(&bits, &number, sizeof bits);
    return bits;
}

/* Of 0 to 4 bytes and more, by other implementations with seed 0. */
static void hashes_are_those_of_others(void **state)
{
    static const struct {
        const char *text;
        uint32_t hash;
    } known[] = {
        {"", 0},
        {"a", 0x3c2569b2u},
        {"abc", 0xb3dd93fau},
        {"aaaa", 0x7eeed987u},
        {"hello", 0x248bfa47u},
        {"hello, world", 0x149bbb7fu},
        {"The quick brown fox jumps over the lazy dog", 0x2e4ff723u},
        {"The quick brown fox jumps over the lazy dog.", 0xd5c48bfcu},
    };

    (void)state;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (cryptomatte_hash(known[k].text) != known[k].hash)
            fail_msg("`%s` is %08x", known[k].text, (unsigned)cryptomatte_hash(known[k].text));
}

/* The examples of the specification, and the keys that Blender writes. */
static void numbers_are_those_of_the_specification(void **state)
{
    char key[8];

    (void)state;
    assert_int_equal(bits_of(cryptomatte_number(cryptomatte_hash("bunny"))), 0x13851a76u);
    assert_int_equal(bits_of(cryptomatte_number(cryptomatte_hash("default"))), 0x42c9679fu);
    cryptomatte_key(key, "CryptoObject");
    assert_string_equal(key, "3ae39a5");
}

static void no_number_is_special(void **state)
{
    (void)state;
    assert_int_equal(bits_of(cryptomatte_number(0)), 1u << 23);
    assert_int_equal(bits_of(cryptomatte_number(0x80000005u)), 0x80800005u);
    assert_int_equal(bits_of(cryptomatte_number(0x7f800000u)), 0x7f000000u);
    assert_int_equal(bits_of(cryptomatte_number(0xffffffffu)), 0xff7fffffu);
    assert_int_equal(bits_of(cryptomatte_number(0x12345678u)), 0x12345678u);
    for (uint32_t k = 0; k < 100000; k++)
        assert_true(isnormal(cryptomatte_number(k * 42949u)));
}

static void ranks_are_sorted_by_share(void **state)
{
    CryptoPixel pixel = {0};
    float values[10];

    (void)state;
    crypto_pixel_add(&pixel, 3, 0.1);
    crypto_pixel_add(&pixel, 5, 0.2);
    crypto_pixel_add(&pixel, 3, 0.25);
    crypto_pixel_add(&pixel, 9, 0);
    crypto_pixel_add(&pixel, 7, 0.2);
    crypto_pixel_ranks(&pixel, 5, values);
    const float expected[10] = {3, 0.35f, 5, 0.2f, 7, 0.2f, 0, 0, 0, 0};
    for (int k = 0; k < 10; k++)
        assert_true(values[k] == expected[k]);
    crypto_pixel_ranks(&pixel, 1, values);
    assert_true(values[0] == 3 && values[2] == 5); /* no more is written */
}

static void more_names_than_fit_are_lost(void **state)
{
    static CryptoPixel pixel;
    float values[2];

    (void)state;
    for (int k = 0; k < CRYPTO_PIXEL_MAX + 10; k++)
        crypto_pixel_add(&pixel, (float)(k + 1), 0.001);
    crypto_pixel_add(&pixel, 17, 0.5);
    assert_int_equal(pixel.count, CRYPTO_PIXEL_MAX);
    crypto_pixel_ranks(&pixel, 1, values);
    assert_true(values[0] == 17 && fabsf(values[1] - 0.501f) < 1e-6f);
}

static void manifests_are_json(void **state)
{
    CryptoNames one = {0}, two = {0};
    char name[32], *text;

    (void)state;
    text = crypto_names_manifest(&one);
    assert_string_equal(text, "{}");
    free(text);
    crypto_names_add(&one, "default");
    crypto_names_add(&two, "bunny");
    crypto_names_add(&two, "default");
    crypto_names_join(&one, &two);
    text = crypto_names_manifest(&one);
    assert_string_equal(text, "{\"bunny\":\"13851a76\",\"default\":\"42c9679f\"}");
    free(text);
    crypto_names_close(&one);
    assert_true(crypto_names_add(&one, "a\"b\\c\nd") == cryptomatte_number(cryptomatte_hash("a\"b\\c\nd")));
    text = crypto_names_manifest(&one);
    assert_memory_equal(text, "{\"a\\\"b\\\\c\\u000ad\":\"", 19);
    free(text);
    crypto_names_close(&one);
    for (int k = 0; k < 3000; k++) { /* several times larger, and no name twice */
        snprintf(name, sizeof name, "name %d", k % 1500);
        crypto_names_add(&two, name);
    }
    assert_int_equal(two.count, 1502);
    crypto_names_close(&two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hashes_are_those_of_others),   cmocka_unit_test(numbers_are_those_of_the_specification),
        cmocka_unit_test(no_number_is_special),         cmocka_unit_test(ranks_are_sorted_by_share),
        cmocka_unit_test(more_names_than_fit_are_lost), cmocka_unit_test(manifests_are_json),
    };

    return cmocka_run_group_tests(tests, NULL, NULL);
}
