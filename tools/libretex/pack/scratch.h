/* What a thread decodes a pack with: memory, the chunk that was read last, the bands that were decoded. Private to
 * libretex. */
#ifndef RETEX_PACK_SCRATCH_H
#define RETEX_PACK_SCRATCH_H

#include "pack/open.h"

/* A band of planes. Their numbers are kept, and one row of samples, which is likelier to be in the processor's cache
 * when it is asked for than a band of them. Where a part says what matters of others, by its third channel, what that
 * says is kept too. */
typedef struct RetexPackPlaneBand {
    int band[RETEX_PACK_CHANNELS_MAX];      /* that a channel's numbers are of; -1: none */
    void *numbers[RETEX_PACK_CHANNELS_MAX]; /* unsigned char where the channel is coded, else int32_t; or NULL */
    int line;                               /* of the band, that the row is of; -1: none */
    RetexRowSpan span;                      /* beside which the row is 0 */
    int runs_band;                          /* that what matters is of; -1: none */
    unsigned char *present;
    RetexPackRuns runs; /* of `present` */
} RetexPackPlaneBand;

/* The band of a part that was met last. Of a JPEG its coefficients are kept, which are half as many bytes, and one row
 * of blocks at a time. */
typedef struct RetexPackCachedBand {
    int band;     /* -1: none */
    uint64_t lit; /* bit y: row y is not all 0; of a JPEG, of those that have been asked for */
    float *rows;  /* the band's; of a JPEG RETEX_PACK_BLOCK_ROWS of them, of planes one */
    RetexPackPlaneBand planes;
    RetexPackJpegDecoder *jpeg;
    int blocks;          /* which row of them is there; -1: none */
    unsigned char *mask; /* of the band, or NULL */
    int is_black;        /* by its mask */
} RetexPackCachedBand;

struct RetexPackScratch {
    const RetexPack *pack;
    unsigned char *chunk; /* as read */
    size_t chunk_capacity;
    unsigned char *residuals, *shift;
    size_t pixels; /* of a band, that there is room for in these two */
    int nparts;
    RetexPackCachedBand *cached;
};

/* Room for the residuals and shifts of a band of this part. */
int retex_pack_scratch_reserve(RetexPackScratch *s, const RetexPackPart *p, RetexError *err);
/* Chunk k of a part, behind `before` bytes that are there, its checksum compared. */
int retex_pack_read_chunk(int part, int k, size_t before, RetexPackScratch *s, RetexError *err);
/* 1 unless all of so many bytes are 0. */
int retex_pack_any_nonzero(const void *data, size_t bytes);

/* Have the numbers of a band of planes, and say which rows are not all 0. */
int retex_pack_plane_band_decode(int part, int band, uint64_t *lit, RetexPackScratch *s, RetexError *err);
/* Have one of these rows, as samples. */
int retex_pack_plane_band_row(int part, int band, int line, float *row, RetexRowSpan *span, RetexPackScratch *s,
                              RetexError *err);
void retex_pack_plane_band_init(RetexPackPlaneBand *planes);
void retex_pack_plane_band_free(RetexPackPlaneBand *planes);

#endif
