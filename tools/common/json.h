/* Values of JSON, by jansson, which what is printed for programs is made of. */
#ifndef RETEX_JSON_H
#define RETEX_JSON_H

#include <jansson.h>
#include <stdio.h>

/* Text as a string; what is no UTF-8 becomes U+FFFD. */
json_t *json_of_text(const char *text);

/* A number, whole ones without a fraction; null for what is none, which JSON cannot say. */
json_t *json_of_number(double number);

/* The same, to so many decimals. */
json_t *json_of_rounded(double number, int decimals);

/* Append a value to an array, which becomes NULL, as json_pack gives it, where there is no memory. */
void json_add(json_t **array, json_t *value);

/* A value, which is taken over, as one line with its end, for the caller to free; fractions have so many digits. NULL
 * without memory, or of NULL. */
char *json_line_text(json_t *value, int digits);

/* Print such a line at once, so that output of other programs does not split it; without memory nothing, and
 * -1 is returned. */
int json_print_line(FILE *file, json_t *value, int digits);

#endif
