/* See frames.h. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/frames.h"

enum { DIGITS_MAX = 9 }; /* of a frame's number, and of its field in a name */

/* Read a number of at most nine digits; NULL if there is none. */
static const char *read_number(const char *text, int *number)
{
    int digits = 0;
    for (*number = 0; isdigit((unsigned char)*text); text++)
        if (++digits > DIGITS_MAX)
            return NULL;
        else
            *number = 10 * *number + (*text - '0');
    return digits ? text : NULL;
}

void frames_take(Cli *cli, const CliOption *option, void *to)
{
    FrameRange *range = to;
    const char *text = read_number(cli->value, &range->first);
    range->last = range->first;
    range->step = 1;
    if (text && *text == '-')
        text = read_number(text + 1, &range->last);
    if (text && *text == 'x')
        text = read_number(text + 1, &range->step);
    if (!text || *text || range->step < 1 || range->last < range->first)
        cli_die(cli, "--%s: expected the first frame and the last, as 1-12, or 1-12x2, not `%s`", option->name,
                cli->value);
}

int frames_count(const FrameRange *range)
{
    return range->step ? (range->last - range->first) / range->step + 1 : 0;
}

void frames_check_count(const Cli *cli, const FrameRange *range)
{
    if (frames_count(range) > FRAMES_MAX)
        cli_die(cli, "%d frames are more than the %d that one command makes: give a part of them with --frames",
                frames_count(range), FRAMES_MAX);
}

/* The end of what begins with a percent sign: `%%`, where *digits is -1, or the number of a frame in that many digits.
 * NULL if it is anything else. */
static const char *read_percent(const char *text, int *digits)
{
    *digits = -1;
    if (text[1] == '%')
        return text + 2;
    text++;
    *digits = 0;
    if (*text == '0')
        text = read_number(text, digits);
    return text && *text == 'd' && *digits <= DIGITS_MAX ? text + 1 : NULL;
}

int frames_has_number(const char *name)
{
    int digits;
    for (const char *c = strchr(name, '%'); c && (c = read_percent(c, &digits)); c = strchr(c, '%'))
        if (digits >= 0)
            return 1;
    return 0;
}

void frames_check_name(const Cli *cli, const FrameRange *range, const char *what, const char *name, int written)
{
    int digits;
    if (!name || !range->step)
        return;
    for (const char *c = strchr(name, '%'), *end; c; c = strchr(end, '%'))
        if (!(end = read_percent(c, &digits)))
            cli_die(cli, "%s: expected %%d or %%04d, the frame's number, or %%%% for a percent sign, in `%s`", what,
                    name);
    if (written && frames_count(range) > 1 && !frames_has_number(name))
        cli_die(cli, "%s: %d frames need a number in the name, as name-%%04d.exr, not `%s`", what, frames_count(range),
                name);
}

char *frames_name(const Cli *cli, const char *name, int frame)
{
    size_t size = 1;
    int digits;
    if (!name)
        return NULL;
    for (const char *c = name; *c; c++)
        size += *c == '%' ? DIGITS_MAX + 2 : 1;
    char *path = malloc(size), *out = path;
    if (!path)
        cli_die(cli, "not enough memory for the names of files");
    for (const char *c = name; *c;)
        if (*c != '%') {
            *out++ = *c++;
        } else {
            c = read_percent(c, &digits);
            out += digits < 0 ? sprintf(out, "%%") : sprintf(out, "%0*d", digits, frame);
        }
    *out = '\0';
    return path;
}

void frames_tell_failed(const Cli *cli, int failed, int total)
{
    RetexError err;
    retex_fail(&err, RETEX_EIO, "%d of %d frames failed", failed, total);
    cli_error(cli, &err);
}
