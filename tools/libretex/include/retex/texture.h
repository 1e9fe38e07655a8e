/* Textures and how they lie on a target.
 *
 * u runs right, v up, v = 0 at the image's bottom row; texel centres lie at (i + 0.5) / width. The surface's UV is
 * taken through uv' = R(rotate, counter-clockwise about 0) (scale * uv) + offset before the look-up, so scale 2
 * shows two repeats. */
#ifndef RETEX_TEXTURE_H
#define RETEX_TEXTURE_H

#include <retex/image.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef enum RetexWrap { RETEX_WRAP_REPEAT, RETEX_WRAP_MIRROR, RETEX_WRAP_CLAMP, RETEX_WRAP_BLACK } RetexWrap;

/* What the user said: --texture:scale=2,2:rotate=30:wrap=mirror NAME=IMAGE. Begin with RETEX_TEXTURE_SPEC_INIT. */
typedef struct RetexTextureSpec {
    size_t size;
    char target[128];
    char image[1024];      /* file name, or "" when constant */
    int constant;          /* 1: `rgb(r,g,b)` */
    float color[3];        /* scene-linear, any finite value >= 0; of a constant */
    double scale[2];       /* default 1, 1; not 0 */
    double rotate;         /* degrees, default 0 */
    double offset[2];      /* default 0, 0; in repeats of the texture */
    RetexWrap wrap[2];     /* u, v; default repeat */
    char colorspace[64];   /* "" = by the file's type */
} RetexTextureSpec;
#define RETEX_TEXTURE_SPEC_INIT \
    { sizeof(RetexTextureSpec), "", "", 0, {0, 0, 0}, {1, 1}, 0, {0, 0}, {RETEX_WRAP_REPEAT, RETEX_WRAP_REPEAT}, "" }

/* opts: what follows `--texture:` ("scale=2,2:rotate=30", or "" or NULL); arg: "NAME=IMAGE" or "NAME=rgb(r,g,b)". */
int retex_texture_spec_parse(RetexTextureSpec *spec, const char *opts, const char *arg, RetexError *err);

typedef struct RetexTexture RetexTexture;

/* Load and build the MIP pyramid. RETEX_EIO or RETEX_EFORMAT with the file's name where it cannot. */
int retex_texture_load(RetexTexture **texture, const RetexTextureSpec *spec, int nthreads, RetexError *err);
/* A texture from pixels in memory (1, 3 or 4 channels, scene-linear, unassociated alpha; row 0 is the top). Copies. */
int retex_texture_create(RetexTexture **texture, const RetexImage *image,
                         const RetexTextureSpec *spec /* NULL = plain */, RetexError *err);
void retex_texture_close(RetexTexture **texture);
int retex_texture_size(const RetexTexture *texture, int *width, int *height); /* 1, 1 for a constant */

/* One point, bilinear between texel centres, after the spec's UV transform and wraps: rgba, unassociated alpha.
 * `wrap=black` gives (0,0,0,0) outside [0,1]. Thread-safe. What --replace and a pigment's interpolated image_map
 * use. */
void retex_texture_point(const RetexTexture *texture, double u, double v, float rgba[4]);

/* One point without interpolation: the texel that (u, v) falls in, floor(u * width) from the left, floor((1 - v) *
 * height) from the top, after the same transform and wraps. What a pigment's image_map without `interpolate` uses.
 * Thread-safe. */
void retex_texture_nearest(const RetexTexture *texture, double u, double v, float rgba[4]);

/* The texture averaged over a Gaussian of mean (u, v) and covariance {uu, uv, vv} in surface UV (before the spec's
 * transform, which is applied to both exactly). With zero covariance equals retex_texture_point. Colours are averaged
 * with alpha as their weight; rgba, unassociated. Thread-safe. */
void retex_texture_gaussian(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

/* The same over a disc: the texture averaged evenly over the ellipse of that mean and covariance, whose half axes are
 * two standard deviations along its principal axes (a disc of radius R has the variance R^2 / 4 along each axis). What
 * a footprint is that a box pixel filter sees sharply. Very long ellipses, of more than forty times their width, skip
 * texels along their length. */
void retex_texture_disc(const RetexTexture *texture, double u, double v, const double covariance[3], float rgba[4]);

#ifdef __cplusplus
}
#endif
#endif
