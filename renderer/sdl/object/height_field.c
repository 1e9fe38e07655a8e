/* height_field: heights from a picture, as its numbers are, or from a function. */
#include <string.h>
#include <retex/image_file.h>
#include "base/digest.h"
#include "sdl/object/shape.h"
#include "shade/pigment.h"
#include "shape/height_field.h"
#include "shape/shape.h"

#define LARGEST 65536 /* points along a side */

/* Of a value from 0 to 1. */
static uint16_t units(double value)
{
    return (uint16_t)(value >= 1 ? HEIGHT_UNITS - 1 : value > 0 ? value * (HEIGHT_UNITS - 1) : 0);
}

static void set_size(Sdl *sdl, HeightField *field, double width, double height)
{
    if (!(width >= 2 && width <= LARGEST && height >= 2 && height <= LARGEST))
        sdl_error(sdl, "a height_field of %g by %g points: there are 2 to %d", width, height, LARGEST);
    field->width = (int)width;
    field->height = (int)height;
    field->heights = sdl_alloc(sdl, (size_t)field->width * (size_t)field->height * sizeof *field->heights);
}

/* ---- pictures ---- */

/* Grey values; of colours red is the coarse and green the fine part of a number of 16 bits. */
static uint16_t height_of_pixel(const float *p)
{
    if (p[0] == p[1] && p[1] == p[2])
        return (uint16_t)fmin(fmax(p[0] * 65535.0 + 0.5, 0), 65535);
    return (uint16_t)(256 * (int)fmin(fmax(p[0] * 255.0 + 0.5, 0), 255) + (int)fmin(fmax(p[1] * 255.0 + 0.5, 0), 255));
}

/* Points of a picture from the top, whose lowest row is at z = 0. */
static size_t point_at(const HeightField *field, int i, int j)
{
    return (size_t)(field->height - 1 - j) * (size_t)field->width + (size_t)i;
}

/* An index of a palette is the height, as the coarse part of a number of 16 bits. */
static void take_indices(Sdl *sdl, HeightField *field, const PaletteIndices *palette)
{
    set_size(sdl, field, palette->width, palette->height);
    for (int j = 0; j < field->height; j++)
        for (int i = 0; i < field->width; i++)
            field->heights[point_at(field, i, j)] =
                (uint16_t)(256 * palette->indices[(size_t)j * (size_t)field->width + (size_t)i]);
}

/* `pot`: the left half of the picture has the coarse parts of heights, the right half their fine parts. */
static void take_halves(Sdl *sdl, HeightField *field, const PaletteIndices *palette)
{
    set_size(sdl, field, palette->width / 2, palette->height);
    for (int j = 0; j < field->height; j++)
        for (int i = 0; i < field->width; i++) {
            const unsigned char *coarse = palette->indices + (size_t)j * (size_t)palette->width + i;
            field->heights[point_at(field, i, j)] = (uint16_t)(256 * coarse[0] + coarse[field->width]);
        }
}

static void take_colors(Sdl *sdl, HeightField *field, const char *path)
{
    const SdlOptions *options = sdl_options(sdl);
    const RetexReadParams params = {.size = sizeof params,
                                    .colorspace = "linear",
                                    .max_pixels = (long)LARGEST * LARGEST,
                                    .access = sdl_access(sdl),
                                    .budget = options->budget,
                                    .pixel_bytes = 16 + 2 + 6,
                                    .warn = warn_of_picture,
                                    .warn_context = sdl};
    RetexImage pixels = {0};
    RetexError err = {0};
    sdl_add_file(sdl, path);
    if (retex_image_read(&pixels, path, &params, options->nthreads, &err))
        sdl_error(sdl, "height_field: %s%s%s", err.file, err.file[0] ? ": " : "", err.message);
    field->width = pixels.width;
    field->height = pixels.height;
    if (pixels.width >= 2 && pixels.height >= 2 && pixels.width <= LARGEST && pixels.height <= LARGEST)
        field->heights =
            arena_alloc(sdl_arena(sdl), (size_t)field->width * (size_t)field->height * sizeof *field->heights);
    for (int j = 0; field->heights && j < field->height; j++)
        for (int i = 0; i < field->width; i++)
            field->heights[point_at(field, i, j)] = height_of_pixel(pixels.pixels + retex_image_index(&pixels, i, j));
    retex_image_free(&pixels);
    if (!field->heights)
        set_size(sdl, field, field->width, field->height); /* tells why not */
}

static void read_picture(Sdl *sdl, HeightField *field)
{
    const int halves = sdl_is(sdl, "pot");
    const char *path = parse_image_path(sdl);
    PaletteIndices palette;
    if (halves && read_palette_indices(sdl, path, LARGEST, &palette))
        take_halves(sdl, field, &palette);
    else if (read_palette_indices(sdl, path, LARGEST, &palette))
        take_indices(sdl, field, &palette);
    else
        take_colors(sdl, field, path);
    Scene *scene = sdl_scene(sdl);
    scene->digest = digest_bytes(scene->digest, field->heights,
                                 (size_t)field->width * (size_t)field->height * sizeof *field->heights);
}

/* ---- functions ---- */

static void read_function(Sdl *sdl, HeightField *field)
{
    DrawnImage image;
    Gaps gaps = {0};
    parse_drawn_image(sdl, &image, "a height_field", 2, &gaps);
    gaps_report(sdl, &gaps);
    set_size(sdl, field, image.width, image.height);
    for (int j = 0; j < field->height; j++) {
        sdl_step(sdl, 1 + field->width);
        for (int i = 0; i < field->width; i++)
            field->heights[point_at(field, i, j)] = units(drawn_image_grey(&image, i, j));
    }
}

/* ---- the tree ---- */

static HeightRange joined(HeightRange a, HeightRange b)
{
    return (HeightRange){a.low < b.low ? a.low : b.low, a.high > b.high ? a.high : b.high};
}

static void first_level(const HeightField *field, HeightLevel *level)
{
    for (int j = 0; j < level->height; j++)
        for (int i = 0; i < level->width; i++) {
            const uint16_t *h = field->heights + (size_t)j * (size_t)field->width + (size_t)i;
            const HeightRange front = joined((HeightRange){h[0], h[0]}, (HeightRange){h[1], h[1]});
            h += field->width;
            level->ranges[(size_t)j * (size_t)level->width + (size_t)i] =
                joined(front, joined((HeightRange){h[0], h[0]}, (HeightRange){h[1], h[1]}));
        }
}

static void next_level(const HeightLevel *below, HeightLevel *level)
{
    for (int j = 0; j < below->height; j++)
        for (int i = 0; i < below->width; i++) {
            HeightRange *to = &level->ranges[(size_t)(j / 2) * (size_t)level->width + (size_t)(i / 2)];
            const HeightRange one = below->ranges[(size_t)j * (size_t)below->width + (size_t)i];
            *to = i % 2 || j % 2 ? joined(*to, one) : one;
        }
}

static void build_levels(Sdl *sdl, HeightField *field)
{
    int width = field->width - 1, height = field->height - 1;
    for (int n = 0;; n++) {
        HeightLevel *level = &field->levels[n];
        *level = (HeightLevel){width, height, sdl_alloc(sdl, (size_t)width * (size_t)height * sizeof(HeightRange))};
        if (n == 0)
            first_level(field, level);
        else
            next_level(level - 1, level);
        field->nlevels = n + 1;
        if (width == 1 && height == 1)
            return;
        width = (width + 1) / 2;
        height = (height + 1) / 2;
    }
}

static void skip_gamma(Sdl *sdl)
{
    if (!sdl_accept(sdl, "srgb") && !sdl_accept(sdl, "bt709") && !sdl_accept(sdl, "bt2020"))
        sdl_float(sdl);
}

void parse_height_field(Sdl *sdl, Object *object)
{
    HeightField *field = sdl_alloc(sdl, sizeof *field);
    field->water = -1; /* none: all is there */
    if (sdl_accept(sdl, "function"))
        read_function(sdl, field);
    else
        read_picture(sdl, field);
    for (;;) {
        if (sdl_accept(sdl, "water_level"))
            field->water = sdl_float(sdl) * HEIGHT_UNITS;
        else if (sdl_accept(sdl, "smooth"))
            field->smooth = sdl_optional_bool(sdl, 1);
        else if (sdl_accept(sdl, "premultiplied") || sdl_accept(sdl, "hierarchy"))
            sdl_optional_bool(sdl, 1);
        else if (sdl_accept(sdl, "gamma")) /* heights are numbers */
            skip_gamma(sdl);
        else
            break;
    }
    build_levels(sdl, field);
    object->shape.ops = &shape_height_field;
    object->shape.data = field;
}
