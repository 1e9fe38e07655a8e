/* The one clock of this house: for durations, deadlines and locks that are waited for only so long. */
#ifndef RETEX_CLOCK_H
#define RETEX_CLOCK_H

#include <time.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

/* Time since some moment before the program began, by a clock that never goes back. */
double retex_clock_seconds(void);

/* The time of day so many seconds from now, 0 or more: what pthread_mutex_timedlock and its like take. */
struct timespec retex_clock_time_after(double seconds);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
