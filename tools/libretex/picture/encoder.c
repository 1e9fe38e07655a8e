/* Pictures encoded by the program that decodes them (decoder.h): formats of other libraries that must end in time. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <retex/picture.h>

#include "base/params.h"
#include "picture/decoder_process.h"

enum { ENCODE_SECONDS = 3600 }; /* where no budget ends it before */

static int write_pixels(int file, const RetexImage *image)
{
    const size_t bytes = 3 * sizeof(float) * (size_t)image->width * (size_t)image->height;
    for (size_t done = 0; done < bytes;) {
        const ssize_t written = write(file, (const char *)image->pixels + done, bytes - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return -1;
        done += (size_t)written;
    }
    return lseek(file, 0, SEEK_SET) == 0 ? 0 : -1;
}

/* The pixels as a file in memory; below 0: errno says why there is none. */
static int open_pixels(const RetexImage *image)
{
    const int low = memfd_create("pixels", MFD_CLOEXEC), copy = low < 0 ? -1 : retex_decoder_copy_high(low);
    const int failed = copy >= 0 && write_pixels(copy, image), why = errno;
    if (low >= 0)
        close(low);
    if (failed)
        close(copy);
    errno = why;
    return failed ? -1 : copy;
}

/* One process: the file that it makes. */
static int encode(const RetexDecoderOrder *order, const RetexImage *image, const RetexBudget *budget, void **data,
                  size_t *bytes, RetexError *err)
{
    RetexDecoderProcess decoder;
    RetexDecoderReply *reply = malloc(sizeof *reply);
    if (!reply)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory");
    int code = retex_decoder_start(&decoder, order, budget, open_pixels(image), ENCODE_SECONDS, err);
    if (!code)
        code = retex_decoder_take_reply(&decoder, reply, err);
    if (!code && reply->code) {
        code = reply->code;
        if (err)
            *err = reply->error;
    }
    if (!code && !(*data = malloc(reply->file_bytes)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory");
    if (!code)
        code = retex_decoder_take(&decoder, *data, *bytes = reply->file_bytes, err);
    retex_decoder_stop(&decoder);
    free(reply);
    return code;
}

int retex_picture_encode(void **data, size_t *bytes, const RetexImage *image, const char *format,
                         const RetexWriteParams *given, const RetexBudget *budget, int nthreads, RetexError *err)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexDecoderOrder order = {.magic = RETEX_DECODER_MAGIC,
                               .bytes = sizeof order,
                               .parent = (int32_t)getpid(),
                               .decode = RETEX_DECODE_NOT,
                               .with_bridge = 1,
                               .nthreads = nthreads,
                               .seconds = ENCODE_SECONDS,
                               .width = image->width,
                               .height = image->height};
    int code = RETEX_PARAMS_COPY(&params, given, err);
    *data = NULL, *bytes = 0;
    if (!code && (image->channels != 3 || params.display || params.colorspace || params.depth))
        code = retex_fail(err, RETEX_EUNSUPPORTED, "only RGB is encoded by a process of its own, by its view");
    order.quality = params.quality;
    snprintf(order.path, sizeof order.path, "picture.%s", format);
    if (!code &&
        (snprintf(order.format, sizeof order.format, "%s", format) >= (int)sizeof order.format ||
         snprintf(order.view, sizeof order.view, "%s", params.view ? params.view : "") >= (int)sizeof order.view))
        code = retex_fail(err, RETEX_EINVAL, "the name of a format or view is too long");
    if (!code)
        code = encode(&order, image, budget, data, bytes, err);
    if (!code)
        return RETEX_OK;
    free(*data);
    *data = NULL, *bytes = 0;
    return code;
}
