/* Colours that several patterns have where none are written. */
#include "pattern/pattern.h"

const ColorMap pattern_blue_green_red = {
    .entries = (ColorMapEntry[]){{.value = 0, .color = {0, 0, 1, 0, 0}},
                                 {.value = 1, .color = {0, 1, 0, 0, 0}},
                                 {.value = 2, .color = {1, 0, 0, 0, 0}}},
    .count = 3};
