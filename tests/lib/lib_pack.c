/* See lib_pack.h. */
#include "lib_pack.h"
#include "lib_footprints.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
    test_must(pack_read(data, bytes, &set, 2, &err), &err);
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

RetexSet *set_of_axes(int width, int height)
{
    RetexSet *set = start_set(width, height, 1);
    set->targets[0].periodic[0] = 1;
    strcpy(set->filter, "box");
    const int f = add_footprint(set, 0, RETEX_FOOTPRINT_SHARP, 1, "RGBA"), light = add_term(set, 1, f, 0);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const double below = 20 + y, aside = x + 0.3 * y, u = 3 * aside / below;
            if (hypot(x - 0.5 * width, y - 0.5 * height) < 0.2 * width)
                continue;
            const double axes[] = {3 / below, 0, 0.9 / below - u / below, 40 / (below * below)};
            put(set, f, x, y, (float)(u - floor(u)), (float)(-40 / below), 1);
            for (int k = 0; k < RETEX_AXES; k++)
                pixel(set, set->footprints[f].spread, x, y)[k] = (float)axes[k];
            put_rgb(set, set->footprints[f].albedo, x, y, 0.5f, 0.5f, 0.5f);
            put_rgb(set, light, x, y, 0.8f, 0.7f, 0.6f);
        }
    return set;
}
