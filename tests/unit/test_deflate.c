/* Deflate: zlib decompresses the streams that the library compressed, of any bytes, any length, whole or in pieces. The
 * library decompresses the streams that zlib compressed. Checksums are those of zlib. */
#include "lib_test.h"

#include <stdlib.h>
#include <string.h>
#include <zlib.h>

#include <cmocka.h>

#include <retex/host/cpu.h>
#if RETEX_CPU_X86
#include <cpuid.h>
#endif

#include "io/checksum.h"
#include "io/deflate.h"

enum { MOST = 400000, KINDS = 9 };

static unsigned char bytes[MOST], back[MOST + 1];

/* Noise, nothing, few values in runs, frequencies far apart, runs in noise, runs far apart, smooth lines; in
 * turns of 70000 nothing and nearly noise; pairs of noise. */
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
        case 6:
            last = (unsigned char)(last + (int)(5 * u) - 2);
            break;
        case 7:
            last = i / 70000 % 2 ? (unsigned char)(240 * u) : 0;
            break;
        default:
            last = i % 2 ? last : (unsigned char)(256 * u);
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
        const size_t count = (size_t)((double)most * test_random(&seed)), room = retex_deflate_bound(count);
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
        const size_t room = retex_deflate_bound(first) + retex_deflate_bound(count - first);
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

/* The same bytes give the same stream wherever they lie, whatever was deflated before. */
static void test_same_again(void **state)
{
    (void)state;
    static unsigned char moved[MOST + 64];
    uint32_t seed = 7;
    for (int round = 0; round < 4000; round++) {
        const size_t count = (size_t)((round % 50 ? 3000 : MOST) * test_random(&seed));
        const size_t room = retex_deflate_bound(count), step = (size_t)(60 * test_random(&seed)) + 1;
        unsigned char *first = malloc(room), *again = malloc(room), *hole = malloc(round % 7 * 30000 + 1);
        assert_true(first && again && hole);
        fill(round % KINDS, count, &seed);
        for (size_t i = step; i < count; i++) /* repetitions, not quite whole */
            if (round % 2 && test_random(&seed) < 0.9)
                bytes[i] = bytes[i - step];
        const size_t packed_bytes = retex_deflate(first, room, bytes, count, 1);
        memcpy(moved + round % 64, bytes, count);
        retex_deflate(again, room, back, (size_t)(5000 * test_random(&seed)), 1);
        free(hole);
        assert_int_equal(retex_deflate(again, room, moved + round % 64, count, 1), packed_bytes);
        assert_memory_equal(first, again, packed_bytes);
        free(first);
        free(again);
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
    static const double most[KINDS] = {1.002, 0.01, 0.5, 0.6, 1.002, 0.1, 0.99, 0.5, 1.002}; /* of the bytes */
    static unsigned char packed[MOST + 4096];
    uint32_t seed = 11;
    for (int round = 0; round < 4 * KINDS; round++) {
        fill(round % KINDS, MOST, &seed);
        const double share = (double)retex_deflate(packed, sizeof packed, bytes, MOST, 1) / MOST;
        print_message("kind %d: %.4f\n", round % KINDS, share);
        assert_true(share > 0 && share < most[round % KINDS]);
    }
}

/* zlib decompresses what the library compressed, with any effort: the same bytes each time, never more than there is
 * room for. */
static void test_compresses(void **state)
{
    (void)state;
    RetexZlib zlib = {.effort = 0}, other = {.effort = 0};
    uint32_t seed = 19;
    for (int round = 0; round < 300; round++) {
        const size_t count = (size_t)((round % 30 ? 3000 : MOST) * test_random(&seed));
        const size_t room = retex_deflate_bound(compressBound(count)) + 9;
        zlib.effort = other.effort = (RetexZlibEffort)(round / KINDS % 3);
        assert_true(retex_zlib_open(&zlib) && retex_zlib_open(&other));
        unsigned char *first = malloc(room);
        assert_non_null(first);
        fill(round % KINDS, count, &seed);
        const size_t packed = retex_zlib_compress(&zlib, first, room, bytes, count);
        uLongf back_bytes = sizeof back;
        assert_in_range(packed, 1, room);
        assert_int_equal(uncompress(back, &back_bytes, first, packed), Z_OK);
        assert_int_equal(back_bytes, count);
        assert_memory_equal(back, bytes, count);
        unsigned char *again = malloc(room), *tight = malloc(packed);
        assert_true(again && tight);
        retex_zlib_compress(&other, again, room, back, count / 2);
        assert_int_equal(retex_zlib_compress(&other, again, room, bytes, count), packed);
        assert_memory_equal(first, again, packed);
        const size_t fitted = retex_zlib_compress(&other, tight, packed, bytes, count);
        assert_true(fitted == 0 || fitted == packed ||
                    (zlib.effort && fitted < packed)); /* that may choose otherwise */
        back_bytes = sizeof back;
        assert_int_equal(fitted ? uncompress(back, &back_bytes, tight, fitted) : Z_OK, Z_OK);
        assert_memory_equal(back, bytes, count);
        free(tight);
        free(again);
        free(first);
    }
    retex_zlib_close(&zlib);
    retex_zlib_close(&other);
}

/* What zlib compresses comes back; cut off, of another length or with a bit changed that matters it is refused. */
static void test_decompresses(void **state)
{
    (void)state;
    RetexZlib zlib = {.effort = RETEX_ZLIB_SMALL};
    uint32_t seed = 13;
    assert_true(retex_zlib_open(&zlib));
    for (int round = 0; round < 300; round++) {
        const size_t count = (size_t)(20000 * test_random(&seed)) + 1;
        uLongf packed_bytes = compressBound(count);
        unsigned char *packed = malloc(packed_bytes), *out = malloc(count + 1);
        assert_non_null(packed);
        assert_non_null(out);
        fill(round % KINDS, count, &seed);
        assert_int_equal(compress2(packed, &packed_bytes, bytes, count, round % 10), Z_OK);
        assert_true(retex_zlib_decompress(&zlib, out, count, packed, packed_bytes));
        assert_memory_equal(out, bytes, count);
        assert_false(retex_zlib_decompress(&zlib, out, count - 1, packed, packed_bytes));
        assert_false(retex_zlib_decompress(&zlib, out, count + 1, packed, packed_bytes));
        assert_false(
            retex_zlib_decompress(&zlib, out, count, packed, (size_t)((double)packed_bytes * test_random(&seed))));
        packed[(size_t)((double)packed_bytes * test_random(&seed))] ^= (unsigned char)(1 << round % 8);
        assert_true(!retex_zlib_decompress(&zlib, out, count, packed, packed_bytes) || memcmp(out, bytes, count) == 0);
        free(packed);
        free(out);
    }
    retex_zlib_close(&zlib);
}

static void test_checksums(void **state)
{
    (void)state;
    uint32_t seed = 17;
    uint32_t crc = CRC32_OF_NONE, adler = ADLER32_OF_NONE;
    uLong zlib_crc = crc32(0, NULL, 0), zlib_adler = adler32(0, NULL, 0);
    for (int round = 0; round < 300; round++) {
        const size_t count = (size_t)((round % 50 ? 300 : MOST) * test_random(&seed));
        fill(round % KINDS, count, &seed);
        crc = retex_crc32(crc, bytes, count), adler = retex_adler32(adler, bytes, count);
        zlib_crc = crc32_z(zlib_crc, bytes, count), zlib_adler = adler32_z(zlib_adler, bytes, count);
        assert_int_equal(crc, zlib_crc);
        assert_int_equal(adler, zlib_adler);
    }
    assert_int_equal(retex_crc32(crc, NULL, 0), crc);
    assert_int_equal(retex_adler32(adler, NULL, 0), adler);
}

/* Whether the upper halves of vector registers are in use: XINUSE, bit 2 of what XGETBV gives with ECX = 1. 0 where the
 * processor cannot tell. */
static int are_upper_halves_used(void)
{
#if RETEX_CPU_X86
    unsigned a, b, c, d;
    if (!__get_cpuid(1, &a, &b, &c, &d) || !(c & 1u << 27) || !__get_cpuid_count(0xd, 1, &a, &b, &c, &d) ||
        !(a & 1u << 2))
        return 0;
    __asm__ volatile("xgetbv" : "=a"(a), "=d"(d) : "c"(1));
    return (a & 1u << 2) != 0;
#else
    return 0;
#endif
}

/* Nothing that is called here leaves them in use: code of the baseline would be several times as slow behind it. */
static void test_registers(void **state)
{
    static unsigned char packed[MOST + MOST / 64 + 512];
    uint32_t seed = 5;
    (void)state;
    fill(6, MOST, &seed);
    for (size_t count = 1; count < MOST; count *= 3) {
        (void)retex_crc32(0, bytes, count);
        assert_false(are_upper_halves_used());
        (void)retex_adler32(1, bytes, count);
        assert_false(are_upper_halves_used());
        assert_true(retex_deflate(packed, sizeof packed, bytes, count, 1) > 0);
        assert_false(are_upper_halves_used());
        for (int effort = 0; effort < 3; effort++) {
            RetexZlib zlib = {.effort = (RetexZlibEffort)effort};
            assert_true(retex_zlib_open(&zlib));
            const size_t packed_bytes = retex_zlib_compress(&zlib, packed, sizeof packed, bytes, count);
            assert_false(are_upper_halves_used());
            assert_true(packed_bytes > 0 && retex_zlib_decompress(&zlib, back, count, packed, packed_bytes));
            assert_false(are_upper_halves_used());
            retex_zlib_close(&zlib);
        }
    }
}

static int slow = 0, quick = 1;
#define COMPRESSES(quickly) cmocka_unit_test_prestate(test_compresses, (quickly) ? &quick : &slow)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_comes_back),
        cmocka_unit_test(test_pieces),
        cmocka_unit_test(test_same_again),
        cmocka_unit_test(test_little_room),
        cmocka_unit_test(test_is_short),
        COMPRESSES(0),
        COMPRESSES(1),
        cmocka_unit_test(test_decompresses),
        cmocka_unit_test(test_checksums),
        cmocka_unit_test(test_registers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
