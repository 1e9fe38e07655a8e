/* See retex/budget.h. Counters are atomic: they are charged by all threads of a piece of work, and stopped by others. */
#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <time.h>

#include <retex/budget.h>

struct RetexBudget {
    atomic_int stopped, held;
    atomic_llong deadline; /* nanoseconds of the monotonic clock; 0 = none */
    double seconds;        /* what the deadline was made of, for messages */
};

static long long nanoseconds_now(void)
{
    struct timespec t;

    clock_gettime(CLOCK_MONOTONIC, &t);
    return t.tv_sec * 1000000000LL + t.tv_nsec;
}

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

void retex_budget_stop(RetexBudget *budget)
{
    atomic_store(&budget->stopped, 1);
}

void retex_budget_set_seconds(RetexBudget *budget, double seconds)
{
    budget->seconds = seconds;
    atomic_store(&budget->deadline, seconds > 0 ? nanoseconds_now() + llrint(1e9 * fmin(seconds, 1e9)) : 0);
}

static int is_late(const RetexBudget *budget)
{
    const long long deadline = atomic_load_explicit(&budget->deadline, memory_order_relaxed);

    return deadline && nanoseconds_now() >= deadline;
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
    return retex_fail(err, RETEX_ELIMIT, "this takes longer than the %g seconds of max-time", budget->seconds);
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
