/* The bridge: OpenImageIO and OpenColorIO behind a few C calls. They live in a library of their own, libretex-oiio.so,
 * loaded on first use, because linking OpenImageIO costs every process 0.17 s of start-up and most need none of it. */
#ifndef RETEX_PICTURE_BRIDGE_LOAD_H
#define RETEX_PICTURE_BRIDGE_LOAD_H

#include <stdint.h>

#include <retex/image.h>
#include <retex/image_file.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Whether a colour space, by its name or by none, is what we compute in: then OpenColorIO is not needed for an EXR. */
int retex_names_linear(const char *colorspace);

/* What is to be read. */
typedef struct RetexBridgeFile {
    const char *path;
    const char *format;     /* OpenImageIO's name of the one decoder that may see it, or NULL: any one */
    int descriptor;         /* with a format: the file, in place of path, which then is for messages only */
    const char *colorspace; /* or NULL */
    long max_pixels;        /* 0 = no limit */
    char limit[64];         /* that in words */
} RetexBridgeFile;

/* Read any file OpenImageIO knows as R,G,B,A, scene-linear Rec.709, unassociated alpha; as retex_image_read, of
 * which it is the general case. dst is unallocated. */
int retex_bridge_read(RetexImage *dst, const RetexBridgeFile *file, RetexError *err);

/* An image of 16-bit integers, 65535 for 1: R,G,B,A, scene-linear Rec.709, premultiplied, rows from the top. The
 * pixels are freed with free(). */
typedef struct RetexNarrowImage {
    int width, height;
    uint16_t *pixels;
} RetexNarrowImage;

/* The same picture without floats, for files of 8- and 16-bit integers whose channels are decoded one by one. Others
 * are left alone: dst->pixels stays NULL. */
int retex_bridge_read_narrow(RetexNarrowImage *dst, const RetexBridgeFile *file, RetexError *err);

/* In base/image.c: the same for any path that retex_image_read_with takes. */
int retex_image_read_narrow(RetexNarrowImage *dst, const char *path, const RetexReadParams *params, RetexError *err);

/* How a picture of that size goes into a file of the format that path's ending names, in the colours that params name.
 * Neither is needed afterwards. */
typedef struct RetexBridgePlan RetexBridgePlan;

/* What such a file stores of a pixel. */
typedef struct RetexBridgeStored {
    int channels; /* fewer than the picture has where the format knows no alpha */
    int bits;     /* a sample: 8, 16, or 32 for floats */
    int is_srgb;  /* colours are shown as plain sRGB, alpha apart or lost: whoever knows the curve may store them */
    /* Of params->colorspace, as far as the configuration tells: */
    char interop[64];          /* the interop ID that the space has as its name or an alias, "data", or "" */
    int is_linear;             /* 1: a linear space, and this leads to it from scene-linear Rec.709: */
    double from_rec709[3][3];
} RetexBridgeStored;

int retex_bridge_plan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width, int height,
                      int channels, const RetexWriteParams *params, RetexError *err);
void retex_bridge_plan_free(RetexBridgePlan **plan); /* NULL in it is fine */

/* Scene-linear pixels as the file stores them; from any thread. */
int retex_bridge_convert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples, RetexError *err);

/* Where the bytes of a written picture go: returns 0 or a RETEX_E… that ends the writing, with err filled. */
typedef int RetexBridgeSink(void *context, const void *data, size_t bytes, RetexError *err);

/* Encode all stored samples of the picture and hand the file to sink. The path of the plan is not opened. */
int retex_bridge_write(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                       RetexError *err);

/* Whether there is such a format, and the colour space or the display that params name. */
int retex_bridge_check(const char *path, const RetexWriteParams *params, RetexError *err);

/* What the library exports and what it is given. The library has no part of libretex inside: memory of images comes
 * from the caller's functions. */
typedef struct RetexBridgeHost {
    int (*image_alloc)(RetexImage *im, int width, int height, int channels, RetexError *err);
    void (*image_free)(RetexImage *im);
    void *(*alloc)(size_t bytes);
    void (*free)(void *block);
} RetexBridgeHost;

#define RETEX_BRIDGE_ABI 7
typedef int RetexBridgeAbi(void);
typedef int RetexBridgeRead(const RetexBridgeHost *host, RetexImage *dst, const RetexBridgeFile *file, RetexError *err);
typedef int RetexBridgeReadNarrow(const RetexBridgeHost *host, RetexNarrowImage *dst, const RetexBridgeFile *file,
                                  RetexError *err);
typedef int RetexBridgeMakePlan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width,
                                int height, int channels, const RetexWriteParams *params, RetexError *err);
typedef void RetexBridgeFreePlan(RetexBridgePlan **plan);
typedef int RetexBridgeConvert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples,
                               RetexError *err);
typedef int RetexBridgeWrite(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                             RetexError *err);
/* Before the process ends: temporary files that have a name. */
typedef void RetexBridgeRemove(void);
typedef int RetexBridgeCheck(const char *path, const RetexWriteParams *params, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
