/* An animation: the frames that POV-Ray would render, and what a scene knows of each: clock, frame_number and so on. */
#ifndef RENDERER_JOB_ANIMATION_H
#define RENDERER_JOB_ANIMATION_H

/* Begin with ANIMATION_INIT. Frame numbers are 0 to 999999999. */
typedef struct Animation {
    int first_frame, last_frame;    /* last_frame -1: no animation, a still picture */
    double first_clock, last_clock; /* clock at these frames */
    int cyclic;                     /* 1: last_clock belongs to the frame after the last, which looks as the first */
} Animation;
#define ANIMATION_INIT                                                                                                 \
    {                                                                                                                  \
        1, -1, 0, 1, 0                                                                                                 \
    }

enum { ANIMATION_DECLARES = 8, ANIMATION_DECLARE_SIZE = 48 };

/* The values that a scene has at a frame, each as a NAME=VALUE of SdlOptions: those that POV-Ray 3.7 computes. clock is
 * rounded to single precision, and a cyclic animation has one more final_frame. The clock of an animation of one frame,
 * which POV-Ray has none for, is first_clock. */
void animation_declares(const Animation *animation, int frame, char declares[][ANIMATION_DECLARE_SIZE]);

/* Whether a NAME=VALUE sets one of these values. */
int animation_is_declare(const char *declare);

#endif
