/* Text of any bytes as a string of JSON. */
#ifndef RETEX_JSON_TEXT_H
#define RETEX_JSON_TEXT_H

#include <stdio.h>

/* With its quotes. Bytes that are not UTF-8, for which JSON has no place, become U+FFFD each. */
void json_text(FILE *file, const char *text);

#endif
