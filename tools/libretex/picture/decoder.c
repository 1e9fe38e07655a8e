/* See decoder.h. This is the side that asks. */
#include "picture/decoder.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/picture.h>

#include "base/machine.h"
#include "base/params.h"
#include "exr/io.h"
#include "picture/beside.h"
#include "picture/image_format.h"

enum {
    PROCESSOR_SECONDS = 60,
    MOST_SECONDS = 300,     /* by the clock: a decoder can also wait */
    ENCODE_SECONDS = 3600,  /* where no budget ends it before */
    LOOK_MILLISECONDS = 20, /* for stops and for memory */
    END_MILLISECONDS = 500, /* between its last byte and its end */
    PIPE_BYTES = 1 << 20,
    FIRST_FREE = 4, /* descriptors below are the decoder's own */
    MOST_COUNTED = 64
};

extern char **environ;

/* Resident memory of all decoders of this process, by slots. */
static _Atomic uint64_t resident[MOST_COUNTED];

typedef struct Decoder {
    const RetexDecoderOrder *order;
    const RetexBudget *budget;
    pid_t pid;
    int from;     /* its output */
    double until; /* of the clock */
    int slot;     /* of resident; below 0 = none */
} Decoder;

/* ---- memory ---- */

static uint64_t resident_bytes(pid_t pid)
{
    char path[64], text[128] = "";
    unsigned long long pages = 0;
    snprintf(path, sizeof path, "/proc/%ld/statm", (long)pid);
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return 0;
    if (read(file, text, sizeof text - 1) <= 0 || sscanf(text, "%*u %llu", &pages) != 1)
        pages = 0;
    close(file);
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

static int take_slot(void)
{
    for (int i = 0; i < MOST_COUNTED; i++) {
        uint64_t unused = 0;
        if (atomic_compare_exchange_strong(&resident[i], &unused, 1))
            return i;
    }
    return -1;
}

static int fail_memory(const Decoder *decoder, RetexError *err)
{
    return retex_fail(err, RETEX_ELIMIT, "%s: decoding it takes more than the %.0f MB that --max-memory leaves",
                      decoder->order->path, (double)decoder->order->memory / (1 << 20));
}

/* All decoders, and `more` bytes of this process, must keep within what is left. Of several the largest gives way. */
static int check_memory(const Decoder *decoder, uint64_t more, RetexError *err)
{
    const uint64_t own = resident_bytes(decoder->pid), most = decoder->order->memory;
    uint64_t sum = more, largest = 0;
    if (decoder->slot < 0 || !most)
        return RETEX_OK;
    atomic_store(&resident[decoder->slot], own | !own);
    for (int i = 0; i < MOST_COUNTED; i++) {
        const uint64_t bytes = atomic_load(&resident[i]);
        sum += bytes;
        largest = bytes > largest ? bytes : largest;
    }
    return sum > most && own >= largest ? fail_memory(decoder, err) : RETEX_OK;
}

/* ---- the start ---- */

static int fail_start(const char *path, const char *why, RetexError *err)
{
    return retex_fail(err, RETEX_EIO, "%s: no process for it: %s", path, why);
}

static int find_program(RetexBesidePath path)
{
    const char *named = getenv("RETEX_DECODER");
    if (!named || !*named)
        return retex_beside_find(path, "retex-decode");
    return snprintf(path, sizeof(RetexBesidePath), "%s", named) < (int)sizeof(RetexBesidePath);
}

/* A copy of a descriptor beyond those that the decoder has as its own. */
static int copy_high(int file)
{
    return fcntl(file, F_DUPFD_CLOEXEC, FIRST_FREE);
}

/* A pipe whose ends are beyond them, too. */
static int open_pipe(int ends[2])
{
    int low[2];
    ends[0] = ends[1] = -1;
    if (pipe2(low, O_CLOEXEC) != 0)
        return -1;
    ends[0] = copy_high(low[0]);
    ends[1] = copy_high(low[1]);
    close(low[0]);
    close(low[1]);
    return ends[0] < 0 || ends[1] < 0 ? -1 : 0;
}

static void close_file(int file)
{
    if (file >= 0)
        close(file);
}

/* The picture as a file: standard input may have been a pipe, which is in memory. */
static int open_picture(const RetexInput *input)
{
    const int file = retex_input_descriptor(input);
    if (file >= 0)
        return copy_high(file);
    const int low = memfd_create("picture", MFD_CLOEXEC), copy = low < 0 ? -1 : copy_high(low);
    close_file(low);
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

/* Start the program with these files. posix_spawn, because this may be a program of many threads. */
static int spawn(pid_t *pid, const char *program, int picture, int orders, int replies)
{
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    sigset_t none, all;
    char name[] = "retex-decode", *arguments[] = {name, NULL};
    sigemptyset(&none);
    sigfillset(&all);
    int code = posix_spawn_file_actions_init(&files);
    if (code)
        return code;
    code = posix_spawnattr_init(&attributes);
    if (!code) {
        posix_spawnattr_setsigmask(&attributes, &none);
        posix_spawnattr_setsigdefault(&attributes, &all);
        posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        code = posix_spawn_file_actions_adddup2(&files, picture, STDIN_FILENO);
        if (!code)
            code = posix_spawn_file_actions_adddup2(&files, replies, STDOUT_FILENO);
        if (!code)
            code = posix_spawn_file_actions_addopen(&files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        if (!code)
            code = posix_spawn_file_actions_adddup2(&files, orders, RETEX_DECODER_ORDERS);
        if (!code)
            code = posix_spawn(pid, program, &files, &attributes, arguments, environ);
        posix_spawnattr_destroy(&attributes);
    }
    posix_spawn_file_actions_destroy(&files);
    return code;
}

/* picture: a descriptor, or below 0 with errno set; it is closed. */
static int start(Decoder *decoder, int picture, RetexError *err)
{
    const RetexDecoderOrder *order = decoder->order;
    RetexBesidePath program;
    int orders[2] = {-1, -1}, replies[2] = {-1, -1}, code = 0;
    _Static_assert(sizeof *order <= 4096, "fits into any pipe");
    if (!find_program(program)) {
        close_file(picture);
        return fail_start(order->path, "there is no program retex-decode", err);
    }
    if (picture < 0 || open_pipe(orders) || open_pipe(replies) ||
        write(orders[1], order, sizeof *order) != (ssize_t)sizeof *order)
        code = errno ? errno : EIO;
    if (!code)
        code = spawn(&decoder->pid, program, picture, orders[0], replies[1]);
    close_file(picture);
    close_file(orders[0]);
    close_file(orders[1]);
    close_file(replies[1]);
    if (code) {
        close_file(replies[0]);
        return fail_start(order->path, strerror(code), err);
    }
    decoder->from = replies[0];
    fcntl(decoder->from, F_SETPIPE_SZ, PIPE_BYTES); /* only faster */
    decoder->slot = take_slot();
    return RETEX_OK;
}

/* ---- the end ---- */

/* The status with which it ended by itself, if it does so soon, or below 0. Whoever else waits for all children of this
 * process may have it. */
static int end(Decoder *decoder)
{
    int status = -1, is_over = 0;
    for (int i = 0; i < END_MILLISECONDS && !is_over; i++) {
        const pid_t ended = waitpid(decoder->pid, &status, WNOHANG);
        is_over = ended == decoder->pid || (ended < 0 && errno != EINTR);
        status = ended == decoder->pid ? status : -1;
        if (!is_over)
            poll(NULL, 0, 1);
    }
    if (is_over)
        decoder->pid = 0;
    return status;
}

static void stop(Decoder *decoder)
{
    if (decoder->pid > 0) {
        kill(decoder->pid, SIGKILL);
        while (waitpid(decoder->pid, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    close_file(decoder->from);
    if (decoder->slot >= 0)
        atomic_store(&resident[decoder->slot], 0);
}

static int fail_late(const Decoder *decoder, RetexError *err)
{
    return retex_fail(err, RETEX_ELIMIT, "%s: not done within %g s", decoder->order->path, decoder->order->seconds);
}

/* It ended before it had said all. */
static int explain_end(Decoder *decoder, RetexError *err)
{
    const int status = end(decoder), number = status >= 0 && WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const char *path = decoder->order->path;
    if (number == SIGXCPU)
        return fail_late(decoder, err);
    if (number == SIGKILL)
        return retex_fail(err, RETEX_ELIMIT, "%s: the process that decodes it was killed", path);
    return retex_fail(err, RETEX_EFORMAT, "%s: the process that decodes it ended (%s): it is damaged", path,
                      number ? strsignal(number) : "without a word");
}

static int fail_nonsense(const Decoder *decoder, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "%s: the process that decodes it gave a wrong answer: it is damaged",
                      decoder->order->path);
}

/* ---- what it says ---- */

static int wait_for_bytes(const Decoder *decoder, RetexError *err)
{
    for (;;) {
        struct pollfd from = {decoder->from, POLLIN, 0};
        const int ready = poll(&from, 1, LOOK_MILLISECONDS);
        const int code = retex_budget_check(decoder->budget, err);
        if (code)
            return code;
        if (retex_clock_seconds() > decoder->until)
            return fail_late(decoder, err);
        if (ready > 0)
            return RETEX_OK;
        const int too_large = check_memory(decoder, 0, err);
        if (too_large)
            return too_large;
    }
}

static int take(Decoder *decoder, void *to, size_t bytes, RetexError *err)
{
    for (size_t done = 0; done < bytes;) {
        const int code = wait_for_bytes(decoder, err);
        if (code)
            return code;
        const ssize_t got = read(decoder->from, (char *)to + done, bytes - done);
        if (got < 0 && errno != EINTR)
            return retex_fail(err, RETEX_EIO, "%s: cannot read what the process that decodes it says: %s",
                              decoder->order->path, strerror(errno));
        if (got == 0)
            return explain_end(decoder, err);
        done += got > 0 ? (size_t)got : 0;
    }
    return RETEX_OK;
}

/* Text of another process: it ends, and has no control characters. */
static void clean_text(char *text, size_t size)
{
    text[size - 1] = '\0';
    for (unsigned char *c = (unsigned char *)text; *c; c++)
        if (*c < ' ' || *c == 127)
            *c = '?';
}

static int take_reply(Decoder *decoder, RetexDecoderReply *reply, RetexError *err)
{
    const int code = take(decoder, reply, sizeof *reply, err);
    if (code)
        return code;
    if (reply->magic != RETEX_DECODER_MAGIC || reply->bytes != sizeof *reply || reply->code > 0 ||
        reply->code < RETEX_EACCESS || reply->nwarnings < 0 || reply->nwarnings > RETEX_DECODER_WARNINGS ||
        (reply->misses_bridge && decoder->order->with_bridge))
        return fail_nonsense(decoder, err);
    clean_text(reply->missed_space, sizeof reply->missed_space);
    clean_text(reply->error.file, sizeof reply->error.file);
    clean_text(reply->error.message, sizeof reply->error.message);
    for (int i = 0; i < reply->nwarnings; i++)
        clean_text(reply->warnings[i], sizeof reply->warnings[i]);
    reply->error.code = reply->code;
    return RETEX_OK;
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

static int take_pixels(Decoder *decoder, const RetexDecoderReply *reply, RetexDecoded *decoded, RetexError *err)
{
    const uint64_t count = (uint64_t)reply->width * (uint64_t)reply->height,
                   bytes = count * 4 * (reply->is_narrow ? sizeof(uint16_t) : sizeof(float));
    RetexNarrowImage narrow = {0};
    RetexImage image = {0};
    if (!are_expected(decoder->order, reply))
        return fail_nonsense(decoder, err);
    int code = count ? check_pixels(decoder->order, count, err) : RETEX_OK;
    if (code || !count)
        return code;
    code = check_memory(decoder, bytes, err);
    if (!code && reply->is_narrow) {
        narrow = (RetexNarrowImage){reply->width, reply->height, malloc(bytes)};
        code = narrow.pixels ? RETEX_OK : retex_fail(err, RETEX_ENOMEM, "not enough memory");
    } else if (!code) {
        code = retex_image_alloc(&image, reply->width, reply->height, 4, err);
    }
    if (!code)
        code = take(decoder, reply->is_narrow ? (void *)narrow.pixels : (void *)image.pixels, bytes, err);
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
    Decoder decoder = {
        .order = order, .budget = budget, .from = -1, .slot = -1, .until = retex_clock_seconds() + MOST_SECONDS};
    int code = retex_budget_check(budget, err);
    if (!code)
        code = start(&decoder, open_picture(input), err);
    if (!code)
        code = take_reply(&decoder, reply, err);
    if (!code && !reply->code && !reply->misses_bridge)
        code = take_pixels(&decoder, reply, decoded, err);
    stop(&decoder);
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
        code =
            reply->code == RETEX_ENOMEM && order.memory ? fail_memory(&(Decoder){.order = &order}, err) : reply->code;
        if (err && code == reply->code)
            *err = reply->error;
    }
    for (int i = 0; !code && params->warn && i < reply->nwarnings; i++)
        params->warn(params->warn_context, reply->warnings[i]);
    free(reply);
    return code;
}

/* ---- encoding ---- */

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
    const int low = memfd_create("pixels", MFD_CLOEXEC), copy = low < 0 ? -1 : copy_high(low);
    const int failed = copy >= 0 && write_pixels(copy, image), why = errno;
    close_file(low);
    if (failed)
        close(copy);
    errno = why;
    return failed ? -1 : copy;
}

/* One process: the file that it makes. */
static int encode(const RetexDecoderOrder *order, const RetexImage *image, const RetexBudget *budget, void **data,
                  size_t *bytes, RetexError *err)
{
    Decoder decoder = {
        .order = order, .budget = budget, .from = -1, .slot = -1, .until = retex_clock_seconds() + ENCODE_SECONDS};
    RetexDecoderReply *reply = malloc(sizeof *reply);
    int code = reply ? start(&decoder, open_pixels(image), err) : retex_fail(err, RETEX_ENOMEM, "not enough memory");
    if (!code)
        code = take_reply(&decoder, reply, err);
    if (!code && reply->code) {
        code = reply->code;
        if (err)
            *err = reply->error;
    }
    if (!code && !(*data = malloc(reply->file_bytes)))
        code = retex_fail(err, RETEX_ENOMEM, "not enough memory");
    if (!code)
        code = take(&decoder, *data, *bytes = reply->file_bytes, err);
    stop(&decoder);
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
    if (!code && (snprintf(order.format, sizeof order.format, "%s", format) >= (int)sizeof order.format ||
                  snprintf(order.view, sizeof order.view, "%s", params.view ? params.view : "") >=
                      (int)sizeof order.view))
        code = retex_fail(err, RETEX_EINVAL, "the name of a format or view is too long");
    if (!code)
        code = encode(&order, image, budget, data, bytes, err);
    if (!code)
        return RETEX_OK;
    free(*data);
    *data = NULL, *bytes = 0;
    return code;
}
