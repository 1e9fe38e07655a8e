/* generate-textures [--set NAME] DIRECTORY [WORD]: write textures below DIRECTORY, which is there with its subfolders;
 * with WORD only those whose path holds it. The sets:
 *   scenes            of all scenes; DIRECTORY is the scenes' folder, to make the committed files anew (the default)
 *   fidelity-scenes   of the scenes in tests/fidelity/scenes, which have them in textures/
 *   fidelity          what those are retextured with: checker, wood, grout, text, saturated, constant, dark, photo */
#include <stdio.h>
#include <string.h>
#include <retex/image.h>
#include <retex/image_file.h>
#include <retex/parallel.h>
#include "generate.h"

typedef struct Job {
    const char *path;
    Color (*at)(double u, double v);
    int width, height;
    int (*whole)(RetexImage *image); /* fills the image where there is no at; not 0: out of memory */
} Job;

static const Job scene_jobs[] = {
    {"cornell-box/textures/encaustic-tiles.jpg", encaustic_tiles, 1024, 1024, NULL},
    {"glass-caustics/textures/marble-tiles.jpg", marble_tiles, 1024, 1024, NULL},
    {"kitchen/textures/octagon-tiles.jpg", octagon_tiles, 1024, 1024, NULL},
    {"kitchen/textures/zellige.jpg", zellige, 1024, 1024, NULL},
    {"living-room/textures/oak-planks.jpg", oak_planks, 1024, 1024, NULL},
    {"living-room/textures/linen.jpg", linen, 512, 512, NULL},
    {"living-room/textures/rug.jpg", rug, 900, 600, NULL},
    {"living-room/textures/painting.jpg", painting, 640, 480, NULL},
    {"textures/walnut-herringbone.jpg", walnut_herringbone, 1024, 1024, NULL},
    {"textures/terrazzo.jpg", terrazzo, 1024, 1024, NULL},
    {"textures/travertine.jpg", travertine, 1024, 1024, NULL},
    {"textures/damask.jpg", damask, 1024, 1024, NULL},
    {"textures/fans.jpg", fans, 1024, 1024, NULL},
    {"textures/brick.jpg", brick, 1024, 1024, NULL},
};

static const Job fidelity_scene_jobs[] = {
    {"globe.jpg", globe, 1024, 512, NULL},
    {"left.jpg", fans, 512, 512, NULL},
    {"right.jpg", terrazzo, 512, 512, NULL},
    {"ground.jpg", cobbles, 1024, 1024, NULL},
};

static const Job fidelity_jobs[] = {
    {"checker.png", checker, 1024, 1024, NULL},     {"wood.jpg", walnut_herringbone, 1024, 1024, NULL},
    {"grout.png", grout, 1024, 1024, NULL},         {"text.png", text, 1024, 1024, NULL},
    {"saturated.png", saturated, 1024, 1024, NULL}, {"constant.png", constant, 64, 64, NULL},
    {"dark.png", dark, 1024, 1024, NULL},           {"photo.jpg", NULL, 4096, 4096, photo},
};

typedef struct Set {
    const char *name;
    const Job *jobs;
    size_t count;
} Set;

#define SET(name, jobs)                                                                                                \
    {                                                                                                                  \
        name, jobs, sizeof jobs / sizeof *jobs                                                                         \
    }
static const Set sets[] = {
    SET("scenes", scene_jobs),
    SET("fidelity-scenes", fidelity_scene_jobs),
    SET("fidelity", fidelity_jobs),
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
        if (job->at)
            retex_parallel(0, image.height, fill_row, &fill);
        else
            status = job->whole(&image);
        if (status)
            snprintf(error->message, sizeof error->message, "out of memory");
        else
            status = retex_image_write(&image, path, &params, 0, error);
    }
    retex_image_free(&image);
    return status;
}

static int usage(void)
{
    fprintf(stderr, "usage: generate-textures [--set scenes|fidelity-scenes|fidelity] DIRECTORY [WORD]\n");
    return 2;
}

int main(int argc, char **argv)
{
    const Set *set = &sets[0];
    if (argc > 2 && !strcmp(argv[1], "--set")) {
        set = NULL;
        for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
            if (!strcmp(argv[2], sets[i].name))
                set = &sets[i];
        argc -= 2;
        argv += 2;
    }
    if (!set || (argc != 2 && argc != 3) || argv[1][0] == '-')
        return usage();
    for (size_t i = 0; i < set->count; i++) {
        const Job *job = &set->jobs[i];
        char path[1024];
        RetexError error = {0};
        if (argc == 3 && !strstr(job->path, argv[2]))
            continue;
        int length = snprintf(path, sizeof path, "%s/%s", argv[1], job->path);
        if (length < 0 || (size_t)length >= sizeof path) {
            fprintf(stderr, "generate-textures: error: the directory's name is too long\n");
            return 2;
        }
        if (make(job, path, &error)) {
            fprintf(stderr, "generate-textures: error: %s: %s\n", path, error.message);
            return 2;
        }
    }
    return 0;
}
