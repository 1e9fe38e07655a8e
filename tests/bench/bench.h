/* Measuring pairs: see bench.c. */
#ifndef BENCH_H
#define BENCH_H

/* Print how many times as long slow takes as fast. Both do the same amount of work. */
void bench_pair(const char *name, void (*fast)(void *context), void (*slow)(void *context), void *context);
/* A line of the table that was not measured by time: a ratio as it is. */
void bench_ratio(const char *name, double ratio);
/* Print how many times `amount` is done in a second: what a ratio stands on, on this machine and at this hour. */
void bench_rate(const char *name, void (*side)(void *context), void *context, double amount);
void bench_section(const char *title);

extern volatile float bench_sink; /* where results go, so that computing them is not left out */

void bench_kernels(void);
void bench_denoise(const char *scenes /* folder */);
void bench_pictures(const char *scenes /* folder */, const char *folder /* for files of its own */);

#endif
