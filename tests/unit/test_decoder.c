/* Decoders that do not do what they should: whatever the other process does, one error, no pixels, and no process and
 * no file left. This program is also the false decoder: the library starts it where FALSE_DECODER says what it does. */
#include "lib_folder.h"
#include "lib_test.h"
#include <cmocka.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>

#include "picture/decoder.h"

/* ---- the false decoder ---- */

static RetexDecoderReply good_reply(void)
{
    RetexDecoderReply reply;
    memset(&reply, 0, sizeof reply);
    reply.magic = RETEX_DECODER_MAGIC;
    reply.bytes = sizeof reply;
    reply.width = 4;
    reply.height = 3;
    return reply;
}

static void write_all(const void *data, size_t bytes)
{
    for (size_t done = 0; done < bytes;) {
        const ssize_t written = write(STDOUT_FILENO, (const char *)data + done, bytes - done);
        if (written <= 0)
            _exit(3);
        done += (size_t)written;
    }
}

static void send_pixels(size_t count)
{
    const float pixel[4] = {.5f, .25f, 1, 1};
    for (size_t i = 0; i < count; i++)
        write_all(pixel, sizeof pixel);
}

static void set_reply(RetexDecoderReply *reply, const char *what, const RetexDecoderOrder *order)
{
    if (strcmp(what, "magic") == 0)
        reply->magic++;
    else if (strcmp(what, "bytes") == 0)
        reply->bytes--;
    else if (strcmp(what, "code above") == 0)
        reply->code = 1;
    else if (strcmp(what, "code below") == 0)
        reply->code = -1000;
    else if (strcmp(what, "wide") == 0)
        reply->width = RETEX_MAX_SIZE + 1;
    else if (strcmp(what, "negative") == 0)
        reply->width = -4, reply->height = -3;
    else if (strcmp(what, "no pixels") == 0)
        reply->width = reply->height = 0;
    else if (strcmp(what, "no height") == 0)
        reply->height = 0;
    else if (strcmp(what, "narrow") == 0)
        reply->is_narrow = 1;
    else if (strcmp(what, "many pixels") == 0)
        reply->width = reply->height = 2000;
    else if (strcmp(what, "warnings") == 0)
        reply->nwarnings = RETEX_DECODER_WARNINGS + 1;
    else if (strcmp(what, "negative warnings") == 0)
        reply->nwarnings = INT_MIN;
    else if (strcmp(what, "bridge") == 0 || (strcmp(what, "bridge once") == 0 && !order->with_bridge))
        reply->misses_bridge = 1;
    else if (strcmp(what, "text") == 0) {
        reply->code = RETEX_EFORMAT;
        memset(reply->error.message, '\033', sizeof reply->error.message);
        memset(reply->error.file, 'x', sizeof reply->error.file);
    } else if (strcmp(what, "warn") == 0) {
        reply->nwarnings = RETEX_DECODER_WARNINGS;
        memset(reply->warnings, '\n', sizeof reply->warnings);
    }
}

static void take_memory(void)
{
    for (;;) {
        char *memory = malloc(1 << 20);
        if (memory)
            memset(memory, 1, 1 << 20);
    }
}

static int act(const char *what)
{
    RetexDecoderOrder order;
    RetexDecoderReply reply = good_reply();
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (read(RETEX_DECODER_ORDERS, &order, sizeof order) != sizeof order)
        return 3;
    set_reply(&reply, what, &order);
    if (strcmp(what, "nothing") == 0)
        return 0;
    if (strcmp(what, "crash") == 0)
        abort();
    if (strcmp(what, "time") == 0)
        raise(SIGXCPU);
    if (strcmp(what, "memory") == 0)
        take_memory();
    if (strcmp(what, "close") == 0)
        close(STDOUT_FILENO);
    if (strcmp(what, "hang") == 0 || strcmp(what, "close") == 0)
        for (;;)
            pause();
    if (strcmp(what, "half a reply") == 0) {
        write_all(&reply, sizeof reply / 2);
        return 0;
    }
    write_all(&reply, sizeof reply);
    if (strcmp(what, "half the pixels") == 0) {
        send_pixels(6);
        return 0;
    }
    if (strcmp(what, "hang later") == 0) {
        send_pixels(6);
        for (;;)
            pause();
    }
    send_pixels(12);
    if (strcmp(what, "stay") == 0)
        for (;;)
            pause();
    for (;;) /* too much */
        send_pixels(1000);
}

/* ---- the tests ---- */

static char picture[PATH_MAX];

typedef struct Warnings {
    int count;
    char last[1024];
} Warnings;

static void keep(void *context, const char *text)
{
    Warnings *warnings = context;
    warnings->count++;
    snprintf(warnings->last, sizeof warnings->last, "%s", text);
}

static int open_files(void)
{
    DIR *open = opendir("/proc/self/fd");
    int count = 0;
    while (readdir(open))
        count++;
    closedir(open);
    return count;
}

/* Read with a false decoder; nothing may be left of it. */
static int read_by(const char *what, RetexImage *image, RetexBudget *budget, Warnings *warnings, RetexError *err)
{
    const RetexAccess access = {.size = sizeof access, .safe = 1};
    RetexReadParams params = RETEX_READ_INIT;
    const int files = open_files();
    params.access = &access;
    params.budget = budget;
    params.max_pixels = 1000000;
    params.warn = warnings ? keep : NULL;
    params.warn_context = warnings;
    memset(err, 0, sizeof *err);
    setenv("FALSE_DECODER", what, 1);
    const int code = retex_image_read(image, picture, &params, 1, err);
    unsetenv("FALSE_DECODER");
    assert_int_equal(open_files(), files);
    assert_int_equal(waitpid(-1, NULL, WNOHANG), -1);
    assert_int_equal(errno, ECHILD);
    assert_int_equal(code != 0, image->pixels == NULL);
    return code;
}

static void test_right_pixels(void **state)
{
    static const char *const whats[] = {"", "stay", "bridge once"};
    (void)state;
    for (size_t i = 0; i < sizeof whats / sizeof *whats; i++) {
        RetexImage image = {0};
        RetexError err;
        test_must(read_by(whats[i], &image, NULL, NULL, &err), &err);
        assert_int_equal(image.width * 100 + image.height, 403);
        for (int k = 0; k < 12; k++)
            assert_memory_equal(image.pixels + 4 * k, ((float[]){.5f, .25f, 1, 1}), 16);
        retex_image_free(&image);
    }
}

static void test_wrong_answers(void **state)
{
    static const char *const whats[] = {"magic",  "bytes",    "code above",        "code below",
                                        "wide",   "negative", "no pixels",         "no height",
                                        "narrow", "warnings", "negative warnings", "bridge"};
    (void)state;
    for (size_t i = 0; i < sizeof whats / sizeof *whats; i++) {
        RetexImage image = {0};
        RetexError err;
        assert_int_equal(read_by(whats[i], &image, NULL, NULL, &err), RETEX_EFORMAT);
        assert_non_null(strstr(err.message, "a.png: the process that decodes it gave a wrong answer: it is damaged"));
    }
}

static void test_early_ends(void **state)
{
    static const struct {
        const char *what, *message;
    } ends[] = {{"nothing", "ended (without a word)"},
                {"half a reply", "ended (without a word)"},
                {"half the pixels", "ended (without a word)"},
                {"crash", "ended (Aborted)"},
                {"time", "not done within 60 s"},
                {"close", "ended (without a word)"},
                {"many pixels", "4000000 pixels, more than the 1000000 of --max-pixels"}};
    (void)state;
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        RetexImage image = {0};
        RetexError err;
        assert_true(read_by(ends[i].what, &image, NULL, NULL, &err) < 0);
        if (!strstr(err.message, ends[i].message))
            fail_msg("%s: %s", ends[i].what, err.message);
    }
}

static void test_texts_are_cleaned(void **state)
{
    RetexImage image = {0};
    RetexError err;
    Warnings warnings = {0};
    (void)state;
    assert_int_equal(read_by("text", &image, NULL, NULL, &err), RETEX_EFORMAT);
    assert_int_equal(strlen(err.message), sizeof err.message - 1);
    assert_int_equal(strspn(err.message, "?"), sizeof err.message - 1);
    assert_int_equal(strlen(err.file), sizeof err.file - 1);
    test_must(read_by("warn", &image, NULL, &warnings, &err), &err);
    assert_int_equal(warnings.count, RETEX_DECODER_WARNINGS);
    assert_int_equal(strspn(warnings.last, "?"), sizeof warnings.last - 1);
    retex_image_free(&image);
}

static RetexBudget *new_budget(void)
{
    RetexBudget *budget = NULL;
    RetexError err = {0};
    test_must(retex_budget_create(&budget, &err), &err);
    return budget;
}

static void test_time_of_the_budget(void **state)
{
    static const char *const whats[] = {"hang", "hang later"};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        RetexBudget *budget = new_budget();
        RetexImage image = {0};
        RetexError err;
        retex_budget_set_seconds(budget, .3);
        const double began = retex_clock_seconds();
        assert_int_equal(read_by(whats[i], &image, budget, NULL, &err), RETEX_ELIMIT);
        assert_non_null(strstr(err.message, "this takes longer than the 0.3 s of --max-time"));
        const double took = retex_clock_seconds() - began;
        assert_true(took > .25 && took < 5);
        retex_budget_close(&budget);
    }
}

static void *stop_soon(void *budget)
{
    usleep(200000);
    retex_budget_stop(budget);
    return NULL;
}

static void test_stop(void **state)
{
    RetexBudget *budget = new_budget();
    RetexImage image = {0};
    RetexError err;
    pthread_t thread;
    (void)state;
    pthread_create(&thread, NULL, stop_soon, budget);
    assert_int_equal(read_by("hang", &image, budget, NULL, &err), RETEX_ESTOPPED);
    pthread_join(thread, NULL);
    retex_budget_close(&budget);
}

/* The false one has no limit of its own: it is seen to grow. */
static void test_memory_of_the_budget(void **state)
{
    RetexBudget *budget = new_budget();
    RetexImage image = {0};
    RetexError err;
    (void)state;
    retex_budget_set_memory(budget, 300 << 20);
    assert_int_equal(read_by("memory", &image, budget, NULL, &err), RETEX_ELIMIT);
    assert_non_null(strstr(err.message, "decoding it takes more than the 300 MB that --max-memory leaves"));
    retex_budget_close(&budget);
}

static void test_no_program(void **state)
{
    char before[PATH_MAX];
    RetexImage image = {0};
    RetexError err;
    (void)state;
    snprintf(before, sizeof before, "%s", getenv("RETEX_DECODER"));
    setenv("RETEX_DECODER", "/nowhere/retex-decode", 1);
    assert_int_equal(read_by("", &image, NULL, NULL, &err), RETEX_EIO);
    assert_non_null(strstr(err.message, "a.png: no process for it: No such file or directory"));
    setenv("RETEX_DECODER", before, 1);
}

/* Programs without standard streams get the same pixels. */
static void test_without_standard_streams(void **state)
{
    int kept[3];
    RetexImage image = {0};
    RetexError err;
    (void)state;
    fflush(NULL);
    for (int i = 0; i < 3; i++) {
        kept[i] = fcntl(i, F_DUPFD_CLOEXEC, 100);
        close(i);
    }
    const int code = read_by("", &image, NULL, NULL, &err);
    for (int i = 0; i < 3; i++) {
        dup2(kept[i], i);
        close(kept[i]);
    }
    test_must(code, &err);
    retex_image_free(&image);
}

static void write_picture(void)
{
    RetexImage image = {0};
    RetexError err = {0};
    snprintf(picture, sizeof picture, "%s", test_in_folder("a.png"));
    test_must(retex_image_alloc(&image, 4, 3, 3, &err), &err);
    test_must(retex_image_write(&image, picture, NULL, 1, &err), &err);
    retex_image_free(&image);
}

static int set_up(void **state)
{
    static char program[PATH_MAX];
    if (test_make_folder(state) || readlink("/proc/self/exe", program, sizeof program - 1) <= 0)
        return -1;
    setenv("RETEX_DECODER", program, 1);
    write_picture();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_right_pixels),
                                       cmocka_unit_test(test_wrong_answers),
                                       cmocka_unit_test(test_early_ends),
                                       cmocka_unit_test(test_texts_are_cleaned),
                                       cmocka_unit_test(test_time_of_the_budget),
                                       cmocka_unit_test(test_stop),
                                       cmocka_unit_test(test_memory_of_the_budget),
                                       cmocka_unit_test(test_no_program),
                                       cmocka_unit_test(test_without_standard_streams)};
    const char *what = getenv("FALSE_DECODER");
    return what ? act(what) : cmocka_run_group_tests(tests, set_up, test_remove_folder);
}
