/* Jobs: programs of retex that a window starts, and what they say. Long ones run one after the other; of others a few
 * run beside. The thread that runs programs calls jobs_poll and jobs_go_on; the other calls are for any thread. */
#ifndef RETEX_STUDIO_JOBS_H
#define RETEX_STUDIO_JOBS_H

#include <jansson.h>
#include <poll.h>

#include "changes.h"
#include "job_line.h"

enum { JOBS_MOST = 200, JOBS_FILES = 16 }; /* that are remembered; that are read at once */

typedef struct Job Job;

typedef struct Jobs {
    Changes *changes;
    Job *jobs[JOBS_MOST]; /* in the order of their numbers; guarded by the lock of changes */
    int count, newest;    /* newest: the last number that was given */
} Jobs;

void jobs_open(Jobs *jobs, Changes *changes);
void jobs_close(Jobs *jobs);

/* Add a job from what a window sends, {"tool", "args", "label"}. Its number, or below 0 and an error. */
int jobs_add(Jobs *jobs, const json_t *asked, const ProgramLimits *limits, const Model *model, RetexError *err);
/* End a job as Ctrl-C does, so that a render keeps its rows; a second time, at once. RETEX_ENOTFOUND: there is no such
 * job, or it has ended. */
int jobs_stop(Jobs *jobs, int number, RetexError *err);
/* All jobs, or those that have changed since a number of changes; with the lock. */
json_t *jobs_list(const Jobs *jobs, uint64_t since);

/* ---- for the thread that runs programs ---- */

/* The files to wait for. */
int jobs_poll(Jobs *jobs, struct pollfd files[JOBS_FILES]);
/* Read what programs have said, note which have ended, and start those whose turn it is. */
void jobs_go_on(Jobs *jobs);
/* Send all that run a signal, and forget those that wait. Returns how many run. */
int jobs_end(Jobs *jobs, int number);

#endif
