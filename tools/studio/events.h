/* Server-sent events: a window is told which jobs, which project and which model have changed since last time. */
#ifndef RETEX_STUDIO_EVENTS_H
#define RETEX_STUDIO_EVENTS_H

#include "reply.h"

struct Studio;

/* A stream of what changes after a number of changes. After 0 it begins with all that is there, so that a window misses
 * nothing between its first questions and its stream. */
Reply events_stream(struct Studio *studio, uint64_t since);

#endif
