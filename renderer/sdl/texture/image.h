/* Images of image_map and the like: read, drawn by the scene, loaded; indices of palettes. */
#ifndef RENDERER_SDL_TEXTURE_IMAGE_H
#define RENDERER_SDL_TEXTURE_IMAGE_H

#include "sdl/state/builder.h"

enum { PALETTE_ENTRIES = 256 };
typedef struct ParsedImage {
    ImageMap map;        /* texture, size and alpha are filled in when the scene is complete */
    char colorspace[64]; /* of the file; "" = by its type */
    double gamma;        /* the file's numbers have this power of light; where it is not 1, colorspace is linear */
    float (*palette)[2]; /* filter and transmit of each entry; NAN: as of all; or NULL */
    const float *drawn;  /* R, G, B and A of each texel, as written, where the scene draws it; then there is no path */
    int use_alpha;       /* of an image_pattern: its value is the transparency */
    int working;         /* 1: the numbers of an integer file are colours of the working space, taken as they are */
    const char *file;    /* where it is written, for messages */
    int line;
    struct ParsedImage *next;
} ParsedImage;

static inline const ParsedImage *parsed_image(const ImageMap *map)
{
    return PARSED(ParsedImage, map, map);
}

struct ParsedPigment;

/* The name of an image and before it `png` and the like, which are not looked at: its file, also by a name without its
 * ending; or an error. */
const char *parse_image_path(Sdl *sdl);
void parse_image_map(Sdl *sdl, struct ParsedPigment *pigment); /* after image_map */
/* An image and its options, up to what is none. */
ParsedImage *parse_image(Sdl *sdl, struct ParsedPigment *pigment);
/* drawn_image.c: `function WIDTH, HEIGHT { … }` in place of an image's file. */
typedef struct DrawnImage {
    int width, height;
    const FunctionProgram *program; /* or NULL: then the pigment */
    const Pigment *pigment;
} DrawnImage;
/* After `function`. of: what is to have it, for messages; least: texels along a side. */
void parse_drawn_image(Sdl *sdl, DrawnImage *image, const char *of, int least, Gaps *gaps);
/* Row 0 is the top. Both evaluate the function: each texel is to be asked for once. */
double drawn_image_grey(const DrawnImage *image, int column, int row);
void drawn_image_texel(const DrawnImage *image, int column, int row, float rgba[4]); /* as written, from 0 to 1 */
/* image_file.c: the images of a pigment and of its map's pigments; is_light: their colours may be brighter than 1. */
void load_pigment_images(Sdl *sdl, const Pigment *pigment, int is_light);

/* palette.c, gif.c: 1 and the indices, row by row from the top, if the file is a GIF picture, or a PNG picture that has
 * a palette; else 0. */
typedef struct PaletteIndices {
    int width, height;
    const unsigned char *indices; /* in the arena */
} PaletteIndices;
/* A RetexWarn of pictures that are read for something else than their colours; the context is the Sdl. */
void warn_of_picture(void *context, const char *text);
int read_palette_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out);
void read_gif_indices(Sdl *sdl, const char *path, int side_max, PaletteIndices *out);

#endif
