/* The budget of decoding one image: what is left of the server's memory, its limit of pixels, and a time of its own. */
#ifndef RETEX_SERVE_DECODING_H
#define RETEX_SERVE_DECODING_H

#include <retex/budget.h>

/* `of` may be NULL. deadline: of retex_clock_seconds; most: seconds at most. */
int decoding_budget(RetexBudget **budget, const RetexBudget *of, double deadline, double most, RetexError *err);

#endif
