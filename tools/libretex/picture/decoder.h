/* The decoder: a small program, retex-decode, that reads one picture in a process of its own. Under safe access all
 * pictures are decoded there: whatever they do to a decoder, this process goes on. It is limited in memory and time,
 * ended when it takes too long, and confined; see tools/decode. It also encodes a picture that must end in time, which
 * formats of other libraries do not promise. */
#ifndef RETEX_PICTURE_DECODER_H
#define RETEX_PICTURE_DECODER_H

#include <retex/image_file.h>

#include "io/input.h"
#include "picture/bridge_load.h"
#include "picture/decoder_messages.h"

/* Pixels of the one kind or of the other. */
typedef struct RetexDecoded {
    RetexNarrowImage narrow;
    RetexImage image;
} RetexDecoded;

/* Have an open file decoded in safe access. params are complete; path is for messages. */
int retex_decoder_run(RetexDecoded *decoded, RetexDecode decode, const RetexInput *input, const char *path,
                      const RetexReadParams *params, int nthreads, RetexError *err);

#endif
