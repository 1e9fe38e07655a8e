/* Decoding one chunk of an EXR file: shared by reading whole parts and reading rows. Private to libretex. */
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

/* A request with the layout of its part. */
typedef struct RetexExrPlan {
    RetexExrRequest *request;
    exr_storage_t storage;
    exr_compression_t compression;
    int left, top, width, height; /* data window */
    int chunk_width, chunk_height;
    int across, down; /* number of chunks across and down */
    int nchannels;    /* channels of the part, all of which are in every chunk */
    const exr_attr_chlist_entry_t *channels;
    int *image_channel; /* by channel of the part: the image's channel, or -1 */
    size_t pixel_bytes;
} RetexExrPlan;

/* Running checksums of a request's channels: one for each channel and each `lines` lines, from line top on. Where a
 * chunk is as wide as the part a channel's samples come in order, and `lines` may be any number; else it must be 1. */
typedef struct RetexExrSums {
    uint32_t (*crc)[RETEX_EXR_LETTERS_MAX];
    int top, lines;
} RetexExrSums;

/* The code of retex_exr_chunk_read for a value that is not allowed; OpenEXRCore has none. */
#define RETEX_EXR_NON_FINITE ((exr_result_t)1000)
typedef struct RetexExrNonFinite {
    int x, y, channel; /* pixel in the part; number of the channel in the part */
    float value;
} RetexExrNonFinite;

/* Scratch memory of one thread. */
typedef struct RetexExrScratch {
    RetexZip zip;
    unsigned char *packed, *raw;
    float *rows; /* planes of a line */
    size_t packed_bytes, raw_bytes, rows_count;
    RetexExrNonFinite bad;
} RetexExrScratch;

void retex_exr_data_window(const RetexExr *exr, int part, exr_attr_box2i_t *window); /* empty where the part has none */
int retex_exr_fail(RetexExr *exr, exr_result_t code, RetexError *err);
int retex_exr_fail_nonfinite(const RetexExr *exr, int part, const RetexExrNonFinite *bad, RetexError *err);

/* Check a request and make a plan for it; the plan borrows the request. */
int retex_exr_plan_open(RetexExr *exr, RetexExrPlan *plan, RetexExrRequest *request, RetexError *err);
void retex_exr_plan_close(RetexExrPlan *plan);

size_t retex_exr_channel_bytes(const exr_attr_chlist_entry_t *channel);

/* Read and decompress the chunk at (column, row) among the part's chunks, of *width x *height pixels: line by line, in
 * each line channel by channel, in *samples, which scratch owns. Thread-safe, each thread with its own scratch. */
exr_result_t retex_exr_chunk_samples(RetexExr *exr, const RetexExrPlan *plan, int column, int row,
                                     RetexExrScratch *scratch, const unsigned char **samples, int *width, int *height);
/* Read the chunk at (column, row) among the part's chunks into the image (NULL: nowhere), whose first row is row top of
 * the part, and update sums (or NULL), for which chunks of a row must come from the left. Thread-safe, each thread with
 * its own scratch. */
exr_result_t retex_exr_chunk_read(RetexExr *exr, const RetexExrPlan *plan, int column, int row, RetexImage *image,
                                  int top, const RetexExrSums *sums, RetexExrScratch *scratch);
/* The checksum of lines y0 to y1 of one channel of the request; *bytes (may be NULL) receives how many bytes they
 * are. */
uint32_t retex_exr_sums_plane(const RetexExrPlan *plan, const RetexExrSums *sums, int to, int y0, int y1,
                              size_t *bytes);
void retex_exr_scratch_free(RetexExrScratch *scratch);

#endif
