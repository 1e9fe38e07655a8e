/* See said.h. */
#include "said.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "reply.h"

void said_free(Said *said)
{
    for (int i = 0; i < SAID_LINES; i++)
        free(said->lines[i]);
    free(said->output);
    *said = (Said){0};
}

static void add_line(Said *said, const char *text)
{
    const int at = (said->first + said->nlines) % SAID_LINES;
    char *copy = strdup(text);
    if (!copy)
        return;
    if (said->nlines == SAID_LINES) {
        free(said->lines[at]);
        said->first = (said->first + 1) % SAID_LINES;
        said->dropped++;
    } else {
        said->nlines++;
    }
    said->lines[at] = copy;
}

/* {"stage": "render", "fraction": 0.25, "seconds": 3.5}: 1, or 0 if it is another line. */
static int take_progress(Said *said, const char *line)
{
    if (*line != '{')
        return 0;
    json_t *root = json_loads(line, 0, NULL);
    const char *stage = json_string_value(json_object_get(root, "stage"));
    const json_t *fraction = json_object_get(root, "fraction");
    const int is_progress = stage && json_is_number(fraction);
    if (is_progress) {
        said->progress = json_number_value(fraction);
        snprintf(said->stage, sizeof said->stage, "%s", stage);
    }
    json_decref(root);
    return is_progress;
}

static void end_line(Said *said)
{
    said->line[said->length] = 0;
    said->length = 0;
    if (!take_progress(said, said->line))
        add_line(said, said->line);
}

int said_message(Said *said, const char *bytes, size_t count)
{
    int changed = 0;
    for (const char *c = bytes; c < bytes + count; c++)
        if (*c == '\n' || *c == '\r') {
            changed |= said->length > 0;
            if (said->length)
                end_line(said);
        } else if (said->length < SAID_LINE && *c) {
            said->line[said->length++] = *c;
        }
    return changed;
}

int said_output(Said *said, const char *bytes, size_t count)
{
    const size_t left = SAID_OUTPUT - said->output_bytes, kept = count < left ? count : left;
    if (!said->output && !(said->output = malloc(SAID_OUTPUT + 1)))
        return 0;
    said->is_cut |= kept < count;
    memcpy(said->output + said->output_bytes, bytes, kept);
    said->output_bytes += kept;
    return kept > 0;
}

void said_line(Said *said, const char *fmt, ...)
{
    char text[SAID_LINE + 1];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    add_line(said, text);
}

void said_end(Said *said, int is_done)
{
    if (said->length)
        end_line(said);
    if (is_done)
        said->progress = 1;
}

const char *said_last(const Said *said)
{
    return said->nlines ? said->lines[(said->first + said->nlines - 1) % SAID_LINES] : "";
}

/* Standard output as text; a NUL ends it. */
static json_t *output_json(const Said *said)
{
    if (!said->output)
        return json_string("");
    said->output[said->output_bytes] = 0;
    return json_of_text(said->output);
}

json_t *said_json(const Said *said)
{
    json_t *lines = json_array();
    for (int i = 0; i < said->nlines; i++)
        json_array_append_new(lines, json_of_text(said->lines[(said->first + i) % SAID_LINES]));
    return json_pack("{s:f, s:s, s:o, s:i, s:o, s:b}", "progress", said->progress, "stage", said->stage, "lines", lines,
                     "dropped", said->dropped, "stdout", output_json(said), "cut", said->is_cut);
}
