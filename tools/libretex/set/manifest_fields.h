/* Fields of the manifest, read and checked one by one. Private to manifest_read.c and manifest_terms.c. */
#ifndef RETEX_SET_MANIFEST_FIELDS_H
#define RETEX_SET_MANIFEST_FIELDS_H

#include <jansson.h>

#include "set/manifest.h"

/* State of the parser. Only the first failure is kept, so readers may go on to the end of a row of fields. */
typedef struct Reading {
    const char *name; /* name of the file, for messages */
    RetexError *err;
    int code;
    RetexBandSums *sums; /* or NULL */
} Reading;

void retex_reading_fail(Reading *reading, int code, const char *fmt, ...) RETEX_PRINTF(3, 4);
/* Each of these fails where the object has no such key, or something else there. */
void retex_reading_text(Reading *reading, const json_t *object, const char *key, char *out, size_t size);
int retex_reading_integer(Reading *reading, const json_t *object, const char *key, int low, int high);
double retex_reading_real(Reading *reading, const json_t *value, const char *key);
int retex_reading_boolean(Reading *reading, const json_t *value, const char *key);
const json_t *retex_reading_array(Reading *reading, const json_t *object, const char *key, size_t most);
/* The index of a part that is referred to by name; -1 where the value is null and may be. */
int retex_reading_part(Reading *reading, const RetexSet *set, const json_t *object, const char *key, size_t channels,
                       int optional);
/* A part with one channel for all colours, or with three. */
int retex_reading_weight(Reading *reading, const RetexSet *set, const json_t *json, const char *key);
/* Check that a part (-1: none) has the set's size, or that divided by a scale. */
void retex_reading_check_size(Reading *reading, const RetexSet *set, int part, const char *key);
void retex_reading_check_scale(Reading *reading, const RetexSet *set, int part, const char *key);
/* The number of a name among `count` that this version knows; others are refused by name. */
int retex_reading_name(Reading *reading, const char *name, const char *what, const char *(*name_of)(int number),
                       int count);
/* The same of the name under a key. */
int retex_reading_named(Reading *reading, const json_t *json, const char *key, const char *what,
                        const char *(*name_of)(int number), int count);

/* manifest_terms.c: the list of parameters, and that of terms. */
void retex_reading_terms(Reading *reading, const json_t *root, RetexSet *set);

#endif
