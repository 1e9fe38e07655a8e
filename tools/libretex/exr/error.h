/* Messages of OpenEXRCore, kept for each file until the call that caused them fails. */
#ifndef RETEX_EXR_ERROR_H
#define RETEX_EXR_ERROR_H

#include <pthread.h>
#include <stdlib.h>
#include <openexr.h>
#include <retex/error.h>

/* The first message about a file that is read; several threads may report. First member of the context's user data,
 * where the callback finds it. */
typedef struct RetexExrMessage {
    pthread_mutex_t lock;
    char text[256];
} RetexExrMessage;

void retex_exr_message(exr_const_context_t context, exr_result_t code, const char *text);

/* For a file that is written. Core holds its lock while it reports there, so asking for the user data would deadlock;
 * the code is enough. */
void retex_exr_no_message(exr_const_context_t context, exr_result_t code, const char *text);
/* Fill err with the failure of a file that is written. */
int retex_exr_fail_write(exr_result_t code, const char *path, RetexError *err);

/* OpenEXRCore's allocator: memory is zeroed, so that a damaged chunk never shows old data, and limited, so that a
 * damaged size is refused. */
void *retex_exr_alloc(size_t bytes);
/* 1 if the machine had no memory for one of these in this thread since this was asked last. Core tells it as damage in
 * some places, and in others goes on with less of a header. */
int retex_exr_alloc_failed(void);

#endif
