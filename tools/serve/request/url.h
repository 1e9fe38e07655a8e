/* Parts of URLs and of the header Accept. */
#ifndef RETEX_SERVE_URL_H
#define RETEX_SERVE_URL_H

#include <stddef.h>

/* Decode %XX in place. 0 if the text is not what request.h says of parts of paths and queries. */
int url_decode(char *text);

/* Append text to what `out` of `size` bytes holds, percent-encoded as a part of a path; what does not fit is left
 * out. */
void url_encode(char *out, size_t size, const char *text);

/* Cut text at the first `mark`. Returns what follows it, or NULL if there is none. */
char *url_cut(char *text, char mark);

/* A whole number of 1 to 9 digits and nothing else. 0 if it is not. */
int url_integer(const char *text, int *value);

/* The weight, 0 to 1, that a header Accept gives to a type, "image/avif"; of its own if it is named, otherwise by
 * `image/` followed by an asterisk, otherwise by two asterisks; *named is 1 in the first case. NULL accepts all. */
double url_accepts(const char *accept, const char *type, int *named);

#endif
