/* Writes a small repeatable picture, correct or with one defect, for the tests of retex-diff:
 * make_picture FILE [noise=SIZE] [mirror] [swap] [nan] [inf] [channels=LETTERS] [size=WxH] [seed=N] [grey]
 * An EXR gets exactly the channels asked for (default RGB), in half precision; other formats are written as usual. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "exr/io.h"
#include "lib_test.h"

typedef struct Wishes {
    int width, height, mirror, swap, nan, inf, grey;
    unsigned seed;
    double noise;
    const char *channels;
} Wishes;

static void parse(Wishes *w, int argc, char **argv)
{
    for (int i = 2; i < argc; i++) {
        const char *value = strchr(argv[i], '=');
        if (strncmp(argv[i], "noise=", 6) == 0)
            w->noise = atof(value + 1);
        else if (strncmp(argv[i], "channels=", 9) == 0)
            w->channels = value + 1;
        else if (strncmp(argv[i], "seed=", 5) == 0)
            w->seed = (unsigned)atoi(value + 1);
        else if (strncmp(argv[i], "size=", 5) == 0)
            sscanf(value + 1, "%dx%d", &w->width, &w->height);
        else if (strcmp(argv[i], "mirror") == 0)
            w->mirror = 1;
        else if (strcmp(argv[i], "swap") == 0)
            w->swap = 1;
        else if (strcmp(argv[i], "nan") == 0)
            w->nan = 1;
        else if (strcmp(argv[i], "inf") == 0)
            w->inf = 1;
        else if (strcmp(argv[i], "grey") == 0)
            w->grey = 1;
        else {
            fprintf(stderr, "make_picture: what is '%s'?\n", argv[i]);
            exit(2);
        }
    }
}

/* A gradient that differs in each channel and has no symmetry. */
static void paint(RetexImage *im, const Wishes *w)
{
    uint32_t state = w->seed;
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++) {
            double u = (x + 0.5) / im->width, v = (y + 0.5) / im->height;
            u = w->mirror ? 1 - u : u;
            double color[3] = {0.1 + 0.8 * u, 0.3 + 0.4 * v * v, 0.2 + 0.6 * u * v};
            for (int c = 0; c < im->channels; c++) {
                int from = w->grey ? 0 : w->swap && c < 3 ? 2 - c : c;
                double noise = w->noise * (2 * test_random(&state) - 1);
                im->pixels[retex_image_index(im, x, y) + (size_t)c] = (float)((from < 3 ? color[from] : u * v) + noise);
            }
        }
    if (w->nan)
        im->pixels[retex_image_index(im, im->width / 2, im->height / 2) + 1] = NAN;
    if (w->inf)
        im->pixels[retex_image_index(im, im->width / 3, im->height / 2)] = INFINITY;
}

static void write_exr(const RetexImage *im, const Wishes *w, const char *path)
{
    RetexExrPart part = {.name = "picture", .type = RETEX_HALF, .image = im};
    RetexExrEncoding *encoding = NULL;
    RetexError err = {0};
    snprintf(part.letters, sizeof part.letters, "%s", w->channels);
    test_must(retex_exr_encode(&encoding, &part, 1, 1, 1, &err), &err);
    test_must(retex_exr_write(encoding, im->width, im->height, NULL, NULL, path, &err), &err);
    retex_exr_encoding_free(&encoding);
}

int main(int argc, char **argv)
{
    Wishes w = {.width = 64, .height = 40, .seed = 1, .channels = "RGB"};
    RetexImage im = {0};
    RetexError err = {0};
    if (argc < 2) {
        fprintf(stderr, "usage: make_picture FILE [noise=SIZE] [mirror] [swap] [nan] [inf] [grey] [channels=LETTERS] "
                        "[size=WxH] [seed=N]\n");
        return 2;
    }
    parse(&w, argc, argv);
    test_must(retex_image_alloc(&im, w.width, w.height, (int)strlen(w.channels), &err), &err);
    paint(&im, &w);
    const char *ending = strrchr(argv[1], '.');
    if (ending && strcmp(ending, ".exr") == 0)
        write_exr(&im, &w, argv[1]);
    else
        test_must(retex_image_write(&im, argv[1], NULL, 1, &err), &err);
    retex_image_free(&im);
    return 0;
}
