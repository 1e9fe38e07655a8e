/* Picture files: reading and writing of whole images. <retex/picture.h> writes pictures row by row. */
#ifndef RETEX_IMAGE_FILE_H
#define RETEX_IMAGE_FILE_H

#include <retex/image.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* How a picture is read. Begin with RETEX_READ_INIT. */
typedef struct RetexReadParams {
    size_t size;               /* of this struct */
    const char *colorspace;    /* a name known to the OCIO config. NULL, the default = what the file states, else
                                  8- and 16-bit integers are sRGB and floats scene-linear. An EXR states its colours by
                                  acesImageContainerFlag, colorInteropID, oiio:ColorSpace, chromaticities, in this
                                  order; a PNG by cICP, iCCP, sRGB, gAMA with cHRM; others by an ICC profile */
    long max_pixels;           /* a picture of more is refused with RETEX_ELIMIT. Default 0 = no limit */
    const RetexAccess *access; /* borrowed; default NULL = any file */
    const RetexBudget *budget; /* borrowed: a picture of more pixels, or for which it has not enough memory left, is
                                  refused before it is decoded. Default NULL = none is */
    unsigned pixel_bytes;      /* what the caller will need a pixel, at the peak; default 16, the pixels alone */
    RetexWarn *warn;           /* told, in the calling thread, why colours that the file states are not followed;
                                  default NULL = nobody */
    void *warn_context;        /* handed to it; default NULL */
} RetexReadParams;
#define RETEX_READ_INIT { sizeof(RetexReadParams), NULL, 0, NULL, NULL, 16, NULL, NULL }

/* Read the colours of any file that OpenImageIO reads. EXR, JPEG and PNG are read without loading it, but for rare
 * kinds of them and for colour spaces that need OpenColorIO. path "-" is standard input (EXR only). The result has 4
 * channels R,G,B,A, scene-linear Rec.709, alpha unassociated (1 where the file has none; grey is spread over R,G,B).
 * Only the first subimage is read. nthreads: at most so many decode, 0 = all cores. */
int retex_image_read(RetexImage *dst, const char *path, const RetexReadParams *params /* NULL = defaults */,
                     int nthreads, RetexError *err);
/* Check whether retex_image_read could read a file, as far as its beginning tells: it exists, may be read, and is
 * a picture. Colour spaces are not checked, and pipes and "-" are not read. To be called before long work. */
int retex_image_read_check(const char *path, const RetexReadParams *params /* NULL = defaults */, RetexError *err);

/* How a picture is written. Begin with RETEX_WRITE_INIT. */
typedef struct RetexWriteParams {
    size_t size;            /* of this struct */
    const char *display;    /* OCIO display for 8- and 16-bit files; NULL = the config's default */
    const char *view;       /* its view; NULL = the display's default. The built-in configuration has Standard, Filmic,
                               Neutral and Raw, see retex-combine(1) */
    const char *colorspace; /* write in this colour space instead of through display and view; NULL = none */
    int quality;            /* of JPEG, 1..100, and of WebP, AVIF and JPEG XL, whose error is then about that of
                               JPEG; default 95 */
    int is_data;            /* 1: numbers that are no colours, which an EXR stores as they are and says so; other
                               formats go by what is above. Default 0 */
    int depth;              /* bits of integers: 8 or 16. Default 0 = the format's: 16 of TIFF and DPX, 8 of others */
} RetexWriteParams;
#define RETEX_WRITE_INIT { sizeof(RetexWriteParams), NULL, NULL, NULL, 95, 0, 0 }

/* Write a picture of 1 (grey), 3 (RGB) or 4 (RGBA) channels; the format follows the name's ending, "-" is EXR to
 * standard output. EXR (half) and other float formats stay scene-linear unless colorspace says otherwise; 8- and 16-bit
 * formats go through the display transform. An EXR names its colours where they are known, by chromaticities where they
 * are linear, and by the interop ID. Written under a temporary name and renamed when complete. nthreads: at most
 * so many encode, 0 = all cores; the file is the same for every number. */
int retex_image_write(const RetexImage *src, const char *path, const RetexWriteParams *params /* NULL = defaults */,
                      int nthreads, RetexError *err);

/* Check whether retex_image_write could write there, as far as that is known without writing: a format of that ending,
 * a folder that takes files, a known display, view or colour space. To be called before the work that makes the
 * picture. */
int retex_image_write_check(const char *path, const RetexWriteParams *params /* NULL = defaults */, RetexError *err);

/* The same without the folder, which need not exist yet. */
int retex_image_format_check(const char *path, const RetexWriteParams *params /* NULL = defaults */, RetexError *err);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
