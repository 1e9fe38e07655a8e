/* JPEG files of radiance: libjpeg writes and reads DCT coefficients, the DCT itself is ours. See jpeg.h. */
#include "pack/jpeg.h"

#include <math.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>
#include <jerror.h>

#include <retex/color.h>

#include "pack/jpeg_kernel.h"

/* --- the curve --- */

/* The curve is sRGB's up to white and logarithmic above: a factor of e adds LEVELS_PER_E levels, if white is at 255. */
static const double LEVELS_PER_E = 48;
static const double ENTRIES_TO_WHITE = (double)RETEX_PACK_LEVEL_ENTRIES / RETEX_PACK_WHITES_MOST;

RetexPackCurve retex_pack_curve(double white, double levels)
{
    return (RetexPackCurve){.white = {white, white, white}, .levels = levels};
}

double retex_pack_curve_level(const RetexPackCurve *curve, int channel, double value)
{
    const double x = value / curve->white[channel];
    const double y = x > 1 ? 1 + LEVELS_PER_E / 255 * log(x) : retex_srgb_encode(x);
    return curve->levels * fmin(y, RETEX_PACK_WHITES_MOST);
}

double retex_pack_curve_value(const RetexPackCurve *curve, int channel, double level)
{
    const double y = level / curve->levels;
    const double x = y > 1 ? exp((y - 1) * 255 / LEVELS_PER_E) : retex_srgb_decode(y);
    return curve->white[channel] * x;
}

/* Values relative to white, by level, the same for all curves. fill_shares fills them once. */
static float shares[RETEX_PACK_LEVEL_ENTRIES + 2];

static void fill_shares(void)
{
    const RetexPackCurve unit = retex_pack_curve(1, ENTRIES_TO_WHITE);
    for (int i = 0; i < RETEX_PACK_LEVEL_ENTRIES + 2; i++)
        shares[i] = (float)retex_pack_curve_value(&unit, 0, i);
}

static RetexPackLevels levels_of(const RetexPackCurve *curve)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, fill_shares);
    RetexPackLevels levels = {.scale = (float)(ENTRIES_TO_WHITE / curve->levels), .share = shares};
    for (int c = 0; c < 3; c++)
        levels.white[c] = (float)curve->white[c];
    return levels;
}

/* --- libjpeg's errors --- */

typedef struct JpegErrors {
    struct jpeg_error_mgr manager;
    jmp_buf failed;
    char message[JMSG_LENGTH_MAX];
} JpegErrors;

static void error_exit(j_common_ptr jpeg)
{
    JpegErrors *errors = (JpegErrors *)jpeg->err;
    jpeg->err->format_message(jpeg, errors->message);
    longjmp(errors->failed, 1);
}

/* Warnings count as errors: libjpeg would go on with made-up data. */
static void exit_on_warning(j_common_ptr jpeg, int level)
{
    if (level < 0)
        error_exit(jpeg);
}

static void discard_message(j_common_ptr jpeg)
{
    (void)jpeg;
}

static struct jpeg_error_mgr *jpeg_errors_init(JpegErrors *errors)
{
    jpeg_std_error(&errors->manager);
    errors->manager.error_exit = error_exit;
    errors->manager.emit_message = exit_on_warning;
    errors->manager.output_message = discard_message;
    return &errors->manager;
}

static int fail_decoding(const JpegErrors *errors, RetexError *err)
{
    if (errors->manager.msg_code == JERR_OUT_OF_MEMORY)
        return retex_fail(err, RETEX_ENOMEM, "no memory to decode JPEGs");
    return retex_fail(err, RETEX_EFORMAT, "its JPEG cannot be decoded: %s", errors->message);
}

/* --- encoding --- */

void retex_pack_jpeg_free(RetexPackJpeg *jpeg)
{
    free(jpeg->data);
    free(jpeg->slice_bytes);
    memset(jpeg, 0, sizeof *jpeg);
}

/* The largest magnitudes of DCT coefficients, by frequency: [0] luma, [1] chroma. */
typedef struct Largest {
    float size[2][64];
} Largest;

/* Choose quantizer steps, in natural order: about `step`, but large enough that quantized coefficients fit in JPEG's 10
 * bits. */
static void choose_steps(unsigned int steps[64], double step, const float largest[64])
{
    for (int i = 0; i < 64; i++) {
        /* steps are integers: if `step` is not, low frequencies get the smaller neighbour */
        const double wanted = rint(step + (i % 8 + i / 8) / 14.0 - 0.5), least = ceil((double)largest[i] / 1023);
        steps[i] = (unsigned int)fmin(fmax(fmax(wanted, least), 1), RETEX_PACK_JPEG_STEP_MAX);
    }
}

/* Copy one YCbCr component of a row of blocks into plane: 8 rows of `blocks` blocks, centred on 0. Pixels beyond the
 * image repeat its last column and row. */
static void gather(float *plane, const float *levels, int width, int height, int channels, int component, int row,
                   int blocks)
{
    for (int y = 0; y < 8; y++) {
        const int from = 8 * row + y < height ? 8 * row + y : height - 1;
        const float *pixel = levels + (size_t)from * (size_t)width * (size_t)channels;
        float *to = plane + (size_t)y * 8 * (size_t)blocks;
        for (int x = 0; x < 8 * blocks; x++) {
            const float *p = pixel + (size_t)(x < width ? x : width - 1) * (size_t)channels;
            if (channels == 1)
                to[x] = p[0] - 128;
            else if (component == 0)
                to[x] = 0.299f * p[0] + 0.587f * p[1] + 0.114f * p[2] - 128;
            else if (component == 1)
                to[x] = -0.168735892f * p[0] - 0.331264108f * p[1] + 0.5f * p[2];
            else
                to[x] = 0.5f * p[0] - 0.418687589f * p[1] - 0.081312411f * p[2];
        }
    }
}

/* Find the largest coefficients; choosing quantizer steps needs them. */
static void find_largest(Largest *largest, const float *levels, float *plane, int width, int height, int channels)
{
    const int rows = (height + 7) / 8, blocks = (width + 7) / 8;
    memset(largest, 0, sizeof *largest);
    for (int c = 0; c < channels; c++)
        for (int row = 0; row < rows; row++) {
            gather(plane, levels, width, height, channels, c, row, blocks);
            for (int block = 0; block < blocks; block++)
                retex_pack_block_largest(largest->size[c > 0], plane + 8 * block, 8 * blocks);
        }
}

static void fill_coefficients(struct jpeg_compress_struct *jpeg, jvirt_barray_ptr *arrays, const float *levels,
                              float *plane, int width, int height, unsigned int steps[2][64])
{
    const int rows = (height + 7) / 8, blocks = (width + 7) / 8;
    float inverse[2][64];
    for (int i = 0; i < 128; i++)
        inverse[i / 64][i % 64] = 1 / (float)steps[i / 64][i % 64];
    for (int c = 0; c < jpeg->num_components; c++)
        for (int row = 0; row < rows; row++) {
            JBLOCKARRAY array = jpeg->mem->access_virt_barray((j_common_ptr)jpeg, arrays[c], (JDIMENSION)row, 1, TRUE);
            gather(plane, levels, width, height, jpeg->num_components, c, row, blocks);
            for (int block = 0; block < blocks; block++)
                retex_pack_block_forward(array[0][block], plane + 8 * block, 8 * blocks, inverse[c > 0]);
        }
}

static int find_slices(RetexPackJpeg *jpeg, int strips)
{
    const unsigned char *p = jpeg->data;
    jpeg->slice_bytes = calloc((size_t)strips + 1, sizeof *jpeg->slice_bytes);
    if (!jpeg->slice_bytes)
        return 0;
    size_t at = 2, begin = 0;
    while (at + 4 <= jpeg->bytes && p[at + 1] != 0xda) /* SOS */
        at += 2 + (size_t)(p[at + 2] << 8 | p[at + 3]);
    at += 2 + (size_t)(p[at + 2] << 8 | p[at + 3]);
    jpeg->slice_bytes[jpeg->nslices++] = at;
    for (begin = at; at + 1 < jpeg->bytes && jpeg->nslices <= strips; at++)
        if (p[at] == 0xff && p[at + 1] != 0) {
            jpeg->slice_bytes[jpeg->nslices++] = at + 2 - begin;
            begin = at + 2;
        }
    return begin == jpeg->bytes && jpeg->nslices == strips + 1;
}

static void write_file(struct jpeg_compress_struct *jpeg, const float *levels, float *plane, int width, int height,
                       int channels, unsigned int steps[2][64])
{
    jvirt_barray_ptr arrays[3];
    const JDIMENSION blocks = (JDIMENSION)(width + 7) / 8, rows = (JDIMENSION)(height + 7) / 8;
    jpeg->image_width = (JDIMENSION)width;
    jpeg->image_height = (JDIMENSION)height;
    jpeg->input_components = channels;
    jpeg->in_color_space = channels == 3 ? JCS_RGB : JCS_GRAYSCALE;
    jpeg_set_defaults(jpeg);
    for (int table = 0; table < (channels == 3 ? 2 : 1); table++)
        jpeg_add_quant_table(jpeg, table, steps[table], 100, TRUE);
    for (int c = 0; c < channels; c++) {
        jpeg->comp_info[c].h_samp_factor = jpeg->comp_info[c].v_samp_factor = 1;
        jpeg->comp_info[c].quant_tbl_no = c > 0;
        arrays[c] = jpeg->mem->request_virt_barray((j_common_ptr)jpeg, JPOOL_IMAGE, TRUE, blocks, rows, 1);
    }
    jpeg->optimize_coding = TRUE;
    jpeg->restart_in_rows = RETEX_PACK_STRIP_ROWS / 8;
    jpeg_write_coefficients(jpeg, arrays);
    fill_coefficients(jpeg, arrays, levels, plane, width, height, steps);
    jpeg_finish_compress(jpeg);
}

int retex_pack_jpeg_encode(RetexPackJpeg *result, const float *levels, int width, int height, int channels, double step,
                           RetexError *err)
{
    struct jpeg_compress_struct jpeg;
    JpegErrors errors;
    unsigned char *volatile data = NULL;
    unsigned long bytes = 0;
    unsigned int steps[2][64];
    memset(result, 0, sizeof *result);
    float *plane = malloc((size_t)((width + 7) / 8) * 64 * sizeof *plane);
    if (!plane)
        return retex_fail(err, RETEX_ENOMEM, "no memory to encode a JPEG");
    Largest largest;
    find_largest(&largest, levels, plane, width, height, channels);
    for (int table = 0; table < 2; table++)
        choose_steps(steps[table], step, largest.size[table]);
    jpeg.err = jpeg_errors_init(&errors);
    if (setjmp(errors.failed)) {
        jpeg_destroy_compress(&jpeg);
        free(plane);
        free(data);
        return retex_fail(err, RETEX_EINTERNAL, "cannot encode a JPEG: %s", errors.message);
    }
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, (unsigned char **)&data, &bytes);
    write_file(&jpeg, levels, plane, width, height, channels, steps);
    jpeg_destroy_compress(&jpeg);
    free(plane);
    result->data = data;
    result->bytes = bytes;
    if (find_slices(result, (height + RETEX_PACK_STRIP_ROWS - 1) / RETEX_PACK_STRIP_ROWS))
        return 0;
    retex_pack_jpeg_free(result);
    return retex_fail(err, RETEX_EINTERNAL, "cannot take a JPEG apart");
}

/* --- decoding --- */

struct RetexPackJpegDecoder {
    struct jpeg_decompress_struct jpeg;
    JpegErrors errors;
    const RetexPackJpegKernels *kernels;
    jvirt_barray_ptr *arrays; /* coefficients of the open strip, or NULL */
    int width, rows, channels;
    RetexPackLevels levels;
    float *planes; /* one row of blocks: three components of 8 rows */
    size_t capacity;
};

int retex_pack_jpeg_decoder_create(RetexPackJpegDecoder **result, RetexError *err)
{
    RetexPackJpegDecoder *decoder = *result = calloc(1, sizeof *decoder);
    if (!decoder)
        return retex_fail(err, RETEX_ENOMEM, "no memory to decode JPEGs");
    decoder->kernels = &retex_pack_jpeg_kernels[retex_cpu_level()];
    decoder->jpeg.err = jpeg_errors_init(&decoder->errors);
    if (setjmp(decoder->errors.failed)) {
        jpeg_destroy_decompress(&decoder->jpeg);
        free(decoder);
        *result = NULL;
        return retex_fail(err, RETEX_ENOMEM, "no memory to decode JPEGs");
    }
    jpeg_create_decompress(&decoder->jpeg);
    return 0;
}

void retex_pack_jpeg_decoder_close(RetexPackJpegDecoder **decoder)
{
    if (!decoder || !*decoder)
        return;
    jpeg_destroy_decompress(&(*decoder)->jpeg);
    free((*decoder)->planes);
    free(*decoder);
    *decoder = NULL;
}

/* Turn header and slice into a JPEG file of one strip: set its height, and replace the final restart marker by EOI. The
 * restart interval is set to 0 if the strip has no restart inside, because libjpeg then decodes faster. */
static int patch(unsigned char *file, size_t header, size_t bytes, int width, int rows)
{
    const int blocks = (width + 7) / 8 * ((rows + 7) / 8);
    int sized = 0;
    if (header < 4 || bytes < header + 2 || file[bytes - 2] != 0xff)
        return 0;
    for (size_t at = 2; at + 9 < header && file[at] == 0xff; at += 2 + (size_t)(file[at + 2] << 8 | file[at + 3])) {
        if (file[at + 1] == 0xc0) { /* SOF0: length, precision, height */
            file[at + 5] = (unsigned char)(rows >> 8);
            file[at + 6] = (unsigned char)(rows & 255);
            sized = 1;
        } else if (file[at + 1] == 0xdd && (file[at + 4] << 8 | file[at + 5]) >= blocks) { /* DRI: length, interval */
            file[at + 4] = file[at + 5] = 0;
        }
    }
    file[bytes - 1] = 0xd9; /* EOI */
    return sized;
}

static void close_strip(RetexPackJpegDecoder *decoder)
{
    jpeg_abort_decompress(&decoder->jpeg);
    decoder->arrays = NULL;
}

static int reserve(RetexPackJpegDecoder *decoder, int width)
{
    const size_t capacity = (size_t)((width + 7) / 8) * 64 * 3;
    float *planes =
        capacity > decoder->capacity ? realloc(decoder->planes, capacity * sizeof *planes) : decoder->planes;
    if (!planes)
        return 0;
    decoder->planes = planes;
    decoder->capacity = capacity > decoder->capacity ? capacity : decoder->capacity;
    return 1;
}

int retex_pack_jpeg_open_strip(RetexPackJpegDecoder *decoder, unsigned char *file, size_t header, size_t bytes,
                               int width, int rows, int channels, const RetexPackCurve *curve, RetexError *err)
{
    struct jpeg_decompress_struct *jpeg = &decoder->jpeg;
    close_strip(decoder);
    if (!patch(file, header, bytes, width, rows))
        return retex_fail(err, RETEX_EFORMAT, "its JPEG has no proper header");
    if (!reserve(decoder, width))
        return retex_fail(err, RETEX_ENOMEM, "no memory to decode JPEGs");
    decoder->width = width;
    decoder->rows = rows;
    decoder->channels = channels;
    decoder->levels = levels_of(curve);
    if (setjmp(decoder->errors.failed)) {
        close_strip(decoder);
        return fail_decoding(&decoder->errors, err);
    }
    jpeg_mem_src(jpeg, file, bytes);
    jpeg_read_header(jpeg, TRUE);
    int ok = jpeg->image_width == (JDIMENSION)width && jpeg->image_height == (JDIMENSION)rows &&
             jpeg->num_components == channels && !jpeg->progressive_mode && !jpeg->arith_code;
    for (int c = 0; ok && c < channels; c++)
        ok = jpeg->comp_info[c].h_samp_factor == 1 && jpeg->comp_info[c].v_samp_factor == 1;
    decoder->arrays = ok ? jpeg_read_coefficients(jpeg) : NULL;
    for (int c = 0; ok && c < channels; c++)
        ok = jpeg->comp_info[c].quant_table != NULL;
    if (ok)
        return 0;
    close_strip(decoder);
    return retex_fail(err, RETEX_EFORMAT, "its JPEG is not of the part's size");
}

int retex_pack_jpeg_decode_blocks(RetexPackJpegDecoder *decoder, int row, float *values, RetexError *err)
{
    struct jpeg_decompress_struct *jpeg = &decoder->jpeg;
    const int width = decoder->width, channels = decoder->channels, blocks = (width + 7) / 8;
    const size_t stride = 8 * (size_t)blocks;
    float steps[64];
    if (!decoder->arrays || row < 0 || 8 * row >= decoder->rows)
        return retex_fail(err, RETEX_EINTERNAL, "no such blocks of a JPEG");
    if (setjmp(decoder->errors.failed)) {
        close_strip(decoder);
        return fail_decoding(&decoder->errors, err);
    }
    for (int c = 0; c < channels; c++) {
        JBLOCKARRAY array =
            jpeg->mem->access_virt_barray((j_common_ptr)jpeg, decoder->arrays[c], (JDIMENSION)row, 1, FALSE);
        for (int i = 0; i < 64; i++)
            steps[i] = (float)jpeg->comp_info[c].quant_table->quantval[i];
        decoder->kernels->inverse(decoder->planes + (size_t)c * 8 * stride, (int)stride, array[0][0], blocks, steps);
    }
    for (int y = 0; y < 8 && 8 * row + y < decoder->rows; y++) {
        const float *p = decoder->planes + (size_t)y * stride;
        float *to = values + (size_t)y * (size_t)width * (size_t)channels;
        if (channels == 3)
            decoder->kernels->colors(to, p, p + 8 * stride, p + 16 * stride, width, &decoder->levels);
        else
            decoder->kernels->greys(to, p, width, &decoder->levels);
    }
    return 0;
}
