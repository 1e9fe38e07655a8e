/* generate-textures DIRECTORY [WORD]: write the textures of all scenes below DIRECTORY (the scenes' own folder, to
 * make the committed files anew); with WORD only those whose path holds it. */
#include <stdio.h>
#include <string.h>
#include <retex/image.h>
#include <retex/parallel.h>
#include "generate.h"

typedef struct Job {
    const char *path;
    Color (*at)(double u, double v);
    int width, height;
} Job;

static const Job jobs[] = {
    {"cornell-box/textures/encaustic-tiles.jpg", encaustic_tiles, 1024, 1024},
    {"glass-caustics/textures/marble-tiles.jpg", marble_tiles, 1024, 1024},
    {"kitchen/textures/octagon-tiles.jpg", octagon_tiles, 1024, 1024},
    {"kitchen/textures/zellige.jpg", zellige, 1024, 1024},
    {"living-room/textures/oak-planks.jpg", oak_planks, 1024, 1024},
    {"living-room/textures/linen.jpg", linen, 512, 512},
    {"living-room/textures/rug.jpg", rug, 900, 600},
    {"living-room/textures/painting.jpg", painting, 640, 480},
    {"textures/walnut-herringbone.jpg", walnut_herringbone, 1024, 1024},
    {"textures/terrazzo.jpg", terrazzo, 1024, 1024},
    {"textures/travertine.jpg", travertine, 1024, 1024},
    {"textures/damask.jpg", damask, 1024, 1024},
    {"textures/fans.jpg", fans, 1024, 1024},
    {"textures/brick.jpg", brick, 1024, 1024},
};

typedef struct Fill {
    RetexImage *image;
    Color (*at)(double u, double v);
} Fill;

/* One row, each pixel the average of SAMPLES by SAMPLES points. */
static void fill_row(void *context, int y, int thread)
{
    enum { SAMPLES = 4 };
    const Fill *fill = context;
    const RetexImage *image = fill->image;
    (void)thread;
    for (int x = 0; x < image->width; x++) {
        Color sum = {0, 0, 0};
        for (int k = 0; k < SAMPLES * SAMPLES; k++) {
            double px = x + (k % SAMPLES + 0.5) / SAMPLES, py = y + (k / SAMPLES + 0.5) / SAMPLES;
            Color c = fill->at(px / image->width, 1 - py / image->height);
            sum.r += c.r;
            sum.g += c.g;
            sum.b += c.b;
        }
        float *out = image->pixels + retex_image_index(image, x, y);
        out[0] = (float)clamp01(sum.r / (SAMPLES * SAMPLES));
        out[1] = (float)clamp01(sum.g / (SAMPLES * SAMPLES));
        out[2] = (float)clamp01(sum.b / (SAMPLES * SAMPLES));
    }
}

static int make(const Job *job, const char *path, RetexError *error)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    params.colorspace = "sRGB";
    params.quality = 90;
    RetexImage image = {0};
    int status = retex_image_alloc(&image, job->width, job->height, 3, error);
    if (!status) {
        Fill fill = {&image, job->at};
        retex_parallel(0, image.height, fill_row, &fill);
        status = retex_image_write(&image, path, &params, error);
    }
    retex_image_free(&image);
    return status;
}

int main(int argc, char **argv)
{
    if (argc != 2 && argc != 3) {
        fprintf(stderr, "usage: generate-textures DIRECTORY [WORD]\n");
        return 2;
    }
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        char path[1024];
        RetexError error = {0};
        if (argc == 3 && !strstr(jobs[i].path, argv[2]))
            continue;
        int length = snprintf(path, sizeof path, "%s/%s", argv[1], jobs[i].path);
        if (length < 0 || (size_t)length >= sizeof path) {
            fprintf(stderr, "generate-textures: error: the directory's name is too long\n");
            return 2;
        }
        if (make(&jobs[i], path, &error)) {
            fprintf(stderr, "generate-textures: error: %s: %s\n", path, error.message);
            return 2;
        }
    }
    return 0;
}
