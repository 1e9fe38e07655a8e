/* What a thread decodes a pack with: memory, the slice that was read last, the strips that were decoded. Private to
 * libretex. */
#ifndef RETEX_PACK_SCRATCH_H
#define RETEX_PACK_SCRATCH_H

#include "base/row_span.h"
#include "pack/pack.h"

/* A strip of planes. Their numbers are kept, and one row of samples, which is likelier to be in the processor's cache
 * when it is asked for than a strip of them. Where a part says what matters of others, by its third channel, what that
 * says is kept too. */
typedef struct RetexPackPlaneStrip {
    int strip[RETEX_PACK_CHANNELS_MAX];     /* that a channel's numbers are of; -1: none */
    void *numbers[RETEX_PACK_CHANNELS_MAX]; /* unsigned char where the channel is coded, else int32_t; or NULL */
    int line;                               /* of the strip, that the row is of; -1: none */
    RetexRowSpan span;                      /* beside which the row is 0 */
    int runs_strip;                         /* that what matters is of; -1: none */
    unsigned char *present;
    RetexPackRuns runs; /* of `present` */
} RetexPackPlaneStrip;

/* The strip of a part that was met last. Of a JPEG its coefficients are kept, which are half as many bytes, and one row
 * of blocks at a time. */
typedef struct RetexPackCachedStrip {
    int strip;    /* -1: none */
    uint64_t lit; /* bit y: row y is not all 0; of a JPEG, of those that have been asked for */
    float *rows;  /* the strip's; of a JPEG RETEX_PACK_BLOCK_ROWS of them, of planes one */
    RetexPackPlaneStrip planes;
    RetexPackJpegDecoder *jpeg;
    int blocks;          /* which row of them is there; -1: none */
    unsigned char *mask; /* of the strip, or NULL */
    int is_black;        /* by its mask */
} RetexPackCachedStrip;

typedef struct RetexPackScratch {
    const RetexPack *pack;
    unsigned char *slice; /* as read */
    size_t slice_capacity;
    unsigned char *residuals, *shift;
    size_t pixels; /* of a strip, that there is room for in these two */
    int nparts;
    RetexPackCachedStrip *cached;
} RetexPackScratch;

/* Room for the residuals and shifts of a strip of this part. */
int retex_pack_scratch_reserve(RetexPackScratch *s, const RetexPackPart *p, RetexError *err);
/* Slice k of a part, behind `before` bytes that are there, its checksum compared. */
int retex_pack_read_slice(int part, int k, size_t before, RetexPackScratch *s, RetexError *err);
/* 1 unless all of so many bytes are 0. */
int retex_pack_any_nonzero(const void *data, size_t bytes);

/* Have the numbers of a strip of planes, and say which rows are not all 0. */
int retex_pack_plane_strip_decode(int part, int strip, uint64_t *lit, RetexPackScratch *s, RetexError *err);
/* Have one of these rows, as samples. */
int retex_pack_plane_strip_row(int part, int strip, int line, float *row, RetexRowSpan *span, RetexPackScratch *s,
                               RetexError *err);
void retex_pack_plane_strip_init(RetexPackPlaneStrip *planes);
void retex_pack_plane_strip_free(RetexPackPlaneStrip *planes);

#endif
