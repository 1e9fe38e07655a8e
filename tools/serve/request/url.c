/* See url.h. */
#include "serve/request/url.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/json_text.h"

static int hex_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* UTF-8 without control characters (the second range is U+0080 to U+009F), slashes and backslashes. */
static int is_plain(const char *text)
{
    for (int length; *text; text += length) {
        const unsigned char *c = (const unsigned char *)text;
        length = utf8_length(text);
        if (length == 0 || c[0] < 0x20 || c[0] == 0x7f || (c[0] == 0xc2 && c[1] < 0xa0) || c[0] == '/' || c[0] == '\\')
            return 0;
    }
    return 1;
}

int url_decode(char *text)
{
    char *out = text;
    for (const char *c = text; *c; c++) {
        if (*c == '%') {
            int high = hex_digit(c[1]), low = high < 0 ? -1 : hex_digit(c[2]);
            if (low < 0 || (high == 0 && low == 0))
                return 0;
            *out++ = (char)(16 * high + low);
            c += 2;
        } else if (*c > ' ' && *c < 0x7f) {
            *out++ = *c;
        } else {
            return 0;
        }
    }
    *out = '\0';
    return is_plain(text) && strcmp(text, ".") != 0 && strcmp(text, "..") != 0;
}

void url_encode(char *out, size_t size, const char *text)
{
    size_t used = strlen(out);
    for (const unsigned char *c = (const unsigned char *)text; *c && used + 4 <= size; c++)
        if (isalnum(*c) || strchr("-._~;=(),+!", *c))
            used += (size_t)snprintf(out + used, size - used, "%c", *c);
        else
            used += (size_t)snprintf(out + used, size - used, "%%%02X", *c);
}

char *url_cut(char *text, char mark)
{
    char *found = strchr(text, mark);
    if (found)
        *found++ = '\0';
    return found;
}

int url_integer(const char *text, int *value)
{
    size_t length = strspn(text, "0123456789");
    if (length < 1 || length > 9 || text[length])
        return 0;
    *value = atoi(text);
    return 1;
}

/* The parameter q of a media range, `;level=1;q=0.5`, which ends at a comma; 1 if there is none. */
static double weight(const char *parameters)
{
    for (const char *c = parameters; *c && *c != ','; c++) {
        if (*c != ';')
            continue;
        const char *name = c + 1 + strspn(c + 1, " \t");
        if ((*name != 'q' && *name != 'Q') || name[1] != '=')
            continue;
        double value = name[2] == '1' ? 1 : 0, place = 0.1;
        if (name[2] == '0' && name[3] == '.')
            for (const char *digit = name + 4; isdigit((unsigned char)*digit); digit++, place /= 10)
                value += place * (*digit - '0');
        return value;
    }
    return 1;
}

double url_accepts(const char *accept, const char *type, int *named)
{
    const char *slash = strchr(type, '/');
    double any = 0, family = -1;
    *named = 0;
    if (!accept)
        return 1;
    for (const char *c = accept; *c;) {
        while (*c == ' ' || *c == '\t' || *c == ',')
            c++;
        size_t length = strcspn(c, ",; \t");
        double q = weight(c + length);
        if (length == strlen(type) && strncasecmp(c, type, length) == 0) {
            *named = 1;
            return q;
        }
        if (length == 3 && strncmp(c, "*/*", 3) == 0)
            any = q;
        if (length == (size_t)(slash - type) + 2 && strncasecmp(c, type, length - 1) == 0 && c[length - 1] == '*')
            family = q;
        c += strcspn(c, ",");
    }
    return family >= 0 ? family : any;
}
