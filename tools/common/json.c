/* See json.h. */
#include "common/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/json_text.h"

#define WHOLE_LIMIT 1e9 /* larger ones have an exponent, as %g prints them */

json_t *json_of_text(const char *text)
{
    char *clean = malloc(3 * strlen(text) + 1), *out = clean;
    if (!clean)
        return NULL;
    for (int length; *text; text += length ? length : 1) {
        length = utf8_length(text);
        memcpy(out, length ? text : "\xef\xbf\xbd", (size_t)(length ? length : 3));
        out += length ? length : 3;
    }
    json_t *value = json_stringn(clean, (size_t)(out - clean));
    free(clean);
    return value;
}

json_t *json_of_number(double number)
{
    return !isfinite(number)                                       ? json_null()
           : number == trunc(number) && fabs(number) < WHOLE_LIMIT ? json_integer((json_int_t)number)
                                                                   : json_real(number);
}

json_t *json_of_rounded(double number, int decimals)
{
    const double scale = pow(10, decimals);
    return json_of_number(round(number * scale) / scale);
}

void json_add(json_t **array, json_t *value)
{
    if (json_array_append_new(*array, value)) {
        json_decref(*array);
        *array = NULL;
    }
}

char *json_line_text(json_t *value, int digits)
{
    char *text = value ? json_dumps(value, JSON_REAL_PRECISION((size_t)digits)) : NULL;
    const size_t length = text ? strlen(text) : 0;
    char *line = text ? realloc(text, length + 2) : NULL;
    if (line)
        strcpy(line + length, "\n");
    else
        free(text);
    json_decref(value);
    return line;
}

int json_print_line(FILE *file, json_t *value, int digits)
{
    char *line = json_line_text(value, digits);
    if (!line)
        return -1;
    fputs(line, file);
    free(line);
    return 0;
}
