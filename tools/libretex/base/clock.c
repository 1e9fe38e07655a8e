/* See retex/clock.h. */
#include <retex/clock.h>

#include "base/clock.h"

long long retex_clock_nanoseconds(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1000000000LL + t.tv_nsec;
}

double retex_clock_seconds(void)
{
    return 1e-9 * (double)retex_clock_nanoseconds();
}

struct timespec retex_clock_time_after(double seconds)
{
    struct timespec t;

    clock_gettime(CLOCK_REALTIME, &t);
    const long long nanoseconds = t.tv_nsec + (long long)(1e9 * seconds);
    t.tv_sec += (time_t)(nanoseconds / 1000000000);
    t.tv_nsec = (long)(nanoseconds % 1000000000);
    return t;
}
