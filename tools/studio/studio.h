/* The server: what its requests and its programs share. */
#ifndef RETEX_STUDIO_STUDIO_H
#define RETEX_STUDIO_STUDIO_H

#include "changes.h"
#include "events.h"
#include "gate.h"
#include "jobs.h"
#include "places.h"
#include "preview.h"
#include "project.h"
#include "thumbs.h"
#include "watch.h"

typedef struct Studio {
    Gate gate;
    Changes changes;
    Places places;
    Watch watch;     /* of the model's file */
    Project project; /* and of its project's */
    Jobs jobs;
    Preview preview;
    Thumbs thumbs;
    ProgramLimits limits;
    int is_quitting; /* guarded by changes: a window has asked for the end */
} Studio;

/* ---- http.c ---- */

typedef struct Http Http;

/* Listen on 127.0.0.1; the port becomes that of studio->gate. */
int http_open(Http **http, Studio *studio, int port, RetexError *err);
/* Answers that are on their way have two seconds to arrive. All that wait must have been woken: changes_end. */
void http_close(Http **http);

#endif
