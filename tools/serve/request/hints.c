/* See hints.h. */
#include "serve/request/hints.h"

#include <string.h>

/* A decimal number above 0, and nothing else; 0 for what is none, or has more digits than any screen. */
static double read_number(const char *text)
{
    enum { DIGITS_MAX = 12 };
    if (!text)
        return 0;
    text += strspn(text, " \t");
    const size_t whole = strspn(text, "0123456789");
    const size_t part = text[whole] == '.' ? 1 + strspn(text + whole + 1, "0123456789") : 0, length = whole + part;
    if (!whole || length > DIGITS_MAX || text[length + strspn(text + length, " \t")])
        return 0;
    double value = 0, place = 1;
    for (size_t i = 0; i < length; i++) /* strtod goes by the locale */
        if (i < whole)
            value = 10 * value + (text[i] - '0');
        else if (i > whole)
            value += (place /= 10) * (text[i] - '0');
    return value;
}

int hints_width(const Hints *hints)
{
    static const int widths[] = {320, 480, 640, 960, 1280, 1600, 1920, 2560, 3840};
    const int count = sizeof widths / sizeof *widths;
    const double dpr = read_number(hints->dpr), viewport = read_number(hints->viewport_width);
    double wanted = read_number(hints->width);
    int i = 0;
    if (!(wanted > 0))
        wanted = viewport * (dpr > 0 ? dpr : 1);
    if (!(wanted > 0))
        return 0;
    while (i < count - 1 && widths[i] < wanted)
        i++;
    return widths[i];
}

void hints_apply(ServeRequest *request, const Hints *hints)
{
    enum { ANY_HEIGHT = 1 << 30 };
    const int width = hints_width(hints);
    if (!request->size_by_hints)
        return;
    request->size = width ? (ServeSize){.kind = SERVE_SIZE_WITHIN, .width = width, .height = ANY_HEIGHT}
                          : (ServeSize){.kind = SERVE_SIZE_MAX};
}
