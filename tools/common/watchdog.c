/* See watchdog.h. All threads block the signals; one thread receives them by sigtimedwait. Nothing runs in a signal
 * handler. */
#include "common/watchdog.h"

#include <fcntl.h>
#include <math.h>
#include <pthread.h>
#include <semaphore.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <retex/clock.h>
#include <retex/image.h>
#include <retex/output_file.h>

enum {
    STACK_BYTES = 256 << 10,
    IDLE_MILLISECONDS = 500,
    LEAST_MILLISECONDS = 5,
    KEEP_MILLISECONDS = 900, /* time for stopped work to call retex_budget_hold */
    EXIT_STATUS = 2
};

enum { THE_WORK = 1, THE_DOG }; /* who ends the tool */

static struct {
    const char *tool;
    RetexBudget *budget;
    sigset_t signals; /* signals that end the tool */
    atomic_int started;
    atomic_int may_keep, end_is_right, bar_is_open;
    atomic_int number;    /* the first signal received, or 0 */
    atomic_int too_large; /* the process uses more memory than the limit */
    int status_file;      /* /proc/self/statm, or below 0 */
    int ignores_pipe;     /* SIGPIPE was ignored when the tool was started */
    atomic_int ending;    /* THE_WORK or THE_DOG, which ends the tool; or 0 */
    _Atomic(const char *) remove;
    _Atomic(WatchdogLast *) last;
} dog;

static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};

static const char *signal_name(int number)
{
    return number == SIGINT ? "SIGINT" : number == SIGTERM ? "SIGTERM" : number == SIGPIPE ? "SIGPIPE" : "SIGHUP";
}

void watchdog_prepare(const char *tool)
{
    sigset_t blocked;
    struct sigaction of_pipe;

    dog.tool = tool;
    dog.ignores_pipe = sigaction(SIGPIPE, NULL, &of_pipe) == 0 && of_pipe.sa_handler == SIG_IGN;
    signal(SIGPIPE, SIG_IGN);
    sigemptyset(&dog.signals);
    pthread_sigmask(SIG_BLOCK, NULL, &blocked);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction now;
        if (sigaction(numbers[i], NULL, &now) == 0 && now.sa_handler == SIG_DFL && !sigismember(&blocked, numbers[i]))
            sigaddset(&dog.signals, numbers[i]);
    }
    pthread_sigmask(SIG_BLOCK, &dog.signals, NULL);
    dog.status_file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
    if (retex_budget_create(&dog.budget, NULL) != 0) {
        fprintf(stderr, "%s: error: out of memory\n", tool);
        exit(EXIT_STATUS);
    }
}

RetexBudget *watchdog_budget(void)
{
    return dog.budget;
}

/* ---- the end ---- */

static _Noreturn void raise_again(int number)
{
    sigset_t one;

    signal(number, SIG_DFL);
    sigemptyset(&one);
    sigaddset(&one, number);
    pthread_sigmask(SIG_UNBLOCK, &one, NULL);
    raise(number);
    _exit(128 + number);
}

static _Noreturn void wait_for_the_end(void)
{
    for (;;)
        pause();
}

/* Print with one system call, not with stdio: another thread may hold its locks. */
static void say(const char *text)
{
    char line[2048];
    int n =
        snprintf(line, sizeof line - 1, "%s%s: error: %s", atomic_load(&dog.bar_is_open) ? "\n" : "", dog.tool, text);

    n = n < (int)sizeof line - 1 ? n : (int)sizeof line - 2;
    line[n++] = '\n';
    (void)!write(STDERR_FILENO, line, (size_t)n);
}

/* End the tool. Callers must have succeeded in take_on. `kept` continues the message, about saved results, or is
 * "". */
static _Noreturn void end_tool(const char *kept)
{
    const int number = atomic_load(&dog.number);
    char text[1536];

    if (number)
        snprintf(text, sizeof text, "ended by %s%s", signal_name(number), kept);
    else if (atomic_load(&dog.too_large))
        snprintf(text, sizeof text, "out of memory: this takes more than the %.0f MB of --max-memory",
                 (double)retex_budget_memory(dog.budget) / (1 << 20));
    else
        snprintf(text, sizeof text, "not done within the %g s of --max-time%s", retex_budget_seconds(dog.budget), kept);
    WatchdogLast *last = atomic_load(&dog.last);
    if (last)
        last(text);
    retex_pending_files_remove(); /* from now on no temporary file is renamed */
    const char *other = atomic_load(&dog.remove);
    if (other)
        unlink(other);
    if (number != SIGPIPE) /* by which programs end without a word */
        say(text);
    if (number)
        raise_again(number);
    _exit(EXIT_STATUS);
}

/* Whether `who` ends the tool: true for the first one who asks. */
static int take_on(int who)
{
    int nobody = 0;

    return atomic_compare_exchange_strong(&dog.ending, &nobody, who) || nobody == who;
}

/* The library's message about stopped work begins with "stopped". Return the rest, or "". */
static const char *what_was_kept(const char *why)
{
    static const char begin[] = "stopped";
    return strncmp(why, begin, sizeof begin - 1) == 0 ? why + sizeof begin - 1 : "";
}

static int is_stopped(void)
{
    return dog.budget && retex_budget_is_stopped(dog.budget);
}

void watchdog_fail(const char *why)
{
    if (!take_on(THE_WORK))
        wait_for_the_end();
    if (is_stopped() && !atomic_load(&dog.end_is_right))
        end_tool(what_was_kept(why));
}

void watchdog_done(void)
{
    watchdog_fail("");
}

void watchdog_end_by_pipe(void)
{
    if (dog.ignores_pipe)
        return;
    watchdog_fail("");
    atomic_store(&dog.number, SIGPIPE);
    end_tool("");
}

void watchdog_go_on(void)
{
    if (atomic_load(&dog.ending) == THE_DOG)
        wait_for_the_end();
}

void watchdog_let_keep(int on)
{
    atomic_store(&dog.may_keep, on);
}

void watchdog_end_is_right(int on)
{
    atomic_store(&dog.end_is_right, on);
}

void watchdog_note_bar(int open)
{
    atomic_store(&dog.bar_is_open, open);
}

void watchdog_remove(const char *path)
{
    atomic_store(&dog.remove, path);
}

void watchdog_at_end(WatchdogLast *last)
{
    atomic_store(&dog.last, last);
}

/* ---- the thread ---- */

static int take_signal(int milliseconds)
{
    const struct timespec most = {milliseconds / 1000, milliseconds % 1000 * 1000000L};
    const int number = sigtimedwait(&dog.signals, NULL, &most);

    return number > 0 ? number : 0;
}

/* Resident memory of the process. */
static uint64_t bytes_in_use(void)
{
    char text[128] = "";
    unsigned long long pages = 0;

    if (dog.status_file < 0 || pread(dog.status_file, text, sizeof text - 1, 0) <= 0 ||
        sscanf(text, "%*u %llu", &pages) != 1)
        return 0;
    return (uint64_t)pages * (uint64_t)sysconf(_SC_PAGESIZE);
}

/* Time until a limit can be reached. A process can touch at most a few bytes of new memory per nanosecond. */
static int milliseconds_to_wait(uint64_t in_use)
{
    const uint64_t most = retex_budget_memory(dog.budget);
    double milliseconds = IDLE_MILLISECONDS;

    if (most)
        milliseconds = fmin(milliseconds, in_use < most ? (double)(most - in_use) / 4e6 : 0);
    milliseconds = fmin(milliseconds, 1e3 * retex_budget_seconds_left(dog.budget));
    return milliseconds < LEAST_MILLISECONDS ? LEAST_MILLISECONDS : (int)milliseconds;
}

/* Wait for stopped work, which may end the tool itself. */
static void wait_for_work(void)
{
    const double until = retex_clock_seconds() + 1e-3 * KEEP_MILLISECONDS;

    while (retex_budget_is_held(dog.budget) || retex_clock_seconds() < until) {
        const int number = take_signal(20);
        if (number)
            raise_again(number);
    }
}

static void *watch(void *started)
{
    sem_post(started);
    for (;;) {
        const uint64_t in_use = bytes_in_use(), most = retex_budget_memory(dog.budget);
        const int number = take_signal(milliseconds_to_wait(in_use));
        if (number && (atomic_load(&dog.number) || atomic_load(&dog.ending)))
            raise_again(number);
        if (number)
            atomic_store(&dog.number, number);
        else if (most && in_use > most)
            atomic_store(&dog.too_large, 1);
        else if (retex_budget_seconds_left(dog.budget) > 0)
            continue;
        if (atomic_load(&dog.may_keep) && !atomic_load(&dog.too_large)) {
            retex_budget_stop(dog.budget);
            wait_for_work();
        }
        if (take_on(THE_DOG))
            end_tool("");
    }
    return NULL;
}

void watchdog_start(void)
{
    static sem_t started;
    pthread_t thread;
    pthread_attr_t attributes;

    if (atomic_exchange(&dog.started, 1))
        return;
    sem_init(&started, 0, 0);
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, STACK_BYTES);
    pthread_attr_setdetachstate(&attributes, PTHREAD_CREATE_DETACHED);
    if (pthread_create(&thread, &attributes, watch, &started) != 0) /* signals keep their default action */
        pthread_sigmask(SIG_UNBLOCK, &dog.signals, NULL);
    else /* a tool that forks while a thread starts may copy locks that the thread holds: the address sanitizer's */
        while (sem_wait(&started) != 0)
            continue;
    pthread_attr_destroy(&attributes);
}
