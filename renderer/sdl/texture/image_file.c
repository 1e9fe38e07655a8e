/* Files of image_map, loaded when they are needed, once each. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <retex/image_file.h>
#include "base/digest.h"
#include "sdl/texture/texture.h"

/* How a file's numbers become light: NULL or the name of their colour space, and a power. */
typedef struct Numbers {
    const char *colorspace;
    double gamma;
} Numbers;

/* In scenes before 3.7 the numbers of 8- and 16-bit files are colours of the working space, as they are. */
static Numbers numbers_of(Sdl *sdl, const ParsedImage *image)
{
    const GlobalSettings *global = &builder_of(sdl)->global;
    const double version = global->has_assumed_gamma ? global->gamma_version : sdl_version(sdl);
    const WorkingSpace space = working_space(sdl);
    const char *dot = image->drawn ? NULL : strrchr(image->map.path, '.');
    int is_float = dot && (strcmp(dot, ".exr") == 0 || strcmp(dot, ".hdr") == 0 || strcmp(dot, ".EXR") == 0 ||
                           strcmp(dot, ".HDR") == 0);
    if (image->working && !is_float && version < 3.7 && space.kind != WORKING_SRGB)
        return (Numbers){"linear", space.kind == WORKING_POWER ? space.gamma : 1};
    return (Numbers){image->colorspace[0] ? image->colorspace : NULL, image->gamma};
}

static int has_alpha(const RetexImage *pixels)
{
    size_t n = (size_t)pixels->width * (size_t)pixels->height;
    if (pixels->channels < 4)
        return 0;
    for (size_t i = 0; i < n; i++)
        if (pixels->pixels[i * (size_t)pixels->channels + 3] < 1)
            return 1;
    return 0;
}

static void apply_gamma(RetexImage *pixels, double gamma)
{
    const size_t n = retex_image_index(pixels, 0, pixels->height);
    for (size_t i = 0; i < n; i++)
        if (pixels->channels < 4 || i % (size_t)pixels->channels != 3)
            pixels->pixels[i] = (float)copysign(pow(fabs((double)pixels->pixels[i]), gamma), pixels->pixels[i]);
}

/* Of the palette's entries, to each texel. */
static void set_transparency(Sdl *sdl, ParsedImage *image)
{
    ImageMap *map = &image->map;
    PaletteIndices indices;
    if (!image->palette)
        return;
    if (image->drawn || !read_palette_indices(sdl, map->path, RETEX_MAX_SIZE, &indices) ||
        indices.width != map->width || indices.height != map->height) {
        sdl_warn_at(sdl, image->file, image->line,
                    "image_map: `%s`: filter and transmit of a palette's entries need a GIF or PNG file with one; "
                    "they are left out",
                    image->drawn ? "a function" : map->path);
        return;
    }
    const size_t n = (size_t)map->width * (size_t)map->height;
    float(*texels)[2] = sdl_alloc(sdl, n * sizeof *texels);
    for (size_t i = 0; i < n; i++) {
        const float *entry = image->palette[indices.indices[i]];
        texels[i][0] = isnan(entry[0]) ? map->filter_all : entry[0];
        texels[i][1] = isnan(entry[1]) ? map->transmit_all : entry[1];
    }
    map->transparency = texels;
}

static int same_image(Sdl *sdl, const ParsedImage *a, const ParsedImage *b)
{
    const Numbers x = numbers_of(sdl, a), y = numbers_of(sdl, b);
    if (a->drawn || b->drawn)
        return a->drawn == b->drawn && a->working == b->working;
    return strcmp(a->map.path, b->map.path) == 0 && x.gamma == y.gamma &&
           strcmp(x.colorspace ? x.colorspace : "", y.colorspace ? y.colorspace : "") == 0;
}

static void add_image(Sdl *sdl, ParsedImage *image)
{
    Scene *scene = sdl_scene(sdl);
    TextureState *textures = textures_of(sdl);
    scene->images = sdl_grow(sdl, scene->images, scene->nimages, &textures->image_capacity, sizeof *scene->images);
    scene->images[scene->nimages++] = &image->map;
}

enum { IMAGE_PEAK_BYTES = 16 + 22 }; /* a pixel: as it is read, and the texture of it */

/* What is odd about the image's colours. */
typedef struct ImageWarning {
    Sdl *sdl;
    const ParsedImage *image;
} ImageWarning;

static void warn_of_image(void *context, const char *text)
{
    const ImageWarning *warning = context;
    const ParsedImage *image = warning->image;
    sdl_warn_at(warning->sdl, image->file, image->line, "image_map: %s", text); /* which begins with the path */
}

void warn_of_picture(void *context, const char *text)
{
    sdl_warn(context, "%s", text);
}

static int read_image(Sdl *sdl, const ParsedImage *image, ImageWarning *warning, RetexImage *pixels, RetexError *err)
{
    const SdlOptions *options = sdl_options(sdl);
    const Numbers numbers = numbers_of(sdl, image);
    const RetexReadParams params = {.size = sizeof params,
                                    .colorspace = numbers.colorspace,
                                    .access = sdl_access(sdl),
                                    .budget = options->budget,
                                    .pixel_bytes = IMAGE_PEAK_BYTES,
                                    .warn = warn_of_image,
                                    .warn_context = warning};
    sdl_add_file(sdl, image->map.path);
    sdl_step(sdl, 1);
    const int code = retex_image_read(pixels, image->map.path, &params, options->nthreads, err);
    if (code == 0 && numbers.gamma != 1)
        apply_gamma(pixels, numbers.gamma);
    return code;
}

/* What the scene draws has colours of the working space. */
static int take_drawn(Sdl *sdl, const ParsedImage *image, RetexImage *pixels, RetexError *err)
{
    const ImageMap *map = &image->map;
    const size_t n = (size_t)map->width * (size_t)map->height;
    const int code = retex_image_alloc(pixels, map->width, map->height, 4, err);
    for (size_t i = 0; code == 0 && i < n; i++) {
        const float *from = image->drawn + 4 * i;
        float *to = pixels->pixels + 4 * i;
        const Rgb written = rgb(from[0], from[1], from[2]);
        const Rgb c = image->working ? decode_color(sdl, written) : written;
        to[0] = c.r, to[1] = c.g, to[2] = c.b, to[3] = from[3];
    }
    return code;
}

static void load_image(Sdl *sdl, ParsedImage *image, int is_light)
{
    Scene *scene = sdl_scene(sdl);
    ImageMap *map = &image->map;
    if (map->texture)
        return;
    for (int i = 0; i < scene->nimages; i++)
        if (same_image(sdl, parsed_image(scene->images[i]), image)) {
            map->texture = scene->images[i]->texture;
            map->width = scene->images[i]->width;
            map->height = scene->images[i]->height;
            map->has_alpha = scene->images[i]->has_alpha;
            add_image(sdl, image);
            set_transparency(sdl, image);
            return;
        }
    add_image(sdl, image); /* before there is anything to free */
    RetexImage pixels = {0};
    RetexError err = {0};
    const SdlOptions *options = sdl_options(sdl);
    ImageWarning warning = {sdl, image};
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    spec.budget = options->budget;
    snprintf(spec.image, sizeof spec.image, "%s", image->drawn ? "a function" : map->path);
    if ((image->drawn ? take_drawn(sdl, image, &pixels, &err) : read_image(sdl, image, &warning, &pixels, &err)) == 0) {
        map->has_alpha = has_alpha(&pixels);
        map->width = pixels.width;
        map->height = pixels.height;
        scene->digest =
            digest_bytes(scene->digest, pixels.pixels, retex_image_index(&pixels, 0, pixels.height) * sizeof(float));
        spec.warn = warn_of_image;
        spec.warn_context = &warning;
        spec.is_light = is_light;
        retex_texture_create(&map->texture, &pixels, &spec, options->nthreads, &err);
        retex_image_free(&pixels);
    }
    if (!map->texture)
        sdl_error(sdl, "%s:%d: image_map: %s%s%s", image->file, image->line, err.file, err.file[0] ? ": " : "",
                  err.message);
    set_transparency(sdl, image);
}

/* Also those of its map's pigments. */
void load_pigment_images(Sdl *sdl, const Pigment *pigment, int is_light)
{
    if (pigment->kind == PIGMENT_IMAGE)
        load_image(sdl, (ParsedImage *)parsed_image(pigment->image), is_light);
    for (int i = 0; i < pigment->map.count; i++)
        if (pigment->map.entries[i].pigment)
            load_pigment_images(sdl, pigment->map.entries[i].pigment, is_light);
}
