/* What ends a tool before its work is done: SIGINT, SIGTERM, SIGHUP and limits. One thread waits for them, so that they
 * are answered at once whatever the others do, and whatever library they do it in. It removes unfinished files, says
 * one line, and raises the signal again; a limit ends the tool with exit status 2. */
#ifndef RETEX_WATCHDOG_H
#define RETEX_WATCHDOG_H

#include <retex/budget.h>

/* First of all, before there are other threads: from here on signals wait for the watchdog. Those that are ignored, as
 * under nohup, stay so. */
void watchdog_prepare(const char *tool);
void watchdog_start(void);

/* For the params of long work: stopped when the tool is to end. */
RetexBudget *watchdog_budget(void);

/* While on, work that is stopped is waited for, because it has something to keep: a little until it says so by
 * retex_budget_hold, then as long as it takes. It comes back through watchdog_fail. A second signal ends the tool. */
void watchdog_let_keep(int on);

/* The tool fails, and is about to say why: does not return where that is because it was stopped. */
void watchdog_fail(const char *why);
/* The tool is done. */
void watchdog_done(void);
/* The tool goes on: does not return where the watchdog is ending it, so that its word is the last. */
void watchdog_go_on(void);

/* Whether the cursor stands behind a progress bar, so that a message begins on a new line. */
void watchdog_note_bar(int open);

/* A file to be removed too should the tool be ended: what belongs to an output that is not there yet. NULL = none. */
void watchdog_remove(const char *path);

/* What is to be done before the tool is ended: in any thread, while the others run. why: "ended by SIGTERM". */
typedef void WatchdogLast(const char *why);
void watchdog_at_end(WatchdogLast *last /* NULL = nothing */);

#endif
