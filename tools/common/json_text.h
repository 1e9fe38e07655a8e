/* Strings of JSON from arbitrary bytes. */
#ifndef RETEX_JSON_TEXT_H
#define RETEX_JSON_TEXT_H

#include <stdio.h>

/* Print text as a JSON string, with quotes. Each byte that is not valid UTF-8 becomes U+FFFD. */
void json_text(FILE *file, const char *text);

/* Bytes of the UTF-8 character at the start of text, which ends with a NUL; 0 if it is invalid by RFC 3629: overlong, a
 * surrogate … */
int utf8_length(const char *text);

/* End text before the first byte that is invalid: its last character may have been cut in the middle. */
void utf8_trim(char *text);

#endif
