/* bump_map: heights from a picture's numbers as they are in its file, from the indices of its palette, or from a
 * function. Pictures are found while reading and loaded at the end, only if a surface uses them. */
#include <retex/image_file.h>
#include "base/digest.h"
#include "sdl/texture/texture.h"

enum { SIDE_MAX = 65536 };

static int bump_map_option(Sdl *sdl, ParsedBumpMap *map, double *size)
{
    ImageMap *image = &map->map.image;
    if (sdl_accept(sdl, "once"))
        image->once = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "interpolate"))
        image->interpolate = (int)sdl_float(sdl);
    else if (sdl_accept(sdl, "map_type"))
        image->map_type = (MapType)(int)sdl_float(sdl);
    else if (sdl_accept(sdl, "bump_size"))
        *size = sdl_float(sdl);
    else if (sdl_accept(sdl, "use_index"))
        map->use_index = 1;
    else if (sdl_accept(sdl, "use_color") || sdl_accept(sdl, "use_colour"))
        map->use_index = 0;
    else if (sdl_accept(sdl, "premultiplied"))
        sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "gamma")) { /* heights are the file's numbers */
        if (!sdl_accept(sdl, "srgb") && !sdl_accept(sdl, "bt709") && !sdl_accept(sdl, "bt2020"))
            sdl_float(sdl);
    } else
        return 0;
    return 1;
}

static double grey(const float *p, int channels)
{
    return channels >= 3 ? 0.297 * p[0] + 0.589 * p[1] + 0.114 * p[2] : p[0];
}

static float *heights_new(Sdl *sdl, BumpMap *map, double width, double height)
{
    if (!(width >= 1 && width <= SIDE_MAX && height >= 1 && height <= SIDE_MAX))
        sdl_error(sdl, "a bump_map of %g by %g points: there are 1 to %d", width, height, SIDE_MAX);
    map->image.width = (int)width, map->image.height = (int)height;
    float *heights = sdl_alloc(sdl, (size_t)map->image.width * (size_t)map->image.height * sizeof *heights);
    map->heights = heights;
    return heights;
}

/* ---- functions ---- */

static void parse_function(Sdl *sdl, BumpMap *map)
{
    DrawnImage image;
    Gaps gaps = {0};
    parse_drawn_image(sdl, &image, "a bump_map", 1, &gaps);
    gaps_report(sdl, &gaps);
    float *heights = heights_new(sdl, map, image.width, image.height);
    for (int j = 0; j < image.height; j++) {
        sdl_step(sdl, 1 + image.width);
        for (int i = 0; i < image.width; i++)
            heights[(size_t)j * (size_t)image.width + (size_t)i] =
                (float)fmin(1, fmax(0, drawn_image_grey(&image, i, j)));
    }
}

/* ---- pictures ---- */

const BumpMap *parse_bump_map(Sdl *sdl, double *size)
{
    ParsedBumpMap *map = sdl_alloc(sdl, sizeof *map);
    sdl_expect(sdl, "{");
    if (sdl_is(sdl, "<")) {
        sdl_vector(sdl); /* the projection of very old scenes */
        sdl_optional_comma(sdl);
    }
    if (sdl_accept(sdl, "function"))
        parse_function(sdl, &map->map);
    else
        map->map.image.path = parse_image_path(sdl);
    while (!sdl_accept(sdl, "}"))
        if (!bump_map_option(sdl, map, size))
            sdl_expected(sdl, "an option of bump_map or }");
        else
            sdl_optional_comma(sdl);
    return &map->map;
}

static int load_indices(Sdl *sdl, BumpMap *map)
{
    PaletteIndices palette;
    if (!read_palette_indices(sdl, map->image.path, SIDE_MAX, &palette))
        return 0;
    float *heights = heights_new(sdl, map, palette.width, palette.height);
    for (size_t i = 0; i < (size_t)palette.width * (size_t)palette.height; i++)
        heights[i] = palette.indices[i];
    return 1;
}

static void load_colors(Sdl *sdl, BumpMap *map)
{
    const SdlOptions *options = sdl_options(sdl);
    const RetexReadParams params = {.size = sizeof params,
                                    .colorspace = "linear",
                                    .max_pixels = (long)SIDE_MAX * SIDE_MAX,
                                    .access = sdl_access(sdl),
                                    .budget = options->budget,
                                    .pixel_bytes = 16 + 4,
                                    .warn = warn_of_picture,
                                    .warn_context = sdl};
    RetexImage pixels = {0};
    RetexError err = {0};
    sdl_add_file(sdl, map->image.path);
    if (retex_image_read(&pixels, map->image.path, &params, options->nthreads, &err))
        sdl_error(sdl, "bump_map: %s%s%s", err.file, err.file[0] ? ": " : "", err.message);
    const size_t count = (size_t)pixels.width * (size_t)pixels.height;
    float *heights = count ? arena_alloc(sdl_arena(sdl), count * sizeof *heights) : NULL;
    for (size_t i = 0; heights && i < count; i++)
        heights[i] = (float)grey(pixels.pixels + i * (size_t)pixels.channels, pixels.channels);
    map->heights = heights;
    map->image.width = pixels.width, map->image.height = pixels.height;
    retex_image_free(&pixels);
    if (!heights)
        heights_new(sdl, map, map->image.width, map->image.height); /* tells why not */
}

void load_bump_map(Sdl *sdl, const BumpMap *loaded)
{
    ParsedBumpMap *map = (ParsedBumpMap *)parsed_bump_map(loaded); /* it is this scene's own */
    Scene *scene = sdl_scene(sdl);
    if (map->map.heights)
        return;
    if (!map->use_index || !load_indices(sdl, &map->map))
        load_colors(sdl, &map->map);
    scene->digest =
        digest_bytes(scene->digest, map->map.heights,
                     (size_t)map->map.image.width * (size_t)map->map.image.height * sizeof *map->map.heights);
}
