/* image_map: a picture as a pigment. Files are found while reading and loaded at the end, once each, when the scene's
 * gamma is known and only if something uses them. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "sdl/texture/texture.h"

/* Before the file's name. The name's ending is not looked at: OpenImageIO looks into the file. */
const char *parse_image_path(Sdl *sdl)
{
    static const char *const types[] = {"png", "jpeg", "jpg", "gif", "tga", "tiff", "tif", "bmp", "ppm",
                                        "pgm", "pbm",  "exr", "hdr", "iff", "sys",  "pot", NULL};
    char longer[1024];
    for (int i = 0; types[i]; i++)
        if (sdl_accept(sdl, types[i]))
            break;
    const char *name = sdl_string(sdl), *path = sdl_find_file(sdl, name);
    for (int i = 0; !path && types[i] && !strchr(name, '.') && strlen(name) < sizeof longer - 8; i++) {
        snprintf(longer, sizeof longer, "%s.%s", name, types[i]);
        path = sdl_find_file(sdl, longer);
    }
    return path ? path : sdl_need_file(sdl, "image", name);
}

/* `filter all F`, `transmit all T`, or of one palette entry. What is written later counts. */
static void transparency(Sdl *sdl, ParsedImage *image, float *all, int transmit)
{
    if (sdl_accept(sdl, "all")) {
        *all = (float)sdl_float(sdl);
        for (int i = 0; image->palette && i < PALETTE_ENTRIES; i++)
            image->palette[i][transmit] = NAN;
        return;
    }
    const double entry = sdl_float(sdl);
    sdl_optional_comma(sdl);
    const float value = (float)sdl_float(sdl);
    if (!(entry >= 0 && entry < PALETTE_ENTRIES))
        sdl_error(sdl, "a palette has entries from 0 to %d", PALETTE_ENTRIES - 1);
    if (!image->palette) {
        image->palette = sdl_alloc(sdl, PALETTE_ENTRIES * sizeof *image->palette);
        for (int i = 0; i < PALETTE_ENTRIES; i++)
            image->palette[i][0] = image->palette[i][1] = NAN;
    }
    image->palette[(int)entry][transmit] = value;
}

static void gamma_keyword(Sdl *sdl, ParsedImage *image)
{
    double gamma = 0;
    if (!sdl_accept(sdl, "srgb") && !sdl_accept(sdl, "bt709") && !sdl_accept(sdl, "bt2020")) {
        gamma = sdl_float(sdl);
        if (!(gamma > 0.1 && gamma < 10))
            sdl_error(sdl, "an image's gamma of %g is not sensible", gamma);
    }
    strcpy(image->colorspace, gamma ? "linear" : "sRGB");
    image->gamma = gamma ? gamma : 1;
    image->working = 0;
}

/* `repeat` or `offset`. Maps of identifiers share a place: a change makes a new one. */
static void place_keyword(Sdl *sdl, ImageMap *map, int is_offset)
{
    ImagePlacement *place = sdl_alloc(sdl, sizeof *place);
    *place = map->place ? *map->place : (ImagePlacement){{1, 1}, {0, 0}};
    *(is_offset ? &place->offset : &place->repeat) = sdl_vector2(sdl);
    map->place = place;
}

static int image_option(Sdl *sdl, ParsedPigment *pigment, ParsedImage *image)
{
    ImageMap *map = &image->map;
    if (sdl_accept(sdl, "once"))
        map->once = sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "interpolate"))
        map->interpolate = (int)sdl_float(sdl);
    else if (sdl_accept(sdl, "map_type")) {
        int type = (int)sdl_float(sdl);
        if (type != MAP_PLANAR && type != MAP_SPHERICAL && type != MAP_CYLINDRICAL && type != MAP_TORUS &&
            type != MAP_ANGULAR) {
            gaps_add(&pigment->gaps, GAP_MAP_TYPE);
            type = MAP_PLANAR;
        }
        map->map_type = (MapType)type;
    } else if (sdl_accept(sdl, "filter"))
        transparency(sdl, image, &map->filter_all, 0);
    else if (sdl_accept(sdl, "transmit"))
        transparency(sdl, image, &map->transmit_all, 1);
    else if (sdl_accept(sdl, "gamma"))
        gamma_keyword(sdl, image);
    else if (sdl_accept(sdl, "premultiplied"))
        sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "use_color") || sdl_accept(sdl, "use_colour") || sdl_accept(sdl, "use_index"))
        image->use_alpha = 0;
    else if (sdl_accept(sdl, "use_alpha"))
        image->use_alpha = 1;
    else if (sdl_accept(sdl, "repeat"))
        place_keyword(sdl, map, 0);
    else if (sdl_accept(sdl, "offset"))
        place_keyword(sdl, map, 1);
    else
        return 0;
    return 1;
}

/* `function WIDTH, HEIGHT { … }` */
static void draw_image(Sdl *sdl, ParsedPigment *pigment, ParsedImage *image)
{
    DrawnImage drawn;
    parse_drawn_image(sdl, &drawn, "an image", 1, &pigment->gaps);
    float *rgba = sdl_alloc(sdl, 4 * (size_t)drawn.width * (size_t)drawn.height * sizeof *rgba);
    image->drawn = rgba;
    image->map.width = drawn.width, image->map.height = drawn.height;
    for (int j = 0; j < drawn.height; j++) {
        sdl_step(sdl, 1 + drawn.width);
        for (int i = 0; i < drawn.width; i++, rgba += 4)
            drawn_image_texel(&drawn, i, j, rgba);
    }
}

ParsedImage *parse_image(Sdl *sdl, ParsedPigment *pigment)
{
    TextureState *textures = textures_of(sdl);
    ParsedImage *image = sdl_alloc(sdl, sizeof *image);
    image->working = 1;
    image->gamma = 1;
    image->file = sdl_peek(sdl)->file;
    image->line = sdl_peek(sdl)->line;
    if (sdl_accept(sdl, "function"))
        draw_image(sdl, pigment, image);
    else
        image->map.path = parse_image_path(sdl);
    while (image_option(sdl, pigment, image))
        sdl_optional_comma(sdl);
    image->next = textures->images;
    textures->images = image;
    pigment->pigment.kind = PIGMENT_IMAGE;
    pigment->pigment.image = &image->map;
    return image;
}

void parse_image_map(Sdl *sdl, ParsedPigment *pigment)
{
    sdl_expect(sdl, "{");
    if (sdl_is(sdl, "<")) {
        sdl_vector(sdl); /* the projection of very old scenes */
        sdl_optional_comma(sdl);
    }
    parse_image(sdl, pigment);
    if (!sdl_accept(sdl, "}"))
        sdl_expected(sdl, "an option of image_map or }");
}
