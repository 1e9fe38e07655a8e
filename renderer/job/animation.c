/* See animation.h. */
#include <stdio.h>
#include <string.h>
#include "job/animation.h"

static const char *const names[ANIMATION_DECLARES] = {"clock",         "clock_delta", "clock_on",      "frame_number",
                                                      "initial_frame", "final_frame", "initial_clock", "final_clock"};

void animation_declares(const Animation *a, int frame, char declares[][ANIMATION_DECLARE_SIZE])
{
    const int final_frame = a->last_frame + a->cyclic, steps = final_frame - a->first_frame;
    const double delta = steps > 0 ? (a->last_clock - a->first_clock) / steps : 0;
    const double clock = a->first_clock + delta * (frame - a->first_frame);
    const double values[ANIMATION_DECLARES] = {
        (double)(float)clock, delta, 1, frame, a->first_frame, final_frame, a->first_clock, a->last_clock};
    for (int k = 0; k < ANIMATION_DECLARES; k++)
        snprintf(declares[k], ANIMATION_DECLARE_SIZE, "%s=%.17g", names[k], values[k]);
}

int animation_is_declare(const char *declare)
{
    for (int k = 0; k < ANIMATION_DECLARES; k++)
        if (strlen(names[k]) == strcspn(declare, "=") && !strncmp(declare, names[k], strlen(names[k])))
            return 1;
    return 0;
}
