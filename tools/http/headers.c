/* See headers.h. */
#include "http/headers.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int header_has_etag(const char *list, const char *etag)
{
    const size_t length = strlen(etag);
    if (!list || !length)
        return 0;
    while (*list) {
        list += strspn(list, " \t,");
        if (*list == '*')
            return 1;
        list += strncmp(list, "W/", 2) == 0 ? 2 : 0;
        const char *end = *list == '"' ? strchr(list + 1, '"') : NULL;
        if (!end)
            return 0;
        if ((size_t)(end + 1 - list) == length && memcmp(list, etag, length) == 0)
            return 1;
        list = end + 1;
    }
    return 0;
}

/* A number of decimal digits; *end is behind it. Numbers that are too large become the largest. */
static size_t read_number(const char *text, const char **end)
{
    size_t number = 0;
    for (; isdigit((unsigned char)*text); text++) {
        const size_t digit = (size_t)(*text - '0');
        number = number > ((size_t)-1 - digit) / 10 ? (size_t)-1 : 10 * number + digit;
    }
    *end = text;
    return number;
}

RangeKind header_range(const char *range, size_t bytes, size_t *first, size_t *last)
{
    static const char unit[] = "bytes=";
    const char *at, *end;
    if (!range || strncmp(range, unit, sizeof unit - 1) != 0)
        return RANGE_NONE;
    range += sizeof unit - 1;
    const size_t begin = read_number(range, &at);
    if (*at != '-')
        return RANGE_NONE;
    const int has_begin = at > range;
    const size_t stop = read_number(at + 1, &end);
    const int has_stop = end > at + 1;
    if (*end || (!has_begin && !has_stop) || (has_begin && has_stop && stop < begin))
        return RANGE_NONE;
    if (!has_begin) { /* the last bytes */
        *first = stop < bytes ? bytes - stop : 0;
        *last = bytes - 1;
        return stop && bytes ? RANGE_SOME : RANGE_OUTSIDE;
    }
    *first = begin;
    *last = has_stop && stop < bytes ? stop : bytes - 1;
    return begin < bytes ? RANGE_SOME : RANGE_OUTSIDE;
}

const char *header_base(char *text, size_t size, const char *host, const char *protocol)
{
    const int is_safe = protocol && strcmp(protocol, "https") == 0;
    text[0] = '\0';
    if (!host || !*host || strlen(host) > 200)
        return text;
    for (const char *c = host; *c; c++)
        if (!isalnum((unsigned char)*c) && !strchr(".-_:[]", *c))
            return text;
    snprintf(text, size, "%s://%s", is_safe ? "https" : "http", host);
    return text;
}
