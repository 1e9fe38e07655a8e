/* Numbers in the text of edits. See number.h. */
#include "edit/number.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/edit.h>

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

/* A unit is numerator / denominator metres: so 7 cm are the number nearest to .07. */
static const struct {
    const char *word;
    double numerator, denominator;
} units[] = {{"mm", 1, 1000}, {"cm", 1, 100}, {"m", 1, 1}, {"in", 254, 10000}, {"ft", 3048, 10000}};

/* The metres of `count` of the unit that a text begins with; *text is behind it. 0: there is none. */
static int take_unit(const char **text, double count, double *metres)
{
    const char *word = retex_skip_spaces(*text);
    for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
        const size_t length = strlen(units[k].word);
        if (strncasecmp(word, units[k].word, length) == 0 && !isalnum((unsigned char)word[length])) {
            *metres = count * units[k].numerator / units[k].denominator;
            *text = word + length;
            return 1;
        }
    }
    return 0;
}

/* metric: how many have a unit; NULL: none may. */
static int parse_list(double *numbers, int most, const char *text, int *metric)
{
    int count = 0, with_unit = 0;
    do {
        double *number = &numbers[count++];
        if (!retex_number_parse(text, &text, number))
            return 0;
        with_unit += metric && take_unit(&text, *number, number);
        text = retex_skip_spaces(text);
    } while (*text == ',' && count < most && text++);
    for (int i = 1; i < most && count == 1; i++)
        numbers[i] = numbers[0];
    if (metric)
        *metric = with_unit > 0;
    return *text == '\0' && (count == 1 || count == most) && (with_unit == 0 || with_unit == count);
}

int retex_numbers_parse(double *numbers, int most, const char *text)
{
    return parse_list(numbers, most, text, NULL);
}

int retex_lengths_parse(double *lengths, int most, const char *text, int *metric)
{
    return parse_list(lengths, most, text, metric);
}

int retex_length_parse(double *metres, const char *text, RetexError *err)
{
    const char *end = retex_skip_spaces(text);
    double count;
    const int is_number = retex_number_parse(end, &end, &count);
    count = is_number ? count : 1;
    *metres = count;
    const int has_unit = take_unit(&end, count, metres);
    if ((is_number || has_unit) && *retex_skip_spaces(end) == '\0' && isfinite(*metres))
        return RETEX_OK;
    return retex_fail(err, RETEX_EPARSE, "'%.80s' is no length: expected a number of mm, cm, m, in or ft, as in 60cm",
                      text);
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
