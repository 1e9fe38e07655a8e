/* What a piece of work may take, and the way to end it early: memory, time, and somebody who says stop. A budget is
 * handed down in the params of long work, whose threads charge it and ask it; NULL = no limits. Every call is safe from
 * any thread. */
#ifndef RETEX_BUDGET_H
#define RETEX_BUDGET_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexBudget RetexBudget;

int retex_budget_create(RetexBudget **budget, RetexError *err);
void retex_budget_close(RetexBudget **budget); /* NULL and pointers to NULL are fine */

/* ---- memory ---- */

/* So many bytes; 0 = as many as there are. */
void retex_budget_set_memory(RetexBudget *budget, uint64_t bytes);
uint64_t retex_budget_memory(const RetexBudget *budget); /* 0 where there is no limit */
uint64_t retex_budget_left(const RetexBudget *budget);   /* UINT64_MAX where there is no limit */
/* Before memory is asked for: RETEX_ELIMIT, with nothing charged, where that would be too much. `what` needs it. */
int retex_budget_take(RetexBudget *budget, uint64_t bytes, const char *what, RetexError *err);
void retex_budget_give(RetexBudget *budget, uint64_t bytes);

/* What the machine has, or what the control group leaves of it that this process is in; 0 = not known. */
uint64_t retex_machine_memory(void);

/* Of any one picture; 0, at first, = as many as there may be. */
void retex_budget_set_pixels(RetexBudget *budget, long pixels);
long retex_budget_pixels(const RetexBudget *budget);

/* ---- what a user allows ---- */

/* Begin with RETEX_LIMITS_INIT. */
typedef struct RetexLimits {
    size_t size;     /* of this struct */
    uint64_t memory; /* bytes of the process; default, 0, three quarters of retex_machine_memory() */
    double seconds;  /* default 0 = as long as it takes */
    long pixels;     /* of a picture that is read or rendered; default 2^28, 16384 x 16384 */
    long steps;      /* of reading a scene; default 200 million */
} RetexLimits;
#define RETEX_LIMITS_INIT { sizeof(RetexLimits), 0, 0, 1L << 28, 200000000 }

/* By the name of its option, without dashes: max-memory, a size as of retex_size_parse; max-time, seconds; max-pixels,
 * max-steps. RETEX_ENOTFOUND: another name; RETEX_EPARSE: no such value. */
int retex_limits_set(RetexLimits *limits, const char *name, const char *value, RetexError *err);
/* As RETEX_MAX_MEMORY, RETEX_MAX_TIME, RETEX_MAX_PIXELS and RETEX_MAX_STEPS of the environment say. */
int retex_limits_environment(RetexLimits *limits, RetexError *err);
/* Memory, pixels and, from now on, seconds. */
void retex_budget_set_limits(RetexBudget *budget, const RetexLimits *limits);

/* 512M, 1.5G, or a number of MB, each of 2^20 bytes. 1 where it is one. */
int retex_size_parse(const char *text, uint64_t *bytes);

/* ---- stopping ---- */

/* Let the work end as soon as it can, with RETEX_ESTOPPED. */
void retex_budget_stop(RetexBudget *budget);
/* Let it end so many seconds from now, with RETEX_ELIMIT; 0 = never. */
void retex_budget_set_seconds(RetexBudget *budget, double seconds);
double retex_budget_seconds(const RetexBudget *budget); /* as they were set */
/* Below 0 where they are over; infinite where there is no end. */
double retex_budget_seconds_left(const RetexBudget *budget);
/* 0 while work may go on; else the code to fail with. To be asked every few milliseconds of work. */
int retex_budget_check(const RetexBudget *budget, RetexError *err);
/* As retex_budget_check, where nobody asks why. */
int retex_budget_is_stopped(const RetexBudget *budget);

/* Work that was stopped says that it is putting away what it has: whoever stopped it should wait. */
void retex_budget_hold(RetexBudget *budget);
int retex_budget_is_held(const RetexBudget *budget);

#ifdef __cplusplus
}
#endif
#endif
