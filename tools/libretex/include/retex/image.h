/* Images and regions. A RetexImage is a plain block of float samples, interleaved by pixel, rows from the top, no
 * padding. Scene-linear unless said otherwise. */
#ifndef RETEX_IMAGE_H
#define RETEX_IMAGE_H

#include <stddef.h>
#include <retex/access.h>
#include <retex/budget.h>
#include <retex/error.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RETEX_MAX_SIZE 65536     /* largest width or height of any image */
#define RETEX_MAX_CHANNELS 64

/* Half-open: pixels x0 <= x < x1, y0 <= y < y1, channels c0 <= c < c1. */
typedef struct RetexRoi {
    int x0, y0, x1, y1, c0, c1;
} RetexRoi;

typedef struct RetexImage {
    int width, height, channels; /* 0, 0, 0 while unallocated */
    float *pixels;               /* width * height * channels; owned by the image */
} RetexImage;

/* How samples are stored. In memory they are always float. */
typedef enum RetexPixelType { RETEX_HALF, RETEX_FLOAT } RetexPixelType;

static inline size_t retex_image_index(const RetexImage *im, int x, int y)
{
    return ((size_t)y * (size_t)im->width + (size_t)x) * (size_t)im->channels;
}

/* Allocate zeroed pixels; im must be unallocated ({0}). */
int retex_image_alloc(RetexImage *im, int width, int height, int channels, RetexError *err);
void retex_image_free(RetexImage *im); /* NULL and unallocated are fine; leaves {0} */
int retex_image_copy(RetexImage *dst, const RetexImage *src, RetexError *err); /* dst unallocated */

RetexRoi retex_image_roi(const RetexImage *im); /* all of it */
/* Common checks of an image operation: allocate dst as width x height x channels if it is unallocated, else check that
 * it has that shape; clip *roi (NULL = all) to it into *out. */
int retex_image_prepare(RetexImage *dst, int width, int height, int channels, const RetexRoi *roi, RetexRoi *out,
                        RetexError *err);

/* Read the colours of any file that OpenImageIO reads, or an EXR through OpenEXRCore without loading OpenImageIO.
 * path "-" is standard input (EXR only). The result has 4 channels R,G,B,A, scene-linear Rec.709, alpha unassociated
 * (1 where the file has none; grey is spread over R,G,B). colorspace: NULL = 8- and 16-bit integers are sRGB, floats
 * scene-linear, an EXR what its header says (acesImageContainerFlag, colorInteropID, chromaticities, in this order);
 * otherwise a name known to the OCIO config. Only the first subimage is read.
 * Files of more than max_pixels pixels (0 = no limit) are refused with RETEX_ELIMIT. */
int retex_image_read(RetexImage *dst, const char *path, const char *colorspace, long max_pixels, RetexError *err);

/* The same, and which files may be read. Begin with RETEX_READ_INIT. */
typedef struct RetexReadParams {
    size_t size;               /* of this struct */
    const char *colorspace;    /* default NULL */
    long max_pixels;           /* default 0 */
    const RetexAccess *access; /* borrowed; default NULL = any file */
    const RetexBudget *budget; /* borrowed: a picture of more pixels, or for which it has not enough memory left, is
                                  refused before it is decoded. Default NULL = none is */
    unsigned pixel_bytes;      /* what the caller will need a pixel, at the peak; default 16, the pixels alone */
} RetexReadParams;
#define RETEX_READ_INIT { sizeof(RetexReadParams), NULL, 0, NULL, NULL, 16 }

int retex_image_read_with(RetexImage *dst, const char *path, const RetexReadParams *params /* NULL = defaults */,
                          RetexError *err);
/* Whether retex_image_read_with could read it, as far as the file's beginning tells: it is there, may be read, and is a
 * picture. Colour spaces are not looked at, of pipes and "-" nothing is read. For before long work. */
int retex_image_read_check(const char *path, const RetexReadParams *params /* NULL = defaults */, RetexError *err);

/* How a picture leaves. Begin with RETEX_WRITE_INIT. */
typedef struct RetexWriteParams {
    size_t size;            /* of this struct */
    const char *display;    /* OCIO display for 8- and 16-bit files; NULL = the config's default */
    const char *view;       /* OCIO view; NULL = the display's default */
    const char *colorspace; /* write in this colour space instead of through display and view; NULL = none */
    int quality;            /* of JPEG, 1..100; default 95 */
    int is_data;            /* 1: numbers that are no colours, which an EXR stores as they are and says so; other
                               formats go by what is above. Default 0 */
} RetexWriteParams;
#define RETEX_WRITE_INIT { sizeof(RetexWriteParams), NULL, NULL, NULL, 95, 0 }

/* Write a picture of 1 (grey), 3 (RGB) or 4 (RGBA) channels; the format follows the name's ending, "-" is EXR to
 * standard output. EXR (half) and other float formats stay scene-linear unless colorspace says otherwise; 8- and 16-bit
 * formats go through the display transform. An EXR names its colours where they are known, by chromaticities where they
 * are linear, and by the interop ID. Written under a temporary name and renamed when complete. */
int retex_image_write(const RetexImage *src, const char *path, const RetexWriteParams *params /* NULL = defaults */,
                      RetexError *err);

/* Whether retex_image_write could write there, as far as one can tell without doing it: a format of that ending, a
 * folder that takes files, a known display, view or colour space. For before the work that makes the picture. */
int retex_image_write_check(const char *path, const RetexWriteParams *params /* NULL = defaults */, RetexError *err);

/* The same without looking at the folder, which need not be there yet. */
int retex_image_format_check(const char *path, const RetexWriteParams *params /* NULL = defaults */, RetexError *err);

/* Write a file of any kind as all outputs here are: under a temporary name, renamed when complete; or to "-". */
int retex_file_write(const char *path, const void *data, size_t bytes, RetexError *err);

/* Before a process ends in the middle of its work, from any thread: remove what outputs that are not whole have of
 * temporary names. No output can be finished afterwards. */
void retex_pending_files_remove(void);

#ifdef __cplusplus
}
#endif
#endif
