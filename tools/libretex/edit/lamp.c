/* The values of lamps: see retex/lamp.h. */
#include <retex/lamp.h>

#include <ctype.h>
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <retex/color.h>
#include <retex/color_text.h>
#include <retex/nearest.h>

#include "edit/number.h"
#include "set/set.h"

static const double GAIN_MAX = 1e30;

/* ---- black bodies ---- */

/* A lobe of a matching function: a Gaussian with two widths, in nanometres. */
static double lobe(double wavelength, double mean, double below, double above)
{
    const double t = (wavelength - mean) / (wavelength < mean ? below : above);
    return exp(-0.5 * t * t);
}

static void match(double wavelength, double xyz[3])
{
    xyz[0] = 1.056 * lobe(wavelength, 599.8, 37.9, 31.0) + 0.362 * lobe(wavelength, 442.0, 16.0, 26.7) -
             0.065 * lobe(wavelength, 501.1, 20.4, 26.2);
    xyz[1] = 0.821 * lobe(wavelength, 568.8, 46.9, 40.5) + 0.286 * lobe(wavelength, 530.9, 16.3, 31.1);
    xyz[2] = 1.217 * lobe(wavelength, 437.0, 11.8, 36.0) + 0.681 * lobe(wavelength, 459.0, 26.0, 13.8);
}

/* Makes the luminance of a colour 1; a colour of luminance 0 stays. */
static void normalize(double color[3])
{
    const double luminance = retex_luminance(color[0], color[1], color[2]);
    for (int c = 0; c < 3 && luminance > 0; c++)
        color[c] /= luminance;
}

void retex_kelvin_color(float color[3], double kelvin)
{
    static const double SECOND_RADIATION = 1.438776877e7; /* constant, in nanometres times kelvins */
    static const double rec709[3][3] = {
        {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};
    double sum[3] = {0, 0, 0}, linear[3];
    for (int wavelength = 360; wavelength <= 830; wavelength += 5) {
        double xyz[3];
        const double power = pow(wavelength / 560.0, -5) / expm1(SECOND_RADIATION / (wavelength * kelvin));
        match(wavelength, xyz);
        for (int c = 0; c < 3; c++)
            sum[c] += power * xyz[c];
    }
    for (int c = 0; c < 3; c++)
        linear[c] = fmax((rec709[c][0] * sum[0] + rec709[c][1] * sum[1] + rec709[c][2] * sum[2]) / sum[1], 0);
    normalize(linear);
    for (int c = 0; c < 3; c++)
        color[c] = (float)linear[c];
}

/* ---- text ---- */

static int no_value(const char *text, RetexError *err)
{
    return retex_fail(err, RETEX_EPARSE,
                      "light '%.80s': expected numbers, colours and kelvins, as in 2.5, #ffd0a0, 3000K or 1.5*3000K",
                      text);
}

/* A factor that begins as a number does: one, or kelvins. */
static int parse_number(RetexLampValue *value, double color[3], const char *factor, const char *text, RetexError *err)
{
    char *end;
    const double number = strtod(factor, &end);
    float body[3];
    if (end == factor || !(number >= 0 && number <= GAIN_MAX))
        return no_value(text, err);
    if (!*end) {
        value->gain *= number;
        return RETEX_OK;
    }
    if ((*end != 'K' && *end != 'k') || end[1])
        return no_value(text, err);
    if (number < RETEX_KELVIN_MIN || number > RETEX_KELVIN_MAX)
        return retex_fail(err, RETEX_EPARSE, "light '%.80s': expected %d to %d kelvins", text, RETEX_KELVIN_MIN,
                          RETEX_KELVIN_MAX);
    retex_kelvin_color(body, number);
    value->colored = 1;
    for (int c = 0; c < 3; c++)
        color[c] *= (double)body[c];
    return RETEX_OK;
}

static int parse_factor(RetexLampValue *value, double color[3], const char *factor, const char *text, RetexError *err)
{
    float parsed[3];
    RetexError why;
    if (strchr("0123456789.+-", *factor))
        return parse_number(value, color, factor, text, err);
    const int code = retex_color_parse(parsed, factor, &why);
    if (code == RETEX_ENOTFOUND) {
        char meant[RETEX_MEANT_SIZE];
        return retex_fail(err, RETEX_EPARSE,
                          "light '%.80s': expected numbers, colours and kelvins, as in 2.5, #ffd0a0 or 1.5*3000K%s",
                          text, retex_color_meant(factor, meant));
    }
    if (code)
        return retex_fail(err, code, "%s", why.message);
    value->colored = 1;
    for (int c = 0; c < 3; c++)
        color[c] *= (double)parsed[c];
    return RETEX_OK;
}

/* Keeps the luminance, 1; a colour that is black turns the lamp off. */
static void keep_color(RetexLampValue *value, double color[3])
{
    static const double EXACT = 1e-6; /* a colour of luminance 1 stays the same to the bit */
    const double luminance = retex_luminance(color[0], color[1], color[2]);
    if (!(luminance > 0))
        value->gain = value->colored = 0;
    if (fabs(luminance - 1) > EXACT)
        normalize(color);
    for (int c = 0; c < 3; c++)
        value->color[c] = value->colored ? (float)color[c] : 1;
}

int retex_lamp_value_parse(RetexLampValue *value, const char *text, RetexError *err)
{
    RetexLampValue parsed = {.gain = 1};
    double color[3] = {1, 1, 1};
    const char *at = text;
    int code = RETEX_OK;
    for (int more = 1; more && !code;) {
        char factor[RETEX_LAMP_TEXT_MAX];
        size_t length = strcspn(at, "*");
        const char *next = at + length;
        more = *next == '*';
        while (length && isspace((unsigned char)*at))
            at++, length--;
        while (length && isspace((unsigned char)at[length - 1]))
            length--;
        if (!length || length >= sizeof factor)
            return no_value(text, err);
        memcpy(factor, at, length);
        factor[length] = '\0';
        code = parse_factor(&parsed, color, factor, text, err);
        at = next + 1;
    }
    if (!code && !(parsed.gain <= GAIN_MAX))
        code = no_value(text, err);
    if (code)
        return code;
    keep_color(&parsed, color);
    *value = parsed;
    return RETEX_OK;
}

void retex_lamp_value_text(const RetexLampValue *value, char text[RETEX_LAMP_TEXT_MAX])
{
    char gain[RETEX_NUMBER_MAX], r[RETEX_NUMBER_MAX], g[RETEX_NUMBER_MAX], b[RETEX_NUMBER_MAX];
    retex_number_text(value->gain, gain);
    if (value->colored)
        snprintf(text, RETEX_LAMP_TEXT_MAX, "%s%srgb(%s,%s,%s)", value->gain == 1 ? "" : gain,
                 value->gain == 1 ? "" : "*", retex_float_text(value->color[0], r),
                 retex_float_text(value->color[1], g), retex_float_text(value->color[2], b));
    else
        snprintf(text, RETEX_LAMP_TEXT_MAX, "%s", gain);
}

/* ---- lamps ---- */

int retex_lamp_value_apply(float color[3], const RetexLampValue *value, const RetexParameter *lamp, RetexError *err)
{
    const int off = lamp->value[0] == 0 && lamp->value[1] == 0 && lamp->value[2] == 0;
    const float *base = off ? lamp->kept : lamp->value;
    const double luminance = retex_luminance((double)base[0], (double)base[1], (double)base[2]);
    for (int c = 0; c < 3; c++) {
        const double old = (double)base[c], hue = (double)value->color[c];
        const double made = value->gain * (!value->colored ? old : lamp->several ? old * hue : luminance * hue);
        if (!(made <= (double)FLT_MAX))
            return retex_fail(err, RETEX_EINVAL, "the light of %s becomes too bright", lamp->name);
        color[c] = (float)made;
    }
    return RETEX_OK;
}

int retex_lamp_find(int *parameter, const RetexSet *set, const char *name, RetexError *err)
{
    char all[sizeof err->message] = "", meant[RETEX_MEANT_SIZE];
    RetexNearest nearest = {name, NULL, 0};
    int found = -1, alike = 0, lamps = 0;
    for (int i = 0; i < set->nparameters; i++) {
        const char *own = retex_parameter_lamp(set, i);
        if (!own)
            continue;
        const size_t used = strlen(all);
        *parameter = i;
        if (strcmp(own, name) == 0)
            return RETEX_OK;
        if (strcasecmp(own, name) == 0)
            found = i, alike++;
        snprintf(all + used, sizeof all - used, "%s%s", lamps++ ? ", " : "", own);
        retex_nearest_try(&nearest, own);
    }
    *parameter = found;
    if (alike == 1)
        return RETEX_OK;
    if (!lamps)
        return retex_fail(err, RETEX_ENOTFOUND,
                          "the set has no lamps: the light of '%s' cannot be changed; render it with --lamps", name);
    return retex_fail(err, RETEX_ENOTFOUND, "no lamp is called '%s'; the set has %.700s%s", name, all,
                      retex_meant(nearest.best, meant));
}
