/* What is sent: a status and bytes, shared by all requests that get the same. It does not change once it is made. */
#ifndef RETEX_SERVE_ANSWER_H
#define RETEX_SERVE_ANSWER_H

#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>

#include <jansson.h>

#include <retex/error.h>

enum { ETAG_SIZE = 40 };

typedef struct Answer {
    atomic_int uses;
    int status;
    const char *type;         /* media type; not owned */
    char etag[ETAG_SIZE];     /* with its quotes, or "" */
    int width, height;        /* of the room whose picture it is, or 0 */
    char *location;           /* of a redirection, owned; or NULL */
    char reason[200];         /* of an error, for the log, or "" */
    void *data;
    size_t bytes;
} Answer;

/* data comes from malloc and is taken over. NULL if there is no memory; data is then freed. */
Answer *answer_new(int status, const char *type, void *data, size_t bytes);
/* Of what was printed into a stream of open_memstream, which is closed. NULL if there was no memory. */
Answer *answer_of_text(int status, const char *type, FILE *file, char **text, const size_t *bytes);
/* A value, which is taken over, as a line of JSON. NULL: no memory. */
Answer *answer_json(int status, json_t *value);
/* An error: its reason as a line of plain text. */
Answer *answer_error(int status, const char *fmt, ...) RETEX_PRINTF(2, 3);
/* The error of the library as an answer: whose fault it is says its code. */
Answer *answer_of_error(const RetexError *err);

Answer *answer_hold(Answer *answer);
void answer_release(Answer *answer); /* NULL is fine */

#endif
