/* What a program has said: its progress, its messages and its standard output, each bounded. */
#ifndef RETEX_STUDIO_SAID_H
#define RETEX_STUDIO_SAID_H

#include <jansson.h>
#include <stddef.h>

#include <retex/error.h>

enum { SAID_LINES = 200, SAID_LINE = 1000, SAID_OUTPUT = 64 << 10 };

typedef struct Said {
    char *lines[SAID_LINES]; /* the last ones, from `first` on, around the end */
    int first, nlines, dropped;
    char line[SAID_LINE + 1]; /* that has not ended yet */
    int length;
    char *output; /* the first SAID_OUTPUT bytes of standard output */
    size_t output_bytes;
    int is_cut;      /* there was more */
    double progress; /* 0 to 1 */
    char stage[32];
} Said;

void said_free(Said *said);

/* Bytes of standard error: lines, of which those of RETEX_PROGRESS=json are progress; see retex(1). 1: there is
 * something new. */
int said_message(Said *said, const char *bytes, size_t count);
int said_output(Said *said, const char *bytes, size_t count);
/* Add a line. */
void said_line(Said *said, const char *fmt, ...) RETEX_PRINTF(2, 3);
/* The program has ended: a line without an end is one too. */
void said_end(Said *said, int is_done);
/* The last line, or "". */
const char *said_last(const Said *said);
/* {"progress", "stage", "lines", "dropped", "stdout", "cut"} */
json_t *said_json(const Said *said);

#endif
