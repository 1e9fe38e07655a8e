/* Budgets: how much memory and time a piece of work may use, and a request to stop it. The params of long operations
 * take a budget; their threads charge it and check it. NULL = no limits. Every call is safe from any thread. */
#ifndef RETEX_BUDGET_H
#define RETEX_BUDGET_H

#include <stddef.h>
#include <stdint.h>
#include <retex/error.h>

#pragma GCC visibility push(default)
#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexBudget RetexBudget;

int retex_budget_create(RetexBudget **budget, RetexError *err);
void retex_budget_close(RetexBudget **budget); /* NULL and pointers to NULL are fine */

/* ---- memory ---- */

/* Set the limit in bytes; 0 = no limit. */
void retex_budget_set_memory(RetexBudget *budget, uint64_t bytes);
uint64_t retex_budget_memory(const RetexBudget *budget); /* 0 where there is no limit */
uint64_t retex_budget_left(const RetexBudget *budget);   /* UINT64_MAX where there is no limit */
/* Charge memory before it is allocated. RETEX_ELIMIT, with nothing charged, where that exceeds the limit. `what` names
 * the purpose in the message. */
int retex_budget_charge(RetexBudget *budget, uint64_t bytes, const char *what, RetexError *err);
void retex_budget_release(RetexBudget *budget, uint64_t bytes);

/* The memory of the machine, or the limit of the control group that this process is in; 0 = not known. */
uint64_t retex_machine_memory(void);

/* The limit on pixels of any one picture; 0, the default, = none. */
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
    unsigned given;  /* written by the calls below: which limits were set by name */
} RetexLimits;
#define RETEX_LIMITS_INIT { sizeof(RetexLimits), 0, 0, 1L << 28, 200000000, 0 }

/* Set a limit by the name of its option, without dashes: max-memory, a size as for retex_size_parse; max-time, seconds;
 * max-pixels, max-steps. RETEX_ENOTFOUND: unknown name; RETEX_EPARSE: invalid value. */
int retex_limits_set(RetexLimits *limits, const char *name, const char *value, RetexError *err);
/* Set limits from the environment: RETEX_MAX_MEMORY, RETEX_MAX_TIME, RETEX_MAX_PIXELS and RETEX_MAX_STEPS. */
int retex_limits_environment(RetexLimits *limits, RetexError *err);
/* For safe access (<retex/access.h>): set those limits that were not set by name to 2 GB (2^31 bytes, or the default if
 * that is less), 60 seconds and the pixels of a picture of 7680 x 4320. */
void retex_limits_safe(RetexLimits *limits);
/* Apply limits to a budget: memory, pixels and, from now on, seconds. */
void retex_budget_set_limits(RetexBudget *budget, const RetexLimits *limits);

/* Parse a size: 512M, 1.5G, or a number of MB, each of 2^20 bytes. RETEX_EPARSE. */
int retex_size_parse(const char *text, uint64_t *bytes, RetexError *err);

/* ---- stopping ---- */

/* Request that the work ends as soon as it can, with RETEX_ESTOPPED. */
void retex_budget_stop(RetexBudget *budget);
/* End the work so many seconds from now, with RETEX_ELIMIT; 0 = never. */
void retex_budget_set_seconds(RetexBudget *budget, double seconds);
double retex_budget_seconds(const RetexBudget *budget); /* as they were set */
/* Negative when they are over; infinite where there is no limit. */
double retex_budget_seconds_left(const RetexBudget *budget);
/* Returns 0 while work may go on, else the code to fail with. To be called every few milliseconds of work. */
int retex_budget_check(const RetexBudget *budget, RetexError *err);
/* The same without a message. */
int retex_budget_is_stopped(const RetexBudget *budget);

/* Work that was stopped tells that it is saving its results: whoever stopped it should wait. */
void retex_budget_hold(RetexBudget *budget);
int retex_budget_is_held(const RetexBudget *budget);

#ifdef __cplusplus
}
#endif
#pragma GCC visibility pop
#endif
