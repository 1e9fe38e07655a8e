/* make_ranks EXPECTED A B: how well an expected error ranks the true error. Prints Spearman's rank correlation between
 * the root mean square of EXPECTED and that of A - B, over blocks of 8x8 pixels; then both over the whole picture. */
#include <math.h>
#include <retex/image.h>
#include <retex/image_file.h>
#include <stdio.h>
#include <stdlib.h>

#define BLOCK 8

typedef struct Block {
    double value;
    int index;
    double rank;
} Block;

static int compare_values(const void *a, const void *b)
{
    double x = ((const Block *)a)->value, y = ((const Block *)b)->value;
    return x < y ? -1 : x > y;
}

static int compare_indices(const void *a, const void *b)
{
    return ((const Block *)a)->index - ((const Block *)b)->index;
}

/* Ranks from 0; equal values share their mean rank. */
static void rank(Block *blocks, int count)
{
    qsort(blocks, (size_t)count, sizeof *blocks, compare_values);
    for (int k = 0, end; k < count; k = end) {
        for (end = k + 1; end < count && blocks[end].value == blocks[k].value; end++)
            ;
        for (int i = k; i < end; i++)
            blocks[i].rank = 0.5 * (k + end - 1);
    }
    qsort(blocks, (size_t)count, sizeof *blocks, compare_indices);
}

/* Mean squares of a, or of a - b, by block; returns that of the whole. */
static double measure(const RetexImage *a, const RetexImage *b, Block *blocks)
{
    int across = a->width / BLOCK, down = a->height / BLOCK;
    double all = 0;
    for (int k = 0; k < across * down; k++) {
        double sum = 0;
        for (int i = 0; i < BLOCK * BLOCK * 3; i++) {
            int x = k % across * BLOCK + i / 3 % BLOCK, y = k / across * BLOCK + i / 3 / BLOCK;
            size_t at = retex_image_index(a, x, y) + (size_t)(i % 3);
            double d = a->pixels[at] - (b ? b->pixels[at] : 0);
            sum += d * d;
        }
        blocks[k] = (Block){.value = sum, .index = k};
        all += sum / (across * down * BLOCK * BLOCK * 3);
    }
    return all;
}

int main(int argc, char **argv)
{
    RetexImage images[3] = {{0}};
    const RetexReadParams params = {.size = sizeof params, .colorspace = "linear", .pixel_bytes = 16};
    RetexError err;
    if (argc != 4)
        return 2;
    for (int k = 0; k < 3; k++)
        if (retex_image_read(&images[k], argv[1 + k], &params, 1, &err)) {
            fprintf(stderr, "make_ranks: %s\n", err.message);
            return 2;
        }
    int count = images[0].width / BLOCK * (images[0].height / BLOCK);
    Block *expected = calloc((size_t)count + 1, sizeof *expected), *found = calloc((size_t)count + 1, sizeof *found);
    if (!expected || !found || images[1].width != images[0].width || images[2].width != images[0].width)
        return 2;
    double e = measure(&images[0], NULL, expected), t = measure(&images[1], &images[2], found);
    rank(expected, count);
    rank(found, count);
    double mean = 0.5 * (count - 1), xy = 0, xx = 0, yy = 0;
    for (int k = 0; k < count; k++) {
        double x = expected[k].rank - mean, y = found[k].rank - mean;
        xy += x * y, xx += x * x, yy += y * y;
    }
    printf("%.3f %.4g %.4g\n", xx > 0 && yy > 0 ? xy / sqrt(xx * yy) : 0, sqrt(e), sqrt(t));
    for (int k = 0; k < 3; k++)
        retex_image_free(&images[k]);
    free(expected);
    free(found);
    return 0;
}
