/* make_values FILE X,Y…: prints the values of part 0 of a set or picture at these pixels, with nine digits, one line
 * per pixel; for `mean` the means of all pixels. */
#include <retex/image.h>
#include <retex/image_file.h>
#include <retex/set.h>
#include <retex/set_file.h>
#include <stdio.h>
#include <string.h>

#include "set/laid.h"

static void print_mean(const RetexImage *image)
{
    const size_t count = (size_t)image->width * (size_t)image->height, channels = (size_t)image->channels;
    double sums[3] = {0};
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            sums[c] += (double)image->pixels[channels * i + c];
    printf("%.9g %.9g %.9g\n", sums[0] / (double)count, sums[1] / (double)count, sums[2] / (double)count);
}

int main(int argc, char **argv)
{
    RetexError err = {0};
    RetexSet *set = NULL;
    RetexImage picture = {0};
    if (argc < 3)
        return 2;
    if (retex_set_read(argv[1], &set, 0, NULL) && retex_image_read(&picture, argv[1], NULL, 1, &err)) {
        fprintf(stderr, "make_values: %s\n", err.message);
        return 2;
    }
    const RetexImage *image = set ? &set->parts[0].image : &picture;
    for (int k = 2; k < argc; k++) {
        int x, y;
        if (!strcmp(argv[k], "mean")) {
            print_mean(image);
            continue;
        }
        if (sscanf(argv[k], "%d,%d", &x, &y) != 2 || x < 0 || y < 0 || x >= image->width || y >= image->height)
            return 2;
        const float *p = image->pixels + retex_image_index(image, x, y);
        printf("%.9g %.9g %.9g\n", p[0], p[1], p[2]);
    }
    retex_set_close(&set);
    retex_image_free(&picture);
    return 0;
}
