/* The views of the built-in configuration's display that are more than its curve: tone curves from scene-linear colours
 * to linear colours of the display, 0 to 1. They are computed here and nowhere else, by this library and by the bridge.
 * Private to libretex.
 *
 * Filmic: the curve that Krzysztof Narkowicz fitted to the Academy's transforms ('ACES Filmic Tone Mapping Curve',
 * 2016), x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14) of each channel, with x the colour times the factor that
 * leaves a grey of 0.18 as it is. What is 10 times as bright as white becomes white.
 *
 * Neutral: the Khronos PBR Neutral Tone Mapper (Khronos Group, 2024). It keeps colours up to 0.8 but for 0.04, what a
 * dielectric surface reflects, and compresses and desaturates brighter ones. */
#ifndef RETEX_PICTURE_VIEW_H
#define RETEX_PICTURE_VIEW_H

#include <stddef.h>
#include <strings.h>

typedef enum RetexView { RETEX_VIEW_STANDARD, RETEX_VIEW_FILMIC, RETEX_VIEW_NEUTRAL, RETEX_VIEWS } RetexView;

/* The view of a name, of which NULL and "" are the default one; RETEX_VIEWS: none of these. */
static inline RetexView retex_view_find(const char *name)
{
    static const char *const names[RETEX_VIEWS] = {"Standard", "Filmic", "Neutral"};
    int view = RETEX_VIEW_STANDARD;
    while (name && name[0] && view < RETEX_VIEWS && strcasecmp(name, names[view]) != 0)
        view++;
    return (RetexView)view;
}

/* Values below 0, and NaN, become 0. */
static inline float retex_view_filmic(float value)
{
    /* solves filmic(0.18 g) = 0.18 */
    const float g = 0.7231708f, most = 10.1f; /* beyond which it is 1 */
    float x = value > 0 ? value : 0;
    x = g * (x < most ? x : most);
    const float shown = x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f);
    return shown < 1 ? shown : 1;
}

static inline void retex_view_neutral(float rgb[3])
{
    const float f90 = 0.04f, start = 0.8f - f90, desaturation = 0.15f;
    float least, peak = 0;
    for (int c = 0; c < 3; c++)
        rgb[c] = rgb[c] > 0 ? (rgb[c] < 1e30f ? rgb[c] : 1e30f) : 0;
    least = rgb[0] < rgb[1] ? rgb[0] : rgb[1];
    least = least < rgb[2] ? least : rgb[2];
    const float offset = least < 2 * f90 ? least - least * least / (4 * f90) : f90;
    for (int c = 0; c < 3; c++) {
        rgb[c] -= offset;
        peak = rgb[c] > peak ? rgb[c] : peak;
    }
    if (peak <= start)
        return;
    const float shown = 1 - (1 - start) * (1 - start) / (peak + 1 - 2 * start);
    const float kept = 1 / (desaturation * (peak - shown) + 1);
    for (int c = 0; c < 3; c++)
        rgb[c] = rgb[c] * (shown / peak) * kept + shown * (1 - kept);
}

/* Pixels of 1, 3 or 4 numbers, colours first, in place. */
static inline void retex_view_apply(RetexView view, float *pixels, size_t count, size_t channels)
{
    for (size_t i = 0; i < count && view == RETEX_VIEW_NEUTRAL; i++) {
        float *colors = pixels + channels * i, grey[3] = {colors[0], colors[0], colors[0]};
        retex_view_neutral(channels > 1 ? colors : grey);
        colors[0] = channels > 1 ? colors[0] : grey[0];
    }
    for (size_t i = 0; i < count && view == RETEX_VIEW_FILMIC; i++)
        for (size_t c = 0; c < (channels > 1 ? 3 : 1); c++)
            pixels[channels * i + c] = retex_view_filmic(pixels[channels * i + c]);
}

#endif
