/* The command line of a job: which tools and options there are, and what is put before them. A window asks for what it
 * needs and nothing else: an option is of the table in job_line.c, names stand behind `--`, and outputs lie in the
 * folder that is written to, in which there is no link. */
#ifndef RETEX_STUDIO_JOB_LINE_H
#define RETEX_STUDIO_JOB_LINE_H

#include <jansson.h>

#include "places.h"

enum { LINE_WORDS = 1024, LINE_BYTES = 1 << 20 };

/* What programs may use. */
typedef struct ProgramLimits {
    int is_unsafe;   /* 1: nothing is limited */
    uint64_t memory; /* bytes */
} ProgramLimits;

/* A command line as a program gets it; `words` are owned and end with NULL. */
typedef struct Line {
    char **words;
    int count;
} Line;

/* The line of a tool with the arguments of a JSON array: options, `--`, names. RETEX_EINVAL: they are not as above. The
 * folders of outputs are made. */
int line_make(Line *line, const char *tool, const json_t *args, const ProgramLimits *limits, const Model *model,
              RetexError *err);
/* The same of `retex-render --live` for a scene; args are options alone. */
int line_make_live(Line *line, const char *scene, const json_t *args, const ProgramLimits *limits, const Model *model,
                   RetexError *err);
void line_free(Line *line);

/* 1: it uses all cores for long, so that one such tool runs after the other. Lists of a scene's lamps and the like are
 * not, though retex-render makes them. args: an array of strings. */
int line_is_long(const char *tool, const json_t *args);

#endif
