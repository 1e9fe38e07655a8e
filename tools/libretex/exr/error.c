/* OpenEXRCore's callbacks: its default prints messages to stderr, which a library must not do. */
#include <stdio.h>

#include "exr/error.h"

void retex_exr_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    void *data = NULL;

    (void)code;
    if (!context || exr_get_user_data(context, &data) != EXR_ERR_SUCCESS || !data)
        return;
    RetexExrMessage *message = data;
    pthread_mutex_lock(&message->lock);
    if (!message->text[0])
        snprintf(message->text, sizeof message->text, "%s", text ? text : "");
    pthread_mutex_unlock(&message->lock);
}

void retex_exr_no_message(exr_const_context_t context, exr_result_t code, const char *text)
{
    (void)context;
    (void)code;
    (void)text;
}

int retex_exr_fail_write(exr_result_t code, const char *path, RetexError *err)
{
    if (code == EXR_ERR_OUT_OF_MEMORY)
        return retex_fail(err, RETEX_ENOMEM, "no memory to write %s", path);
    return retex_fail(err, RETEX_EINTERNAL, "cannot write %s: %s", path, exr_get_default_error_message(code));
}

static _Thread_local int alloc_failed;

void *retex_exr_alloc(size_t bytes)
{
    if (bytes > (size_t)1 << 30)
        return NULL;
    void *block = calloc(1, bytes ? bytes : 1);
    if (!block)
        alloc_failed = 1;
    return block;
}

int retex_exr_alloc_failed(void)
{
    const int failed = alloc_failed;

    alloc_failed = 0;
    return failed;
}
