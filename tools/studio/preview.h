/* The preview: one process `retex-render --live`, which gets lines and answers each by a line of JSON and bytes; see
 * retex-render(1). Of each kind of answer only the newest is kept: a slow window has nothing to catch up with. */
#ifndef RETEX_STUDIO_PREVIEW_H
#define RETEX_STUDIO_PREVIEW_H

#include <jansson.h>
#include <poll.h>
#include <stdatomic.h>

#include "changes.h"
#include "child.h"
#include "job_line.h"
#include "said.h"

enum { PREVIEW_FILES = 3, PREVIEW_LINE = 1000 };

typedef enum AnswerKind {
    ANSWER_LIVE,
    ANSWER_PICTURE,
    ANSWER_SURFACES,
    ANSWER_UV,
    ANSWER_ERROR,
    ANSWER_KINDS
} AnswerKind;

/* An answer does not change once it is there; whoever takes one releases it. */
typedef struct LiveAnswer {
    atomic_int uses;
    uint64_t number; /* of the change that it is */
    char *line;      /* its JSON, with "number" */
    char *data;
    size_t bytes;
} LiveAnswer;

void live_answer_release(LiveAnswer *answer); /* NULL is fine */

/* An answer that is being read. */
typedef struct Incoming {
    char *head; /* the line so far */
    size_t head_bytes, head_space;
    json_t *json; /* of the whole line; NULL: it has not ended */
    char *data;
    size_t bytes, got;
} Incoming;

typedef struct Preview {
    Changes *changes; /* whose lock guards all that follows */
    Line next;        /* to be started; words NULL: nothing */
    const Model *next_model;
    int next_is_confined, is_stopping;
    Child child;
    double stopped;                  /* when it was told to end */
    char lines[4][PREVIEW_LINE + 2]; /* that wait for the process */
    int nlines;
    Incoming incoming;
    LiveAnswer *answers[ANSWER_KINDS];
    Said said;
    uint64_t changed; /* number of the last start or end */
} Preview;

void preview_open(Preview *preview, Changes *changes);
void preview_close(Preview *preview);

/* Start, in place of one that runs: takes over the line. */
void preview_start(Preview *preview, Line *line, const Model *model, int is_confined);
void preview_stop(Preview *preview);
/* Send a line. Of lines that the process has not taken yet, a newer `view` replaces an older one. RETEX_EINVAL: it is
 * no line; RETEX_ENOTFOUND: there is no preview. */
int preview_send(Preview *preview, const char *line, RetexError *err);
int preview_kind(const char *name, AnswerKind *kind);
/* The newest answer of a kind after a number, waiting for one for some seconds. NULL: there is none; *is_running says
 * whether one may still come, and why gets what the process said last. */
LiveAnswer *preview_answer(Preview *preview, AnswerKind kind, uint64_t after, double seconds, int *is_running,
                           char why[SAID_LINE + 1]);
/* {"running", "error"}; with the lock */
json_t *preview_json(const Preview *preview);

/* ---- for the thread that runs programs ---- */

int preview_poll(Preview *preview, struct pollfd files[PREVIEW_FILES]);
void preview_go_on(Preview *preview);
/* As jobs_end. */
int preview_end(Preview *preview, int number);

#endif
