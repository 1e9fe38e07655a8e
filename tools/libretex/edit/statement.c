/* The table of statements about a target's texture: how the value of each is read and written. Every mistake has one
 * message that names the option and says what would be right. */
#include "edit/statement.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/color_text.h>
#include <retex/nearest.h>

#define OPTION "texture option "

/* ---- numbers ---- */

/* Parses a finite number; *end is behind it. 0 where there is none. There is no -0, which would be written and say
 * nothing. */
static int parse_number(const char *text, const char **end, double *value)
{
    char *stop;
    *value = strtod(text, &stop) + 0.0;
    if (stop == text || !isfinite(*value))
        return 0;
    *end = stop;
    return 1;
}

static const char *skip_spaces(const char *text)
{
    while (isspace((unsigned char)*text))
        text++;
    return text;
}

/* Parses one or two numbers; one number stands for both. */
static int parse_pair(double pair[2], const char *text)
{
    const char *at = text;
    if (!parse_number(at, &at, &pair[0]))
        return 0;
    pair[1] = pair[0];
    at = skip_spaces(at);
    if (*at == ',') {
        if (!parse_number(at + 1, &at, &pair[1]))
            return 0;
        at = skip_spaces(at);
    }
    return *at == '\0';
}

enum { NUMBER_MAX = 32 };

/* The fewest digits that mean the same. */
static const char *number_text(double value, char text[NUMBER_MAX])
{
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, NUMBER_MAX, "%.*g", digits, value);
        if (strtod(text, NULL) == value)
            break;
    }
    return text;
}

static const char *float_text(float value, char text[NUMBER_MAX])
{
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, NUMBER_MAX, "%.*g", digits, (double)value);
        if ((float)strtod(text, NULL) == value)
            break;
    }
    return text;
}

static int write_pair(const double pair[2], double unsaid, char text[STATEMENT_TEXT_MAX])
{
    char first[NUMBER_MAX], second[NUMBER_MAX];
    snprintf(text, STATEMENT_TEXT_MAX, "%s,%s", number_text(pair[0], first), number_text(pair[1], second));
    return pair[0] != unsaid || pair[1] != unsaid;
}

/* ---- words ---- */

static int find_word(const char *const *words, int count, const char *word, size_t length)
{
    int i = 0;
    while (i < count && (strlen(words[i]) != length || strncasecmp(words[i], word, length) != 0))
        i++;
    return i < count ? i : -1;
}

static const char *const wrap_words[] = {"repeat", "mirror", "clamp", "black"};
static const char *const repeat_words[] = {"straight", "brick", "half-drop", "mirror"};

/* ---- the image ---- */

static int parse_image(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    RetexError why;
    const int code = retex_color_parse(spec->color, value, &why);
    spec->constant = !code;
    if (code == RETEX_EPARSE)
        return retex_fail(err, code, "%s", why.message);
    if (!code)
        return code;
    if (strlen(value) >= sizeof spec->image)
        return retex_fail(err, RETEX_EPARSE, "texture for '%s': the image's name has at most %d bytes", spec->target,
                          (int)sizeof spec->image - 1);
    strcpy(spec->image, value);
    return RETEX_OK;
}

static int write_image(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    char r[NUMBER_MAX], g[NUMBER_MAX], b[NUMBER_MAX];
    if (spec->constant)
        snprintf(text, STATEMENT_TEXT_MAX, "rgb(%s,%s,%s)", float_text(spec->color[0], r),
                 float_text(spec->color[1], g), float_text(spec->color[2], b));
    else
        snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->image);
    return 1;
}

/* ---- options ---- */

static int parse_scale(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!parse_pair(spec->scale, value))
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "scale='%s': expected one or two numbers, as in scale=2 or scale=2,1", value);
    if (spec->scale[0] == 0 || spec->scale[1] == 0)
        return retex_fail(err, RETEX_EPARSE, OPTION "scale='%s': a scale cannot be 0", value);
    return RETEX_OK;
}

static int write_scale(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    return write_pair(spec->scale, 1, text);
}

static int parse_rotate(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const char *end;
    if (!parse_number(value, &end, &spec->rotate) || *skip_spaces(end))
        return retex_fail(err, RETEX_EPARSE, OPTION "rotate='%s': expected degrees, as in rotate=30", value);
    return RETEX_OK;
}

static int write_rotate(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    number_text(spec->rotate, text);
    return spec->rotate != 0;
}

static int parse_offset(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!parse_pair(spec->offset, value))
        return retex_fail(err, RETEX_EPARSE, OPTION "offset='%s': expected one or two numbers, as in offset=0,0.5",
                          value);
    return RETEX_OK;
}

static int write_offset(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    return write_pair(spec->offset, 0, text);
}

static int parse_flip(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const size_t length = strlen(value);
    spec->flip[0] = strpbrk(value, "uU") != NULL;
    spec->flip[1] = strpbrk(value, "vV") != NULL;
    if (length < 1 || strspn(value, "uvUV") != length || (size_t)(spec->flip[0] + spec->flip[1]) != length)
        return retex_fail(err, RETEX_EPARSE, OPTION "flip='%s': expected u, v or uv", value);
    return RETEX_OK;
}

static int write_flip(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s%s", spec->flip[0] ? "u" : "", spec->flip[1] ? "v" : "");
    return text[0] != '\0';
}

static int parse_wrap(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const size_t first = strcspn(value, ",");
    const char *second = value[first] ? value + first + 1 : value;
    const int u = find_word(wrap_words, 4, value, first);
    const int v = find_word(wrap_words, 4, second, second == value ? first : strlen(second));
    if (u < 0 || v < 0)
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "wrap='%s': expected repeat, mirror, clamp or black, or two of them for u,v", value);
    spec->wrap[0] = (RetexWrap)u, spec->wrap[1] = (RetexWrap)v;
    return RETEX_OK;
}

static int write_wrap(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    const int both = spec->wrap[0] == spec->wrap[1];
    snprintf(text, STATEMENT_TEXT_MAX, both ? "%s" : "%s,%s", wrap_words[spec->wrap[0]], wrap_words[spec->wrap[1]]);
    return !both || spec->wrap[0] != RETEX_WRAP_REPEAT;
}

static int parse_repeat(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    const int found = find_word(repeat_words, 4, value, strlen(value));
    if (found < 0)
        return retex_fail(err, RETEX_EPARSE, OPTION "repeat='%s': expected straight, brick, half-drop or mirror",
                          value);
    spec->repeat = (RetexRepeat)found;
    return RETEX_OK;
}

static int write_repeat(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", repeat_words[spec->repeat]);
    return spec->repeat != RETEX_REPEAT_STRAIGHT;
}

/* One or two lengths; the image determines the second where it is missing. */
static int parse_width(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!parse_pair(spec->width, value) || !(spec->width[0] > 0) || !(spec->width[1] > 0))
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "width='%s': expected one or two lengths above 0, as in width=1.2 or width=1.2,0.2",
                          value);
    if (!strchr(value, ','))
        spec->width[1] = 0;
    return RETEX_OK;
}

static int write_width(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    if (spec->width[1] > 0)
        return write_pair(spec->width, 0, text);
    number_text(spec->width[0], text);
    return spec->width[0] > 0;
}

static int parse_colorspace(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!*value || strlen(value) >= sizeof spec->colorspace || strchr(value, ':')) /* which would end it in an option */
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "colorspace='%.80s': expected the name of a colour space, as in colorspace=sRGB",
                          value);
    strcpy(spec->colorspace, value);
    return RETEX_OK;
}

static int write_colorspace(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->colorspace);
    return text[0] != '\0';
}

static int parse_finish(RetexTextureSpec *spec, const char *value, RetexError *err)
{
    if (!*value || strlen(value) >= sizeof spec->finish || strchr(value, ':')) /* which would end it in an option */
        return retex_fail(err, RETEX_EPARSE,
                          OPTION "finish='%.80s': expected a picture without a colon in its name, as in "
                                 "finish=gloss.png, or none",
                          value);
    strcpy(spec->finish, value);
    return RETEX_OK;
}

static int write_finish(const RetexTextureSpec *spec, char text[STATEMENT_TEXT_MAX])
{
    snprintf(text, STATEMENT_TEXT_MAX, "%s", spec->finish);
    return text[0] != '\0';
}

/* ---- the table ---- */

const RetexStatementKind retex_statement_kinds[STATEMENT_KINDS] = {
    {"", parse_image, write_image},
    {"scale", parse_scale, write_scale},
    {"rotate", parse_rotate, write_rotate},
    {"offset", parse_offset, write_offset},
    {"flip", parse_flip, write_flip},
    {"wrap", parse_wrap, write_wrap},
    {"repeat", parse_repeat, write_repeat},
    {"width", parse_width, write_width},
    {"colorspace", parse_colorspace, write_colorspace},
    {"finish", parse_finish, write_finish},
};

int retex_statement_option(const char *word, size_t length)
{
    for (int k = 1; k < STATEMENT_KINDS; k++)
        if (strlen(retex_statement_kinds[k].word) == length && memcmp(word, retex_statement_kinds[k].word, length) == 0)
            return k;
    return -1;
}

int retex_statement_unknown(const char *word, RetexError *err)
{
    char words[160] = "", meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {word, NULL, 0};
    for (int k = 1; k < STATEMENT_KINDS; k++) {
        const size_t used = strlen(words);
        snprintf(words + used, sizeof words - used, "%s%s", k > 1 ? ", " : "", retex_statement_kinds[k].word);
        retex_nearest_try(&nearest, retex_statement_kinds[k].word);
    }
    return retex_fail(err, RETEX_EPARSE, "no texture option is called '%s'; there are %s%s", word, words,
                      retex_meant(nearest.best, meant));
}

int retex_statement_check(const RetexTextureSpec *spec, RetexError *err)
{
    const int shifted = spec->repeat == RETEX_REPEAT_BRICK || spec->repeat == RETEX_REPEAT_HALF_DROP;
    if (shifted && (spec->wrap[0] != RETEX_WRAP_REPEAT || spec->wrap[1] != RETEX_WRAP_REPEAT))
        return retex_fail(err, RETEX_EPARSE, "texture options: repeat=%s needs wrap=repeat, the default, on both axes",
                          repeat_words[spec->repeat]);
    return RETEX_OK;
}
