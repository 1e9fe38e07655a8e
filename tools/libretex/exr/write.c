/* Writes multi-part EXR files.
 *
 * First all chunks are converted, checksummed and compressed on all threads, in bands of 16 lines. Then the file is
 * written front to back. OpenEXRCore writes the header and the chunks. The table of chunk offsets, for which Core seeks
 * back at the end, is computed from the known sizes and written in its place, so that the output may be a pipe. The
 * table that Core writes at the end is compared with it. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <retex/parallel.h>

#include "io/checksum.h"
#include "exr/chunk.h"
#include "exr/error.h"
#include "exr/io.h"
#include "io/output.h"
#include "exr/band_store_chunks.h"
#include "exr/stored.h"

typedef struct Band {
    int part, first_line, lines;
    unsigned char *data;               /* the encoded band; NULL: fetched from where it is when it is written */
    const RetexBandStoreChunk *stored; /* or NULL */
    uint64_t offset;                   /* of a chunk that is copied */
    size_t bytes;
    int wide;                            /* 1: PXR24 would lose bits of its floats */
    uint32_t crc[RETEX_EXR_LETTERS_MAX]; /* checksum of this band of each plane, in the order of letters */
} Band;

struct RetexExrEncoding {
    RetexExrPart *parts; /* a copy */
    char *pxr24;         /* by part: 1 = compressed by PXR24, 0 = by ZIP */
    int nparts;
    RetexExrCompression compress;
    RetexChunkScratch scratch; /* for bands that are fetched */
    unsigned char *packed;
    size_t packed_bytes;
    Band *bands;
    int nbands;
};

typedef struct EncodeWork {
    RetexExrEncoding *encoding;
    RetexChunkScratch *scratch; /* one a thread */
    int *failed;                /* one a band: a RetexCode */
} EncodeWork;

static RetexChunkShape band_shape(const RetexExrPart *part, const Band *band)
{
    return (RetexChunkShape){part->letters, part->type, part->image->width, band->lines};
}

/* Compresses the chunk in scratch->raw. */
static void pack_band(Band *band, const RetexChunkShape *shape, int pxr24, RetexChunkScratch *scratch)
{
    band->bytes = retex_chunk_compress(scratch, shape, pxr24, scratch->raw, band->data);
    unsigned char *less = realloc(band->data, band->bytes);
    if (less)
        band->data = less;
}

static int encode_band(Band *band, const RetexExrPart *part, const float *pixels, int compress, int pxr24,
                       RetexChunkScratch *scratch)
{
    const RetexChunkShape shape = band_shape(part, band);

    band->bytes = retex_chunk_bytes(&shape);
    band->data = malloc(band->bytes);
    if (!band->data || !retex_chunk_reserve(scratch, &shape))
        return 0;
    retex_chunk_encode(scratch, &shape, pixels, compress ? scratch->raw : band->data, band->crc);
    if (compress)
        pack_band(band, &shape, pxr24, scratch);
    return 1;
}

/* Encodes a band that is 0 everywhere. */
static int encode_zero_band(Band *band, const RetexChunkShape *shape, int compress, int pxr24,
                            RetexChunkScratch *scratch)
{
    const int channels = (int)strlen(shape->letters);

    band->bytes = retex_chunk_bytes(shape);
    if (!retex_chunk_reserve(scratch, shape))
        return 0;
    memset(scratch->raw, 0, band->bytes);
    for (int c = 0; c < channels; c++)
        band->crc[c] = c ? band->crc[0] : retex_crc32(CRC32_OF_NONE, scratch->raw, retex_chunk_plane(shape));
    if (!compress)
        return 1;
    band->data = malloc(band->bytes);
    if (band->data)
        pack_band(band, shape, pxr24, scratch);
    return band->data != NULL;
}

/* A band of the band store in a part whose other bands PXR24 cannot store. */
static int encode_band_again(Band *band, const RetexExrPart *part, const RetexChunkShape *shape,
                             RetexChunkScratch *scratch)
{
    const size_t bytes = retex_chunk_bytes(shape);
    RetexError ignored;

    band->bytes = bytes;
    band->data = malloc(bytes);
    if (!band->data || !retex_chunk_reserve(scratch, shape) ||
        retex_band_store_read(part->store, band->stored, band->data, &ignored) ||
        !retex_chunk_decompress(scratch, shape, 1, band->data, band->stored->bytes, scratch->raw))
        return 0;
    pack_band(band, shape, 0, scratch);
    return 1;
}

/* For a band in the band store only the size is needed at first. */
static int encode_stored_band(Band *band, const RetexExrPart *part, int compress, int pxr24, RetexChunkScratch *scratch)
{
    const RetexChunkShape shape = band_shape(part, band);

    if (!band->stored->bytes)
        return encode_zero_band(band, &shape, compress, pxr24, scratch);
    memcpy(band->crc, band->stored->crc, sizeof band->crc);
    if (compress && band->stored->pxr24 && !pxr24)
        return encode_band_again(band, part, &shape, scratch);
    band->bytes = compress ? band->stored->bytes : retex_chunk_bytes(&shape);
    return 1;
}

/* Finds out whether PXR24 can store a band. */
static void look_job(void *context, int index, int thread)
{
    EncodeWork *work = context;
    Band *band = &work->encoding->bands[index];
    const RetexExrPart *part = &work->encoding->parts[band->part];
    const RetexChunkShape shape = band_shape(part, band);

    (void)thread;
    if (part->stored)
        return;
    if (band->stored)
        band->wide = band->stored->bytes && !band->stored->pxr24;
    else
        band->wide = !retex_chunk_fits_pxr24(
            &shape, (const unsigned char *)(part->image->pixels + retex_image_index(part->image, 0, band->first_line)));
}

/* A part is compressed by PXR24 if it is of floats and loses nothing. */
static void choose_compression(EncodeWork *work, int nthreads)
{
    RetexExrEncoding *encoding = work->encoding;

    retex_parallel(nthreads, encoding->nbands, look_job, work);
    for (int i = 0; i < encoding->nparts; i++)
        encoding->pxr24[i] = encoding->parts[i].stored ? encoding->parts[i].stored->pxr24
                                                       : encoding->compress && encoding->parts[i].type == RETEX_FLOAT;
    for (int i = 0; i < encoding->nbands; i++)
        if (encoding->bands[i].wide)
            encoding->pxr24[encoding->bands[i].part] = 0;
}

static void encode_job(void *context, int index, int thread)
{
    EncodeWork *work = context;
    Band *band = &work->encoding->bands[index];
    const RetexExrPart *part = &work->encoding->parts[band->part];
    const int compress = work->encoding->compress, pxr24 = work->encoding->pxr24[band->part];

    int encoded;

    if (part->stored) { /* only its size is needed */
        if (!retex_exr_stored_chunk(part->stored, band->first_line, &band->offset, &band->bytes))
            work->failed[index] = RETEX_EFORMAT;
        return;
    }
    if (band->stored)
        encoded = encode_stored_band(band, part, compress, pxr24, &work->scratch[thread]);
    else
        encoded = encode_band(band, part, part->image->pixels + retex_image_index(part->image, 0, band->first_line),
                              compress, pxr24, &work->scratch[thread]);
    if (!encoded)
        work->failed[index] = RETEX_ENOMEM;
}

/* Combines the bands' checksums: planes one after another, each from the top. */
static uint32_t part_crc(const RetexExrEncoding *encoding, int part, const Band *first)
{
    const RetexExrPart *of = &encoding->parts[part];
    uint32_t crc = CRC32_OF_NONE;

    if (of->stored)
        return of->stored->crc;
    for (int c = 0; c < of->image->channels; c++)
        for (const Band *band = first; band < encoding->bands + encoding->nbands && band->part == part; band++) {
            const RetexChunkShape shape = band_shape(of, band);
            crc = retex_crc32_join(crc, band->crc[c], retex_chunk_plane(&shape));
        }
    return crc;
}

uint32_t *retex_exr_band_crcs(const RetexExrEncoding *encoding, int part)
{
    const RetexExrPart *of = &encoding->parts[part];
    const int lines = RETEX_CHUNK_LINES, count = (of->image->height + lines - 1) / lines;
    const Band *band = encoding->bands;
    uint32_t *crcs = calloc((size_t)count, sizeof *crcs);

    if (crcs && of->stored)
        return memcpy(crcs, of->stored->bands, (size_t)count * sizeof *crcs);
    while (band->part != part)
        band++;
    for (int i = 0; crcs && i < count; i++, band++) {
        const RetexChunkShape shape = band_shape(of, band);
        crcs[i] = CRC32_OF_NONE;
        for (int c = 0; c < of->image->channels; c++)
            crcs[i] = retex_crc32_join(crcs[i], band->crc[c], retex_chunk_plane(&shape));
    }
    return crcs;
}

/* Checks the parts; rows_later: 1 = images have no pixels yet. */
static int check_parts(const RetexExrPart *parts, int nparts, int rows_later, RetexError *err)
{
    if (nparts < 1 || nparts > RETEX_EXR_PARTS_MAX)
        return retex_fail(err, RETEX_EINVAL, "an EXR file of %d parts cannot be written (1 to %d can)", nparts,
                          RETEX_EXR_PARTS_MAX);
    for (int i = 0; i < nparts; i++) {
        const RetexImage *image = parts[i].image;
        if (!image || (!image->pixels && !parts[i].store && !parts[i].stored && !rows_later) ||
            (size_t)image->channels != strlen(parts[i].letters))
            return retex_fail(err, RETEX_EINVAL, "part %s has no image, or one whose channels are not %s",
                              parts[i].name, parts[i].letters);
        for (int j = 0; j < i; j++)
            if (strcmp(parts[i].name, parts[j].name) == 0)
                return retex_fail(err, RETEX_EINVAL, "two parts are named %s", parts[i].name);
    }
    return 0;
}

static int lay_out_bands(RetexExrEncoding *encoding, RetexError *err)
{
    int count = 0;

    for (int i = 0; i < encoding->nparts; i++)
        count += (encoding->parts[i].image->height + RETEX_CHUNK_LINES - 1) / RETEX_CHUNK_LINES;
    encoding->bands = calloc((size_t)count, sizeof *encoding->bands);
    if (!encoding->bands)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file");
    for (int i = 0; i < encoding->nparts; i++) {
        const int height = encoding->parts[i].image->height;
        for (int y = 0; y < height; y += RETEX_CHUNK_LINES) {
            Band *band = &encoding->bands[encoding->nbands++];
            band->part = i;
            if (encoding->parts[i].store && !encoding->parts[i].image->pixels)
                band->stored = retex_band_store_chunk(encoding->parts[i].store, encoding->parts[i].store_image,
                                                      y / RETEX_CHUNK_LINES);
            band->first_line = y;
            band->lines = height - y < RETEX_CHUNK_LINES ? height - y : RETEX_CHUNK_LINES;
        }
    }
    return 0;
}

static int encode_bands(RetexExrEncoding *encoding, int nthreads, RetexError *err)
{
    EncodeWork work = {encoding, NULL, NULL};
    const RetexExrStored *damaged = NULL;
    int failed = 0;

    nthreads = retex_threads(nthreads);
    work.scratch = calloc((size_t)nthreads, sizeof *work.scratch);
    work.failed = calloc((size_t)encoding->nbands, sizeof *work.failed);
    for (int i = 0; work.scratch && i < nthreads; i++)
        work.scratch[i].zip.zlib.effort = encoding->compress == RETEX_EXR_QUICKLY ? RETEX_ZLIB_HURRY : RETEX_ZLIB_SMALL;
    if (work.scratch && work.failed) {
        choose_compression(&work, nthreads);
        retex_parallel(nthreads, encoding->nbands, encode_job, &work);
    } else {
        failed = RETEX_ENOMEM;
    }
    for (int i = 0; !failed && i < encoding->nbands; i++) {
        failed = work.failed[i];
        damaged = encoding->parts[encoding->bands[i].part].stored;
    }
    for (int i = 0; work.scratch && i < nthreads; i++)
        retex_chunk_free(&work.scratch[i]);
    free(work.scratch);
    free(work.failed);
    if (failed == RETEX_EFORMAT)
        return retex_exr_stored_fail(damaged, err);
    return failed ? retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file") : 0;
}

static int open_encoding(RetexExrEncoding **result, const RetexExrPart *parts, int nparts, RetexExrCompression compress,
                         RetexError *err)
{
    *result = NULL;
    RetexExrEncoding *encoding = calloc(1, sizeof *encoding);
    if (!encoding || !(encoding->parts = calloc((size_t)nparts, sizeof *parts)) ||
        !(encoding->pxr24 = calloc((size_t)nparts, 1))) {
        free(encoding ? encoding->parts : NULL);
        free(encoding);
        return retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file");
    }
    memcpy(encoding->parts, parts, (size_t)nparts * sizeof *parts);
    encoding->nparts = nparts;
    encoding->compress = compress;
    const int code = lay_out_bands(encoding, err);
    if (code)
        retex_exr_encoding_free(&encoding);
    *result = encoding;
    return code;
}

int retex_exr_encode(RetexExrEncoding **result, RetexExrPart *parts, int nparts, RetexExrCompression compress,
                     int nthreads, RetexError *err)
{
    RetexExrEncoding *encoding = NULL;
    int code = check_parts(parts, nparts, 0, err);

    *result = NULL;
    if (!code)
        code = open_encoding(&encoding, parts, nparts, compress, err);
    if (!code)
        code = encode_bands(encoding, nthreads, err);
    if (code) {
        retex_exr_encoding_free(&encoding);
        return code;
    }
    for (int i = 0, band = 0; i < nparts; i++) {
        parts[i].crc = part_crc(encoding, i, &encoding->bands[band]);
        while (band < encoding->nbands && encoding->bands[band].part == i)
            band++;
    }
    *result = encoding;
    return 0;
}

int retex_exr_encoding_open(RetexExrEncoding **result, const RetexExrPart *part, int compress, RetexError *err)
{
    const int code = check_parts(part, 1, 1, err);

    *result = NULL;
    return code ? code : open_encoding(result, part, 1, compress, err);
}

int retex_exr_encode_rows(RetexExrEncoding *encoding, int y0, int y1, const float *rows, RetexError *err)
{
    const RetexExrPart *part = &encoding->parts[0];
    RetexChunkScratch scratch = {.raw = NULL};
    int encoded = 1;

    for (int y = y0; y < y1 && encoded; y += RETEX_CHUNK_LINES)
        encoded = encode_band(&encoding->bands[y / RETEX_CHUNK_LINES], part,
                              rows + retex_image_index(part->image, 0, y - y0), encoding->compress, 0, &scratch);
    retex_chunk_free(&scratch);
    return encoded ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file");
}

void retex_exr_encoding_free(RetexExrEncoding **result)
{
    RetexExrEncoding *encoding = result ? *result : NULL;

    if (!encoding)
        return;
    for (int i = 0; i < encoding->nbands; i++)
        free(encoding->bands[i].data);
    retex_chunk_free(&encoding->scratch);
    free(encoding->packed);
    free(encoding->bands);
    free(encoding->pxr24);
    free(encoding->parts);
    free(encoding);
    *result = NULL;
}

/* User data of Core's write context. */
typedef struct Sink {
    RetexOutput *output;
    RetexError error;  /* the error of the output, with more detail than Core's */
    uint64_t position; /* bytes written so far */
    uint64_t *table;   /* offsets of all chunks; relative to table_end until they are written */
    uint64_t table_start, table_bytes;
    int table_sent;
} Sink;

static int send_bytes(Sink *sink, const void *data, uint64_t bytes)
{
    if (sink->error.code || retex_output_write(sink->output, data, (size_t)bytes, &sink->error))
        return 0;
    sink->position += bytes;
    return 1;
}

static int send_table(Sink *sink)
{
    sink->table_start = sink->position;
    for (uint64_t i = 0; i < sink->table_bytes / sizeof *sink->table; i++)
        sink->table[i] += sink->table_start + sink->table_bytes;
    sink->table_sent = 1;
    return send_bytes(sink, sink->table, sink->table_bytes);
}

/* Core's write callback: sequential, but for a gap where the table belongs, and the table itself at the end. */
static int64_t sink_write(exr_const_context_t context, void *data, const void *buffer, uint64_t bytes, uint64_t offset,
                          exr_stream_error_func_ptr_t report)
{
    Sink *sink = data;

    (void)context;
    (void)report;
    if (!sink->table_sent && offset == sink->position + sink->table_bytes && !send_table(sink))
        return -1;
    if (sink->table_sent && offset < sink->position) {
        const uint64_t end = sink->table_start + sink->table_bytes;
        if (offset >= sink->table_start && offset <= end && bytes <= end - offset &&
            memcmp((const unsigned char *)sink->table + (offset - sink->table_start), buffer, (size_t)bytes) == 0)
            return (int64_t)bytes;
    }
    if (offset != sink->position) {
        if (!sink->error.code)
            retex_fail(&sink->error, RETEX_EINTERNAL, "the EXR file was laid out in an unexpected order");
        return -1;
    }
    return send_bytes(sink, buffer, bytes) ? (int64_t)bytes : -1;
}

/* The number of chunks in a band: uncompressed, every line is a chunk. */
static int band_chunks(const RetexExrEncoding *encoding, const Band *band)
{
    return encoding->compress ? 1 : band->lines;
}

/* Computes the offset of every chunk, counted from the table's end. */
static int plan_table(Sink *sink, const RetexExrEncoding *encoding, RetexError *err)
{
    const uint64_t leader = encoding->nparts > 1 ? 12 : 8; /* (part number,) line, size */
    uint64_t offset = 0;
    size_t count = 0, next = 0;

    for (int i = 0; i < encoding->nbands; i++)
        count += (size_t)band_chunks(encoding, &encoding->bands[i]);
    sink->table = malloc(count * sizeof *sink->table);
    if (!sink->table)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file");
    sink->table_bytes = count * sizeof *sink->table;
    for (int i = 0; i < encoding->nbands; i++) {
        const Band *band = &encoding->bands[i];
        const int chunks = band_chunks(encoding, band);
        for (int chunk = 0; chunk < chunks; chunk++) {
            sink->table[next++] = offset;
            offset += leader + band->bytes / (unsigned)chunks;
        }
    }
    return 0;
}

static exr_result_t declare_color(exr_context_t context, int part, const RetexColorTag *tag)
{
    const float *c = tag->chromaticities;
    const exr_attr_chromaticities_t chromaticities = {c[0], c[1], c[2], c[3], c[4], c[5], c[6], c[7]};
    exr_result_t code = EXR_ERR_SUCCESS;

    if (tag->has_chromaticities)
        code = exr_attr_set_chromaticities(context, part, "chromaticities", &chromaticities);
    if (!code && tag->interop[0])
        code = exr_attr_set_string(context, part, "colorInteropID", tag->interop);
    return code;
}

static exr_result_t declare_part(exr_context_t context, const RetexExrEncoding *encoding, int index,
                                 const exr_attr_box2i_t *display)
{
    const RetexExrPart *part = &encoding->parts[index];
    const exr_attr_box2i_t data = {.max = {.x = part->image->width - 1, .y = part->image->height - 1}};
    const exr_attr_v2f_t center = {.x = 0, .y = 0};
    exr_result_t code;
    int number;

    code = exr_add_part(context, part->name, EXR_STORAGE_SCANLINE, &number);
    if (!code)
        code = exr_initialize_required_attr(context, number, display, &data, 1.0f, &center, 1.0f,
                                            EXR_LINEORDER_INCREASING_Y,
                                            !encoding->compress                         ? EXR_COMPRESSION_NONE
                                            : encoding->pxr24 && encoding->pxr24[index] ? EXR_COMPRESSION_PXR24
                                                                                        : EXR_COMPRESSION_ZIP);
    for (const char *letter = part->letters; *letter && !code; letter++) {
        char channel[RETEX_EXR_NAME_MAX + 2];
        if (index == 0)
            snprintf(channel, sizeof channel, "%c", *letter);
        else
            snprintf(channel, sizeof channel, "%s.%c", part->name, *letter);
        code = exr_add_channel(context, number, channel, part->type == RETEX_HALF ? EXR_PIXEL_HALF : EXR_PIXEL_FLOAT,
                               EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    }
    if (!code && part->color)
        code = declare_color(context, number, part->color);
    return code;
}

/* Fetches a band from the band store, or from the file where it is stored, into the encoding's own memory. */
static const unsigned char *fetch_band(RetexExrEncoding *encoding, const Band *band, RetexError *err)
{
    const RetexExrPart *part = &encoding->parts[band->part];
    const RetexChunkShape shape = band_shape(part, band);
    const size_t bytes = retex_chunk_bytes(&shape);

    if (encoding->packed_bytes < bytes) {
        free(encoding->packed);
        encoding->packed = malloc(bytes);
        encoding->packed_bytes = encoding->packed ? bytes : 0;
    }
    if (!encoding->packed || !retex_chunk_reserve(&encoding->scratch, &shape)) {
        retex_fail(err, RETEX_ENOMEM, "no memory to write an EXR file");
        return NULL;
    }
    if (part->stored)
        return retex_exr_stored_read(part->stored, band->offset, band->bytes, encoding->packed, err) ? NULL
                                                                                                     : encoding->packed;
    if (!band->stored->bytes)
        return memset(encoding->packed, 0, bytes);
    if (retex_band_store_read(part->store, band->stored, encoding->packed, err))
        return NULL;
    if (encoding->compress)
        return encoding->packed;
    if (retex_chunk_decompress(&encoding->scratch, &shape, band->stored->pxr24, encoding->packed, band->stored->bytes,
                               encoding->scratch.raw))
        return encoding->scratch.raw;
    retex_fail(err, RETEX_EFORMAT, "the temporary file is damaged");
    return NULL;
}

static exr_result_t write_chunks(exr_context_t context, RetexExrEncoding *encoding, RetexError *err)
{
    exr_result_t code = EXR_ERR_SUCCESS;

    for (int i = 0; i < encoding->nbands && !code; i++) {
        Band *band = &encoding->bands[i];
        const int chunks = band_chunks(encoding, band);
        const size_t bytes = band->bytes / (unsigned)chunks;
        const unsigned char *data = band->data ? band->data : fetch_band(encoding, band, err);
        if (!data)
            return EXR_ERR_WRITE_IO;
        for (int chunk = 0; chunk < chunks && !code; chunk++)
            code = exr_write_scanline_chunk(context, band->part, band->first_line + chunk, data + (size_t)chunk * bytes,
                                            bytes);
        free(band->data);
        band->data = NULL;
    }
    return code;
}

static exr_result_t write_file(exr_context_t context, RetexExrEncoding *encoding, int width, int height,
                               const char *attribute, const char *value, RetexError *err)
{
    const exr_attr_box2i_t display = {.max = {.x = width - 1, .y = height - 1}};
    exr_result_t code = EXR_ERR_SUCCESS;
    int long_names = 0;

    for (int i = 0; i < encoding->nparts; i++)
        long_names |= strlen(encoding->parts[i].name) > 29; /* 31 with ".R" */
    if (long_names)
        code = exr_set_longname_support(context, 1);
    for (int i = 0; i < encoding->nparts && !code; i++)
        code = declare_part(context, encoding, i, &display);
    if (!code && attribute)
        code = exr_attr_set_string(context, 0, attribute, value);
    if (!code)
        code = exr_write_header(context);
    if (!code)
        code = write_chunks(context, encoding, err);
    return code;
}

int retex_exr_write(RetexExrEncoding *encoding, int width, int height, const char *attribute, const char *value,
                    const char *path, RetexError *err)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    Sink sink = {.output = NULL};
    exr_context_t context = NULL;
    exr_result_t code;
    int status;

    settings.error_handler_fn = retex_exr_no_message;
    settings.user_data = &sink;
    settings.write_fn = sink_write;
    status = plan_table(&sink, encoding, err);
    if (!status)
        status = retex_output_open(&sink.output, path, err);
    if (status) {
        free(sink.table);
        return status;
    }
    code = exr_start_write(&context, path, EXR_WRITE_FILE_DIRECTLY, &settings);
    if (!code)
        code = write_file(context, encoding, width, height, attribute, value, &sink.error);
    if (context) {
        const exr_result_t finished = exr_finish(&context);
        code = code ? code : finished;
    }
    if (sink.error.code)
        status = retex_fail(err, sink.error.code, "%s", sink.error.message);
    else if (code)
        status = retex_exr_fail_write(code, path, err);
    if (status)
        retex_output_abandon(&sink.output);
    else
        status = retex_output_commit(&sink.output, err);
    free(sink.table);
    return status;
}

/* ---- the header alone ---- */

/* User data of its write context. */
typedef struct HeaderSink {
    unsigned char *bytes;
    size_t count;
    int starved; /* 1: out of memory */
} HeaderSink;

static int64_t keep_header(exr_const_context_t context, void *data, const void *buffer, uint64_t bytes, uint64_t offset,
                           exr_stream_error_func_ptr_t report)
{
    HeaderSink *sink = data;
    (void)context;
    (void)report;
    if (offset != sink->count)
        return -1;
    unsigned char *more = realloc(sink->bytes, sink->count + (size_t)bytes + 1);
    if (!more) {
        sink->starved = 1;
        return -1;
    }
    sink->bytes = more;
    memcpy(more + sink->count, buffer, (size_t)bytes);
    sink->count += (size_t)bytes;
    return (int64_t)bytes;
}

int retex_exr_header(unsigned char **header, size_t *bytes, const RetexExrPart *part, RetexError *err)
{
    exr_context_initializer_t settings = EXR_DEFAULT_CONTEXT_INITIALIZER;
    HeaderSink sink = {.bytes = NULL};
    RetexExrEncoding encoding = {.parts = (RetexExrPart *)part, .nparts = 1, .compress = 1};
    exr_context_t context = NULL;

    settings.error_handler_fn = retex_exr_no_message;
    settings.user_data = &sink;
    settings.write_fn = keep_header;
    exr_result_t code = exr_start_write(&context, "header", EXR_WRITE_FILE_DIRECTLY, &settings);
    if (!code)
        code = write_file(context, &encoding, part->image->width, part->image->height, NULL, NULL, err);
    *header = sink.bytes;
    *bytes = sink.count;
    if (context)
        exr_finish(&context); /* the file lacks its chunks, but the header has been received */
    if (!code)
        return 0;
    free(*header);
    *header = NULL;
    return retex_exr_fail_write(sink.starved ? EXR_ERR_OUT_OF_MEMORY : code, "an EXR file's header", err);
}
