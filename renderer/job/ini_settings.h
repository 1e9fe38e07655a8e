/* The options of .ini files and switches of POV-Ray, by name. */
#ifndef RENDERER_JOB_INI_SETTINGS_H
#define RENDERER_JOB_INI_SETTINGS_H

#include <retex/error.h>
#include "job/animation.h"

enum { INI_LIST_MAX = 64 };

/* Texts that are owned. */
typedef struct IniList {
    char *items[INI_LIST_MAX];
    int count;
} IniList;

/* Begin with INI_OPTIONS_INIT; ini_close frees what it owns. */
typedef struct IniOptions {
    /* by the caller */
    int safe; /* 1: files of strangers. They name only files in their own folder, and no output */
    void (*message)(void *context, int level /* 0 detail, 1 warning */, const char *text);
    void *message_context;
    /* what was read; NULL, 0 or -1 = not given */
    char *scene, *output; /* scene: a path; output: as written, without the number of a frame */
    char output_type;     /* N, J, E …: the format where the output has no ending */
    int width, height;
    double window[4]; /* first and last column, first and last row: from 1, or, below 1, a share of the picture */
    int threads, resume;
    long seed;
    double clock; /* of a still picture; NAN = not given */
    Animation animation;
    double subset[2]; /* the first and the last frame to render, or, below 1, a share of the frames; 0 = not given */
    int step;         /* every step-th of them; default 1 */
    IniList declares, folders, files; /* NAME=VALUE, Library_Path, the .ini files */
    int nlines, nreads, depth;        /* lines and files that were read; files that are open */
} IniOptions;
#define INI_OPTIONS_INIT                                                                                               \
    {                                                                                                                  \
        .seed = -1, .clock = NAN, .step = 1, .animation = ANIMATION_INIT                                               \
    }

/* Where an option stands, for messages. */
typedef struct IniPlace IniPlace;
struct IniPlace {
    const char *file; /* "" on the command line */
    int line;
    const char *folder; /* of the file, "" or with a final slash: what names are relative to */
    /* Reads another file, whose name may have a [SECTION]. */
    int (*include)(IniOptions *options, const IniPlace *place, const char *name, RetexError *err);
};

/* A KEYWORD=VALUE. */
int ini_set(IniOptions *options, const IniPlace *place, const char *keyword, const char *value, RetexError *err);
/* A switch, `+W320` or `-D`. */
int ini_set_switch(IniOptions *options, const IniPlace *place, const char *word, RetexError *err);
/* A name that stands alone, or Include_Ini: of a scene if it ends in .pov, otherwise of an .ini file. */
int ini_set_name(IniOptions *options, const IniPlace *place, const char *name, RetexError *err);

/* Fail with the place. */
int ini_fail(const IniPlace *place, RetexError *err, const char *fmt, ...) RETEX_PRINTF(3, 4);

/* The pattern of the output's name, `NAME%02d.png`, with as many digits as the last frame has, or NAME.png without
 * frames. The caller frees it. NULL without memory, or if no output was named. */
char *ini_output_name(const IniOptions *options);

/* The frames to render: subset, or all. */
void ini_frames(const IniOptions *options, int *first, int *last);

void ini_close(IniOptions *options);

#endif
