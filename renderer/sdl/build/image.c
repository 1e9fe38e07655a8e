/* image_map: a picture as a pigment. Files are found while reading and loaded at the end, once each, when the scene's
 * gamma is known and only if something uses them. */
#include <stdio.h>
#include <string.h>
#include "sdl/build/builder.h"

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

/* `filter all F`, `transmit all T`, or of one palette entry. */
static void transparency(Sdl *sdl, ParsedPigment *pigment, float *all)
{
    if (sdl_accept(sdl, "all")) {
        *all = (float)sdl_float(sdl);
        return;
    }
    sdl_float(sdl);
    sdl_optional_comma(sdl);
    sdl_float(sdl);
    gaps_add(&pigment->gaps, GAP_IMAGE_PALETTE);
}

static void gamma_keyword(Sdl *sdl, ParsedImage *image)
{
    double gamma = 2.2;
    if (!sdl_accept(sdl, "srgb") && !sdl_accept(sdl, "bt709") && !sdl_accept(sdl, "bt2020"))
        gamma = sdl_float(sdl);
    if (gamma > 0.99 && gamma < 1.01)
        strcpy(image->colorspace, "linear");
    else {
        strcpy(image->colorspace, "sRGB");
        if (gamma < 1.7 || gamma > 2.5)
            sdl_warn(sdl, "image gamma %g is taken as sRGB: only 1 and sRGB are known", gamma);
    }
    image->working = 0;
}

static void place_keyword(Sdl *sdl, ParsedPigment *pigment)
{
    sdl_expression(sdl);
    gaps_add(&pigment->gaps, GAP_IMAGE_PLACE);
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
        if (type != MAP_PLANAR && type != MAP_SPHERICAL && type != MAP_CYLINDRICAL && type != MAP_TORUS) {
            gaps_add(&pigment->gaps, GAP_MAP_TYPE);
            type = MAP_PLANAR;
        }
        map->map_type = (MapType)type;
    } else if (sdl_accept(sdl, "filter"))
        transparency(sdl, pigment, &map->filter_all);
    else if (sdl_accept(sdl, "transmit"))
        transparency(sdl, pigment, &map->transmit_all);
    else if (sdl_accept(sdl, "gamma"))
        gamma_keyword(sdl, image);
    else if (sdl_accept(sdl, "premultiplied"))
        sdl_optional_bool(sdl, 1);
    else if (sdl_accept(sdl, "use_color") || sdl_accept(sdl, "use_colour") || sdl_accept(sdl, "use_index") ||
             sdl_accept(sdl, "use_alpha"))
        ;
    else if (sdl_accept(sdl, "repeat") || sdl_accept(sdl, "offset"))
        place_keyword(sdl, pigment);
    else
        return 0;
    return 1;
}

/* image_map{ function W,H {…} }, or of a pattern: there is no file to load. */
static void computed_image(Sdl *sdl, ParsedPigment *pigment)
{
    gaps_add(&pigment->gaps, GAP_IMAGE_FUNCTION);
    pigment->pigment.kind = PIGMENT_COLOR;
    pigment->pigment.color = (Rgbft){0.5f, 0.5f, 0.5f, 0, 0};
    while (!sdl_accept(sdl, "}"))
        if (sdl_is(sdl, "{"))
            sdl_skip_block(sdl);
        else if (sdl_is(sdl, ","))
            sdl_optional_comma(sdl);
        else if (sdl_peek(sdl)->kind == TOKEN_END)
            sdl_expected(sdl, "} of the image_map");
        else
            sdl_next(sdl);
}

ParsedImage *parse_image(Sdl *sdl, ParsedPigment *pigment)
{
    Builder *builder = builder_of(sdl);
    ParsedImage *image = sdl_alloc(sdl, sizeof *image);
    image->working = 1;
    image->file = sdl_peek(sdl)->file;
    image->line = sdl_peek(sdl)->line;
    image->map.path = parse_image_path(sdl);
    while (image_option(sdl, pigment, image))
        sdl_optional_comma(sdl);
    image->next = builder->images;
    builder->images = image;
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
    if (sdl_is(sdl, "function") || sdl_is(sdl, "pigment")) {
        computed_image(sdl, pigment);
        return;
    }
    parse_image(sdl, pigment);
    if (!sdl_accept(sdl, "}"))
        sdl_expected(sdl, "an option of image_map or }");
}
