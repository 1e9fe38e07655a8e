/* See decoding.h. */
#include "serve/files/decoding.h"

#include <math.h>

#include <retex/clock.h>

int decoding_budget(RetexBudget **budget, const RetexBudget *of, double deadline, double most, RetexError *err)
{
    const uint64_t left = retex_budget_left(of);
    int code = retex_budget_create(budget, err);
    if (code)
        return code;
    if (left != UINT64_MAX)
        retex_budget_set_memory(*budget, left ? left : 1);
    retex_budget_set_pixels(*budget, retex_budget_pixels(of));
    retex_budget_set_seconds(*budget, fmax(fmin(most, deadline - retex_clock_seconds()), 1e-3));
    return RETEX_OK;
}
