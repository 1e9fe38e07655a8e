/* See lib_pack.h. */
#include "lib_pack.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

unsigned char *pack(const RetexSet *set, const RetexPackParams *params, size_t *bytes, int nthreads)
{
    char path[] = "/tmp/test_pack_XXXXXX";
    RetexError err = {0};
    int fd = mkstemp(path);
    assert_true(fd >= 0);
    close(fd);
    test_must(retex_pack_write(set, path, params, bytes, nthreads, &err), &err);
    FILE *file = fopen(path, "rb");
    unsigned char *data = malloc(*bytes);
    assert_int_equal(fread(data, 1, *bytes, file), *bytes);
    assert_int_equal(fgetc(file), EOF);
    fclose(file);
    unlink(path);
    return data;
}

RetexPackParams lossless(void)
{
    RetexPackParams params = RETEX_PACK_INIT;
    params.lossless = 1;
    return params;
}

RetexSet *unpack(const unsigned char *data, size_t bytes)
{
    RetexSet *set = NULL;
    RetexError err = {0};
    test_must(retex_pack_read(data, bytes, &set, 2, &err), &err);
    return set;
}

double part_difference(const RetexPart *a, const RetexPart *b, double floor)
{
    size_t n = (size_t)a->image.width * (size_t)a->image.height * (size_t)a->image.channels;
    double worst = 0;
    assert_int_equal(a->image.channels, b->image.channels);
    assert_int_equal(a->image.width, b->image.width);
    assert_int_equal(a->image.height, b->image.height);
    for (size_t i = 0; i < n; i++) {
        double x = (double)a->image.pixels[i], y = (double)b->image.pixels[i];
        if (x != y)
            worst = fmax(worst, fabs(x - y) / fmax(fmax(fabs(x), fabs(y)), floor));
    }
    return worst;
}
