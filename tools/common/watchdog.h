/* The watchdog ends a tool early: after SIGINT, SIGTERM or SIGHUP, or when a limit is reached. A thread of its own
 * waits for these, so that it can respond at once while other threads are busy, in any library. It removes unfinished
 * files, prints one line, and raises the signal again. A limit ends the tool with exit status 2. */
#ifndef RETEX_WATCHDOG_H
#define RETEX_WATCHDOG_H

#include <retex/budget.h>

/* Call first, before other threads start: blocks the signals, so that only the watchdog receives them. Signals that are
 * ignored, for instance under nohup, stay ignored. SIGPIPE is ignored from now on: writing to a pipe that nobody reads
 * is an error like a full disk, see watchdog_end_by_pipe. */
void watchdog_prepare(const char *tool);
void watchdog_start(void);

/* The budget for the params of long operations. The watchdog stops it when the tool has to end. */
RetexBudget *watchdog_budget(void);

/* While on, the watchdog waits for stopped work, which may save its results: for a short time until the work calls
 * retex_budget_hold, then as long as it takes. The work returns through watchdog_fail. A second signal ends the tool at
 * once. */
void watchdog_let_keep(int on);

/* While on, a signal, or the end of --max-time, is how the tool is meant to end: the work, which watchdog_let_keep lets
 * finish, returns without a message. */
void watchdog_end_is_right(int on);

/* Call before an error message. Does not return if the error is a consequence of the watchdog's stop. */
void watchdog_fail(const char *why);
/* Call when the tool is done. */
void watchdog_done(void);
/* Call when a write has failed because the reader of a pipe has gone: ends the tool by SIGPIPE, without a message.
 * Returns if SIGPIPE was ignored when the tool was started; the failure is then an error like others. */
void watchdog_end_by_pipe(void);
/* Call before any other message. Does not return if the watchdog is ending the tool, whose message is the last one. */
void watchdog_go_on(void);

/* Tell whether the cursor is at the end of a progress bar; a message then begins on a new line. */
void watchdog_note_bar(int open);

/* Set another file to remove when the tool is ended early, which belongs to an unfinished output. NULL = none. */
void watchdog_remove(const char *path);

/* A callback before the tool is ended early. It runs in any thread, while other threads run. why: "ended by
 * SIGTERM". */
typedef void WatchdogLast(const char *why);
void watchdog_at_end(WatchdogLast *last /* NULL = none */);

#endif
