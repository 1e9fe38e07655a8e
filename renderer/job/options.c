/* Parses render options. Names, values and messages are the same on the command line and in names that OpenImageIO
 * opens. */
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <retex/edit.h>
#include <retex/nearest.h>
#include "film/params.h"
#include "job/animation.h"
#include "job/job.h"

typedef struct Option {
    RenderParams *render;
    SdlOptions *sdl;
    const char *name, *value;
    RetexError *err;
} Option;

static int read_whole(const Option *o, long low, long high, long *number)
{
    char *end;
    errno = 0;
    *number = strtol(o->value, &end, 10);
    if (errno || end == o->value || *end || isspace((unsigned char)o->value[0]) || *number < low || *number > high)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected a whole number from %ld to %ld, not '%s'", o->name, low,
                          high, o->value);
    return RETEX_OK;
}

static int set_whole(const Option *o, long low, long high, int *field)
{
    long number;
    int code = read_whole(o, low, high, &number);
    if (!code)
        *field = (int)number;
    return code;
}

static int set_seed(const Option *o)
{
    long number;
    int code = read_whole(o, 0, 0xffffffffL, &number);
    if (!code)
        o->render->seed = (uint32_t)number;
    return code;
}

static int set_real(const Option *o, double low, double high, double *field)
{
    char *end;
    double value = strtod(o->value, &end);
    if (end == o->value || *end || isspace((unsigned char)o->value[0]) || !isfinite(value) || value < low ||
        value > high)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected a number from %g to %g, not '%s'", o->name, low, high,
                          o->value);
    *field = value;
    return RETEX_OK;
}

int job_numbers(const char *text, char separator, int count, int *numbers)
{
    for (int k = 0; k < count; k++) {
        char *end;
        long v = strtol(text, &end, 10);
        if (!isdigit((unsigned char)*text) || v < 0 || v > 1 << 24 || *end != (k + 1 < count ? separator : 0))
            return 0;
        numbers[k] = (int)v;
        text = end + 1;
    }
    return 1;
}

static int set_size(const Option *o)
{
    int size[2];
    if (!job_numbers(o->value, 'x', 2, size) || size[0] < 1 || size[1] < 1)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected WxH, not `%s`", o->name, o->value);
    o->render->width = o->sdl->width = size[0];
    o->render->height = o->sdl->height = size[1];
    return RETEX_OK;
}

static int set_unit(const Option *o)
{
    RetexError why = {0};
    if (retex_length_parse(&o->render->unit, o->value, &why) || o->render->unit < 1e-9 || o->render->unit > 1e9)
        return retex_fail(o->err, RETEX_EPARSE,
                          "%s: expected what a scene unit is, as cm, 0.01 or 2.5cm: 1e-9 to 1e9 metres, not `%s`",
                          o->name, o->value);
    return RETEX_OK;
}

static int set_crop(const Option *o)
{
    int crop[4];
    if (!job_numbers(o->value, ',', 4, crop) || crop[2] < 1 || crop[3] < 1)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected X,Y,W,H, not `%s`", o->name, o->value);
    memcpy(o->render->crop, crop, sizeof crop);
    return RETEX_OK;
}

/* The index of the value among two names. */
static int set_choice(const Option *o, const char *first, const char *second, int *field)
{
    char meant[RETEX_MEANT_SIZE];
    if (strcmp(o->value, first) && strcmp(o->value, second))
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected %s or %s, not `%s`%s", o->name, first, second, o->value,
                          retex_meant(retex_nearest_of(o->value, (const char *const[]){first, second}, 2), meant));
    *field = !strcmp(o->value, second);
    return RETEX_OK;
}

#define ADDENDS_MAX 3

/* How many numbers of up to two digits, with + between them, a text is; 0: it is something else. */
static int read_addends(const char *text, int numbers[ADDENDS_MAX])
{
    int used;
    for (int count = 0; count < ADDENDS_MAX; text += used + 1) {
        if (!isdigit((unsigned char)*text) || sscanf(text, "%2d%n", &numbers[count++], &used) != 1)
            return 0;
        if (!text[used])
            return count;
        if (text[used] != '+')
            return 0;
    }
    return 0;
}

/* Clusters: one number for both kinds together, S+B, or S+B+X. */
static int set_clusters(const Option *o)
{
    int n[ADDENDS_MAX] = {0};
    const int count = read_addends(o->value, n);
    if (!count)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected one number, or two or three as in 4+2+8, not `%s`",
                          o->name, o->value);
    const int sharp = n[0], broad = count == 1 ? n[0] : n[1], all = n[0] + n[1];
    if (all < 2 || all + n[2] > FILM_CLUSTERS_MAX || sharp < 1 || broad < 1)
        return retex_fail(o->err, RETEX_EPARSE, "%s: expected 2 to %d, at least one sharp and one broad, not `%s`",
                          o->name, FILM_CLUSTERS_MAX, o->value);
    o->render->clusters = all;
    o->render->sharp = sharp, o->render->broad = broad, o->render->extra = n[2];
    return RETEX_OK;
}

static int set_filter(const Option *o)
{
    return set_choice(o, "box", "gaussian", &o->render->gaussian);
}

static int set_layout(const Option *o)
{
    return set_choice(o, "footprints", "paper", &o->render->paper);
}

static int set_aovs(const Option *o)
{
    return retex_aov_parse(&o->render->aovs, o->value, o->name, o->err);
}

/* An option with a value: a number from low to high, which is a member of RenderParams, or what a function reads. */
typedef struct Row {
    const char *name;
    enum { WHOLE, REAL, READ } kind;
    size_t at;
    double low, high;
    int (*read)(const Option *o);
} Row;

#define AT(member) offsetof(RenderParams, member)

static const Row rows[] = {
    {"spp", WHOLE, AT(spp), 1, 1 << 20, NULL},
    {"max-depth", WHOLE, AT(max_depth), 1, 256, NULL},
    {"orders", WHOLE, AT(orders), 1, RETEX_MAX_ORDERS, NULL},
    {"noise", REAL, AT(noise), 1e-6, 10, NULL},
    {"light-share", REAL, AT(light_share), 0, 1, NULL},
    {"seed", READ, 0, 0, 0, set_seed},
    {"size", READ, 0, 0, 0, set_size},
    {"unit", READ, 0, 0, 0, set_unit},
    {"crop", READ, 0, 0, 0, set_crop},
    {"filter", READ, 0, 0, 0, set_filter},
    {"layout", READ, 0, 0, 0, set_layout},
    {"clusters", READ, 0, 0, 0, set_clusters},
    {"aov", READ, 0, 0, 0, set_aovs},
};

static int set_value(const Option *o)
{
    const Row *row = rows, *end = rows + sizeof rows / sizeof *rows;
    while (row < end && strcmp(o->name, row->name))
        row++;
    if (row == end)
        return retex_fail(o->err, RETEX_ENOTFOUND, "%s is no option of a render", o->name);
    void *member = (char *)o->render + row->at;
    return row->kind == WHOLE  ? set_whole(o, (long)row->low, (long)row->high, member)
           : row->kind == REAL ? set_real(o, row->low, row->high, member)
                               : row->read(o);
}

int job_set_option(RenderParams *render, SdlOptions *sdl, const char *name, const char *value, RetexError *err)
{
    const struct {
        const char *name;
        int *field, set;
    } flags[] = {{"plain", &render->plain, 1},
                 {"strict-paper", &render->strict_paper, 1},
                 {"caustics-guide", &render->caustics_guide, 1},
                 {"caustics", &sdl->caustics, 1},
                 {"no-caustics", &sdl->caustics, -1},
                 {"ambient", &sdl->ambient, 1},
                 {"no-ambient", &sdl->ambient, -1},
                 {"lenient", &sdl->lenient, 1},
                 {"strict", &sdl->strict, 1}};
    const Option option = {render, sdl, name, value, err};
    for (size_t k = 0; k < sizeof flags / sizeof *flags; k++)
        if (!strcmp(name, flags[k].name)) {
            int on = 1, code = value ? set_whole(&option, 0, 1, &on) : RETEX_OK;
            *flags[k].field = on ? flags[k].set : 0;
            return code;
        }
    return value ? set_value(&option) : retex_fail(err, RETEX_EPARSE, "%s: expected a value", name);
}

int job_check_declare(const char *declare, RetexError *err)
{
    const char *value = strchr(declare, '=');
    char *end;
    if (!value || !((value[1] && strchr("0123456789.+-", value[1])) || animation_is_declare(declare)))
        return RETEX_OK;
    strtod(value + 1, &end);
    if (*end || end == value + 1)
        return retex_fail(err, RETEX_EPARSE, "expected NAME=NUMBER or NAME=\"TEXT\", not `%s`", declare);
    return RETEX_OK;
}
