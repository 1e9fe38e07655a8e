/* Chunks of an EXR file, one at a time: what reading whole parts and reading rows share. Private to libretex. */
#ifndef RETEX_EXR_DECODE_H
#define RETEX_EXR_DECODE_H

#include "exr/error.h"
#include "exr/io.h"
#include "exr/zip.h"

struct RetexExr {
    RetexExrMessage message; /* first: see error.h */
    RetexInput *input;
    exr_context_t context;
    int nparts;
};

/* How one request is met. */
typedef struct RetexExrPlan {
    RetexExrRequest *request;
    exr_storage_t storage;
    exr_compression_t compression;
    int left, top, width, height; /* data window */
    int chunk_width, chunk_height;
    int across, down; /* chunks */
    int nchannels;    /* of the part; all lie in every chunk */
    const exr_attr_chlist_entry_t *channels;
    int *slot; /* channel of the image that a channel of the part fills, or -1 */
    size_t pixel_bytes;
} RetexExrPlan;

/* Running checksums of a request's channels: one of each for every `lines` lines from line top on. Where a chunk is as
 * wide as the part a channel's samples come in order, and these may be many; else they are those of one line. */
typedef struct RetexExrSums {
    uint32_t (*crc)[RETEX_EXR_LETTERS_MAX];
    int top, lines;
} RetexExrSums;

/* What retex_exr_chunk_read says of a value that is not allowed; Core has no code for it. */
#define RETEX_EXR_NON_FINITE ((exr_result_t)1000)
typedef struct RetexExrNonFinite {
    int x, y, channel; /* in the part, and among its channels */
    float value;
} RetexExrNonFinite;

/* Of one thread. */
typedef struct RetexExrScratch {
    RetexZip zip;
    unsigned char *packed, *raw;
    float *row;
    size_t packed_bytes, raw_bytes, row_count;
    RetexExrNonFinite bad;
} RetexExrScratch;

void retex_exr_data_window(const RetexExr *exr, int part, exr_attr_box2i_t *window); /* empty where there is none */
int retex_exr_fail(RetexExr *exr, exr_result_t code, RetexError *err);
int retex_exr_fail_nonfinite(const RetexExr *exr, int part, const RetexExrNonFinite *bad, RetexError *err);

/* Find out how to meet a request, which plan borrows. */
int retex_exr_plan_open(RetexExr *exr, RetexExrPlan *plan, RetexExrRequest *request, RetexError *err);
void retex_exr_plan_close(RetexExrPlan *plan);

size_t retex_exr_channel_bytes(const exr_attr_chlist_entry_t *channel);

/* Read a chunk, by its place among the part's, into the image (NULL: nowhere), whose first row is row top of the part,
 * and into sums (or NULL), to which chunks of a row must come from the left. Thread-safe, each with its own scratch. */
exr_result_t retex_exr_chunk_read(RetexExr *exr, const RetexExrPlan *plan, int column, int row, RetexImage *image,
                                  int top, const RetexExrSums *sums, RetexExrScratch *scratch);
/* The checksum of lines y0 to y1 of one channel of the request, put together; *bytes (may be NULL): how many they
 * are. */
uint32_t retex_exr_sums_plane(const RetexExrPlan *plan, const RetexExrSums *sums, int slot, int y0, int y1,
                              size_t *bytes);
void retex_exr_scratch_free(RetexExrScratch *scratch);

#endif
