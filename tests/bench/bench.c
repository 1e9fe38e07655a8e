/* make bench: how much faster one way of doing something is than another.
 *
 * Only ratios are printed: figures of different machines or of a busy hour cannot be compared, the two sides of a pair
 * can. They are measured in turn, one call or a few of each, several times over; every turn gives a ratio, of which the
 * table has the median and the quartiles. Times are of the processor and all work is done by one thread, so that
 * neighbours disturb little. */
#include "bench.h"

#include <retex/retex.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

enum { TURNS_MAX = 21 };
#define TURN_SECONDS 0.01 /* each side of a turn takes at least so long */
#define PAIR_SECONDS 5.0  /* a pair gets fewer turns, but at least 5, beyond this */

volatile float bench_sink;

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Seconds a call. */
static double measure(void (*side)(void *), void *context, long calls)
{
    double began = cpu_seconds();
    for (long i = 0; i < calls; i++)
        side(context);
    return (cpu_seconds() - began) / (double)calls;
}

/* How many calls fill a turn; also warms up caches and loads what is loaded once. */
static long find_calls(void (*side)(void *), void *context)
{
    long calls = 1;
    side(context);
    while (calls < 1 << 24 && measure(side, context, calls) * (double)calls < TURN_SECONDS)
        calls *= 2;
    return calls;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void bench_pair(const char *name, void (*fast)(void *), void (*slow)(void *), void *context)
{
    double ratios[TURNS_MAX], began;
    long fast_calls = find_calls(fast, context), slow_calls = find_calls(slow, context);
    int turns = 0;
    for (began = cpu_seconds(); turns < TURNS_MAX && (turns < 5 || cpu_seconds() - began < PAIR_SECONDS); turns++) {
        double a = turns & 1 ? measure(fast, context, fast_calls) : 0;
        double b = measure(slow, context, slow_calls);
        a = turns & 1 ? a : measure(fast, context, fast_calls);
        ratios[turns] = b / a;
    }
    qsort(ratios, (size_t)turns, sizeof *ratios, ascending);
    printf("  %-74s %8.2f  %8.2f .. %-8.2f %3d\n", name, ratios[turns / 2], ratios[turns / 4],
           ratios[turns - 1 - turns / 4], turns);
    fflush(stdout);
}

void bench_ratio(const char *name, double ratio)
{
    printf("  %-74s %8.2f\n", name, ratio);
}

void bench_rate(const char *name, void (*side)(void *), void *context, double amount)
{
    double best = 1e30;
    for (int turn = 0; turn < 7; turn++) {
        double seconds = measure(side, context, find_calls(side, context));
        best = seconds < best ? seconds : best;
    }
    bench_ratio(name, amount / best);
}

void bench_section(const char *title)
{
    printf("\n%-76s %8s  %20s %3s\n", title, "ratio", "quartiles", "of");
}

static void describe_machine(void)
{
    char line[256], model[256] = "unknown processor";
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "model name", 10) == 0 && strchr(line, ':')) {
            snprintf(model, sizeof model, "%s", strchr(line, ':') + 2);
            model[strcspn(model, "\n")] = 0;
            break;
        }
    if (file)
        fclose(file);
    double load = 0;
    if (getloadavg(&load, 1) != 1)
        load = 0;
    printf("machine: %s, %ld cores, load %.1f; compiler %s; one thread, processor time\n", model,
           sysconf(_SC_NPROCESSORS_ONLN), load, __VERSION__);
}

int main(int argc, char **argv)
{
    if (argc != 3) {
        fprintf(stderr, "usage: bench SCENES FOLDER\n");
        return 2;
    }
    describe_machine();
    bench_kernels();
    bench_denoise(argv[1]);
    bench_pictures(argv[1], argv[2]);
    return 0;
}
