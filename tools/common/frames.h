/* Frames of an animation: the option --frames, and file names that hold the number of a frame. */
#ifndef RETEX_FRAMES_H
#define RETEX_FRAMES_H

#include "common/cli.h"

/* Frames first, first + step, … up to last. step 0: no frames, --frames was not given. */
typedef struct FrameRange {
    int first, last, step;
} FrameRange;

enum { FRAMES_MAX = 100000 }; /* in one command */

/* Its row, for a FrameRange. */
#define FRAMES_OPTION(type, member)                                                                                    \
    {                                                                                                                  \
        "frames", 0, "A-B[xS]", "make frames A to B, every S-th; %04d in names is the frame's number",                 \
            0, CLI_CALL(type, member, frames_take)                                                                     \
    }

/* The next frame after `frame`; a loop goes while it is at most `last`. */
#define FOR_FRAMES(frame, range) for (int frame = (range).first; frame <= (range).last; frame += (range).step)

/* Parse --frames: A, A-B or A-BxS. */
void frames_take(Cli *cli, const CliOption *option, void *range);
int frames_count(const FrameRange *range);
/* Exit with an error if there are more than FRAMES_MAX. */
void frames_check_count(const Cli *cli, const FrameRange *range);

/* Exit with an error if `name` cannot name a file of each frame: `%d`, or `%04d` with any number of digits, is the
 * frame's number, `%%` a percent sign, and any other `%` an error. `what` is the file, for the message, and `written`
 * is 1 if it is an output, which must have a number if there are several frames. name NULL: no file. */
void frames_check_name(const Cli *cli, const FrameRange *range, const char *what, const char *name, int written);
/* Whether a name has a number: the file differs from frame to frame. */
int frames_has_number(const char *name);
/* The last line after --keep-going: how many frames failed. */
void frames_tell_failed(const Cli *cli, int failed, int total);
/* The name of a frame's file, after frames_check_name; the caller frees it. Exits where memory is short. NULL gives
 * NULL. */
char *frames_name(const Cli *cli, const char *name, int frame);

#endif
