/* Numbers in the text of edits. Private to libretex. */
#ifndef RETEX_EDIT_NUMBER_H
#define RETEX_EDIT_NUMBER_H

enum { RETEX_NUMBER_MAX = 32 }; /* bytes of a number as text */

const char *retex_skip_spaces(const char *text);
/* Parse a finite number; *end is behind it. 0 where there is none. There is no -0, which would be written and say
 * nothing. */
int retex_number_parse(const char *text, const char **end, double *value);
/* Parse `most` numbers, or one that stands for all. 0: the text is something else. */
int retex_numbers_parse(double *numbers, int most, const char *text);
/* The same of lengths, which all have a unit, or none: *metric is 1 where they have one, and are metres. */
int retex_lengths_parse(double *lengths, int most, const char *text, int *metric);
/* The fewest digits that mean the same. */
const char *retex_number_text(double value, char text[RETEX_NUMBER_MAX]);
const char *retex_float_text(float value, char text[RETEX_NUMBER_MAX]);

#endif
