/* Numbers in the text of edits. See number.h. */
#include "edit/number.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int retex_number_parse(const char *text, const char **end, double *value)
{
    char *stop;
    *value = strtod(text, &stop) + 0.0;
    if (stop == text || !isfinite(*value))
        return 0;
    *end = stop;
    return 1;
}

const char *retex_skip_spaces(const char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    return text;
}

int retex_numbers_parse(double *numbers, int most, const char *text)
{
    int count = 0;
    do {
        if (!retex_number_parse(text, &text, &numbers[count++]))
            return 0;
        text = retex_skip_spaces(text);
    } while (*text == ',' && count < most && text++);
    for (int i = 1; i < most && count == 1; i++)
        numbers[i] = numbers[0];
    return *text == '\0' && (count == 1 || count == most);
}

const char *retex_number_text(double value, char text[RETEX_NUMBER_MAX])
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, RETEX_NUMBER_MAX, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

const char *retex_float_text(float value, char text[RETEX_NUMBER_MAX])
{
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, RETEX_NUMBER_MAX, "%.*g", digits, (double)value);
        if ((float)strtod(text, NULL) == value)
            break;
    }
    return text;
}
