/* retex-decode: decodes one picture for another process, see libretex/picture/decoder.h. Nobody else has a use for it.
 *
 * Before it looks at the picture it loads what decoding may need, limits itself, and gives up all other rights. It also
 * encodes pixels of that process, which are no stranger's. */
#include <errno.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <retex/parallel.h>
#include <retex/picture.h>

#include "common/confine.h"
#include "picture/image_format.h"
#include "picture/image_read.h"

enum { FILES = 32, THREAD_BYTES = 9 << 20, OWN_BYTES = 64 << 20 };

static RetexDecoderReply reply = {.magic = RETEX_DECODER_MAGIC, .bytes = sizeof reply};

static int read_order(RetexDecoderOrder *order)
{
    size_t done = 0;
    for (ssize_t got; done < sizeof *order; done += (size_t)got) {
        got = read(RETEX_DECODER_ORDERS, (char *)order + done, sizeof *order - done);
        if (got < 0 && errno == EINTR)
            got = 0;
        else if (got <= 0)
            return -1;
    }
    return order->magic == RETEX_DECODER_MAGIC && order->bytes == sizeof *order ? 0 : -1;
}

static int write_all(const void *data, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t written = write(STDOUT_FILENO, (const char *)data + done, bytes - done);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return -1;
        done += (size_t)written;
    }
    return 0;
}

static void keep_warning(void *context, const char *text)
{
    (void)context;
    if (reply.nwarnings < RETEX_DECODER_WARNINGS)
        snprintf(reply.warnings[reply.nwarnings++], sizeof reply.warnings[0], "%s", text);
}

/* Its parent ends it; signals that a terminal sends to all are the parent's affair. */
static void ignore_signals(void)
{
    static const int numbers[] = {SIGINT, SIGQUIT, SIGHUP, SIGTERM};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        signal(numbers[i], SIG_IGN);
}

/* Load what is needed later: 0, or the reply says what is missing. */
static int prepare(const RetexDecoderOrder *order, const RetexInput *input)
{
    const RetexBridgeFile file = {
        .path = order->path, .format = retex_image_format(input), .colorspace = order->space_to_load};
    unsetenv("OIIO_LIBRARY_PATH"); /* the formats that are read here are no plugins */
    if (!order->with_bridge)
        retex_bridge_leave_out();
    return order->with_bridge ? retex_bridge_prepare(&file, &reply.error) : 0;
}

static void give_up_rights(const RetexDecoderOrder *order)
{
#ifdef M_ARENA_MAX
    mallopt(M_ARENA_MAX, 1); /* each reserves much more than it uses */
#endif
    confine_limit(RLIMIT_CORE, 0);
    confine_limit(RLIMIT_CPU, (uint64_t)order->seconds);
    if (order->memory)
        confine_memory(order->memory + OWN_BYTES + (uint64_t)retex_threads(order->nthreads) * THREAD_BYTES);
    confine_limit(RLIMIT_NOFILE, FILES);
    confine_limit(RLIMIT_FSIZE, 0);
    confine_to_open_files();
}

static int decode(const RetexDecoderOrder *order, RetexInput *input, RetexDecoded *decoded)
{
    const RetexAccess access = {.size = sizeof access, .safe = 2, .accept_damaged = order->accept_damaged};
    RetexBudget *budget = NULL;
    RetexReadParams params = RETEX_READ_INIT;
    int code = retex_budget_create(&budget, &reply.error);
    if (code)
        return code;
    retex_budget_set_pixels(budget, (long)order->all_pixels);
    retex_budget_set_memory(budget, order->left == UINT64_MAX ? 0 : order->left ? order->left : 1);
    params.colorspace = order->has_colorspace ? order->colorspace : NULL;
    params.max_pixels = (long)order->max_pixels;
    params.access = &access;
    params.budget = budget;
    params.pixel_bytes = order->pixel_bytes;
    params.warn = keep_warning;
    code = retex_image_decode(decoded, (RetexDecode)order->decode, input, order->path, &params, order->nthreads,
                              &reply.error);
    retex_budget_close(&budget);
    return code;
}

static int answer(int code, const RetexDecoded *decoded)
{
    const RetexNarrowImage *narrow = &decoded->narrow;
    const RetexImage *image = &decoded->image;
    const char *missed = retex_bridge_missed();
    reply.code = code;
    reply.misses_bridge = missed != NULL;
    snprintf(reply.missed_space, sizeof reply.missed_space, "%s", missed ? missed : "");
    reply.is_narrow = narrow->pixels != NULL;
    reply.width = narrow->pixels ? narrow->width : image->width;
    reply.height = narrow->pixels ? narrow->height : image->height;
    if (write_all(&reply, sizeof reply) || code || missed)
        return 1;
    const size_t samples = (size_t)reply.width * (size_t)reply.height * 4;
    return narrow->pixels ? write_all(narrow->pixels, samples * sizeof(uint16_t))
                          : write_all(image->pixels, samples * sizeof(float));
}

/* ---- encoding ---- */

static int read_pixels(RetexImage *image)
{
    const size_t bytes = 3 * sizeof(float) * (size_t)image->width * (size_t)image->height;
    for (size_t done = 0; done < bytes;) {
        const ssize_t got = read(STDIN_FILENO, (char *)image->pixels + done, bytes - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return retex_fail(&reply.error, RETEX_EIO, "cannot read the pixels");
        done += (size_t)got;
    }
    return RETEX_OK;
}

static int encode(const RetexDecoderOrder *order)
{
    RetexWriteParams params = RETEX_WRITE_INIT;
    RetexImage image = {0};
    RetexPicture *picture = NULL;
    void *data = NULL;
    size_t bytes = 0;
    params.quality = order->quality;
    params.view = order->view;
    int code = retex_image_alloc(&image, order->width, order->height, 3, &reply.error);
    if (!code)
        code = read_pixels(&image);
    if (!code)
        code = retex_picture_open_memory(&picture, order->format, image.width, image.height, 3, &params, &reply.error);
    if (!code)
        code = retex_picture_image(picture, &image, order->nthreads, &reply.error);
    if (!code)
        code = retex_picture_take(&picture, &data, &bytes, &reply.error);
    reply.code = code;
    reply.file_bytes = bytes;
    return write_all(&reply, sizeof reply) || code ? 1 : write_all(data, bytes);
}

int main(void)
{
    RetexDecoderOrder order;
    RetexDecoded decoded = {0};
    RetexInput *input = NULL;
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (read_order(&order) || getppid() != order.parent) {
        const int layers = confine_to_open_files();
        printf("retex-decode: other programs of retex start it, to decode a picture; seccomp: %s, Landlock: %s\n",
               layers & CONFINE_CALLS ? "yes" : "no", layers & CONFINE_FILES ? "yes" : "no");
        fflush(stdout);
        _exit(2);
    }
    syscall(SYS_close_range, RETEX_DECODER_ORDERS, ~0u, 0);
    ignore_signals();
    if (order.decode == RETEX_DECODE_NOT)
        _exit(encode(&order) ? 1 : 0);
    int code = retex_input_open_descriptor(&input, STDIN_FILENO, order.path, &reply.error);
    if (!code)
        code = prepare(&order, input);
    give_up_rights(&order);
    if (!code)
        code = decode(&order, input, &decoded);
    _exit(answer(code, &decoded) ? 1 : 0);
}
