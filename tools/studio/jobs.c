/* See jobs.h. */
#include "jobs.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include <retex/clock.h>

#include "child.h"
#include "said.h"
#include "reply.h"

enum { BESIDE = 4, NICE = 10 }; /* how many jobs run beside a long one; what they leave to the server */

typedef enum JobState { JOB_WAITING, JOB_RUNNING, JOB_DONE, JOB_FAILED, JOB_STOPPED } JobState;
static const char *const state_names[] = {"waiting", "running", "done", "failed", "stopped"};

struct Job {
    int number;
    JobState state;
    uint64_t changed; /* number of the last change */
    json_t *asked;    /* what the window sent */
    Line line;
    const Model *model;
    int is_long, is_confined, stops; /* stops: how often it was told to end */
    Child child;
    int status; /* of its end: exit status, or 128 plus a signal's number */
    double started, seconds;
    uint64_t memory; /* peak, bytes */
    Said said;
};

static int is_over(const Job *job)
{
    return job->state >= JOB_DONE;
}

static void note(Jobs *jobs, Job *job)
{
    job->changed = changes_note(jobs->changes);
}

void jobs_open(Jobs *jobs, Changes *changes)
{
    *jobs = (Jobs){.changes = changes};
}

static void free_job(Job *job)
{
    json_decref(job->asked);
    line_free(&job->line);
    said_free(&job->said);
    free(job);
}

void jobs_close(Jobs *jobs)
{
    for (int i = 0; i < jobs->count; i++)
        free_job(jobs->jobs[i]);
    jobs->count = 0;
}

/* ---- what windows ask for ---- */

/* Forget the oldest job that has ended. 0: all still run or wait. */
static int forget_one(Jobs *jobs)
{
    int i = 0;
    while (i < jobs->count && !is_over(jobs->jobs[i]))
        i++;
    if (i == jobs->count)
        return 0;
    free_job(jobs->jobs[i]);
    jobs->count--;
    memmove(jobs->jobs + i, jobs->jobs + i + 1, (size_t)(jobs->count - i) * sizeof *jobs->jobs);
    return 1;
}

int jobs_add(Jobs *jobs, const json_t *asked, const ProgramLimits *limits, const Model *model, RetexError *err)
{
    Job *job = calloc(1, sizeof *job);
    const char *tool = json_string_value(json_object_get(asked, "tool"));
    if (!job)
        return retex_fail(err, RETEX_ENOMEM, "not enough memory");
    const int code = line_make(&job->line, tool, json_object_get(asked, "args"), limits, model, err);
    if (code) {
        free(job);
        return code;
    }
    job->asked = json_deep_copy(asked);
    job->model = model;
    job->is_long = line_is_long(tool, json_object_get(asked, "args"));
    job->is_confined = !limits->is_unsafe;
    job->child = (Child)CHILD_NONE;
    changes_lock(jobs->changes);
    const int has_room = jobs->count < JOBS_MOST || forget_one(jobs);
    const int number = job->number = jobs->newest + 1;
    if (job->asked && has_room) {
        jobs->jobs[jobs->count++] = job;
        jobs->newest = number;
        note(jobs, job);
        job = NULL;
    }
    changes_unlock(jobs->changes);
    changes_wake(jobs->changes);
    if (!job)
        return number;
    free_job(job);
    return has_room ? retex_fail(err, RETEX_ENOMEM, "not enough memory")
                    : retex_fail(err, RETEX_ELIMIT, "too many jobs wait");
}

int jobs_stop(Jobs *jobs, int number, RetexError *err)
{
    Job *job = NULL;
    changes_lock(jobs->changes);
    for (int i = 0; i < jobs->count; i++)
        if (jobs->jobs[i]->number == number && !is_over(jobs->jobs[i]))
            job = jobs->jobs[i];
    if (job) {
        if (job->state == JOB_WAITING)
            job->state = JOB_STOPPED;
        else
            child_signal(&job->child, job->stops < 2 ? SIGINT : SIGKILL);
        job->stops++;
        note(jobs, job);
    }
    changes_unlock(jobs->changes);
    return job ? RETEX_OK : retex_fail(err, RETEX_ENOTFOUND, "job %d does not run", number);
}

static json_t *describe(const Job *job)
{
    const double seconds = job->state == JOB_RUNNING ? retex_clock_seconds() - job->started : job->seconds;
    json_t *text = json_deep_copy(job->asked), *said = said_json(&job->said);
    json_t *rest =
        json_pack("{s:i, s:s, s:f, s:I, s:b}", "job", job->number, "state", state_names[job->state], "seconds", seconds,
                  "memory", (json_int_t)job->memory, "stopping", job->stops && !is_over(job));
    if (rest && is_over(job) && job->started > 0)
        json_object_set_new(rest, "status", json_integer(job->status));
    if (json_object_update(text, rest) || json_object_update(text, said)) {
        json_decref(text);
        text = NULL;
    }
    json_decref(rest);
    json_decref(said);
    return text;
}

json_t *jobs_list(const Jobs *jobs, uint64_t since)
{
    json_t *list = json_array();
    for (int i = 0; i < jobs->count; i++)
        if (jobs->jobs[i]->changed > since && json_array_append_new(list, describe(jobs->jobs[i]))) {
            json_decref(list);
            return NULL;
        }
    return list;
}

/* ---- running ---- */

int jobs_poll(Jobs *jobs, struct pollfd files[JOBS_FILES])
{
    int count = 0;
    changes_lock(jobs->changes);
    for (int i = 0; i < jobs->count && count < JOBS_FILES - 1; i++) {
        const Child *child = &jobs->jobs[i]->child;
        if (child->output >= 0)
            files[count++] = (struct pollfd){child->output, POLLIN, 0};
        if (child->message >= 0)
            files[count++] = (struct pollfd){child->message, POLLIN, 0};
    }
    changes_unlock(jobs->changes);
    return count;
}

/* Read what there is. 1: something has changed. */
static int read_file(Job *job, int *file, int is_output)
{
    char bytes[8192];
    int changed = 0;
    while (*file >= 0) {
        const ssize_t got = read(*file, bytes, sizeof bytes);
        if (got > 0) {
            changed |=
                is_output ? said_output(&job->said, bytes, (size_t)got) : said_message(&job->said, bytes, (size_t)got);
        } else if (got < 0 && errno == EINTR) {
            continue;
        } else if (got < 0 && errno == EAGAIN) {
            break;
        } else {
            child_close_file(file);
        }
    }
    return changed;
}

static void end_job(Jobs *jobs, Job *job, int status)
{
    job->status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    job->seconds = retex_clock_seconds() - job->started;
    job->state = WIFEXITED(status) && job->status < 2 ? JOB_DONE : job->stops ? JOB_STOPPED : JOB_FAILED;
    said_end(&job->said, job->state == JOB_DONE);
    if (WIFSIGNALED(status) && !job->stops)
        said_line(&job->said, "retex-studio: the program was ended by a signal: %s", strsignal(WTERMSIG(status)));
    note(jobs, job);
}

static void follow(Jobs *jobs, Job *job)
{
    int status;
    uint64_t memory = 0;
    const int has_ended = child_reap(&job->child, &status, &memory);
    if (read_file(job, &job->child.output, 1) | read_file(job, &job->child.message, 0))
        note(jobs, job);
    if (!has_ended)
        return;
    child_close(&job->child);
    job->memory = memory;
    end_job(jobs, job, status);
}

static void start(Jobs *jobs, Job *job)
{
    const ChildParams params = {.words = job->line.words,
                                .folder = job->model->folder,
                                .writes = job->is_confined ? job->model->written : NULL,
                                .writes_folder = job->model->top,
                                .nice = NICE};
    RetexError err = {0};
    job->started = retex_clock_seconds();
    job->state = JOB_RUNNING;
    if (child_start(&job->child, &params, &err)) {
        said_line(&job->said, "retex-studio: %s", err.message);
        job->state = JOB_FAILED;
        job->status = 2;
    }
    note(jobs, job);
}

void jobs_go_on(Jobs *jobs)
{
    int running[2] = {0};
    changes_lock(jobs->changes);
    for (int i = 0; i < jobs->count; i++) {
        Job *job = jobs->jobs[i];
        if (job->state == JOB_RUNNING)
            follow(jobs, job);
        running[job->is_long] += job->state == JOB_RUNNING;
    }
    for (int i = 0; i < jobs->count && !jobs->changes->is_ending; i++) {
        Job *job = jobs->jobs[i];
        if (job->state == JOB_WAITING && running[job->is_long] < (job->is_long ? 1 : BESIDE)) {
            start(jobs, job);
            running[job->is_long]++;
        }
    }
    changes_unlock(jobs->changes);
}

int jobs_end(Jobs *jobs, int number)
{
    int running = 0;
    changes_lock(jobs->changes);
    for (int i = 0; i < jobs->count; i++) {
        Job *job = jobs->jobs[i];
        if (job->state == JOB_WAITING)
            job->state = JOB_STOPPED;
        if (job->state != JOB_RUNNING)
            continue;
        running++;
        job->stops++;
        if (number)
            child_signal(&job->child, number);
    }
    changes_unlock(jobs->changes);
    return running;
}
