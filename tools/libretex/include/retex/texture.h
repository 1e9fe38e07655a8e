/* Textures, and their placement on a target.
 *
 * u runs right, v up, v = 0 at the image's bottom row; texel centres are at (i + 0.5) / width. Before the look-up the
 * surface's UV is transformed:
 *
 *     uv' = M uv + offset,  M = R(rotate) diag(scale)
 *
 * R turns counter-clockwise about 0; scale 2 shows two repeats. With `width` repeats have a size in scene units, and
 * the rotation is done in these units, so that a plank stays a plank:
 *
 *     M = diag(1 / width, 1 / height) R(rotate) diag(uv_scale * scale)
 *
 * Where the surface closes along u (or v), width means the nearest whole number of repeats around it, at least one, so
 * that there is no seam: uv_scale becomes that number of widths. That is so of rotations by quarter turns, and of
 * textures that repeat or are mirrored in that direction.
 *
 * `flip` is applied last, u' -> 1 - u' and v' -> 1 - v'. A footprint's mean is transformed so, its covariance C becomes
 * M C M^T: exactly, in every look-up below. Constants ignore the placement. */
#ifndef RETEX_TEXTURE_H
#define RETEX_TEXTURE_H

#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef enum RetexWrap { RETEX_WRAP_REPEAT, RETEX_WRAP_MIRROR, RETEX_WRAP_CLAMP, RETEX_WRAP_BLACK } RetexWrap;

/* How repeats are arranged. All but straight and mirror need wrap = repeat on both axes, and more memory, because
 * several repeats are laid into one image: two of brick and half-drop. A shift is a whole number of texels, half of the
 * image's rounded down, so that no repeat is softer than another. Herringbone and basket need a width. Their joints and
 * sides are whole numbers of texels, so that the ratio of the sides is the next one of small whole numbers; if the
 * image has more than 2^26 texels, it becomes coarser. */
typedef enum RetexRepeat {
    RETEX_REPEAT_STRAIGHT,
    RETEX_REPEAT_BRICK,     /* every second row of repeats, floor(v') odd, moved right by half a repeat */
    RETEX_REPEAT_HALF_DROP, /* every second column, floor(u') odd, moved down by half a repeat */
    RETEX_REPEAT_MIRROR,    /* book-matched: every second repeat mirrored, as by wrap = mirror */
    RETEX_REPEAT_HERRINGBONE, /* repeats that lie and that stand, of any ratio: at an end of each begins another's
                                 side. The ratio of the pitches is the nearest of whole numbers, the denominator at
                                 most 4 */
    RETEX_REPEAT_BASKET,    /* squares of repeats that lie, and that stand, by turns; the longer pitch is the nearest
                               multiple of the shorter */
    RETEX_REPEAT_HEXAGON,   /* the image's middle in hexagons with a corner above, width[0] wide */
    RETEX_REPEATS
} RetexRepeat;

/* Whether a map beside the image is a normal map, and where its green points. */
typedef enum RetexNormalMap {
    RETEX_NORMAL_NONE,    /* it is none */
    RETEX_NORMAL_BY_NAME, /* down where the file's name says so, as in wall_nor_dx.png or Wall_NormalDX.png; else up */
    RETEX_NORMAL_GL,      /* up, as OpenGL has it */
    RETEX_NORMAL_DX       /* down, as DirectX has it */
} RetexNormalMap;

enum { RETEX_TILES_MAX = 8 };

/* Which lengths are in metres, not in scene units, bits. All that a texture or a layer has are, or none is. */
enum { RETEX_METRIC_WIDTH = 1, RETEX_METRIC_GROUT = 2, RETEX_METRIC_AT = 4 };

/* What differs at random from repeat to repeat, bits. Of a square repeat TURN is by quarter turns, otherwise by half a
 * turn. FLIP mirrors along u, v or both; SHIFT moves the image within its repeat. So many different repeats are laid
 * into one image as have at most 2^26 texels together, at most 256; then they repeat. */
enum { RETEX_VARY_TURN = 1, RETEX_VARY_FLIP = 2, RETEX_VARY_SHIFT = 4 };

/* What is done to the colours of a texture before it is filtered, one adjustment after the other. The result is
 * limited to 0..1, of light (is_light) to 0 and more. Colours are scene-linear; alpha is blurred, and else stays. */
typedef enum RetexAdjust {
    RETEX_ADJUST_HUE,        /* turned by value[0] degrees in Oklab */
    RETEX_ADJUST_SATURATION, /* Y + value[0] (c - Y), of the luminance Y, see retex/color.h; 0 = grey */
    RETEX_ADJUST_GAIN,       /* value[c] c */
    RETEX_ADJUST_GAMMA,      /* c^(1 / value[0]) */
    RETEX_ADJUST_CONTRAST,   /* 0.18 (c / 0.18)^value[0] */
    RETEX_ADJUST_BLUR,       /* a Gaussian whose standard deviation is value[0], 0..0.25, of the image's width; beyond
                                the image is what `wrap` says */
    RETEX_ADJUST_INVERT,     /* 1 - c of the values that sRGB encodes; value[0] is 1 */
    RETEX_ADJUST_TINT,       /* value[c] c */
    RETEX_ADJUST_COLORIZE,   /* value[c] Y / the mean of Y: the pattern of the luminance in one colour, the mean */
    RETEX_ADJUSTS
} RetexAdjust;
typedef struct RetexAdjustment {
    RetexAdjust kind;
    float value[3]; /* 0 or more, but for HUE; more than 0 for GAMMA and CONTRAST */
} RetexAdjustment;

/* A picture that lies once on a texture, or on the original: a logo, a rug, a stain. What is transparent, and what is
 * beyond the picture, shows what lies below. Its members mean what those of RetexTextureSpec mean. */
typedef struct RetexTextureLayer {
    char image[256];
    char colorspace[64];
    double scale[2], rotate, offset[2], width[2];
    int flip[2];
    int has_at;
    double at[2];
    int nadjustments;
    RetexAdjustment adjustments[RETEX_ADJUSTS];
    int metric;
} RetexTextureLayer;
enum { RETEX_LAYERS_MAX = 4 };

/* A texture and how it lies on its target; retex/edit.h makes it of text. Begin with RETEX_TEXTURE_SPEC_INIT. */
typedef struct RetexTextureSpec {
    size_t size;
    char target[128];
    char image[1024];      /* name of a file, or of a folder that holds its base colour; "" when constant */
    int constant;          /* 1: a colour */
    float color[3];        /* scene-linear, any finite value >= 0; of a constant */
    double scale[2];       /* default 1, 1; not 0 */
    double rotate;         /* degrees, default 0 */
    double offset[2];      /* default 0, 0; in repeats of the texture */
    RetexWrap wrap[2];     /* u, v; default repeat */
    char colorspace[64];   /* "" = by the file's type */
    int flip[2];           /* 1: mirrored left-right (u), up-down (v), after all else; default 0, 0 */
    RetexRepeat repeat;    /* default straight */
    double width[2];       /* of one repeat along u and along v, in scene units, > 0. 0, 0 (the default) = a repeat is
                              one unit of UV; second 0 = by the image's aspect, width[0] * its height / its width */
    double uv_scale[2];    /* scene units that one unit of surface u and of v measures, > 0: filled in by the caller
                              from the set or the scene, after parsing. Default 0, 0 = unknown; needed with width */
    double uv_min[2], uv_max[2]; /* the part of the surface that exists, along u and v: Gaussian footprints are cut off
                              there, as far as the texture is not turned against it. Filled in by the caller; the
                              default, min = max, is no limit */
    const RetexAccess *access; /* which files may be read; filled in by the caller, borrowed while the texture is
                              loaded. Default NULL = any */
    RetexWarn *warn;       /* told, in the calling thread, what is odd about the colours, see retex_texture_load; filled
                              in by the caller. Default NULL = nobody */
    void *warn_context;    /* handed to it; default NULL */
    int is_light;          /* 1: it stands for light, which may be brighter than white; default 0: for albedo */
    RetexBudget *budget;   /* what the texture's memory is charged to until it is closed, and which says how many pixels
                              its image may have (otherwise 2^28); filled in by the caller. Default NULL = none */
    int periodic[2];       /* 1: the surface closes after one unit of u (or v); filled in by the caller. Default 0, 0 */
    char finish[1024];     /* a picture that says which finish of the target is where, laid as the image is, see
                              retex-edit(5). "", the default: the roughness of a folder, where `image` is one that has
                              it; "none": the target has one finish all over. Or a normal map, see `normal` */
    int nfinishes;         /* of the target; filled in by the caller. Default 0: it has none to choose from */
    float roughness[4];    /* of these; filled in by the caller. Default 0 */
    int nadjustments;      /* 0..RETEX_ADJUSTS, default 0; each kind at most once */
    RetexAdjustment adjustments[RETEX_ADJUSTS];
    double grout;          /* width in scene units of a joint at the right and upper end of each repeat, whose size
                              stays `width`, which is needed. At most as wide as the repeat; of a colour too. Default
                              0 */
    float grout_color[3];  /* scene-linear; default sRGB's #808080 */
    int vary;              /* of RETEX_VARY_…; default 0 */
    unsigned vary_seed;    /* which repeats are picked and how they vary; default 0 */
    char tiles[RETEX_TILES_MAX][256]; /* names of more images: each repeat has one at random, `image` among them, all of
                              one size on the target. Behind the first "" there are no more; default "" */
    int has_at;            /* 1: the middle of the image is `at`, and `offset` is added to that; default 0 */
    double at[2];          /* in scene units along u and v from UV 0, 0, with a width; else in UV */
    RetexNormalMap normal; /* not NONE: `finish` is a normal map, and "none" uses none, nor that of a folder. Default
                              NONE */
    double normal_tilt;    /* degrees, that of the target, which takes normal maps where it is above 0; filled in by the
                              caller. Default 0 */
    int nlayers;           /* 0..RETEX_LAYERS_MAX, default 0. With layers `image` may be "", and `constant` 0: then they
                              lie on the original. There is no map of finishes or normals then */
    RetexTextureLayer layers[RETEX_LAYERS_MAX]; /* the lowest first */
    int metric;            /* of RETEX_METRIC_…: these are in metres. Default 0 */
    double unit;           /* metres of a scene unit, > 0; filled in by the caller. Default 1 */
} RetexTextureSpec;
#define RETEX_TEXTURE_SPEC_INIT \
    { sizeof(RetexTextureSpec), "", "", 0, {0, 0, 0}, {1, 1}, 0, {0, 0}, {RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT}, \
      "", {0, 0}, RETEX_REPEAT_STRAIGHT, {0, 0}, {0, 0}, {0, 0}, {0, 0}, NULL, NULL, NULL, 0, NULL, {0, 0}, \
      "", 0, {0, 0, 0, 0}, 0, {{RETEX_ADJUST_HUE, {0, 0, 0}}}, 0, \
      {0.21586050f, 0.21586050f, 0.21586050f}, 0, 0, {""}, 0, {0, 0}, RETEX_NORMAL_NONE, 0, \
      0, {{"", "", {1, 1}, 0, {0, 0}, {0, 0}, {0, 0}, 0, {0, 0}, 0, {{RETEX_ADJUST_HUE, {0, 0, 0}}}, 0}}, 0, 1 }

/* 1 where uv_scale has to be filled in before the texture is loaded: an image with a width. */
int retex_texture_spec_needs_scale(const RetexTextureSpec *spec);

typedef struct RetexTexture RetexTexture;

/* In memory a texture has 16-bit integers a channel, scene-linear and premultiplied, where its file has 8- or 16-bit
 * integers that are sRGB or linear; else floats. With its pyramid that is 11 bytes a texel, or 21. */

/* Load and build the MIP pyramid. RETEX_EIO or RETEX_EFORMAT with the file's name where it cannot; RETEX_EINVAL for a
 * width without uv_scale.
 *
 * Texels that are not finite become black, and transparent where it is alpha; colours beyond 65504, the largest half,
 * become that, so that no result overflows; negative ones stay, for colours of wide gamuts have them. spec->warn is
 * told how many there are and where the first is, and of an albedo that is brighter than white: of an image by its
 * luminance or a channel above 3, of a constant by any channel; and which other maps a folder has, which are not
 * used. */
int retex_texture_load(RetexTexture **texture, const RetexTextureSpec *spec, int nthreads, RetexError *err);
/* The files of a texture, by number: the image, the map that `finish` names or a folder's roughness, a folder's normal
 * map, its tiles from RETEX_TEXTURE_FILE_TILES on, and its layers from RETEX_TEXTURE_FILE_LAYERS on. */
enum {
    RETEX_TEXTURE_FILE_IMAGE,
    RETEX_TEXTURE_FILE_FINISH,
    RETEX_TEXTURE_FILE_NORMAL,
    RETEX_TEXTURE_FILE_TILES,
    RETEX_TEXTURE_FILE_LAYERS = RETEX_TEXTURE_FILE_TILES + RETEX_TILES_MAX,
    RETEX_TEXTURE_FILES = RETEX_TEXTURE_FILE_LAYERS + RETEX_LAYERS_MAX
};
/* The file of that number that retex_texture_load would read now: the image itself, or where it is a folder, the
 * file of its base colour, by the rules of retex-edit(5); the map that spec names, or the folder's roughness, which
 * is read where the target has finishes, and its normal map, which is where it takes one. For checksums and times of
 * files, and for all that must know what is read. To be freed; NULL where there is none, as the image of a constant.
 * RETEX_EFORMAT for a folder that has no base colour, or several. */
int retex_texture_file(char **file, const RetexTextureSpec *spec, int number, RetexError *err);
/* A texture from pixels in memory (1, 3 or 4 channels, scene-linear, unassociated alpha; row 0 is the top). Copies. */
int retex_texture_create(RetexTexture **texture, const RetexImage *image,
                         const RetexTextureSpec *spec /* NULL = plain */, int nthreads, RetexError *err);
void retex_texture_close(RetexTexture **texture);
/* Layer number `index`, which must be one, as a texture of its own, on the same target, in a struct whose size is set;
 * and back: RETEX_EINVAL where a layer cannot be
 * so. */
void retex_texture_layer_get(RetexTextureSpec *layer, const RetexTextureSpec *spec, int index);
int retex_texture_layer_set(RetexTextureSpec *spec, int index, const RetexTextureSpec *layer, RetexError *err);
/* Add the layers of `more` to those of a texture on the same target. One of both may have an image, which lies below.
 * RETEX_EINVAL: both have; or there are too many layers. */
int retex_texture_spec_join(RetexTextureSpec *spec, const RetexTextureSpec *more, RetexError *err);
/* Take its placement away, and what the caller fills in but finishes: what is left decides on the texels. */
void retex_texture_spec_unplace(RetexTextureSpec *spec);
/* 1: both images have the same texels, whatever their placement, so that memory can be shared, as long as the files and
 * the finishes of their targets are the same. */
int retex_texture_specs_alike(const RetexTextureSpec *a, const RetexTextureSpec *b);
/* Texels of one repeat; 1, 1 for a constant. */
void retex_texture_size(const RetexTexture *texture, int *width, int *height);

/* Bytes of its texels, all levels; 0 for a constant, and where they are another texture's. */
uint64_t retex_texture_bytes(const RetexTexture *texture);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
