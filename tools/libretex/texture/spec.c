/* Parses the texture option, `--texture:scale=2,2:rotate=30 floor=oak.jpg`, into a RetexTextureSpec. Every mistake has
 * one message that names the option and says what would be right. */
#include <retex/host/nearest.h>
#include <retex/texture.h>
#include "base/params.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define OPTION_NAMES "scale, rotate, offset, flip, wrap, repeat, width, colorspace"

static int unknown_option(const char *name, RetexError *err)
{
    static const char *const names[] = {"scale", "rotate", "offset", "flip", "wrap", "repeat", "width", "colorspace"};
    char meant[RETEX_MEANT_SIZE];
    return retex_fail(err, RETEX_EPARSE, "no texture option is called '%s'; there are " OPTION_NAMES "%s", name,
                      retex_meant(retex_nearest_of(name, names, sizeof names / sizeof *names), meant));
}

/* Parses a finite number; *end is behind it. 0 where there is none. */
static int parse_number(const char *text, const char **end, double *value)
{
    char *stop;
    *value = strtod(text, &stop);
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

static int parse_wrap_word(RetexWrap *wrap, const char *word, size_t length)
{
    static const char *const words[] = {"repeat", "mirror", "clamp", "black"};
    for (int i = 0; i < 4; i++)
        if (strlen(words[i]) == length && strncasecmp(words[i], word, length) == 0) {
            *wrap = (RetexWrap)i;
            return 1;
        }
    return 0;
}

static int parse_wrap(RetexWrap wrap[2], const char *text)
{
    size_t first = strcspn(text, ",");
    if (!parse_wrap_word(&wrap[0], text, first))
        return 0;
    wrap[1] = wrap[0];
    return text[first] == '\0' || parse_wrap_word(&wrap[1], text + first + 1, strlen(text + first + 1));
}

static int parse_flip(int flip[2], const char *text)
{
    size_t length = strlen(text);
    if (length < 1 || strspn(text, "uvUV") != length)
        return 0;
    flip[0] = strpbrk(text, "uU") != NULL;
    flip[1] = strpbrk(text, "vV") != NULL;
    return (size_t)(flip[0] + flip[1]) == length;
}

static const char *const repeat_words[] = {"straight", "brick", "half-drop", "mirror"};

static int parse_repeat(RetexRepeat *repeat, const char *text)
{
    for (int i = 0; i < 4; i++)
        if (strcasecmp(repeat_words[i], text) == 0) {
            *repeat = (RetexRepeat)i;
            return 1;
        }
    return 0;
}

/* Parses one or two lengths; the image determines the second where it is missing. */
static int parse_width(double width[2], const char *text)
{
    if (!parse_pair(width, text) || !(width[0] > 0) || !(width[1] > 0))
        return 0;
    if (!strchr(text, ','))
        width[1] = 0;
    return 1;
}

static int parse_option(RetexTextureSpec *spec, const char *name, const char *value, RetexError *err)
{
    if (strcmp(name, "scale") == 0) {
        if (!parse_pair(spec->scale, value))
            return retex_fail(err, RETEX_EPARSE,
                              "texture option scale='%s': expected one or two numbers, as in scale=2 "
                              "or scale=2,1",
                              value);
        if (spec->scale[0] == 0 || spec->scale[1] == 0)
            return retex_fail(err, RETEX_EPARSE, "texture option scale='%s': a scale cannot be 0", value);
    } else if (strcmp(name, "rotate") == 0) {
        const char *end;
        if (!parse_number(value, &end, &spec->rotate) || *skip_spaces(end))
            return retex_fail(err, RETEX_EPARSE, "texture option rotate='%s': expected degrees, as in rotate=30",
                              value);
    } else if (strcmp(name, "offset") == 0) {
        if (!parse_pair(spec->offset, value))
            return retex_fail(err, RETEX_EPARSE,
                              "texture option offset='%s': expected one or two numbers, as in "
                              "offset=0,0.5",
                              value);
    } else if (strcmp(name, "wrap") == 0) {
        if (!parse_wrap(spec->wrap, value))
            return retex_fail(err, RETEX_EPARSE,
                              "texture option wrap='%s': expected repeat, mirror, clamp or black, or "
                              "two of them for u,v",
                              value);
    } else if (strcmp(name, "flip") == 0) {
        if (!parse_flip(spec->flip, value))
            return retex_fail(err, RETEX_EPARSE, "texture option flip='%s': expected u, v or uv", value);
    } else if (strcmp(name, "repeat") == 0) {
        if (!parse_repeat(&spec->repeat, value))
            return retex_fail(err, RETEX_EPARSE,
                              "texture option repeat='%s': expected straight, brick, half-drop or mirror", value);
    } else if (strcmp(name, "width") == 0) {
        if (!parse_width(spec->width, value))
            return retex_fail(err, RETEX_EPARSE,
                              "texture option width='%s': expected one or two lengths above 0, as in width=1.2 or "
                              "width=1.2,0.2",
                              value);
    } else if (strcmp(name, "colorspace") == 0) {
        if (!*value || strlen(value) >= sizeof spec->colorspace)
            return retex_fail(err, RETEX_EPARSE,
                              "texture option colorspace='%.80s': expected the name of a colour space, "
                              "as in colorspace=sRGB",
                              value);
        strcpy(spec->colorspace, value);
    } else {
        return unknown_option(name, err);
    }
    return RETEX_OK;
}

static int parse_options(RetexTextureSpec *spec, const char *opts, RetexError *err)
{
    int code = RETEX_OK;
    char text[4096]; /* fixed memory: text that was parsed once is parsed again later, which must not fail for lack
                        of memory */
    if (strlen(opts) >= sizeof text)
        return retex_fail(err, RETEX_EPARSE, "texture options of more than %zu characters", sizeof text - 1);
    strcpy(text, opts);
    for (char *at = text, *next; at && !code; at = next) {
        next = strchr(at, ':');
        if (next)
            *next++ = '\0';
        if (!*at) /* "::" and a colon at either end are allowed */
            continue;
        char *equals = strchr(at, '=');
        if (!equals) {
            code = retex_fail(err, RETEX_EPARSE, "texture option '%s' has no value; expected name=value with one of %s",
                              at, OPTION_NAMES);
            break;
        }
        *equals = '\0';
        code = parse_option(spec, at, equals + 1, err);
    }
    int shifted = spec->repeat == RETEX_REPEAT_BRICK || spec->repeat == RETEX_REPEAT_HALF_DROP;
    if (!code && shifted && (spec->wrap[0] != RETEX_WRAP_REPEAT || spec->wrap[1] != RETEX_WRAP_REPEAT))
        code = retex_fail(err, RETEX_EPARSE, "texture options: repeat=%s needs wrap=repeat, the default, on both axes",
                          repeat_words[spec->repeat]);
    return code;
}

/* Parses `rgb(r, g, b)`; 0 where the text is not a colour and so is a file name. */
static int parse_color(RetexTextureSpec *spec, const char *text, RetexError *err)
{
    const char *at = skip_spaces(text);
    if (strncasecmp(at, "rgb", 3) != 0)
        return 0;
    at = skip_spaces(at + 3);
    if (*at != '(')
        return 0;
    at++;
    for (int c = 0; c < 3; c++) {
        double value;
        if (!parse_number(at, &at, &value) || value < 0 || value > 1e30)
            return retex_fail(err, RETEX_EPARSE, "colour '%s': expected rgb(r,g,b) with three numbers of 0 or more",
                              text);
        spec->color[c] = (float)value;
        at = skip_spaces(at);
        if (*at++ != (c < 2 ? ',' : ')'))
            return retex_fail(err, RETEX_EPARSE, "colour '%s': expected rgb(r,g,b) with three numbers", text);
    }
    if (*skip_spaces(at))
        return retex_fail(err, RETEX_EPARSE, "colour '%s': nothing may follow rgb(r,g,b)", text);
    spec->constant = 1;
    return 0;
}

int retex_texture_spec_needs_scale(const RetexTextureSpec *given)
{
    RetexTextureSpec spec = RETEX_TEXTURE_SPEC_INIT;
    return !RETEX_PARAMS_COPY(&spec, given, NULL) && !spec.constant && spec.width[0] > 0;
}

static int parse(RetexTextureSpec *spec, const char *opts, const char *arg, RetexError *err)
{
    int code = parse_options(spec, opts ? opts : "", err);
    if (code)
        return code;
    if (!arg)
        arg = "";
    const char *equals = strchr(arg, '=');
    if (!equals || equals == arg)
        return retex_fail(err, RETEX_EPARSE, "texture '%s': expected NAME=IMAGE, a target and what to put on it", arg);
    size_t length = (size_t)(equals - arg);
    if (length >= sizeof spec->target)
        return retex_fail(err, RETEX_EPARSE, "texture '%.40s…': a target's name has at most %d bytes", arg,
                          (int)sizeof spec->target - 1);
    memcpy(spec->target, arg, length);
    spec->target[length] = '\0';
    const char *image = equals + 1;
    if (!*image)
        return retex_fail(err, RETEX_EPARSE, "texture '%s': no image after '='", arg);
    code = parse_color(spec, image, err);
    if (code || spec->constant)
        return code;
    if (strlen(image) >= sizeof spec->image)
        return retex_fail(err, RETEX_EPARSE, "texture for '%s': the image's name has at most %d bytes", spec->target,
                          (int)sizeof spec->image - 1);
    strcpy(spec->image, image);
    return RETEX_OK;
}

int retex_texture_spec_parse(RetexTextureSpec *spec, const char *opts, const char *arg, RetexError *err)
{
    RetexTextureSpec own = RETEX_TEXTURE_SPEC_INIT;
    const int code = parse(&own, opts, arg, err);
    return code ? code : RETEX_PARAMS_RETURN(spec, &own, err);
}
