/* The built-in functions that return strings. */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include "sdl/lang/internal.h"

/* A growable string; the finished string is copied to the arena. */
typedef struct Text {
    char *bytes;
    size_t length, capacity;
} Text;

static void append(Sdl *sdl, Text *text, const char *bytes, size_t length)
{
    if (text->length + length > MAX_STRING)
        sdl_fail(sdl, RETEX_ELIMIT, "a string longer than %d bytes", MAX_STRING);
    text->bytes = sdl_reserve(sdl, text->bytes, text->length, text->length + length + 1, &text->capacity);
    memcpy(text->bytes + text->length, bytes, length);
    text->length += length;
    text->bytes[text->length] = 0;
}

/* The number format of str(). The result has at least |length| characters; a negative length pads with zeros. A
 * negative precision selects the default precision. */
static char *string_number(Sdl *sdl, double value, int length, int precision)
{
    char format[8] = "%*.*f", small[400];
    if (length < 0)
        memcpy(format, "%0*.*f", 7);
    int width = length < 0 ? -length : length, digits = precision < 0 ? 6 : precision;
    if (width > 4000 || digits > 4000)
        sdl_fail(sdl, RETEX_ELIMIT, "a number written with more than 4000 places");
    int needed = snprintf(small, sizeof small, format, width, digits, value);
    char *out = sdl_alloc(sdl, (size_t)needed + 1);
    snprintf(out, (size_t)needed + 1, format, width, digits, value);
    return out;
}

static int int_argument(Sdl *sdl)
{
    double value = expression_parameter(sdl);
    if (!(fabs(value) < 1e9))
        sdl_error(sdl, "%g is not a number that a string can have", value);
    return (int)value;
}

static const char *number_string(Sdl *sdl)
{
    double value = expression_parameter(sdl);
    sdl_expect(sdl, ",");
    int length = int_argument(sdl);
    sdl_expect(sdl, ",");
    return string_number(sdl, value, length, int_argument(sdl));
}

static const char *vector_string(Sdl *sdl)
{
    Text text = {0};
    int count = int_argument(sdl);
    if (count < 2 || count > 5)
        sdl_error(sdl, "vstr writes 2 to 5 numbers, not %d", count);
    sdl_expect(sdl, ",");
    Num num = expression_full(sdl);
    num_promote(&num, count);
    sdl_expect(sdl, ",");
    const char *separator = sdl_string(sdl);
    sdl_expect(sdl, ",");
    int length = int_argument(sdl);
    sdl_expect(sdl, ",");
    int precision = int_argument(sdl);
    for (int i = 0; i < count; i++) {
        const char *part = string_number(sdl, num.n[i], length, precision);
        if (i)
            append(sdl, &text, separator, strlen(separator));
        append(sdl, &text, part, strlen(part));
    }
    return text.bytes;
}

static const char *concatenation(Sdl *sdl)
{
    Text text = {0};
    do {
        const char *part = sdl_string(sdl);
        append(sdl, &text, part, strlen(part));
    } while (sdl_accept(sdl, ","));
    return text.bytes;
}

static const char *part_of_string(Sdl *sdl)
{
    const char *whole = sdl_string(sdl);
    sdl_expect(sdl, ",");
    int first = int_argument(sdl);
    sdl_expect(sdl, ",");
    int count = int_argument(sdl), length = (int)strlen(whole);
    if (first < 1 || count < 0 || first - 1 > length || count > length - (first - 1))
        sdl_error(sdl, "substr(…, %d, %d) is outside of a string of %d characters", first, count, length);
    char *part = sdl_alloc(sdl, (size_t)count + 1);
    memcpy(part, whole + first - 1, (size_t)count);
    return part;
}

static const char *changed_case(Sdl *sdl, int upper)
{
    const char *text = sdl_string(sdl);
    size_t length = strlen(text);
    char *out = sdl_alloc(sdl, length + 1);
    for (size_t i = 0; i < length; i++) {
        char c = text[i];
        out[i] = upper && c >= 'a' && c <= 'z' ? (char)(c - 32) : !upper && c >= 'A' && c <= 'Z' ? (char)(c + 32) : c;
    }
    return out;
}

static const char *character(Sdl *sdl)
{
    int code = int_argument(sdl);
    if (code < 1 || code > 0xffff)
        sdl_error(sdl, "chr(%d) is no character", code);
    char *out = sdl_alloc(sdl, 4);
    if (code < 0x80)
        out[0] = (char)code;
    else if (code < 0x800)
        out[0] = (char)(0xc0 | code >> 6), out[1] = (char)(0x80 | (code & 63));
    else
        out[0] = (char)(0xe0 | code >> 12), out[1] = (char)(0x80 | (code >> 6 & 63)),
        out[2] = (char)(0x80 | (code & 63));
    return out;
}

/* datetime(days since 2000[, strftime format]), in UTC. */
static const char *date_and_time(Sdl *sdl)
{
    double days = expression_parameter(sdl);
    const char *format = sdl_accept(sdl, ",") ? sdl_string(sdl) : "%Y-%m-%d %H:%M:%SZ";
    if (!(fabs(days) < 1e6))
        sdl_error(sdl, "%g days are not a date", days);
    time_t seconds = (time_t)(days * 86400 + 946684800.0 + 0.5);
    struct tm parts;
    char *out = sdl_alloc(sdl, 256);
    if (!gmtime_r(&seconds, &parts) || !strftime(out, 256, format, &parts))
        out[0] = 0;
    return out;
}

const char *builtin_string(Sdl *sdl, const Builtin *builtin)
{
    const char *name = builtin->name, *result;
    if (strcmp(name, "input_file_name") == 0)
        return sdl->scene->path;
    sdl_expect(sdl, "(");
    if (strcmp(name, "str") == 0)
        result = number_string(sdl);
    else if (strcmp(name, "vstr") == 0)
        result = vector_string(sdl);
    else if (strcmp(name, "concat") == 0)
        result = concatenation(sdl);
    else if (strcmp(name, "substr") == 0)
        result = part_of_string(sdl);
    else if (strcmp(name, "strupr") == 0)
        result = changed_case(sdl, 1);
    else if (strcmp(name, "strlwr") == 0)
        result = changed_case(sdl, 0);
    else if (strcmp(name, "chr") == 0)
        result = character(sdl);
    else
        result = date_and_time(sdl);
    sdl_expect(sdl, ")");
    return result;
}
