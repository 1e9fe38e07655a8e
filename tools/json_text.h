/* Strings of JSON from arbitrary bytes. */
#ifndef RETEX_JSON_TEXT_H
#define RETEX_JSON_TEXT_H

#include <stdio.h>

/* Print text as a JSON string, with quotes. Each byte that is not valid UTF-8 becomes U+FFFD. */
void json_text(FILE *file, const char *text);

#endif
