/* Reads pictures, by the decoder that the file's content asks for; picture.c writes them. EXR is read by OpenEXRCore,
 * which starts in 2 ms, common JPEG and PNG files by their own libraries, every other format, and files that these
 * cannot decode, by the bridge, which loads OpenImageIO. */
#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include <retex/image.h>
#include <retex/image_file.h>

#include "base/params.h"
#include "exr/io.h"
#include "io/input.h"
#include "picture/bridge_load.h"
#include "picture/image_format.h"
#include "picture/image_read.h"
#include "picture/jpeg_read.h"
#include "picture/png_read.h"

/* Chooses the channels of an EXR's first part that are its colours: R, G, B, or the grey Y, and A. 0 where there are
 * none. */
static int choose_channels(const RetexExr *exr, RetexExrRequest *request, int *grey)
{
    static const char colors[3][2] = {"R", "G", "B"};

    *grey = 1;
    for (int c = 0; c < 3; c++)
        if (retex_exr_has_channel(exr, 0, colors[c])) {
            strcpy(request->channels[c], colors[c]);
            *grey = 0;
        }
    if (*grey) {
        if (!retex_exr_has_channel(exr, 0, "Y"))
            return 0;
        strcpy(request->channels[0], "Y");
    }
    if (retex_exr_has_channel(exr, 0, "A"))
        strcpy(request->channels[3], "A");
    return 1;
}

/* Converts the pixels of an EXR, with associated alpha or none, to those of a RetexImage. */
static void finish_pixels(RetexImage *image, int grey, int has_alpha)
{
    const size_t count = (size_t)image->width * (size_t)image->height;

    for (size_t i = 0; i < count; i++) {
        float *pixel = image->pixels + 4 * i;
        if (grey)
            pixel[1] = pixel[2] = pixel[0];
        if (!has_alpha)
            pixel[3] = 1;
        else if (pixel[3] > 0 && pixel[3] != 1)
            for (int c = 0; c < 3; c++)
                pixel[c] /= pixel[3];
    }
}

static int check_pixels(int width, int height, const RetexBridgeFile *file, const char *name, RetexError *err)
{
    if (file->max_pixels > 0 && (int64_t)width * height > file->max_pixels)
        return retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels, more than %s", name, width, height,
                          file->limit);
    return 0;
}

/* Sets the smaller of two limits, and its name for messages. */
static void set_limit(RetexBridgeFile *file, const RetexReadParams *params)
{
    const uint64_t left = retex_budget_left(params->budget),
                   pixels = left / (params->pixel_bytes | !params->pixel_bytes);

    const long all = retex_budget_pixels(params->budget), own = params->max_pixels;

    file->max_pixels = own > 0 && all > 0 ? (own < all ? own : all) : own > 0 ? own : all;
    snprintf(file->limit, sizeof file->limit, "the %ld of --max-pixels", file->max_pixels);
    if (left != UINT64_MAX && (file->max_pixels <= 0 || pixels < (uint64_t)file->max_pixels)) {
        file->max_pixels = pixels ? (long)pixels : 1;
        snprintf(file->limit, sizeof file->limit, "--max-memory has room for");
    }
}

/* How the colours of an EXR are converted. */
typedef struct ExrColors {
    const char *colorspace; /* "" = linear; where converted is 1 this matrix leads to Rec.709: */
    int converted;          /* negative: the chromaticities span no space */
    double matrix[3][3];
    RetexColorTag tag;
} ExrColors;

/* Chooses the conversion. The interop ID has precedence; chromaticities are used where it is unknown. A file without
 * either is scene-linear Rec.709; data are not converted. */
static void choose_colors(ExrColors *colors, const RetexExr *exr, int is_unknown)
{
    const RetexColorTag *tag = &colors->tag;

    *colors = (ExrColors){.colorspace = ""};
    retex_exr_color_tag(exr, 0, &colors->tag);
    const RetexColorTag *known = retex_color_tag_find(tag->interop);
    const int named = !is_unknown && tag->interop[0] && strcmp(tag->interop, "unknown") != 0;
    if (known)
        colors->converted = retex_color_tag_to_rec709(known->chromaticities, colors->matrix);
    else if (named && strcmp(tag->interop, "data") != 0)
        colors->colorspace = tag->interop;
    else if (!named && tag->has_chromaticities)
        colors->converted = retex_color_tag_to_rec709(tag->chromaticities, colors->matrix);
}

static void convert_colors(RetexImage *image, const ExrColors *colors)
{
    const size_t count = (size_t)image->width * (size_t)image->height;
    const double(*m)[3] = colors->matrix;

    for (size_t i = 0; i < count && colors->converted == 1; i++) {
        float *p = image->pixels + 4 * i;
        const double r = p[0], g = p[1], b = p[2];
        for (int c = 0; c < 3; c++)
            p[c] = (float)(m[c][0] * r + m[c][1] * g + m[c][2] * b);
    }
}

/* Reads an open EXR. RETEX_EUNSUPPORTED: the file is sound, but this reader cannot read it. */
static int read_exr(RetexImage *dst, RetexExr *exr, const char *name, const RetexBridgeFile *file, RetexError *err)
{
    RetexExrRequest request = {.part = 0};
    RetexImage image = {0};
    const char *reason;
    int grey, width, height;

    if (!retex_exr_part_readable(exr, 0, &reason))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s: %s", name, reason);
    if (!choose_channels(exr, &request, &grey))
        return retex_fail(err, RETEX_EUNSUPPORTED, "%s has no channels R, G, B or Y", name);
    retex_exr_part_size(exr, 0, &width, &height);
    int code = check_pixels(width, height, file, name, err);
    if (!code && (uint64_t)width * (uint64_t)height * 16 > RETEX_EXR_MEMORY_MAX)
        code = retex_fail(err, RETEX_ELIMIT, "%s is too large: %d x %d pixels", name, width, height);
    if (!code)
        code = retex_image_alloc(&image, width, height, 4, err);
    if (!code) {
        request.image = &image;
        code = retex_exr_read(exr, &request, 1, file->nthreads, err);
    }
    if (code) {
        retex_image_free(&image);
        return code;
    }
    finish_pixels(&image, grey, request.channels[3][0] != 0);
    *dst = image;
    return 0;
}

/* A caller's parameters with all that they point to. */
typedef struct Reading {
    RetexReadParams params;
    RetexAccess access; /* what params.access points to, unless that is NULL */
} Reading;

static int copy_params(Reading *reading, const RetexReadParams *given, RetexError *err)
{
    *reading = (Reading){RETEX_READ_INIT, RETEX_ACCESS_INIT};
    int code = RETEX_PARAMS_COPY(&reading->params, given, err);
    if (!code && reading->params.access) {
        code = RETEX_PARAMS_COPY(&reading->access, reading->params.access, err);
        reading->params.access = &reading->access;
    }
    return code;
}

/* Chooses the bridge's decoder: any, or for safe access that of the content. */
static int choose_decoder(RetexBridgeFile *file, const RetexInput *input, const char *path,
                          const RetexReadParams *params, RetexError *err)
{
    *file = (RetexBridgeFile){.path = path,
                              .descriptor = -1,
                              .colorspace = params->colorspace,
                              .warn = params->warn,
                              .warn_context = params->warn_context,
                              .accept_damaged = params->access && params->access->accept_damaged};
    set_limit(file, params);
    if (strcmp(path, "-") == 0)
        return 0;
    const char *format = retex_image_format(input);
    const uint64_t pixels = retex_image_header_pixels(input, format);
    if (file->max_pixels > 0 && pixels > (uint64_t)file->max_pixels)
        return retex_fail_at(err, RETEX_ELIMIT, path, 0, 0, "the picture is too large: %.0f pixels, more than %s",
                             (double)pixels, file->limit);
    if (!params->access || !params->access->safe)
        return 0;
    file->format = format;
    file->descriptor = retex_input_descriptor(input);
    if (!file->format)
        return retex_fail_at(err, RETEX_EFORMAT, path, 0, 0,
                             "no " RETEX_IMAGE_FORMATS " by what is in it: others are not read (--safe)");
    return 0;
}

/* Reads an EXR with linear colours here if possible, else by the bridge. */
static int read_in_space(RetexImage *dst, RetexExr *exr, const RetexInput *input, const RetexBridgeFile *file,
                         RetexError *err)
{
    const int standard_input = strcmp(file->path, "-") == 0;
    int code = RETEX_EUNSUPPORTED;

    if (retex_names_linear(file->colorspace))
        code = read_exr(dst, exr, retex_input_name(input), file, err);
    else if (standard_input)
        retex_fail(err, code, "standard input is read as scene-linear only, not %s", file->colorspace);
    if (code == RETEX_EUNSUPPORTED && !standard_input)
        code = retex_bridge_read(dst, file, err);
    return code;
}

/* Warns of colours that the header states and that are not followed. */
static void warn_of_colors(const ExrColors *colors, int is_unknown, const RetexBridgeFile *file)
{
    const char *taken = is_unknown && colors->converted == 1 ? "the colours are taken by its chromaticities"
                                                             : "its colours are taken as scene-linear Rec.709";
    char text[sizeof colors->tag.interop + PATH_MAX + 256];

    if (!file->warn || (!is_unknown && colors->converted >= 0))
        return;
    if (is_unknown)
        snprintf(text, sizeof text, "%s: its header names the colour space '%s', which is not known; %s", file->path,
                 colors->tag.interop, taken);
    else
        snprintf(text, sizeof text, "%s: the chromaticities in its header span no colour space; %s", file->path, taken);
    file->warn(file->warn_context, text);
}

/* Reads an EXR in the colour space that its header names, as far as it is known. */
static int read_tagged(RetexImage *dst, RetexExr *exr, const RetexInput *input, const RetexBridgeFile *file,
                       RetexError *err)
{
    RetexBridgeFile tagged = *file;
    ExrColors colors;
    int is_unknown = 0;

    choose_colors(&colors, exr, 0);
    tagged.colorspace = colors.colorspace;
    int code = read_in_space(dst, exr, input, &tagged, err);
    if (code == RETEX_ENOTFOUND && colors.colorspace[0]) {
        is_unknown = 1;
        choose_colors(&colors, exr, is_unknown);
        tagged.colorspace = colors.colorspace;
        code = read_in_space(dst, exr, input, &tagged, err);
    }
    if (!code) {
        convert_colors(dst, &colors);
        warn_of_colors(&colors, is_unknown, file);
    }
    return code;
}

/* Read a common JPEG or PNG file without the bridge, into one of the levels' images, which has no pixels where the
 * file is left to the bridge. */
static int decode_levels(RetexLevels *levels, RetexInput *input, RetexError *err)
{
    static const struct {
        const char *mark;
        size_t length;
        int (*read)(RetexLevels *levels, const void *data, size_t bytes);
    } decoders[] = {{"\xff\xd8\xff", 3, retex_jpeg_read}, {"\x89PNG\r\n\x1a\n", 8, retex_png_read}};
    unsigned char begin[8] = {0};
    const void *data;
    size_t bytes;

    retex_input_read(input, begin, sizeof begin, 0);
    for (size_t i = 0; i < sizeof decoders / sizeof *decoders; i++) {
        if (memcmp(begin, decoders[i].mark, decoders[i].length) != 0)
            continue;
        const int code = retex_input_load(input, &data, &bytes, err);
        const int done = code ? RETEX_LEVELS_LEFT : decoders[i].read(levels, data, bytes);
        if (!code)
            retex_levels_end(levels, done == RETEX_LEVELS_READ);
        return done == RETEX_LEVELS_NO_MEMORY
                   ? retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", retex_input_name(input))
                   : code;
    }
    return retex_input_check(input, RETEX_OK, err);
}

/* The same of colour spaces that OpenColorIO need not find, and that no configuration may change. */
static int read_levels(RetexLevels *levels, RetexInput *input, const RetexBridgeFile *file, RetexError *err)
{
    const char *name = file->colorspace, *ocio = getenv("OCIO");
    const int named = name && name[0], by_default = !ocio || !ocio[0]; /* the bridge decides whether it is usable */
    const int is_srgb = named ? strcasecmp(name, "sRGB") == 0 : by_default;

    levels->is_linear = named && by_default && retex_names_linear(name);
    levels->max_pixels = file->max_pixels;
    return is_srgb || levels->is_linear ? decode_levels(levels, input, err) : 0;
}

static int read_open(RetexImage *dst, RetexInput *input, const char *path, const RetexReadParams *params, int nthreads,
                     RetexError *err)
{
    const int standard_input = strcmp(path, "-") == 0, linear = retex_names_linear(params->colorspace);
    RetexBridgeFile file;
    RetexExr *exr = NULL;
    int code = choose_decoder(&file, input, path, params, err);

    if (code)
        return code;
    file.nthreads = nthreads;
    if (!standard_input && (!retex_exr_probe(input) || !linear)) {
        code = read_levels(&(RetexLevels){.image = dst}, input, &file, err);
        return code || dst->pixels ? code : retex_bridge_read(dst, &file, err);
    }
    code = retex_exr_open(&exr, input, err);
    if (!code)
        code = params->colorspace && params->colorspace[0] ? read_in_space(dst, exr, input, &file, err)
                                                             : read_tagged(dst, exr, input, &file, err);
    retex_exr_close(&exr);
    return code;
}

/* Checks whether the bridge can read a file, by its beginning: with a limit of one pixel no picture is decoded. */
static int bridge_check(RetexBridgeFile file, RetexError *err)
{
    RetexImage image = {0};
    RetexError error = {0};

    file.max_pixels = 1;
    file.warn = NULL;
    const int code = retex_bridge_read(&image, &file, &error);
    retex_image_free(&image);
    if (code && code != RETEX_ELIMIT && err)
        *err = error;
    return code == RETEX_ELIMIT ? 0 : code;
}

/* Checks the header of an EXR: 0 if it can be read, here or by the bridge. */
static int check_exr(RetexInput *input, const RetexBridgeFile *file, RetexError *err)
{
    RetexExr *exr = NULL;
    RetexExrRequest request = {.part = 0};
    const char *reason;
    int grey, code = retex_exr_open(&exr, input, err);
    const int own = !code && retex_exr_part_readable(exr, 0, &reason) && choose_channels(exr, &request, &grey);

    retex_exr_close(&exr);
    return own || code ? code : bridge_check(*file, err);
}

/* JPEG by its beginning, PNG by its checksums. */
static int is_sound(RetexInput *input)
{
    unsigned char begin[3];
    const void *data;
    size_t bytes;

    if (retex_input_read(input, begin, sizeof begin, 0) != sizeof begin)
        return 0;
    if (memcmp(begin, "\xff\xd8\xff", 3) == 0)
        return 1;
    return memcmp(begin, "\x89PN", 3) == 0 && !retex_input_load(input, &data, &bytes, NULL) &&
           retex_png_is_whole(data, bytes);
}

static int check_open(RetexInput *input, const char *path, const RetexReadParams *params, RetexError *err)
{
    RetexBridgeFile file;
    const int code = choose_decoder(&file, input, path, params, err);

    if (code)
        return code;
    if (retex_exr_probe(input))
        return check_exr(input, &file, err);
    return is_sound(input) ? 0 : bridge_check(file, err);
}

/* Reads 16-bit integers, or nothing where the file has others. Spaces that have to be looked up may not be decoded by
 * channel. */
static int read_narrow(RetexNarrowImage *dst, RetexInput *input, const char *path, const RetexReadParams *params,
                       int nthreads, RetexError *err)
{
    const char *name = params->colorspace;
    RetexBridgeFile file;

    if (strcmp(path, "-") == 0 || retex_exr_probe(input) || (name && name[0] && strcasecmp(name, "sRGB") != 0))
        return 0;
    int code = choose_decoder(&file, input, path, params, err);
    if (!code)
        code = read_levels(&(RetexLevels){.narrow = dst}, input, &file, err);
    file.nthreads = nthreads;
    return code || dst->pixels ? code : retex_bridge_read_narrow(dst, &file, err);
}

/* Of files of strangers. Some programs make a dozen scans. */
static int check_scans(const RetexInput *input, const char *path, RetexError *err)
{
    enum { MOST_SCANS = 200 };
    const char *format = retex_image_format(input);

    if (!format || strcmp(format, "jpeg") != 0 || !retex_image_has_more_scans(input, MOST_SCANS))
        return 0;
    return retex_fail(err, RETEX_ELIMIT, "%s: a JPEG of more than %d scans, which are not read (--safe)", path,
                      MOST_SCANS);
}

int retex_image_decode(RetexDecoded *decoded, RetexDecode decode, RetexInput *input, const char *path,
                       const RetexReadParams *params, int nthreads, RetexError *err)
{
    int code = params->access && params->access->safe ? check_scans(input, path, err) : 0;

    *decoded = (RetexDecoded){0};
    if (code)
        return code;
    if (decode == RETEX_DECODE_CHECK)
        return check_open(input, path, params, err);
    if (decode == RETEX_DECODE_ANY)
        code = read_narrow(&decoded->narrow, input, path, params, nthreads, err);
    if (code || decoded->narrow.pixels)
        return code;
    return read_open(&decoded->image, input, path, params, nthreads, err);
}

/* In this process, or in safe access in one of its own, if this one is not confined itself. What is none of the formats
 * needs none. */
static int read_input(RetexDecoded *decoded, RetexDecode decode, RetexInput *input, const char *path,
                      const RetexReadParams *params, int nthreads, RetexError *err)
{
    const int is_apart = params->access && params->access->safe == 1;
    RetexBridgeFile file;

    if (!is_apart)
        return retex_image_decode(decoded, decode, input, path, params, nthreads, err);
    const int code = choose_decoder(&file, input, path, params, err);
    return code ? code : retex_decoder_run(decoded, decode, input, path, params, nthreads, err);
}

static int read_path(RetexDecoded *decoded, RetexDecode decode, const char *path, const RetexReadParams *given,
                     int nthreads, RetexError *err)
{
    RetexInput *input = NULL;
    Reading own;

    *decoded = (RetexDecoded){0};
    int code = copy_params(&own, given, err);
    if (!code)
        code = retex_input_open_allowed(&input, path, own.params.access, err);
    if (!code)
        code = read_input(decoded, decode, input, path, &own.params, nthreads, err);
    retex_input_close(&input);
    return code;
}

int retex_image_read(RetexImage *dst, const char *path, const RetexReadParams *given, int nthreads, RetexError *err)
{
    RetexDecoded decoded;

    if (dst->pixels)
        return retex_fail(err, RETEX_EINVAL, "the destination is allocated already");
    const int code = read_path(&decoded, RETEX_DECODE_PIXELS, path, given, nthreads, err);
    if (!code)
        *dst = decoded.image;
    return code;
}

int retex_image_read_any(RetexDecoded *decoded, const char *path, const RetexReadParams *params, int nthreads,
                         RetexError *err)
{
    return read_path(decoded, RETEX_DECODE_ANY, path, params, nthreads, err);
}

int retex_image_read_check(const char *path, const RetexReadParams *given, RetexError *err)
{
    RetexDecoded none;
    struct stat info;
    Reading own;

    const int code = copy_params(&own, given, err);
    if (code || strcmp(path, "-") == 0)
        return code;
    if (!own.access.safe && stat(path, &info) == 0 && S_ISFIFO(info.st_mode))
        return access(path, R_OK) == 0 ? 0 : retex_fail(err, RETEX_EIO, "cannot read %s: %s", path, strerror(errno));
    return read_path(&none, RETEX_DECODE_CHECK, path, &own.params, 1, err);
}
