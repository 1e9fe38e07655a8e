/* Server-sent events: a window is told which jobs, which project and which model have changed since last time. */
#ifndef RETEX_STUDIO_EVENTS_H
#define RETEX_STUDIO_EVENTS_H

#include "reply.h"

struct Studio;

/* A stream of what changes after a number of changes. */
Reply events_stream(struct Studio *studio, uint64_t since);

#endif
