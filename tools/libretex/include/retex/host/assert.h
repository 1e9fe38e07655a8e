/* Assertions: what the code takes for granted, where a debug build checks it: make DEBUG=1, make check-debug.
 *
 *     RETEX_ASSERT(part >= 0 && part < set->nparts);   // an index of the set's parts, not of its footprints
 *
 * They say what a reader would have to guess: of which list a number is an index, which members are NULL together, what
 * an earlier step has promised. What an input can bring about is none, but an error of the call. A release build
 * compiles the condition and never evaluates it. */
#ifndef RETEX_HOST_ASSERT_H
#define RETEX_HOST_ASSERT_H

#ifdef RETEX_DEBUG
#undef NDEBUG
#include <assert.h>
#define RETEX_ASSERT(condition) assert(condition)
#else
#define RETEX_ASSERT(condition) ((void)(0 && (condition)))
#endif

#endif
