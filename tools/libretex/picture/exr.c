/* EXR of halves, scene-linear unless a colour space is named, for which the bridge is used. The table of chunk offsets
 * precedes the chunks: in a file its place is reserved and written at the end; to a pipe nothing is written before all
 * chunks are there. */
#include <stdlib.h>
#include <string.h>

#include "exr/io.h"
#include "picture/format.h"

enum { LEADER = 8, ENTRY = 8 }; /* bytes before a chunk: its first line and its size; bytes of an entry of the table */

typedef struct ExrState {
    RetexImage shape; /* no pixels */
    RetexExrPart part;
    RetexColorTag color;        /* colours of part; known when the first strip is encoded */
    RetexExrEncoding *encoding; /* for outputs that are not files; or NULL, and: */
    unsigned char *header;      /* everything before the table; made with the first strip */
    size_t header_bytes;
    uint64_t *chunks; /* bytes of each */
    int nchunks;
} ExrState;

static int exr_begin(RetexPicture *picture, RetexError *err)
{
    ExrState *state = calloc(1, sizeof *state);

    if (!state)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    picture->state = state;
    state->shape = (RetexImage){picture->width, picture->height, picture->channels, NULL};
    state->part = (RetexExrPart){.name = "beauty", .type = RETEX_HALF, .image = &state->shape};
    strcpy(state->part.letters, picture->channels == 1 ? "Y" : picture->channels == 3 ? "RGB" : "RGBA");
    state->color = picture->params.is_data ? retex_color_tag_data : retex_color_tag_rec709;
    state->part.color = &state->color;
    if (!retex_output_is_file(picture->path))
        return retex_exr_encoding_open(&state->encoding, &state->part, strcmp(picture->path, "-") != 0, err);
    state->nchunks = (picture->height + RETEX_CHUNK_LINES - 1) / RETEX_CHUNK_LINES;
    state->chunks = calloc((size_t)state->nchunks, sizeof *state->chunks);
    return state->chunks ? 0 : retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
}

/* Fills in the colours that the bridge produces. The interop ID of the space's name has precedence over that of its
 * matrix. */
static void tag_colors(RetexColorTag *tag, const RetexBridgeStored *stored)
{
    const RetexColorTag *known = retex_color_tag_find(stored->interop);

    if (!known && !stored->interop[0] && stored->is_linear)
        known = retex_color_tag_of_matrix(stored->from_rec709);
    *tag = known ? *known : (RetexColorTag){.interop = ""};
    if (!known)
        strcpy(tag->interop, stored->interop);
}

/* Makes the header when the first strip comes, because that waits for the bridge's plan. */
static int make_header(RetexPicture *picture, RetexError *err)
{
    ExrState *state = picture->state;

    if (picture->bridged)
        tag_colors(&state->color, &picture->stored);
    return state->encoding ? 0 : retex_exr_header(&state->header, &state->header_bytes, &state->part, err);
}

static void associate(float *associated, const float *rows, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++)
            associated[4 * i + c] = rows[4 * i + c] * rows[4 * i + 3];
        associated[4 * i + 3] = rows[4 * i + 3];
    }
}

/* Converts pixels to those of the file, where these differ: in the named space, and multiplied by alpha. */
static int convert(const RetexPicture *picture, float **converted, const float *rows, int lines, RetexError *err)
{
    const size_t pixels = (size_t)picture->width * (size_t)lines;

    if (picture->channels != 4 && !picture->bridged)
        return 0;
    *converted = malloc(pixels * (size_t)picture->channels * sizeof **converted);
    if (!*converted)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    if (picture->bridged)
        return retex_bridge_convert(picture->plan, rows, (long)pixels, *converted, err);
    associate(*converted, rows, pixels);
    return 0;
}

static void put_little(unsigned char *to, uint64_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        to[i] = (unsigned char)(value >> 8 * i);
}

/* Encodes the chunks of a strip one after another. Returns their bytes, or 0 where memory is short. */
static size_t make_chunks(ExrState *state, unsigned char *to, int y0, int y1, const float *rows)
{
    RetexChunkScratch scratch = {.zip.zlib.effort = RETEX_ZLIB_FAST};
    size_t at = 0;

    for (int y = y0; y < y1; y += RETEX_CHUNK_LINES) {
        const RetexChunkShape shape = {state->part.letters, RETEX_HALF, state->shape.width,
                                       y1 - y < RETEX_CHUNK_LINES ? y1 - y : RETEX_CHUNK_LINES};
        if (!retex_chunk_reserve(&scratch, &shape)) {
            at = 0;
            break;
        }
        retex_chunk_encode(&scratch, &shape, rows + retex_image_index(&state->shape, 0, y - y0), scratch.raw, NULL);
        const size_t bytes = retex_chunk_compress(&scratch, &shape, 0, scratch.raw, to + at + LEADER);
        put_little(to + at, (uint64_t)y, 4);
        put_little(to + at + 4, bytes, 4);
        state->chunks[y / RETEX_CHUNK_LINES] = LEADER + bytes;
        at += LEADER + bytes;
    }
    retex_chunk_free(&scratch);
    return at;
}

/* Encodes a strip: its chunks, for the first strip preceded by the header and the reserved table. */
static unsigned char *encode_strip(ExrState *state, int y0, int y1, const float *rows, size_t *bytes)
{
    const RetexChunkShape shape = {state->part.letters, RETEX_HALF, state->shape.width, y1 - y0};
    const size_t before = y0 == 0 ? state->header_bytes + ENTRY * (size_t)state->nchunks : 0;
    const size_t leaders = (size_t)((y1 - y0 + RETEX_CHUNK_LINES - 1) / RETEX_CHUNK_LINES) * LEADER;
    unsigned char *encoded = malloc(before + leaders + retex_chunk_bytes(&shape));

    if (!encoded)
        return NULL;
    if (before) {
        memcpy(encoded, state->header, state->header_bytes);
        memset(encoded + state->header_bytes, 0, before - state->header_bytes);
    }
    *bytes = make_chunks(state, encoded + before, y0, y1, rows);
    if (!*bytes) {
        free(encoded);
        return NULL;
    }
    *bytes += before;
    unsigned char *less = realloc(encoded, *bytes);
    return less ? less : encoded;
}

static int exr_strip(RetexPicture *picture, int strip, const float *rows, RetexError *err)
{
    ExrState *state = picture->state;
    const int y0 = strip * RETEX_PICTURE_STRIP, lines = retex_picture_strip_lines(picture, strip);
    float *converted = NULL;
    unsigned char *encoded = NULL;
    size_t bytes = 0;

    int code = picture->bridged ? retex_picture_plan(picture, err) : 0;
    if (!code && strip == 0)
        code = make_header(picture, err);
    if (!code)
        code = convert(picture, &converted, rows, lines, err);
    if (code) {
        free(converted);
        return code;
    }
    rows = converted ? converted : rows;
    if (state->encoding)
        code = retex_exr_encode_rows(state->encoding, y0, y0 + lines, rows, err);
    else if (!(encoded = encode_strip(state, y0, y0 + lines, rows, &bytes)))
        code = retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    free(converted);
    return code ? code : retex_picture_submit_strip(picture, strip, encoded, bytes, err);
}

/* Writes the table of chunk offsets. */
static int write_table(RetexPicture *picture, const ExrState *state, RetexError *err)
{
    const size_t bytes = ENTRY * (size_t)state->nchunks;
    unsigned char *table = malloc(bytes);
    uint64_t at = state->header_bytes + bytes;

    if (!table)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", picture->path);
    for (int i = 0; i < state->nchunks; at += state->chunks[i++])
        put_little(table + ENTRY * (size_t)i, at, ENTRY);
    const int code = retex_output_patch(picture->output, state->header_bytes, table, bytes, err);
    free(table);
    return code;
}

static int exr_finish(RetexPicture *picture, RetexError *err)
{
    ExrState *state = picture->state;

    return state->encoding
               ? retex_exr_write(state->encoding, picture->width, picture->height, NULL, NULL, picture->path, err)
               : write_table(picture, state, err);
}

static void exr_end(RetexPicture *picture)
{
    ExrState *state = picture->state;

    if (!state)
        return;
    retex_exr_encoding_free(&state->encoding);
    free(state->header);
    free(state->chunks);
    free(state);
}

const RetexPictureFormat retex_picture_exr = {exr_begin, exr_strip, exr_finish, exr_end};
