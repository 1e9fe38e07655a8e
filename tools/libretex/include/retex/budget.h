/* What a piece of work may take, and the way to end it early: memory, time, and somebody who says stop. A budget is
 * handed down in the params of long work, whose threads charge it and ask it; NULL = no limits. Every call is safe from
 * any thread. */
#ifndef RETEX_BUDGET_H
#define RETEX_BUDGET_H

#include <stdint.h>
#include <retex/error.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct RetexBudget RetexBudget;

int retex_budget_create(RetexBudget **budget, RetexError *err);
void retex_budget_close(RetexBudget **budget); /* NULL and pointers to NULL are fine */

/* ---- stopping ---- */

/* Let the work end as soon as it can, with RETEX_ESTOPPED. */
void retex_budget_stop(RetexBudget *budget);
/* Let it end so many seconds from now, with RETEX_ELIMIT; 0 = never. */
void retex_budget_set_seconds(RetexBudget *budget, double seconds);
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
