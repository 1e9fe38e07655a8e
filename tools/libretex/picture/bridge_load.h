/* The bridge: OpenImageIO and OpenColorIO behind a few C functions. They are in a library of their own,
 * libretex-oiio.so, loaded on first use, because linking OpenImageIO costs every process 0.17 s of start-up time, and
 * most processes do not need it. */
#ifndef RETEX_PICTURE_BRIDGE_LOAD_H
#define RETEX_PICTURE_BRIDGE_LOAD_H

#include <stdint.h>

#include <retex/image.h>
#include <retex/image_file.h>

#include "levels.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if a colour space, by its name or NULL, is the one in which the library computes: then an EXR needs no
 * OpenColorIO. */
int retex_names_linear(const char *colorspace);

/* A file to read. */
typedef struct RetexBridgeFile {
    const char *path;
    const char *format;     /* OpenImageIO's name of the only decoder that may be used, or NULL: any */
    int descriptor;         /* with a format: the file's descriptor, used instead of path, which then is for messages
                               only */
    const char *colorspace; /* or NULL */
    long max_pixels;        /* 0 = no limit */
    char limit[64];         /* the limit in words, for messages */
    int nthreads;           /* that decode, at most; 0 = all cores */
    RetexWarn *warn;        /* as of RetexReadParams, or NULL */
    void *warn_context;
    int accept_damaged;     /* 1: what is damaged is read all the same, and warned of */
} RetexBridgeFile;

/* Read any file that OpenImageIO reads as R,G,B,A, scene-linear Rec.709, unassociated alpha: the general case of
 * retex_image_read. dst is unallocated. */
int retex_bridge_read(RetexImage *dst, const RetexBridgeFile *file, RetexError *err);

/* Read the same picture as integers, for files of 8- and 16-bit integers whose channels are decoded one by one. For
 * other files dst->pixels stays NULL. */
int retex_bridge_read_narrow(RetexNarrowImage *dst, const RetexBridgeFile *file, RetexError *err);

/* For the program that decodes, see picture/decoder.h, which cannot load libraries once it is confined. Either the
 * bridge is left out, and reading fails where it is missed: then retex_bridge_missed returns the colour space of that
 * file, else NULL. Or all that files of a format need is loaded before: of `file`, format and colorspace count. */
void retex_bridge_leave_out(void);
const char *retex_bridge_missed(void);
int retex_bridge_prepare(const RetexBridgeFile *file, RetexError *err);

/* A plan: how a picture of that size is stored in a file of the format that path's ending names, in the colours that
 * params name. path and params are not needed afterwards. */
typedef struct RetexBridgePlan RetexBridgePlan;

/* The samples that such a file stores for a pixel. */
typedef struct RetexBridgeStored {
    int channels; /* fewer than the picture has where the format has no alpha */
    int bits;     /* bits a sample: 8, 16, or 32 for floats */
    int is_srgb;  /* 1: colours are plain sRGB, and alpha is separate or absent: then the library can convert them
                     itself */
    /* What the configuration says of params->colorspace: */
    char interop[64];          /* the interop ID that the space has as its name or an alias, "data", or "" */
    int is_linear;             /* 1: a linear space; this matrix leads to it from scene-linear Rec.709: */
    double from_rec709[3][3];
} RetexBridgeStored;

int retex_bridge_plan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width, int height,
                      int channels, const RetexWriteParams *params, RetexError *err);
void retex_bridge_plan_free(RetexBridgePlan **plan); /* NULL in it is fine */

/* Convert scene-linear pixels to the file's samples; from any thread. */
int retex_bridge_convert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples, RetexError *err);

/* Receives the bytes of a picture that is written: returns 0 or a RETEX_E… that ends the writing, with err filled. */
typedef int RetexBridgeSink(void *context, const void *data, size_t bytes, RetexError *err);

/* Encode all samples of the picture and write the file to sink. The path of the plan is not opened. */
int retex_bridge_write(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                       RetexError *err);

/* Check that the format, and the colour space or the display that params name, exist. */
int retex_bridge_check(const char *path, const RetexWriteParams *params, RetexError *err);

/* The functions that the library exports and those that it receives. The library contains no part of libretex: memory
 * of images comes from the caller's functions. */
typedef struct RetexBridgeHost {
    int (*image_alloc)(RetexImage *im, int width, int height, int channels, RetexError *err);
    void (*image_free)(RetexImage *im);
    void *(*alloc)(size_t bytes);
    void (*free)(void *block);
    int (*to_rec709)(const float chromaticities[8], double matrix[3][3]); /* retex_color_tag_to_rec709 */
    int (*jpeg_is_damaged)(const void *data, size_t bytes, RetexDamage damage);
    int (*png_is_damaged)(const void *data, size_t bytes, long max_pixels, RetexDamage damage);
} RetexBridgeHost;

#define RETEX_BRIDGE_ABI 11
typedef int RetexBridgeAbi(void);
typedef int RetexBridgeRead(const RetexBridgeHost *host, RetexImage *dst, const RetexBridgeFile *file, RetexError *err);
typedef int RetexBridgeReadNarrow(const RetexBridgeHost *host, RetexNarrowImage *dst, const RetexBridgeFile *file,
                                  RetexError *err);
typedef int RetexBridgePrepare(const RetexBridgeFile *file, RetexError *err);
typedef int RetexBridgeMakePlan(RetexBridgePlan **plan, RetexBridgeStored *stored, const char *path, int width,
                                int height, int channels, const RetexWriteParams *params, RetexError *err);
typedef void RetexBridgeFreePlan(RetexBridgePlan **plan);
typedef int RetexBridgeConvert(const RetexBridgePlan *plan, const float *rows, long pixels, void *samples,
                               RetexError *err);
typedef int RetexBridgeWrite(const RetexBridgePlan *plan, const void *samples, RetexBridgeSink *sink, void *context,
                             RetexError *err);
/* Remove temporary files that have a name, before the process ends. */
typedef void RetexBridgeRemove(void);
typedef int RetexBridgeCheck(const char *path, const RetexWriteParams *params, RetexError *err);

#ifdef __cplusplus
}
#endif
#endif
