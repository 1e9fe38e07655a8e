/* See <retex/budget.h>. The counters are atomic: all threads of the work charge them, and another thread may stop
 * it. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>

#include <retex/budget.h>
#include <retex/clock.h>
#include <retex/host/assert.h>

#include "base/clock.h"

struct RetexBudget {
    atomic_int stopped, held;
    _Atomic uint64_t memory, used; /* bytes; memory 0 = no limit */
    atomic_long pixels;
    atomic_llong deadline; /* nanoseconds of the monotonic clock; 0 = none */
    double seconds;        /* what the deadline was made of, for messages */
};

int retex_budget_create(RetexBudget **budget, RetexError *err)
{
    *budget = calloc(1, sizeof **budget);
    return *budget ? 0 : retex_fail(err, RETEX_ENOMEM, "out of memory");
}

void retex_budget_close(RetexBudget **budget)
{
    if (!budget)
        return;
    free(*budget);
    *budget = NULL;
}

void retex_budget_set_memory(RetexBudget *budget, uint64_t bytes)
{
    atomic_store(&budget->memory, bytes);
}

uint64_t retex_budget_memory(const RetexBudget *budget)
{
    return budget ? atomic_load(&budget->memory) : 0;
}

void retex_budget_set_pixels(RetexBudget *budget, long pixels)
{
    atomic_store(&budget->pixels, pixels);
}

long retex_budget_pixels(const RetexBudget *budget)
{
    return budget ? atomic_load(&budget->pixels) : 0;
}

uint64_t retex_budget_left(const RetexBudget *budget)
{
    const uint64_t memory = retex_budget_memory(budget), used = memory ? atomic_load(&budget->used) : 0;

    return !memory ? UINT64_MAX : used < memory ? memory - used : 0;
}

int retex_budget_charge(RetexBudget *budget, uint64_t bytes, const char *what, RetexError *err)
{
    if (!budget)
        return 0;
    const uint64_t memory = atomic_load(&budget->memory);
    uint64_t used = atomic_load(&budget->used);
    do {
        if (memory && (used >= memory || bytes > memory - used))
            return retex_fail(err, RETEX_ELIMIT, "%s: this takes more than the %.0f MB of --max-memory", what,
                              (double)memory / (1 << 20));
    } while (!atomic_compare_exchange_weak(&budget->used, &used, used + bytes));
    return 0;
}

void retex_budget_release(RetexBudget *budget, uint64_t bytes)
{
    if (!budget)
        return;
    const uint64_t used = atomic_fetch_sub(&budget->used, bytes);
    RETEX_ASSERT(used >= bytes); /* what is released has been charged */
    (void)used;
}

void retex_budget_stop(RetexBudget *budget)
{
    atomic_store(&budget->stopped, 1);
}

void retex_budget_set_seconds(RetexBudget *budget, double seconds)
{
    budget->seconds = seconds;
    atomic_store(&budget->deadline, seconds > 0 ? retex_clock_nanoseconds() + llrint(1e9 * fmin(seconds, 1e9)) : 0);
}

double retex_budget_seconds(const RetexBudget *budget)
{
    return budget->seconds;
}

double retex_budget_seconds_left(const RetexBudget *budget)
{
    const long long deadline = atomic_load_explicit(&budget->deadline, memory_order_relaxed);

    return deadline ? 1e-9 * (double)(deadline - retex_clock_nanoseconds()) : INFINITY;
}

static int is_late(const RetexBudget *budget)
{
    return retex_budget_seconds_left(budget) <= 0;
}

int retex_budget_is_stopped(const RetexBudget *budget)
{
    return budget && (atomic_load_explicit(&budget->stopped, memory_order_relaxed) || is_late(budget));
}

int retex_budget_check(const RetexBudget *budget, RetexError *err)
{
    if (!retex_budget_is_stopped(budget))
        return 0;
    if (atomic_load(&budget->stopped))
        return retex_fail(err, RETEX_ESTOPPED, "stopped");
    return retex_fail(err, RETEX_ELIMIT, "this takes longer than the %g s of --max-time", budget->seconds);
}

void retex_budget_hold(RetexBudget *budget)
{
    if (budget)
        atomic_store(&budget->held, 1);
}

int retex_budget_is_held(const RetexBudget *budget)
{
    return budget && atomic_load(&budget->held);
}
