/* See adjustment.h. */
#include "edit/adjustment.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include <retex/color_text.h>

#include "edit/number.h"

enum { COLOR = 0, WORD = -1 };

typedef struct AdjustmentKind {
    const char *word;
    int numbers;               /* 1 or 3; or COLOR or WORD */
    double least, most, plain; /* `plain` changes nothing */
    const char *expected;
} AdjustmentKind;

static const AdjustmentKind kinds[RETEX_ADJUSTS] = {
    [RETEX_ADJUST_HUE] = {"hue", 1, -1e6, 1e6, 0, "degrees, as in hue=30"},
    [RETEX_ADJUST_SATURATION] = {"saturation", 1, 0, 1e3, 1, "a factor from 0 to 1000, as in saturation=0.5"},
    [RETEX_ADJUST_GAIN] = {"gain", 3, 0, 1e6, 1, "one or three factors from 0 on, as in gain=1.5 or gain=1,0.9,0.8"},
    [RETEX_ADJUST_GAMMA] = {"gamma", 1, 1e-3, 1e3, 1, "a number from 0.001 to 1000, as in gamma=1.2"},
    [RETEX_ADJUST_CONTRAST] = {"contrast", 1, 1e-3, 1e3, 1, "a number from 0.001 to 1000, as in contrast=1.2"},
    [RETEX_ADJUST_BLUR] = {"blur", 1, 0, 0.25, 0, "a part of the image's width from 0 to 0.25, as in blur=0.01"},
    [RETEX_ADJUST_INVERT] = {"invert", WORD, 0, 0, 0, "yes or no"},
    [RETEX_ADJUST_TINT] = {"tint", COLOR, 0, 1e6, 1, "a colour, as in tint=#ffe0c0"},
    [RETEX_ADJUST_COLORIZE] = {"colorize", COLOR, 0, 1e6, -1, "a colour, as in colorize=#c04020"},
};

const char *retex_adjustment_word(RetexAdjust kind)
{
    return kinds[kind].word;
}

static int parse_color(float value[3], const AdjustmentKind *of, const char *text, RetexError *err)
{
    RetexError why = {0};
    const int code = retex_color_parse(value, text, &why);
    return !code ? RETEX_OK
           : code == RETEX_EPARSE
               ? retex_fail(err, code, "texture option %s: %s", of->word, why.message)
               : retex_fail(err, RETEX_EPARSE, "texture option %s='%.80s': expected %s", of->word, text, of->expected);
}

static int parse_value(float value[3], const AdjustmentKind *of, const char *text, RetexError *err)
{
    double numbers[3] = {0};
    if (of->numbers == COLOR)
        return parse_color(value, of, text, err);
    int is_right;
    if (of->numbers == WORD) {
        numbers[0] = strcasecmp(text, "yes") == 0;
        is_right = numbers[0] > 0 || strcasecmp(text, "no") == 0;
    } else {
        is_right = retex_numbers_parse(numbers, of->numbers, text);
        for (int i = 0; i < of->numbers; i++)
            is_right &= numbers[i] >= of->least && numbers[i] <= of->most;
    }
    for (int i = 0; i < 3; i++)
        value[i] = (float)numbers[i];
    return is_right
               ? RETEX_OK
               : retex_fail(err, RETEX_EPARSE, "texture option %s='%.80s': expected %s", of->word, text, of->expected);
}

static int changes_something(const AdjustmentKind *of, const float value[3])
{
    int changes = (double)value[0] != of->plain;
    for (int i = 1; i < 3 && (of->numbers == 3 || of->numbers == COLOR); i++)
        changes |= (double)value[i] != of->plain;
    return changes;
}

static const RetexAdjustment *find(const RetexTextureSpec *spec, RetexAdjust kind)
{
    for (int i = 0; i < spec->nadjustments; i++)
        if (spec->adjustments[i].kind == kind)
            return &spec->adjustments[i];
    return NULL;
}

int retex_adjustment_parse(RetexTextureSpec *spec, RetexAdjust kind, const char *text, RetexError *err)
{
    RetexAdjustment made = {kind, {0}};
    const int code = parse_value(made.value, &kinds[kind], text, err);
    if (code)
        return code;
    const RetexAdjustment *before = find(spec, kind);
    if (before) {
        const long at = before - spec->adjustments;
        memmove(spec->adjustments + at, spec->adjustments + at + 1,
                (size_t)(--spec->nadjustments - at) * sizeof *spec->adjustments);
    }
    if (changes_something(&kinds[kind], made.value))
        spec->adjustments[spec->nadjustments++] = made;
    return RETEX_OK;
}

int retex_adjustment_write(const RetexTextureSpec *spec, RetexAdjust kind, char *text, size_t size)
{
    const RetexAdjustment *of = find(spec, kind);
    char a[RETEX_NUMBER_MAX], b[RETEX_NUMBER_MAX], c[RETEX_NUMBER_MAX];
    if (!of)
        return 0;
    const float *value = of->value;
    if (kinds[kind].numbers == WORD)
        snprintf(text, size, "yes");
    else if (kinds[kind].numbers == 1)
        snprintf(text, size, "%s", retex_float_text(value[0], a));
    else
        snprintf(text, size, kinds[kind].numbers == COLOR ? "rgb(%s,%s,%s)" : "%s,%s,%s", retex_float_text(value[0], a),
                 retex_float_text(value[1], b), retex_float_text(value[2], c));
    return 1;
}
