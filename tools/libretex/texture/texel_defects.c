/* See texel_defects.h. */
#include "texture/texel_defects.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include <retex/color.h>

#define LARGEST_COLOR 65504.0f /* the largest half; sums and squares of it are finite */
/* A negative colour above this is a rounding error of a conversion. */
#define LEAST_NEGATIVE -1e-5f
/* White, with a margin for rounding. Colours of wide gamuts have channels above 1 that reflect no more than white does,
 * up to 2.6 for the red of ACES2065-1: they are judged by their luminance. */
#define BRIGHTER_THAN_WHITE 1.001f
#define BEYOND_ANY_GAMUT 3.0f

static void count_texel(RetexTexelDefects *defects, RetexTexelDefect defect, int x, int y)
{
    if (defects->count[defect]++ == 0) {
        defects->x[defect] = x;
        defects->y[defect] = y;
    }
}

static float largest_of(const float *p)
{
    return fmaxf(p[0], fmaxf(p[1], p[2]));
}

static int is_bright(const float *p)
{
    return retex_luminancef(p[0], p[1], p[2]) > BRIGHTER_THAN_WHITE || largest_of(p) > BEYOND_ANY_GAMUT;
}

static void count_bright(RetexTexelDefects *defects, const float *p, int x, int y)
{
    count_texel(defects, RETEX_TEXEL_BRIGHT, x, y);
    defects->brightest = fmaxf(defects->brightest, largest_of(p));
}

static void repair_texel(float *p, int x, int y, RetexTexelDefects *defects)
{
    int too_large = 0, negative = 0;

    if (!isfinite(p[0]) || !isfinite(p[1]) || !isfinite(p[2]) || !isfinite(p[3])) {
        count_texel(defects, RETEX_TEXEL_NOT_FINITE, x, y);
        p[0] = p[1] = p[2] = 0;
        p[3] = isfinite(p[3]) ? p[3] : 0;
        return;
    }
    for (int c = 0; c < 3; c++) {
        too_large |= fabsf(p[c]) > LARGEST_COLOR;
        negative |= p[c] < LEAST_NEGATIVE;
        p[c] = fminf(fmaxf(p[c], -LARGEST_COLOR), LARGEST_COLOR);
    }
    if (negative)
        count_texel(defects, RETEX_TEXEL_NEGATIVE, x, y);
    if (too_large)
        count_texel(defects, RETEX_TEXEL_TOO_LARGE, x, y);
    else if (p[3] > 0 && is_bright(p))
        count_bright(defects, p, x, y);
}

void retex_texel_defects_repair(float *rgba, int width, int y, RetexTexelDefects *defects)
{
    *defects = (RetexTexelDefects){.brightest = 0};
    if (retex_texels_are_in_range(rgba, 4 * (size_t)width))
        return;
    for (int x = 0; x < width; x++)
        if (!retex_texels_are_in_range(rgba + 4 * (size_t)x, 4))
            repair_texel(rgba + 4 * (size_t)x, x, y, defects);
}

void retex_texel_defects_merge(RetexTexelDefects *defects, const RetexTexelDefects *row)
{
    for (int k = 0; k < RETEX_TEXEL_DEFECTS; k++) {
        if (defects->count[k] == 0) {
            defects->x[k] = row->x[k];
            defects->y[k] = row->y[k];
        }
        defects->count[k] += row->count[k];
    }
    defects->brightest = fmaxf(defects->brightest, row->brightest);
}

void retex_texel_defects_repair_color(float color[3], RetexTexelDefects *defects)
{
    float texel[4] = {color[0], color[1], color[2], 1};

    *defects = (RetexTexelDefects){.brightest = 0};
    repair_texel(texel, 0, 0, defects);
    if (defects->brightest == 0 && largest_of(texel) > BRIGHTER_THAN_WHITE) /* a constant has no wide gamut */
        count_bright(defects, texel, 0, 0);
    memcpy(color, texel, 3 * sizeof *color);
}

/* ---- in words ---- */

static double linear_of_code(float code)
{
    return retex_srgb_decode((double)code / 255);
}

static void report_color(const RetexTexelDefects *defects, const RetexTextureSpec *spec)
{
    const float *c = spec->color;
    char text[400];
    int used;

    if (!defects->count[RETEX_TEXEL_BRIGHT] && !defects->count[RETEX_TEXEL_TOO_LARGE])
        return;
    used = snprintf(text, sizeof text,
                    "%s%srgb(%g,%g,%g): a surface of a colour above 1 gives back more light than it gets", spec->target,
                    spec->target[0] ? "=" : "", (double)c[0], (double)c[1], (double)c[2]);
    if (defects->count[RETEX_TEXEL_TOO_LARGE])
        snprintf(text + used, sizeof text - (size_t)used, "; it is taken as %g at most", (double)LARGEST_COLOR);
    else if (defects->brightest > 4 && defects->brightest <= 255)
        snprintf(text + used, sizeof text - (size_t)used,
                 "; if numbers from 0 to 255 are meant, it is rgb(%.3g,%.3g,%.3g)", linear_of_code(c[0]),
                 linear_of_code(c[1]), linear_of_code(c[2]));
    spec->warn(spec->warn_context, text);
}

static void report_texels(const RetexTexelDefects *defects, const RetexTextureSpec *spec, RetexTexelDefect defect,
                          const char *what, const char *so)
{
    const long count = defects->count[defect];
    char text[sizeof spec->image + 400];

    if (!count)
        return;
    snprintf(text, sizeof text, "%s%s%ld texel%s %s, the first at %d,%d: %s", spec->image, spec->image[0] ? ": " : "",
             count, count == 1 ? "" : "s", what, defects->x[defect], defects->y[defect], so);
    spec->warn(spec->warn_context, text);
}

void retex_texel_defects_report(const RetexTexelDefects *defects, const RetexTextureSpec *spec, long texels)
{
    char what[160];

    if (!spec->warn)
        return;
    if (spec->constant) {
        report_color(defects, spec);
        return;
    }
    report_texels(defects, spec, RETEX_TEXEL_NOT_FINITE, "not finite", "taken as black");
    report_texels(defects, spec, RETEX_TEXEL_TOO_LARGE, "beyond 65504", "taken as that");
    report_texels(defects, spec, RETEX_TEXEL_NEGATIVE, "with negative colours",
                  "kept, for colours of wide gamuts have them");
    snprintf(what, sizeof what, "of %ld brighter than white, up to %.3g", texels, (double)defects->brightest);
    if (!spec->is_light)
        report_texels(
            defects, spec, RETEX_TEXEL_BRIGHT, what,
            "a surface gives back no more light than it gets; perhaps the file holds light, not albedo, or is "
            "exposed too brightly");
}
