/* See decoder_process.h. */
#include "picture/decoder_process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>

#include "picture/beside.h"

enum {
    LOOK_MILLISECONDS = 20, /* for stops and for memory */
    END_MILLISECONDS = 500, /* between its last byte and its end */
    PIPE_BYTES = 1 << 20,
    FIRST_FREE = 4, /* descriptors below are the decoder's own */
    MOST_COUNTED = 64
};

extern char **environ;

/* Resident memory of all decoders of this process, by counters. */
static _Atomic uint64_t resident[MOST_COUNTED];

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

static int take_counter(void)
{
    for (int i = 0; i < MOST_COUNTED; i++) {
        uint64_t unused = 0;
        if (atomic_compare_exchange_strong(&resident[i], &unused, 1))
            return i;
    }
    return -1;
}

int retex_decoder_fail_memory(const RetexDecoderOrder *order, RetexError *err)
{
    return retex_fail(err, RETEX_ELIMIT, "%s: decoding it takes more than the %.0f MB that --max-memory leaves",
                      order->path, (double)order->memory / (1 << 20));
}

int retex_decoder_check_memory(const RetexDecoderProcess *decoder, uint64_t more, RetexError *err)
{
    const uint64_t own = resident_bytes(decoder->pid), most = decoder->order->memory;
    uint64_t sum = more, largest = 0;
    if (decoder->counter < 0 || !most)
        return RETEX_OK;
    atomic_store(&resident[decoder->counter], own | !own);
    for (int i = 0; i < MOST_COUNTED; i++) {
        const uint64_t bytes = atomic_load(&resident[i]);
        sum += bytes;
        largest = bytes > largest ? bytes : largest;
    }
    return sum > most && own >= largest ? retex_decoder_fail_memory(decoder->order, err) : RETEX_OK;
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

int retex_decoder_copy_high(int file)
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
    ends[0] = retex_decoder_copy_high(low[0]);
    ends[1] = retex_decoder_copy_high(low[1]);
    close(low[0]);
    close(low[1]);
    return ends[0] < 0 || ends[1] < 0 ? -1 : 0;
}

static void close_file(int file)
{
    if (file >= 0)
        close(file);
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

int retex_decoder_start(RetexDecoderProcess *decoder, const RetexDecoderOrder *order, const RetexBudget *budget,
                        int picture, double seconds, RetexError *err)
{
    RetexBesidePath program;
    int orders[2] = {-1, -1}, replies[2] = {-1, -1}, code = 0;
    _Static_assert(sizeof *order <= 4096, "fits into any pipe");
    *decoder = (RetexDecoderProcess){
        .order = order, .budget = budget, .from = -1, .counter = -1, .until = retex_clock_seconds() + seconds};
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
    decoder->counter = take_counter();
    return RETEX_OK;
}

/* ---- the end ---- */

/* The status with which it ended by itself, if it does so soon, or below 0. Whoever else waits for all children of this
 * process may have it. */
static int end(RetexDecoderProcess *decoder)
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

void retex_decoder_stop(RetexDecoderProcess *decoder)
{
    if (decoder->pid > 0) {
        kill(decoder->pid, SIGKILL);
        while (waitpid(decoder->pid, NULL, 0) < 0 && errno == EINTR)
            ;
    }
    close_file(decoder->from);
    if (decoder->counter >= 0)
        atomic_store(&resident[decoder->counter], 0);
}

static int fail_late(const RetexDecoderProcess *decoder, RetexError *err)
{
    return retex_fail(err, RETEX_ELIMIT, "%s: not done within %g s", decoder->order->path, decoder->order->seconds);
}

/* It ended before it had said all. */
static int explain_end(RetexDecoderProcess *decoder, RetexError *err)
{
    const int code = end(decoder), number = code >= 0 && WIFSIGNALED(code) ? WTERMSIG(code) : 0;
    const char *path = decoder->order->path;
    if (number == SIGXCPU)
        return fail_late(decoder, err);
    if (number == SIGKILL)
        return retex_fail(err, RETEX_ELIMIT, "%s: the process that decodes it was killed", path);
    return retex_fail(err, RETEX_EFORMAT, "%s: the process that decodes it ended (%s): it is damaged", path,
                      number ? strsignal(number) : "without a word");
}

int retex_decoder_fail_nonsense(const RetexDecoderOrder *order, RetexError *err)
{
    return retex_fail(err, RETEX_EFORMAT, "%s: the process that decodes it gave a wrong answer: it is damaged",
                      order->path);
}

/* ---- what it says ---- */

static int wait_for_bytes(const RetexDecoderProcess *decoder, RetexError *err)
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
        const int too_large = retex_decoder_check_memory(decoder, 0, err);
        if (too_large)
            return too_large;
    }
}

int retex_decoder_take(RetexDecoderProcess *decoder, void *to, size_t bytes, RetexError *err)
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

int retex_decoder_take_reply(RetexDecoderProcess *decoder, RetexDecoderReply *reply, RetexError *err)
{
    const int code = retex_decoder_take(decoder, reply, sizeof *reply, err);
    if (code)
        return code;
    if (reply->magic != RETEX_DECODER_MAGIC || reply->bytes != sizeof *reply || reply->code > 0 ||
        reply->code < RETEX_EACCESS || reply->nwarnings < 0 || reply->nwarnings > RETEX_DECODER_WARNINGS ||
        (reply->misses_bridge && decoder->order->with_bridge))
        return retex_decoder_fail_nonsense(decoder->order, err);
    clean_text(reply->missed_space, sizeof reply->missed_space);
    clean_text(reply->error.file, sizeof reply->error.file);
    clean_text(reply->error.message, sizeof reply->error.message);
    for (int i = 0; i < reply->nwarnings; i++)
        clean_text(reply->warnings[i], sizeof reply->warnings[i]);
    reply->error.code = reply->code;
    return RETEX_OK;
}
