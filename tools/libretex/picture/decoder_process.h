/* A process of retex-decode as its parent sees it: started with a picture and an order, listened to within
 * limits of time and memory, and ended. Nothing that it says is trusted. */
#ifndef RETEX_PICTURE_DECODER_PROCESS_H
#define RETEX_PICTURE_DECODER_PROCESS_H

#include <sys/types.h>

#include <retex/budget.h>

#include "picture/decoder_messages.h"

typedef struct RetexDecoderProcess {
    const RetexDecoderOrder *order;
    const RetexBudget *budget;
    pid_t pid;
    int from;     /* its output */
    double until; /* of the clock */
    int counter;  /* where its memory is counted; below 0 = nowhere */
} RetexDecoderProcess;

/* Start one, which may take so many seconds by the clock. picture: a descriptor, or below 0 with errno set; it is
 * closed. Whether this fails or not, retex_decoder_stop ends what there is. */
int retex_decoder_start(RetexDecoderProcess *decoder, const RetexDecoderOrder *order, const RetexBudget *budget,
                        int picture, double seconds, RetexError *err);

/* Take so many bytes of what it says. */
int retex_decoder_take(RetexDecoderProcess *decoder, void *to, size_t bytes, RetexError *err);
/* Take its reply, checked and with clean texts. */
int retex_decoder_take_reply(RetexDecoderProcess *decoder, RetexDecoderReply *reply, RetexError *err);
/* All decoders, and `more` bytes of this process, must keep within what is left. Of several the largest gives way. */
int retex_decoder_check_memory(const RetexDecoderProcess *decoder, uint64_t more, RetexError *err);

void retex_decoder_stop(RetexDecoderProcess *decoder);

int retex_decoder_fail_memory(const RetexDecoderOrder *order, RetexError *err);
int retex_decoder_fail_nonsense(const RetexDecoderOrder *order, RetexError *err);

/* A copy of a descriptor beyond those that the decoder has as its own. */
int retex_decoder_copy_high(int file);

#endif
