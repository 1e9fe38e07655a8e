/* Deflating: what zlib inflates is what went in, of any bytes, at whatever length and in pieces. */
#include "lib_test.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <cmocka.h>

#include "deflate.h"

enum { MOST = 400000, KINDS = 7 };

static unsigned char bytes[MOST], back[MOST + 1];

/* Noise, nothing, few values in runs, frequencies far apart, runs in noise, runs far apart, smooth lines. */
static void fill(int kind, size_t count, uint32_t *seed)
{
    unsigned char last = 0;
    const double often = test_random(seed);
    for (size_t i = 0; i < count; i++) {
        const double u = test_random(seed);
        const int changes = test_random(seed) < often;
        switch (kind) {
        case 0:
            last = (unsigned char)(256 * u);
            break;
        case 1:
            break;
        case 2:
            last = changes ? (unsigned char)(4 * u) : last;
            break;
        case 3:
            last = (unsigned char)(5 * __builtin_ctz((unsigned)(u * 0x7fffffff) | 1u << 30));
            break;
        case 4:
            last = changes ? (unsigned char)(256 * u) : last;
            break;
        case 5:
            last = u < 1e-3 ? (unsigned char)(256e3 * u) : last;
            break;
        default:
            last = (unsigned char)(last + (int)(5 * u) - 2);
        }
        bytes[i] = last;
    }
}

static void check_inflates(const unsigned char *packed, size_t packed_bytes, size_t count)
{
    z_stream stream = {.next_in = (unsigned char *)packed, .avail_in = (uInt)packed_bytes};
    assert_int_equal(inflateInit2(&stream, -MAX_WBITS), Z_OK);
    stream.next_out = back;
    stream.avail_out = sizeof back;
    assert_int_equal(inflate(&stream, Z_FINISH), Z_STREAM_END);
    assert_int_equal(stream.total_out, count);
    assert_int_equal(stream.avail_in, 0);
    assert_memory_equal(back, bytes, count);
    inflateEnd(&stream);
}

static void test_comes_back(void **state)
{
    (void)state;
    uint32_t seed = 3;
    for (int round = 0; round < 1500; round++) {
        const size_t most = round % 30 == 0 ? MOST : round % 3 ? 2000 : 20;
        const size_t count = (size_t)((double)most * test_random(&seed)), room = retex_deflate_room(count);
        fill(round % KINDS, count, &seed);
        unsigned char *packed = malloc(room); /* exactly, so that a sanitizer sees what lies beyond */
        assert_non_null(packed);
        const size_t whole = retex_deflate(packed, room, bytes, count, 1);
        assert_true(whole > 0 && whole <= room);
        check_inflates(packed, whole, count);
        free(packed);
    }
}

/* Two pieces of one stream; the first ends at a whole byte. */
static void test_pieces(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int round = 0; round < 200; round++) {
        const size_t count = (size_t)(70000 * test_random(&seed)), first = (size_t)((double)count * test_random(&seed));
        const size_t room = retex_deflate_room(first) + retex_deflate_room(count - first);
        fill(round % KINDS, count, &seed);
        unsigned char *packed = malloc(room);
        assert_non_null(packed);
        size_t at = retex_deflate(packed, room, bytes, first, 0);
        assert_true(at > 0);
        at += retex_deflate(packed + at, room - at, bytes + first, count - first, 1);
        check_inflates(packed, at, count);
        free(packed);
    }
}

/* Whatever the room, it is kept to. */
static void test_little_room(void **state)
{
    (void)state;
    uint32_t seed = 9;
    int refused = 0;
    for (int round = 0; round < 500; round++) {
        const size_t count = (size_t)(3000 * test_random(&seed)) + 1, room = (size_t)(3100 * test_random(&seed)) + 1;
        fill(round % KINDS, count, &seed);
        unsigned char *packed = malloc(room);
        assert_non_null(packed);
        const size_t whole = retex_deflate(packed, room, bytes, count, 1);
        assert_true(whole <= room);
        if (whole)
            check_inflates(packed, whole, count);
        refused += !whole;
        free(packed);
    }
    assert_in_range(refused, 50, 450);
}

/* What it looks for it finds, and noise does not grow. */
static void test_is_short(void **state)
{
    (void)state;
    static const double most[KINDS] = {1.002, 0.01, 0.5, 0.6, 1.002, 0.1, 0.99}; /* of the bytes */
    static unsigned char packed[MOST + 4096];
    uint32_t seed = 11;
    for (int round = 0; round < 4 * KINDS; round++) {
        fill(round % KINDS, MOST, &seed);
        const double share = (double)retex_deflate(packed, sizeof packed, bytes, MOST, 1) / MOST;
        print_message("kind %d: %.4f\n", round % KINDS, share);
        assert_true(share > 0 && share < most[round % KINDS]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_comes_back),
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_little_room),
        cmocka_unit_test(test_is_short),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
