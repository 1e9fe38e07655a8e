/* See manifest_fields.h. */
#include "set/manifest_fields.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void retex_reading_fail(Reading *reading, int code, const char *fmt, ...)
{
    char message[512];
    va_list arguments;

    if (reading->code)
        return;
    va_start(arguments, fmt);
    vsnprintf(message, sizeof message, fmt, arguments);
    va_end(arguments);
    reading->code = retex_fail(reading->err, code, "%s: the manifest %s", reading->name, message);
}

void retex_reading_text(Reading *reading, const json_t *object, const char *key, char *out, size_t size)
{
    const json_t *value = json_object_get(object, key);
    const char *bytes = json_string_value(value);

    if (!bytes || strlen(bytes) >= size || strlen(bytes) != json_string_length(value))
        retex_reading_fail(reading, RETEX_EFORMAT, "has no proper text \"%s\"", key);
    else
        strcpy(out, bytes);
}

int retex_reading_integer(Reading *reading, const json_t *object, const char *key, int low, int high)
{
    const json_t *value = json_object_get(object, key);
    const json_int_t number = json_integer_value(value);

    if (!json_is_integer(value) || number < low || number > high) {
        retex_reading_fail(reading, RETEX_EFORMAT, "has no integer \"%s\" from %d to %d", key, low, high);
        return low;
    }
    return (int)number;
}

double retex_reading_real(Reading *reading, const json_t *value, const char *key)
{
    if (!json_is_number(value))
        retex_reading_fail(reading, RETEX_EFORMAT, "has no number \"%s\"", key);
    return json_number_value(value);
}

int retex_reading_boolean(Reading *reading, const json_t *value, const char *key)
{
    if (!json_is_boolean(value))
        retex_reading_fail(reading, RETEX_EFORMAT, "has no true or false \"%s\"", key);
    return json_is_true(value);
}

const json_t *retex_reading_array(Reading *reading, const json_t *object, const char *key, size_t most)
{
    const json_t *value = json_object_get(object, key);

    if (!json_is_array(value) || json_array_size(value) > most) {
        retex_reading_fail(reading, RETEX_EFORMAT, "has no list \"%s\" of at most %zu", key, most);
        return NULL;
    }
    return value;
}

/* The index of a part that is referred to by name; -1 where the value is null and may be. */
int retex_reading_part(Reading *reading, const RetexSet *set, const json_t *object, const char *key, size_t channels,
                       int optional)
{
    const json_t *value = json_object_get(object, key);
    const char *name = json_string_value(value);

    if (json_is_null(value) && optional)
        return -1;
    const int part = name ? retex_set_find_part(set, name) : -1;
    if (part < 0)
        retex_reading_fail(reading, RETEX_EFORMAT, "refers to a part that is not there in \"%s\"", key);
    else if (strlen(set->parts[part].letters) != channels)
        retex_reading_fail(reading, RETEX_EFORMAT, "has in \"%s\" a part of %zu channels instead of %zu", key,
                           strlen(set->parts[part].letters), channels);
    return part;
}

/* A part with one channel for all colours, or with three. */
int retex_reading_weight(Reading *reading, const RetexSet *set, const json_t *json, const char *key)
{
    const char *name = json_string_value(json_object_get(json, key));
    const int part = name ? retex_set_find_part(set, name) : -1;
    return retex_reading_part(reading, set, json, key, part >= 0 && set->parts[part].image.channels == 3 ? 3 : 1, 0);
}

void retex_reading_check_size(Reading *reading, const RetexSet *set, int part, const char *key)
{
    if (part >= 0 && (set->parts[part].image.width != set->width || set->parts[part].image.height != set->height))
        retex_reading_fail(reading, RETEX_EFORMAT, "has in \"%s\" a part of another size than the set's", key);
}

/* Checks the size of a part that may be reduced. */
void retex_reading_check_scale(Reading *reading, const RetexSet *set, int part, const char *key)
{
    if (part >= 0 && !retex_set_scale(set, &set->parts[part].image))
        retex_reading_fail(reading, RETEX_EFORMAT,
                           "has in \"%s\" a part that is neither of the set's size nor 2, 4 or 8 times smaller", key);
}

/* The number of a name among those of a later or this version; refuses unknown ones by name. */
int retex_reading_name(Reading *reading, const char *name, const char *what, const char *(*name_of)(int number),
                       int count)
{
    int number = 0;

    while (number < count && strcmp(name, name_of(number)) != 0)
        number++;
    if (number == count)
        retex_reading_fail(reading, RETEX_EUNSUPPORTED, "has a %s that this program does not know: \"%s\"", what, name);
    return number < count ? number : 0;
}

int retex_reading_named(Reading *reading, const json_t *json, const char *key, const char *what,
                        const char *(*name_of)(int number), int count)
{
    char name[RETEX_NAME_MAX] = "";

    retex_reading_text(reading, json, key, name, sizeof name);
    return reading->code ? 0 : retex_reading_name(reading, name, what, name_of, count);
}
