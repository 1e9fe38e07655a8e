/* See <retex/clock.h>. Private to libretex. */
#ifndef RETEX_BASE_CLOCK_H
#define RETEX_BASE_CLOCK_H

#include <retex/clock.h>

/* What retex_clock_seconds is made of. */
long long retex_clock_nanoseconds(void);

#endif
