/* What a process asks of retex-decode, see decoder.h, and what that says. It gets the picture as its standard input, an
 * open file, and an order by a pipe at RETEX_DECODER_ORDERS. To standard output, a pipe, it writes a reply, and then
 * the pixels. Nothing that it writes is trusted. */
#ifndef RETEX_PICTURE_DECODER_MESSAGES_H
#define RETEX_PICTURE_DECODER_MESSAGES_H

#include <stdint.h>
#include <retex/error.h>

enum { RETEX_DECODER_ORDERS = 3, RETEX_DECODER_WARNINGS = 4 };

/* What is asked of a picture. */
typedef enum RetexDecode {
    RETEX_DECODE_CHECK,  /* whether it can be read */
    RETEX_DECODE_PIXELS, /* floats */
    RETEX_DECODE_ANY,    /* 16-bit integers, or floats where the file has others */
    RETEX_DECODE_NOT     /* standard input has floats: they are to be encoded */
} RetexDecode;

/* Smaller than the smallest buffer of a pipe, so that nobody waits for it to be read. The first members of both
 * messages say which version of them it is. */
typedef struct RetexDecoderOrder {
    uint32_t magic, bytes;
    int32_t parent; /* process */
    int32_t decode; /* a RetexDecode */
    int32_t with_bridge;
    int32_t nthreads;
    uint32_t pixel_bytes; /* these three as of RetexReadParams and its budget */
    int64_t max_pixels, all_pixels;
    uint64_t left;          /* memory that the command has left; UINT64_MAX = any */
    uint64_t memory;        /* that the decoder may take; 0 = any */
    double seconds;         /* of processor time; */
    int32_t accept_damaged; /* as of RetexAccess */
    int32_t has_colorspace;
    char colorspace[256], space_to_load[256]; /* the second: of a file that asked for it */
    char path[1024];                          /* for messages */
    int32_t width, height, quality;           /* of RETEX_DECODE_NOT: of RGB pixels, and as of RetexWriteParams; */
    char format[16], view[64];                /* as of retex_picture_open_memory, and of RetexWriteParams */
} RetexDecoderOrder;

typedef struct RetexDecoderReply {
    uint32_t magic, bytes;
    int32_t code;          /* a RetexCode */
    int32_t misses_bridge; /* 1: to be asked again, with the bridge and this colour space */
    char missed_space[256];
    RetexError error; /* where code is not 0 */
    int32_t nwarnings;
    char warnings[RETEX_DECODER_WARNINGS][1024];
    int32_t is_narrow, width, height; /* of the pixels that follow; 0 x 0 = none do */
    uint64_t file_bytes;              /* of the encoded picture that follows */
} RetexDecoderReply;

enum { RETEX_DECODER_MAGIC = 0x52744432 };

#endif
