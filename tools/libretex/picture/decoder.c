/* See decoder.h. This is the side that asks for a picture's pixels. */
#include "picture/decoder.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include <retex/picture.h>

#include "base/machine.h"
#include "base/params.h"
#include "exr/io.h"
#include "picture/decoder_process.h"
#include "picture/image_format.h"

enum {
    PROCESSOR_SECONDS = 60,
    MOST_SECONDS = 300 /* by the clock: a decoder can also wait */
};

/* The picture as a file: standard input may have been a pipe, which is in memory. */
static int open_picture(const RetexInput *input)
{
    const int file = retex_input_descriptor(input);
    if (file >= 0)
        return retex_decoder_copy_high(file);
    const int low = memfd_create("picture", MFD_CLOEXEC), copy = low < 0 ? -1 : retex_decoder_copy_high(low);
    if (low >= 0)
        close(low);
    char bytes[4096];
    uint64_t at = 0;
    int64_t got = 0;
    while (copy >= 0 && (got = retex_input_read(input, bytes, sizeof bytes, at)) > 0) {
        if (write(copy, bytes, (size_t)got) != got)
            got = -1;
        if (got < 0)
            break;
        at += (uint64_t)got;
    }
    if (copy >= 0 && got < 0) {
        close(copy);
        return -1;
    }
    return copy;
}

/* Whether the pixels that the reply announces may be what was asked for. */
static int are_expected(const RetexDecoderOrder *order, const RetexDecoderReply *reply)
{
    const RetexDecode decode = (RetexDecode)order->decode;
    if (decode == RETEX_DECODE_CHECK)
        return reply->width == 0 && reply->height == 0;
    return (decode == RETEX_DECODE_ANY || !reply->is_narrow) && reply->width > 0 && reply->height > 0 &&
           reply->width <= RETEX_MAX_SIZE && reply->height <= RETEX_MAX_SIZE;
}

static int check_pixels(const RetexDecoderOrder *order, uint64_t count, RetexError *err)
{
    const int64_t most[] = {order->max_pixels, order->all_pixels};
    for (int i = 0; i < 2; i++)
        if (most[i] > 0 && count > (uint64_t)most[i])
            return retex_fail(err, RETEX_ELIMIT, "%s is too large: %.0f pixels, more than the %.0f of --max-pixels",
                              order->path, (double)count, (double)most[i]);
    return RETEX_OK;
}

static int take_pixels(RetexDecoderProcess *decoder, const RetexDecoderReply *reply, RetexDecoded *decoded,
                       RetexError *err)
{
    const uint64_t count = (uint64_t)reply->width * (uint64_t)reply->height,
                   bytes = count * 4 * (reply->is_narrow ? sizeof(uint16_t) : sizeof(float));
    RetexNarrowImage narrow = {0};
    RetexImage image = {0};
    if (!are_expected(decoder->order, reply))
        return retex_decoder_fail_nonsense(decoder->order, err);
    int code = count ? check_pixels(decoder->order, count, err) : RETEX_OK;
    if (code || !count)
        return code;
    code = retex_decoder_check_memory(decoder, bytes, err);
    if (!code && reply->is_narrow) {
        narrow = (RetexNarrowImage){reply->width, reply->height, malloc(bytes)};
        code = narrow.pixels ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory");
    } else if (!code) {
        code = retex_image_alloc(&image, reply->width, reply->height, 4, err);
    }
    if (!code)
        code = retex_decoder_take(decoder, reply->is_narrow ? (void *)narrow.pixels : (void *)image.pixels, bytes, err);
    if (code) {
        free(narrow.pixels);
        retex_image_free(&image);
        return code;
    }
    decoded->narrow = narrow;
    decoded->image = image;
    return RETEX_OK;
}

/* One process: its reply, and the pixels where all is well. */
static int run(RetexDecoded *decoded, RetexDecoderReply *reply, const RetexDecoderOrder *order, const RetexInput *input,
               const RetexBudget *budget, RetexError *err)
{
    RetexDecoderProcess decoder;
    int code = retex_budget_check(budget, err);
    if (code)
        return code;
    code = retex_decoder_start(&decoder, order, budget, open_picture(input), MOST_SECONDS, err);
    if (!code)
        code = retex_decoder_take_reply(&decoder, reply, err);
    if (!code && !reply->code && !reply->misses_bridge)
        code = take_pixels(&decoder, reply, decoded, err);
    retex_decoder_stop(&decoder);
    return code;
}

/* ---- the order ---- */

static int fill_order(RetexDecoderOrder *order, RetexDecode decode, const RetexInput *input, const char *path,
                      const RetexReadParams *params, int nthreads, RetexError *err)
{
    const char *format = retex_image_format(input), *space = params->colorspace;
    const int is_own =
        !format || strcmp(format, "jpeg") == 0 || strcmp(format, "png") == 0 || strcmp(format, "openexr") == 0;
    const uint64_t machine = retex_machine_memory();
    *order = (RetexDecoderOrder){.magic = RETEX_DECODER_MAGIC,
                                 .bytes = sizeof *order,
                                 .parent = (int32_t)getpid(),
                                 .decode = (int32_t)decode,
                                 .with_bridge = !is_own,
                                 .nthreads = nthreads,
                                 .pixel_bytes = params->pixel_bytes,
                                 .max_pixels = params->max_pixels,
                                 .all_pixels = retex_budget_pixels(params->budget),
                                 .left = retex_budget_left(params->budget),
                                 .seconds = PROCESSOR_SECONDS,
                                 .accept_damaged = params->access && params->access->accept_damaged,
                                 .has_colorspace = space != NULL};
    order->memory = order->left == UINT64_MAX ? machine / 4 * 3 : order->left;
    if (snprintf(order->colorspace, sizeof order->colorspace, "%s", space ? space : "") >=
        (int)sizeof order->colorspace)
        return retex_fail(err, RETEX_EINVAL, "the name of a colour space is too long");
    snprintf(order->space_to_load, sizeof order->space_to_load, "%s", order->colorspace);
    snprintf(order->path, sizeof order->path, "%s", path);
    if (params->budget)
        order->seconds = fmin(order->seconds, fmax(ceil(retex_budget_seconds_left(params->budget)), 1));
    return RETEX_OK;
}

int retex_decoder_run(RetexDecoded *decoded, RetexDecode decode, const RetexInput *input, const char *path,
                      const RetexReadParams *params, int nthreads, RetexError *err)
{
    RetexDecoderOrder order;
    RetexDecoderReply *reply = malloc(sizeof *reply);
    int code = reply ? fill_order(&order, decode, input, path, params, nthreads, err)
                     : retex_fail(err, RETEX_ENOMEM, "not enough memory to read %s", path);
    if (!code)
        code = run(decoded, reply, &order, input, params->budget, err);
    if (!code && reply->misses_bridge) {
        order.with_bridge = 1;
        strcpy(order.space_to_load, reply->missed_space);
        code = run(decoded, reply, &order, input, params->budget, err);
    }
    if (!code && reply->code) {
        code = reply->code == RETEX_ENOMEM && order.memory ? retex_decoder_fail_memory(&order, err) : reply->code;
        if (err && code == reply->code)
            *err = reply->error;
    }
    for (int i = 0; !code && params->warn && i < reply->nwarnings; i++)
        params->warn(params->warn_context, reply->warnings[i]);
    free(reply);
    return code;
}
